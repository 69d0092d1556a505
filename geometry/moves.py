"""Dimensions of a machine of any kind that may vary, by name: some of its drawn lengths moved by one amount."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from geometry.errors import GeometryError
from geometry.parts import ComposedMachine, Part
from units import FACTORS, written

_PARTS = ("stator", "rotor")


@dataclass(frozen=True)
class Move:
    """name: for people; dimensions: of which part (``stator`` or ``rotor``) which fields; unit: drawing unit of both

    low, high: bounds of what is added to each of them [m or rad, or 1 where the unit is empty]
    """

    name: str
    dimensions: tuple[tuple[str, str], ...]
    unit: str
    low: float
    high: float

    def amount(self, value: float) -> str:
        """As people read it; value: of a change [m or rad, or 1 where the unit is empty]"""
        return f"{value / FACTORS[self.unit] if self.unit else value:+.4g} {written(self.unit)}".rstrip()


def moved(machine: ComposedMachine, moves: Sequence[Move], amounts: Sequence[float]) -> ComposedMachine:
    """The machine with its dimensions moved; amounts: one a move, in the unit inside the project [m, rad or 1].

    Raises GeometryError for a dimension that its part does not have.
    """
    parts: dict[str, Part] = {"stator": machine.stator, "rotor": machine.rotor}
    for move, amount in zip(moves, amounts, strict=True):
        for part, name in move.dimensions:
            parts[part] = _with(parts[part], part, name, amount)
    return replace(machine, **parts)  # type: ignore[arg-type]


def _with(part: Part, where: str, name: str, amount: float) -> Part:
    value = getattr(part, name, None)
    if not isinstance(value, float):
        raise GeometryError(f"the {where} ({type(part).__name__}) has no dimension {name} that could be moved")
    changed: Part = replace(part, **{name: value + amount})  # type: ignore[type-var]
    return changed
