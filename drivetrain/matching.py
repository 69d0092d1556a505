"""Gearbox and motor matched over the stator radius for every slot-pole combination, and the machine to go on with.

Cross-sections come from the fits of the optima, with the overload torque as the field gives it and as it would be if
torque grew in proportion to current. Beside them: the machine that the study states, with its torques from the field
and as somebody else states them, and the chosen machine under the requirements and linkage that the study states.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import lru_cache, partial
from math import sqrt
from operator import attrgetter
from typing import ClassVar

import numpy as np

from drivetrain.finding import Finding, Sentence
from drivetrain.masses import DrawnParts, MassModel, PartMasses, PartMaterials, SteelCylinder
from drivetrain.match import (
    RATIO_SAMPLES,
    Constraints,
    CopperLoading,
    CostModel,
    CostScales,
    CostWeights,
    DampingReading,
    Infeasible,
    Match,
    MatchCurves,
    MatchError,
    MatchLimits,
    RadiusMatches,
    SizedSection,
    linear_overload,
    match,
    match_at,
    match_curves,
    match_over_radius,
    planet_clearance,
)
from drivetrain.output import Output
from drivetrain.planetary import GearboxDesign, GearLaws
from drivetrain.requirements import Linkage, Requirements
from geometry.family import Combination, MatchedMachine
from geometry.machine import Machine
from geometry.winding import star_of_slots
from magnetostatics.case import FamilyCase
from magnetostatics.model import FieldModel, FieldSolution
from magnetostatics.positions import period_points
from magnetostatics.torque import maxwell_torque
from optimisation.fits import FittedSection, SectionFits
from optimisation.polynomial_fits import FitRefused
from optimisation.states import STEPS_OVER_PERIOD
from units import MILLIMETRE

RADII = 46  # stator radii at which the matches over the radius are given
_CURVE_SAMPLES = 161  # transmission ratios of the curves
_CURVE_ENDS = 0.9, 2.2  # of the smallest allowed ratio, of the chosen ratio


class OverloadLaw:
    """Where the overload torque of a fitted cross-section comes from; the concrete laws are below."""

    name: ClassVar[str]

    def torque_per_length(self, fitted: FittedSection) -> float:
        """[Nm/m] at the overload current density."""
        raise NotImplementedError


@dataclass(frozen=True)
class FieldOverload(OverloadLaw):
    """Solved at the overload current."""

    name: ClassVar[str] = "field"

    def torque_per_length(self, fitted: FittedSection) -> float:
        """[Nm/m], see ``OverloadLaw``."""
        return fitted.torque_overload


@dataclass(frozen=True)
class LinearOverload(OverloadLaw):
    """Scaled from the nominal torque in proportion to the current (3.68), without saturation."""

    name: ClassVar[str] = "linear"

    def torque_per_length(self, fitted: FittedSection) -> float:
        """[Nm/m], see ``OverloadLaw``."""
        return fitted.torque_overload_linear


OVERLOAD_LAWS: tuple[OverloadLaw, ...] = (FieldOverload(), LinearOverload())


@dataclass(frozen=True)
class ChosenByHand:
    """What the study fixes of the machine to go on with; None where the least cost decides.

    stator_outer_radius: [m]; gear_ratio: linkage ratio over transmission ratio; active_length: [m]
    """

    slots: int | None = None
    stator_outer_radius: float | None = None
    poles: int | None = None
    gear_ratio: float | None = None
    active_length: float | None = None

    @property
    def nothing(self) -> bool:
        """Whether the least cost decides about everything."""
        return all(getattr(self, one.name) is None for one in fields(self))


@dataclass(frozen=True)
class PrintedMachine:
    """What somebody else states for the machine of the study.

    torque_nominal: per length at the nominal current density [Nm/m]; coil_side_area: A_s [m^2]
    """

    source: str
    torque_nominal: float
    coil_side_area: float


@dataclass(frozen=True)
class StatedDemands:
    """Requirements and linkage that the study states beside those that its vehicle and its front give."""

    requirements: Requirements
    linkage: Linkage


@dataclass(frozen=True)
class MatchInputs:
    """What the study fixes of the match.

    combinations: of slots and poles that are matched; resistivity: of the winding's copper at its temperature [ohm m]
    gear_stages, planets, gear_laws: of the gearbox; overload: the law that the choice rests on
    damping: which constraints are enforced; masses: densities of the parts
    by_hand: the designer's choice; printed: somebody else's numbers for the study's machine
    """

    combinations: tuple[Combination, ...]
    limits: MatchLimits
    scales: CostScales
    weights: CostWeights
    gear_stages: int
    planets: int
    gear_laws: GearLaws
    resistivity: float
    overload: OverloadLaw
    damping: DampingReading
    masses: PartMaterials
    by_hand: ChosenByHand = ChosenByHand()
    printed: PrintedMachine | None = None

    def gearbox(self, requirements: Requirements, linkage: Linkage) -> GearboxDesign:
        """The gearbox by its scaling laws, at the nominal linkage ratio."""
        return GearboxDesign(
            stage_count=self.gear_stages,
            linkage_ratio=linkage.ratio_nominal,
            force_rms=requirements.force_rms,
            velocity_rms=requirements.velocity_rms,
            laws=self.gear_laws,
            planets=self.planets,
        )


@dataclass(frozen=True)
class CombinationMatches:
    """The matches of one combination with one overload law; why there are none where ``over_radius`` is None."""

    combination: Combination
    overload: OverloadLaw
    over_radius: RadiusMatches | None
    refusal: Finding | None = None


@dataclass(frozen=True)
class NamedMatch:
    """The match of a machine that is not the chosen one, or why it has none; reason: what stands behind its numbers."""

    name: str
    reason: str
    match: Match | None
    refusal: Finding | None = None


@dataclass(frozen=True)
class MatchOutcome:
    """The chosen machine, how it was chosen, and what stands beside it.

    chosen: its match; machine: its cross-section; reason: why this one; at_edge: sentence where the least cost lies on
        an end of the investigated radii; overload: law of its overload torque
    parts: masses and inertias of its active parts at the matched length; cylinder_mass: of the thesis's solid steel
        cylinder in their place [kg]
    over_radius: matches by combination and overload law
    reference: the study's own machine with its torques from the field; printed: with somebody else's, as the thesis's
        cylinder of steel; reference_cylinder: that cylinder with the torques from the field
    stated: the chosen cross-section under stated requirements and linkage, None where they are the ones that are met
    curves: of the chosen cross-section over the transmission ratio; length_limit: largest active length [m]
    """

    chosen: Match
    machine: Machine
    overload: OverloadLaw
    reason: str
    at_edge: str | None
    parts: PartMasses
    cylinder_mass: float
    over_radius: tuple[CombinationMatches, ...]
    reference: NamedMatch
    reference_cylinder: NamedMatch | None
    printed: NamedMatch | None
    stated: NamedMatch | None
    curves: MatchCurves
    length_limit: float

    @property
    def notes(self) -> tuple[Finding, ...]:
        """What must not be overlooked: an optimum outside the range or on a bound, violated constraints."""
        edge = None if self.at_edge is None else Sentence(self.at_edge)
        return tuple(one for one in (edge, self.chosen.bound, *self.chosen.notes) if one is not None)


@dataclass(frozen=True)
class Matcher:
    """The match of one pair of requirements and linkage; masses: what a motor weighs.

    radii, ratio_samples: how many stator radii and transmission ratios are looked at before the best is refined
    """

    case: FamilyCase
    fits: SectionFits
    requirements: Requirements
    linkage: Linkage
    inputs: MatchInputs
    masses: MassModel
    radii: int = RADII
    ratio_samples: int = RATIO_SAMPLES

    @property
    def gearbox(self) -> GearboxDesign:
        """What gearboxes are sized from."""
        return self.inputs.gearbox(self.requirements, self.linkage)

    @property
    def loading(self) -> CopperLoading:
        """Copper at the nominal current."""
        return CopperLoading(self.case.nominal_density / sqrt(2), self.case.packing, self.inputs.resistivity)

    @property
    def model(self) -> CostModel:
        """What is made small."""
        return CostModel(self.masses, self.inputs.scales, self.inputs.weights)

    def section(self, combination: Combination, overload: OverloadLaw, radius: float) -> SizedSection:
        """The fitted cross-section at a stator outer radius [m]. Raises FitRefused."""
        radius = float(radius)  # numpy's would stay in every number of the artefact
        fitted = self.fits.at(combination, radius)
        machine = self.case.family.machine(combination, stator_outer_radius=radius, **fitted.dimensions)
        torques = fitted.torque_nominal, overload.torque_per_length(fitted)
        return sized_section(self.case, machine, fitted.half_slot_area, *torques)

    def constraints_without_planets(self, section: SizedSection) -> Constraints:
        """As the study asks for them."""
        return self.inputs.damping.constraints(section, self.requirements, self.inputs.limits, self.loading)

    def constraints(self, section: SizedSection) -> Constraints:
        """As the study asks for them, with planets that clear each other."""
        found, planets = self.constraints_without_planets(section), planet_clearance(self.gearbox)
        return replace(found, enforced=(*found.enforced, planets))

    def match(self, section: SizedSection) -> Match:
        """Of one cross-section. Raises Infeasible."""
        found = self.constraints(section)
        return match(
            section, enforced=found.enforced, reported=found.reported, gearbox=self.gearbox, model=self.model,
            samples=self.ratio_samples,
        )  # fmt: skip

    def match_by_hand(self, section: SizedSection) -> Match:
        """As ``match``, at the gear ratio and active length that the designer gives. Raises Infeasible, MatchError."""
        ratio, length = self.inputs.by_hand.gear_ratio, self.inputs.by_hand.active_length
        if ratio is None and length is None:
            return self.match(section)
        if ratio is None and self.inputs.gear_stages:
            raise MatchError("match.chosen_active_length_mm needs match.chosen_gear_ratio; add it")
        found, at = self.constraints(section), self.linkage.ratio_nominal / (ratio or 1.0)
        return match_at(
            section, at, length, enforced=found.enforced, reported=found.reported, gearbox=self.gearbox,
            model=self.model,
        )  # fmt: skip

    def over_radius(self, combination: Combination, overload: OverloadLaw) -> CombinationMatches:
        """Over the range of the fits."""
        try:
            low, high = self.fits.range(combination)
            self.section(combination, overload, low)  # a refused fit may have one radius only, or none
            found = match_over_radius(
                partial(self.section, combination, overload),
                np.linspace(low, high, self.radii),
                constraints_of=self.constraints,
                gearbox=self.gearbox,
                model=self.model,
                samples=self.ratio_samples,
            )
        except Infeasible as refusal:
            return CombinationMatches(combination, overload, None, refusal.finding)
        except FitRefused as refusal:
            return CombinationMatches(combination, overload, None, Sentence(str(refusal)))
        return CombinationMatches(combination, overload, found)

    def curves(self, chosen: Match) -> MatchCurves:
        """Over the transmission ratio, from below the allowed ratios to well above the chosen one."""
        found = self.constraints(chosen.section)
        ratio = np.linspace(*self._curve_ends(chosen), _CURVE_SAMPLES)
        return match_curves(
            chosen.section, ratio, enforced=found.enforced, reported=found.reported, gearbox=self.gearbox,
            model=self.model,
        )  # fmt: skip

    def _curve_ends(self, chosen: Match) -> tuple[float, float]:
        """First and last ratio of the curves [m/rad], short of where the planets vanish."""
        first, last = _CURVE_ENDS[0] * chosen.ratio_bounds[0], _CURVE_ENDS[1] * chosen.transmission_ratio
        if self.inputs.gear_stages == 0:
            return first, last
        return first, min(last, self.gearbox.largest_transmission_ratio * (1 - 1e-3))

    def named(self, name: str, reason: str, section: SizedSection) -> NamedMatch:
        """The match of one cross-section, or why it has none."""
        try:
            return NamedMatch(name, reason, self.match(section))
        except Infeasible as refusal:
            return NamedMatch(name, reason, None, refusal.finding)


def sized_section(
    case: FamilyCase, machine: Machine, coil_side_area: float, torque_nominal: float, torque_overload: float
) -> SizedSection:
    """A machine of a study as the match sees it.

    coil_side_area: [m^2]; torque_nominal, torque_overload: per length [Nm/m]
    """
    coils, pitch = _coils(machine.slots, machine.pole_pairs, case.layers, case.coil_pitch)
    return SizedSection(machine, coils, pitch, coil_side_area, torque_nominal, torque_overload)


@lru_cache
def _coils(slots: int, pole_pairs: int, layers: int, coil_pitch: int | None) -> tuple[int, int]:
    """Coils in series of a phase, and their pitch [slots]."""
    layout = star_of_slots(slots, pole_pairs, layers, coil_pitch)
    return layout.coils_in_series, layout.coil_pitch


def match_stage(
    case: FamilyCase,
    fits: SectionFits,
    requirements: Requirements,
    linkage: Linkage,
    stated: StatedDemands | None,
    inputs: MatchInputs,
    output: Output,
) -> MatchOutcome:
    """Match gearbox and motor for all slot-pole combinations and radii, and choose the machine to go on with.

    case: materials, winding and currents of the field solutions of the reference machine
    fits: of the optimised cross-sections; requirements, linkage: what is to be met
    stated: the reference machine is matched with these where they are given, and the chosen one a second time
    output: in whose words a refusal is said
    Raises MatchError where nothing can be chosen, with the key of the study to move.
    Source: thesis eqs 3.62-3.102, Figs 3.25 and 3.26.
    """
    drawn = DrawnParts(inputs.masses, case.packing)
    matcher = Matcher(case, fits, requirements, linkage, inputs, drawn, radii=RADII)
    results = tuple(matcher.over_radius(one, law) for one in inputs.combinations for law in OVERLOAD_LAWS)
    best = _least(tuple(one for one in results if one.overload == inputs.overload), output)
    chosen, reason = _choose(matcher, best, output)
    cylinder = SteelCylinder(inputs.gear_laws.density)
    beside = matcher if stated is None else replace(matcher, requirements=stated.requirements, linkage=stated.linkage)
    reference = solved_section(case, case.family.reference)
    return MatchOutcome(
        chosen=chosen,
        machine=chosen.section.machine,
        overload=inputs.overload,
        reason=reason,
        at_edge=best.at_edge,
        parts=drawn.parts(chosen.section, chosen.active_length),
        cylinder_mass=cylinder.mass(chosen.section, chosen.active_length),
        over_radius=results,
        reference=beside.named("reference machine, field torque", _SOLVED, reference),
        **_as_cylinder(replace(beside, masses=cylinder), reference),
        stated=None if stated is None else _stated(beside, chosen.section),
        curves=matcher.curves(chosen),
        length_limit=inputs.limits.active_length,
    )


def matched_machine(found: MatchOutcome) -> MatchedMachine:
    """The cross-section that was chosen."""
    return MatchedMachine(found.machine)


def _least(results: tuple[CombinationMatches, ...], output: Output) -> RadiusMatches:
    """Those of the combination with the least cost; MatchError with every reason where none has a match."""
    found = [one.over_radius for one in results if one.over_radius is not None]
    if not found:
        said = ((one.combination.words, one.refusal.words(output)) for one in results if one.refusal is not None)
        reasons = "; ".join(f"{which}: {words}" for which, words in said)
        raise MatchError(f"no slot-pole combination of sweep.slots and sweep.poles has a match: {reasons}")
    return min(found, key=lambda one: one.best.cost.total)


def _choose(matcher: Matcher, best: RadiusMatches, output: Output) -> tuple[Match, str]:
    """The designer's choice of machine, or the least cost, and why."""
    if matcher.inputs.by_hand.nothing:
        return best.best, "least cost over all radii and slot-pole combinations"
    section = _section_by_hand(matcher, best.best.section.machine)
    try:
        chosen = matcher.match_by_hand(section)
    except Infeasible as refusal:
        raise MatchError(_no_match_by_hand(section.machine, best.best, refusal.finding.words(output))) from None
    return chosen, _comparison(chosen, best)


def _no_match_by_hand(machine: Machine, best: Match, why: str) -> str:
    least = best.section.machine
    return (
        f"the machine chosen in the study file ({_words(machine)}, "
        f"{2 * machine.stator_outer_radius / MILLIMETRE:g} mm) has no match: {why}; or choose another with "
        f"match.chosen_slots and match.chosen_stator_diameter_mm, the least cost belongs to {_words(least)} and "
        f"{2 * least.stator_outer_radius / MILLIMETRE:.1f} mm"
    )


def _section_by_hand(matcher: Matcher, least: Machine) -> SizedSection:
    """The designer's cross-section; what he leaves open is that of least cost."""
    inputs, wanted = matcher.inputs, matcher.inputs.by_hand
    combination = Combination(wanted.slots or least.slots, wanted.poles or least.poles)
    radius = least.stator_outer_radius if wanted.stator_outer_radius is None else wanted.stator_outer_radius
    if combination not in inputs.combinations:
        raise MatchError(_not_swept(combination, inputs.combinations))
    low, high = matcher.fits.range(combination)
    if not low * (1 - 1e-9) <= radius <= high * (1 + 1e-9):
        first, last, found = (2 * length / MILLIMETRE for length in (low, high, radius))
        raise MatchError(
            f"match.chosen_stator_diameter_mm = {found:g} lies outside the {first:g} to {last:g} mm of "
            "sweep.stator_diameters_mm; add diameters there or choose another"
        )
    return matcher.section(combination, inputs.overload, min(max(radius, low), high))


def _not_swept(wanted: Combination, swept: tuple[Combination, ...]) -> str:
    for key, of in (("slots", attrgetter("slots")), ("poles", attrgetter("poles"))):
        counts = list(dict.fromkeys(of(one) for one in swept))
        if of(wanted) not in counts:
            return f"match.chosen_{key} = {of(wanted)} is not among sweep.{key} {counts}; add it there"
    return f"{wanted.words} of match.chosen_slots and match.chosen_poles are not swept; choose another pair"


def _words(machine: Machine) -> str:
    return Combination.of(machine).words


def _comparison(chosen: Match, best: RadiusMatches) -> str:
    own, least = chosen.section.machine, best.best.section.machine
    return (
        f"chosen in the study file ({_words(own)}, {2 * own.stator_outer_radius / MILLIMETRE:g} mm, cost "
        f"{chosen.cost.total:.3f}); the least cost, {best.best.cost.total:.3f}, belongs to {_words(least)} and "
        f"{2 * least.stator_outer_radius / MILLIMETRE:.1f} mm"
    )


_SOLVED = "the study's machine with its torques from the field solution, mean over a period"


def solved_section(case: FamilyCase, machine: Machine) -> SizedSection:
    """A machine as the match sees it, with slot area and torques from the field in the place of the fits.

    Raises GeometryError where it cannot be built.
    """
    model = case.model(machine)
    area = model.section.half_slot_area * model.section.half_slots_per_coil_side
    densities = case.nominal_density, case.overload_density
    nominal, overload = (_mean_torque(case, model, density) for density in densities)
    return sized_section(case, machine, area, nominal, overload)


def _mean_torque(case: FamilyCase, model: FieldModel, density: float) -> float:
    """The torque that optima have, mean over one electrical period [Nm/m], at an amplitude of the current [A/m^2]."""
    section = model.section
    solutions: list[FieldSolution] = []
    for point in period_points(section.machine, section.layout, density, case.packing, STEPS_OVER_PERIOD):
        solutions.append(model.solve(point, start=solutions[-1] if solutions else None))
    return case.kept * sum(maxwell_torque(solution) for solution in solutions) / len(solutions)


def _as_cylinder(matcher: Matcher, reference: SizedSection) -> dict[str, NamedMatch | None]:
    """The reference machine as the thesis's cylinder of steel, with both torques, where somebody else states one."""
    printed = matcher.inputs.printed
    if printed is None:
        return {"reference_cylinder": None, "printed": None}
    name = f"reference machine, torque stated by {printed.source}"
    solved = "reference machine, field torque, cylinder of steel"
    return {
        "reference_cylinder": matcher.named(solved, f"{_SOLVED}, as a cylinder of steel", reference),
        "printed": matcher.named(name, _stated_reason(printed), _printed_section(matcher.case, printed)),
    }


def _stated_reason(printed: PrintedMachine) -> str:
    return (
        f"the study's machine with the torque stated by {printed.source}, scaled linearly to the overload, as a "
        "cylinder of steel"
    )


def _printed_section(case: FamilyCase, printed: PrintedMachine) -> SizedSection:
    """The study's machine with somebody else's torque and slot, the torque scaled linearly to the overload."""
    overload = linear_overload(printed.torque_nominal, case.nominal_density, case.overload_density)
    machine = case.family.reference
    return sized_section(case, machine, printed.coil_side_area, printed.torque_nominal, overload)


def _stated(matcher: Matcher, section: SizedSection) -> NamedMatch:
    """The chosen cross-section under the requirements and the linkage that the study states."""
    return matcher.named("stated values", "the chosen cross-section, stated requirements and linkage", section)
