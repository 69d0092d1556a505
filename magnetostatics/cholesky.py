"""Sparse Cholesky factorisation of a matrix whose pattern stays and whose values change.

The order is that of approximate minimum degree (Amestoy, Davis and Duff, through cvxopt); the factorisation itself is
the project's own (``magnetostatics/fronts.py``, ``magnetostatics/multifrontal.py``): on the problems of this room it
takes 0.5 to 0.6 of the time of CHOLMOD as cvxopt carries it (``docs/speed.md``).
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import cvxopt
import cvxopt.amd
import numpy as np
from threadpoolctl import ThreadpoolController

from magnetostatics.fronts import Fronts, analysed
from magnetostatics.multifrontal import factorise, solve

# Made after the imports above, or it would not know their libraries.
_BLAS = [library for library in ThreadpoolController().lib_controllers if library.user_api == "blas"]


@contextmanager
def one_thread() -> Iterator[None]:
    """Context in which BLAS uses one thread: two make a solve of this size two to three times slower."""
    threads = [(library, library.get_num_threads()) for library in _BLAS]
    others = [(library, count) for library, count in threads if count != 1]
    for library, _ in others:
        library.set_num_threads(1)
    try:
        yield
    finally:
        for library, count in others:
            library.set_num_threads(count)


class FactorMemory:
    """Room for one factor and what it takes to make it; systems that are factorised in turn may share it.

    factor, workspace: [square root of the unit of the matrix] and [its unit], as long as the largest needs
    holder: what tells the system whose factor is there from the others
    """

    def __init__(self) -> None:
        self.factor, self.workspace = np.empty(0), np.empty(0)
        self.holder: object = None

    def give(self, holder: object, factor: int, workspace: int) -> None:
        """Room for so many numbers to a new holder; what was there is lost."""
        self.holder = holder
        if len(self.factor) < factor:
            self.factor = np.empty(factor)
        if len(self.workspace) < workspace:
            self.workspace = np.empty(workspace)


class SymmetricSystem:
    """A symmetric positive definite matrix with fixed pattern: analysed once, refactorised for new values.

    rows, columns: indices of the lower triangle (k,), rows >= columns
    memory: shared with other systems, of which only the one factorised last can then be solved; None for its own
    column_counts: number of entries in every column of the factor (n,); their squares sum up to the operations
    """

    def __init__(self, rows: np.ndarray, columns: np.ndarray, size: int, memory: FactorMemory | None = None) -> None:
        pattern = cvxopt.spmatrix(1.0, cvxopt.matrix(rows.astype(int)), cvxopt.matrix(columns), (size, size))
        order = np.array(cvxopt.amd.order(pattern, "L")).ravel()
        self._fronts, self._order, counts, workspace = analysed(rows, columns, order)
        self.column_counts = counts.astype(np.uint32)
        self._sizes, self._memory = (int(self._fronts.panels[-1]), int(workspace)), memory or FactorMemory()

    @property
    def factors(self) -> tuple[Fronts, np.ndarray, np.ndarray]:
        """Fronts, order [indices, (n,)] and factor [square root of m/H, (l,)] as ``multifrontal.solve`` takes them.

        Good until the next factorisation in the same memory; asked for after it, RuntimeError is raised.
        """
        if self._memory.holder is not self._order:
            raise RuntimeError("the factor of this matrix was not made yet, or gave way to that of another one")
        return self._fronts, self._order, self._memory.factor

    def factorise(self, values: np.ndarray) -> None:
        """Numeric factorisation for the values of the lower triangle [m/H], (k,), in the order of the pattern.

        Raises ArithmeticError when the matrix is not positive definite.
        """
        self._memory.give(self._order, *self._sizes)
        if not factorise(self._fronts, values, self._memory.factor, self._memory.workspace):
            raise ArithmeticError("the matrix is not positive definite")

    def solve(self, right_hand_side: np.ndarray) -> np.ndarray:
        """Solution [Wb/m] of the shape of right_hand_side [A], (n,), or several in one, (n, k)."""
        given = np.ascontiguousarray(np.atleast_2d(right_hand_side.T))
        return solve(*self.factors, given).T.reshape(right_hand_side.shape)
