"""The field of a machine as a weak form in scikit-fem, term by term as it stands on paper: new physics starts here.

    curl (nu curl A) = J + curl (nu_m B_r)       A = (0, 0, A) per metre of length,  B = (dA/dy, -dA/dx)

times a test function v and integrated by parts: find A so that for all v

    integral nu(|B|^2) grad A . grad v  =  integral J v + integral nu_m (B_rx dv/dy - B_ry dv/dx)

A = 0 on the outside of the stator, A = +-A from one end of a sector to the other, and rotor and stator meet on the
sliding circle. Newton's method solves it: the step d from A follows from the residual R(v), right minus left side,

    integral nu grad d . grad v + 2 nu' (grad A . grad d) (grad A . grad v)  =  R(v)

``magnetostatics/model.py`` solves the same problem on the same triangles by hand-written assembly and a factorisation
whose symbolic part is kept, six to ten times faster from the mesh on and up to eighteen times where its numbering is
there already (``benchmarks/other_codes.py`` measures it); a test holds the two together.
A new term, say eddy currents, an anisotropic nu or a magnet that demagnetises, is a form here before it is fast there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from skfem import Basis, BilinearForm, DiscreteField, Functional, LinearForm, MeshTri, asm, solve
from skfem.assembly.form.form import FormExtraParams
from skfem.helpers import dot, grad

from geometry.cross_section import CrossSection
from magnetostatics.elements import QUADRATIC, TriangleOrder
from magnetostatics.local_steel import law_in
from magnetostatics.model import MachineMaterials
from magnetostatics.newton import FieldSolutionError
from magnetostatics.topology import IRON, Topology
from units import MU_0

_MOST_ITERATIONS = 50
_SMALLEST_STEP = 1.0 / 1024

# ---- the terms: u, v trial and test function, w.a the potential, w.<name> what ``WeakForm`` gives at every point -----


@LinearForm
def field_forces(v: DiscreteField, w: FormExtraParams) -> np.ndarray:
    """Integrand [A/m^2], (E, Q), of integral nu grad A . grad v."""
    return w.nu * dot(grad(w.a), grad(v))


@BilinearForm
def tangent(u: DiscreteField, v: DiscreteField, w: FormExtraParams) -> np.ndarray:
    """Integrand [1/(H m)], (E, Q), of integral nu grad u . grad v + 2 nu' (grad A . grad u) (grad A . grad v)."""
    return w.nu * dot(grad(u), grad(v)) + 2 * w.slope * dot(grad(w.a), grad(u)) * dot(grad(w.a), grad(v))


@LinearForm
def current(v: DiscreteField, w: FormExtraParams) -> np.ndarray:
    """Integrand [A/m^2], (E, Q), of integral J v."""
    return w.density * v


@LinearForm
def magnets(v: DiscreteField, w: FormExtraParams) -> np.ndarray:
    """Integrand [A/m^2], (E, Q), of integral nu_m (B_rx dv/dy - B_ry dv/dx)."""
    return w.coercive_field[0] * grad(v)[1] - w.coercive_field[1] * grad(v)[0]


@Functional
def ring_torque(w: FormExtraParams) -> np.ndarray:
    """integral of the Maxwell stress times grad h about the axis, h from 0 to 1 over the stator half of the gap.

    ring_torque: the integrand [N/m^2], (E, Q)
    """
    (x, y), b = w.x, np.stack([grad(w.a)[1], -grad(w.a)[0]])
    force = (b * dot(b, w.upwards) - dot(b, b) / 2 * w.upwards) / MU_0
    return x * force[1] - y * force[0]


# ---- the machine they stand in --------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class WeakSolution:
    """What a weak form was solved to; per metre, torque and flux linkage of the whole machine.

    a: vector potential (n,) [Wb/m], numbered as in ``FieldSolution``
    flux_linkage: of phases A, B, C (3,) [Wb/m per turn of each coil]; torque: as ``arkkio_torque`` [Nm/m]
    residuals: before every step and behind the last, relative to the load
    """

    a: np.ndarray
    flux_linkage: np.ndarray
    torque: float
    residuals: tuple[float, ...]


class WeakForm:
    """A meshed cross-section with its materials and its rotor at one angle [rad], mechanical, as in ``OperatingPoint``.

    degree: of the polynomials that the quadrature integrates exactly; 2 is that of ``FieldModel``
    Arrays over the mesh are (E, Q) as in scikit-fem: element, quadrature point.
    """

    def __init__(
        self,
        section: CrossSection,
        materials: MachineMaterials,
        angle: float,
        order: TriangleOrder = QUADRATIC,
        degree: int = 2,
    ) -> None:
        topology = Topology(section, order)
        turn = topology.unknowns.turn(angle)
        column, sign = topology.unknowns.turned(turn.edges)
        self.section, self.materials, self.regions = section, materials, section.mesh.subdomains
        self.basis = Basis(_sheared(section, topology.rotor_band, turn.rest), order.element, intorder=degree)
        self.stator_gap = np.setdiff1d(self.regions["gap"], topology.rotor_band)
        # a = P u: every degree of freedom is plus or minus a free unknown (sector, sliding circle), or zero (outside).
        self.P = sp.csr_matrix((sign, (np.arange(topology.size), column)), (topology.size, topology.unknowns.count))

    def reluctivity(self, b2: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """nu [m/H] and dnu/d(b2) (E, Q) at the squared flux density b2 (E, Q) [T^2]."""
        nu, slope = np.full_like(b2, 1 / MU_0), np.zeros_like(b2)
        for name, steel in zip(IRON, (self.materials.stator_steel, self.materials.rotor_steel)):
            where, law = self.regions[name], law_in(steel, self.section, name)
            nu[where], slope[where] = (values.T for values in law.nu_and_derivative(b2[where].T))
        for number in range(self.section.magnets):
            nu[self.regions[f"magnet_{number}"]] /= self.materials.magnet_at(number).recoil_permeability
        return nu, slope

    def coercive_field(self) -> np.ndarray:
        """nu_m B_r (2, E, Q) [A/m] of the magnets, of which every other one points inwards; zero elsewhere."""
        points = np.asarray(self.basis.global_coordinates())
        field = np.zeros_like(points)
        for number in range(self.section.magnets):
            where, magnet = self.regions[f"magnet_{number}"], self.materials.magnet_at(number)
            direction = self.section.magnetisation_angle(number, points[:, where]) + magnet.axis_error
            strength = self.section.polarity(number) * magnet.coercive_field
            field[:, where] = strength * np.stack([np.cos(direction), np.sin(direction)])
        return field

    def turn_densities(self) -> np.ndarray:
        """Current density (3, E, Q) [1/m^2] of 1 A in one turn of every coil of phases A, B, C, even in a coil side."""
        densities = np.zeros((3, *self.basis.dx.shape))
        for slot, side in self.section.coil_sides:
            where, (coil, way) = self.regions[f"slot_{slot}_{side}"], self.section.layout.coil_at(slot, side)
            area = self.basis.dx[where].sum() * self.section.half_slots_per_coil_side
            densities[coil.phase, where] = way * coil.sign * coil.turns / area
        return densities

    def solve(self, ampere_turns: np.ndarray, tolerance: float = 1e-10) -> WeakSolution:
        """The field of the magnets and of currents, by Newton's method from zero field.

        ampere_turns: of one coil of phases A, B, C (3,) [A], see ``OperatingPoint.ampere_turns``
        tolerance: residual relative to the load
        Raises FieldSolutionError when it is not reached.
        """
        turns = np.stack([asm(current, self.basis, density=density) for density in self.turn_densities()])
        load = asm(magnets, self.basis, coercive_field=self.coercive_field()) + ampere_turns @ turns
        a, residuals = self._newton(load, tolerance)
        return WeakSolution(a, self.section.sectors * turns @ a, self._torque(a), residuals)

    def _newton(self, load: np.ndarray, tolerance: float) -> tuple[np.ndarray, tuple[float, ...]]:
        residuals: list[float] = []
        u, scale = np.zeros(self.P.shape[1]), np.linalg.norm(self.P.T @ load)
        while len(residuals) < _MOST_ITERATIONS:
            r = self._residual(u, load)
            residuals.append(float(np.linalg.norm(r) / scale) if scale else 0.0)
            if residuals[-1] <= tolerance:
                return self.P @ u, tuple(residuals)
            matrix = self.P.T @ asm(tangent, self.basis, **self._state(u)) @ self.P
            u = self._stepped(u, solve(matrix, r), load, r)
        raise FieldSolutionError(f"residuals {residuals} relative to the load, asked for {tolerance:g}")

    def _stepped(self, u: np.ndarray, step: np.ndarray, load: np.ndarray, r: np.ndarray) -> np.ndarray:
        """u plus the step, halved until the energy's slope along it, -R . step, is no steeper behind it than before it.

        The energy of every law here is convex, so that a short step always passes. Source: Matthies, Strang, "The
        solution of nonlinear finite element equations", Int. J. Numer. Methods Eng. 14 (1979) 1613-1626.
        """
        length = 1.0
        while length > _SMALLEST_STEP and abs(self._residual(u + length * step, load) @ step) > r @ step:
            length /= 2
        return u + length * step

    def _residual(self, u: np.ndarray, load: np.ndarray) -> np.ndarray:
        return self.P.T @ (load - asm(field_forces, self.basis, **self._state(u)))

    def _state(self, u: np.ndarray) -> dict[str, np.ndarray | DiscreteField]:
        """The potential and what depends on it, as the forms name it."""
        field = self.basis.interpolate(self.P @ u)
        nu, slope = self.reluctivity(dot(grad(field), grad(field)))
        return {"a": field, "nu": nu, "slope": slope}

    def _torque(self, a: np.ndarray) -> float:
        gap = Basis(self.basis.mesh, self.basis.elem, elements=self.stator_gap, quadrature=self.basis.quadrature)
        upwards = self.section.stator_gap.gradient(np.asarray(gap.global_coordinates()))
        return float(self.section.sectors * asm(ring_torque, gap, a=a, upwards=upwards))


def _sheared(section: CrossSection, rotor_band: np.ndarray, rest: float) -> MeshTri:
    """The mesh with the rotor side of the gap sheared: the sliding circle moves by -rest [rad] against the rotor."""
    nodes, points = np.unique(section.mesh.t[:, rotor_band]), section.mesh.p.copy()
    points[:, nodes] = section.rotor_gap.sheared(points[:, nodes], -rest)
    return replace(section.mesh, doflocs=points)
