"""How fast the error falls with the mesh: A in the L2 norm as h^(k+1), energy as h^(2k), for functions of degree k.

Manufactured solution on a square with irregular triangles, linear and saturating: with any A(x, y) that vanishes on the
boundary, the load integral H . grad v with H = nu(|grad A|^2) grad A makes A the solution.
"""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve
from skfem import MeshTri
from skfem.quadrature import get_quadrature

from magnetostatics.elements import LINEAR, QUADRATIC, Elements, TriangleOrder, element_dofs
from magnetostatics.model import OperatingPoint
from magnetostatics.newton import NewtonSettings, newton
from materials.library import load_steel
from materials.reluctivity import LinearReluctivity, Reluctivity
from tests.physics.slotless_ring import (
    EXACT,
    POLE_PAIRS,
    Ring,
    SheetModel,
    exact_radial_harmonic,
    radial_harmonic,
    ring_section,
)

pytestmark = pytest.mark.physics

PEAK = 1.6 / pi  # Wb/m: the flux density reaches 1.6 T
DEGREE_OF = {"linear": 1, "quadratic": 2}
ORDERS = {"linear": LINEAR, "quadratic": QUADRATIC}
both_orders = pytest.mark.parametrize("name", ORDERS)


class SmoothSaturation(Reluctivity):
    """H = (200 + 300 B^2) B: a polynomial, so that no kink of a table limits the order."""

    def nu_and_derivative(self, b2):
        return 200.0 + 300.0 * b2, np.full_like(b2, 300.0)

    def field_strength(self, b):
        return (200.0 + 300.0 * b**2) * b

    def energy_density(self, b):
        return 100.0 * b**2 + 75.0 * b**4


LAWS = {"air": LinearReluctivity(1.0), "smooth steel": SmoothSaturation(), "35PN270": load_steel("35PN270")}


def exact_potential(x, y):
    return PEAK * np.sin(pi * x) * np.sin(pi * y)


def exact_gradient(x, y):
    return PEAK * pi * np.cos(pi * x) * np.sin(pi * y), PEAK * pi * np.sin(pi * x) * np.cos(pi * y)


def irregular_square() -> MeshTri:
    """Unit square of 32 triangles with its inner nodes moved about."""
    mesh = MeshTri().refined(2)
    inner = mesh.interior_nodes()
    moved = mesh.p.copy()
    moved[:, inner] += 0.06 * np.sin(np.array([[7.0], [11.0]]) * (1 + np.arange(len(inner))))
    return MeshTri(moved, mesh.t)


def fine_quadrature(order: TriangleOrder) -> TriangleOrder:
    """The same functions at points that integrate polynomials of degree 8 exactly."""
    points, weights = get_quadrature(order.element, 8)
    values, gradients = zip(*(order.element.lbasis(points, i) for i in range(len(order.values))))
    gradients = np.stack([np.broadcast_to(np.stack(np.broadcast_arrays(*g)), (2, len(weights))) for g in gradients])
    values = np.stack([np.broadcast_to(v, weights.shape) for v in values])
    return TriangleOrder(order.element, values, gradients, points, weights, order.pairs)


def iron_tangent(elements: Elements, law: Reluctivity, a: np.ndarray, size: int) -> sp.csc_matrix:
    """integral (nu grad u . grad v + 2 nu' (grad A . grad u)(grad A . grad v)), assembled by scipy."""
    x, y = elements.gradient(a)
    nu, slope = law.nu_and_derivative(x * x + y * y)
    along = elements.gradient_x * x + elements.gradient_y * y
    local = np.einsum("iqe,jqe,qe->ije", elements.gradient_x, elements.gradient_x, nu * elements.weights)
    local += np.einsum("iqe,jqe,qe->ije", elements.gradient_y, elements.gradient_y, nu * elements.weights)
    local += np.einsum("iqe,jqe,qe->ije", along, along, 2 * slope * elements.weights)
    rows, columns = np.broadcast_arrays(elements.dofs[:, None], elements.dofs[None])
    return sp.csc_matrix((local.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))


def solve_square(mesh: MeshTri, law: Reluctivity, order: TriangleOrder):
    """(elements with fine quadrature, degrees of freedom a) of the manufactured problem; elements, law and Newton's
    method are the solver's own."""
    dofs, size = element_dofs(mesh, order)
    elements, fine = (Elements.of(one, mesh.p, mesh.t, dofs) for one in (order, fine_quadrature(order)))
    fixed = mesh.boundary_facets()
    is_free = np.ones(size, dtype=bool)
    is_free[np.unique(mesh.facets[:, fixed])] = False
    if order is QUADRATIC:
        is_free[mesh.p.shape[1] + fixed] = False
    free = np.flatnonzero(is_free)

    def full(u):
        a = np.zeros(size)
        a[free] = u
        return a

    def force(a):
        x, y = elements.gradient(a)
        nu = law.nu(x * x + y * y)
        return elements.scatter(elements.forces(nu * x, nu * y), size)

    def step(u, residual):
        return spsolve(iron_tangent(elements, law, full(u), size)[free][:, free], residual)

    x, y = exact_gradient(*fine.points)
    nu = law.nu(x * x + y * y)
    load = fine.scatter(fine.forces(nu * x, nu * y), size)[free]
    settings = NewtonSettings(tolerance=1e-10)
    u, _ = newton(np.zeros(len(free)), np.linalg.norm(load), lambda u: load - force(full(u))[free], step, settings)
    return fine, full(u)


def coenergy(fine, a, law) -> float:
    """integral (H . grad a - w(grad a)) with H of the exact field: largest for the exact solution."""
    (x, y), exact = fine.gradient(a), exact_gradient(*fine.points)
    nu = law.nu(exact[0] ** 2 + exact[1] ** 2)
    return (((x * exact[0] + y * exact[1]) * nu - law.energy_density(np.hypot(x, y))) * fine.weights).sum()


def exact_coenergy(fine, law) -> float:
    return (law.coenergy_density(np.hypot(*exact_gradient(*fine.points))) * fine.weights).sum()


def errors(mesh, law, order) -> tuple[float, float]:
    """(L2 error of A, error of the co-energy, whose derivatives are torque and flux linkage)."""
    fine, a = solve_square(mesh, law, order)
    difference = np.einsum("iq,ie->qe", fine.order.values, a[fine.dofs]) - exact_potential(*fine.points)
    missing = exact_coenergy(fine, law) - coenergy(fine, a, law)
    return float(np.sqrt((difference**2 * fine.weights).sum())), float(missing)


def observed_orders(law, order, levels=(2, 3)) -> np.ndarray:
    """Orders of (A, co-energy) when the elements are halved."""
    found = np.array([errors(irregular_square().refined(level), law, order) for level in levels])
    return np.log2(found[0] / found[1])


@pytest.mark.parametrize("law", ("air", "smooth steel"))
@both_orders
def test_order_of_potential_and_coenergy(name, law):
    k = DEGREE_OF[name]
    a, energy = observed_orders(LAWS[law], ORDERS[name])
    assert abs(a - (k + 1)) < 0.2
    assert abs(energy - 2 * k) < 0.2


@both_orders
def test_order_of_potential_in_the_steel_of_the_machine(name):
    """The kinks in the second derivative of a measured curve do not cost order."""
    a, _ = observed_orders(LAWS["35PN270"], ORDERS[name])
    assert abs(a - (DEGREE_OF[name] + 1)) < 0.2


def ring_errors(edges_per_half_slot: int, order) -> tuple[float, float, float]:
    """Relative errors of A (L2), co-energy and first harmonic in the gap of the slotless ring with a current sheet."""
    ring, sheet = Ring(), 3e4
    section = ring_section(ring.machine, edges_per_half_slot, max(1, edges_per_half_slot // 4))
    model = SheetModel(section, ring.materials, EXACT, order, sheet=sheet, magnets=0.0)
    solution = model.solve(OperatingPoint(0.0))
    field, bore = ring.field(POLE_PAIRS, magnets=0.0, sheet=sheet), ring.machine.slot_bottom_radius
    coenergy = section.sectors * model.load(solution.point) @ solution.a / 2
    exact_coenergy = pi / 2 * bore * sheet * field.potential(bore).real
    harmonic = radial_harmonic(solution, POLE_PAIRS) / exact_radial_harmonic(ring, POLE_PAIRS, magnets=0.0, sheet=sheet)
    return _potential_error(solution, field), abs(coenergy / exact_coenergy - 1), abs(harmonic - 1)


def _potential_error(solution, field) -> float:
    """L2 error of A over copper and gap, relative to its size."""
    model, mesh = solution.model, solution.model.section.mesh
    radius = np.hypot(*mesh.p[:, mesh.t].mean(axis=1))
    machine = model.section.machine
    which = np.flatnonzero((radius > machine.mid_gap_radius) & (radius < machine.slot_bottom_radius))
    elements = Elements.of(fine_quadrature(model.order), mesh.p, mesh.t[:, which], model.elements.dofs[:, which])
    found = np.einsum("iq,ie->qe", elements.order.values, solution.a[elements.dofs])
    x, y = elements.points
    amplitude = np.array([field.potential(r) for r in np.hypot(x, y).ravel()]).reshape(x.shape)
    exact = (amplitude * np.exp(1j * POLE_PAIRS * np.arctan2(y, x))).real
    return float(np.sqrt(((found - exact) ** 2 * elements.weights).sum() / (exact**2 * elements.weights).sum()))


@both_orders
def test_orders_on_the_ring(name):
    """Straight edges in place of arcs: A and B stay at h^2 for quadratic functions too, energy still reaches h^(2k)."""
    coarse, fine = np.array([ring_errors(edges, ORDERS[name]) for edges in (4, 8)])
    a, energy, harmonic = np.log2(coarse / fine)
    assert abs(a - 2) < 0.2
    assert abs(energy - 2 * DEGREE_OF[name]) < 0.2
    assert abs(harmonic - 2) < 0.2


def test_quadratic_functions_are_worth_a_refinement():
    """On one mesh of the ring: A and the gap field some five times closer, co-energy a thousand times."""
    linear, quadratic = np.array([ring_errors(6, order) for order in (LINEAR, QUADRATIC)])
    assert (linear / quadratic > (4, 1000, 4)).all()
