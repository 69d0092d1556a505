"""The bench of drawn machines against the field itself, hand calculations and symmetry."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from effects.drawn.bridge_width import BridgeWidth
from effects.drawn_design import rim_field
from effects.electrical.winding_turns import WindingTurns
from effects.machine.airgap_change import AirgapChange
from effects.machine.end_leakage import EndLeakage
from effects.machine.magnet_temperature import MagnetTemperature
from geometry.half_cell import MeshDensity
from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.torque import arkkio_torque
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError
from workbench.models.drawn.answers import Answers, _around, _unfolded
from workbench.models.drawn.copper import copper_resistance
from workbench.models.drawn.field import FieldSamples, Plan, State
from workbench.models.drawn.model import DrawnBench

COARSE = Plan(24, MeshDensity(gap_edges=96, gap_layers=1, across_iron=1.0))


@pytest.fixture(scope="module")
def outrunner():
    """Bench and design, coarse; solved for what the tests ask."""
    bench = DrawnBench(COARSE, cache=None)
    design = bench.design({"machine_file": "outrunner_9_12"})
    return bench.prepared(design, ()), design


def answers(outrunner, design=None):
    bench, drawn = outrunner
    return Answers(bench.expansion, bench.anchors, design or drawn)


def test_a_sixth_of_three_phases_makes_a_period():
    angle = np.arange(36) * 2 * pi / 36
    wave = np.cos(angle - 0.3) + 0.2 * np.cos(5 * angle) + 0.1 * np.sin(3 * angle)
    lagging = [np.roll(wave, 12 * k) for k in range(3)]
    assert np.allclose(_unfolded(np.stack([one[:6] for one in lagging], axis=1)), wave)


def test_a_polynomial_between_angles_is_met():
    here = np.array([2.3, -0.7, 5.0])
    places, weights = _around(here)
    assert np.allclose((weights * (places**5 - 3 * places)).sum(1), here**5 - 3 * here)


def test_the_voltage_is_the_slope_of_the_fields_linkage(outrunner):
    bench, design = outrunner
    model, h = bench.expansion.samples.model(design), bench.expansion.samples.step
    psi = [phase_flux_linkage(model.solve(PhaseCurrents(k * h, (0.0, 0.0, 0.0)))) for k in (3, 4, 5, 6, 7)]
    slope = (psi[0] - 8 * psi[1] + 8 * psi[3] - psi[4]) / (12 * h) * design.turns * design.length
    asked = {"angle_mech": np.array([5 * h]), "speed": np.array([100.0])}
    found = bench.respond(design, "back_emf", asked)
    size = np.abs(slope).max()
    assert [found[f"v_{x}"][0] for x in "abc"] == pytest.approx(100 * slope, abs=0.01 * 100 * size)


def test_rms_values_are_those_of_the_wave(outrunner):
    bench, design = outrunner
    turn = {"angle_mech": np.arange(120) * 2 * pi / 720, "speed": np.full(120, 50.0)}
    wave = bench.respond(design, "back_emf", turn)
    rms = bench.respond(design, "back_emf", {"speed": np.array([-50.0])})
    assert rms["v_ll"][0] == pytest.approx(sqrt(np.mean((wave["v_a"] - wave["v_b"]) ** 2)), rel=1e-9)
    spectrum = np.fft.rfft(wave["v_c"]) / 60
    assert rms["v_c"][0] == pytest.approx(abs(spectrum[1]) / sqrt(2), rel=1e-9)


def test_torque_with_current_is_that_of_voltage_and_current(outrunner):
    """Mean over a period with sinusoidal currents in phase with the voltage: 1.5 p psi I, no reluctance torque."""
    bench, design = outrunner
    angle = np.arange(0, 60, 5) * pi / 180
    wave = answers(outrunner).linkage_slopes(angle)
    currents = 0.3 * wave / np.abs(answers(outrunner).waves[1]) / 6
    mean = answers(outrunner).torque(angle, currents).mean()
    assert mean == pytest.approx(1.5 * 6 * abs(answers(outrunner).waves[1]) * 0.3, rel=0.02)


def test_currents_in_proportion_share_their_anchor(outrunner):
    found = answers(outrunner)
    angle = np.array([0.02, 0.05])
    alone, more = (found.torque(angle, np.tile([i, -i / 2, -i / 2], (2, 1))) for i in (4.0, 4.2))
    assert len(outrunner[0].anchors._known) < 40
    exact = outrunner[0].expansion.samples.model(outrunner[1]).solve(PhaseCurrents(0.02, (4.2, -2.1, -2.1), 8))
    assert more[0] != alone[0]
    assert more[0] == pytest.approx(arkkio_torque(exact) * outrunner[1].length, rel=0.03)


def test_effects_do_what_they_say(outrunner):
    bench, design = outrunner
    at = {"speed": np.array([100.0])}

    def volts(changed):
        return bench.respond(changed, "back_emf", at)["v_ll"][0]

    drawn = volts(design)
    assert volts(EndLeakage(share=0.07).on_design(design)) == pytest.approx(0.93 * drawn, rel=1e-12)
    assert volts(WindingTurns(change=0.1).on_design(design)) == pytest.approx(1.1 * drawn, rel=1e-12)
    assert volts(AirgapChange(change=5e-5).on_design(design)) < drawn
    warm = MagnetTemperature(rise=50.0).on_design(design)
    assert volts(warm) == pytest.approx(drawn * (1 - 50 * 0.0011), rel=0.01)
    assert not BridgeWidth.can_act_on(design)


def test_the_expansion_is_exact_at_its_nodes_and_centre(outrunner):
    bench, design = outrunner
    weaker = design.with_magnet(remanence=0.9 * design.magnet.remanence)
    states = [State(3, (0.0, 0.0, 0.0))]
    exact = FieldSamples(weaker, COARSE, None).at(weaker, states)
    near = bench.expansion.at_centre(states) + bench.expansion.change(weaker, states)
    assert near == pytest.approx(exact, rel=3e-3, abs=2e-4 * np.abs(exact).max())
    moved = bench.recentred(weaker).expansion
    assert moved.at_centre(states) + moved.change(weaker, states) == pytest.approx(exact, rel=1e-6, abs=1e-9)


def test_the_gap_widens_by_the_bore(outrunner):
    _, design = outrunner
    assert rim_field(design.machine.stator) == "outer_radius"
    assert design.with_airgap(1e-5).machine.airgap == pytest.approx(design.machine.airgap + 1e-5)
    wide = DrawnBench().with_tolerance(design, Tolerance("airgap", 1e-5, relative=False, source=""), 2.0)
    assert wide.machine.airgap == pytest.approx(design.machine.airgap + 2e-5)


def test_solutions_are_kept_on_disk(tmp_path, outrunner):
    _, design = outrunner
    state = [State(0, (0.0, 0.0, 0.0))]
    first = FieldSamples(design, COARSE, tmp_path).at(design, state)
    again = FieldSamples(design, COARSE, tmp_path)
    again.model = None  # nothing is solved
    assert np.array_equal(again.at(design, state), first)


def test_the_resistance_between_lines_is_seen():
    device = {"machine_file": "inset_ferrite_6_4", "wire_diameter_mm": 0.64, "phase_resistance_mohm": 4473.0}
    bench = DrawnBench()
    right = bench.design(device)
    by_hand = 1.68e-8 * 656 * (2 * 0.0301 + pi * 0.0256) / (pi / 4 * 0.64e-3**2)
    assert copper_resistance(right) == pytest.approx(by_hand, rel=0.03)
    assert bench.doubts(right) == ()
    (said,) = bench.doubts(replace(right, phase_resistance=8.9462))
    assert "between two lines" in said


def test_what_is_not_known_is_refused():
    bench = DrawnBench()
    with pytest.raises(WorkbenchError, match="poles = 8"):
        bench.design({"machine_file": "outrunner_9_12", "poles": 8})
    design = bench.design({"machine_file": "outrunner_9_12"})
    with pytest.raises(WorkbenchError, match="no input of this model"):
        bench.with_tolerance(design, Tolerance("bridge", 1e-4, relative=False, source=""), 1.0)
