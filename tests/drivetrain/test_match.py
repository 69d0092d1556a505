"""The match with the thesis's inputs, and the rules of the optimum."""

import re
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

from drivetrain.match import (
    CostWeights,
    DampingEnforced,
    DampingReported,
    Infeasible,
    active_length,
    damping_constraint,
    force_constraints,
    match,
    match_curves,
    match_over_radius,
    planet_clearance,
)
from drivetrain.output import Shaft, Wheel
from units import MILLIMETRE


@contextmanager
def refused(pattern):
    """What is refused, in the words of a wheel."""
    with pytest.raises(Infeasible) as caught:
        yield
    assert re.search(pattern, caught.value.finding.words(Wheel()))


def said(finding):
    return finding.words(Wheel())


def constraints_of(thesis, reading=DampingReported(), **changes):
    """The thesis's constraints with some of its parts replaced."""
    case = {**vars(thesis), **changes}
    return reading.constraints(case["section"], case["requirements"], case["limits"], case["loading"])


def run(thesis, reading=DampingReported(), **changes):
    """The thesis's match with some of its parts replaced."""
    case = {**vars(thesis), **changes}
    constraints = constraints_of(thesis, reading, **changes)
    return match(case["section"], **vars(constraints), gearbox=case["gearbox"], model=case["model"])


@pytest.fixture(scope="module")
def optimum(thesis):
    return run(thesis)


def test_optimum_of_the_thesis(optimum):
    assert optimum.transmission_ratio == pytest.approx(2.3 * MILLIMETRE, abs=0.1 * MILLIMETRE)
    assert optimum.active_length == pytest.approx(36 * MILLIMETRE, abs=1.5 * MILLIMETRE)
    assert optimum.binding.name(Wheel()) == "overload force"
    assert optimum.bound is None


def test_optimum_against_the_independent_computation(optimum):
    assert optimum.transmission_ratio / MILLIMETRE == pytest.approx(2.261, rel=0.005)
    assert optimum.active_length / MILLIMETRE == pytest.approx(35.5, rel=0.005)
    assert optimum.cost.total == pytest.approx(0.591, rel=0.002)
    assert optimum.cost.motor_mass == pytest.approx(1.57, abs=0.005)
    assert optimum.cost.gearbox_mass == pytest.approx(0.415, abs=0.001)
    assert optimum.cost.motor_equivalent_mass == pytest.approx(5.16, abs=0.015)
    assert optimum.cost.gearbox_equivalent_mass == pytest.approx(2.19 * 0.02, rel=0.05)  # with the planets' orbits


def test_violated_damping_is_reported_in_words(optimum):
    assert any(
        "regenerative damping 27." in note and "below the requirement of 40 kNs/m" in note
        for note in map(said, optimum.notes)
    )


def test_lower_bound_of_the_ratio(optimum):
    assert optimum.ratio_bounds[0] / MILLIMETRE == pytest.approx(1.299, abs=0.0005)
    assert optimum.ratio_bounds[1] == pytest.approx(70e-3 * 500 / 3 / 2614, rel=1e-9)


def test_cost_is_flat(thesis, optimum):
    """Inside a band of +-0.5 % over 2.0-2.6 mm/rad; its ends lie 0.50 and 0.61 % above the optimum."""
    cost = curves_of(thesis, np.linspace(2.0, 2.6, 31) * MILLIMETRE).cost
    middle = (cost.min() + cost.max()) / 2
    assert np.all(np.abs(cost / middle - 1) < 0.005)
    assert cost[[0, -1]] / optimum.cost.total - 1 == pytest.approx([0.0050, 0.0061], abs=1e-4)
    assert np.all(cost >= optimum.cost.total * (1 - 1e-9))


@pytest.mark.parametrize("stages, ratio", [(1, 3.94), (2, 2.26), (3, 2.15)])
def test_number_of_stages(thesis, stages, ratio):
    found = run(thesis, gearbox=replace(thesis.gearbox, stage_count=stages))
    assert found.transmission_ratio / MILLIMETRE == pytest.approx(ratio, rel=0.004)
    assert any("planets overlap" in note for note in map(said, found.notes)) == (stages == 1)


@pytest.mark.parametrize("weight, ratio", [(0.4, 1.89), (0.6, 2.72)])
def test_inertia_weight(thesis, weight, ratio):
    found = run(thesis, model=replace(thesis.model, weights=CostWeights(inertia=weight, stator_radius=0.2)))
    assert found.transmission_ratio / MILLIMETRE == pytest.approx(ratio, rel=0.004)


def test_with_the_damping_enforced_it_binds(thesis):
    found = run(thesis, DampingEnforced())
    assert found.binding.name(Wheel()) == "regenerative damping"
    assert found.transmission_ratio / MILLIMETRE == pytest.approx(1.463, rel=0.003)
    assert found.active_length / MILLIMETRE == pytest.approx(24.4, rel=0.005)
    assert found.cost.total == pytest.approx(0.653, rel=0.002)
    assert found.notes == ()


def test_swapped_targets_push_the_optimum_onto_the_length_limit(thesis):
    swapped = replace(thesis.model.scales, mass=15.0, equivalent_mass=4.0)
    found = run(thesis, model=replace(thesis.model, scales=swapped))
    assert found.transmission_ratio / MILLIMETRE == pytest.approx(4.46, abs=0.01)
    assert found.active_length == pytest.approx(70 * MILLIMETRE, rel=1e-6)
    assert "largest allowed transmission ratio" in said(found.bound)


def test_optimum_on_the_speed_limit_is_said(thesis):
    found = run(thesis, requirements=replace(thesis.requirements, velocity_peak=2618 * 2.6e-3))
    assert found.transmission_ratio == pytest.approx(2.6 * MILLIMETRE, rel=1e-6)
    assert "smallest allowed transmission ratio" in said(found.bound)


def test_field_solution_instead_of_proportion_lengthens_the_machine(thesis, optimum):
    """27 % less overload torque than eq. 3.68 promises."""
    section = replace(thesis.section, torque_per_length_overload=thesis.section.torque_per_length_overload / 1.27)
    found = run(thesis, section=section)
    assert found.active_length > 1.1 * optimum.active_length
    assert found.cost.total > optimum.cost.total


def test_the_optimum_is_the_minimum_of_the_curve(thesis, optimum):
    ratio = np.linspace(*optimum.ratio_bounds, 2001)
    curves = curves_of(thesis, ratio)
    assert curves.feasible.all()
    assert curves.cost.min() == pytest.approx(optimum.cost.total, rel=1e-6)
    assert ratio[curves.cost.argmin()] == pytest.approx(optimum.transmission_ratio, rel=2e-3)


def test_kink_between_two_binding_constraints_is_found(thesis):
    """Damping rises faster than force with the ratio: if both meet at 2 mm/rad, the optimum is the kink."""
    ratio = 2.0 * MILLIMETRE
    reported = constraints_of(thesis)
    length = active_length(reported.enforced, ratio)
    demand = damping_constraint(thesis.section, thesis.requirements, thesis.loading).capability(ratio, length)
    found = run(thesis, DampingEnforced(), requirements=replace(thesis.requirements, maximum_damping=float(demand)))
    assert found.transmission_ratio == pytest.approx(ratio, rel=1e-5)


def test_curves_for_plotting(thesis):
    ratio = np.linspace(1.0, 5.0, 9) * MILLIMETRE
    curves = curves_of(thesis, ratio)
    lengths = {one.name(Wheel()): one.length for one in curves.lengths}
    assert set(lengths) == {"nominal force", "overload force", "regenerative damping"}
    assert curves.active_length == pytest.approx(lengths["overload force"])
    names = {one.name(Shaft()) for one in curves.lengths}
    assert names == {"nominal torque", "overload torque", "regenerative damping"}
    assert curves.feasible.tolist() == [False] + [True] * 6 + [False] * 2
    assert curves.cost == pytest.approx(curves.radius_term + curves.inertia_term + curves.mass_term)


def test_a_machine_too_weak_is_refused_by_name(thesis):
    section = replace(thesis.section, torque_per_length_overload=40.0)
    with refused("overload force needs 84.9 mm"):
        run(thesis, section=section)


def test_one_stage_whose_planets_overlap_is_refused_with_a_key_that_helps(thesis):
    """The optimum of one stage, 3.94 mm/rad, needs a stage ratio of 43: three planets stop at 14.93."""
    gearbox = replace(thesis.gearbox, stage_count=1)
    enforced = (*constraints_of(thesis).enforced, planet_clearance(gearbox))
    with refused("set by the planet clearance.*more match.gearbox_stages"):
        match(thesis.section, enforced=enforced, gearbox=gearbox, model=thesis.model)


def test_planets_bind_where_the_optimum_lies_beyond_them(thesis):
    """Five planets clear each other below 4.85: two stages give 23.5, not the 75 of the optimum."""
    gearbox = replace(thesis.gearbox, planets=5)
    limits = replace(thesis.limits, active_length=200 * MILLIMETRE)
    enforced = (*constraints_of(thesis, limits=limits).enforced, planet_clearance(gearbox))
    found = match(thesis.section, enforced=enforced, gearbox=gearbox, model=thesis.model)
    assert found.transmission_ratio == pytest.approx(planet_clearance(gearbox).minimum_ratio(), rel=1e-6)
    assert "set by the planet clearance (more match.gearbox_stages)" in said(found.bound) and found.gearbox.notes == ()


def test_a_direct_drive_has_the_ratio_of_its_linkage(thesis):
    """1000 N at 5 mm/rad without gears: one ratio, its length, no gear mass; a fast wheel is refused."""
    gearbox = replace(thesis.gearbox, stage_count=0, linkage_ratio=5 * MILLIMETRE)
    small = replace(thesis.requirements, force_peak=1000.0, force_rms=100.0)
    enforced = (*constraints_of(thesis, requirements=small).enforced, planet_clearance(gearbox))
    found = match(thesis.section, enforced=enforced, gearbox=gearbox, model=thesis.model)
    assert found.transmission_ratio == 5 * MILLIMETRE and found.bound is None and found.cost.gearbox_mass == 0
    assert found.active_length == pytest.approx(1000 * 5e-3 / (500 / 3), rel=1e-9)
    fast = constraints_of(thesis, requirements=replace(small, velocity_peak=100.0)).enforced
    with refused("rotor speed asks for at least"):
        match(thesis.section, enforced=fast, gearbox=gearbox, model=thesis.model)


def test_no_damping_leaves_the_match_to_the_forces(thesis, optimum):
    found = run(thesis, DampingEnforced(), requirements=replace(thesis.requirements, maximum_damping=0.0))
    assert found.transmission_ratio == pytest.approx(optimum.transmission_ratio, rel=1e-9) and found.notes == ()


def test_a_rotor_too_slow_for_the_gears_is_refused(thesis):
    limits = replace(thesis.limits, rotor_speed=50.0)
    with refused("planets vanish"):
        run(thesis, limits=limits)


def test_nothing_enforced_that_needs_a_length_is_refused(thesis):
    reported = constraints_of(thesis)
    bounds_only = tuple(c for c in reported.enforced if c.minimum_length(1e-3) == 0)
    with refused("no enforced constraint"):
        match(thesis.section, enforced=bounds_only, gearbox=thesis.gearbox, model=thesis.model)


def test_reported_constraints_do_not_shape_the_design(thesis, optimum):
    nominal, overload = force_constraints(thesis.section, thesis.requirements)
    reported = constraints_of(thesis)
    _, _, speed, length = reported.enforced
    only_nominal = match(
        thesis.section, enforced=(nominal, speed, length), reported=(overload,), gearbox=thesis.gearbox,
        model=thesis.model,
    )  # fmt: skip
    assert only_nominal.binding is nominal
    assert "overload force" in said(only_nominal.notes[0])


def sections_over_radius(thesis):
    """Cross-sections that grow in proportion, torque per length with the square of the radius."""

    def section_at(radius):
        machine = thesis.section.machine
        scale = radius / machine.stator_outer_radius
        lengths = ("stator_outer_radius", "rotor_outer_radius", "back_iron_width", "tooth_width", "shoe_d1", "shoe_d2")
        grown = replace(machine, **{name: getattr(machine, name) * scale for name in lengths})
        squares = ("coil_side_area", "torque_per_length_nominal", "torque_per_length_overload")
        return replace(
            thesis.section, machine=grown, **{name: getattr(thesis.section, name) * scale**2 for name in squares}
        )

    return section_at


def sweep(thesis, radii):
    return match_over_radius(
        sections_over_radius(thesis),
        radii,
        constraints_of=lambda section: constraints_of(thesis, section=section),
        gearbox=thesis.gearbox,
        model=thesis.model,
    )


def test_radius_sweep_refines_the_best_radius(thesis):
    coarse = sweep(thesis, np.linspace(20, 57.5, 6) * MILLIMETRE)
    fine = sweep(thesis, np.linspace(20, 57.5, 21) * MILLIMETRE)
    assert coarse.at_edge is None
    assert coarse.best.cost.total <= np.nanmin(coarse.cost)
    assert coarse.best.cost.total == pytest.approx(fine.best.cost.total, rel=1e-6)
    at = [found.best.section.machine.stator_outer_radius for found in (coarse, fine)]
    assert at[0] == pytest.approx(at[1], rel=1e-2)


def test_radius_sweep_passes_through_the_thesis_machine(thesis, optimum):
    swept = sweep(thesis, np.array([40.0, 42.5, 45.0]) * MILLIMETRE)
    assert swept.transmission_ratio[1] == pytest.approx(optimum.transmission_ratio, rel=1e-6)


def test_radius_sweep_says_that_the_minimum_is_outside(thesis):
    edge = sweep(thesis, np.array([45.0, 50.0, 55.0]) * MILLIMETRE).at_edge
    assert "true minimum is outside: add smaller diameters to sweep.stator_diameters_mm" in edge


def test_radius_sweep_keeps_the_reason_of_an_infeasible_radius(thesis):
    swept = sweep(thesis, np.array([12.0, 35.0, 42.5]) * MILLIMETRE)
    assert np.isnan(swept.cost[0]) and "overload force needs" in said(swept.refusals[0])
    assert swept.refusals[1:] == (None, None)


def test_radius_sweep_without_any_match_is_refused(thesis):
    with refused("no stator radius has a match"):
        sweep(thesis, np.array([10.0, 12.0]) * MILLIMETRE)


def test_radius_sweep_wants_rising_radii(thesis):
    with pytest.raises(ValueError, match="rising"):
        sweep(thesis, np.array([45.0, 40.0]) * MILLIMETRE)


def test_inertia_weight_outside_its_range_is_refused():
    with pytest.raises(ValueError, match="between 0 and 1"):
        CostWeights(inertia=1.5, stator_radius=0.2)


def curves_of(thesis, ratio):
    reported = constraints_of(thesis)
    return match_curves(thesis.section, ratio, **vars(reported), gearbox=thesis.gearbox, model=thesis.model)
