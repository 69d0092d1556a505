"""Constrained optimum of every combination and stator radius, refined with the field solver beyond the grid."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import nan

from geometry.family import Combination
from geometry.machine import Machine
from geometry.variables import Variable
from magnetostatics.case import FamilyCase
from magnetostatics.mesh_error import torque_errors
from magnetostatics.model import FieldModel, FieldSolution
from magnetostatics.positions import period_points
from magnetostatics.torque import arkkio_torque, maxwell_torque
from optimisation.constrained_optimum import BestDesign, NoOptimumError, find_optimum
from optimisation.design import Judge
from optimisation.freedom import AS_SWEPT, Freedom
from optimisation.gradient_optimum import find_optimum_by_gradients
from optimisation.states import STEPS_OVER_PERIOD
from optimisation.sweep import DesignMaps, SaturationLimit, SweepGrid
from optimisation.torque import QuickMeanTorque
from tasks import Workers
from units import MILLIMETRE

_ON_THE_BOUND = 1e-4  # relative; an optimum closer to the bound of a variable lies on it
_ON_THE_EDGE = 0.02  # of the range of the grid: an optimum closer to its end may lie beyond


@dataclass(frozen=True)
class Optimum:
    """The best cross-section of one combination and stator radius under the limit; lengths in m, torques in Nm/m.

    half_slot_area: of one coil side [m^2]
    torque_nominal, torque_overload: mean over one electrical period (``MeanTorque``) [Nm/m], at the two current
        densities
    torque_nominal_error, torque_overload_error: bounds of their mesh errors [Nm/m]
    torque_nominal_ring: the first by the ring average [Nm/m]
    torque_overload_linear: scaled from the nominal one (thesis eq. 3.68) [Nm/m]
    further: values of what the optimum chose beside these [m or 1], in the order of ``Freedom.further``
    torque_null: in the thesis's null state at the nominal current density [Nm/m]; NaN where the reading looks elsewhere
    limited, tooth_worst, back_iron_worst: flux densities in the states of the reading [T]
    field_solutions: designs solved on the way; newton_iterations: of the last one
    """

    combination: Combination
    stator_outer_radius: float
    back_iron_width: float
    rotor_outer_radius: float
    tooth_width: float
    half_slot_area: float
    torque_nominal: float
    torque_nominal_error: float
    torque_nominal_ring: float
    torque_overload: float
    torque_overload_error: float
    torque_overload_linear: float
    torque_null: float
    limited: float
    limit_binds: bool
    tooth_worst: float
    back_iron_worst: float
    field_solutions: int
    newton_iterations: int
    further: tuple[float, ...] = ()


@dataclass(frozen=True)
class NoOptimum:
    """A combination and stator radius [m] without an optimum, and why."""

    combination: Combination
    stator_outer_radius: float
    reason: str


@dataclass(frozen=True)
class GridEdge:
    """An optimum on or beyond the edge of the sweep's grid.

    key: of the study, to be moved so that the grid holds the optimum; edge, found: shares of the stator radius
    """

    combination: Combination
    stator_outer_radius: float
    key: str
    edge: float
    found: float

    @property
    def sentence(self) -> str:
        """Where the optimum lies and what to widen."""
        way = "lower" if self.key.endswith("_min") else "raise"
        return (
            f"{self.combination.words}, {2 * self.stator_outer_radius / MILLIMETRE:g} mm: the optimum lies at "
            f"{self.found:.4f} of the stator radius, on or beyond the edge of the sweep at {self.edge:g}: "
            f"{way} {self.key}"
        )


@dataclass(frozen=True)
class BoundHit:
    """An optimum on a bound of a variable that it may choose; bound: which one [m or 1]."""

    combination: Combination
    stator_outer_radius: float
    variable: Variable
    bound: float

    @property
    def sentence(self) -> str:
        """Which bound, and what to widen."""
        which = "smallest" if self.bound == self.variable.low else "largest"
        return (
            f"{self.combination.words}, {2 * self.stator_outer_radius / MILLIMETRE:g} mm: the optimum lies on the "
            f"{which} {self.variable.words} that is allowed, {self.variable.amount(self.bound)}: widen "
            f"variables.{self.variable.key} where it can be built"
        )


@dataclass(frozen=True)
class Optima:
    """The refined optima in the order of the sweep, what has none, and those at the edge of the grid or on a bound.

    freedom: what they could choose
    """

    limit: SaturationLimit
    found: tuple[Optimum, ...]
    without: tuple[NoOptimum, ...]
    edges: tuple[GridEdge | BoundHit, ...]
    freedom: Freedom = AS_SWEPT

    @property
    def combinations(self) -> tuple[Combination, ...]:
        """Those that have optima, each once, in the order of the sweep."""
        return tuple(dict.fromkeys(optimum.combination for optimum in self.found))

    def of(self, combination: Combination) -> tuple[Optimum, ...]:
        """The optima of one combination by rising radius."""
        own = (optimum for optimum in self.found if optimum.combination == combination)
        return tuple(sorted(own, key=lambda optimum: optimum.stator_outer_radius))


@dataclass(frozen=True)
class OptimumSearch:
    """One search; start: (back-iron width, rotor radius) [m], read off the map."""

    case: FamilyCase
    limit: SaturationLimit
    freedom: Freedom
    combination: Combination
    stator_outer_radius: float
    start: tuple[float, float]


def optima_stage(case: FamilyCase, maps: DesignMaps, freedom: Freedom, workers: Workers) -> Optima:
    """Refine the best point of every map, then free the further dimensions.

    Raises NoOptimumError where no design of the sweep holds the limit.
    """
    searches, without = _searches(case, maps, freedom)
    results = workers.map("optima", solve_optimum, searches).values() if searches else ()
    found = tuple(one for one in results if isinstance(one, Optimum))
    without += tuple(one for one in results if isinstance(one, NoOptimum))
    if not found:
        raise NoOptimumError(_nothing(maps.limit, without))
    edges = tuple(edge for optimum in found for edge in _ends(optimum, maps.grid, freedom))
    return Optima(maps.limit, found, without, edges, freedom)


def solve_optimum(search: OptimumSearch) -> Optimum | NoOptimum:
    """The refined optimum, or why there is none."""
    case, limit = search.case, search.limit
    judge = Judge(case, limit.reading, case.nominal_density, QuickMeanTorque())
    try:
        best = find_optimum(judge, search.combination, search.stator_outer_radius, limit.limit, search.start)
        best = _freed(judge, search, best)
    except NoOptimumError as error:
        return NoOptimum(search.combination, search.stator_outer_radius, str(error))
    return _record(case, best, search.freedom)


def _freed(judge: Judge, search: OptimumSearch, best: BestDesign) -> BestDesign:
    """The optimum with the further dimensions free, from the one where they are the study's."""
    if not search.freedom.further:
        return best
    start = [variable.of(best.design.machine) for variable in search.freedom.variables]
    found = find_optimum_by_gradients(
        judge, search.combination, search.stator_outer_radius, search.limit.limit, start, search.freedom
    )
    return replace(found, solves=best.solves + found.solves)


def _ends(optimum: Optimum, grid: SweepGrid, freedom: Freedom) -> Sequence[GridEdge | BoundHit]:
    """Where an optimum may lie beyond what was looked at: the grid where that alone was searched, or bounds."""
    return bounds_of(optimum, freedom) if freedom.further else edges_at(optimum, grid)


def bounds_of(optimum: Optimum, freedom: Freedom) -> list[BoundHit]:
    """The bounds that an optimum lies on."""
    place = optimum.combination, optimum.stator_outer_radius
    return [
        BoundHit(*place, variable, bound)
        for variable, value in zip(freedom.further, optimum.further, strict=True)
        for bound in (variable.low, variable.high)
        if abs(value - bound) < _ON_THE_BOUND * bound
    ]


def edges_at(optimum: Optimum, grid: SweepGrid) -> list[GridEdge]:
    """The edges of the grid that an optimum lies on or beyond."""
    outer = optimum.stator_outer_radius
    places = (
        ("back_iron_fraction", optimum.back_iron_width / outer, grid.back_iron_fractions),
        ("rotor_radius_fraction", optimum.rotor_outer_radius / outer, grid.rotor_radius_fractions),
    )
    found = []
    for key, share, (low, high) in places:
        margin = _ON_THE_EDGE * (high - low)
        if share < low + margin:
            found.append(GridEdge(optimum.combination, outer, f"sweep.{key}_min", low, share))
        if share > high - margin:
            found.append(GridEdge(optimum.combination, outer, f"sweep.{key}_max", high, share))
    return found


def _searches(
    case: FamilyCase, maps: DesignMaps, freedom: Freedom
) -> tuple[dict[str, OptimumSearch], tuple[NoOptimum, ...]]:
    """The searches that have a start, and where no design of the map holds the limit."""
    searches, without = {}, []
    for combination, outer in maps.grid.sections:
        name = f"{combination.words}, {2 * outer / MILLIMETRE:g} mm"
        best = maps.map(combination, outer).best_point(maps.limit.limit)
        if best is None:
            without.append(NoOptimum(combination, outer, f"{name}: no design of the sweep holds {maps.limit.words}"))
        else:
            searches[name] = OptimumSearch(case, maps.limit, freedom, combination, outer, (best.width, best.radius))
    return searches, tuple(without)


def _nothing(limit: SaturationLimit, without: tuple[NoOptimum, ...]) -> str:
    return (
        f"no design of the sweep holds the limit of {limit.words} ({without[0].reason}): raise saturation.limit_T or "
        "widen the sweep (sweep.back_iron_fraction_max, sweep.rotor_radius_fraction_min)"
    )


def _record(case: FamilyCase, best: BestDesign, freedom: Freedom) -> Optimum:
    design, machine = best.design, best.design.machine
    torques = _torques(case, machine)
    return Optimum(
        combination=Combination.of(machine),
        stator_outer_radius=machine.stator_outer_radius,
        back_iron_width=machine.back_iron_width,
        rotor_outer_radius=machine.rotor_outer_radius,
        tooth_width=machine.tooth_width,
        half_slot_area=design.coil_side_area,
        torque_nominal=torques.nominal,
        torque_nominal_error=torques.nominal_error,
        torque_nominal_ring=torques.nominal_ring,
        torque_overload=torques.overload,
        torque_overload_error=torques.overload_error,
        torque_overload_linear=torques.nominal * case.overload_density / case.nominal_density,
        torque_null=design.torque_null,
        limited=design.limited,
        limit_binds=best.limit_binds,
        tooth_worst=design.tooth_worst,
        back_iron_worst=design.back_iron_worst,
        field_solutions=best.solves,
        newton_iterations=design.newton_iterations,
        further=tuple(variable.of(machine) for variable in freedom.further),
    )


@dataclass(frozen=True)
class _Torques:
    nominal: float
    nominal_ring: float
    nominal_error: float
    overload: float
    overload_error: float


def _torques(case: FamilyCase, machine: Machine) -> _Torques:
    """Mean torques at both current densities and their mesh errors in the first position, all on one mesh."""
    model = case.model(machine)
    nominal, overload = (_over_period(case, model, density) for density in _densities(case))
    errors = torque_errors([nominal[0], overload[0]])
    return _Torques(
        case.kept * _mean([maxwell_torque(solution) for solution in nominal]),
        case.kept * _mean([arkkio_torque(solution) for solution in nominal]),
        case.kept * errors[0],
        case.kept * _mean([maxwell_torque(solution) for solution in overload]),
        case.kept * errors[1],
    )


def _densities(case: FamilyCase) -> tuple[float, float]:
    return case.nominal_density, case.overload_density


def _over_period(case: FamilyCase, model: FieldModel, density: float) -> list[FieldSolution]:
    """The fields that ``MeanTorque`` is the mean of."""
    section, solutions = model.section, list[FieldSolution]()
    for point in period_points(section.machine, section.layout, density, case.packing, STEPS_OVER_PERIOD):
        solutions.append(model.solve(point, start=solutions[-1] if solutions else None))
    return solutions


def _mean(values: list[float]) -> float:
    return sum(values) / len(values) if values else nan
