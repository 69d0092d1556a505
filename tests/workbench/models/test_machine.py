"""The machine bench: reading the device, signs of the answers, sentences for what is wrong."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from benchmarks.virtual_benches.machine_bench import DEVICE
from tests.workbench.models.machine_case import PLAN, SOLVED, STATES, builder, drawn, surrogate
from units import DEGREE
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError
from workbench.models.machine.build import SurrogateBuilder
from workbench.models.machine.model import MachineBench, loaded_states

BENCH = MachineBench(cache=None)
ANGLES = np.linspace(0.0, 2 * np.pi, 50, endpoint=False)


def prepared():
    return replace(BENCH, surrogate=surrogate(), builder=builder(), about_drawing=surrogate())


def test_device():
    design = BENCH.design(DEVICE)
    assert design == drawn()
    assert BENCH.accepts(DEVICE) and not BENCH.accepts({"moving_mass_kg": 1.0})


@pytest.mark.parametrize(
    "change, words",
    (
        ({"airgap_mm": None}, "lacks airgap"),
        ({"airgap_mm": -0.5}, "airgap must be a positive"),
        ({"steel": "tin"}, "unknown steel 'tin'"),
        ({"magnetisation": "axial"}, "magnetisation must be one of parallel, radial, halbach"),
        ({"coils_in_series_per_phase": 2}, "must be slots / 3"),
        ({"magnet_arc_fraction": 1.2}, "magnet_arc_fraction must be at most 1"),
    ),
)
def test_wrong_devices(change, words):
    device = {key: value for key, value in (DEVICE | change).items() if value is not None}
    with pytest.raises(WorkbenchError, match=words):
        BENCH.design(device)


def test_tolerances():
    moved = BENCH.with_tolerance(drawn(), Tolerance("remanence", 0.01, relative=True), 2.0)
    assert_allclose(moved.magnet.remanence, 1.3 * 1.02)
    moved = BENCH.with_tolerance(drawn(), Tolerance("airgap", 0.02e-3, relative=False), -1.0)
    assert_allclose(moved.machine.airgap, 0.48e-3)
    with pytest.raises(WorkbenchError, match="no input of this model"):
        BENCH.with_tolerance(drawn(), Tolerance("colour", 1.0, relative=False), 1.0)


def test_machines_are_alike_whose_fields_are():
    bench, friction = prepared(), replace(drawn(), dry_friction=0.01)
    assert bench.is_alike(drawn(), friction) and not bench.is_alike(drawn(), drawn().with_magnet(remanence=1.2))


def test_voltage_is_the_slope_of_the_flux_linkage_and_turns_with_the_speed():
    forward = prepared().respond(drawn(), "back_emf", {"angle_mech": ANGLES, "speed": np.full(50, 100.0)})
    back = prepared().respond(drawn(), "back_emf", {"angle_mech": ANGLES, "speed": np.full(50, -100.0)})
    assert_allclose(forward["v_a"], -back["v_a"])
    step = 1e-3
    ends = [evaluated_linkage(ANGLES + sign * step) for sign in (1, -1)]
    slope = (ends[0] - ends[1]) / (2 * step)
    assert_allclose(forward["v_a"], 100.0 * slope, atol=2e-3 * np.abs(slope).max() * 100)


def evaluated_linkage(angle):
    from workbench.models.machine.spectra import evaluated

    return 41e-3 * evaluated(surrogate().spectrum(drawn())[1:2], angle)[0]


def test_a_warm_magnet_induces_less():
    """As a machine with 6 % less remanence, -0.12 %/K against the temperature at which it was stated; in every kind."""
    currents = {f"i_{x}": np.full(50, i) for x, i in zip("abc", STATES[0].currents)}
    loaded = currents | {"angle_mech": np.full(50, STATES[0].angle)}
    free = {"angle_mech": ANGLES, "speed": np.full(50, 100.0)}
    weak = drawn().with_magnet(remanence=0.94 * 1.3)
    for kind, at in (("back_emf", free), ("cogging", free), ("locked_rotor", loaded), ("flux_linkage", loaded)):
        cold = prepared().respond(drawn(), kind, at | {"magnet_T": np.full(50, 22.0)})
        warm = prepared().respond(drawn(), kind, at | {"magnet_T": np.full(50, 72.0)})
        for name, values in prepared().respond(weak, kind, at).items():
            assert_allclose(warm[name], values, rtol=1e-9, atol=1e-12)
            assert np.abs(warm[name] - cold[name]).max() > 1e-4 * np.abs(cold[name]).max()


def test_magnets_that_warm_up_follow_a_parabola_between_three_fields():
    """Halfway between the middle and the warmest row, against the machine at that temperature."""
    at = {"angle_mech": np.full(200, 0.3), "speed": np.full(200, 100.0)}
    rising = prepared().respond(drawn(), "back_emf", at | {"magnet_T": np.linspace(22.0, 102.0, 200)})["v_a"]
    row = 150
    there = drawn().with_magnet(remanence=1.3 * (1 - 0.0012 * 80.0 * row / 199))
    expected = prepared().respond(there, "back_emf", at)["v_a"][row]
    assert_allclose(rising[row], expected, rtol=2e-4)


def test_resistance_of_copper():
    """234.5 degC + T: annealed copper, IEC 60028."""
    found = prepared().respond(drawn(), "phase_resistance", {"winding_T": np.array([20.0, 100.0])})["r_b"]
    assert_allclose(found, [12.6e-3, 12.6e-3 * (234.5 + 100) / (234.5 + 20)], rtol=1e-3)


def test_flux_change_is_zero_without_current():
    at = {"angle_mech": np.full(2, STATES[0].angle), "i_a": np.array([40.0, 0.0])}
    at |= {"i_b": -at["i_a"] / 2, "i_c": -at["i_a"] / 2}
    found = prepared().respond(drawn(), "flux_linkage", at)
    assert found["dpsi_a"][0] > 0
    assert all(found[f"dpsi_{x}"][1] == 0.0 for x in "abc")


def test_end_leakage_takes_the_magnets_flux_and_leaves_the_currents():
    leaky = replace(drawn(), end_leakage=0.1)
    emf = {"angle_mech": ANGLES, "speed": np.full(50, 100.0)}
    for kind, at, name, factor in (("back_emf", emf, "v_a", 0.9), ("cogging", emf, "torque", 0.81)):
        before, after = (prepared().respond(d, kind, at)[name] for d in (drawn(), leaky))
        assert_allclose(after, factor * before)


def test_exact_is_the_surrogate_at_the_drawing():
    at = {"angle_mech": ANGLES}
    exact = prepared().exact(drawn(), "cogging", at)["torque"]
    assert_allclose(exact, prepared().respond(drawn(), "cogging", at)["torque"], atol=1e-9)


def test_exact_at_one_design_after_another():
    """Solved about a machine with a smaller gap, then about the drawing: the drawing's own answer comes back."""
    there_and_back = prepared().recentred(drawn().with_machine(airgap=0.46e-3)).recentred(drawn())
    at = {"angle_mech": ANGLES}
    found = there_and_back.respond(drawn(), "cogging", at)["torque"]
    assert_allclose(found, prepared().respond(drawn(), "cogging", at)["torque"], atol=1e-9)


def test_states_are_solved_where_the_rotor_truly_stood():
    """An encoder that reads 0.3 degrees too little, and magnets a tenth of a degree too far on."""
    design = replace(drawn(), rotor_turn=0.1 * DEGREE)
    loaded = {f"i_{x}": np.full(2, i) for x, i in zip("abc", STATES[0].currents)}
    table = SimpleNamespace(
        kind="locked_rotor", rows=2, conditions={"angle_mech": np.full(2, STATES[0].angle + 0.3 * DEGREE), **loaded}
    )
    assert prepared().recentred(design, [table]).surrogate.states.turn == pytest.approx(0.2 * DEGREE)
    assert prepared().recentred(design).surrogate.states.turn == 0.0


def test_a_state_just_before_a_revolution_is_the_one_at_its_start():
    currents = {f"i_{x}": np.array([30.0, 30.0]) for x in "abc"}
    table = SimpleNamespace(kind="locked_rotor", conditions={"angle_mech": np.radians([359.848, 0.1]), **currents})
    assert [s.angle for s in loaded_states(drawn(), [table]) if any(s.currents)] == [0.0]


def test_states_are_solved_at_whole_degrees_where_these_are_near():
    """There the two states of a pair in a mirror are one, beside an encoder that is off by some tenths too."""
    angles = np.arange(-180.0, 540.0, 0.037)
    currents = {f"i_{x}": np.full(len(angles), 30.0) for x in "abc"}
    states = loaded_states(
        drawn(), [SimpleNamespace(kind="locked_rotor", conditions={"angle_mech": angles * DEGREE, **currents})]
    )
    found = np.array([state.angle for state in states if any(state.currents)]) / DEGREE
    assert_allclose(np.sort(found), np.arange(0.0, 360.0, 0.5), atol=1e-9)
    at = {"angle_mech": np.array([0.265, 6.29, 11.72, 18.35]) * DEGREE} | {f"i_{x}": np.full(4, 30.0) for x in "abc"}
    some = loaded_states(drawn(), [SimpleNamespace(kind="locked_rotor", conditions=at)])
    assert_allclose([state.angle / DEGREE for state in some if any(state.currents)], [0.0, 6.0, 12.0, 18.5])


def test_sentences():
    with pytest.raises(WorkbenchError, match="prepare"):
        BENCH.respond(drawn(), "cogging", {"angle_mech": ANGLES})
    with pytest.raises(WorkbenchError, match="no measurement kind impedance"):
        prepared().respond(drawn(), "impedance", {})
    with pytest.raises(WorkbenchError, match="currents of all phases"):
        prepared().respond(drawn(), "locked_rotor", {"angle_mech": ANGLES, "i_a": ANGLES})


def test_a_second_build_comes_from_the_cache(monkeypatch):
    """Nothing is solved, and it answers the same bit for bit."""
    surrogate()
    second = SurrogateBuilder(drawn(), PLAN, SOLVED)
    monkeypatch.setattr(second, "_solved", lambda tasks: iter(list(tasks)))
    there = replace(prepared(), surrogate=second.build(STATES))
    changed = drawn().with_magnet(remanence=1.22)
    for kind, at in (
        ("cogging", {"angle_mech": ANGLES}),
        ("back_emf", {"angle_mech": ANGLES, "speed": np.full(50, 1.0)}),
    ):
        first, again = (bench.respond(changed, kind, at) for bench in (prepared(), there))
        assert all((first[name] == again[name]).all() for name in first)
