"""Freed dimensions: derivatives, the optimum on their bounds, the rules that keep a machine buildable, the fits."""

from dataclasses import replace
from math import nan

import numpy as np
import pytest

from geometry.family import Combination
from geometry.half_cell import MeshDensity
from geometry.variables import AIRGAP, FURTHER, MAGNET_ARC, MAGNET_LENGTH, SLOT_OPENING, TOOTH_WIDTH
from geometry.winding import star_of_slots
from optimisation.build_rules import MagnetStands, WireEnters, largest_tooth_potential
from optimisation.constrained_optimum import NoOptimumError
from optimisation.design import DesignSolver, Judge
from optimisation.fits import fits_stage
from optimisation.freedom import Freedom
from optimisation.gradient_optimum import find_optimum_by_gradients
from optimisation.optima import BoundHit, Optima, Optimum, bounds_of
from optimisation.states import AlignedTooth
from optimisation.sweep import SaturationLimit
from optimisation.torque import NullTorque
from report.fits import fits_table
from report.sweep import optima_table
from study.inputs_field import field_case
from study.read import read_study
from units import MU_0

TWELVE, OUTER, LIMIT = Combination(12, 10), 42.5e-3, SaturationLimit(AlignedTooth(), 1.2)
CASE = replace(
    field_case(read_study("motorcycle")),
    density=MeshDensity(gap_edges=120, longest_gap_edge=2.0, gap_layers=1, across_iron=1.0),
)
JUDGE = Judge(CASE, AlignedTooth(), CASE.nominal_density, NullTorque())
SHARE = 0.02  # of a dimension, for the differences


@pytest.fixture(scope="module")
def apart():
    """The study's machine with magnets that do not touch and stated teeth, so that every dimension stands alone."""
    base = CASE.family.reference
    teeth = {name: getattr(base, name) for name in ("tooth_width", "shoe_d1", "shoe_d2")}
    return replace(CASE.family, magnet_arc_fraction=0.9, **teeth)


@pytest.fixture(scope="module")
def solver(apart):
    found = DesignSolver(Judge(replace(CASE, family=apart), AlignedTooth(), CASE.nominal_density, NullTorque()))
    found.design(apart.reference)
    return found


# ---- derivatives ----------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def slopes(apart, solver):
    values = np.array([one.of(apart.reference) for one in FURTHER])

    def machine(x):
        return apart.machine(TWELVE, **dict(zip((one.name for one in FURTHER), (values * (1 + x)).tolist())))

    solver.design(apart.reference)
    return solver.gradient(machine, np.full(len(FURTHER), 1e-4))


@pytest.mark.parametrize("number", range(len(FURTHER)), ids=[one.name for one in FURTHER])
def test_the_derivatives_are_those_of_differences(apart, solver, slopes, number):
    """Both of torque [Nm/m] and of the limited flux density [T], per relative change, on the moved mesh."""
    variable = FURTHER[number]
    at = variable.of(apart.reference)
    more, less = (solver.design(apart.machine(TWELVE, **{variable.name: at * (1 + s)})) for s in (SHARE, -SHARE))
    differences = (more.torque - less.torque) / (2 * SHARE), (more.limited - less.limited) / (2 * SHARE)
    assert slopes[0][number] == pytest.approx(differences[0], rel=0.03, abs=0.05)
    assert slopes[1][number] == pytest.approx(differences[1], rel=0.03, abs=2e-3)


# ---- the optimum ----------------------------------------------------------------------------------------------------


def best(freedom, start):
    return find_optimum_by_gradients(JUDGE, TWELVE, OUTER, 1.2, start, freedom)


@pytest.fixture(scope="module")
def as_swept():
    return best(Freedom(), (2.7e-3, 14.0e-3))


def test_a_freed_gap_goes_to_its_smallest_and_the_torque_rises(as_swept):
    gap = AIRGAP.between(0.4e-3, 0.8e-3)
    found = best(Freedom((gap,)), (*_place(as_swept), 0.5e-3))
    assert found.design.machine.airgap == pytest.approx(0.4e-3)
    assert found.design.torque > 1.003 * as_swept.design.torque
    assert found.design.limited == pytest.approx(1.2, rel=1e-3)


def test_a_rule_is_held_where_it_binds(as_swept):
    """A wire of 2.6 mm holds the opening above the 2 mm of the study."""
    opening = SLOT_OPENING.between(1e-3, 3e-3)
    found = best(Freedom((opening,), (WireEnters(2.6e-3),)), (*_place(as_swept), 2e-3))
    assert found.design.machine.opening_width >= 2.6e-3 * (1 - 1e-3)


def test_a_rule_that_no_design_holds_is_said(as_swept):
    opening = SLOT_OPENING.between(1e-3, 2.1e-3)
    with pytest.raises(NoOptimumError, match="a slot opening of 4.00 mm at least, through which the wire passes"):
        best(Freedom((opening,), (WireEnters(4e-3),)), (*_place(as_swept), 2e-3))


def _place(found):
    return found.design.machine.back_iron_width, found.design.machine.rotor_outer_radius


# ---- rules ----------------------------------------------------------------------------------------------------------


def test_the_shortest_magnet_by_hand():
    """850 A against a magnet of 1.15 T with its knee at 0.2 T behind 0.5 mm: 1.05 (mu_0 850 A + 0.1 mT m) / 0.95 T."""
    machine, layout = CASE.family.reference, star_of_slots(12, 5)
    rule = MagnetStands(1.15, 0.2, 1.05, 850.0 / machine.half_slot_area)
    least = 1.05 * (MU_0 * 850.0 + 0.2 * 0.5e-3) / 0.95
    assert rule.least_length(machine, layout) == pytest.approx(least, rel=1e-9)
    assert rule.room(replace(machine, magnet_length=least), layout) == pytest.approx(0.0, abs=1e-9)
    assert "1.29 mm at least" in rule.words(machine, layout)


@pytest.mark.parametrize("slots, pole_pairs, layers, expected", ((12, 5, 2, 1.0), (9, 5, 2, 1.0), (12, 2, 2, 2.0)))
def test_the_largest_tooth_potential(slots, pole_pairs, layers, expected):
    """A coil around every tooth: its own ampere-turns; full pitch with one slot per pole and phase: a coil of each
    phase around every tooth, i_a - i_b + i_c = -2 i_b."""
    assert largest_tooth_potential(star_of_slots(slots, pole_pairs, layers)) == pytest.approx(expected)


# ---- what people and the match read ---------------------------------------------------------------------------------


FREEDOM = Freedom((MAGNET_ARC.between(0.6, 0.98), TOOTH_WIDTH.between(3e-3, 8e-3), MAGNET_LENGTH.between(1e-3, 4e-3)))


def optimum(radius):
    return Optimum(
        combination=TWELVE, stator_outer_radius=radius, back_iron_width=0.07 * radius, rotor_outer_radius=0.35 * radius,
        tooth_width=0.13 * radius, half_slot_area=0.06 * radius**2, torque_nominal=3e4 * radius**2,
        torque_nominal_error=0.1, torque_nominal_ring=3e4 * radius**2, torque_overload=7e4 * radius**2,
        torque_overload_error=0.1, torque_overload_linear=1e5 * radius**2, torque_null=nan, limited=1.2,
        limit_binds=True, tooth_worst=1.5, back_iron_worst=1.4, field_solutions=20, newton_iterations=3,
        further=(0.98, 0.13 * radius, 0.06 * radius),
    )  # fmt: skip


def test_an_optimum_on_a_bound_says_which_key_to_widen():
    (hit,) = bounds_of(optimum(OUTER), FREEDOM)
    assert hit == BoundHit(TWELVE, OUTER, FREEDOM.further[0], 0.98)
    assert "the largest magnet arc over pole pitch that is allowed, 0.98: widen variables.magnet_arc_fraction" in (
        hit.sentence
    )


def test_fits_carry_what_was_freed_within_its_bounds():
    optima = Optima(LIMIT, tuple(optimum(radius) for radius in (0.035, 0.04, 0.045, 0.05)), (), (), FREEDOM)
    section = fits_stage(optima).at(TWELVE, OUTER)
    assert section.dimensions["tooth_width"] == pytest.approx(0.13 * OUTER)
    assert section.dimensions["magnet_arc_fraction"] == pytest.approx(0.98, abs=1e-12)
    machine = CASE.family.machine(TWELVE, stator_outer_radius=OUTER, **section.dimensions)
    assert (machine.magnet_length, machine.tooth_width) == pytest.approx((0.06 * OUTER, 0.13 * OUTER))
    assert optima_table(optima).magnet_length_mm[0] == pytest.approx(2.1)
    table = fits_table(fits_stage(optima)).set_index("quantity")
    assert table.p1["magnet_length_mm"] == pytest.approx(0.06) and table.p0["magnet_arc_fraction"] == pytest.approx(
        0.98
    )
