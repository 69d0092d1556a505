"""The resistance of a phase from turns, wire and drawing, to be held against the declared one."""

from __future__ import annotations

import numpy as np

from effects.drawn_design import DrawnAsBuilt
from materials.conductor import COPPER

_AGREES = 1.5  # times more or less: what the end turns of an unknown winding leave open
_LINES = (1.7, 2.5)  # times the copper that is two phases in series


def doubts_of_resistance(design: DrawnAsBuilt) -> tuple[str, ...]:
    """A sentence where the declared resistance is not that of the declared wire; nothing where no wire is declared."""
    if not (design.copper_area and design.phase_resistance):
        return ()
    copper = copper_resistance(design)
    ratio = design.phase_resistance / copper
    if 1 / _AGREES < ratio < _AGREES:
        return ()
    words = "it is that between two lines" if _LINES[0] < ratio < _LINES[1] else "check turns, wire and unit"
    return (
        f"[device]: the copper of a phase, {design.turns:g} turns a coil, has about {copper:.3g} ohm, declared are "
        f"{design.phase_resistance:.3g} ohm, {ratio:.2g} times as much: {words}",
    )


def copper_resistance(design: DrawnAsBuilt) -> float:
    """Of a phase of the equivalent star at 20 degC [ohm]: rho n coils l_turn / A of all coils in series, by what each
    carries of the current of a line; l_turn = 2 (l + l_et).

    l_et: of an end turn, an estimate where coils span more than a tooth (the ends have 30 to 60 % of the resistance)
    """
    turns = design.turns * design.drawing.layout.coils_in_series
    series = COPPER.reference_resistivity * turns * 2 * (design.length + design.drawing.end_turn) / design.copper_area
    between_two = design.drawing.coil_currents @ np.array([1.0, -1.0, 0.0])
    return float(series * (between_two**2).sum() / 2)
