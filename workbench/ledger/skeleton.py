"""A skeleton of a user's own effect, written from what the residual looks like."""

from __future__ import annotations

import ast
import json
from collections.abc import Mapping
from keyword import iskeyword
from math import isfinite
from pathlib import Path

from disk import write_atomically
from workbench.errors import WorkbenchError

_TEXT = '''"""{doc}"""

from dataclasses import dataclass

import numpy as np

from effects.base import ResponseEffect
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class {cls}(ResponseEffect):
    """Write the equation here, with its source.

    y = y_model + size * (what the residual looks like)
    """

    title = {title}
    looks_like = {looks}

    size: float = parameter(0.0, {unit}, prior=Normal({sd:.3g}), low={low:.3g}, high={high:.3g}, source="to be found")

    def on_response(self, response, conditions, kind, design):
        """Adds the effect to the response {about}; conditions there: {conditions}."""
        if kind != {kind} or self.is_null:
            return response
        shape = {shape}
        return {{**response, {response}: response[{response}] + self.size * shape}}
'''


def skeleton(
    path: Path, signature: Mapping[str, object], response: str, kind: str, conditions: list[str], size: float
) -> str:
    """The text of a Python file with one effect that acts on the channel where the residual sits.

    What comes from a campaign stands in it as quoted text, or with letters and digits only.
    signature: ``residual_signature`` of a diagnosis;  size: of the residual in SI
    """
    words = describe(signature)
    size = size if isfinite(size) and size > 0 else 1.0
    return _TEXT.format(
        doc=plain(f"An effect of one's own. The residual: {words}"),
        cls="".join(part.capitalize() for part in path.stem.split("_")),
        title=quoted(path.stem.replace("_", " ")),
        looks=quoted(words),
        unit=quoted("SI of the response"),
        sd=size,
        low=-20 * size,
        high=20 * size,
        about=plain(f"{response} of tables of kind {kind}"),
        response=quoted(response),
        kind=quoted(kind),
        conditions=plain(", ".join(conditions)),
        shape=_shape(signature, conditions),
    )


def quoted(text: object) -> str:
    """Text as a Python literal in double quotes, whatever is in it."""
    return json.dumps(str(text), ensure_ascii=False)


def plain(text: str) -> str:
    """Text that may stand in a docstring: without quotes, backslashes, line breaks and what is no plain letter."""
    return "".join(sign if sign.isascii() and (sign.isalnum() or sign in " .,;:'^_-+*()") else " " for sign in text)


def describe(signature: Mapping[str, object]) -> str:
    """One sentence on where the residual sits."""
    if not signature:
        return "was not looked at."
    where = ", ".join(f"{n} {low:.4g} to {high:.4g}" for n, (low, high) in signature["regime"].items())
    powers = ", ".join(f"{n}^{mid:.2g}" for n, (_, mid, _) in signature["exponents"].items())
    orders = ", ".join(str(k) for k in signature["orders"])
    parts = [f"largest in {signature['channel']} at {where}"]
    parts += [f"grows as {powers}"] if powers else []
    parts += [f"orders per turn {orders}"] if orders else []
    return "; ".join(parts) + "."


def _shape(signature: Mapping[str, object], conditions: list[str]) -> str:
    """A first guess of the shape over the conditions: the power law or the order that was found."""
    if signature.get("orders") and "angle_mech" in conditions:
        return f'np.cos({float(signature["orders"][0]):g} * conditions["angle_mech"])'
    exponents = {n: e[1] for n, e in signature.get("exponents", {}).items() if n in conditions and abs(e[1]) > 0.3}
    if exponents:
        name, power = max(exponents.items(), key=lambda item: abs(item[1]))
        column = f"conditions[{quoted(name)}]"
        return f"np.sign({column}) * np.abs({column}) ** {float(power):.1f}"
    return f"np.ones_like(response[{quoted(signature['channel'].split('.')[-1])}])" if signature else "1.0"


def write_new(path: Path, text: str) -> None:
    """Writes a new file.

    Raises:
        WorkbenchError: there is a file of that name, or the name is no name of an effect.
    """
    _check_name(path)
    if path.exists():
        raise WorkbenchError(f"{path}: exists already; choose another name.")
    ast.parse(text)  # what cannot be read by Python is never written
    try:
        write_atomically(path, lambda part: part.write_text(text, encoding="utf-8"))
    except OSError as error:
        raise WorkbenchError(f"{path}: cannot be written ({error.strerror}).") from None


def _check_name(path: Path) -> None:
    name = path.stem
    word = name.isascii() and name.isidentifier() and not iskeyword(name) and name.strip("_")
    if path.suffix != ".py" or not word:
        raise WorkbenchError(f"{path}: the name of an effect file is a word in snake case and ends in .py.")
