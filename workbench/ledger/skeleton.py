"""A skeleton of a user's own effect, written from what the residual looks like."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

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

    title = "{title}"
    looks_like = "{looks}"

    size: float = parameter(0.0, "{unit}", prior=Normal({sd:.3g}), low={low:.3g}, high={high:.3g}, source="to be found")

    def on_response(self, response, conditions, kind, design):
        """Adds the effect to ``{response}`` of tables of kind ``{kind}``; conditions there: {conditions}."""
        if kind != "{kind}" or self.is_null:
            return response
        shape = {shape}
        return {{**response, "{response}": response["{response}"] + self.size * shape}}
'''


def skeleton(
    path: Path, signature: Mapping[str, object], response: str, kind: str, conditions: list[str], size: float
) -> str:
    """The text of a Python file with one effect that acts on the channel where the residual sits.

    signature: ``residual_signature`` of a diagnosis;  size: of the residual in SI
    """
    words = describe(signature)
    return _TEXT.format(
        doc=f"An effect of one's own. The residual: {words}",
        cls="".join(part.capitalize() for part in path.stem.split("_")),
        title=path.stem.replace("_", " "),
        looks=words.replace('"', "'"),
        unit="SI of the response",
        sd=size,
        low=-20 * size,
        high=20 * size,
        response=response,
        kind=kind,
        conditions=", ".join(conditions),
        shape=_shape(signature, conditions),
    )


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
        return f'np.cos({signature["orders"][0]} * conditions["angle_mech"])'
    exponents = {n: e[1] for n, e in signature.get("exponents", {}).items() if n in conditions and abs(e[1]) > 0.3}
    if exponents:
        name, power = max(exponents.items(), key=lambda item: abs(item[1]))
        return f'np.sign(conditions["{name}"]) * np.abs(conditions["{name}"]) ** {power:.1f}'
    return f'np.ones_like(response["{signature["channel"].split(".")[-1]}"])' if signature else "1.0"


def write_new(path: Path, text: str) -> None:
    """Writes a new file.

    Raises:
        WorkbenchError: there is a file of that name, or the name is no name of an effect.
    """
    if path.suffix != ".py" or not path.stem.isidentifier():
        raise WorkbenchError(f"{path}: the name of an effect file is a word in snake case and ends in .py.")
    if path.exists():
        raise WorkbenchError(f"{path}: exists already; choose another name.")
    path.write_text(text, encoding="utf-8")
