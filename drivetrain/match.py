"""Match of gearbox and motor: transmission ratio and active length of least mass, inertia and envelope.

At each transmission ratio the machine is as long as the hardest enforced constraint asks; the cost along that curve has
one minimum. Source: thesis eqs 3.62-3.102, corrected where noted.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, pi

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from drivetrain.constraints import (
    Constraint,
    LengthLimit,
    NominalForce,
    OverloadForce,
    RegenerativeDamping,
    SpeedLimit,
    damping_coefficient,
)
from drivetrain.planetary import Gearbox, GearboxDesign
from electrical.end_turn import end_turn_length
from units import MILLIMETRE

RATIO_SAMPLES = 161  # of the cost curve before the minimum is refined
PLANET_MARGIN = 1e-6  # relative distance kept from the ratio at which the planets vanish
BOUND_SLACK = 1e-6  # relative; an optimum this close to a bound counts as lying on it


class MatchError(ValueError):
    """No transmission ratio satisfies the enforced constraints; the message names them."""


@dataclass(frozen=True)
class CrossSection:
    """An optimised cross-section as the match sees it, SI units.

    torque_per_length_nominal, torque_per_length_overload: [Nm/m] at the nominal and at the overload current density.
        The second is a number of its own: from the field solution, or from ``linear_overload`` with its error.
    """

    slots: int
    coils_in_series: int  # N_c
    stator_outer_radius: float  # R_so
    rotor_outer_radius: float  # R_ro
    back_iron_width: float  # w_bi
    tooth_width: float  # w_tb
    shoe_d1: float
    shoe_d2: float
    airgap: float  # g
    half_slot_area: float  # A_s
    torque_per_length_nominal: float
    torque_per_length_overload: float

    @property
    def end_turn_length(self) -> float:
        """l_et [m], with the shoe (3.84-3.90)."""
        return end_turn_length(
            slots=self.slots,
            shoe_top_radius=self.rotor_outer_radius + self.airgap + self.shoe_d1 + self.shoe_d2,
            slot_bottom_radius=self.stator_outer_radius - self.back_iron_width,
            tooth_width=self.tooth_width,
        )


@dataclass(frozen=True)
class ActuatorRequirements:
    """Demands at the wheel in nominal and overload condition (thesis Table 3.7), magnitudes."""

    regenerative_damping: float  # Ns/m
    force_rms: float  # N
    velocity_rms: float  # m/s
    velocity_peak: float  # m/s
    force_peak: float  # N
    velocity_at_force_peak: float  # m/s
    power_peak: float  # W


@dataclass(frozen=True)
class CopperLoading:
    """Nominal RMS current density [A/m^2], packing factor k_cp, copper resistivity [ohm m] of the damping demand."""

    nominal_current_density: float
    packing: float
    resistivity: float


@dataclass(frozen=True)
class MatchLimits:
    """Bounds of the match: active length [m] (3.62) and rotor speed [rad/s] (3.63)."""

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

    def __post_init__(self):
        if not 0 <= self.inertia <= 1:
            raise ValueError(f"the inertia weight must lie between 0 and 1; found {self.inertia}")


@dataclass(frozen=True)
class Constraints:
    """Which constraints shape the design and which are only checked and reported."""

    enforced: tuple[Constraint, ...]
    reported: tuple[Constraint, ...] = ()


@dataclass(frozen=True)
class Cost:
    """Masses [kg] and the three dimensionless terms of the cost (3.98)."""

    motor_mass: float
    gearbox_mass: float
    motor_equivalent_mass: float
    gearbox_equivalent_mass: float
    radius_term: float
    inertia_term: float
    mass_term: float

    @property
    def total(self) -> float:
        """F_cost."""
        return self.radius_term + self.inertia_term + self.mass_term

    @property
    def mass(self) -> float:
        """m_tot [kg] (3.99)."""
        return self.motor_mass + self.gearbox_mass

    @property
    def equivalent_mass(self) -> float:
        """m_eq at the wheel [kg] (3.100)."""
        return self.motor_equivalent_mass + self.gearbox_equivalent_mass


@dataclass(frozen=True)
class Match:
    """The optimum for one cross-section.

    binding: the enforced constraint whose length curve the optimum lies on
    bound: sentence when the optimum lies on an end of the allowed ratios, else None
    notes: violated reported constraints and gearbox remarks, in words
    """

    section: CrossSection
    transmission_ratio: float  # m/rad
    active_length: float  # m
    cost: Cost
    gearbox: Gearbox
    binding: Constraint
    ratio_bounds: tuple[float, float]  # m/rad
    bound: str | None
    notes: tuple[str, ...]


@dataclass(frozen=True)
class MatchCurves:
    """The match over the transmission ratio, for plotting (thesis Fig. 3.25); arrays over ``ratio``."""

    ratio: np.ndarray  # m/rad
    minimum_length: dict[str, np.ndarray]  # m, by name of the constraint, enforced and reported
    active_length: np.ndarray  # m, the largest of the enforced ones
    feasible: np.ndarray  # bool, inside ratio and length bounds
    radius_term: np.ndarray
    inertia_term: np.ndarray
    mass_term: np.ndarray

    @property
    def cost(self) -> np.ndarray:
        """F_cost."""
        return self.radius_term + self.inertia_term + self.mass_term


@dataclass(frozen=True)
class RadiusMatches:
    """Matches over the stator outer radius (thesis Fig. 3.26).

    radii: [m]; matches: one per radius, None where infeasible; refusals: the reasons, None where feasible
    best: the match of least cost over the continuous radius; at_edge: sentence when that is an end of the range
    """

    radii: np.ndarray
    matches: tuple[Match | None, ...]
    refusals: tuple[str | None, ...]
    best: Match
    at_edge: str | None


def linear_overload(torque_per_length_nominal, nominal_current_density, overload_current_density):
    """Torque per length at the overload current density if torque grew in proportion, r J_oload / J_nom (3.68).

    An assumption, and a costly one: on the 85 mm, 12-slot machine of the thesis it promises 185 Nm/m at 20 A/mm^2 RMS
    where the field solution gives 146, more than a fifth too much (27 %), because the teeth saturate. Use the field
    solution unless the assumption itself is the subject.

    Torque per length [Nm/m]; current densities in one unit, both RMS or both peak.
    """
    return torque_per_length_nominal * overload_current_density / nominal_current_density


def force_constraints(section, requirements: ActuatorRequirements) -> tuple[Constraint, Constraint]:
    """Nominal and overload force of Table 3.7 for this cross-section (3.95, 3.96)."""
    return (
        NominalForce(requirements.force_rms, section.torque_per_length_nominal),
        OverloadForce(requirements.force_peak, section.torque_per_length_overload),
    )


def damping_constraint(section, requirements: ActuatorRequirements, loading: CopperLoading) -> RegenerativeDamping:
    """Regenerative damping of Table 3.7 for this cross-section (3.91, 3.97)."""
    alpha = damping_coefficient(
        torque_per_length=section.torque_per_length_nominal,
        current_density=loading.nominal_current_density,
        coils_in_series=section.coils_in_series,
        resistivity=loading.resistivity,
        packing=loading.packing,
        half_slot_area=section.half_slot_area,
    )
    return RegenerativeDamping(requirements.regenerative_damping, alpha, section.end_turn_length)


def bound_constraints(requirements: ActuatorRequirements, limits: MatchLimits) -> tuple[Constraint, Constraint]:
    """Rotor speed and active length (3.62, 3.64)."""
    return SpeedLimit(requirements.velocity_peak, limits.rotor_speed), LengthLimit(limits.active_length)


def damping_reported(section, requirements, limits: MatchLimits, loading: CopperLoading) -> Constraints:
    """Forces and bounds enforced, damping only reported: the reading that reproduces the thesis's optimum.

    Enforced, the printed damping constraint forbids the printed optimum (27.4 instead of 40 kNs/m there).
    """
    enforced = force_constraints(section, requirements) + bound_constraints(requirements, limits)
    return Constraints(enforced, (damping_constraint(section, requirements, loading),))


def damping_enforced(section, requirements, limits: MatchLimits, loading: CopperLoading) -> Constraints:
    """Forces, bounds and damping all enforced: the thesis's equations as they stand."""
    reported = damping_reported(section, requirements, limits, loading)
    return Constraints(reported.enforced + reported.reported)


def evaluate_cost(
    section: CrossSection, ratio, length, gearbox: Gearbox, density, scales: CostScales, weights: CostWeights
) -> Cost:
    """Masses and cost of one design (3.98-3.102).

    F = w_R R_so/R_lim + w_m m_eq/m_eq,max + (1 - w_m) m_tot/m_max          (3.98)
    m_em = rho pi R_so^2 l                                                  (3.101)
    m_eq,em = 1/2 rho pi R_ro^4 l / tau_t^2                                 (3.102)

    Equation 3.102 prints R_ro^2, which is not a mass. The motor is a solid steel cylinder, its rotor too.
    ratio: tau_t [m/rad]; length: l_em [m]; density: [kg/m^3]
    """
    motor_mass = density * pi * section.stator_outer_radius**2 * length
    motor_equivalent = density * pi * section.rotor_outer_radius**4 * length / ratio**2 / 2
    equivalent = motor_equivalent + gearbox.equivalent_mass
    return Cost(
        motor_mass=motor_mass,
        gearbox_mass=gearbox.mass,
        motor_equivalent_mass=motor_equivalent,
        gearbox_equivalent_mass=gearbox.equivalent_mass,
        radius_term=weights.stator_radius * section.stator_outer_radius / scales.stator_radius,
        inertia_term=weights.inertia * equivalent / scales.equivalent_mass,
        mass_term=(1 - weights.inertia) * (motor_mass + gearbox.mass) / scales.mass,
    )


def active_length(enforced: tuple[Constraint, ...], ratio):
    """Largest of the enforced minimum lengths [m] at these ratios [m/rad]."""
    return np.max([constraint.minimum_length(ratio) for constraint in enforced], axis=0)


def ratio_bounds(enforced: tuple[Constraint, ...], gearbox: GearboxDesign) -> tuple[float, float]:
    """Smallest and largest transmission ratio that the enforced constraints and the gear geometry leave [m/rad].

    Raises MatchError when they leave none, naming the constraint that asks for too much length.
    """
    low = max(constraint.minimum_ratio() for constraint in enforced)
    high = gearbox.largest_transmission_ratio * (1 - PLANET_MARGIN)
    low = low or high * PLANET_MARGIN
    longest = min(constraint.maximum_length() for constraint in enforced)
    _check_start(enforced, low, high, longest)
    if active_length(enforced, high) <= longest:
        return low, high
    return low, brentq(lambda ratio: active_length(enforced, ratio) - longest, low, high, xtol=1e-15)


def match(
    section: CrossSection,
    *,
    enforced: tuple[Constraint, ...],
    reported: tuple[Constraint, ...] = (),
    gearbox: GearboxDesign,
    scales: CostScales,
    weights: CostWeights,
) -> Match:
    """Transmission ratio and active length of least cost for one cross-section.

    enforced: constraints that shape the length curve and the bounds; at least one must ask for a length
    reported: constraints that are only checked at the optimum; a violated one becomes a sentence in ``notes``

    Scans the allowed ratios, then refines round the best sample; the ends of the range take part.
    Raises MatchError when the enforced constraints leave no ratio.
    Source: thesis, "Optimization approach" of the match, Fig. 3.25.
    """
    bounds = ratio_bounds(enforced, gearbox)
    design = _Design(section, enforced, gearbox, scales, weights)
    ratio = _minimum(design.cost_at, *bounds, RATIO_SAMPLES)
    length = float(active_length(enforced, ratio))
    box = design.gearbox_at(ratio)
    return Match(
        section=section,
        transmission_ratio=ratio,
        active_length=length,
        cost=design.evaluate(ratio),
        gearbox=box,
        binding=max(enforced, key=lambda constraint: constraint.minimum_length(ratio)),
        ratio_bounds=bounds,
        bound=_bound_sentence(ratio, bounds, enforced),
        notes=_violations(reported, ratio, length) + box.notes,
    )


def match_curves(
    section: CrossSection,
    ratio,
    *,
    enforced: tuple[Constraint, ...],
    reported: tuple[Constraint, ...] = (),
    gearbox: GearboxDesign,
    scales: CostScales,
    weights: CostWeights,
) -> MatchCurves:
    """Length curves of all constraints and cost terms over an array of transmission ratios [m/rad] (Fig. 3.25).

    The cost is given outside the bounds too, for the curve; ``feasible`` tells where it counts. Constraints without
    a length curve (speed, length) are left out of ``minimum_length``.
    """
    ratio = np.asarray(ratio, dtype=float)
    design = _Design(section, enforced, gearbox, scales, weights)
    costs = [design.evaluate(value) for value in ratio]
    lengths = {c.name: c.minimum_length(ratio) for c in enforced + reported if np.any(c.minimum_length(ratio) > 0)}
    low, high = ratio_bounds(enforced, gearbox)
    return MatchCurves(
        ratio=ratio,
        minimum_length=lengths,
        active_length=active_length(enforced, ratio),
        feasible=(ratio >= low) & (ratio <= high),
        radius_term=np.array([cost.radius_term for cost in costs]),
        inertia_term=np.array([cost.inertia_term for cost in costs]),
        mass_term=np.array([cost.mass_term for cost in costs]),
    )


def match_over_radius(
    section_at: Callable[[float], CrossSection],
    radii,
    *,
    constraints_of: Callable[[CrossSection], Constraints],
    gearbox: GearboxDesign,
    scales: CostScales,
    weights: CostWeights,
) -> RadiusMatches:
    """Matches over an array of stator outer radii [m], and the best over the continuous radius between them.

    section_at: stator outer radius [m] -> cross-section, for example from the polynomial fits
    radii: two or more, rising
    constraints_of: cross-section -> constraints, for example ``damping_reported`` with its other arguments bound
    Raises MatchError when no radius has a match.
    Source: thesis, "Optimization output" of the match, Fig. 3.26.
    """
    radii = _increasing(radii)

    def at(radius):
        section = section_at(radius)
        chosen = constraints_of(section)
        return match(section, **vars(chosen), gearbox=gearbox, scales=scales, weights=weights)

    results = [_attempt(at, radius) for radius in radii]
    matches = tuple(result if isinstance(result, Match) else None for result in results)
    refusals = tuple(result if isinstance(result, str) else None for result in results)
    if not any(matches):
        raise MatchError(f"no stator radius has a match; at {radii[0] / MILLIMETRE:g} mm: {refusals[0]}")
    best = at(_best_radius(at, radii, matches))
    return RadiusMatches(radii, matches, refusals, best, _edge_sentence(best, radii))


@dataclass(frozen=True)
class _Design:
    """Everything but the transmission ratio."""

    section: CrossSection
    enforced: tuple[Constraint, ...]
    gearbox: GearboxDesign
    scales: CostScales
    weights: CostWeights

    def gearbox_at(self, ratio) -> Gearbox:
        return self.gearbox.size(envelope_radius=self.section.stator_outer_radius, transmission_ratio=ratio)

    def evaluate(self, ratio) -> Cost:
        length = float(active_length(self.enforced, ratio))
        density = self.gearbox.laws.density
        return evaluate_cost(self.section, ratio, length, self.gearbox_at(ratio), density, self.scales, self.weights)

    def cost_at(self, ratio) -> float:
        return self.evaluate(ratio).total


def _minimum(cost, low, high, samples):
    """Position of the least cost between low and high: best sample, refined between its neighbours, ends included."""
    grid = np.linspace(low, high, samples)
    best = int(np.argmin([cost(value) for value in grid]))
    return _refine(cost, grid, best)


def _refine(cost, grid, best):
    """Least cost between the neighbours of the best sample."""
    low, high = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, len(grid) - 1)])
    inner = minimize_scalar(cost, bounds=(low, high), method="bounded", options={"xatol": 1e-9 * high})
    return min((float(inner.x), float(grid[best])), key=cost)


def _check_start(enforced, low, high, longest):
    if low > high:
        raise MatchError(
            f"the rotor speed asks for at least {low / MILLIMETRE:.4g} mm/rad, the planets vanish at "
            f"{high / MILLIMETRE:.4g} mm/rad: use fewer gear stages or allow a faster rotor"
        )
    if not active_length(enforced, high) > 0:
        raise MatchError("no enforced constraint asks for an active length; enforce a force or the damping")
    hardest = max(enforced, key=lambda constraint: constraint.minimum_length(low))
    if hardest.minimum_length(low) > longest:
        raise MatchError(
            f"{hardest.name} needs {hardest.minimum_length(low) / MILLIMETRE:.1f} mm of active length at the smallest "
            f"allowed ratio of {low / MILLIMETRE:.3f} mm/rad, the limit is {longest / MILLIMETRE:.1f} mm: relax one "
            "of the two or take a larger stator"
        )


def _bound_sentence(ratio, bounds, enforced):
    low, high = bounds
    if ratio <= low * (1 + BOUND_SLACK):
        return f"the optimum lies on the smallest allowed transmission ratio, {low / MILLIMETRE:.3f} mm/rad"
    if ratio >= high * (1 - BOUND_SLACK):
        length = active_length(enforced, high) / MILLIMETRE
        return (
            f"the optimum lies on the largest allowed transmission ratio, {high / MILLIMETRE:.3f} mm/rad "
            f"({length:.1f} mm of active length)"
        )
    return None


def _violations(reported, ratio, length):
    return tuple(filter(None, (constraint.violation(ratio, length) for constraint in reported)))


def _increasing(radii):
    radii = np.asarray(radii, dtype=float)
    if radii.ndim != 1 or len(radii) < 2 or not np.all(np.diff(radii) > 0):
        raise ValueError(f"give at least two stator radii in rising order, in metres; found {radii}")
    return radii


def _attempt(at, radius):
    """The match at this radius, or the sentence that says why there is none."""
    try:
        return at(radius)
    except MatchError as refusal:
        return str(refusal)


def _best_radius(at, radii, matches):
    def cost(radius):
        result = _attempt(at, radius)
        return inf if isinstance(result, str) else result.cost.total

    costs = [inf if result is None else result.cost.total for result in matches]
    return _refine(cost, radii, int(np.argmin(costs)))


def _edge_sentence(best, radii):
    radius = best.section.stator_outer_radius
    edges = (radii.min(), radii.max())
    if min(abs(radius - edge) / radius for edge in edges) > BOUND_SLACK:
        return None
    return (
        f"the least cost lies at {radius / MILLIMETRE:.2f} mm, an end of the investigated range "
        f"{edges[0] / MILLIMETRE:g} to {edges[1] / MILLIMETRE:g} mm; the true minimum is outside"
    )
