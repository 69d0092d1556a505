"""Units at the border of the workbench: the end of a column name (``torque_Nm``) or a ``unit`` key; SI inside.

Temperatures stay in degrees Celsius (names end in ``_T``) and frequencies in hertz.
"""

from __future__ import annotations

from difflib import get_close_matches
from typing import Final

import numpy as np

import units
from units import DEGREE, RPM
from workbench.errors import WorkbenchError

# What columns have beyond the one table: pure numbers, and differences of temperature.
FACTORS: Final[dict[str, float]] = {**units.FACTORS, "1": 1.0, "K": 1.0}
# Temperatures that are not in degrees Celsius: degC = scale * (value + offset).
OFFSETS: Final[dict[str, tuple[float, float]]] = {"K": (1.0, -273.15), "degF": (5 / 9, -32.0)}


def split_unit(name: str) -> tuple[str, str]:
    """Quantity and unit of a name, ``("torque", "Nm")``; the unit is empty where the name ends in none.

    The unit T is read from a name only as ``mT``: ``magnet_T`` is a temperature.
    """
    quantity, unit = units.split_unit(name)
    return (name, "") if unit == "T" else (quantity, unit)


def factor(unit: str, where: str) -> float:
    """Factor to the unit used inside.

    Raises:
        WorkbenchError: the unit is not known.
    """
    if unit not in FACTORS:
        close = get_close_matches(unit, FACTORS, n=5, cutoff=0.5)
        near = f"the nearest are {', '.join(close)}; all" if close else "all"
        raise WorkbenchError(f"{where}: the unit {unit!r} is not known; {near} stand in docs/campaign.md.")
    return FACTORS[unit]


def to_inside(values: np.ndarray, name: str, unit: str, where: str) -> np.ndarray:
    """Readings of a column in the unit used inside; a temperature (``magnet_T``) may be in degC, K or degF (n,)."""
    if name.endswith("_T") and unit in OFFSETS:
        scale, offset = OFFSETS[unit]
        return scale * (values + offset)
    return values * factor(unit, f"{where}, {name}")


def difference(unit: str, name: str, where: str) -> float:
    """Factor of a difference or an uncertainty to the unit used inside."""
    return OFFSETS[unit][0] if name.endswith("_T") and unit in OFFSETS else factor(unit, f"{where}, {name}")


def for_people(name: str) -> tuple[str, float]:
    """Unit in which people read a condition, and the factor from the unit used inside."""
    if "angle" in name or name == "phase":
        return "deg", 1 / DEGREE
    if name == "speed":
        return "rpm", 1 / RPM
    for ending, unit in _UNITS_INSIDE.items():
        if name == ending or name.startswith(ending + "_"):
            return unit, 1.0
    return ("degC", 1.0) if name.endswith("_T") else ("", 1.0)


# Inputs of a device that are no lengths: ``end_winding_inductance``, ``stacking_factor``, ``phase_resistance_a``.
_UNITS_OF_INPUTS = {
    "inductance": "H", "resistance": "ohm", "remanence": "T", "temperature": "K", "factor": "1", "fraction": "1",
    "permeability": "1", "share": "1", "scale": "1", "turns": "1",
}  # fmt: skip
_UNITS_INSIDE = {
    "velocity": "m/s", "shunt": "ohm", "frequency": "Hz", "amplitude": "m", "displacement": "m", "i": "A",
    "v": "V", "torque": "Nm", "current": "A", "time": "s",
}  # fmt: skip


def unit_inside(name: str) -> str:
    """SI unit of a quantity by a word of its name, or by the first one: ``force_offset`` N, ``airgap`` m."""
    if "angle" in name or name.startswith("encoder"):
        return "rad"
    if unit := next((unit for word, unit in _UNITS_OF_INPUTS.items() if word in name), ""):
        return unit
    first = name.split("_")[0]
    return {"force": "N", "voltage": "V", "torque": "Nm", "current": "A", "speed": "rad/s"}.get(first, "m")
