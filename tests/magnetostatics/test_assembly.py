"""The fast assembly against plain formulas on the machine: every element integral, sum and tangent by another route."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from numpy.testing import assert_allclose
from skfem.assembly import Dofs

from magnetostatics.assembly import Entries
from magnetostatics.elements import LINEAR, QUADRATIC, element_dofs, lower_order, refine_order
from magnetostatics.iron import _SERIES
from magnetostatics.model import OperatingPoint, _Problem
from magnetostatics.passes import merged
from tests.magnetostatics.reference_machine import STEEL, model_of, reference_machine
from units import DEGREE

POINT = OperatingPoint(-20.3 * DEGREE, 12e6)
orders = pytest.mark.parametrize("order", (LINEAR, QUADRATIC), ids=("linear", "quadratic"))


def state(order):
    model = model_of(reference_machine(), order=order)
    solution = model.solve(POINT)
    column, sign = model.topology.iron_unknowns
    problem = _Problem(model, POINT, model.load(POINT))
    return model, problem, problem.free_values(solution.a), column, sign


@orders
def test_forces_of_the_iron(order):
    """Against the quadrature of nu grad A . grad v with gradients in metres."""
    model, _, u, column, sign = state(order)
    elements = model.elements.take(model.topology.iron)
    local = u[column] * sign
    x, y = (np.einsum("iqe,ie->qe", part, local) for part in (elements.gradient_x, elements.gradient_y))
    nu = STEEL.nu(x * x + y * y) * elements.weights
    wanted = np.einsum("iqe,qe->ie", elements.gradient_x, nu * x) + np.einsum("iqe,qe->ie", elements.gradient_y, nu * y)
    assert_allclose(model.iron.at(local).forces, wanted, rtol=1e-9, atol=1e-9 * np.abs(wanted).max())


@orders
def test_tangent_is_the_derivative_of_the_forces(order):
    """Local matrices times a direction against the central difference of the local forces."""
    model, _, u, column, sign = state(order)
    local = u[column] * sign
    direction = np.random.default_rng(2).standard_normal(local.shape) * np.abs(local).max()
    product = local_product(order, model.iron.at(local).tangent, direction)
    step = 1e-7
    ends = [model.iron.at(local + sign * step * direction).forces for sign in (1, -1)]
    assert_allclose(product, (ends[0] - ends[1]) / (2 * step), rtol=1e-4, atol=1e-5 * np.abs(product).max())


def local_product(order, entries, local):
    """Local symmetric matrices (K, E) times local vectors (F, E)."""
    product = np.zeros_like(local)
    for k, (row, col) in enumerate(zip(*order.pairs)):
        product[row] += entries[k] * local[col]
        if row != col:
            product[col] += entries[k] * local[row]
    return product


def drawn_back(model, local, beside):
    """Where the tangent after one from ``beside`` touches the laws, what is lacking there, and B there over B."""
    field = model.iron.at(local)
    state, lacking = model.iron.drawn_back(field, model.iron.at(beside))
    return state, lacking, np.sqrt(state.b2 / field.b2)


def test_what_is_lacking_where_the_tangent_touches():
    """f(u) - f(p) + K(p) (p - u), each by itself; fields of linear elements are fields where they are drawn back."""
    model, _, u, column, sign = state(LINEAR)
    local = u[column] * sign
    touching, lacking, share = drawn_back(model, 1.3 * local, local)
    there = share * 1.3 * local
    assert share.min() < 0.95
    assert_allclose(touching.forces, model.iron.at(there).forces, rtol=1e-9, atol=1e-9 * np.abs(lacking).max())
    forces = model.iron.at(1.3 * local).forces - model.iron.at(there).forces
    wanted = forces + local_product(LINEAR.of_distinct_gradients, touching.tangent, there - 1.3 * local)
    assert_allclose(lacking, wanted, atol=1e-9 * np.abs(forces).max())


@orders
def test_field_strength_on_a_tangent(order):
    """nu B + 2 nu' (B_t . (B - B_t)) B_t along B, with gradients in metres and B turned against B_t."""
    model, _, u, column, sign = state(order)
    elements = replace(model.elements.take(model.topology.iron), order=model.iron.elements.order)
    touched = u[column] * sign
    turned = touched + 0.3 * np.abs(touched).max() * np.random.default_rng(4).standard_normal(touched.shape)
    (x, y), (x_t, y_t) = (
        [np.einsum("iqe,ie->qe", part, local) for part in (elements.gradient_x, elements.gradient_y)]
        for local in (turned, touched)
    )
    nu, slope = STEEL.nu_and_derivative(x_t**2 + y_t**2)
    bent = 2 * slope * (x_t * (x - x_t) + y_t * (y - y_t))
    wanted = ((nu * x + bent * x_t) * x + (nu * y + bent * y_t) * y) / np.hypot(x, y)
    found = model.iron.at(turned).strength_on(model.iron.at(touched))
    assert_allclose(found, wanted, rtol=1e-7, atol=1e-7 * np.abs(wanted).max())


@orders
def test_the_tangent_touches_the_law_between_field_and_tangent(order):
    """H there lies on the line H = H_t - n (B - b), to two steps of Newton's method."""
    model, _, u, column, sign = state(order)
    local = u[column] * sign
    at, after = model.iron.at(local), model.iron.at(1.05 * local)
    b, there = np.sqrt(after.b2), np.sqrt(drawn_back(model, 1.05 * local, local)[0].b2)
    slope = at.nu + 2 * at.slope * at.b2
    on_tangent = at.nu * np.sqrt(at.b2) + slope * (b - np.sqrt(at.b2))  # B along itself: the law's own slope
    line = on_tangent - _SERIES * (there - b)
    assert_allclose(STEEL.field_strength(there), line, rtol=0.01, atol=5.0)


@orders
def test_a_field_is_its_own_tangent(order):
    """Where the last tangent touched the law at the field itself nothing is drawn back, nothing is lacking."""
    model, _, u, column, sign = state(order)
    local = u[column] * sign
    touching, lacking, share = drawn_back(model, local, local)
    assert_allclose(share, 1.0, atol=1e-10)
    assert_allclose(touching.tangent, model.iron.at(local).tangent, rtol=1e-9)
    assert np.abs(lacking).max() < 1e-9 * np.abs(touching.forces).max()


@orders
def test_solution_of_the_factorised_tangent(order):
    """K times the answer gives the load back, K by differences of the residual."""
    _, problem, u, _, _ = state(order)
    load = np.random.default_rng(3).standard_normal(len(u))
    answer = problem.factorise(u).solve(load)
    step = 1e-5 * np.abs(u).max() / np.abs(answer).max()
    slope = (problem.residual(u - step * answer) - problem.residual(u + step * answer)) / (2 * step)
    assert_allclose(slope, load, atol=2e-3 * np.abs(load).max())


@orders
def test_numbering_is_that_of_scikit_fem(order):
    mesh = model_of(reference_machine()).section.mesh
    dofs, size = element_dofs(mesh, order)
    wanted = Dofs(mesh, order.element)
    assert size == wanted.N
    assert np.array_equal(dofs, wanted.element_dofs)


def test_entries_are_those_of_scipy():
    """Random triangles, signs and fixed unknowns: the sums are the lower triangle of scipy's assembly."""
    random = np.random.default_rng(4)
    dofs, column = random.integers(0, 40, (3, 60)), random.integers(0, 30, 40)
    sign = random.choice([-1.0, 0.0, 1.0], 40)
    pairs, local = np.tril_indices(3), random.standard_normal((6, 60))
    entries = Entries.of(pairs, dofs, column, sign, 30)
    rows, columns = np.maximum(*column[dofs][list(pairs)]), np.minimum(*column[dofs][list(pairs)])
    values = local * sign[dofs][pairs[0]] * sign[dofs][pairs[1]]
    wanted = sp.coo_matrix((values.ravel(), (rows.ravel(), columns.ravel())), (30, 30)).toarray()
    found = np.zeros((30, 30))
    found[entries.keys % 30, entries.keys // 30] = entries.sum(local)
    assert_allclose(found, wanted, atol=1e-13)
    free = np.flatnonzero((sign[dofs][pairs[0]] * sign[dofs][pairs[1]]).ravel())
    assert set(entries.keys) == set((columns * 30 + rows).ravel()[free])  # fixed unknowns do not fill the pattern
    assert (np.diff(entries.keys) > 0).all()


def test_lower_order_is_the_transpose_of_refine_order():
    """The work of a load on a linear field is the same in both descriptions."""
    facets = model_of(reference_machine()).topology.facets
    random = np.random.default_rng(5)
    linear = random.standard_normal(facets.max() + 1)
    load = random.standard_normal(len(linear) + facets.shape[1])
    assert_allclose(lower_order(facets, load) @ linear, load @ refine_order(facets, linear), rtol=1e-10)


def test_merged_keys_are_the_union():
    random = np.random.default_rng(6)
    first, second = (np.unique(random.integers(0, 60, 40)) for _ in range(2))
    keys, of_first, of_second = merged(first, second)
    assert keys.tolist() == np.union1d(first, second).tolist()
    assert (keys[of_first] == first).all() and (keys[of_second] == second).all()


def test_the_coarse_model_is_that_of_linear_elements():
    """What it takes over from the fine model is what linear elements find themselves."""
    coarse, linear = model_of(reference_machine()).coarse_model, model_of(reference_machine(), order=LINEAR)
    assert_allclose(coarse.magnet_loads, linear.magnet_loads, atol=1e-12 * np.abs(linear.magnet_loads).max())
    assert_allclose(coarse.phase_loads, linear.phase_loads, atol=1e-12 * np.abs(linear.phase_loads).max())
    assert_allclose(coarse.solve(POINT).a, linear.solve(POINT).a, atol=1e-4 * np.abs(linear.solve(POINT).a).max())


def test_a_pattern_serves_its_neighbours():
    """Four neighbouring turns share one pattern, and each has its own entries in it."""
    topology = model_of(reference_machine()).topology
    pattern = topology.pattern(8)
    assert all(topology.pattern(turn) is pattern for turn in (9, 10, 11)) and topology.pattern(12) is not pattern
    keys = pattern.columns * pattern.size + pattern.rows
    assert all((keys[pattern.band_positions[turn]] == pattern.bands[turn].keys).all() for turn in (8, 9, 10, 11))


def test_loads_of_no_magnets_on_linear_functions():
    model = model_of(reference_machine())
    lower = lower_order(model.topology.facets, np.empty((0, model.size)))
    assert lower.shape == (0, model.coarse_model.size)
