"""Sparse Cholesky factorisation (CHOLMOD through cvxopt) of a matrix whose pattern stays and whose values change."""

from __future__ import annotations

from contextlib import AbstractContextManager

import cvxopt
import cvxopt.cholmod
import numpy as np
from threadpoolctl import ThreadpoolController

_BLAS = ThreadpoolController()  # made after the imports above, or it would not know their libraries


def one_thread() -> AbstractContextManager[object]:
    """Context in which BLAS uses one thread: two make a solve of this size two to three times slower."""
    return _BLAS.limit(limits=1, user_api="blas")


class SymmetricSystem:
    """A symmetric positive definite matrix with fixed pattern: analysed once, refactorised for new values.

    rows, columns: indices of the lower triangle (k,), rows >= columns, sorted by column, then by row
    """

    def __init__(self, rows: np.ndarray, columns: np.ndarray, size: int) -> None:
        ones = cvxopt.matrix(1.0, (len(rows), 1))
        self._matrix = cvxopt.spmatrix(ones, cvxopt.matrix(rows), cvxopt.matrix(columns), (size, size))
        self._factor = cvxopt.cholmod.symbolic(self._matrix)

    def factorise(self, values: np.ndarray) -> None:
        """Numeric factorisation for the values of the lower triangle [m/H], (k,), in the order of the pattern.

        Raises ArithmeticError when the matrix is not positive definite.
        """
        self._matrix.V = cvxopt.matrix(values)
        cvxopt.cholmod.numeric(self._matrix, self._factor)

    def column_counts(self) -> np.ndarray:
        """Number of entries in every column of the factor (n,); their squares sum up to the operations."""
        factor = cvxopt.cholmod.symbolic(self._matrix)
        cvxopt.cholmod.numeric(self._matrix, factor)
        return np.diff(np.array(cvxopt.cholmod.getfactor(factor).CCS[0]).ravel())

    def solve(self, right_hand_side: np.ndarray) -> np.ndarray:
        """Solution [Wb/m] of the shape of right_hand_side [A], (n,), or several in one, (n, k)."""
        solution = cvxopt.matrix(right_hand_side)
        cvxopt.cholmod.solve(self._factor, solution)
        return np.array(solution).reshape(right_hand_side.shape)
