"""Match of gearbox and motor: transmission ratio and active length of least mass, inertia and envelope.

At each transmission ratio the machine is as long as the hardest enforced constraint asks; the cost along that curve has
one minimum. Source: thesis eqs 3.62-3.102, corrected where noted.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf, nan

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from drivetrain.constraints import (
    Constraint,
    LengthLimit,
    NominalForce,
    OverloadForce,
    PlanetClearance,
    RegenerativeDamping,
    SpeedLimit,
    Violation,
    damping_coefficient,
)
from drivetrain.finding import Finding, Sentence
from drivetrain.masses import CopperBars, MassModel
from drivetrain.output import Output
from drivetrain.planetary import Gearbox, GearboxDesign
from drivetrain.requirements import Requirements
from electrical.dq import Values
from electrical.wound_machine import machine_end_turn
from geometry.machine import Machine
from units import MILLIMETRE

RATIO_SAMPLES = 161  # of the cost curve before the minimum is refined
PLANET_MARGIN = 1e-6  # relative distance kept from the ratio at which the planets vanish
BOUND_SLACK = 1e-6  # relative; an optimum this close to a bound counts as lying on it


class MatchError(ValueError):
    """Nothing can be matched; the message says why and which key to move."""


class Infeasible(ValueError):
    """No gearbox and motor satisfy the enforced constraints; finding: which, and the key to move."""

    def __init__(self, finding: Finding) -> None:
        super().__init__(finding)
        self.finding = finding


@dataclass(frozen=True)
class SizedSection:
    """A cross-section as the match sees it: drawn, wound in principle, and with its torques; SI units.

    machine: as drawn; coils_in_series: N_c of a phase; coil_pitch: y [slots]
    coil_side_area: A_s [m^2], what the copper of one coil side shares with its insulation
    torque_per_length_nominal, torque_per_length_overload: [Nm/m] at the nominal and at the overload current density.
        The second is a number of its own: from the field solution, or from ``linear_overload`` with its error.
    """

    machine: Machine
    coils_in_series: int
    coil_pitch: int
    coil_side_area: float
    torque_per_length_nominal: float
    torque_per_length_overload: float

    @cached_property
    def end_turn_length(self) -> float:
        """l_et [m], with the shoe (3.84-3.90), of the coil pitch."""
        return machine_end_turn(self.machine, self.coil_pitch)

    def copper(self, packing: float) -> CopperBars:
        """The copper of all three phases at a packing factor k_cp."""
        return CopperBars(packing * self.coil_side_area, 6 * self.coils_in_series, self.end_turn_length)


@dataclass(frozen=True)
class CopperLoading:
    """Copper of the damping demand.

    nominal_current_density: RMS [A/m^2]; packing: factor k_cp; resistivity [ohm m]
    """

    nominal_current_density: float
    packing: float
    resistivity: float


@dataclass(frozen=True)
class MatchLimits:
    """Bounds of the match: active_length [m] (3.62) and rotor_speed [rad/s] (3.63)."""

    active_length: float
    rotor_speed: float


@dataclass(frozen=True)
class CostScales:
    """Target values that make the cost dimensionless: mass [kg], equivalent mass [kg], stator radius [m] (3.98)."""

    mass: float
    equivalent_mass: float
    stator_radius: float


@dataclass(frozen=True)
class CostWeights:
    """w_m, share of the inertia against the mass, 0 to 1, and the weight of the stator radius (3.98)."""

    inertia: float
    stator_radius: float

    def __post_init__(self) -> None:
        if not 0 <= self.inertia <= 1:
            raise ValueError(f"the inertia weight must lie between 0 and 1; found {self.inertia}")


@dataclass(frozen=True)
class CostModel:
    """How a design is valued: what its motor weighs, what counts as 1, and the weights (3.98)."""

    masses: MassModel
    scales: CostScales
    weights: CostWeights


@dataclass(frozen=True)
class Constraints:
    """Which constraints shape the design and which are only checked and reported."""

    enforced: tuple[Constraint, ...]
    reported: tuple[Constraint, ...] = ()


@dataclass(frozen=True)
class Cost:
    """Masses [kg] and the terms of the cost (3.98); radius_term, inertia_term, mass_term: dimensionless."""

    motor_mass: Values
    gearbox_mass: Values
    motor_equivalent_mass: Values
    gearbox_equivalent_mass: Values
    radius_term: float
    inertia_term: Values
    mass_term: Values

    @property
    def total(self) -> Values:
        """F_cost, dimensionless."""
        return self.radius_term + self.inertia_term + self.mass_term

    @property
    def mass(self) -> Values:
        """m_tot [kg] (3.99)."""
        return self.motor_mass + self.gearbox_mass

    @property
    def equivalent_mass(self) -> Values:
        """m_eq at the wheel [kg] (3.100)."""
        return self.motor_equivalent_mass + self.gearbox_equivalent_mass


@dataclass(frozen=True)
class Match:
    """The optimum for one cross-section.

    binding: the enforced constraint whose length curve the optimum lies on
    bound: when the optimum lies on an end of the allowed ratios, else None
    notes: violated reported constraints and gearbox remarks
    """

    section: SizedSection
    transmission_ratio: float  # m/rad
    active_length: float  # m
    cost: Cost
    gearbox: Gearbox
    binding: Constraint
    ratio_bounds: tuple[float, float]  # [m/rad]
    bound: Finding | None
    notes: tuple[Finding, ...]

    @property
    def total_cost(self) -> float:
        """F_cost, dimensionless."""
        return self.cost.total


@dataclass(frozen=True)
class LengthCurve:
    """What a constraint asks for.

    length: active length [m], (n,), over the transmission ratios of ``MatchCurves``
    """

    constraint: Constraint
    length: np.ndarray

    def name(self, output: Output) -> str:
        """Of the constraint."""
        return self.constraint.name(output)


@dataclass(frozen=True)
class MatchCurves:
    """The match over the transmission ratio, for plotting (thesis Fig. 3.25); arrays over ``ratio`` (n,)."""

    ratio: np.ndarray  # [m/rad], (n,)
    lengths: tuple[LengthCurve, ...]  # of the constraints that ask for one, enforced and reported
    active_length: np.ndarray  # [m], (n,), the largest of the enforced ones
    feasible: np.ndarray  # whether inside ratio and length bounds, (n,)
    radius_term: np.ndarray  # dimensionless, (n,)
    inertia_term: np.ndarray  # dimensionless, (n,)
    mass_term: np.ndarray  # dimensionless, (n,)

    @property
    def cost(self) -> np.ndarray:
        """F_cost, dimensionless, (n,)."""
        return self.radius_term + self.inertia_term + self.mass_term


@dataclass(frozen=True)
class RadiusMatches:
    """Matches over the stator outer radius (thesis Fig. 3.26).

    radii [m], (n,); transmission_ratio [m/rad], (n,), active_length [m], (n,), cost: dimensionless, (n,), all three NaN
        where infeasible
    refusals: the reasons, None where feasible
    best: the match of least cost over the continuous radius; at_edge: sentence when that is an end of the range
    """

    radii: np.ndarray
    transmission_ratio: np.ndarray
    active_length: np.ndarray
    cost: np.ndarray
    refusals: tuple[Finding | None, ...]
    best: Match
    at_edge: str | None


def linear_overload(
    torque_per_length_nominal: float, nominal_current_density: float, overload_current_density: float
) -> float:
    """Torque per length at the overload current density if torque grew in proportion, r J_oload / J_nom (3.68).

    An assumption, and a costly one: on the 85 mm, 12-slot machine of the thesis it promises 185 Nm/m at 20 A/mm^2 RMS
    where the field solution gives 146, more than a fifth too much (27 %), because the teeth saturate. Use the field
    solution unless the assumption itself is the subject.

    torque_per_length_nominal, linear_overload: [Nm/m]
    nominal_current_density, overload_current_density: [A/m^2], both RMS or both peak
    """
    return torque_per_length_nominal * overload_current_density / nominal_current_density


def force_constraints(section: SizedSection, requirements: Requirements) -> tuple[Constraint, Constraint]:
    """Nominal and overload force of Table 3.7 for this cross-section (3.95, 3.96)."""
    return (
        NominalForce(requirements.force_rms, section.torque_per_length_nominal),
        OverloadForce(requirements.force_peak, section.torque_per_length_overload),
    )


def damping_constraint(
    section: SizedSection, requirements: Requirements, loading: CopperLoading
) -> RegenerativeDamping:
    """Regenerative damping of Table 3.7 for this cross-section (3.91, 3.97)."""
    alpha = damping_coefficient(
        torque_per_length=section.torque_per_length_nominal,
        current_density=loading.nominal_current_density,
        coils_in_series=section.coils_in_series,
        resistivity=loading.resistivity,
        packing=loading.packing,
        coil_side_area=section.coil_side_area,
    )
    return RegenerativeDamping(requirements.maximum_damping, alpha, section.end_turn_length)


def bound_constraints(requirements: Requirements, limits: MatchLimits) -> tuple[Constraint, Constraint]:
    """Rotor speed and active length (3.62, 3.64)."""
    return SpeedLimit(requirements.velocity_peak, limits.rotor_speed), LengthLimit(limits.active_length)


def planet_clearance(gearbox: GearboxDesign) -> PlanetClearance:
    """The smallest transmission ratio at which the planets of every stage clear each other."""
    return PlanetClearance(gearbox.stage_count, gearbox.planets, gearbox.linkage_ratio)


class DampingReading:
    """Which of the thesis's constraints shape the design; the concrete readings are below."""

    def constraints(
        self, section: SizedSection, requirements: Requirements, limits: MatchLimits, loading: CopperLoading
    ) -> Constraints:
        """What is enforced and what is only reported."""
        raise NotImplementedError


@dataclass(frozen=True)
class DampingReported(DampingReading):
    """Forces and bounds enforced, damping only reported: the reading that reproduces the thesis's optimum.

    Enforced, the printed damping constraint forbids the printed optimum (27.4 instead of 40 kNs/m there).
    """

    def constraints(
        self, section: SizedSection, requirements: Requirements, limits: MatchLimits, loading: CopperLoading
    ) -> Constraints:
        """See ``DampingReading``."""
        enforced = force_constraints(section, requirements) + bound_constraints(requirements, limits)
        return Constraints(enforced, (damping_constraint(section, requirements, loading),))


@dataclass(frozen=True)
class DampingEnforced(DampingReading):
    """Forces, bounds and damping all enforced: the thesis's equations as they stand."""

    def constraints(
        self, section: SizedSection, requirements: Requirements, limits: MatchLimits, loading: CopperLoading
    ) -> Constraints:
        """See ``DampingReading``."""
        reported = DampingReported().constraints(section, requirements, limits, loading)
        return Constraints(reported.enforced + reported.reported)


def evaluate_cost(section: SizedSection, ratio: Values, length: Values, gearbox: Gearbox, model: CostModel) -> Cost:
    """Masses and cost of one design (3.98-3.100).

    F = w_R R_so/R_lim + w_m m_eq/m_eq,max + (1 - w_m) m_tot/m_max          (3.98)
    m_eq,em = J_em / tau_t^2                                                (3.102)

    ratio: tau_t [m/rad]; length: l_em [m]; model: motor mass m_em and rotor inertia J_em are those of its masses
    """
    scales, weights = model.scales, model.weights
    motor_mass, rotor_inertia = model.masses.mass_and_inertia(section, length)
    motor_equivalent = rotor_inertia / ratio**2
    equivalent = motor_equivalent + gearbox.equivalent_mass
    return Cost(
        motor_mass=motor_mass,
        gearbox_mass=gearbox.mass,
        motor_equivalent_mass=motor_equivalent,
        gearbox_equivalent_mass=gearbox.equivalent_mass,
        radius_term=weights.stator_radius * section.machine.stator_outer_radius / scales.stator_radius,
        inertia_term=weights.inertia * equivalent / scales.equivalent_mass,
        mass_term=(1 - weights.inertia) * (motor_mass + gearbox.mass) / scales.mass,
    )


def active_length(enforced: tuple[Constraint, ...], ratio: Values) -> Values:
    """Largest of the enforced minimum lengths [m] at a ratio [m/rad], of its shape."""
    longest = np.maximum.reduce([np.asarray(constraint.minimum_length(ratio)) for constraint in enforced])
    return longest if longest.ndim else longest.item()


def ratio_bounds(enforced: tuple[Constraint, ...], gearbox: GearboxDesign) -> tuple[float, float]:
    """Smallest and largest transmission ratio that the enforced constraints and the gear geometry leave [m/rad].

    Raises Infeasible when they leave none, naming the constraint that asks for too much length.
    """
    low, high = _gear_bounds(enforced, gearbox)
    longest = min(constraint.maximum_length() for constraint in enforced)
    _check_start(enforced, gearbox, low, high, longest)
    if low == high or active_length(enforced, high) <= longest:
        return low, high
    return low, brentq(lambda ratio: active_length(enforced, ratio) - longest, low, high, xtol=1e-15)


def _gear_bounds(enforced: tuple[Constraint, ...], gearbox: GearboxDesign) -> tuple[float, float]:
    """Smallest and largest transmission ratio that speed and gears leave [m/rad]; both tau_l for a direct drive."""
    least = _sets_the_smallest_ratio(enforced).minimum_ratio()
    if gearbox.stage_count == 0:
        return max(least * (1 - BOUND_SLACK), gearbox.linkage_ratio), gearbox.linkage_ratio
    high = gearbox.largest_transmission_ratio * (1 - PLANET_MARGIN)
    return least or high * PLANET_MARGIN, high


def match(
    section: SizedSection,
    *,
    enforced: tuple[Constraint, ...],
    reported: tuple[Constraint, ...] = (),
    gearbox: GearboxDesign,
    model: CostModel,
    samples: int = RATIO_SAMPLES,
) -> Match:
    """Transmission ratio and active length of least cost for one cross-section.

    enforced: constraints that shape the length curve and the bounds; at least one must ask for a length
    reported: constraints that are only checked at the optimum; a violated one is among the ``notes``
    gearbox: at the linkage that drives it; model: what is made small; samples: ratios that are scanned first

    Scans the allowed ratios, then refines round the best sample; the ends of the range take part.
    Raises Infeasible when the enforced constraints leave no ratio.
    Source: thesis, "Optimization approach" of the match, Fig. 3.25.
    """
    bounds = ratio_bounds(enforced, gearbox)
    design = _Design(section, enforced, gearbox, model)
    ratio = _minimum(design.cost_at, *bounds, samples)
    length = active_length(enforced, ratio)
    box = design.gearbox_at(ratio)
    return Match(
        section=section,
        transmission_ratio=ratio,
        active_length=length,
        cost=design.evaluate(ratio),
        gearbox=box,
        binding=max(enforced, key=lambda constraint: constraint.minimum_length(ratio)),
        ratio_bounds=bounds,
        bound=_on_bound(ratio, bounds, enforced),
        notes=(*_violations(reported, ratio, length), *(Sentence(note) for note in box.notes)),
    )


def match_at(
    section: SizedSection,
    ratio: float,
    length: float | None,
    *,
    enforced: tuple[Constraint, ...],
    reported: tuple[Constraint, ...] = (),
    gearbox: GearboxDesign,
    model: CostModel,
) -> Match:
    """The match at a transmission ratio [m/rad] and active length [m] that are given; the rest as in ``match``.

    length: None takes the shortest that the enforced constraints allow. What a given length violates is among the notes
    Raises Infeasible where speed or gears do not leave the ratio.
    """
    bounds = _gear_bounds(enforced, gearbox)
    if not bounds[0] * (1 - BOUND_SLACK) <= ratio <= bounds[1] * (1 + BOUND_SLACK):
        raise Infeasible(RatioOutside(ratio, *bounds))
    chosen = active_length(enforced, ratio) if length is None else length
    box = gearbox.size(envelope_radius=section.machine.stator_outer_radius, transmission_ratio=ratio)
    return Match(
        section=section,
        transmission_ratio=ratio,
        active_length=chosen,
        cost=evaluate_cost(section, ratio, chosen, box, model),
        gearbox=box,
        binding=max(enforced, key=lambda constraint: constraint.minimum_length(ratio)),
        ratio_bounds=bounds,
        bound=None,
        notes=(*_violations(enforced + reported, ratio, chosen), *(Sentence(note) for note in box.notes)),
    )


def match_curves(
    section: SizedSection,
    ratio: np.ndarray,
    *,
    enforced: tuple[Constraint, ...],
    reported: tuple[Constraint, ...] = (),
    gearbox: GearboxDesign,
    model: CostModel,
) -> MatchCurves:
    """Length curves of all constraints and cost terms over transmission ratios (Fig. 3.25).

    ratio: [m/rad], (n,)

    The cost is given outside the bounds too, for the curve; ``feasible`` tells where it counts. Constraints without
    a length curve (speed, length) are left out of ``lengths``.
    """
    ratio = np.asarray(ratio, dtype=float)
    design = _Design(section, enforced, gearbox, model)
    cost = design.evaluate(ratio)
    lengths = (LengthCurve(one, np.asarray(one.minimum_length(ratio))) for one in enforced + reported)
    low, high = ratio_bounds(enforced, gearbox)
    return MatchCurves(
        ratio=ratio,
        lengths=tuple(one for one in lengths if np.any(one.length > 0)),
        active_length=np.asarray(active_length(enforced, ratio)),
        feasible=(ratio >= low) & (ratio <= high),
        radius_term=np.full(len(ratio), cost.radius_term),
        inertia_term=cost.inertia_term,
        mass_term=cost.mass_term,
    )


def match_over_radius(
    section_at: Callable[[float], SizedSection],
    radii: np.ndarray,
    *,
    constraints_of: Callable[[SizedSection], Constraints],
    gearbox: GearboxDesign,
    model: CostModel,
    samples: int = RATIO_SAMPLES,
) -> RadiusMatches:
    """Matches over stator outer radii [m], and the best over the continuous radius between them.

    section_at: stator outer radius [m] -> cross-section, for example from the polynomial fits
    radii: [m], (n,), two or more, rising
    constraints_of: cross-section -> constraints, for example of a ``DampingReading``; samples: see ``match``
    Raises Infeasible when no radius has a match.
    Source: thesis, "Optimization output" of the match, Fig. 3.26.
    """
    radii = _increasing(radii)

    def at(radius: float) -> Match:
        section = section_at(radius)
        chosen = constraints_of(section)
        return match(
            section, enforced=chosen.enforced, reported=chosen.reported, gearbox=gearbox, model=model, samples=samples
        )

    results = [_attempt(at, radius) for radius in radii]
    refusals = tuple(result if isinstance(result, Finding) else None for result in results)
    ratio, length, cost = np.array([_numbers(result) for result in results]).T
    if refusals[-1] is not None and None not in refusals:
        raise Infeasible(NoRadius(float(radii[-1]), refusals[-1]))
    best = at(_best_radius(at, radii, cost))
    return RadiusMatches(radii, ratio, length, cost, refusals, best, _edge_sentence(best, radii))


@dataclass(frozen=True)
class _Design:
    """Everything but the transmission ratio."""

    section: SizedSection
    enforced: tuple[Constraint, ...]
    gearbox: GearboxDesign
    model: CostModel

    def gearbox_at(self, ratio: Values) -> Gearbox:
        radius = self.section.machine.stator_outer_radius
        return self.gearbox.size(envelope_radius=radius, transmission_ratio=ratio)

    def evaluate(self, ratio: Values) -> Cost:
        """At one ratio or at many, whose masses and terms are arrays then."""
        return evaluate_cost(
            self.section, ratio, active_length(self.enforced, ratio), self.gearbox_at(ratio), self.model
        )

    def cost_at(self, ratio: Values) -> Values:
        return self.evaluate(ratio).total


def _minimum(cost: Callable[[Values], Values], low: float, high: float, samples: int) -> float:
    """Position of the least cost between low and high: best sample, refined between its neighbours, ends included."""
    grid = np.linspace(low, high, samples)
    best = int(np.argmin(cost(grid)))
    return _refine(cost, grid, best)


def _refine(cost: Callable[[float], Values], grid: np.ndarray, best: int) -> float:
    """Least cost between the neighbours of the best sample."""
    low, high = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, len(grid) - 1)])
    inner = minimize_scalar(cost, bounds=(low, high), method="bounded", options={"xatol": 1e-9 * high})
    return min((float(inner.x), float(grid[best])), key=cost)


def _check_start(
    enforced: tuple[Constraint, ...], gearbox: GearboxDesign, low: float, high: float, longest: float
) -> None:
    """Raise Infeasible where not even the smallest allowed ratio has a machine."""
    lowest = _sets_the_smallest_ratio(enforced)
    if low > high:
        raise Infeasible(NoRatio(lowest, low, high, gearbox.stage_count))
    if not active_length(enforced, high) > 0:
        raise Infeasible(NoLength())
    hardest = max(enforced, key=lambda constraint: constraint.minimum_length(low))
    if hardest.minimum_length(low) > longest:
        raise Infeasible(TooLong(hardest, float(hardest.minimum_length(low)), longest, lowest, low))


def _sets_the_smallest_ratio(enforced: tuple[Constraint, ...]) -> Constraint:
    return max(enforced, key=lambda constraint: constraint.minimum_ratio())


def _lowers(lowest: Constraint) -> str:
    """What makes the smallest allowed ratio smaller: the key of the study and its direction."""
    return "more match.gearbox_stages" if isinstance(lowest, PlanetClearance) else "match.speed_max_rad_per_s"


def _on_bound(ratio: float, bounds: tuple[float, float], enforced: tuple[Constraint, ...]) -> Finding | None:
    low, high = bounds
    if low == high:
        return None
    if ratio <= low * (1 + BOUND_SLACK):
        return OnSmallestRatio(_sets_the_smallest_ratio(enforced), low)
    if ratio >= high * (1 - BOUND_SLACK):
        length = float(active_length(enforced, high))
        longest = min(constraint.maximum_length() for constraint in enforced)
        return OnLargestRatio(high, length, longest)
    return None


# ---- what is found --------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class NoRatio(Finding):
    """A constraint asks for a larger ratio than so many gear stages can have; least: [m/rad]; largest: [m/rad]."""

    lowest: Constraint
    least: float
    largest: float
    stage_count: int

    def words(self, output: Output) -> str:
        asked = f"the {self.lowest.name(output)} asks for at least {output.ratio(self.least)}"
        largest = output.ratio(self.largest)
        if self.stage_count == 0:
            return (
                f"{asked}, a direct drive has {largest}: allow a faster rotor (match.speed_max_rad_per_s) or take "
                "gears (match.gearbox_stages)"
            )
        return (
            f"{asked}, the planets vanish at {largest} (stage ratio 2): use fewer gear stages (match.gearbox_stages) "
            "or allow a faster rotor (match.speed_max_rad_per_s)"
        )


@dataclass(frozen=True)
class RatioOutside(Finding):
    """A given transmission ratio that speed and gears do not leave; ratio, least, largest: [m/rad]."""

    ratio: float
    least: float
    largest: float

    def words(self, output: Output) -> str:
        return (
            f"match.chosen_gear_ratio asks for a transmission ratio of {output.ratio(self.ratio)}, rotor speed and "
            f"gears leave {output.ratio(self.least)} to {output.ratio(self.largest)}"
        )


@dataclass(frozen=True)
class NoLength(Finding):
    """Nothing that is enforced needs a machine."""

    def words(self, output: Output) -> str:
        return (
            f"no enforced constraint asks for an active length; require a {output.effort}, or a damping with "
            "match.enforce_damping"
        )


@dataclass(frozen=True)
class TooLong(Finding):
    """A constraint needs more length than the longest allowed, even at the smallest ratio that the other leaves.

    needed: [m]; longest: [m]; ratio: the smallest [m/rad]
    """

    hardest: Constraint
    needed: float
    longest: float
    lowest: Constraint
    ratio: float

    def words(self, output: Output) -> str:
        return (
            f"{self.hardest.name(output)} needs {self.needed / MILLIMETRE:.1f} mm of active length at the smallest "
            f"allowed ratio of {output.ratio(self.ratio)}, set by the {self.lowest.name(output)}; the limit is "
            f"{self.longest / MILLIMETRE:.1f} mm: relax one of the two ({_lowers(self.lowest)}, match.length_max_mm) "
            "or take a larger stator (sweep.stator_diameters_mm)"
        )


@dataclass(frozen=True)
class NoRadius(Finding):
    """Not one stator radius has a match; refusal: of the largest, radius [m]."""

    radius: float
    refusal: Finding

    def words(self, output: Output) -> str:
        return f"no stator radius has a match; at {self.radius / MILLIMETRE:g} mm: {self.refusal.words(output)}"


@dataclass(frozen=True)
class OnSmallestRatio(Finding):
    """The optimum lies on the smallest allowed ratio: [m/rad]; lowest: what sets it."""

    lowest: Constraint
    ratio: float

    def words(self, output: Output) -> str:
        return (
            f"the optimum lies on the smallest allowed transmission ratio, {output.ratio(self.ratio)}, set by the "
            f"{self.lowest.name(output)} ({_lowers(self.lowest)})"
        )


@dataclass(frozen=True)
class OnLargestRatio(Finding):
    """The optimum lies on the largest allowed ratio: [m/rad]; length: of the machine there; longest: allowed [m]."""

    ratio: float
    length: float
    longest: float

    def words(self, output: Output) -> str:
        too_long = self.length >= self.longest * (1 - BOUND_SLACK)
        key = "match.length_max_mm" if too_long else "fewer match.gearbox_stages"
        return (
            f"the optimum lies on the largest allowed transmission ratio, {output.ratio(self.ratio)} "
            f"({self.length / MILLIMETRE:.1f} mm of active length; {key})"
        )


def _violations(reported: tuple[Constraint, ...], ratio: float, length: float) -> tuple[Violation, ...]:
    found = (constraint.violation(ratio, length) for constraint in reported)
    return tuple(one for one in found if one is not None)


def _increasing(radii: np.ndarray) -> np.ndarray:
    radii = np.asarray(radii, dtype=float)
    if radii.ndim != 1 or len(radii) < 2 or not np.all(np.diff(radii) > 0):
        raise ValueError(f"give at least two stator radii in rising order, in metres; found {radii}")
    return radii


def _attempt(at: Callable[[float], Match], radius: float) -> Match | Finding:
    """The match at this radius, or why there is none."""
    try:
        return at(radius)
    except Infeasible as refusal:
        return refusal.finding


def _numbers(result: Match | Finding) -> tuple[float, float, float]:
    """Transmission ratio, active length and cost; NaN where there is no match."""
    if isinstance(result, Finding):
        return nan, nan, nan
    return result.transmission_ratio, result.active_length, result.cost.total


def _best_radius(at: Callable[[float], Match], radii: np.ndarray, costs: np.ndarray) -> float:
    def cost(radius: float) -> float:
        result = _attempt(at, radius)
        return inf if isinstance(result, Finding) else result.cost.total

    with np.errstate(invalid="ignore"):  # the parabola of the search through a radius without a match
        return _refine(cost, radii, int(np.nanargmin(costs)))


def _edge_sentence(best: Match, radii: np.ndarray) -> str | None:
    radius = best.section.machine.stator_outer_radius
    edges = (radii.min(), radii.max())
    if min(abs(radius - edge) / radius for edge in edges) > BOUND_SLACK:
        return None
    which = "smaller" if abs(radius - edges[0]) < abs(radius - edges[1]) else "larger"
    low, high, diameter = (2 * length / MILLIMETRE for length in (*edges, radius))
    return (
        f"the least cost lies at a stator diameter of {diameter:.4g} mm, an end of the investigated range {low:g} to "
        f"{high:g} mm; the true minimum is outside: add {which} diameters to sweep.stator_diameters_mm"
    )
