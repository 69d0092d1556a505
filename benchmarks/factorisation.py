"""The project's sparse Cholesky factorisation against CHOLMOD: ``python -m benchmarks.factorisation``.

On the tangent matrix of the reference machine with linear and with quadratic elements: CPU times on one thread, taken
in turns, and medians of the ratios. Writes results/reference/benchmarks/factorisation.csv.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from statistics import median

import cvxopt
import cvxopt.cholmod
import numpy as np
import pandas as pd

from benchmarks.reference_case import reference_materials, reference_section
from benchmarks.speed import RESULTS, null_point
from disk import write_atomically
from magnetostatics.cholesky import SymmetricSystem, one_thread
from magnetostatics.elements import LINEAR, QUADRATIC, TriangleOrder
from magnetostatics.model import FieldModel

_REPEATS = 15
_LOADS = 8


class Cholmod:
    """What ``SymmetricSystem`` does, by CHOLMOD as cvxopt carries it."""

    def __init__(self, rows: np.ndarray, columns: np.ndarray, size: int) -> None:
        indices = (cvxopt.matrix(side.astype(int)) for side in (rows, columns))
        self._matrix = cvxopt.spmatrix(1.0, *indices, (size, size))
        self._factor = cvxopt.cholmod.symbolic(self._matrix)

    def factorise(self, values: np.ndarray) -> None:
        self._matrix.V = cvxopt.matrix(values)
        cvxopt.cholmod.numeric(self._matrix, self._factor)

    def solve(self, right_hand_side: np.ndarray) -> np.ndarray:
        solution = cvxopt.matrix(right_hand_side)
        cvxopt.cholmod.solve(self._factor, solution)
        return np.array(solution).reshape(right_hand_side.shape)


def tangent_matrix(order: TriangleOrder) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """Rows, columns and values of the lower triangle at the solution of the reference machine, and its size."""
    model, point = FieldModel(reference_section(), reference_materials(), order=order), null_point()
    pattern = model.topology.pattern(model.unknowns.turn(point.angle).edges)
    kept: list[np.ndarray] = []
    factorise = pattern.system.factorise
    pattern.system.factorise = lambda values: kept.append(values) or factorise(values)
    model.tangent(model.solve(point))
    return pattern.rows, pattern.columns, kept[-1], pattern.size


def compared(order: TriangleOrder, name: str) -> list[dict[str, object]]:
    """One row for the analysis, the factorisation, one load and several loads."""
    rows, columns, values, size = tangent_matrix(order)
    systems = Cholmod(rows, columns, size), SymmetricSystem(rows, columns, size)
    load = np.random.default_rng(0).standard_normal((size, _LOADS))
    for system in systems:
        system.factorise(values)
    theirs, ours = (system.solve(load) for system in systems)
    apart = float(np.abs(ours - theirs).max() / np.abs(theirs).max())
    actions: dict[str, tuple[Callable[[], object], ...]] = {
        "analysis": tuple(partial(type(system), rows, columns, size) for system in systems),
        "factorisation": tuple(partial(system.factorise, values) for system in systems),
        "one load": tuple(partial(system.solve, load[:, 0]) for system in systems),
        f"{_LOADS} loads": tuple(partial(system.solve, load) for system in systems),
    }
    return [
        {"elements": name, "unknowns": size, "step": step, **in_turns(*two), "difference": apart}
        for step, two in actions.items()
    ]


def in_turns(theirs: Callable[[], object], ours: Callable[[], object]) -> dict[str, float]:
    """Medians of the CPU times [ms], and of the ratio."""
    times = [(cpu_ms(theirs), cpu_ms(ours)) for _ in range(_REPEATS)]
    ratio = median(own / other for other, own in times)
    return {"cholmod_ms": median(t[0] for t in times), "own_ms": median(t[1] for t in times), "ratio": ratio}


def cpu_ms(action: Callable[[], object]) -> float:
    """CPU time of a call [ms]."""
    began = time.process_time()
    action()
    return 1e3 * (time.process_time() - began)


def main() -> None:
    """Measure, print and write."""
    with one_thread():
        rows = compared(LINEAR, "linear") + compared(QUADRATIC, "quadratic")
    frame = pd.DataFrame(rows)
    print(frame.to_string(index=False, float_format="{:.3g}".format))
    path = RESULTS / "factorisation.csv"
    write_atomically(path, partial(frame.to_csv, index=False, float_format="%.4g"))


if __name__ == "__main__":
    main()
