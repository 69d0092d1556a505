"""Windings for operating points, on a saturating machine in closed form: every verdict against a search by brute force.

The search here lays a grid over amplitude and angle of the current, with the flux linkages of the closed form and a
resistance by hand; it shares neither the spline nor the searches of the program.
"""

from dataclasses import replace
from math import isnan, pi, sqrt

import numpy as np
import pytest

from electrical.point_winding_stage import as_stated
from electrical.point_windings import (
    CIRCULATION,
    DENSITY,
    LINE_CURRENT,
    VOLTAGE,
    Candidate,
    OperatingPoint,
    PointValuer,
    best_of_each_kind,
    chosen_candidate,
    counts,
    needed_density,
    verdict,
)
from electrical.winding_connection import SERIES_STAR, Delta, Star, WindingConnection
from electrical.winding_selection import LimitsWithDrive, WindingError, evaluate_windings, full_designs
from electrical.winding_stage import per_turn_machine
from tests.electrical.analytic_map import AREA, OVERLOAD, POLE_PAIRS, Saturating, flux_map
from tests.electrical.wires import series_star, wire_of
from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE, RPM, SQUARE_MILLIMETRE

WIRE = wire_of(0.785 * SQUARE_MILLIMETRE)  # 39 of them fit
ERROR = 0.05  # share of the torque, plainly more than the grid of the brute force
LENGTH, END_TURN = 41 * MILLIMETRE, 16 * MILLIMETRE
LIMITS = LimitsWithDrive(
    packing_limit=0.3, packing_tolerance=0.04, overload_current_density=OVERLOAD, dc_voltage=48.0,
    maximum_speed=15000 * RPM, insulated_fill=0.55, circulating_share=0.05, phase_current_rms=70.0,
)  # fmt: skip
POINTS = (OperatingPoint(3.35, 3000 * RPM), OperatingPoint(0.8, 9000 * RPM))
MACHINE = per_turn_machine(flux_map(Saturating(), points=31), END_TURN)
GAMMA = np.linspace(0, pi / 2, 1801)


def candidates(points=POINTS, limits=LIMITS):
    return candidates_of(full_designs(AREA, (WIRE,), (SERIES_STAR,), limits), points, limits)


def candidates_of(designs, points=POINTS, limits=LIMITS):
    windings = evaluate_windings(MACHINE, limits, designs, as_stated(LENGTH, len(designs)))
    return PointValuer(MACHINE, limits, points, ERROR).candidates(windings)


def largest_torque(design, current, speed, voltage=48.0):
    """Within the line current, peak, and the bus, by brute force, on a grid of 600 amplitudes and 1801 angles [Nm]."""
    turns, copper = design.equivalent_turns, design.turns * design.strands * WIRE.area
    amplitude = np.linspace(0, current, 600)[:, None]
    i_d, i_q = -amplitude * np.sin(GAMMA), amplitude * np.cos(GAMMA)
    psi_d, psi_q = (turns * LENGTH * one for one in Saturating().flux_linkage(turns * i_d, turns * i_q))
    ohms = 2 * (LENGTH + END_TURN) * design.wire.resistivity * 4 * turns**2 / copper
    omega = POLE_PAIRS * speed
    square = (ohms * i_d - omega * psi_q) ** 2 + (ohms * i_q + omega * psi_d) ** 2
    torque = 1.5 * POLE_PAIRS * (psi_d * i_q - psi_q * i_d)
    return float(np.max(np.where(square <= voltage**2 / 3, torque, 0.0)))


@pytest.fixture(scope="module")
def valued():
    return candidates()


def of(valued, *turns):
    return [one for one in valued if one.winding.turns in turns]


def test_every_torque_is_what_brute_force_finds(valued):
    for one in of(valued, 2, 9, 19, 25):
        design = one.winding.design
        copper = design.turns * design.strands * WIRE.area
        full = sqrt(2) * min(70.0, OVERLOAD * copper / design.turns)
        for point, torque in zip(POINTS, one.torques, strict=True):
            assert torque == pytest.approx((1 - ERROR) * largest_torque(design, full, point.speed), rel=4e-3, abs=6e-3)


FAST = (OperatingPoint(0.1, 1000 * RPM), OperatingPoint(2.2, 6500 * RPM))  # the field is weakened for the second


@pytest.mark.parametrize("points", [POINTS, FAST], ids=["at the best angle", "weakened"])
def test_the_needed_current_is_the_least(points):
    """Three per mille less misses a point, as much more reaches all."""
    for one in candidates_of((series_star(9, 4, WIRE), series_star(13, 3, WIRE)), points):
        assert not one.refused_by
        for share, enough in ((0.997, False), (1.003, True)):
            torques = [largest_torque(one.winding.design, share * one.needed_current, p.speed) for p in points]
            assert all((1 - ERROR) * t >= p.torque for t, p in zip(torques, points, strict=True)) is enough


def test_each_limit_refuses_what_it_does(valued):
    """Where it is far away it refuses nothing, and what refused the others still does."""
    assert set(counts(valued)) == {VOLTAGE, LINE_CURRENT, DENSITY}
    more = {VOLTAGE: replace(LIMITS, dc_voltage=1e3), LINE_CURRENT: replace(LIMITS, phase_current_rms=1e3)}
    for by, limits in more.items():
        some = valued[::3]
        after = list(zip(some, candidates_of(tuple(one.winding.design for one in some), limits=limits), strict=True))
        assert not any(new.refused_by == by for _, new in after)
        assert all(new.refused_by == old.refused_by for old, new in after if old.refused_by not in (by, ""))
    dense = [one for one in valued if one.refused_by == DENSITY]
    for one in dense:
        assert one.winding.current_rms < 70 and one.winding.peak_torque * (1 - ERROR) < 3.35
        assert isnan(one.needed_current)
        assert one.refusal.startswith("current density: ") and one.refusal.endswith("asked are 3.35 Nm at 3000 rpm")


def test_the_lowest_current_of_those_with_about_the_least_loss_is_chosen(valued):
    chosen = chosen_candidate(valued, POINTS)
    allowed = [one for one in valued if not one.refused_by]

    def loss(one):
        copper = one.winding.design.turns * one.winding.design.strands * WIRE.area
        turn = 2 * (LENGTH + END_TURN) * one.winding.design.wire.resistivity / copper
        return 1.5 * turn * 4 * (one.winding.design.equivalent_turns * one.needed_current) ** 2

    assert loss(chosen) == pytest.approx(chosen.copper_loss, rel=1e-9)
    least = min(map(loss, allowed))
    rivals = [one for one in allowed if loss(one) <= 1.05 * least]
    assert chosen.needed_current == min(one.needed_current for one in rivals)
    assert len(rivals) < len(allowed) and chosen in rivals
    said = {verdict(one, valued, chosen) for one in allowed}
    assert "chosen" in said and any("more copper loss than the least" in one for one in said)
    assert any("more current" in one for one in said)


def test_turns_trade_current_for_voltage_exactly():
    """Half the turns of twice the wires: twice the current, at half the voltage the same torque and loss."""
    whole, half = series_star(16, 2, WIRE), series_star(8, 4, WIRE)
    limits = replace(LIMITS, phase_current_rms=1e3)
    low = (OperatingPoint(2.8, 4000 * RPM),)
    (one,) = candidates_of((whole,), low, limits)
    (other,) = candidates_of((half,), low, replace(limits, dc_voltage=24.0))
    assert one.winding.base_speed < low[0].speed, "the field is weakened"
    assert other.needed_current == pytest.approx(2 * one.needed_current, rel=1e-9)
    assert other.torques == pytest.approx(one.torques, rel=1e-9)
    assert (other.copper_loss, needed_density(other)) == pytest.approx((one.copper_loss, needed_density(one)), rel=1e-9)


def test_paths_and_delta_are_turns_of_the_equivalent_star():
    """Two paths of 18 turns are as one of 9; of equal ones the fewest paths are chosen."""
    two_paths = series_star(18, 2, WIRE, WindingConnection(2, Star()))
    slow = (OperatingPoint(3.35, 1000 * RPM),)
    one, two = candidates_of((series_star(9, 4, WIRE), two_paths), slow)
    assert (two.torques, two.needed_current) == (pytest.approx(one.torques), pytest.approx(one.needed_current))
    assert chosen_candidate((two, one), slow) == one
    assert verdict(two, (one, two), one) == "as good, with more paths, wires or in delta"


def test_a_delta_with_much_circulation_is_refused(valued):
    delta = replace(of(valued, 7)[0].winding, circulating_share=0.2)
    delta = replace(delta, design=replace(delta.design, connection=WindingConnection(1, Delta())))
    (one,) = PointValuer(MACHINE, LIMITS, POINTS, ERROR).candidates((delta,))
    assert one.refused_by == CIRCULATION and "20.0 % of the copper loss" in one.refusal
    with pytest.raises(WindingError, match="allow star or raise delta_circulating_loss_max"):
        chosen_candidate((one,), POINTS)


def test_the_best_of_each_kind_is_one_that_reaches_or_the_nearest(valued):
    ((best),) = best_of_each_kind(valued, POINTS)
    assert best == chosen_candidate(valued, POINTS)
    high = candidates(points=(OperatingPoint(20.0, 1000 * RPM),))
    (near,) = best_of_each_kind(high, (OperatingPoint(20.0, 1000 * RPM),))
    assert near.torques[0] == max(one.torques[0] for one in high)


HELP = {
    VOLTAGE: (OperatingPoint(3.0, 2e5 * RPM), replace(LIMITS, phase_current_rms=1e3), r"raise dc_bus_voltage_V in"),
    DENSITY: (OperatingPoint(9.0, 1000 * RPM), LIMITS, "raise j_overload_rms_A_per_mm2 or packing_factor"),
    LINE_CURRENT: (
        OperatingPoint(2.0, 9000 * RPM), replace(LIMITS, phase_current_rms=2.0), r"raise line_current_peak_A in"
    ),
}  # fmt: skip


@pytest.mark.parametrize("by", HELP)
def test_where_none_will_do_one_sentence_says_what_would_help(by):
    point, limits, words = HELP[by]
    with pytest.raises(WindingError, match=words) as caught:
        chosen_candidate(candidates((point,), limits), (point,))
    text = str(caught.value)
    assert f"refused by {by}: " in text and f"asked are {point}" in text and "\n" not in text


def test_a_winding_carries_what_copper_or_drive_allows_whichever_is_less(valued):
    few, many = of(valued, 3)[0].winding, of(valued, 12)[0].winding
    assert few.current_rms == pytest.approx(70.0) and many.current_rms < 70
    density = many.current_rms * 12 / many.design.copper_area
    assert density == pytest.approx(20 * AMPERE_PER_SQUARE_MILLIMETRE)
    assert isinstance(of(valued, 12)[0], Candidate)
