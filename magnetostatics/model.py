"""The field problem of one cross-section: materials, currents and rotor angle in, vector potential out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi
from time import process_time

import numpy as np

from geometry.cross_section import CrossSection
from magnetostatics.assembly import Entries, JoinedSystem
from magnetostatics.elements import LINEAR, QUADRATIC, Elements, TriangleOrder, element_dofs, refine_order
from magnetostatics.newton import NewtonRecord, NewtonSettings, newton
from magnetostatics.unknowns import Turn, number_unknowns
from materials.magnet import Magnet
from materials.reluctivity import Reluctivity
from units import MU_0


_COARSE = NewtonSettings(tolerance=1e-3)  # of the linear elements that quadratic ones start from


@dataclass(frozen=True)
class MachineMaterials:
    """What the regions of a machine are made of."""

    stator_steel: Reluctivity
    rotor_steel: Reluctivity
    magnet: Magnet


@dataclass(frozen=True)
class OperatingPoint:
    """Rotor angle and slot currents.

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


@dataclass(frozen=True, eq=False)
class FieldSolution:
    """Vector potential a (n,) [Wb/m] of one operating point and how it was found."""

    model: FieldModel
    point: OperatingPoint
    a: np.ndarray
    newton: NewtonRecord
    cpu_seconds: float


class FieldModel:
    """Assembles and solves the field of one meshed cross-section with given materials.

    What depends on neither current nor angle is prepared once. The system joined at an angle is kept until another angle
    is asked for, so that several currents at one angle share its analysis.
    """

    def __init__(
        self,
        section: CrossSection,
        materials: MachineMaterials,
        settings: NewtonSettings = NewtonSettings(),
        order: TriangleOrder = QUADRATIC,
    ):
        self.section, self.materials, self.settings, self.order = section, materials, settings, order
        dofs, self.size = element_dofs(section.mesh, order)
        self.elements = Elements.of(order, section.mesh.p[:, section.mesh.t], dofs)
        self.unknowns = number_unknowns(section, order)
        self._laws = ((self._region("stator_iron"), materials.stator_steel), (self._region("rotor_iron"), materials.rotor_steel))
        self._joined: tuple[Turn, JoinedSystem] | None = None

    def _region(self, name: str) -> Elements:
        return self.elements.take(self.section.mesh.subdomains[name])

    # ---- sources ----------------------------------------------------------------------------------------------

    @cached_property
    def magnet_loads(self) -> np.ndarray:
        """integral nu (B_rx dv/dy - B_ry dv/dx) of every magnet in the sector (magnets, n) [A]."""
        return np.stack([self._magnet_load(m) for m in range(self.section.magnets)])

    def _magnet_load(self, number: int) -> np.ndarray:
        elements = self._region(f"magnet_{number}")
        machine, magnet = self.section.machine, self.materials.magnet
        x, y = elements.points
        direction = machine.magnetisation.direction_angle(np.arctan2(y, x), number * machine.pole_pitch)
        strength = (-1) ** number * magnet.remanence / (MU_0 * magnet.recoil_permeability)
        return elements.scatter(elements.forces(-strength * np.sin(direction), strength * np.cos(direction)), self.size)

    @cached_property
    def coil_side_loads(self) -> np.ndarray:
        """Mean over each half slot, as a load: 1 A in each coil side (2 * teeth, n)."""
        regions = [self._region(f"slot_{slot}_{side}") for slot, side in self.section.coil_sides]
        return np.stack([elements.scatter(elements.means(), self.size) for elements in regions])

    @cached_property
    def phase_loads(self) -> np.ndarray:
        """Load of 1 A in one turn of every coil of phases A, B, C (3, n); as a product with a it is flux linkage."""
        sides = [self.section.layout.coil_side(*side) for side in self.section.coil_sides]
        signs = np.array([[sign if phase == i else 0.0 for phase, sign in sides] for i in range(3)])
        return signs @ self.coil_side_loads / self.section.half_slots_per_coil_side

    def load(self, point: OperatingPoint) -> np.ndarray:
        """Right-hand side (n,) [A] of magnets and currents."""
        densities = point.phase_densities(self.section.machine.pole_pairs, self.section.layout.phase_axis)
        area = self.section.half_slot_area * self.section.half_slots_per_coil_side
        ampere_turns = densities * point.packing_factor * area
        return self.magnet_loads.sum(0) + ampere_turns @ self.phase_loads

    # ---- the linear part and the turning rotor -----------------------------------------------------------------

    @cached_property
    def rotor_band(self) -> np.ndarray:
        """Elements of the gap on the rotor side of the sliding circle: the only ones that change with the angle."""
        mesh = self.section.mesh
        gap = mesh.subdomains["gap"]
        centroids = mesh.p[:, mesh.t[:, gap]].mean(axis=1)
        return gap[np.hypot(*centroids) < self.section.machine.mid_gap_radius]

    def band_elements(self, rest: float) -> Elements:
        """The rotor side of the gap, sheared so that the sliding circle moves by -rest [rad] against the rotor."""
        corners = self.section.mesh.p[:, self.section.mesh.t[:, self.rotor_band]]
        if rest != 0.0:
            corners = _shear(corners, rest, self.section.machine)
        return Elements.of(self.order, corners, self.elements.dofs[:, self.rotor_band])

    @cached_property
    def _iron_entries(self) -> Entries:
        dofs = np.concatenate([elements.dofs for elements, _ in self._laws], axis=1)
        return Entries.of(self.order.pairs, dofs, self.unknowns.column, self.unknowns.sign, self.unknowns.count)

    @cached_property
    def _linear(self) -> tuple[np.ndarray, np.ndarray]:
        """(keys, values) of the linear part without the rotor side of the gap."""
        reluctivity = self._linear_reluctivity()
        reluctivity[self.rotor_band] = 0.0
        which = np.flatnonzero(reluctivity)
        elements = self.elements.take(which)
        entries = Entries.of(self.order.pairs, elements.dofs, self.unknowns.column, self.unknowns.sign, self.unknowns.count)
        return entries.keys, entries.sum(elements.stiffness_basis.sum(1) * reluctivity[which])

    def _linear_reluctivity(self) -> np.ndarray:
        subdomains = self.section.mesh.subdomains
        reluctivity = np.full(self.section.mesh.nelements, 1 / MU_0)
        for m in range(self.section.magnets):
            reluctivity[subdomains[f"magnet_{m}"]] /= self.materials.magnet.recoil_permeability
        for name in ("stator_iron", "rotor_iron"):
            reluctivity[subdomains[name]] = 0.0
        return reluctivity

    def _join(self, turn: Turn) -> JoinedSystem:
        if self._joined is None or self._joined[0] != turn:
            column, sign = self.unknowns.turned(turn.edges)
            band = self.band_elements(turn.rest)
            entries = Entries.of(self.order.pairs, band.dofs, column, sign, self.unknowns.count)
            values = entries.sum(band.stiffness_basis.sum(1) / MU_0)
            keys, linear = self._linear
            self._joined = turn, JoinedSystem(self._iron_entries, linear, keys, entries, values, self.unknowns.count)
        return self._joined[1]

    # ---- Newton -----------------------------------------------------------------------------------------------

    def solve(self, point: OperatingPoint, start: FieldSolution | None = None) -> FieldSolution:
        """Field of an operating point by Newton's method.

        start: a solution of this model to start from (a neighbouring current or angle); without one, quadratic elements
            start from the solution of linear ones on the same mesh, which costs a tenth of a quadratic iteration each
        Raises FieldSolutionError when the iteration does not converge.
        """
        began = process_time()
        turn = self.unknowns.turn(point.angle)
        system = self._join(turn)
        column, sign = self.unknowns.turned(turn.edges)
        load = self._reduce(self.load(point), column, sign)

        def expand(u):
            return u[column] * sign

        def residual(u):
            return load - system.linear_product(u) - self._reduce(self._iron_force(expand(u)), column, sign)

        def direction(u, r):
            return system.factorise(self._iron_tangent(expand(u))).solve(r)

        first = self._free_values(self._coarse_potential(point) if start is None else start.a)
        u, record = newton(first, np.linalg.norm(load), residual, direction, self.settings)
        return FieldSolution(self, point, expand(u), record, process_time() - began)

    def _coarse_potential(self, point: OperatingPoint) -> np.ndarray:
        """Potential to start from: zero for linear elements, their solution for quadratic ones (n,)."""
        if self.order is LINEAR:
            return np.zeros(self.size)
        return refine_order(self.section.mesh, self._coarse_model.solve(point).a)

    @cached_property
    def _coarse_model(self) -> FieldModel:
        return FieldModel(self.section, self.materials, _COARSE, LINEAR)

    def _reduce(self, vector: np.ndarray, column: np.ndarray, sign: np.ndarray) -> np.ndarray:
        return np.bincount(column, weights=vector * sign, minlength=self.unknowns.count)

    def _free_values(self, a: np.ndarray) -> np.ndarray:
        free = np.zeros(self.unknowns.count)
        known = (self.unknowns.sign == 1) & ~np.isin(np.arange(self.size), self.unknowns.rotor_slide)
        free[self.unknowns.column[known]] = a[known]
        return free

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


def _tangent(elements: Elements, law: Reluctivity, a: np.ndarray) -> np.ndarray:
    """nu grad phi_i . grad phi_j + 2 nu' (grad A . grad phi_i)(grad A . grad phi_j), integrated (K, E)."""
    x, y = elements.gradient(a)
    nu, slope = law.nu_and_derivative(x * x + y * y)
    along = elements.gradient_x * x + elements.gradient_y * y
    weighted = along * (2 * slope * elements.weights)
    i, j = elements.order.pairs
    return np.einsum("kqe,qe->ke", elements.stiffness_basis, nu) + np.einsum("kqe,kqe->ke", along[i], weighted[j])


def _shear(corners: np.ndarray, rest: float, machine) -> np.ndarray:
    """Turn points (2, 3, E) of the rotor-side gap by -rest in proportion to their height above the rotor."""
    x, y = corners
    radius = np.hypot(x, y)
    height = (radius - machine.rotor_outer_radius) / (machine.mid_gap_radius - machine.rotor_outer_radius)
    angle = np.arctan2(y, x) - rest * np.clip(height, 0.0, 1.0)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)])
