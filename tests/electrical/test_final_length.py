"""The length behind whole turns and teeth: each need met exactly, the hardest one decides, the limit is said."""

from math import inf

import pytest

from electrical.final_length import LENGTH_STEP, LengthNeed, final_length, length_for_damping, length_for_torque
from electrical.resistance import phase_resistance
from electrical.short_circuit import winding_damping
from units import MILLIMETRE

MM = MILLIMETRE


def test_a_torque_needs_the_length_that_gives_it():
    assert 131.0 * length_for_torque(4.86, 131.0) == pytest.approx(4.86)


@pytest.mark.parametrize("wanted", [10e3, 40e3])
def test_a_machine_of_the_length_for_a_damping_has_it(wanted):
    def damping(length):  # of a winding of 9 turns and 21 wires: the flux grows with l, the resistance with l + l_et
        resistance = phase_resistance(
            turns=9, strands=21, wire_area=0.196e-6, active_length=length, end_turn_length=16 * MM,
            coils_in_series=4, resistivity=1.68e-8,
        )  # fmt: skip
        return winding_damping(torque_constant=1.1 * length, phase_resistance=resistance, transmission_ratio=1.7e-3)

    start = {"length": 30 * MM, "end_turn_length": 16 * MM}
    assert damping(length_for_damping(wanted, reached=damping(30 * MM), **start)) == pytest.approx(wanted, rel=1e-12)


def test_the_hardest_need_decides_and_the_length_is_rounded_up():
    needs = [LengthNeed("the peak force", 20.32 * MM), LengthNeed("the damping", 17 * MM)]
    found = final_length(needs, 70 * MM)
    assert found.length == pytest.approx(20.4 * MM) and found.set_by is needs[0] and not found.short


def test_a_length_on_a_step_stays():
    assert final_length([LengthNeed("the peak force", 7 * LENGTH_STEP)], 1.0).length == pytest.approx(7 * LENGTH_STEP)


def test_what_no_length_gives_leaves_the_length_to_the_others():
    needs = [LengthNeed("the peak force", 20 * MM), LengthNeed("the continuous force", inf)]
    found = final_length(needs, 70 * MM)
    assert found.length == pytest.approx(20 * MM) and found.set_by is needs[0] and found.needs == tuple(needs)


def test_what_is_too_long_is_cut_and_said():
    found = final_length([LengthNeed("the peak force", 80 * MM)], 70 * MM)
    assert found.length == 70 * MM and found.short
