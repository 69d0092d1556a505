"""Radius, slots, poles, active length, transmission ratio and linkage chosen together, not one after the other.

Four objectives: mass, equivalent mass, regenerative damping and loss on the road. The machine is its polynomials over
the stator radius with the masses of its drawn parts, the gearbox its scaling laws, as in the match; the constraints are
those of the match.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import gamma, inf, pi, sqrt

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.problem import Problem
from pymoo.optimize import minimize
from scipy.optimize import differential_evolution

from drivetrain.constraints import RegenerativeDamping
from drivetrain.masses import MassModel
from drivetrain.match import (
    Constraints,
    CopperLoading,
    CostModel,
    CostScales,
    CostWeights,
    SizedSection,
    evaluate_cost,
    planet_clearance,
)
from drivetrain.pareto import non_dominated
from drivetrain.planetary import GearboxDesign, GearboxError
from geometry.family import Combination
from losses.iron import FrequencyTerms

OBJECTIVES = ("mass", "equivalent mass", "damping", "loss")
AIMS = 4  # costs of a front
_SIGNS = np.array([1.0, 1.0, -1.0, 1.0])  # all are made small but the damping
_NO_COST = (CostScales(1.0, 1.0, 1.0), CostWeights(0.5, 0.0))
_FEASIBLE = 1e-6  # relative; a limit exceeded by less is kept
_PENALTY = 1e3  # above every cost
_SEED, _GENERATIONS = 1, 150  # of the search for one objective


@dataclass(frozen=True)
class RoadSection(SizedSection):
    """A cross-section with the loss that its turning rotor causes without current; idle: iron and magnets [W/m]."""

    idle: FrequencyTerms

    @classmethod
    def of(cls, section: SizedSection, idle: FrequencyTerms) -> RoadSection:
        """A cross-section of the match with its idle loss."""
        return cls(**{one.name: getattr(section, one.name) for one in fields(SizedSection)}, idle=idle)


@dataclass(frozen=True)
class RoadDemand:
    """Working point on the road at the wheel, force_rms [N] and velocity_rms [m/s]; copper of the winding."""

    force_rms: float
    velocity_rms: float
    copper: CopperLoading


@dataclass(frozen=True)
class WholeDesign:
    """One design, SI: slots, poles, stator outer radius, active length, tau_t and nominal linkage ratio [m/rad]."""

    combination: Combination
    stator_outer_radius: float
    active_length: float
    transmission_ratio: float
    linkage_ratio: float


@dataclass(frozen=True)
class Values:
    """What a design is worth.

    objectives: in the order of OBJECTIVES [kg, kg, Ns/m, W], on a shaft [kg, kg m^2, Nms/rad, W]
    constraints: relative, satisfied at or below 0
    """

    objectives: tuple[float, ...]
    constraints: tuple[float, ...]

    @property
    def feasible(self) -> bool:
        """Whether every constraint holds."""
        return max(self.constraints) <= _FEASIBLE


@dataclass(frozen=True)
class RatedDesign:
    """A design and its values, objectives [kg, kg, Ns/m, W] and constraints."""

    design: WholeDesign
    values: Values


class Aims:
    """What a front is searched for; the concrete aims give costs and say themselves in words."""

    words: str

    def costs(self, problem: WholeProblem, rated: RatedDesign) -> tuple[float, ...]:
        """Of one design, (AIMS,), all to be made small, in units of their own."""
        raise NotImplementedError


@dataclass(frozen=True)
class RequirementAims(Aims):
    """The OBJECTIVES: mass, equivalent mass, damping and loss."""

    words = "what the requirements ask for: mass, inertia, damping and loss"

    def costs(self, problem: WholeProblem, rated: RatedDesign) -> tuple[float, ...]:
        """[kg, kg, Ns/m, W], on a shaft [kg, kg m^2, Nms/rad, W], (4,), the damping negative."""
        return tuple((_SIGNS * rated.values.objectives).tolist())


@dataclass(frozen=True)
class WholeProblem:
    """What a design is judged by.

    section_at: (combination, stator outer radius [m]) -> ``SizedSection``, for example from the polynomial fits
    combinations: of slots and poles; radii: range of the stator outer radius [m] for each
    lengths: range of the active length [m]
    linkage_ratios: smallest and largest nominal ratio of the linkages that may be built [m/rad]
    constraints_of: as in ``match_over_radius``, without that on the planets, which depends on the linkage
    gearbox: at any linkage ratio, which the design replaces; masses: what a motor weighs
    damping_of: section -> its ``RegenerativeDamping``; loss_of: (section, design) -> loss on the road [W]
    machine_of: design -> its ``RoadMachine`` by the fits
    targets: largest mass and equivalent mass [kg]; a design must also have the damping that is asked for
    aims: of the front
    """

    section_at: Callable[[Combination, float], SizedSection]
    combinations: tuple[Combination, ...]
    radii: tuple[tuple[float, float], ...]
    lengths: tuple[float, float]
    linkage_ratios: tuple[float, float]
    constraints_of: Callable[[SizedSection], Constraints]
    gearbox: GearboxDesign
    masses: MassModel
    damping_of: Callable[[SizedSection], RegenerativeDamping]
    loss_of: Callable[[SizedSection, WholeDesign], float]
    machine_of: Callable[[WholeDesign], RoadMachine]
    targets: tuple[float, float]
    aims: Aims = RequirementAims()

    @cached_property
    def ratios(self) -> tuple[float, float]:
        """Range of the transmission ratio [m/rad]: from the fastest rotor or touching planets to stages of ratio 2."""
        section = self.section_at(self.combinations[0], sum(self.radii[0]) / 2)
        least = [one.minimum_ratio() for one in self.constraints_of(section).enforced]
        least.append(planet_clearance(self._box(self.linkage_ratios[0])).minimum_ratio())
        high = self._box(self.linkage_ratios[1]).largest_transmission_ratio
        return max(least) or high * _FEASIBLE, high

    def _box(self, linkage_ratio: float) -> GearboxDesign:
        return replace(self.gearbox, linkage_ratio=linkage_ratio)

    def design(self, unit: np.ndarray, combination: Combination | None = None) -> WholeDesign:
        """From unit, fractions 0 ... 1, (5,), for combination, radius, length, ratio (logarithmic) and linkage.

        combination: in the place of the first fraction
        """
        count = len(self.combinations)
        number = min(int(unit[0] * count), count - 1) if combination is None else self.combinations.index(combination)
        (low, high), linkage = self.ratios, _between(self.linkage_ratios, unit[4])
        return WholeDesign(
            self.combinations[number],
            _between(self.radii[number], unit[1]),
            _between(self.lengths, unit[2]),
            linkage if self.gearbox.stage_count == 0 else float(low * (high / low) ** unit[3]),
            linkage,
        )

    def unit(self, design: WholeDesign) -> np.ndarray:
        """The inverse of ``design``: fractions 0 ... 1, (5,)."""
        number, (low, high) = self.combinations.index(design.combination), self.ratios
        return np.array(
            [
                (number + 0.5) / len(self.combinations),
                _share(self.radii[number], design.stator_outer_radius),
                _share(self.lengths, design.active_length),
                np.log(design.transmission_ratio / low) / np.log(high / low),
                _share(self.linkage_ratios, design.linkage_ratio),
            ]
        )

    def rated(self, design: WholeDesign) -> RatedDesign:
        """A design with its values by the fits."""
        return RatedDesign(design, self.values(design))

    def costs(self, rated: Sequence[RatedDesign]) -> np.ndarray:
        """What the front makes small, (designs, AIMS), in the units of the aims; infinite for what cannot be built."""
        built = [np.isfinite(one.values.objectives).all() for one in rated]
        none = (inf,) * AIMS
        return np.array([self.aims.costs(self, one) if can else none for one, can in zip(rated, built, strict=True)])

    def values(self, design: WholeDesign, section: SizedSection | None = None) -> Values:
        """Objectives [kg, kg, Ns/m, W] and constraints.

        section: in the place of the fits, such as one solved by the field
        """
        section = section or self.section_at(design.combination, design.stator_outer_radius)
        ratio, length, box = design.transmission_ratio, design.active_length, self._box(design.linkage_ratio)
        limits = self._limits(section, box, ratio, length)
        try:
            gears = box.size(envelope_radius=section.machine.stator_outer_radius, transmission_ratio=ratio)
        except GearboxError:
            return Values((inf, inf, -inf, inf), (*limits, 1.0, 1.0, 1.0))
        cost = evaluate_cost(section, ratio, length, gears, CostModel(self.masses, *_NO_COST))
        damping = self.damping_of(section)
        reached = float(damping.capability(ratio, length))
        found = (float(cost.mass), float(cost.equivalent_mass), reached, float(self.loss_of(section, design)))
        wanted = (found[0] / self.targets[0] - 1, found[1] / self.targets[1] - 1, damping.damping / reached - 1)
        return Values(found, (*limits, *wanted))

    def _limits(
        self, section: SizedSection, box: GearboxDesign, ratio: float, length: float
    ) -> tuple[float, float, float]:
        """What is missing in length, what is too long, and what is missing in ratio, relative."""
        enforced = (*self.constraints_of(section).enforced, planet_clearance(box))
        needed = max(float(one.minimum_length(ratio)) for one in enforced)
        longest = min(one.maximum_length() for one in enforced)
        least = max(one.minimum_ratio() for one in enforced)
        return needed / length - 1, length / longest - 1, least / ratio - 1


def _between(ends: tuple[float, float], share: float) -> float:
    return float(ends[0] + share * (ends[1] - ends[0]))


def _share(ends: tuple[float, float], value: float) -> float:
    return (value - ends[0]) / (ends[1] - ends[0]) if ends[1] > ends[0] else 0.0


@dataclass(frozen=True)
class RoadMachine:
    """The machine of a design as a ride needs it, by the fits.

    peak_torque: at the overload current density [Nm]; copper: loss over squared torque [W/(Nm)^2]; pole_pairs
    idle: loss of iron and magnets over the electrical frequency of the turning rotor, whole machine [W]
    """

    peak_torque: float
    copper: float
    pole_pairs: int
    idle: FrequencyTerms


def road_machine(section: RoadSection, design: WholeDesign, copper: CopperLoading) -> RoadMachine:
    """Of a design; copper: of the winding. The torque is proportional to the current, as in ``road_loss``."""
    length = design.active_length
    density = copper.nominal_current_density / (section.torque_per_length_nominal * length)  # per Nm
    heat = section.copper(copper.packing).volume(length) * copper.resistivity * density**2
    idle = FrequencyTerms(*(length * getattr(section.idle, one.name) for one in fields(FrequencyTerms)))
    return RoadMachine(section.torque_per_length_overload * length, heat, section.machine.pole_pairs, idle)


def road_loss(section: RoadSection, design: WholeDesign, demand: RoadDemand) -> float:
    """Copper loss of the RMS force and idle loss of the moving rotor [W].

    P_cu = 6 N_c k_cp A_s (l + l_et) rho J^2,  J = J_nom F tau_t / (r l)
    P_idle = l (h <f> + e <f^2> + x <f^1.5>),  f = p |v| / (2 pi tau_t)

    The velocity is normally distributed, as on a random road without stops. The copper part alone is F^2 over the
    damping, so that it would say nothing that the damping does not; a small tau_t, which lowers it, turns the
    rotor faster. Left out: gears, bearings, and the iron loss that the current adds.
    """
    machine = road_machine(section, design, demand.copper)
    torque = demand.force_rms * design.transmission_ratio
    frequency = machine.pole_pairs * demand.velocity_rms / (2 * pi * design.transmission_ratio)
    return machine.copper * torque**2 + _idle_loss(machine.idle, frequency)


_MEAN, _MEAN_15 = sqrt(2 / pi), 2**0.75 * gamma(1.25) / sqrt(pi)  # <|x|>, <|x|^1.5> of the standard normal distribution


def _idle_loss(idle: FrequencyTerms, frequency_rms: float) -> float:
    """Mean [W] over a normally distributed speed whose electrical frequency has this RMS value [Hz]."""
    linear, quadratic = idle.hysteresis * frequency_rms, idle.eddy * frequency_rms**2
    return _MEAN * linear + quadratic + _MEAN_15 * idle.excess * frequency_rms**1.5


class _Population(Problem):
    """``WholeProblem`` as pymoo calls it."""

    def __init__(self, problem: WholeProblem) -> None:
        super().__init__(n_var=5, n_obj=AIMS, n_ieq_constr=6, xl=0.0, xu=1.0)
        self.problem = problem

    def _evaluate(self, x: np.ndarray, out: dict[str, np.ndarray], *arguments: object, **named: object) -> None:
        found = [self.problem.rated(self.problem.design(one)) for one in x]
        out["F"] = self.problem.costs(found)
        out["G"] = np.array([one.values.constraints for one in found])


def front(
    problem: WholeProblem, *, start: WholeDesign, seed: int, population: int, generations: int
) -> tuple[RatedDesign, ...]:
    """Non-dominated feasible designs by NSGA-II, by rising mass; ``start`` is in the first population."""
    first = np.random.default_rng(seed).random((population, 5))
    first[0] = np.clip(problem.unit(start), 0, 1)
    algorithm = NSGA2(pop_size=population, sampling=first)
    result = minimize(_Population(problem), algorithm, ("n_gen", generations), seed=seed, verbose=False)
    rated = [problem.rated(problem.design(one)) for one in result.pop.get("X")]
    feasible = [one for one in rated if one.values.feasible]
    return tuple(feasible[k] for k in non_dominated(problem.costs(feasible))) if feasible else ()


def improved(problem: WholeProblem, start: WholeDesign, objective: int, allowed: tuple[float, ...]) -> RatedDesign:
    """The design of least (damping: most) ``objective`` with the others no worse than ``allowed``, for all
    combinations.

    allowed: [kg, kg, Ns/m, W], (4,), in the order of OBJECTIVES, the entry of the objective itself does not count
    returns the start where no design keeps them
    Differential evolution for each combination, with ``start`` among the first designs of its own.
    """
    bounds = np.array(allowed)
    searches = [_evolved(problem, start, one, objective, bounds) for one in problem.combinations]
    rated = [problem.rated(design) for design in (start, *searches)]
    keeping = [one for one in rated if _excess(one.values, objective, bounds) <= _FEASIBLE]
    return min(keeping or rated[:1], key=lambda one: _SIGNS[objective] * one.values.objectives[objective])


def _excess(values: Values, objective: int, allowed: np.ndarray) -> float:
    """Sum of what a design exceeds constraints and allowed values by, relative."""
    others = [k for k in range(4) if k != objective and np.isfinite(allowed[k])]
    bounds = allowed[others]
    scale = np.where(bounds == 0, 1.0, np.abs(bounds))
    miss = (np.array(values.objectives)[others] - bounds) * _SIGNS[others] / scale
    return float(np.maximum(miss, 0).sum() + np.maximum(values.constraints, 0).sum())


def _evolved(
    problem: WholeProblem, start: WholeDesign, combination: Combination, objective: int, allowed: np.ndarray
) -> WholeDesign:
    scale = abs(problem.values(start).objectives[objective])

    def cost(x: np.ndarray) -> float:
        values = problem.values(problem.design(np.concatenate([[0], x]), combination))
        excess = _excess(values, objective, allowed)
        if excess > _FEASIBLE:
            return _PENALTY * (1 + excess)
        return float(_SIGNS[objective] * values.objectives[objective] / scale)

    first = np.clip(problem.unit(start)[1:], 0, 1) if combination == start.combination else None
    found = differential_evolution(
        cost, [(0, 1)] * 4, x0=first, seed=_SEED, popsize=12, maxiter=_GENERATIONS, tol=1e-8, polish=False
    )
    return problem.design(np.concatenate([[0], found.x]), combination)


def spread(rated: Sequence[RatedDesign], costs: np.ndarray, count: int) -> tuple[RatedDesign, ...]:
    """So many of the designs that lie far from each other in their costs, the best of each first.

    costs: as ``WholeProblem.costs`` gives them, (designs, AIMS)
    """
    scaled = (costs - costs.min(axis=0)) / np.maximum(np.ptp(costs, axis=0), 1e-12)
    chosen = list(dict.fromkeys(int(k) for k in scaled.argmin(axis=0)))
    while len(chosen) < min(count, len(rated)):
        distance = np.min(np.linalg.norm(scaled[:, None] - scaled[chosen], axis=2), axis=1)
        chosen.append(int(distance.argmax()))
    return tuple(rated[k] for k in chosen)
