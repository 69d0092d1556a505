"""Uncertainties written as formulas, ``0.3 + 0.008*abs(y)``: read as arithmetic within limits, never executed as code.

Numbers are floating-point numbers, so that no power grows beyond memory; readings are never changed.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from typing import Final

import numpy as np

from workbench.errors import WorkbenchError

LONGEST: Final = 300  # characters of a formula
MOST_PARTS: Final = 60  # numbers, names and operations of a formula
FUNCTIONS: Final = ("abs", "sqrt", "max", "min")

Values = np.ndarray
_TWO: Final[dict[type[ast.operator], Callable[[Values, Values], Values]]] = {
    ast.Add: lambda a, b: a + b, ast.Sub: lambda a, b: a - b, ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b, ast.Pow: lambda a, b: a**b,
}  # fmt: skip
_ONE: Final[dict[type[ast.unaryop], Callable[[Values], Values]]] = {ast.USub: lambda a: -a, ast.UAdd: lambda a: a}


def evaluate(text: object, names: Mapping[str, np.ndarray], where: str) -> np.ndarray:
    """Value of a number or formula; + - * / **, abs, sqrt, max, min and the given names are known.

    names: columns of equal length (n,) or numbers
    Returns: a new array, () or (n,), finite everywhere.
    Raises:
        WorkbenchError: anything else is written there, or the value is not finite in every row.
    """
    if isinstance(text, (int, float)) and not isinstance(text, bool):
        return _finite(text, _number(text), where)
    if not isinstance(text, str) or len(text) > LONGEST:
        raise _unreadable(text, names, where)
    try:
        tree = ast.parse(text.strip(), mode="eval")
        if sum(1 for _ in ast.walk(tree)) > 4 * MOST_PARTS:  # the tree has nodes for operators and contexts too
            raise ValueError("long")
        with np.errstate(all="ignore"):
            return _finite(text, np.array(_value(tree.body, names), dtype=float), where)
    except (KeyError, SyntaxError, TypeError, ValueError, OverflowError, RecursionError, MemoryError) as error:
        if isinstance(error, WorkbenchError):
            raise
        raise _unreadable(text, names, where) from None


def _number(value: int | float) -> np.ndarray:
    try:
        return np.array(float(value))
    except OverflowError:
        return np.array(np.inf)


def _finite(text: object, value: np.ndarray, where: str) -> np.ndarray:
    if not np.isfinite(value).all():
        raise WorkbenchError(f"{where}: {_short(text)} is not a finite number in every row; correct that formula.")
    return value


def _unreadable(text: object, names: Mapping[str, np.ndarray], where: str) -> WorkbenchError:
    known = ", ".join([*FUNCTIONS, *(name for name in names if name.isidentifier())])
    return WorkbenchError(
        f"{where}: {_short(text)} is not a formula that can be read; write numbers, + - * / ** and {known}, at most "
        f"{LONGEST} characters."
    )


def _short(text: object) -> str:
    shown = repr(text)
    return shown if len(shown) <= 60 else shown[:57] + "..."


def _value(node: ast.AST, names: Mapping[str, np.ndarray]) -> np.ndarray:
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return np.array(float(node.value))
    if isinstance(node, ast.Name):
        return np.array(names[node.id], dtype=float)
    if isinstance(node, ast.UnaryOp):
        return _ONE[type(node.op)](_value(node.operand, names))
    if isinstance(node, ast.BinOp):
        return _TWO[type(node.op)](_value(node.left, names), _value(node.right, names))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        return _called(node.func.id, [_value(argument, names) for argument in node.args])
    raise ValueError(node)


def _called(function: str, arguments: list[np.ndarray]) -> np.ndarray:
    if function in ("max", "min") and len(arguments) >= 2:
        larger = np.maximum if function == "max" else np.minimum
        result = arguments[0]
        for argument in arguments[1:]:
            result = larger(result, argument)
        return result
    if function in ("abs", "sqrt") and len(arguments) == 1:
        return np.abs(arguments[0]) if function == "abs" else np.sqrt(arguments[0])
    raise ValueError(function)
