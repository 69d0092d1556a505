"""Winding and length chosen on a flux map in closed form: no field is solved."""

from dataclasses import asdict, replace
from math import inf, sqrt

import pytest

from drivetrain.requirements import shaft_demand
from electrical.dq import base_speed, mtpa_currents
from electrical.final_length import LENGTH_STEP, LengthByDensity
from electrical.short_circuit import winding_damping
from electrical.winding_selection import WindingError
from electrical.winding_stage import per_turn_machine, winding_stage
from tests.electrical.analytic_map import (
    AMPERE_TURNS,
    DEMAND,
    ERROR,
    GOOD,
    INPUTS,
    LINEAR,
    MATCHED,
    REQUIRED,
    RIPPLE,
    TRANSMISSION,
    AnyLength,
    Saturating,
    flux_map,
)
from units import MILLIMETRE

MAP = flux_map()


@pytest.fixture(scope="module")
def found():
    return winding_stage(MAP, MATCHED, DEMAND, INPUTS, GOOD)


def test_the_wound_machine_has_the_peak_force_at_the_largest_ratio(found):
    """Less the error of the mesh, and by one step of the length at most above it."""
    force = found.peak_torque / TRANSMISSION.largest
    step = LENGTH_STEP / found.wound.active_length
    assert REQUIRED.force_peak <= (1 - ERROR) * force <= REQUIRED.force_peak * (1 + step)
    assert found.length.set_by.name == "the peak torque" and not found.length.short
    assert found.wound.active_length == found.length.length


def test_the_peak_torque_is_one_number(found):
    machine = found.wound.on_map(MAP.data)
    on_map = machine.torque(*mtpa_currents(machine, found.limits.current_peak))
    assert found.peak_torque == pytest.approx(on_map, rel=1e-12) == pytest.approx(found.chosen.peak_torque, rel=1e-9)
    assert machine.torque(found.direct_current, found.quadrature_current) == pytest.approx(found.peak_torque)
    assert found.peak_torque_error == pytest.approx(ERROR * found.peak_torque)


def test_the_ripple_is_that_of_the_map_at_the_current_of_the_peak_torque(found):
    share = found.wound.equivalent_turns * found.quadrature_current / AMPERE_TURNS
    assert found.peak_torque_ripple == pytest.approx(RIPPLE * share * found.wound.active_length, rel=1e-3)


def test_constant_parameters_of_a_linear_map_are_its_own(found):
    """Turns and length scale them, and the record of the wound machine has their resistance."""
    scale = found.chosen.turns * found.wound.active_length
    expected = (scale * LINEAR.psi_m, *(found.chosen.turns * scale * LINEAR.inductance_d,) * 2)
    constant = found.constant
    assert (constant.psi_m, constant.inductance_d, constant.inductance_q) == pytest.approx(expected, rel=1e-6)
    assert constant.resistance == pytest.approx(found.wound.phase_resistance, rel=1e-12)
    assert base_speed(constant, found.limits) == pytest.approx(found.chosen.base_speed, rel=1e-6)


def test_every_neighbour_has_its_maximum_power(found):
    turns = [one.turns for one in found.near]
    assert turns == sorted(turns) and found.chosen.turns in turns
    assert all(one.maximum_power >= one.power_at_base_speed for one in found.near)
    assert {one.turns for one in found.table} > set(turns)
    assert all(one.maximum_power is None for one in found.table)


def test_saturation_makes_the_machine_longer_than_its_no_load_flux_promises():
    mapped = flux_map(Saturating())
    found = winding_stage(mapped, MATCHED, DEMAND, INPUTS, GOOD)
    promised = found.chosen.no_load_torque_constant * found.limits.current_peak
    assert found.peak_torque < 0.9 * promised
    assert (1 - ERROR) * found.peak_torque / TRANSMISSION.largest >= REQUIRED.force_peak


def test_a_damping_that_is_asked_for_is_reached():
    """20 kNs/m asked: the machine short-circuited has it, by its no-load flux at the nominal ratio."""
    wanted = 20e3
    found = winding_stage(
        MAP,
        MATCHED,
        shaft_demand(replace(REQUIRED, maximum_damping=wanted), TRANSMISSION),
        replace(INPUTS, damping_asked=True), GOOD,
    )
    reached = winding_damping(
        torque_constant=found.chosen.no_load_torque_constant,
        phase_resistance=found.wound.phase_resistance,
        transmission_ratio=TRANSMISSION.nominal,
    )
    assert reached >= wanted * (1 - 1e-9)


def test_no_damping_asks_for_no_length():
    none = replace(DEMAND, damping=0.0)
    found = winding_stage(MAP, MATCHED, none, replace(INPUTS, damping_asked=True), GOOD)
    assert found.length.set_by.name == "the peak torque"


def test_a_length_that_is_cut_does_not_make_less_copper_look_as_short():
    """All are 20 mm long then, and 110 turns of one wire just meet the speed that is asked for, with least current."""
    short = replace(INPUTS, longest=20 * MILLIMETRE)
    slow = replace(DEMAND, power=1.0)
    thin = next(one for one in winding_stage(MAP, MATCHED, slow, short, GOOD).table if one.turns == 110)
    found = winding_stage(MAP, MATCHED, replace(slow, base_speed=0.999 * thin.base_speed), short, GOOD)
    assert thin.strands == 1 and {one.active_length for one in found.table} == {20 * MILLIMETRE}
    assert found.chosen.packing > 1.3 * thin.packing and found.chosen.current_rms > thin.current_rms
    assert found.chosen.needed_length < 0.8 * thin.needed_length


def test_a_length_beyond_the_longest_is_cut_and_said():
    found = winding_stage(MAP, MATCHED, DEMAND, replace(INPUTS, longest=20 * MILLIMETRE), GOOD)
    assert found.length.short and found.wound.active_length == 20 * MILLIMETRE


def test_a_distributed_winding_has_the_longer_end_turns():
    spread = replace(flux_map(), coil_pitch=3)
    tooth, distributed = (winding_stage(one, MATCHED, DEMAND, INPUTS, GOOD).wound for one in (MAP, spread))
    assert distributed.end_turn_length > 4 * tooth.end_turn_length
    assert distributed.phase_resistance > 1.8 * tooth.phase_resistance


def test_a_current_limit_below_every_winding_names_its_key():
    limits = replace(INPUTS.limits, phase_current_rms=1.0)
    with pytest.raises(WindingError, match="winding_selection.phase_current_max_rms_A"):
        winding_stage(MAP, MATCHED, DEMAND, replace(INPUTS, limits=limits), GOOD)


def test_rows_are_of_the_overload_current(found):
    chosen = asdict(found.chosen)
    density = chosen["current_rms"] / (found.chosen.strands * found.wound.design.wire.area)
    assert density == pytest.approx(INPUTS.limits.overload_current_density)
    assert chosen["current_peak"] == pytest.approx(sqrt(2) * chosen["current_rms"])
    assert found.wound.current_peak(density) == pytest.approx(chosen["current_peak"])


def test_the_length_for_good_sets_the_length_where_it_is_the_largest():
    found = winding_stage(MAP, MATCHED, DEMAND, INPUTS, AnyLength(60 * MILLIMETRE))
    assert found.wound.active_length == pytest.approx(60 * MILLIMETRE)
    assert found.length.set_by.name == AnyLength.name and found.length.needs[0].name == "the peak torque"


def test_a_torque_for_good_that_no_length_gives_leaves_the_length_to_the_peak(found):
    hot = winding_stage(MAP, MATCHED, DEMAND, INPUTS, AnyLength(inf))
    assert hot.length.length == found.length.length and hot.length.needs[1].length == inf


def test_a_stated_density_gives_its_torque_at_the_length_for_it():
    density, machine = INPUTS.nominal_density, per_turn_machine(MAP, end_turn_length=1.0).dq
    need = LengthByDensity(machine, 3.0, density)
    found = winding_stage(MAP, MATCHED, DEMAND, INPUTS, need)
    wound = replace(found.wound, active_length=need.length(found.wound.design))
    current = wound.current_peak(density)
    on_map = wound.on_map(MAP.data)
    assert on_map.torque(*mtpa_currents(on_map, current)) == pytest.approx(3.0, rel=1e-6)
    assert found.length.needs[1].length == pytest.approx(wound.active_length, rel=1e-3) and need.density == density
    assert GOOD.density is None
