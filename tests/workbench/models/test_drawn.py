"""The bench of drawn machines against the field itself, hand calculations and symmetry."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from effects.drawn.bridge_width import BridgeWidth
from effects.drawn.eddy_screening import EddyScreening
from effects.drawn_design import rim_field
from effects.electrical.winding_turns import WindingTurns
from effects.machine.airgap_change import AirgapChange
from effects.machine.end_leakage import EndLeakage
from effects.machine.magnet_temperature import MagnetTemperature
from electrical.winding_connection import Delta, Star, WindingConnection
from geometry.half_cell import MeshDensity
from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.torque import arkkio_torque
from magnetostatics.zero_sequence import harmonics_of_half_period
from study.machine_file import MACHINES
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
    assert np.allclose(_unfolded(np.stack([one[:6] for one in lagging], axis=1), 6), wave)
    uneven = wave + 0.3 * np.sin(2 * angle + 0.1)
    lagging = [np.roll(uneven, 12 * k) for k in range(3)]
    assert np.allclose(_unfolded(np.stack([one[:12] for one in lagging], axis=1), 3), uneven)


def test_a_polynomial_between_angles_is_met():
    here = np.array([2.3, -0.7, 5.0])
    places, weights = _around(here)
    assert np.allclose((weights * (places**5 - 3 * places)).sum(1), here**5 - 3 * here)


@pytest.mark.parametrize("name", ["outrunner_9_12", "consequent_12_8", "szesynrm"])  # poles alike, not, without magnets
def test_states_that_differ_by_the_names_of_the_phases_are_solved_once(name):
    samples = DrawnBench(COARSE, cache=None).prepared(DrawnBench().design({"machine_file": name}), ()).expansion.samples
    design, part = samples.nominal.in_field, samples.period // samples.parts
    lines = [(70.0, -60.0, -10.0), (-10.0, 70.0, -60.0), (-60.0, -10.0, 70.0)]
    states = [State(1 + k * part, currents) for currents in lines for k in range(samples.parts)]
    fields = [samples.model(design).solve(PhaseCurrents(s.step * samples.step, s.ampere_turns)) for s in states]
    own = np.array([[arkkio_torque(one), *phase_flux_linkage(one)] for one in fields])
    assert np.allclose(samples.at(design, states), own, rtol=0, atol=1e-8 * np.abs(own).max(axis=0))
    solved = {samples.alike(one).state for one in states}
    assert len(states) == len(solved) * (3 if design.machine.rotor.magnets_per_pitch else 6)


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


def test_flux_that_leaks_at_the_ends_is_missing_at_speed_whatever_the_current(outrunner):
    """Seven per cent of the magnets', and nothing of what currents change."""
    bench, design = outrunner
    drawn = replace(design, phase_resistance=0.05, largest_current=5.0)
    leaking = EndLeakage(share=0.07).on_design(drawn)
    at = {"speed": np.array([100.0])}
    volts = [bench.respond(one, "no_load", at)["v_ll"][0] for one in (drawn, leaking)]
    assert volts[1] == pytest.approx(0.93 * volts[0], rel=1e-9)
    i_d, i_q = np.array([-2.0]), np.array([3.0])
    lost = [answers(outrunner, drawn).mean_dq(d, q) - answers(outrunner, leaking).mean_dq(d, q)
            for d, q in ((i_d, i_q), (0 * i_d, 0 * i_q))]  # fmt: skip
    assert lost[0] == pytest.approx(lost[1], rel=1e-9) and lost[1][0, 0] > 0


def test_reluctance_torque_does_not_leak_at_the_ends(outrunner):
    """Lost is a share of what voltage and current make, and of cogging its square; locked and turning alike."""
    bench, design = outrunner
    leaking = EndLeakage(share=0.1).on_design(design)
    angle, lines = np.array([5 * bench.expansion.samples.step]), np.array([[3.0, -5.0, 2.0]])
    drawn, less = answers(outrunner), answers(outrunner, leaking)
    lost = drawn.torque(angle, lines) - less.torque(angle, lines)
    cogging = drawn.torque(angle, 0 * lines)
    voltage_per_speed = drawn.linkage_slopes(angle)
    assert lost == pytest.approx(0.1 * (voltage_per_speed * lines).sum() + 0.19 * cogging, rel=1e-9)
    assert less.torque(angle, 0 * lines) == pytest.approx(0.81 * cogging, rel=1e-9)
    turned = 6 * angle[0] - design.drawing.layout.phase_axis - 2 * pi / 3 * np.arange(3)
    assert less.turning_torque(angle, 4.0) == pytest.approx(less.torque(angle, -4.0 * np.sin(turned)[None]), rel=1e-6)


def test_eddies_take_the_flux_that_crosses_the_gap_and_leave_what_all_phases_share(outrunner):
    """Slots, ends and whatever the three phases have in common stay: L + 2 M does not change."""
    bench, design = outrunner
    one = {"angle_mech": np.array([0.1])}
    bare = bench.respond(design, "inductance", one)
    seen = EddyScreening(0.2).on_response(bare, one, "inductance", design)
    assert seen["l_m"] == pytest.approx(0.8 * bare["l_m"]) and bare["l_m"] < 0
    assert seen["l_a"] + 2 * seen["l_m"] == pytest.approx(bare["l_a"] + 2 * bare["l_m"])
    assert seen["l_ab"] - bare["l_ab"] == pytest.approx(2 * (seen["l_a"] - seen["l_m"] - bare["l_a"] + bare["l_m"]))
    assert EddyScreening(0.2).on_response(bare, one, "flux_linkage", design) is bare


def test_a_stack_has_no_more_steel_than_length(outrunner):
    bench, design = outrunner
    tight = Tolerance("stacking_factor", 0.02, relative=False)
    full = bench.with_tolerance(replace(design, stacking_factor=0.97), tight, 5.0)
    assert full.stacking_factor == 1.0


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


def test_phases_that_are_not_alike(outrunner):
    """Between lines the sum of two; a tolerance moves one of them and the mean by a third of that."""
    bench, _ = outrunner
    device = {"machine_file": "outrunner_9_12"} | {f"phase_resistance_{x}_mohm": r for x, r in zip("abc", (68, 74, 66))}
    design = bench.design(device)
    warm = {"winding_T": np.array([20.0, 70.0])}
    found = bench.respond(design, "phase_resistance", warm)
    copper = 1 + 0.00393 * 50
    assert found["r_ab"] == pytest.approx([0.142, 0.142 * copper], rel=1e-3)
    assert [found[f"r_{x}"][0] for x in ("bc", "ca", "a", "c")] == pytest.approx([0.140, 0.134, 0.068, 0.066])
    assert found["resistance"][0] == pytest.approx(0.208 / 3)
    moved = bench.with_tolerance(design, Tolerance("phase_resistance_b", 0.05, relative=True, source=""), 1.0)
    seen = bench.respond(moved, "phase_resistance", warm)
    assert [seen[f"r_{x}"][0] for x in ("ab", "bc", "ca")] == pytest.approx([0.1457, 0.1437, 0.134])
    assert seen["resistance"][0] == pytest.approx(found["resistance"][0] + 0.05 * 0.074 / 3)


@pytest.mark.parametrize("beside", ("phase_resistance_mohm", "phase_resistance_b_mohm"))
def test_phases_are_stated_all_or_none(beside):
    with pytest.raises(WorkbenchError, match="give all of phase_resistance_a"):
        DrawnBench().design({"machine_file": "outrunner_9_12", "phase_resistance_a_mohm": 70.0, beside: 70.0})


# ---- windings in delta and with parallel paths, seen from their terminals --------------------------------------------


@pytest.fixture(scope="module")
def wound(outrunner):
    """The outrunner's design, its coils joined otherwise."""

    def otherwise(**changes):
        drawing = replace(outrunner[1].drawing, **changes)
        return replace(outrunner[1], drawing=drawing, phase_resistance=0.02)

    connections = {"delta": WindingConnection(1, Delta()), "paths": WindingConnection(3, Star())}
    return {
        name: otherwise(coil_currents=one.coil_currents, star_lag=one.closing.lag, is_delta=one.closing.circulates)
        for name, one in connections.items()
    }


def test_the_file_says_how_coils_are_joined(tmp_path):
    text = (MACHINES / "outrunner_9_12.toml").read_text(encoding="utf-8").replace('"curves/', f'"{MACHINES}/curves/')
    joined = tmp_path / "joined.toml"
    joined.write_text(text.replace("turns_per_coil = 8", 'turns_per_coil = 8\nconnection = "delta"'))
    drawing = DrawnBench().design({"machine_file": str(joined)}).drawing
    assert drawing.is_delta and drawing.star_lag == pi / 6
    assert drawing.coil_currents @ np.array([1.0, -1.0, 0.0]) == pytest.approx([2 / 3, -1 / 3, -1 / 3])


def test_a_delta_shows_the_voltage_of_a_phase_without_what_goes_round(outrunner, wound):
    bench, design = outrunner
    turn = {"angle_mech": np.arange(120) * 2 * pi / 720, "speed": np.full(120, 50.0)}
    phase = np.fft.rfft(bench.respond(design, "back_emf", turn)["v_a"]) / 60
    phase[::3] = 0.0
    line = bench.respond(wound["delta"], "back_emf", {"speed": np.array([50.0])})
    assert line["v_ll"][0] == pytest.approx(np.linalg.norm(phase) / sqrt(2), rel=1e-9)
    over_angle = bench.respond(wound["delta"], "back_emf", turn)
    assert np.fft.rfft(over_angle["v_a"] - over_angle["v_b"])[1] / 60 == pytest.approx(phase[1], rel=1e-9)


def test_lines_of_a_delta_feed_its_phases_by_their_resistances(outrunner, wound):
    """A between terminals A and B, B between B and C, C between C and A; what is fed in divides 2 to 1."""
    bench, design = outrunner
    lines, angle = np.array([3.0, -5.0, 2.0]), np.array([5 * bench.expansion.samples.step])
    nodes = np.array([[1, 0, -1], [-1, 1, 0], [1, 1, 1]])
    phases = np.linalg.solve(nodes, [lines[0], lines[1], 0.0])
    at = {"angle_mech": angle} | {f"i_{x}": lines[[k]] for k, x in enumerate("abc")}
    exact = bench.expansion.samples.model(design).solve(PhaseCurrents(angle[0], tuple(phases * design.turns)))
    found = bench.respond(wound["delta"], "locked_rotor", at)["torque"][0]
    assert found == pytest.approx(arkkio_torque(exact) * design.length, rel=1e-6)


def test_inductance_between_the_lines_of_a_delta_is_that_of_two_branches(outrunner, wound):
    """One phase beside two in series, each with what the others induce in it, from the matrix of three phases."""
    bench, design = outrunner
    angle = np.array([0.02])
    matrix = np.zeros((3, 3))
    for k, x in enumerate("abc"):
        at = {"angle_mech": angle} | {f"i_{y}": np.array([0.5 if y == x else 0.0]) for y in "abc"}
        change = bench.respond(design, "flux_linkage", at)
        matrix[:, k] = [change[f"dpsi_{y}"][0] / 0.5 for y in "abc"]
    branches = np.array([[1, 0], [0, -1], [0, -1]])  # A, and B and C the other way round
    two = branches.T @ matrix @ branches
    found = bench.respond(wound["delta"], "inductance", {"angle_mech": angle})
    assert found["l_ab"][0] == pytest.approx(1 / np.linalg.inv(two).sum(), rel=2e-3)
    assert "l_a" not in found


def test_alternating_currents_divide_by_inductances_where_phases_are_not_alike(outrunner, wound, monkeypatch):
    matrix = np.array([[3.0, -1.0, -0.5], [-1.0, 2.0, -0.8], [-0.5, -0.8, 2.5]])
    monkeypatch.setattr(Answers, "_coil_change", lambda _, angle, currents: currents @ matrix)
    branches = np.array([[1, 0], [0, -1], [0, -1]])
    fed = np.array([1.0, -1.0, 0.0])
    found = answers(outrunner, wound["delta"]).alternating_change(np.zeros(1), fed[None])[0] @ fed
    assert found == pytest.approx(1 / np.linalg.inv(branches.T @ matrix @ branches).sum(), rel=1e-12)


def test_what_goes_round_a_delta_brakes_as_its_differential_equation_says(outrunner, wound):
    """R i + L di/dt = -e over one loop of three phases, e a third of their sum, integrated until it repeats."""
    bench, design = outrunner
    speed, seen, plain = 900.0, answers(outrunner, wound["delta"]), answers(outrunner)
    resistance, inductance, third = 3 * 0.02, seen._common_inductance, 2 * pi / 6 / 3 / speed

    def rate(t, i):
        return -(speed * plain.linkage_slopes(np.array([speed * t])).sum() / 3 + resistance * i) / inductance

    end = third * np.ceil(8 * inductance / resistance / third)
    run = solve_ivp(rate, (0.0, end + third), [0.0], rtol=1e-8, atol=1e-10, t_eval=end + third * np.arange(200) / 200)
    loss = np.array([3 * resistance * np.mean(run.y[0] ** 2)])
    assert seen.circulating_loss(np.array([speed])) == pytest.approx(loss, rel=2e-3)
    brake = {name: bench.respond(one, "drag", {"speed": np.array([speed])})["torque"] for name, one in wound.items()}
    assert brake["paths"] == 0.0 and -brake["delta"] * speed == pytest.approx(loss, rel=2e-3)


FINER = Plan(72, MeshDensity(gap_edges=432, gap_layers=1, across_iron=1.0))


def test_load_changes_what_goes_round_a_delta(wound):
    """Third, ninth ... order of the flux that the phases share, of the field itself at twelve positions of a sixth of a
    period, make the loss by which the shaft lacks torque; the map has none of these currents as a node."""
    design = replace(wound["delta"], largest_current=40.0)
    bench = DrawnBench(FINER, cache=None).prepared(design, ())
    seen, i_d, i_q, speed = Answers(bench.expansion, bench.anchors, design), -15.0, 30.0, 900.0
    model, axis = bench.expansion.samples.model(design), design.drawing.layout.phase_axis + design.drawing.star_lag
    common = []
    for theta in pi / 3 * np.arange(12) / 12:
        turned = theta - axis - 2 * pi / 3 * np.arange(3)
        coils = design.turns * design.drawing.coil_currents @ (i_d * np.cos(turned) - i_q * np.sin(turned))
        common.append(phase_flux_linkage(model.solve(PhaseCurrents(theta / 6, tuple(coils)))).mean())
    orders, sizes = harmonics_of_half_period(design.turns * design.length * np.array(common))
    expected = seen.loss_round_delta(np.array([speed]), orders, sizes**2)[0]
    idle = seen.circulating_loss(np.array([speed]))[0]
    assert expected > 100 * idle, "the voltage without current has hardly any third order"
    at = {"i_d": np.full(2, i_d), "i_q": np.full(2, i_q), "speed": np.array([0.0, speed])}
    still, turning = bench.respond(design, "dq_operation", at)["torque"]
    assert (still - turning) * speed == pytest.approx(expected, rel=0.06)


def test_three_paths_are_a_third_of_the_voltage_at_three_times_the_current(outrunner, wound):
    bench, design = outrunner
    at = {"speed": np.array([100.0])}
    series, parallel = (bench.respond(one, "back_emf", at)["v_ll"][0] for one in (design, wound["paths"]))
    assert parallel == pytest.approx(series / 3, rel=1e-12)

    def torque(one, i):
        state = {"angle_mech": np.array([0.05]), "i_a": np.array([i]), "i_b": np.array([-i / 2])}
        return bench.respond(one, "locked_rotor", state | {"i_c": np.array([-i / 2])})["torque"][0]

    assert torque(wound["paths"], 12.0) == pytest.approx(torque(design, 4.0), rel=1e-9)


# ---- kinds of measurement --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("joined", ("series", "delta"))
def test_the_holding_current_leaves_no_torque_in_the_field(outrunner, wound, joined):
    bench, design = outrunner
    asked = design if joined == "series" else wound[joined]
    samples = bench.expansion.samples
    steps = np.array([3, 5, 9])
    current = bench.respond(asked, "holding_current", {"angle_mech": steps * samples.step})["current"]
    model = samples.model(design)
    for step, i in zip(steps, current, strict=True):
        turned = 6 * step * samples.step - design.drawing.layout.phase_axis - asked.drawing.star_lag
        lines = -i * np.sin(turned - 2 * pi / 3 * np.arange(3))
        coils = asked.turns * asked.drawing.coil_currents @ lines
        both = (PhaseCurrents(step * samples.step, tuple(one)) for one in (0 * coils, coils))
        idle, held = (arkkio_torque(model.solve(point)) for point in both)
        assert abs(idle) > 1e-3 and abs(held) < 0.01 * abs(idle)


def test_the_holding_current_carries_the_friction_of_a_creeping_rotor(outrunner):
    """Half the difference of both ways is friction over the torque constant, wherever cogging is."""
    bench, design = outrunner
    stiff = replace(design, dry_friction=2e-4)
    angle = np.array([0.02, 0.05])
    ways = [bench.respond(stiff, "holding_current", {"angle_mech": angle, "direction": np.full(2, d)})["current"]
            for d in (1.0, -1.0)]  # fmt: skip
    constant = 1.5 * 6 * abs(answers(outrunner).waves[1])
    assert (ways[0] - ways[1]) / 2 == pytest.approx(np.full(2, 2e-4 / constant), rel=0.1)


def test_torque_against_the_current_angle_is_that_of_the_field(outrunner):
    bench, design = outrunner
    angle = 4 * bench.expansion.samples.step
    model = bench.expansion.samples.model(design)
    for gamma in (0.0, 0.9):
        turned = 6 * angle - design.drawing.layout.phase_axis - 2 * pi / 3 * np.arange(3)
        lines = -4.0 * (np.sin(gamma) * np.cos(turned) + np.cos(gamma) * np.sin(turned))
        at = {"angle_mech": np.array([angle])} | {f"i_{x}": lines[[k]] for k, x in enumerate("abc")}
        exact = arkkio_torque(model.solve(PhaseCurrents(angle, tuple(lines * design.turns)))) * design.length
        assert bench.respond(design, "locked_rotor", at)["torque"][0] == pytest.approx(exact, rel=1e-6)


@pytest.fixture(scope="module")
def driven(outrunner):
    """The design with what currents at speed need, and its constants read off the field."""
    design = replace(outrunner[1], phase_resistance=0.05, largest_current=5.0, viscous_friction=1e-6)
    psi = abs(answers(outrunner).waves[1])
    at = {"angle_mech": np.array([0.02]), "current": np.array([1.0])}
    return design, psi, outrunner[0].respond(design, "inductance", at)["l_ab"][0] / 2


def test_no_load_speed_current_and_power_by_hand(outrunner, driven):
    """Driven: the voltage of the magnets and the power of the friction. Fed: the voltage that leaves i_d zero needs the
    current of the friction alone."""
    bench, (design, psi, inductance) = outrunner[0], driven
    speed = np.array([400.0])
    open_ends = bench.respond(design, "no_load", {"speed": speed})
    assert open_ends["v_ll"][0] == pytest.approx(6 * 400 * psi * sqrt(1.5), rel=2e-3)
    assert open_ends["power"][0] == pytest.approx(1e-6 * 400**2, rel=1e-9)
    i_q = 1e-6 * 400 / (1.5 * 6 * psi)
    volts = abs(complex(0.05 * i_q + 6 * 400 * psi, 6 * 400 * inductance * i_q)) * sqrt(1.5)
    fed = bench.respond(design, "no_load", {"speed": speed, "v_ll": np.array([volts])})
    assert fed["power"][0] == pytest.approx(1e-6 * 400**2 + 1.5 * 0.05 * i_q**2, rel=0.02)
    assert fed["current"][0] == pytest.approx(i_q / sqrt(2), rel=0.15), "what is left of i_d counts quadratically"


def test_a_dynamometer_map_by_hand(outrunner, driven):
    """Magnets on the surface: i_q = T / (1.5 p psi), i_d = 0."""
    bench, (design, psi, inductance) = outrunner[0], driven
    speed, torque = np.array([300.0]), np.array([0.008])
    i_q = (0.008 + 1e-6 * 300) / (1.5 * 6 * psi)
    found = bench.respond(design, "dyno_map", {"speed": speed, "torque": torque})
    volts = abs(complex(0.05 * i_q + 6 * 300 * psi, 6 * 300 * inductance * i_q)) * sqrt(1.5)
    assert found["current"][0] == pytest.approx(i_q / sqrt(2), rel=5e-3)
    assert found["v_ll"][0] == pytest.approx(volts, rel=5e-3)
    assert found["loss"][0] == pytest.approx(1.5 * 0.05 * i_q**2 + 1e-6 * 300**2, rel=0.01)


def test_what_is_not_known_is_refused():
    bench = DrawnBench()
    with pytest.raises(WorkbenchError, match="poles = 8"):
        bench.design({"machine_file": "outrunner_9_12", "poles": 8})
    design = bench.design({"machine_file": "outrunner_9_12"})
    with pytest.raises(WorkbenchError, match="no input of this model"):
        bench.with_tolerance(design, Tolerance("bridge", 1e-4, relative=False, source=""), 1.0)
