"""Units at the border of the workbench: the end of a column name (``torque_Nm``) or a ``unit`` key; SI inside.

Temperatures stay in degrees Celsius (names end in ``_T``) and frequencies in hertz.
"""

from __future__ import annotations

from math import pi

from workbench.errors import WorkbenchError

# unit as written -> factor to the unit used inside
FACTORS: dict[str, float] = {
    "1": 1.0, "percent": 1e-2,
    "m": 1.0, "mm": 1e-3, "um": 1e-6, "cm": 1e-2,
    "rad": 1.0, "deg": pi / 180, "mrad": 1e-3,
    "rpm": pi / 30, "rad_per_s": 1.0, "deg_per_s": pi / 180,
    "Hz": 1.0, "kHz": 1e3,
    "s": 1.0, "ms": 1e-3,
    "m_per_s": 1.0, "mm_per_s": 1e-3,
    "V": 1.0, "mV": 1e-3, "kV": 1e3,
    "A": 1.0, "mA": 1e-3,
    "ohm": 1.0, "mohm": 1e-3, "kohm": 1e3, "Ohm": 1.0, "mOhm": 1e-3,
    "Nm": 1.0, "mNm": 1e-3,
    "N": 1.0, "kN": 1e3, "mN": 1e-3,
    "Vs": 1.0, "mVs": 1e-3, "Wb": 1.0, "mWb": 1e-3,
    "H": 1.0, "mH": 1e-3, "uH": 1e-6,
    "W": 1.0, "kW": 1e3, "mW": 1e-3,
    "kg": 1.0, "g": 1e-3, "kg_m2": 1.0,
    "T": 1.0, "mT": 1e-3,
    "Ns_per_m": 1.0, "kNs_per_m": 1e3, "Nms_per_rad": 1.0,
    "N_per_A": 1.0, "Vs_per_m": 1.0, "Nm_per_A": 1.0, "N_per_m": 1.0,
    "degC": 1.0, "K": 1.0, "per_K": 1.0, "percent_per_K": 1e-2,
}  # fmt: skip

_LONGEST_FIRST = sorted(FACTORS, key=len, reverse=True)


def split_unit(name: str) -> tuple[str, str]:
    """Quantity and unit of a name, ``("torque", "Nm")``; the unit is empty where the name ends in none.

    The unit T is read from a name only as ``mT``: ``magnet_T`` is a temperature.
    """
    for unit in _LONGEST_FIRST:
        if unit not in ("T", "1") and name.endswith("_" + unit):
            return name[: -len(unit) - 1], unit
    return name, ""


def factor(unit: str, where: str) -> float:
    """Factor to the unit used inside.

    Raises:
        WorkbenchError: the unit is not known.
    """
    if unit not in FACTORS:
        known = ", ".join(sorted(FACTORS))
        raise WorkbenchError(f"{where}: the unit {unit!r} is not known; use one of {known}.")
    return FACTORS[unit]


def for_people(name: str) -> tuple[str, float]:
    """Unit in which people read a condition, and the factor from the unit used inside."""
    if "angle" in name or name == "phase":
        return "deg", 180 / pi
    if name == "speed":
        return "rpm", 30 / pi
    for ending, unit in _UNITS_INSIDE.items():
        if name == ending or name.startswith(ending + "_"):
            return unit, 1.0
    return ("degC", 1.0) if name.endswith("_T") else ("", 1.0)


_UNITS_INSIDE = {
    "velocity": "m/s", "shunt": "ohm", "frequency": "Hz", "amplitude": "m", "displacement": "m", "i": "A",
    "v": "V", "torque": "Nm", "current": "A", "time": "s",
}  # fmt: skip


def unit_inside(name: str) -> str:
    """SI unit of a quantity by the first word of its name: ``force_offset`` N, ``airgap`` m."""
    if "angle" in name or name.startswith("encoder"):
        return "rad"
    first = name.split("_")[0]
    return {"force": "N", "voltage": "V", "torque": "Nm", "current": "A", "speed": "rad/s"}.get(first, "m")
