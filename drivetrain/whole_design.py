"""Radius, slots, active length, transmission ratio and linkage chosen together instead of one after the other.

Four objectives: mass, equivalent mass, damping reserve and loss on the road. The machine is its polynomials over the
stator radius, the gearbox its scaling laws, as in the match; the constraints are those of the match.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from math import gamma, inf, pi, sqrt

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.problem import Problem
from pymoo.optimize import minimize
from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting
from scipy.interpolate import CubicSpline
from scipy.optimize import differential_evolution

from drivetrain.match import Constraints, CopperLoading, CostScales, CostWeights, CrossSection, evaluate_cost
from drivetrain.planetary import GearboxDesign, GearboxError

OBJECTIVES = ("mass", "equivalent_mass", "damping_reserve", "road_loss")
_SIGNS = np.array([1.0, 1.0, -1.0, 1.0])  # all are minimised but the reserve
_NO_COST = (CostScales(1.0, 1.0, 1.0), CostWeights(0.5, 0.0))
_FEASIBLE = 1e-6  # relative; a limit exceeded by less is kept
_PENALTY = 1e3  # above every cost
_SEED, _GENERATIONS = 1, 150  # of the search for one objective


@dataclass(frozen=True)
class RoadSection(CrossSection):
    """A cross-section with the iron and magnet loss that its turning rotor causes, P = h f + e f^2 + x f^1.5 [W/m].

    idle_hysteresis h [W s/m], idle_eddy e, magnets included [W s^2/m], idle_excess x [W s^1.5/m]: of the whole machine
    without current, over the electrical frequency f
    """

    idle_hysteresis: float
    idle_eddy: float
    idle_excess: float


@dataclass(frozen=True)
class RoadDemand:
    """Working point on the road: RMS force [N] and velocity [m/s] at the wheel; copper; pole pairs of the machine."""

    force_rms: float
    velocity_rms: float
    copper: CopperLoading
    pole_pairs: int


@dataclass(frozen=True)
class WholeDesign:
    """One design, SI: slots, stator outer radius, active length, tau_t [m/rad], nominal linkage ratio [m/rad]."""

    slots: int
    stator_outer_radius: float
    active_length: float
    transmission_ratio: float
    linkage_ratio: float


@dataclass(frozen=True)
class Values:
    """Objectives in the order of OBJECTIVES [kg, kg, 1, W], and constraints, satisfied at or below 0."""

    objectives: tuple[float, ...]
    constraints: tuple[float, ...]

    @property
    def feasible(self) -> bool:
        return max(self.constraints) <= 1e-6


@dataclass(frozen=True)
class WholeProblem:
    """What a design is judged by.

    section_at: (slots, stator outer radius [m]) -> ``CrossSection``, for example from the polynomial fits
    slots; radii: range of the stator outer radius [m] for each; lengths: range of the active length [m]
    linkage_ratios: smallest and largest nominal ratio of the linkages that may be built [m/rad]
    constraints_of: as in ``match_over_radius``; gearbox: at any linkage ratio, which the design replaces
    damping_of: section -> its ``RegenerativeDamping``; loss_of: (section, design) -> loss on the road [W]
    targets: largest mass and equivalent mass [kg]; a design must also have a damping reserve of 1
    """

    section_at: Callable[[int, float], CrossSection]
    slots: tuple[int, ...]
    radii: tuple[tuple[float, float], ...]
    lengths: tuple[float, float]
    linkage_ratios: tuple[float, float]
    constraints_of: Callable[[CrossSection], Constraints]
    gearbox: GearboxDesign
    damping_of: Callable[[CrossSection], object]
    loss_of: Callable[[CrossSection, WholeDesign], float]
    targets: tuple[float, float]

    @cached_property
    def ratios(self) -> tuple[float, float]:
        """Range of the transmission ratio [m/rad]: from the fastest rotor to stages of a ratio of 2."""
        section = self.section_at(self.slots[0], sum(self.radii[0]) / 2)
        low = max(one.minimum_ratio() for one in self.constraints_of(section).enforced)
        return low, replace(self.gearbox, linkage_ratio=self.linkage_ratios[1]).largest_transmission_ratio

    def design(self, unit: np.ndarray, slots: int | None = None) -> WholeDesign:
        """From numbers 0 ... 1 for slots, radius, length, ratio (logarithmic) and linkage."""
        number = min(int(unit[0] * len(self.slots)), len(self.slots) - 1) if slots is None else self.slots.index(slots)
        low, high = self.ratios
        return WholeDesign(
            self.slots[number],
            _between(self.radii[number], unit[1]),
            _between(self.lengths, unit[2]),
            low * (high / low) ** unit[3],
            _between(self.linkage_ratios, unit[4]),
        )

    def unit(self, design: WholeDesign) -> np.ndarray:
        """The inverse of ``design``."""
        number, (low, high) = self.slots.index(design.slots), self.ratios
        return np.array(
            [
                (number + 0.5) / len(self.slots),
                _share(self.radii[number], design.stator_outer_radius),
                _share(self.lengths, design.active_length),
                np.log(design.transmission_ratio / low) / np.log(high / low),
                _share(self.linkage_ratios, design.linkage_ratio),
            ]
        )

    def values(self, design: WholeDesign, section: CrossSection | None = None) -> Values:
        """Objectives and constraints; ``section``: in the place of the fits, such as one solved by the field."""
        section = section or self.section_at(design.slots, design.stator_outer_radius)
        ratio, length = design.transmission_ratio, design.active_length
        enforced = self.constraints_of(section).enforced
        needed = max(float(one.minimum_length(ratio)) for one in enforced)
        limits = (
            needed / length - 1,
            length / min(one.maximum_length() for one in enforced) - 1,
            max(one.minimum_ratio() for one in enforced) / ratio - 1,
        )
        try:
            box = replace(self.gearbox, linkage_ratio=design.linkage_ratio).size(
                envelope_radius=section.stator_outer_radius, transmission_ratio=ratio
            )
        except GearboxError:
            return Values((inf, inf, -inf, inf), (*limits, 1.0, 1.0, 1.0))
        cost = evaluate_cost(section, ratio, length, box, self.gearbox.laws.density, *_NO_COST)
        damping = self.damping_of(section)
        reserve = damping.capability(ratio, length) / damping.damping
        found = (cost.mass, cost.equivalent_mass, float(reserve), self.loss_of(section, design))
        wanted = (found[0] / self.targets[0] - 1, found[1] / self.targets[1] - 1, 1 - found[2])
        return Values(found, (*limits, *wanted))


def _between(ends, share):
    return ends[0] + share * (ends[1] - ends[0])


def _share(ends, value):
    return (value - ends[0]) / (ends[1] - ends[0]) if ends[1] > ends[0] else 0.0


def road_loss(section: RoadSection, design: WholeDesign, demand: RoadDemand) -> float:
    """Copper loss of the RMS force and idle loss of the moving rotor [W].

    P_cu = 6 N_c k_cp A_s (l + l_et) rho J^2,  J = J_nom F tau_t / (r l)
    P_idle = l (h <f> + e <f^2> + x <f^1.5>),  f = p |v| / (2 pi tau_t)

    The velocity is normally distributed, as on a random road without stops. The copper part alone is F^2 over the
    damping, so that it would say nothing that the damping reserve does not; a small tau_t, which lowers it, turns the
    rotor faster. Left out: gears, bearings, and the iron loss that the current adds.
    """
    torque = demand.force_rms * design.transmission_ratio
    copper = demand.copper
    density = copper.nominal_current_density * torque / (section.torque_per_length_nominal * design.active_length)
    volume = 6 * section.coils_in_series * copper.packing * section.half_slot_area
    heat = volume * (design.active_length + section.end_turn_length) * copper.resistivity * density**2
    frequency = demand.pole_pairs * demand.velocity_rms / (2 * pi * design.transmission_ratio)
    return heat + design.active_length * _idle_loss(section, frequency)


_MEAN, _MEAN_15 = sqrt(2 / pi), 2**0.75 * gamma(1.25) / sqrt(pi)  # <|x|>, <|x|^1.5> of the standard normal distribution


def _idle_loss(section, frequency_rms) -> float:
    """Mean [W/m] over a normally distributed speed."""
    linear, quadratic = section.idle_hysteresis * frequency_rms, section.idle_eddy * frequency_rms**2
    return _MEAN * linear + quadratic + _MEAN_15 * section.idle_excess * frequency_rms**1.5


class SectionTable:
    """Cross-sections over the stator radius by cubic splines through samples: a search asks for 100,000 of them.

    Sections from second-order polynomials come back to 1e-6, in a fortieth of the time.
    section_at: (slots, stator outer radius [m]) -> section; slots; radii: range [m] for each
    """

    _SAMPLES = 33

    def __init__(self, section_at: Callable, slots: tuple[int, ...], radii: tuple[tuple[float, float], ...]):
        self._kind, self._splines, self._fixed = {}, {}, {}
        for count, ends in zip(slots, radii, strict=True):
            self._add(count, np.linspace(*ends, self._SAMPLES), section_at)

    def _add(self, slots, radii, section_at):
        found = [section_at(slots, radius) for radius in radii]
        rows = [asdict(one) for one in found]
        whole = [name for name, value in rows[0].items() if isinstance(value, int)]
        self._fixed[slots] = {name: rows[0][name] for name in whole}
        names = [name for name in rows[0] if name not in whole]
        spline = CubicSpline(radii, [[row[name] for name in names] for row in rows])
        self._kind[slots], self._splines[slots] = type(found[0]), (names, spline)

    def __call__(self, slots: int, radius: float) -> CrossSection:
        """The section of a slot count at a stator outer radius [m]."""
        names, spline = self._splines[slots]
        values = dict(zip(names, spline(radius).tolist(), strict=True))
        return self._kind[slots](**self._fixed[slots], **values)


class _Population(Problem):
    """``WholeProblem`` as pymoo calls it."""

    def __init__(self, problem: WholeProblem):
        super().__init__(n_var=5, n_obj=4, n_ieq_constr=6, xl=0.0, xu=1.0)
        self.problem = problem

    def _evaluate(self, x, out, *arguments, **named):
        found = [self.problem.values(self.problem.design(one)) for one in x]
        out["F"] = np.array([one.objectives for one in found]) * _SIGNS
        out["G"] = np.array([one.constraints for one in found])


def front(problem: WholeProblem, *, start: WholeDesign, seed: int, population: int, generations: int):
    """Non-dominated feasible designs, [(design, ``Values``)], by NSGA-II; ``start`` is in the first population."""
    first = np.random.default_rng(seed).random((population, 5))
    first[0] = np.clip(problem.unit(start), 0, 1)
    algorithm = NSGA2(pop_size=population, sampling=first)
    result = minimize(_Population(problem), algorithm, ("n_gen", generations), seed=seed, verbose=False)
    designs = [problem.design(one) for one in result.pop.get("X")]
    feasible = [pair for pair in ((one, problem.values(one)) for one in designs) if pair[1].feasible]
    return non_dominated(feasible) if feasible else []


def non_dominated(pairs: list) -> list:
    """Those that no other one dominates."""
    costs = np.array([values.objectives for _, values in pairs]) * _SIGNS
    keep = NonDominatedSorting().do(costs, only_non_dominated_front=True)
    return [pairs[k] for k in sorted(keep)]


def improved(problem: WholeProblem, start: WholeDesign, objective: int, allowed) -> tuple[WholeDesign, Values]:
    """The design of least (reserve: most) ``objective`` with the others no worse than ``allowed``, for all slots.

    allowed: (4,) in the order of OBJECTIVES, the entry of the objective itself does not count; ``start`` must keep it
    Differential evolution for each slot count, with ``start`` among the first designs of its own.
    """
    searches = [_evolved(problem, start, slots, objective, np.array(allowed)) for slots in problem.slots]
    rated = [(start, problem.values(start)), *((design, problem.values(design)) for design in searches)]
    keeping = [pair for pair in rated if _excess(pair[1], objective, np.array(allowed)) <= _FEASIBLE]
    return min(keeping, key=lambda pair: _SIGNS[objective] * pair[1].objectives[objective])


def _excess(values: Values, objective: int, allowed) -> float:
    """Sum of what a design exceeds constraints and allowed values by, relative."""
    others = [k for k in range(4) if k != objective and np.isfinite(allowed[k])]
    miss = (np.array(values.objectives) - allowed)[others] * _SIGNS[others] / np.abs(allowed[others])
    return float(np.maximum(miss, 0).sum() + np.maximum(values.constraints, 0).sum())


def _evolved(problem, start, slots, objective, allowed) -> WholeDesign:
    scale = abs(problem.values(start).objectives[objective])

    def cost(x):
        values = problem.values(problem.design(np.concatenate([[0], x]), slots))
        excess = _excess(values, objective, allowed)
        if excess > _FEASIBLE:
            return _PENALTY * (1 + excess)
        return _SIGNS[objective] * values.objectives[objective] / scale

    first = np.clip(problem.unit(start)[1:], 0, 1) if slots == start.slots else None
    found = differential_evolution(
        cost, [(0, 1)] * 4, x0=first, seed=_SEED, popsize=12, maxiter=_GENERATIONS, tol=1e-8, polish=False
    )
    return problem.design(np.concatenate([[0], found.x]), slots)


def spread(pairs: list, count: int) -> list:
    """So many of the designs that lie far from each other in the objectives, the best of each first."""
    costs = np.array([values.objectives for _, values in pairs]) * _SIGNS
    scaled = (costs - costs.min(axis=0)) / np.maximum(np.ptp(costs, axis=0), 1e-12)
    chosen = list(dict.fromkeys(int(k) for k in scaled.argmin(axis=0)))
    while len(chosen) < min(count, len(pairs)):
        distance = np.min(np.linalg.norm(scaled[:, None] - scaled[chosen], axis=2), axis=1)
        chosen.append(int(distance.argmax()))
    return [pairs[k] for k in chosen]
