"""The resistance of a phase from turns, wire and drawing, to be held against the declared one."""

from __future__ import annotations

from math import pi

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
    """R = rho n coils l_turn / A of a phase at 20 degC [ohm], l_turn = 2 l + pi w.

    w: mean width of a coil, across which the ends are half circles (estimate; they have 30 to 60 % of the resistance)
    """
    layout = design.drawing.layout
    turn = 2 * design.length + pi * _coil_width(design)
    turns = design.turns * layout.coils_in_series
    return COPPER.reference_resistivity * turns * turn / design.copper_area


def _coil_width(design: DrawnAsBuilt) -> float:
    """Between the middles of the sides of a coil, half way down the tooth [m]; tooth coils lie beside each other."""
    (x, low), (_, high) = design.machine.stator.tooth_probe
    pitch, pitches = design.machine.slot_pitch * x, design.drawing.layout.coil_pitch
    return pitches * pitch if pitches > 1 else (pitch + high - low) / 2
