"""The one table of units. SI is used inside the project; drawing units live at its borders, in names: ``airgap_mm``.

``2.5 * MILLIMETRE`` is a length in metres; ``length / MILLIMETRE`` is the number a drawing shows. Two quantities keep a
unit of their own inside: temperatures are in degrees Celsius and frequencies in hertz.
"""

from collections.abc import Iterable, Mapping
from functools import lru_cache
from math import pi
from typing import Any

import numpy as np

Values = float | np.ndarray  # of one quantity: at one place, or an array of any shape

GRAVITY = 9.80665  # m/s^2, standard acceleration of free fall
LBF, INCH = 0.45359237 * GRAVITY, 0.0254  # N, m: by the international yard and pound of 1959

# One row a quantity: unit as the end of a name -> factor to the unit used inside. None: not a pure factor.
QUANTITIES: tuple[dict[str, float | None], ...] = (
    {"mm": 1e-3, "m": 1.0, "cm": 1e-2, "um": 1e-6, "micron": 1e-6, "inch": INCH},
    {"mm2": 1e-6, "m2": 1.0, "cm2": 1e-4},
    {"deg": pi / 180, "rad": 1.0, "mrad": 1e-3},
    {"rad2": 1.0, "deg2": (pi / 180) ** 2},
    {"rpm": pi / 30, "rad_per_s": 1.0, "deg_per_s": pi / 180},
    {"Hz": 1.0, "kHz": 1e3},
    {"m_per_s": 1.0, "mm_per_s": 1e-3, "km_per_h": 1 / 3.6},
    {"mm_per_rad": 1e-3, "m_per_rad": 1.0},
    {"T": 1.0, "mT": 1e-3, "G": 1e-4, "kG": 0.1},
    {"Wb": 1.0, "mWb": 1e-3, "Vs": 1.0, "mVs": 1e-3},
    {"Wb_per_m": 1.0},
    {"A_per_m": 1.0, "kA_per_m": 1e3},
    {"A_per_mm2": 1e6, "A_per_m2": 1.0, "A_per_cm2": 1e4},
    {"N": 1.0, "kN": 1e3, "mN": 1e-3, "kgf": GRAVITY, "lbf": LBF},
    {"Nm": 1.0, "mNm": 1e-3, "Ncm": 1e-2, "Nmm": 1e-3, "kNm": 1e3, "lbf_in": LBF * INCH, "lbf_ft": 12 * LBF * INCH},
    {"Nm_per_m": 1.0, "Nm_per_mm": 1e3},
    {"Nm_per_A": 1.0, "mNm_per_A": 1e-3},
    {"kN_per_m": 1e3, "N_per_m": 1.0, "N_per_mm": 1e3},
    {"kNs_per_m": 1e3, "Ns_per_m": 1.0, "Ns_per_mm": 1e3},
    {"Nms_per_rad": 1.0, "mNms_per_rad": 1e-3},
    {"N_per_A": 1.0},
    {"Vs_per_m": 1.0},
    {"W": 1.0, "kW": 1e3, "mW": 1e-3},
    {"W_per_K": 1.0},
    {"W_per_mK": 1.0},
    {"W_per_m2K": 1.0},
    {"J_per_K": 1.0, "kJ_per_K": 1e3},
    {"MPa": 1e6, "GPa": 1e9, "Pa": 1.0, "N_per_mm2": 1e6},
    {"kg": 1.0, "g": 1e-3},
    {"kg_m2": 1.0, "kg_mm2": 1e-6, "g_m2": 1e-3, "g_cm2": 1e-7},
    {"s": 1.0, "ms": 1e-3, "h": 3600.0},
    {"m_per_s2": 1.0, "mm_per_s2": 1e-3},
    {"mm2_per_s": 1e-6, "m2_per_s": 1.0},
    {"kg_per_m3": 1.0, "g_per_cm3": 1e3},
    {"V": 1.0, "mV": 1e-3, "kV": 1e3},
    {"A": 1.0, "mA": 1e-3, "kA": 1e3},
    {"ohm": 1.0, "mohm": 1e-3, "kohm": 1e3, "Ohm": 1.0, "mOhm": 1e-3, "kOhm": 1e3},
    {"H": 1.0, "mH": 1e-3, "uH": 1e-6},
    {"H_per_m": 1.0},
    {"Ohm_m": 1.0, "uOhm_m": 1e-6, "nOhm_m": 1e-9},
    {"degC": 1.0, "K": None, "degF": None},
    {"per_K": 1.0, "per_degC": 1.0, "percent_per_K": 1e-2},
    {"percent": 1e-2},
)
FACTORS: dict[str, float] = {unit: f for row in QUANTITIES for unit, f in row.items() if f is not None}
_LONGEST_FIRST = sorted({unit for row in QUANTITIES for unit in row}, key=len, reverse=True)

MILLIMETRE = FACTORS["mm"]  # m
SQUARE_MILLIMETRE = FACTORS["mm2"]  # m^2
DEGREE = FACTORS["deg"]  # rad
RPM = FACTORS["rpm"]  # rad/s
AMPERE_PER_SQUARE_MILLIMETRE = FACTORS["A_per_mm2"]  # A/m^2
MILLIOHM = FACTORS["mOhm"]  # ohm
MICROHENRY = FACTORS["uH"]  # H

MU_0 = 4e-7 * pi  # H/m, vacuum permeability (the 2019 SI value differs by 1e-10)

# How the parts of a unit are written that are not their own names.
_WRITTEN = {"deg": "°", "degC": "°C", "degF": "°F", "mm2": "mm²", "m2": "m²", "cm2": "cm²", "m3": "m³", "cm3": "cm³",
            "s2": "s²", "rad2": "rad²", "deg2": "deg²", "percent": "%", "ohm": "Ω", "Ohm": "Ω", "mOhm": "mΩ",
            "mohm": "mΩ", "kOhm": "kΩ", "kohm": "kΩ", "uOhm": "µΩ", "nOhm": "nΩ", "uH": "µH", "um": "µm",
            "mK": "(m K)", "m2K": "(m² K)"}  # fmt: skip


def percent(share: float, decimals: int = 0) -> str:
    """A share [1] as people read it: ``56 %``."""
    return f"{100 * share:.{decimals}f} %"


@lru_cache(maxsize=4096)
def split_unit(name: str) -> tuple[str, str]:
    """Quantity and unit of a name, ``("airgap", "mm")`` of ``airgap_mm``; the unit is empty for a pure number."""
    for unit in _LONGEST_FIRST:
        if name.endswith("_" + unit):
            return name[: -len(unit) - 1], unit
    return name, ""


def to_si(name: str, value: Any) -> tuple[str, Any]:
    """(quantity, value in SI) of a named value in drawing units; a tuple entry by entry, None and text as they are."""
    quantity, unit = split_unit(name)
    factor = FACTORS.get(unit, 1.0)
    if isinstance(value, tuple):
        return quantity, tuple(to_si(name, one)[1] for one in value)
    if isinstance(value, (int, float)) and not isinstance(value, bool) and factor != 1.0:
        return quantity, value * factor
    return quantity, value


def drawn(values: Mapping[str, object] | object, names: Iterable[str]) -> dict[str, object]:
    """Values in SI as a drawing shows them: ``drawn(match, ["active_length_mm"])`` -> {"active_length_mm": 36.8}.

    values: mapping or object with the quantity (``active_length``) as key or attribute
    names: with the unit to show as their end; None stays None
    """
    found: dict[str, object] = {}
    for name in names:
        quantity, unit = split_unit(name)
        value: Any = values[quantity] if isinstance(values, Mapping) else getattr(values, quantity)
        is_number = hasattr(value, "__truediv__") and unit != ""
        found[name] = value / FACTORS[unit] if is_number else value
    return found


def written(unit: str) -> str:
    """A unit as a heading writes it: ``mm/rad`` of ``mm_per_rad``, ``°`` of ``deg``, ``1/K`` of ``per_K``."""
    return "/".join(_written_product(part) for part in f"_{unit}".split("_per_")) if unit else ""


def _written_product(unit: str) -> str:
    parts = unit.removeprefix("_").split("_")
    return " ".join(_WRITTEN.get(part, part) for part in parts) or "1"


def same_quantity(unit: str, other: str) -> bool:
    """True when the two units measure the same thing, such as mm and um."""
    return any(unit in row and other in row for row in QUANTITIES)


def converted(value: float, unit: str, other: str) -> float | None:
    """The value in the other unit, None where that is not a multiplication (temperatures)."""
    row = next(row for row in QUANTITIES if unit in row and other in row)
    from_unit, to_unit = row[unit], row[other]
    if from_unit is None or to_unit is None:
        return None
    return value * from_unit / to_unit


# What the last word of a name is measured in throughout the project, as docstrings write it; "1" is a pure number.
# Words that mean several things (speed, density, ratio, damping) are not here: a docstring states their unit.
SYMBOLS: dict[str, str] = {
    word: unit
    for unit, words in {
        "m": "radius diameter length width depth airgap opening thickness distance stroke height wavelength",
        "m^2": "area",
        "rad": "angle swing",
        "m/s": "velocity",
        "N": "force",
        "Nm": "torque",
        "kg": "mass",
        "kg m^2": "inertia",
        "N/m": "stiffness",
        "W": "power",
        "V": "voltage",
        "A": "i_d i_q current ampere_turns",
        "Wb": "psi_d psi_q",
        "ohm": "resistance",
        "ohm m": "resistivity",
        "H": "inductance inductance_d inductance_q",
        "Hz": "frequency",
        "s": "time duration",
        "degC": "temperature",
        "m/rad": "transmission_ratio linkage_ratio",
        "W/K": "conductance",
        "W/(m K)": "conductivity",
        "W/(m^2 K)": "film",
        "J/K": "capacity",
        "1": "fraction factor share packing efficiency teeth planets slots poles pairs order turns strands layers "
        "count",
    }.items()
    for word in words.split()
}


def usual_unit(name: str) -> str | None:
    """Unit of a name by ``SYMBOLS``: that of the longest ending, None where it has none.

    A quotient such as ``torque_per_length`` has the unit of the whole, never that of what stands behind its ``per``.
    """
    words = name.split("_")
    last = max((place for place, word in enumerate(words) if word == "per"), default=len(words))
    endings = ("_".join(words[first:]) for first in range(last))
    return next((SYMBOLS[ending] for ending in endings if ending in SYMBOLS), None)
