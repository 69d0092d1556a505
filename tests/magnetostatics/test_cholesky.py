"""The sparse factorisation against dense linear algebra, on patterns that no mesh has."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from numpy.testing import assert_allclose
from threadpoolctl import ThreadpoolController

from magnetostatics.cholesky import _BLAS, FactorMemory, SymmetricSystem, one_thread


def lattice(width: int, height: int) -> sp.csc_matrix:
    """The five-point Laplace matrix of a rectangle that is held around its edge."""
    line = [sp.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(n, n)) for n in (width, height)]
    return sp.kronsum(*line, format="csc")


def scattered(size: int, share: float) -> sp.csc_matrix:
    """A random pattern, made positive definite by its diagonal."""
    matrix = sp.random(size, size, share, random_state=1, format="csc")
    matrix = matrix + matrix.T
    return (matrix + sp.diags(abs(matrix).sum(axis=0).A1 + 1.0)).tocsc()


def factorised(matrix: sp.csc_matrix, memory: FactorMemory | None = None) -> SymmetricSystem:
    lower = sp.tril(matrix, format="csc")
    lower.sort_indices()
    columns = np.repeat(np.arange(matrix.shape[0]), np.diff(lower.indptr))
    system = SymmetricSystem(lower.indices.astype(np.int64), columns, matrix.shape[0], memory)
    system.factorise(lower.data)
    return system


MATRICES = {
    "one unknown": sp.csc_matrix([[4.0]]),
    "nothing coupled": sp.diags([1.0, 2.0, 3.0], format="csc"),
    "two islands": sp.block_diag([lattice(4, 5), lattice(3, 7)], format="csc"),
    "square": lattice(40, 40),
    "strip": lattice(300, 2),
    "full": scattered(90, 0.9),
    "random": scattered(400, 0.01),
}


@pytest.mark.parametrize("name", MATRICES)
def test_solution_is_that_of_dense_algebra(name):
    matrix = MATRICES[name]
    loads = np.random.default_rng(3).standard_normal((matrix.shape[0], 3))
    assert_allclose(factorised(matrix).solve(loads), np.linalg.solve(matrix.toarray(), loads), rtol=1e-10, atol=1e-12)


def test_several_loads_and_one_give_the_same():
    system, loads = factorised(lattice(20, 30)), np.random.default_rng(4).standard_normal((600, 5))
    one_by_one = np.stack([system.solve(load) for load in loads.T], axis=1)
    assert_allclose(system.solve(loads), one_by_one, rtol=1e-13)


def test_systems_in_one_memory_answer_until_another_one_is_factorised():
    """The larger one takes a longer room, the smaller one after it a part of that."""
    memory, sizes = FactorMemory(), ((9, 9), (20, 30), (5, 4))
    for size in sizes:
        load = np.arange(1.0, size[0] * size[1] + 1)
        system = factorised(lattice(*size), memory)
        assert_allclose(system.solve(load), factorised(lattice(*size)).solve(load), rtol=1e-14)
    before = factorised(lattice(*sizes[1]), memory)
    factorised(lattice(*sizes[2]), memory)
    with pytest.raises(RuntimeError, match="gave way to that of another"):
        before.solve(np.ones(600))


def test_new_values_on_the_same_pattern():
    """The second factorisation owes nothing to the first."""
    matrix, load = lattice(15, 15), np.ones(225)
    system = factorised(matrix)
    lower = sp.tril(matrix + sp.diags(np.arange(225.0)), format="csc")
    lower.sort_indices()
    system.factorise(lower.data)
    assert_allclose((matrix + sp.diags(np.arange(225.0))) @ system.solve(load), load, rtol=1e-11)


@pytest.mark.parametrize("bad", (-1.0, 0.0, np.nan))
def test_a_matrix_that_is_not_positive_definite_is_refused(bad):
    matrix = lattice(6, 6).tolil()
    matrix[20, 20] = bad
    with pytest.raises(ArithmeticError, match="positive definite"):
        factorised(matrix.tocsc())


def test_entries_of_the_columns_of_a_full_factor():
    assert sorted(factorised(scattered(60, 1.0)).column_counts) == list(range(1, 61))


@pytest.mark.parametrize("name", MATRICES)
def test_entries_of_the_columns_of_a_sparse_factor(name):
    """Against elimination on the full pattern, in the order that was chosen."""
    system = factorised(MATRICES[name])
    pattern = MATRICES[name].toarray()[np.ix_(system._order, system._order)] != 0
    for column in range(len(pattern)):
        below = np.flatnonzero(pattern[column + 1 :, column]) + column + 1
        pattern[np.ix_(below, below)] = True
    assert system.column_counts.tolist() == np.tril(pattern).sum(axis=0).tolist()


def test_one_thread_inside_and_as_many_as_before_outside():
    """Of every library that is known, also where something fails inside."""

    def threads() -> list[int]:
        return [library.get_num_threads() for library in _BLAS]

    with ThreadpoolController().limit(limits=2, user_api="blas"):
        before = threads()
        assert max(before) == 2
        with pytest.raises(ZeroDivisionError), one_thread():
            assert threads() == [1] * len(before)
            raise ZeroDivisionError
        assert threads() == before
