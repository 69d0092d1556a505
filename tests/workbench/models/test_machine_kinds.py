"""Short circuit, drag, maps and inductances of the machine bench, against closed forms and balances of energy."""

from __future__ import annotations

from dataclasses import astuple, replace
from math import lcm

import numpy as np
import pytest
from numpy.testing import assert_allclose

from benchmarks.virtual_benches.machine_bench import DEVICE
from effects.machine.bearing_friction import BearingFriction
from effects.machine.interturn_short import InterturnShort
from effects.machine.iron_loss import IronLoss
from effects.machine.iron_loss_excess import IronLossExcess
from effects.machine.stepped_skew import SteppedSkew
from losses.iron import iron_loss
from losses.loci import solve_part, stator_loci
from magnetostatics.model import OperatingPoint
from materials.iron_loss import iron_loss_law
from tests.effects.machine_bench import TURN, bench
from tests.workbench.models.machine_case import LOADED, MIDDLE, drawn, field, surrogate
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError
from workbench.models.machine.answers import Answers, load_angles
from workbench.models.machine.device import machine_of_device, own_tolerances, with_tolerance
from workbench.models.machine.drag import USUAL_SHEET, Swing, _torques, iron_torques, yoke_wave
from workbench.models.machine.kinds import KINDS, dq_machine, loaded_states

SPEED = np.array([-150.0, 20.0, 80.0, 300.0])
AT = {"angle_mech": np.full(1, LOADED.angle)} | {f"i_{x}": np.full(1, i) for x, i in zip("abc", LOADED.currents)}


def respond(kind, design=None, **at):
    return bench().respond(design or drawn(), kind, {name: np.asarray(v, dtype=float) for name, v in at.items()})


def test_short_circuit_of_a_regular_machine_is_the_closed_form():
    """I = w psi/|R + j w L|, T = -1.5 p R w psi^2/(R^2 + (w L)^2), L = own less mutual inductance."""
    answers = Answers(surrogate(), drawn())
    own, mutual = answers.inductances[0, 0], answers.inductances[0, 1]
    w, r, x = 5 * SPEED, 12.6e-3, 5 * SPEED * (own - mutual)
    psi = np.abs(answers.linkage_waves[0, 5])
    found = respond("short_circuit", speed=SPEED)
    assert_allclose(found["current"], np.abs(w) * psi / np.hypot(r, x) / np.sqrt(2), rtol=1e-6)
    assert_allclose(found["torque"], -1.5 * 5 * r * w * psi**2 / (r**2 + x**2), rtol=1e-6)


def test_short_circuit_of_unlike_phases_keeps_its_energy():
    """The shaft brings what three resistances take, each phase with its own current."""
    design = replace(drawn(), phase_resistance=(12.6e-3, 20e-3, 12.6e-3))
    found = respond("short_circuit", design, speed=SPEED, winding_T=np.full(4, 20.0))
    copper = sum(r * found[f"i_{x}"] ** 2 for x, r in zip("abc", design.phase_resistance))
    assert_allclose(-found["torque"] * SPEED, copper, rtol=1e-9)
    assert np.all(np.ptp([found[f"i_{x}"] for x in "abc"], axis=0) > 0.01 * found["current"])


def test_short_circuit_needs_resistances():
    with pytest.raises(WorkbenchError, match="give phase_resistance"):
        respond("short_circuit", replace(drawn(), phase_resistance=(0.0,) * 3), speed=SPEED)


def test_iron_of_a_sinusoidal_flux_has_the_loss_of_the_sheet():
    """1.2 T at 5 pole pairs and 100 rad/s, in 0.3 kg, against the law in its own frequency and peak."""
    wave = np.zeros(20, dtype=complex)
    wave[5] = 1.2j
    hysteresis, eddy, excess = _torques(USUAL_SHEET, 0.3, Swing.of(wave), 5)
    power = 100.0 * (hysteresis + eddy * 100.0 + excess * 10.0)
    assert_allclose(power, 0.3 * USUAL_SHEET.specific_loss(5 * 100.0 / (2 * np.pi), 1.2), rtol=1e-4)


def test_flux_of_a_tooth_comes_from_the_yoke_on_its_both_sides():
    design = IronLoss(factor=1.0).on_design(drawn())
    tooth, pitch = Answers(surrogate(), design).tooth_wave(0), 2 * np.pi / 12
    yoke = yoke_wave(tooth, pitch)
    apart = yoke - yoke * np.exp(1j * np.arange(len(tooth)) * pitch)
    assert_allclose(apart[5], tooth[5], rtol=1e-9)
    assert 1.0 < np.abs(tooth[5]) / drawn().length / 5.5e-3 < 2.0  # T in a tooth


def test_a_swing_of_another_size_is_that_of_the_larger_flux():
    wave = surrogate().no_load[1]
    assert_allclose(astuple(Swing.of(wave).times(1.7)), astuple(Swing.of(1.7 * wave)), rtol=1e-12)


def test_two_regions_lose_what_all_elements_lose():
    """Against the loci of every element of the stator, without current."""
    part = solve_part(field(MIDDLE).model(drawn(), False), OperatingPoint(0.0, 0.0, 0.0, 0.5))
    expected, per_speed = iron_loss(stator_loci(part), USUAL_SHEET).total, 5 / (2 * np.pi)
    hysteresis, eddy, excess = iron_torques(Answers(surrogate(), IronLoss(factor=1.0).on_design(drawn())))
    length = drawn().length
    assert_allclose(hysteresis, length * expected.hysteresis * per_speed, rtol=0.02)
    assert_allclose(eddy, length * expected.eddy * per_speed**2, rtol=0.08)
    assert_allclose(excess, length * expected.excess * per_speed**1.5, rtol=0.05)


def test_iron_loss_is_a_drag_of_its_own_shape_and_follows_the_magnets():
    """Level, slope and root of the speed; weaker magnets lose less, by the power of the flux density."""
    design = IronLoss(factor=1.0).on_design(drawn())
    level, slope, root = iron_torques(Answers(surrogate(), design))
    found = respond("drag", design, speed=SPEED)["torque"]
    size = np.abs(SPEED)
    assert_allclose(found, -np.sign(SPEED) * (level + slope * size + root * np.sqrt(size)))
    weak = respond("drag", design.with_magnet(remanence=1.3 * 0.9), speed=SPEED)["torque"]
    assert np.all((weak / found > 0.78) & (weak / found < 0.87))  # 0.9 to the power of 1.5 to 2
    creeping = respond("cogging", design, angle_mech=np.zeros(2), direction=[1.0, -1.0])["torque"]
    assert_allclose(np.diff(creeping), 2 * level)
    assert not respond("drag", speed=SPEED)["torque"].any()
    declared = replace(drawn(), iron_loss=USUAL_SHEET)
    assert_allclose(respond("drag", declared, speed=SPEED)["torque"], found)
    more = respond("drag", IronLossExcess(excess=0.5).on_design(declared), speed=SPEED)["torque"]
    assert_allclose(more, 1.5 * found)


def test_shorted_turns_brake_with_the_speed_and_less_beyond_their_corner():
    design = InterturnShort(coil=1, turns=1.0).on_design(drawn())
    slow, twice, fast, faster = -respond("drag", design, speed=[5.0, 10.0, 5000.0, 10000.0])["torque"]
    assert_allclose(twice, 2 * slow, rtol=0.01)
    assert fast > faster > 0


def test_the_machine_by_its_fundamental():
    """psi_m is the fundamental of the back-EMF over w, an inductance of both axes near own less mutual."""
    answers = Answers(surrogate(), drawn())
    machine = dq_machine(answers)
    voltage = respond("back_emf", angle_mech=TURN, speed=np.full(len(TURN), 100.0))["v_a"]
    fundamental = 2 * np.abs(np.fft.rfft(voltage))[5] / len(TURN)
    assert_allclose(machine.psi_m * 500.0, fundamental, rtol=1e-4)
    whole = answers.inductances[0, 0] - answers.inductances[0, 1]
    assert_allclose((machine.inductance_d + machine.inductance_q) / 2, whole, rtol=0.05)


def test_maps_and_no_load_runs_know_friction_iron_and_copper():
    design = IronLoss(factor=1.0).on_design(BearingFriction(level=0.02).on_design(drawn()))
    speed, torque = np.array([50.0, 100.0, 100.0]), np.array([1.0, 2.0, -1.0])
    found = respond("dyno_map", design, speed=speed, torque=torque, winding_T=np.full(3, 20.0))
    drag = -respond("drag", design, speed=speed)["torque"]
    assert_allclose(found["power"], torque * speed + drag * speed + 3 * 12.6e-3 * found["current"] ** 2, rtol=1e-6)
    warm = respond("dyno_map", design, speed=speed, torque=torque, winding_T=np.full(3, 120.0))
    assert np.all(warm["power"] > found["power"])
    idle = respond("no_load", design, speed=speed)
    assert_allclose(idle["power"], drag * speed)


def test_an_end_winding_adds_to_inductance_and_to_flux_with_current():
    more = replace(drawn(), end_winding_inductance=5e-6)
    before, after = respond("flux_linkage", **AT), respond("flux_linkage", more, **AT)
    for k, x in enumerate("abc"):
        assert_allclose(after[f"dpsi_{x}"] - before[f"dpsi_{x}"], 5e-6 * LOADED.currents[k])
        assert_allclose(respond("inductance", **AT)[f"l_{x}"], before[f"dpsi_{x}"] / LOADED.currents[k])
    fast = np.array([2000.0])  # reactance alone limits the current there
    ratio = respond("short_circuit", speed=fast)["current"] / respond("short_circuit", more, speed=fast)["current"]
    assert 1.02 < ratio[0] < 1.08


def test_segments_turned_against_each_other_cancel_and_return():
    """Segments half a period of cogging apart cancel it, one period turns it over, for they stand about the middle."""

    def cogging(angle):
        return respond("cogging", SteppedSkew(segments=2, angle=angle).on_design(drawn()), angle_mech=TURN)["torque"]

    before = respond("cogging", angle_mech=TURN)["torque"]
    period = 2 * np.pi / 60
    assert np.abs(cogging(period / 2)).max() < 0.2 * np.abs(before).max()
    assert_allclose(cogging(period), -before, atol=0.1 * np.abs(before).max())


def test_the_magnets_temperature_is_declared_once_or_row_by_row():
    declared = machine_of_device(DEVICE | {"magnet_temperature_degC": 82.0})
    at = {"angle_mech": TURN, "speed": np.full(len(TURN), 100.0)}
    warm = respond("back_emf", declared, **at)["v_a"]
    read = respond("back_emf", **at, magnet_T=np.full(len(TURN), 82.0))["v_a"]
    assert_allclose(warm, read, rtol=1e-9)
    again = respond("back_emf", declared, **at, magnet_T=np.full(len(TURN), 22.0))["v_a"]
    assert_allclose(again, respond("back_emf", **at)["v_a"], rtol=1e-9)


def test_keys_of_the_device():
    device = DEVICE | {"end_winding_inductance_uH": 3.0, "iron_loss_grade": "M400-50A"}
    design = machine_of_device(device)
    assert design.end_winding_inductance == pytest.approx(3e-6)
    assert design.iron_loss == iron_loss_law("M400-50A")
    with pytest.raises(WorkbenchError, match="no loss data for 'tin'"):
        machine_of_device(DEVICE | {"iron_loss_grade": "tin"})
    with pytest.raises(WorkbenchError, match="no remanence left"):
        machine_of_device(DEVICE | {"magnet_temperature_degC": 900.0})


def test_what_is_uncertain_in_every_machine():
    """Each moves its own input: the phases by 0.4 %, the ends by what half circles of a coil's width have."""
    own = {t.name: t for t in own_tolerances(drawn())}
    phases = {"resistance_a", "resistance_b", "resistance_c"}
    model = {"cogging_of_mesh", "recorder_loss", "rise_beyond_table"}
    assert set(own) == phases | model | {"end_winding_inductance"}
    assert with_tolerance(drawn(), own["recorder_loss"], 2.0).recorder_loss == pytest.approx(1.0)
    assert with_tolerance(drawn(), own["rise_beyond_table"], -1.0).rise_beyond_table == pytest.approx(0.4)
    moved = with_tolerance(drawn(), own["resistance_b"], 2.0)
    assert_allclose(moved.phase_resistance, [12.6e-3, 12.6e-3 * 1.008, 12.6e-3])
    ends = with_tolerance(drawn(), own["end_winding_inductance"], 1.0).end_winding_inductance
    assert 1e-6 < ends < 4e-6  # 4 coils of 7 turns, 11 mm wide
    declared = replace(drawn(), iron_loss=USUAL_SHEET)
    assert "iron_loss_factor" in {t.name for t in own_tolerances(declared)}
    warmer = with_tolerance(drawn(), Tolerance("magnet_temperature", 10.0, relative=False), 1.0)
    assert_allclose(warmer.magnet.remanence, 1.3 * (1 - 0.012))


def test_states_without_current_for_kinds_that_need_inductances():
    found = loaded_states(drawn(), [type("T", (), {"kind": "short_circuit", "conditions": {"speed": SPEED}})()])
    assert np.degrees([state.angle for state in found]) == pytest.approx([2.0, 6.0, 10.0])
    assert all(state.currents == (0.0, 0.0, 0.0) for state in found)


@pytest.mark.parametrize(("slots", "pairs"), [(12, 5), (12, 7), (9, 4), (6, 2)])
def test_inductances_are_the_mean_over_the_slots(slots, pairs):
    """The wave that the slots make has no mean over the angles: two of 12/10 stand at one place of its slots."""
    machine = replace(drawn().machine, slots=slots, pole_pairs=pairs)
    order = lcm(slots, 2 * pairs)
    assert abs(np.exp(1j * order * load_angles(replace(drawn(), machine=machine))).mean()) < 1e-9


OTHER = {
    **dict.fromkeys(("dry_friction", "viscous_friction", "windage", "undeclared_iron_loss", "recorder_loss"), 0.1),
    **{"iron_loss": USUAL_SHEET, "iron_loss_factor": 1.3, "shorted_turns": 1.0, "shorted_coil": 2},
    **{"phase_resistance": (0.01, 0.02, 0.03), "lead_resistance": (0.1, 0.2, 0.3), "cogging_of_mesh": 1.2},
    "end_winding_inductance": 1e-5,
}
SUMMANDS = [(kind, one) for kind, summands in KINDS.items() for one in summands if one.unseen]


@pytest.mark.parametrize(("kind", "summand"), SUMMANDS, ids=[kind for kind, _ in SUMMANDS])
def test_what_is_said_to_be_unseen_has_no_say(kind, summand):
    """To the last bit, everything that the summand does not see changed at once."""
    at = AT | {"speed": np.full(1, 50.0), "direction": np.ones(1)}
    changed = replace(drawn(), **{name: OTHER[name] for name in summand.unseen})
    as_drawn, other = (summand.answer(Answers(surrogate(), design), at) for design in (drawn(), changed))
    assert as_drawn.keys() == other.keys()
    assert all(np.array_equal(as_drawn[name], other[name]) for name in as_drawn)


@pytest.mark.parametrize("kind", ("cogging", "locked_rotor"))
def test_what_brakes_asks_for_no_field_anew(kind):
    """The torque of the field is kept; the brake alone is worked out again, and adds up."""
    model, at = replace(bench()), {**AT, "direction": np.ones(1)}
    still = model.respond(drawn(), kind, at)["torque"]
    before = model._remembered.cache_info().misses
    braked = model.respond(BearingFriction(level=0.01).on_design(drawn()), kind, at)["torque"]
    assert model._remembered.cache_info().misses == before + 1
    assert_allclose(braked - still, -0.01, rtol=1e-9)


def test_whole_numbers_are_conditions_too():
    """What is kept by its bytes must not take an integer for a float."""
    whole = {"angle_mech": np.array([0, 1, 2, 3, 5]), "speed": np.full(5, 50)}
    design = replace(drawn(), recorder_loss=0.3)  # by how far readings lie apart
    found = bench().respond(design, "back_emf", whole)
    expected = bench().respond(design, "back_emf", {name: values.astype(float) for name, values in whole.items()})
    assert all(np.array_equal(found[name], expected[name]) for name in expected)
