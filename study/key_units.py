"""The unit at the end of a key name: ``airgap_mm`` is the quantity ``airgap`` in ``mm``."""

from __future__ import annotations

from math import pi

# Each row is one quantity: unit as written in a key name -> factor to SI. None: not a pure factor.
QUANTITIES = (
    {"mm": 1e-3, "m": 1.0, "cm": 1e-2, "um": 1e-6, "micron": 1e-6, "inch": 0.0254},
    {"mm2": 1e-6, "m2": 1.0, "cm2": 1e-4},
    {"deg": pi / 180, "rad": 1.0, "mrad": 1e-3},
    {"rpm": pi / 30, "rad_per_s": 1.0, "deg_per_s": pi / 180, "Hz": 2 * pi},
    {"m_per_s": 1.0, "mm_per_s": 1e-3, "km_per_h": 1 / 3.6},
    {"mm_per_rad": 1e-3, "m_per_rad": 1.0},
    {"T": 1.0, "mT": 1e-3, "G": 1e-4, "kG": 0.1},
    {"A_per_mm2": 1e6, "A_per_m2": 1.0, "A_per_cm2": 1e4},
    {"N": 1.0, "kN": 1e3},
    {"kN_per_m": 1e3, "N_per_m": 1.0, "N_per_mm": 1e3},
    {"kNs_per_m": 1e3, "Ns_per_m": 1.0, "Ns_per_mm": 1e3},
    {"W": 1.0, "kW": 1e3, "mW": 1e-3},
    {"MPa": 1e6, "GPa": 1e9, "Pa": 1.0, "N_per_mm2": 1e6},
    {"kg": 1.0, "g": 1e-3},
    {"kg_m2": 1.0, "kg_mm2": 1e-6, "g_m2": 1e-3},
    {"s": 1.0, "ms": 1e-3, "h": 3600.0},
    {"m_per_s2": 1.0, "mm_per_s2": 1e-3},
    {"mm2_per_s": 1e-6, "m2_per_s": 1.0},
    {"kg_per_m3": 1.0, "g_per_cm3": 1e3},
    {"V": 1.0, "mV": 1e-3, "kV": 1e3},
    {"A": 1.0, "mA": 1e-3, "kA": 1e3},
    {"Ohm_m": 1.0, "uOhm_m": 1e-6, "nOhm_m": 1e-9},
    {"degC": None, "K": None, "degF": None},
    {"per_K": 1.0, "per_degC": 1.0, "percent_per_K": 1e-2},
)

_UNITS_LONGEST_FIRST = sorted({unit for row in QUANTITIES for unit in row}, key=len, reverse=True)


def split_unit(key: str) -> tuple[str, str]:
    """Quantity name and unit of a key, ``("airgap", "mm")``; the unit is empty for a pure number."""
    for unit in _UNITS_LONGEST_FIRST:
        if key.endswith("_" + unit):
            return key[: -len(unit) - 1], unit
    return key, ""


def same_quantity(unit: str, other: str) -> bool:
    """True when the two units measure the same thing, such as mm and um."""
    return any(unit in row and other in row for row in QUANTITIES)


def converted(value: float, unit: str, other: str) -> float | None:
    """The value in the other unit, None where that is not a multiplication (temperatures)."""
    row = next(row for row in QUANTITIES if unit in row and other in row)
    if row[unit] is None:
        return None
    return value * row[unit] / row[other]
