"""What uncertain conditions make of the uncertainty of a reading, also where the model ends."""

from dataclasses import replace

import numpy as np
from numpy.testing import assert_allclose

from tests.workbench.likelihood.tables import table
from workbench.data.stack import stacked
from workbench.errors import WorkbenchError
from workbench.likelihood.conditions import readings, with_conditions


class Shunted:
    """A damping 1 / (1 + R), with no answer beyond a shunt of some size."""

    def __init__(self, most=np.inf):
        self.most = most

    def answers(self, rows):
        shunt = rows.conditions["shunt"]
        if np.any(shunt > self.most):
            raise WorkbenchError("no answer")
        return {"damping": 1.0 / (1.0 + shunt)}


def shunts(*values):
    """Rows with shunts known to a hundredth, at readings with next to no noise of their own."""
    shunt = np.array(values)
    rows = table({"damping": 1.0 / (1.0 + shunt)}, 1e-12, shunt=shunt)
    return stacked([replace(rows, condition_random={"shunt": 0.01 * shunt})])


def expected(stack):
    shunt = stack.tables[0].conditions["shunt"]
    return 0.01 * shunt / (1.0 + shunt) ** 2


def test_over_decades_every_row_has_the_slope_of_its_own_place():
    stack = shunts(0.3, 1.0, 1e6)
    assert_allclose(with_conditions(Shunted(), stack, readings(Shunted(), stack)), expected(stack), rtol=0.02)


def test_at_the_end_of_what_has_an_answer_the_slope_is_to_the_inside():
    stack = shunts(0.3, 1.0, 2.0)
    ending = Shunted(most=2.0)
    assert_allclose(with_conditions(ending, stack, readings(ending, stack)), expected(stack), rtol=0.02)


def test_rows_without_an_answer_are_the_only_ones_without():
    stack = shunts(0.3, 1.0, 2.0, 3.0)
    found = readings(Shunted(most=2.0), stack)
    assert np.isfinite(found).tolist() == [True, True, True, False]
    assert np.isfinite(with_conditions(Shunted(most=2.0), stack, found)).all()
