"""Formulas of uncertainties are arithmetic within limits: no code, no endless work, no reading changed."""

import time

import numpy as np
import pytest

from workbench.data.expression import evaluate
from workbench.errors import WorkbenchError

Y = np.array([0.0, 1.0, 4.0])


@pytest.mark.parametrize(
    "text, value",
    [
        ("max(2, 3*y**2) - -1", [3.0, 4.0, 49.0]),
        ("0.3 + 0.01*abs(-y)", [0.3, 0.31, 0.34]),
        ("sqrt(y)/2", [0.0, 0.5, 1.0]),
        ("min(y, 1, 3)", [0.0, 1.0, 1.0]),
        (0.5, 0.5),
    ],
)
def test_what_a_formula_is_worth(text, value):
    assert np.allclose(evaluate(text, {"y": Y}, "here"), value)


@pytest.mark.parametrize(
    "text",
    ["y.real", "open('x')", "[1]", "y if y else 0", "lambda: 0", "abs(x=1)", "True", "abs(y, y)", "max(*y)", "y[0]",
     "'a'*9", "1j", "y @ y", "y // 2", "-" * 299 + "1", "1" * 400, "y" + "+y" * 120, "",
     "a\x00b", None, True, [1]],
)  # fmt: skip
def test_what_is_no_formula_is_refused(text):
    with pytest.raises(WorkbenchError, match="is not a formula"):
        evaluate(text, {"y": Y}, "here")


@pytest.mark.parametrize(
    "text", ["9**9**9**9", "1e308**2", "1/0", "1/y", "sqrt(y - 9)", "1e999", 10**400, float("nan")]
)
def test_what_is_not_finite_is_refused_at_once(text):
    start = time.process_time()
    with pytest.raises(WorkbenchError, match="is not a finite number"):
        evaluate(text, {"y": Y}, "here")
    assert time.process_time() - start < 0.5


@pytest.mark.parametrize("text", ["max(y, 9, y)", "y", "+y", "abs(y)", "min(y, y)"])
def test_readings_are_never_changed(text):
    before = Y.copy()
    evaluate(text, {"y": Y}, "here")[...] = 7.0
    assert np.array_equal(Y, before)
