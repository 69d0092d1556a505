"""Thermal classes of electrical insulation, and how warm a winding of each may be."""

from __future__ import annotations

from dataclasses import dataclass

from materials.errors import MaterialError


@dataclass(frozen=True)
class InsulationClass:
    """One class.

    letter: its name; hottest: permitted at the hottest place of the winding [degC], IEC 60085
    mean: of the whole winding when it is rated by its resistance [degC], IEC 60034-1: temperature rise and 40 degC of
        surroundings
    """

    letter: str
    hottest: float
    mean: float


# IEC 60085 (edition 4, 2007), Table 1, and IEC 60034-1, limits of temperature rise by resistance for indirect cooling
# with air (60, 75, 80, 105, 125, 145 K), from memory of both.
_CLASSES = {
    one.letter: one
    for one in (
        InsulationClass("A", 105.0, 100.0),
        InsulationClass("E", 120.0, 115.0),
        InsulationClass("B", 130.0, 120.0),
        InsulationClass("F", 155.0, 145.0),
        InsulationClass("H", 180.0, 165.0),
        InsulationClass("N", 200.0, 185.0),
    )
}
LETTERS = tuple(_CLASSES)


def insulation_class(letter: str) -> InsulationClass:
    """The class of a letter. Raises MaterialError for one that there is not."""
    if letter not in _CLASSES:
        raise MaterialError(f"the insulation classes are {', '.join(LETTERS)} (IEC 60085); found {letter!r}")
    return _CLASSES[letter]
