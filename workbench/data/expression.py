"""Uncertainties written as formulas, ``0.3 + 0.008*abs(y)``: read as arithmetic, never executed as code."""

from __future__ import annotations

import ast
import operator
from collections.abc import Mapping

import numpy as np

from workbench.errors import WorkbenchError

_OPERATORS = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Pow: operator.pow, ast.USub: operator.neg, ast.UAdd: operator.pos,
}  # fmt: skip
_FUNCTIONS = {"abs": np.abs, "sqrt": np.sqrt, "max": np.maximum, "min": np.minimum}


def evaluate(text: object, names: Mapping[str, np.ndarray], where: str) -> np.ndarray:
    """Value of a number or formula; + - * / **, abs, sqrt, max, min and the given names are known.

    Raises:
        WorkbenchError: anything else is written there.
    """
    if isinstance(text, (int, float)) and not isinstance(text, bool):
        return np.asarray(float(text))
    try:
        return np.asarray(_value(ast.parse(str(text), mode="eval").body, names), dtype=float)
    except (KeyError, SyntaxError, TypeError, ValueError, AttributeError):
        known = ", ".join(["abs", "sqrt", "max", "min", *names])
        raise WorkbenchError(
            f"{where}: {text!r} is not a formula that can be read; write numbers, + - * / ** and {known}."
        ) from None


def _value(node: ast.AST, names: Mapping[str, np.ndarray]):
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return node.value
    if isinstance(node, ast.Name):
        return names[node.id]
    if isinstance(node, ast.UnaryOp):
        return _OPERATORS[type(node.op)](_value(node.operand, names))
    if isinstance(node, ast.BinOp):
        return _OPERATORS[type(node.op)](_value(node.left, names), _value(node.right, names))
    if isinstance(node, ast.Call) and not node.keywords:
        return _FUNCTIONS[node.func.id](*(_value(argument, names) for argument in node.args))
    raise ValueError(node)
