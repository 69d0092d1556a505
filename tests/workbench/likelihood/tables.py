"""Tables made in memory, for tests of what needs no model."""

import numpy as np

from workbench.data.stack import stacked
from workbench.data.table import Response, Table
from workbench.likelihood.whitening import Course, Whitener


def table(values, u, repeat=None, scan=None, kind="generic", file="t.csv", **conditions):
    """One table; values: response -> readings (n,);  u: one number for all rows"""
    rows = len(next(iter(values.values())))
    zero = np.zeros(rows, dtype=int)
    responses = {name: Response(name, np.asarray(y, dtype=float), np.full(rows, u), "N") for name, y in values.items()}
    columns = {name: np.asarray(column, dtype=float) for name, column in conditions.items()}
    repeat = zero if repeat is None else repeat
    return Table(kind, file, columns, responses, zero if scan is None else scan, repeat, zero.astype(bool))


def whitened(*tables):
    """A stack and the whitener of independent noise of the declared size."""
    stack = stacked(tables)
    return stack, Whitener(stack.u, Course.independent(stack.size))
