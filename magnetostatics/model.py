"""The field problem of one cross-section: materials, currents and rotor angle in, vector potential out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from time import process_time
from typing import Protocol

import numpy as np

from geometry.cross_section import CrossSection
from geometry.errors import GeometryError
from geometry.winding import Coil
from magnetostatics.assembly import JoinedSystem
from magnetostatics.cholesky import SymmetricSystem, one_thread
from magnetostatics.elements import LINEAR, QUADRATIC, Elements, TriangleOrder, Triangles, lower_order, refine_order
from magnetostatics.iron import Iron, IronState
from magnetostatics.local_steel import LocalSteel, law_in
from magnetostatics.newton import NewtonRecord, NewtonSettings, newton
from magnetostatics.passes import add_scattered, gathered
from magnetostatics.topology import IRON, Topology
from magnetostatics.two_level import Refinement, response
from magnetostatics.unknowns import Turn, Unknowns
from materials.magnet import Magnet
from materials.reluctivity import Reluctivity
from units import MU_0

_ROUGHEST = 0.03  # share of the residual that a Newton step with quadratic elements may leave of its linear equation
_LITTLE = 0.8  # what a step that brought little leaves of the residual
_FEW = 6  # iterations of that; more say that the tangent of linear elements belongs to another field
_BELOW = 0.1  # of the tolerance, which the linear equation need not be solved beyond
_COARSE = NewtonSettings(tolerance=2e-4, always_step=False)  # of the linear elements that quadratic ones start from


@dataclass(frozen=True)
class MachineMaterials:
    """What the regions of a machine are made of.

    magnet: of all poles but ``other_magnets``, the (number, magnet) of those that differ; they need the whole machine
    """

    stator_steel: Reluctivity | LocalSteel
    rotor_steel: Reluctivity | LocalSteel
    magnet: Magnet
    other_magnets: tuple[tuple[int, Magnet], ...] = ()

    def magnet_at(self, number: int) -> Magnet:
        """The magnet of a pole."""
        return dict(self.other_magnets).get(number, self.magnet)

    def with_magnet(self, number: int, magnet: Magnet) -> MachineMaterials:
        """The same with another magnet at one pole."""
        return replace(self, other_magnets=tuple((dict(self.other_magnets) | {number: magnet}).items()))

    def with_magnets(self, change: Callable[[Magnet], Magnet]) -> MachineMaterials:
        """The same with every magnet changed."""
        others = tuple((number, change(magnet)) for number, magnet in self.other_magnets)
        return replace(self, magnet=change(self.magnet), other_magnets=others)


class OperatingState(Protocol):
    """What a field is solved for; ``OperatingPoint`` and the ones of ``magnetostatics.currents``."""

    @property
    def angle(self) -> float:
        """Mechanical rotor angle, magnet 0 on the x axis at zero [rad]."""

    def current_load(self, model: FieldModel) -> np.ndarray:
        """Right-hand side (n,) [A] of the currents."""


@dataclass(frozen=True)
class OperatingPoint:
    """Rotor angle and balanced currents of a sinusoidal supply.

    angle: mechanical rotor angle, magnet 0 on the x axis at zero [rad]
    current_density: amplitude of the current density in the copper [A/m^2]
    current_angle: electrical angle gamma from the q axis; positive weakens the field [rad]
    packing_factor: copper share of the half-slot area; the slot carries packing_factor * current_density
    """

    angle: float
    current_density: float = 0.0
    current_angle: float = 0.0
    packing_factor: float = 0.3

    def phase_densities(self, pole_pairs: int, phase_axis: float) -> np.ndarray:
        """Current density in the copper of A, B, C [A/m^2], (3,).

        J cos(p theta + 90 deg - axis_A + gamma - i 120 deg)

        phase_axis: electrical angle of the axis of phase A [rad]
        """
        lead = pole_pairs * self.angle + pi / 2 - phase_axis + self.current_angle
        return self.current_density * np.cos(lead - 2 * pi / 3 * np.arange(3))

    def ampere_turns(self, section: CrossSection) -> np.ndarray:
        """Of one coil of phases A, B, C [A], (3,)."""
        densities = self.phase_densities(section.machine.pole_pairs, section.layout.phase_axis)
        return densities * self.packing_factor * section.half_slot_area * section.half_slots_per_coil_side

    def current_load(self, model: FieldModel) -> np.ndarray:
        """Right-hand side [A], (n,)."""
        return self.ampere_turns(model.section) @ model.phase_loads


@dataclass(frozen=True, eq=False)
class FieldSolution:
    """Vector potential a (n,) [Wb/m] of one operating point and how it was found.

    cpu_seconds: time that the solution took [s]
    coarse: the solution with linear elements that one with quadratic elements started from
    """

    model: FieldModel
    point: OperatingState
    a: np.ndarray
    newton: NewtonRecord
    cpu_seconds: float
    coarse: FieldSolution | None = None


def blended(solutions: Sequence[FieldSolution], weights: np.ndarray) -> FieldSolution:
    """A start between or beyond solutions on the same triangles.

    weights: of their potentials, dimensionless (k,)
    """
    a = weights @ np.stack([solution.a for solution in solutions])
    below = [solution.coarse for solution in solutions if solution.coarse is not None]
    return replace(solutions[0], a=a, coarse=blended(below, weights) if below else None)


class _Drawn:
    """What a section and the order of its elements determine whatever it is made of."""

    def __init__(self, section: CrossSection, topology: Topology) -> None:
        self.section, self.topology = section, topology

    @cached_property
    def elements(self) -> Elements:
        """Of the whole mesh."""
        mesh = self.section.mesh
        return Elements.of(self.topology.order, mesh.p, mesh.t, self.topology.dofs)

    @cached_property
    def phase_loads(self) -> np.ndarray:
        """See ``FieldModel.phase_loads``, (3, n)."""
        sides = self._coils_of_sides
        factors = np.array([coil.sign * coil.turns * way for coil, way in sides])
        return self._spread([coil.phase for coil, _ in sides], factors, 3)

    @cached_property
    def coil_loads(self) -> np.ndarray:
        """See ``FieldModel.coil_loads``, (coils, n)."""
        sides, coils = self._coils_of_sides, self.section.layout.coils
        rows = {coil.index: row for row, coil in enumerate(coils)}
        return self._spread([rows[coil.index] for coil, _ in sides], np.array([way for _, way in sides]), len(coils))

    @property
    def _coils_of_sides(self) -> list[tuple[Coil, int]]:
        """(coil, direction) of every coil side in the sector."""
        return [self.section.layout.coil_at(*side) for side in self.section.coil_sides]

    def _spread(self, rows: list[int], factors: np.ndarray, count: int) -> np.ndarray:
        """Loads (count, n) of a factor [A] spread evenly over each coil side, summed into the row of each."""
        regions = [self.topology.regions[f"slot_{slot}_{side}"] for slot, side in self.section.coil_sides]
        side = np.repeat(np.arange(len(regions)), [len(region) for region in regions])
        elements = self.elements.take(np.concatenate(regions))
        area = np.bincount(side, weights=elements.weights.sum(0))
        local = elements.integrals() * ((factors / area)[side] / self.section.half_slots_per_coil_side)
        return _scattered(elements.dofs, local, np.asarray(rows)[side], count, self.topology.size)


def _scattered(dofs: np.ndarray, local: np.ndarray, rows: np.ndarray, count: int, size: int) -> np.ndarray:
    """Local vectors (F, E) added up to ``count`` vectors (count, size), all [any unit].

    dofs: indices (F, E); rows: index of the vector that every element counts in (E,)
    """
    place = rows * size + dofs
    return np.bincount(place.ravel(), weights=local.ravel(), minlength=count * size).reshape(count, -1)


class FieldModel:
    """Assembles and solves the field of one meshed cross-section with given materials.

    What depends on neither current nor angle is prepared once. The system joined at an angle is kept until another
    angle is asked for, so that several currents at one angle share it.
    topology: of another model whose cross-section has the same triangles; shared, it saves half of the preparation
    """

    def __init__(
        self,
        section: CrossSection,
        materials: MachineMaterials,
        settings: NewtonSettings = NewtonSettings(),
        order: TriangleOrder = QUADRATIC,
        topology: Topology | None = None,
    ) -> None:
        _check_magnets(section, materials)
        self.section, self.materials = section, materials
        self.topology = topology or Topology(section, order)
        self.settings = settings
        self._joined: tuple[Turn, JoinedSystem] | None = None
        self._bands: dict[float, Triangles] = {}  # of the last angle, shared with the problem of the other order

    @cached_property
    def elements(self) -> Elements:
        """Of the whole mesh."""
        return self._drawn.elements

    @cached_property
    def _drawn(self) -> _Drawn:
        """What depends on the section alone; models with other materials share it."""
        return _Drawn(self.section, self.topology)

    @cached_property
    def iron(self) -> Iron:
        """The elements of the steels and their laws."""
        counts = [len(self.topology.regions[name]) for name in IRON]
        steels = zip(IRON, (self.materials.stator_steel, self.materials.rotor_steel))
        laws = [law_in(steel, self.section, name) for name, steel in steels]
        return Iron(self.elements.take(self.topology.iron), counts, laws)

    @property
    def order(self) -> TriangleOrder:
        """Shape functions and points of integration of the triangles of the mesh."""
        return self.topology.order

    @property
    def unknowns(self) -> Unknowns:
        """Which degrees of freedom are free, and which follow others by periodicity or are zero."""
        return self.topology.unknowns

    @property
    def size(self) -> int:
        """Degrees of freedom of the mesh, free or not."""
        return self.topology.size

    @property
    def rotor_band(self) -> np.ndarray:
        """Indices of the elements of the gap on the rotor side of the sliding circle (k,)."""
        return self.topology.rotor_band

    def like(self, section: CrossSection | None = None, materials: MachineMaterials | None = None) -> FieldModel:
        """The same problem with moved nodes (``geometry.morph``) or other materials, sharing the topology."""
        other = FieldModel(section or self.section, materials or self.materials, self.settings, topology=self.topology)
        other._coarse_topology = self._coarse_topology
        if other.section is self.section:
            other._drawn = self._drawn
        return other

    @property
    def finest(self) -> FieldModel:
        """The problem with quadratic elements where this one belongs to such a one, else this one itself."""
        return self

    def of_order(self, order: TriangleOrder) -> FieldModel:
        """The same problem with elements of the same or the lower order."""
        return self if order is self.order else self.coarse_model

    # ---- sources ----------------------------------------------------------------------------------------------

    @cached_property
    def magnet_loads(self) -> np.ndarray:
        """integral nu (B_rx dv/dy - B_ry dv/dx) of every magnet in the sector (magnets, n) [A]."""
        return self._magnet_loads(together=False)

    def _magnet_loads(self, together: bool) -> np.ndarray:
        """Of every magnet (magnets, n), or the sum of all (1, n) [A]."""
        numbers = range(self.section.magnets)
        if not numbers:
            return np.zeros((int(together), self.size))
        regions = [self.topology.regions[f"magnet_{m}"] for m in numbers]
        sizes, elements = [len(region) for region in regions], self.elements.take(np.concatenate(regions))
        points = np.split(elements.points, np.cumsum(sizes)[:-1], axis=2)
        x, y = np.concatenate([self._strength(m, points[m]) for m in numbers], axis=2)
        rows = np.repeat(np.zeros(len(numbers), int) if together else numbers, sizes)
        count = 1 if together else len(numbers)
        return _scattered(elements.dofs, elements.forces(-y, x), rows, count, self.size)

    def _strength(self, number: int, points: np.ndarray) -> np.ndarray:
        """nu B_r of a magnet at some points [m], (2, ...), x and y [A/m] in one (2, ...)."""
        magnet = self.materials.magnet_at(number)
        return magnet.remanence / (MU_0 * magnet.recoil_permeability) * np.stack(self._direction(number, points))

    def magnet_elements(self, number: int) -> Elements:
        """The elements of a magnet."""
        return self._magnets[number]

    @cached_property
    def _magnets(self) -> list[Elements]:
        return [self.elements.take(self.topology.regions[f"magnet_{m}"]) for m in range(self.section.magnets)]

    def magnetisation(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        """x and y of the unit vector of the magnetisation at the quadrature points of a magnet, dimensionless, each
        (Q, E); magnets of odd number point inwards."""
        return self._direction(number, self.magnet_elements(number).points)

    def _direction(self, number: int, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        angle = self.section.magnetisation_angle(number, points) + self.materials.magnet_at(number).axis_error
        polarity = self.section.polarity(number)
        return polarity * np.cos(angle), polarity * np.sin(angle)

    @cached_property
    def phase_loads(self) -> np.ndarray:
        """Load per ampere in one turn of every coil of phases A, B, C (3, n), dimensionless.

        As a product with a it is flux linkage.

        1 A is spread evenly over each coil side, so that the product with a is its mean. A coil whose turns are not as
        designed counts with its relative turns.
        """
        return self._drawn.phase_loads

    @cached_property
    def coil_loads(self) -> np.ndarray:
        """Load per ampere in one turn of every single coil (coils, n), dimensionless, in +z where it goes; what of it
        is in the sector."""
        return self._drawn.coil_loads

    def load(self, point: OperatingState) -> np.ndarray:
        """Right-hand side (n,) [A] of magnets and currents."""
        return self._all_magnets_load + point.current_load(self)

    @cached_property
    def _all_magnets_load(self) -> np.ndarray:
        return self._magnet_loads(together=True)[0]

    # ---- the linear part and the turning rotor -----------------------------------------------------------------

    def band_elements(self, rest: float) -> Elements:
        """The rotor side of the gap, sheared so that the sliding circle moves by -rest [rad] against the rotor."""
        if rest not in self._bands:
            self._bands.clear()
            self._bands[rest] = self._band(rest)
        return Elements(self.order, self.topology.band_dofs, self._bands[rest])

    def _band(self, rest: float) -> Triangles:
        points = self.section.mesh.p[:, self.topology.band_nodes]
        if rest != 0.0:
            points = self.section.rotor_gap.sheared(points, -rest)
        return Triangles.of(points, self.topology.band_corners)

    @cached_property
    def _linear_values(self) -> np.ndarray:
        """Entries of the linear part without the rotor side of the gap."""
        return self.topology.fixed_pattern.linear_entries.sum(self.order.stiffness @ self._linear_metric)

    @cached_property
    def _linear_metric(self) -> np.ndarray:
        """Metric times reluctivity of the elements of constant reluctivity outside the rotor side of the gap [m/H],
        (3, k)."""
        which = self.topology.linear
        return np.take(self.elements.metric, which, axis=1) * self._reluctivity[which]

    @cached_property
    def _reluctivity(self) -> np.ndarray:
        """Of air, copper and magnets, per element of the mesh [m/H]."""
        reluctivity = np.full(self.section.mesh.nelements, 1 / MU_0)
        for m in range(self.section.magnets):
            reluctivity[self.topology.regions[f"magnet_{m}"]] /= self.materials.magnet_at(m).recoil_permeability
        return reluctivity

    def _join(self, turn: Turn) -> JoinedSystem:
        if self._joined is None or self._joined[0] != turn:
            pattern = self.topology.pattern(turn.edges)
            band = self.band_elements(turn.rest).stiffness(1 / MU_0)
            self._joined = turn, JoinedSystem(pattern, turn.edges, self._linear_values, band)
        return self._joined[1]

    # ---- Newton -----------------------------------------------------------------------------------------------

    def solve(self, point: OperatingState, start: FieldSolution | None = None) -> FieldSolution:
        """Field of an operating point by Newton's method.

        start: a solution to start from, of this model or of one that shares its topology (a neighbouring current,
            angle or design). Quadratic elements begin with the field of linear ones, which costs a tenth of a
            quadratic iteration each, and with a start take only its change: mostly one quadratic iteration follows.
        Raises FieldSolutionError when the iteration does not converge.
        """
        with one_thread():
            return self._solve(point, self.load(point), start)

    def _solve(self, point: OperatingState, load: np.ndarray, start: FieldSolution | None) -> FieldSolution:
        began = process_time()
        coarse = self._coarse_solution(point, load, start)
        problem = _Problem(self, point, load) if coarse is None else _RefinedProblem(self, point, load, coarse)
        u, record = newton(
            problem.free_values(self._first_guess(coarse, start)),
            float(np.linalg.norm(problem.load)),
            problem.residual,
            problem.direction,
            self.settings,
        )
        return FieldSolution(self, point, problem.expand(u), record, process_time() - began, coarse)

    def _coarse_solution(
        self, point: OperatingState, load: np.ndarray, start: FieldSolution | None
    ) -> FieldSolution | None:
        """The same problem with linear elements, None where they are the elements of this model."""
        if self.order is LINEAR:
            return None
        return self.coarse_model._solve(point, lower_order(self.topology.facets, load), start and start.coarse)

    def _first_guess(self, coarse: FieldSolution | None, start: FieldSolution | None) -> np.ndarray:
        """Potential to start from (n,): that of linear elements, or the start and what they changed since."""
        if coarse is None:
            return np.zeros(self.size) if start is None else start.a
        if start is None:
            return refine_order(self.topology.facets, coarse.a)
        if start.coarse is None:
            raise ValueError("a start with quadratic elements carries the field of linear ones, found none")
        return start.a + refine_order(self.topology.facets, coarse.a - start.coarse.a)

    def residual(self, point: OperatingState, a: np.ndarray) -> np.ndarray:
        """Load minus field forces of any potential a (n,) at the free unknowns (m,) [A]; zero for the solution."""
        problem = _Problem(self, point, self.load(point))
        return problem.residual(problem.free_values(a))

    def tangent(self, solution: FieldSolution) -> TangentSystem:
        """The tangent matrix at a solution of this model, factorised."""
        problem = _Problem(self, solution.point, self.load(solution.point))
        u = problem.free_values(solution.a)
        return TangentSystem(problem, u, problem.factorise(u))

    @cached_property
    def coarse_model(self) -> FieldModel:
        """The same problem with linear elements; a solution there costs a quarter of one with quadratic elements."""
        _ = self.iron, self._linear_metric  # both share them
        return _CoarseModel(copy(self), self._coarse_topology)  # of a copy: a cycle would hold its memory for long

    @cached_property
    def _coarse_topology(self) -> Topology:
        return Topology(self.section, LINEAR, self.topology.most_patterns)


class _CoarseModel(FieldModel):
    """The problem of a model with quadratic elements on the same triangles with linear ones.

    Triangles, steels and what is linear are those of the fine model; its loads are the fine ones on fewer functions.
    """

    def __init__(self, fine: FieldModel, topology: Topology) -> None:
        settings = replace(_COARSE, tolerance=max(_COARSE.tolerance, fine.settings.tolerance))
        super().__init__(fine.section, fine.materials, settings, topology=topology)
        self._fine, self._bands = fine, fine._bands

    @property
    def finest(self) -> FieldModel:
        """The problem with quadratic elements."""
        return self._fine

    def like(self, section: CrossSection | None = None, materials: MachineMaterials | None = None) -> FieldModel:
        """As of the fine model, with linear elements."""
        return self._fine.like(section, materials).coarse_model

    @cached_property
    def elements(self) -> Elements:
        """Of the whole mesh."""
        return Elements(self.order, self.topology.dofs, self._fine.elements.shape)

    @cached_property
    def iron(self) -> Iron:
        """The elements of the steels and their laws."""
        return self._fine.iron.of_order(self.order, self.topology.dofs[:, self.topology.iron])

    @property
    def _linear_metric(self) -> np.ndarray:
        return self._fine._linear_metric

    @cached_property
    def magnet_loads(self) -> np.ndarray:
        """As of the fine model, on the linear functions (magnets, n) [A]."""
        return lower_order(self.topology.facets, self._fine.magnet_loads)

    @cached_property
    def _all_magnets_load(self) -> np.ndarray:
        return lower_order(self.topology.facets, self._fine._all_magnets_load)

    @cached_property
    def phase_loads(self) -> np.ndarray:
        """As of the fine model, on the linear functions (3, n), dimensionless."""
        return lower_order(self.topology.facets, self._fine.phase_loads)

    @cached_property
    def coil_loads(self) -> np.ndarray:
        """As of the fine model, on the linear functions (coils, n), dimensionless."""
        return lower_order(self.topology.facets, self._fine.coil_loads)


class _Problem:
    """One operating point of a model in terms of its free unknowns u (m,)."""

    def __init__(self, model: FieldModel, point: OperatingState, load: np.ndarray) -> None:
        turn = model.unknowns.turn(point.angle)
        self.model, self.system, self.angle = model, model._join(turn), point.angle
        self.column, self.sign = model.topology.turned(turn.edges)
        self.load = self.reduce(load)
        self._iron: tuple[np.ndarray, IronState] | None = None  # of the last field looked at
        self._touched: IronState | None = None  # where the tangent of the last step touches the laws
        self._size = np.inf  # of the residual before it; without end when it touched them at the field itself

    def expand(self, u: np.ndarray) -> np.ndarray:
        """All degrees of freedom (n,) from the free unknowns."""
        return u[self.column] * self.sign

    def reduce(self, vector: np.ndarray) -> np.ndarray:
        """Forces on the free unknowns from those on all degrees of freedom."""
        return np.bincount(self.column, weights=vector * self.sign, minlength=self.model.unknowns.count)

    def free_values(self, a: np.ndarray) -> np.ndarray:
        """Free unknowns from all degrees of freedom; the rotor side of the sliding circle does not count."""
        return a[self.model.unknowns.free_dofs]

    def residual(self, u: np.ndarray) -> np.ndarray:
        """Load minus field forces (m,) [A]."""
        forces = self.system.linear_product(u)
        add_scattered(forces, self._iron_at(u).forces, *self.model.topology.iron_unknowns)
        return self.load - forces

    def direction(self, u: np.ndarray, residual: np.ndarray) -> np.ndarray:
        """Newton step (m,)."""
        iron, load = self._tangent_at(u, residual)
        return self.system.factorise(iron.tangent).solve(load)

    def _tangent_at(self, u: np.ndarray, residual: np.ndarray) -> tuple[IronState, np.ndarray]:
        """Where the tangent of a step touches the laws, and its load (m,) [A].

        That is the field itself at first, and after a step from another point of the laws that brought little.
        """
        field, before, size = self._iron_at(u), self._touched, float(np.linalg.norm(residual))
        if before is None or size > _LITTLE * self._size:
            self._touched, self._size = field, np.inf
            return field, residual
        self._touched, lacking = self.model.iron.drawn_back(field, before)
        self._size, load = size, residual.copy()
        add_scattered(load, lacking, *self.model.topology.iron_unknowns)
        return self._touched, load

    def factorise(self, u: np.ndarray) -> SymmetricSystem:
        """The tangent at a field, factorised."""
        return self.system.factorise(self._iron_at(u).tangent)

    def _iron_at(self, u: np.ndarray) -> IronState:
        """The iron at a field; residual and tangent of one field share it."""
        if self._iron is None or self._iron[0] is not u:
            self._iron = u, self.model.iron.at(gathered(u, *self.model.topology.iron_unknowns))
        return self._iron[1]


class _RefinedProblem(_Problem):
    """One operating point with quadratic elements, whose steps are found over the tangent of linear ones.

    coarse: the solution with linear elements
    """

    def __init__(self, model: FieldModel, point: OperatingState, load: np.ndarray, coarse: FieldSolution) -> None:
        super().__init__(model, point, load)
        self._coarse = coarse.model
        self._below = coarse.model._join(coarse.model.unknowns.turn(point.angle))
        self._tangent_below = self._below.pattern.system if coarse.newton.iterations else None  # of its last step

    def direction(self, u: np.ndarray, residual: np.ndarray) -> np.ndarray:
        """Newton step (m,), as exact as it is worth.

        The error of a step is quadratic in its length: more than its square, or much more than the tolerance, is lost.
        """
        size = float(np.linalg.norm(residual) / np.linalg.norm(self.load))
        share = min(_ROUGHEST, max(size, _BELOW * self.model.settings.tolerance / size))
        iron, load = self._tangent_at(u, residual)
        if self._tangent_below is None:
            self._tangent_below = self._below.factorise(iron.linear_tangent)
        tangent = self.system.tangent(iron.tangent)
        step, iterations = response(tangent, self._refinement, self._tangent_below, load, share)
        if iterations > _FEW:
            self._tangent_below = None
        return step

    @cached_property
    def _refinement(self) -> Refinement:
        unknowns = self._coarse.unknowns
        column, sign = self._coarse.topology.turned(unknowns.turn(self.angle).edges)
        ends = self.model.topology.facets[:, self.model.unknowns.free_dofs[unknowns.count :] - self._coarse.size]
        return Refinement(column[ends].astype(np.uint32), sign[ends] / 2)


@dataclass(frozen=True, eq=False)
class TangentSystem:
    """Answers how the field changes: small load in, small change of the potential out.

    It is good until the model, or another one that shares its topology, is solved or has its tangent made again.
    """

    problem: _Problem
    at: np.ndarray  # the free unknowns (m,) that it was made at [Wb/m]
    system: SymmetricSystem

    @property
    def residual(self) -> np.ndarray:
        """Load minus field forces there (m,) [A]; it costs little, for the iron is known."""
        return self.problem.residual(self.at)

    def response(self, load: np.ndarray) -> np.ndarray:
        """Change of the potential (n,) for a change of the load: (n,) on all, or (m,) on the free unknowns [A]."""
        reduced = load if len(load) == self.problem.model.unknowns.count else self.problem.reduce(load)
        return self.problem.expand(self.system.solve(reduced))

    def responses(self, loads: np.ndarray) -> np.ndarray:
        """Changes of the potential [Wb/m], (k, n), for several changes of the load at once.

        loads: on the free unknowns [A], (k, m)
        """
        return np.stack([self.problem.expand(u) for u in self.system.solve(loads.T).T])


def _check_magnets(section: CrossSection, materials: MachineMaterials) -> None:
    magnets = section.magnets * section.sectors
    unknown = [number for number, _ in materials.other_magnets if not 0 <= number < magnets]
    if unknown:
        raise GeometryError(f"there is no magnet {unknown[0]}: they are numbered from 0 to {magnets - 1}")
    if materials.other_magnets and section.sectors > 1:
        raise GeometryError(
            f"magnets that differ break the symmetry of the machine, but 1/{section.sectors} of it is meshed: "
            "mesh the whole machine (mesh_cross_section(..., whole=True))"
        )
