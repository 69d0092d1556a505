"""The field problem of one cross-section: materials, currents and rotor angle in, vector potential out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from time import process_time
from typing import Callable, Protocol

import numpy as np

from geometry.cross_section import CrossSection
from geometry.gap import GapHalf
from geometry.machine import GeometryError
from magnetostatics.assembly import JoinedSystem
from magnetostatics.cholesky import SymmetricSystem, one_thread
from magnetostatics.elements import LINEAR, QUADRATIC, Elements, TriangleOrder, refine_order
from magnetostatics.local_steel import LocalSteel, law_in
from magnetostatics.newton import NewtonRecord, NewtonSettings, newton
from magnetostatics.topology import IRON, Topology
from magnetostatics.unknowns import Turn, Unknowns
from materials.magnet import Magnet
from materials.reluctivity import Reluctivity
from units import MU_0


_COARSE = NewtonSettings(tolerance=1e-3)  # of the linear elements that quadratic ones start from


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

    angle: float  # mechanical rotor angle, magnet 0 on the x axis at zero [rad]

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
        """Current density in the copper of phases A, B, C [A/m^2]: J cos(p theta + 90 deg - axis_A + gamma - i 120 deg)."""
        lead = pole_pairs * self.angle + pi / 2 - phase_axis + self.current_angle
        return self.current_density * np.cos(lead - 2 * pi / 3 * np.arange(3))

    def ampere_turns(self, section: CrossSection) -> np.ndarray:
        """Of one coil of phases A, B, C [A]."""
        densities = self.phase_densities(section.machine.pole_pairs, section.layout.phase_axis)
        return densities * self.packing_factor * section.half_slot_area * section.half_slots_per_coil_side

    def current_load(self, model: FieldModel) -> np.ndarray:
        return self.ampere_turns(model.section) @ model.phase_loads


@dataclass(frozen=True, eq=False)
class FieldSolution:
    """Vector potential a (n,) [Wb/m] of one operating point and how it was found."""

    model: FieldModel
    point: OperatingState
    a: np.ndarray
    newton: NewtonRecord
    cpu_seconds: float


class FieldModel:
    """Assembles and solves the field of one meshed cross-section with given materials.

    What depends on neither current nor angle is prepared once. The system joined at an angle is kept until another angle
    is asked for, so that several currents at one angle share it.
    topology: of another model whose cross-section has the same triangles; shared, it saves half of the preparation
    """

    def __init__(
        self,
        section: CrossSection,
        materials: MachineMaterials,
        settings: NewtonSettings = NewtonSettings(),
        order: TriangleOrder = QUADRATIC,
        topology: Topology | None = None,
    ):
        _check_magnets(section, materials)
        self.section, self.materials, self.settings = section, materials, settings
        self.topology = topology or Topology(section, order)
        self.elements = Elements.of(self.order, section.mesh.p[:, section.mesh.t], self.topology.dofs)
        steels = zip(IRON, (materials.stator_steel, materials.rotor_steel))
        self._laws = tuple((self._region(name), law_in(steel, section, name)) for name, steel in steels)
        self._joined: tuple[Turn, JoinedSystem] | None = None

    @property
    def order(self) -> TriangleOrder:
        return self.topology.order

    @property
    def unknowns(self) -> Unknowns:
        return self.topology.unknowns

    @property
    def size(self) -> int:
        """Degrees of freedom of the mesh, free or not."""
        return self.topology.size

    @property
    def rotor_band(self) -> np.ndarray:
        """Elements of the gap on the rotor side of the sliding circle."""
        return self.topology.rotor_band

    def like(self, section: CrossSection | None = None, materials: MachineMaterials | None = None) -> FieldModel:
        """The same problem with moved nodes (``geometry.morph``) or other materials, sharing the topology."""
        other = FieldModel(section or self.section, materials or self.materials, self.settings, topology=self.topology)
        other._coarse_topology = self._coarse_topology
        return other

    def _region(self, name: str) -> Elements:
        return self.elements.take(self.topology.regions[name])

    # ---- sources ----------------------------------------------------------------------------------------------

    @cached_property
    def magnet_loads(self) -> np.ndarray:
        """integral nu (B_rx dv/dy - B_ry dv/dx) of every magnet in the sector (magnets, n) [A]."""
        return np.stack([self._magnet_load(m) for m in range(self.section.magnets)])

    def _magnet_load(self, number: int) -> np.ndarray:
        elements, magnet = self._region(f"magnet_{number}"), self.materials.magnet_at(number)
        direction = self.section.magnetisation_angle(number, elements.points) + magnet.axis_error
        strength = (-1) ** number * magnet.remanence / (MU_0 * magnet.recoil_permeability)
        return elements.scatter(elements.forces(-strength * np.sin(direction), strength * np.cos(direction)), self.size)

    @cached_property
    def coil_side_loads(self) -> np.ndarray:
        """Mean over each half slot, as a load: 1 A in each coil side (2 * teeth, n)."""
        regions = [self._region(f"slot_{slot}_{side}") for slot, side in self.section.coil_sides]
        return np.stack([elements.scatter(elements.means(), self.size) for elements in regions])

    @cached_property
    def phase_loads(self) -> np.ndarray:
        """Load of 1 A in one turn of every coil of phases A, B, C (3, n); as a product with a it is flux linkage.

        A coil whose turns are not as designed counts with its relative turns.
        """
        sides = [self.section.layout.coil_at(*side) for side in self.section.coil_sides]
        factors = [[(coil.phase == i) * coil.sign * coil.turns * way for coil, way in sides] for i in range(3)]
        return np.array(factors) @ self.coil_side_loads / self.section.half_slots_per_coil_side

    @cached_property
    def coil_loads(self) -> np.ndarray:
        """Load of 1 A in one turn of every single coil (coils, n), in +z where it goes; what of it is in the sector."""
        sides = [self.section.layout.coil_at(*side) for side in self.section.coil_sides]
        factors = [[(coil.index == k.index) * way for coil, way in sides] for k in self.section.layout.coils]
        return np.array(factors) @ self.coil_side_loads / self.section.half_slots_per_coil_side

    def load(self, point: OperatingState) -> np.ndarray:
        """Right-hand side (n,) [A] of magnets and currents."""
        return self.magnet_loads.sum(0) + point.current_load(self)

    # ---- the linear part and the turning rotor -----------------------------------------------------------------

    def band_elements(self, rest: float) -> Elements:
        """The rotor side of the gap, sheared so that the sliding circle moves by -rest [rad] against the rotor."""
        corners = self.section.mesh.p[:, self.section.mesh.t[:, self.rotor_band]]
        if rest != 0.0:
            corners = _shear(corners, rest, self.section.rotor_gap)
        return Elements.of(self.order, corners, self.elements.dofs[:, self.rotor_band])

    @cached_property
    def _linear_values(self) -> np.ndarray:
        """Entries of the linear part without the rotor side of the gap."""
        which = self.topology.linear
        elements = self.elements.take(which)
        return self.topology.linear_entries.sum(elements.stiffness(self._reluctivity[which]))

    @cached_property
    def _reluctivity(self) -> np.ndarray:
        """Of air, copper and magnets, per element of the mesh [m/H]."""
        reluctivity = np.full(self.section.mesh.nelements, 1 / MU_0)
        for m in range(self.section.magnets):
            reluctivity[self.topology.regions[f"magnet_{m}"]] /= self.materials.magnet_at(m).recoil_permeability
        return reluctivity

    def _join(self, turn: Turn) -> JoinedSystem:
        if self._joined is None or self._joined[0] != turn:
            pattern, entries = self.topology.pattern(turn.edges)
            band = entries.sum(self.band_elements(turn.rest).stiffness(1 / MU_0))
            self._joined = turn, JoinedSystem(pattern, (self._linear_values, band))
        return self._joined[1]

    # ---- Newton -----------------------------------------------------------------------------------------------

    def solve(self, point: OperatingState, start: FieldSolution | None = None) -> FieldSolution:
        """Field of an operating point by Newton's method.

        start: a solution of this model to start from (a neighbouring current or angle); without one, quadratic elements
            start from the solution of linear ones on the same mesh, which costs a tenth of a quadratic iteration each
        Raises FieldSolutionError when the iteration does not converge.
        """
        began = process_time()
        problem = _Problem(self, point)
        first = problem.free_values(self._coarse_potential(point) if start is None else start.a)
        with one_thread():
            u, record = newton(first, np.linalg.norm(problem.load), problem.residual, problem.direction, self.settings)
        return FieldSolution(self, point, problem.expand(u), record, process_time() - began)

    def residual(self, point: OperatingState, a: np.ndarray) -> np.ndarray:
        """Load minus field forces of any potential a (n,) at the free unknowns (m,) [A]; zero for the solution."""
        problem = _Problem(self, point)
        return problem.residual(problem.free_values(a))

    def tangent(self, solution: FieldSolution) -> TangentSystem:
        """The tangent matrix at a solution of this model, factorised."""
        problem = _Problem(self, solution.point)
        return TangentSystem(problem, problem.system.factorise(self._iron_tangent(solution.a)))

    def _coarse_potential(self, point: OperatingState) -> np.ndarray:
        """Potential to start from: zero for linear elements, their solution for quadratic ones (n,)."""
        if self.order is LINEAR:
            return np.zeros(self.size)
        return refine_order(self.topology.facets, self._coarse_model.solve(point).a)

    @cached_property
    def _coarse_model(self) -> FieldModel:
        return FieldModel(self.section, self.materials, _COARSE, topology=self._coarse_topology)

    @cached_property
    def _coarse_topology(self) -> Topology:
        return Topology(self.section, LINEAR)

    def _iron_force(self, a: np.ndarray) -> np.ndarray:
        """integral nu(|B|^2) grad A . grad v over the iron (n,)."""
        total = np.zeros(self.size)
        for elements, law in self._laws:
            x, y = elements.gradient(a)
            nu = law.nu(x * x + y * y)
            total += elements.scatter(elements.forces(nu * x, nu * y), self.size)
        return total

    def _iron_tangent(self, a: np.ndarray) -> np.ndarray:
        """Local tangent matrices of the iron (K, E)."""
        return np.concatenate([_tangent(elements, law, a) for elements, law in self._laws], axis=1)


class _Problem:
    """One operating point of a model in terms of its free unknowns u (m,)."""

    def __init__(self, model: FieldModel, point: OperatingState):
        turn = model.unknowns.turn(point.angle)
        self.model, self.system = model, model._join(turn)
        self.column, self.sign = model.unknowns.turned(turn.edges)
        self.load = self.reduce(model.load(point))

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
        return self.load - self.system.linear_product(u) - self.reduce(self.model._iron_force(self.expand(u)))

    def direction(self, u: np.ndarray, residual: np.ndarray) -> np.ndarray:
        """Newton step (m,)."""
        return self.system.factorise(self.model._iron_tangent(self.expand(u))).solve(residual)


@dataclass(frozen=True, eq=False)
class TangentSystem:
    """Answers how the field changes: small load in, small change of the potential out.

    It is good until the model, or another one that shares its topology, is solved at the same turn of the rotor.
    """

    problem: _Problem
    system: SymmetricSystem

    def response(self, load: np.ndarray) -> np.ndarray:
        """Change of the potential (n,) for a change of the load: (n,) on all, or (m,) on the free unknowns [A]."""
        reduced = load if len(load) == self.problem.model.unknowns.count else self.problem.reduce(load)
        return self.problem.expand(self.system.solve(reduced))


def _check_magnets(section: CrossSection, materials: MachineMaterials) -> None:
    unknown = [number for number, _ in materials.other_magnets if not 0 <= number < section.machine.poles]
    if unknown:
        raise GeometryError(f"there is no magnet {unknown[0]}: they are numbered from 0 to {section.machine.poles - 1}")
    if materials.other_magnets and section.sectors > 1:
        raise GeometryError(
            f"magnets that differ break the symmetry of the machine, but 1/{section.sectors} of it is meshed: "
            "mesh the whole machine (mesh_cross_section(..., whole=True))"
        )


def _tangent(elements: Elements, law: Reluctivity, a: np.ndarray) -> np.ndarray:
    """nu grad phi_i . grad phi_j + 2 nu' (grad A . grad phi_i)(grad A . grad phi_j), integrated (K, E)."""
    x, y = elements.gradient(a)
    nu, slope = law.nu_and_derivative(x * x + y * y)
    along = elements.gradient_x * x + elements.gradient_y * y
    weighted = along * (2 * slope * elements.weights)
    i, j = elements.order.pairs
    return np.einsum("kqe,qe->ke", elements.stiffness_basis, nu) + np.einsum("kqe,kqe->ke", along[i], weighted[j])


def _shear(corners: np.ndarray, rest: float, gap: GapHalf) -> np.ndarray:
    """Turn points (2, 3, E) of the rotor-side gap by -rest in proportion to their height above the rotor."""
    x, y = corners
    radius = np.hypot(x, y)
    angle = np.arctan2(y, x) - rest * np.clip(1 - gap.height(corners), 0.0, 1.0)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)])
