"""Choice of turns and wires with the thesis's inputs, and the rules of the choice."""

from dataclasses import asdict, replace
from math import inf, pi, sqrt

import numpy as np
import pytest

from drivetrain.requirements import Requirements, Transmission, shaft_demand
from electrical.dq import DriveLimits, base_speed, peak_torque
from electrical.flux_map_machine import FluxMapMachine, FluxMapMachineError
from electrical.resistance import COPPER_RESISTIVITY_20
from electrical.synchronous_machine import SynchronousMachine
from electrical.winding_connection import SERIES_STAR
from electrical.winding_reason import choice_reason
from electrical.winding_selection import (
    PerTurnMachine,
    WindingError,
    WindingLimits,
    WindingRequirement,
    evaluate_windings,
    full_designs,
    select_winding,
    with_maximum_power,
)
from electrical.wire import Wire
from tests.electrical.wires import HALF_MILLIMETRE, given_lengths, series_star
from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE, RPM, SQUARE_MILLIMETRE

WIRE = HALF_MILLIMETRE
OVERLOAD = 20 * AMPERE_PER_SQUARE_MILLIMETRE
AMPERE_TURNS = sqrt(2) * OVERLOAD * WIRE.area * 7 * 22
LENGTH = 41 * MILLIMETRE
FLUX, INDUCTANCE = 6 / LENGTH / (7.5 * AMPERE_TURNS), 84e-6 / 49 / LENGTH  # per turn (squared) and metre
THESIS = PerTurnMachine(  # 6 Nm from 41 mm at 7 x 22 wires; 84 uH per phase; flux that of the overload
    dq=SynchronousMachine(5, FLUX, INDUCTANCE, INDUCTANCE, 0.0),
    coils_in_series=4,
    coil_side_area=98.2 * SQUARE_MILLIMETRE,
    end_turn_length=16.305 * MILLIMETRE,
)
LIMITS = WindingLimits(
    packing_limit=0.3,
    packing_tolerance=0.04,
    overload_current_density=OVERLOAD,
    dc_voltage=48.0,
    maximum_speed=15000 * RPM,
    insulated_fill=0.55,
    circulating_share=0.05,
)
# Table 3.7 at the wheel, behind 2.3 mm/rad over the whole travel.
TABLE_3_7 = Requirements(40e3, 300.0, 0.1, 37.4, 3.4, 2614.0, 1.6, 4253.0, 1343.0, 3.2)
DEMAND = shaft_demand(TABLE_3_7, Transmission(2.3 * MILLIMETRE, 2.3 * MILLIMETRE))
REQUIREMENT = WindingRequirement(DEMAND.base_speed, DEMAND.power, DEMAND.torque_peak)


WITH_90_A = replace(LIMITS, phase_current_rms=90.0)


def valued(pairs, machine=THESIS, limits=LIMITS, length=LENGTH, wire=WIRE):
    """Turns and wires in hand at the length of the thesis."""
    designs = tuple(series_star(*pair, wire) for pair in pairs)
    return evaluate_windings(machine, limits, designs, given_lengths(len(designs), length))


def chosen_of(limits, requirement=REQUIREMENT, machine=THESIS, wire=WIRE, length=LENGTH):
    """The choice among all full slots of one wire, all of one length."""
    designs = full_designs(machine.coil_side_area, (wire,), (SERIES_STAR,), limits)
    windings = evaluate_windings(machine, limits, designs, given_lengths(len(designs), length))
    return select_winding(windings, limits, requirement)


def reason_of(limits, requirement=REQUIREMENT, **others):
    return choice_reason(chosen_of(limits, requirement, **others), limits, requirement)


@pytest.fixture(scope="module")
def free_choice():
    return chosen_of(LIMITS)


@pytest.fixture(scope="module")
def limited_choice():
    return chosen_of(WITH_90_A)


def test_required_base_speed_divides_by_the_ratio():
    assert DEMAND.base_speed / RPM == pytest.approx(6643, abs=0.5)


def test_required_torque_is_force_times_ratio():
    assert REQUIREMENT.torque == pytest.approx(6.01, abs=0.005)


def test_without_a_current_limit_the_thesis_winding_is_found(free_choice):
    assert (free_choice.chosen.turns, free_choice.chosen.strands) == (4, 39)
    assert free_choice.chosen is free_choice.unrestricted
    assert "lowest current" in reason_of(LIMITS)


def test_of_equal_currents_the_fullest_slot_is_wound():
    """A thick wire leaves many turns with as many wires: copper left out would be length added."""
    needs = WindingRequirement(2000 * RPM, 1000.0, 0.0)
    choice = chosen_of(LIMITS, needs, wire=Wire(1.0 * MILLIMETRE, 1.062 * MILLIMETRE, WIRE.resistivity))
    rivals = [one for one in choice.table if one.strands == choice.chosen.strands and one.satisfies(needs)]
    assert len(rivals) > 1 and choice.chosen is max(rivals, key=lambda one: one.packing)
    assert choice.chosen.peak_torque == max(one.peak_torque for one in rivals)


def test_with_its_current_limit_the_relaxed_thesis_winding_is_found(limited_choice):
    assert (limited_choice.chosen.turns, limited_choice.chosen.strands) == (7, 22)
    assert (limited_choice.unrestricted.turns, limited_choice.unrestricted.strands) == (4, 39)


def test_the_reason_says_what_is_relaxed():
    reason = reason_of(WITH_90_A)
    for words in (
        "Relaxed: base speed from 6643 to 42",
        "power at base speed from 4253 to 26",
        "within 90.0 A RMS",
        "4 turns of 39 wires in hand, 0.5 mm, star would meet it",
        "exceeds the limit 0.3 by 2.6",
    ):
        assert words in reason


def test_only_what_is_missed_is_called_relaxed():
    reason = reason_of(WITH_90_A, replace(REQUIREMENT, base_speed=4000 * RPM))
    assert "Relaxed: power at base speed" in reason and "base speed from 4000" not in reason


@pytest.mark.parametrize(
    "turns, strands, rms, peak, base_rpm, power", [(7, 22, 86.4, 122.2, 4311, 2690), (4, 39, 153.2, 216.6, 7624, 4750)]
)
def test_numbers_of_the_thesis_windings(turns, strands, rms, peak, base_rpm, power):
    winding = with_maximum_power(THESIS, LIMITS, valued([(turns, strands)]))[0]
    assert winding.current_rms == pytest.approx(rms, abs=0.05)
    assert winding.current_peak == pytest.approx(peak, abs=0.05)
    assert winding.base_speed / RPM == pytest.approx(base_rpm, rel=0.04)
    assert winding.power_at_base_speed == pytest.approx(power, rel=0.03)
    assert 1.10 < winding.maximum_power / power < 1.20


def test_electrical_data_of_the_chosen_winding(limited_choice):
    chosen = limited_choice.chosen
    assert chosen.phase_to_phase_resistance == pytest.approx(25.0e-3, abs=0.2e-3)
    assert chosen.phase_to_phase_inductance == pytest.approx(168e-6, rel=1e-12)
    assert chosen.torque_constant == pytest.approx(49.1e-3, abs=0.05e-3)
    assert chosen.peak_torque == pytest.approx(6.0, rel=1e-12)


def test_packing_of_the_printed_windings_on_both_slot_areas():
    pairs = ((7, 22), (4, 39))
    narrow = [w.packing for w in valued(pairs)]
    larger = replace(THESIS, coil_side_area=100.45 * SQUARE_MILLIMETRE)
    drawn = [w.packing for w in valued(pairs, larger)]
    assert narrow == pytest.approx([0.308, 0.312], abs=5e-4)
    assert drawn == pytest.approx([0.301, 0.305], abs=5e-4)


def test_without_a_tolerance_the_printed_windings_do_not_fit():
    strict = replace(WITH_90_A, packing_tolerance=0.0)
    choice = chosen_of(strict)
    assert (choice.chosen.turns, choice.chosen.strands) == (7, 21)
    assert all(winding.packing <= 0.3 for winding in choice.table)
    assert "exceeds the limit" not in reason_of(strict)


def test_table_holds_every_full_slot_and_no_other(free_choice):
    fitting = {(t, n) for t in range(1, 200) for n in range(1, 200) if t * n * pi / 16 * 1e-6 <= 0.312 * 98.2e-6}
    full = {(t, max(n for u, n in fitting if u == t)) for t in {t for t, _ in fitting}}
    assert {(w.turns, w.strands) for w in free_choice.table} == full


def test_a_wire_less_in_hand_would_be_faster_but_is_no_full_slot(limited_choice):
    """Copper left out is torque left out: it does not compete, although it would win by its base speed."""
    chosen = limited_choice.chosen
    (slack,) = valued([(chosen.turns - 1, chosen.strands)])
    assert slack.base_speed > chosen.base_speed and slack.current_rms <= 90
    assert slack.peak_torque < chosen.peak_torque
    assert slack.design not in [one.design for one in limited_choice.table]


def test_more_turns_cost_base_speed_and_save_current():
    windings = valued([(4, 36), (6, 24), (8, 18), (12, 12)])
    assert np.all(np.diff([w.base_speed for w in windings]) < 0)
    assert np.all(np.diff([w.current_rms for w in windings]) < 0)
    assert [w.peak_torque for w in windings] == pytest.approx([windings[0].peak_torque] * 4, rel=1e-12)
    powers = with_maximum_power(THESIS, LIMITS, windings)
    ideal = [w.maximum_power * w.turns for w in powers]  # 1.5 psi V / L, less the copper loss
    assert ideal == pytest.approx([ideal[0]] * 4, rel=0.05)


def test_the_winding_hands_on_its_machine(limited_choice):
    machine = limited_choice.chosen.constant_parameters(pole_pairs=5)
    chosen = limited_choice.chosen
    assert machine.torque_constant == pytest.approx(chosen.torque_constant, rel=1e-12)
    assert machine.torque(0.0, chosen.current_peak) == pytest.approx(chosen.peak_torque, rel=1e-12)


def test_a_missed_peak_torque_is_said():
    assert "below the peak force requirement" in reason_of(LIMITS, length=36 * MILLIMETRE)


def test_a_hopeless_requirement_is_said():
    hopeless = WindingRequirement(9000 * RPM, 9e4, 6.0)
    assert chosen_of(WITH_90_A, hopeless).unrestricted is None
    assert "No winding of this machine" in reason_of(WITH_90_A, hopeless)


def test_a_current_limit_below_every_winding_is_refused():
    with pytest.raises(WindingError, match="smallest is 3.9"):
        chosen_of(replace(LIMITS, phase_current_rms=3.0))


def test_a_wire_thicker_than_the_slot_is_refused():
    with pytest.raises(WindingError, match="does not fit"):
        full_designs(THESIS.coil_side_area, (Wire(8e-3, 8.1e-3, COPPER_RESISTIVITY_20),), (SERIES_STAR,), LIMITS)


def test_more_ampere_turns_than_the_map_holds_are_refused():
    i = np.linspace(-0.9, 0.9, 9) * AMPERE_TURNS
    small = FluxMapMachine(5, i, i, *THESIS.dq.flux_linkage(*np.meshgrid(i, i, indexing="ij")), 0.0)
    with pytest.raises(FluxMapMachineError, match="leaves the map"):
        chosen_of(LIMITS, machine=replace(THESIS, dq=small))


def numbers(winding):
    return {name: value for name, value in asdict(winding).items() if name != "design"}


@pytest.mark.physics
def test_a_linear_map_values_windings_as_its_constant_parameters_do():
    """Turns scale currents, voltages and resistances in the same way whichever describes one turn and one metre."""
    salient = SynchronousMachine(5, FLUX, 0.8 * INDUCTANCE, 1.3 * INDUCTANCE, 0.0)
    i = np.linspace(-1.3, 1.3, 15) * AMPERE_TURNS
    mapped = FluxMapMachine(5, i, i, *salient.flux_linkage(*np.meshgrid(i, i, indexing="ij")), 0.0)
    pairs = ((4, 39), (7, 22), (11, 14))
    plain, field = (
        with_maximum_power(one, LIMITS, valued(pairs, one))
        for one in (replace(THESIS, dq=salient), replace(THESIS, dq=mapped))
    )
    for ours, theirs in zip(field, plain, strict=True):
        assert numbers(ours) == pytest.approx(numbers(theirs), rel=1e-6)
        machine = theirs.constant_parameters(5)
        limits = DriveLimits.from_dc_bus(theirs.current_peak, LIMITS.dc_voltage)
        assert base_speed(machine, limits) == pytest.approx(theirs.base_speed, rel=1e-9)
        assert peak_torque(machine, limits) == pytest.approx(theirs.peak_torque, rel=1e-9)


@pytest.mark.parametrize(
    "field, value",
    [
        ("packing_limit", 0.9),
        ("packing_tolerance", -0.1),
        ("phase_current_rms", 0.0),
        ("insulated_fill", 0.95),
        ("circulating_share", -0.1),
    ],
)
def test_impossible_limits_are_refused(field, value):
    with pytest.raises(WindingError, match="must"):
        replace(LIMITS, **{field: value})


@pytest.mark.parametrize("value", [0.0, -1.0, inf, float("nan")])
def test_impossible_machines_are_refused(value):
    with pytest.raises(WindingError, match="end_turn_length must be a positive number"):
        replace(THESIS, end_turn_length=value)
