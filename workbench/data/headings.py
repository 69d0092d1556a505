"""Headings and units as laboratories write them: ``Kraft [kN]``, ``force (N)``, ``F / kN``, ``Kraft in kN``,
``torque_Nm``, ``m/s``, ``°C``, ``1/min``."""

from __future__ import annotations

import re
import unicodedata
from typing import Final

from workbench.data.column_units import FACTORS, OFFSETS, split_unit

# Spellings that are not built from the parts of a unit.
_OTHERWISE: Final[dict[str, str]] = {
    "°": "deg", "grad": "deg", "degree": "deg", "degrees": "deg", "°C": "degC", "ºC": "degC", "Celsius": "degC",
    "grad C": "degC", "°F": "degF", "%": "percent", "-": "1", "–": "1", "": "1", "1/min": "rpm", "min-1": "rpm",
    "min^-1": "rpm", "U/min": "rpm", "rev/min": "rpm", "r/min": "rpm", "upm": "rpm", "RPM": "rpm", "Rpm": "rpm",
    "°mech": "deg", "°mech.": "deg", "deg mech": "deg",
    "1/K": "per_K", "sec": "s", "Sek": "s", "Volt": "V", "Ampere": "A",
    "kp": "kgf", "lbs": "lbf", "lb-ft": "lbf_ft", "ft-lb": "lbf_ft", "lb-in": "lbf_in", "in-lb": "lbf_in",
    "Newton": "N", "Ohms": "ohm", "OHM": "ohm", "HZ": "Hz", "hz": "Hz", "KN": "kN", "NM": "Nm",
}  # fmt: skip
_PARTS: Final = (
    ("°", "deg"), ("μ", "u"), ("Ω", "ohm"), ("·", ""), ("⋅", ""), ("∙", ""), ("*", ""),
    ("^", ""), (" ", ""), ("/", "_per_"),
)  # fmt: skip
_IN_BRACKETS = re.compile(
    r"^(?P<name>.*?)\s*(?:\[(?P<a>[^][]*)\]|\((?P<b>[^()]*)\)|<(?P<c>[^<>]*)>|\{(?P<d>[^{}]*)\})$"
)
# Which value of a quantity is meant, and no part of its unit: A rms, Veff.
_RMS = re.compile(r"(?<=[^\s_])[ _]*\(?(?:rms|eff|effektiv)\.?\)?$", re.IGNORECASE)
_BEHIND = re.compile(r"^(?P<name>.+?)(?:\s*/\s*|\s+in\s+|\s*,\s*)(?P<unit>\S.*)$")


def known_unit(written: str) -> str | None:
    """The unit of the one table that a spelling means, ``m_per_s`` of ``m/s``; None where there is none."""
    text = _RMS.sub("", unicodedata.normalize("NFKC", written).strip())
    found = _OTHERWISE.get(text, text)
    for sign, word in _PARTS:
        found = found.replace(sign, word) if found not in FACTORS else found
    return found if found in FACTORS or found in OFFSETS else None


def heading_parts(heading: str) -> tuple[str, str]:
    """Name and unit of a heading; the unit is empty where the heading ends in none that is known.

    A unit in square brackets is kept as written when it is not known, so that it can be asked about.
    """
    found = _IN_BRACKETS.match(heading)
    if found and found["name"]:
        written = next(found[group] for group in "abcd" if found[group] is not None)
        unit = known_unit(written)
        if unit is not None or found["a"] is not None:
            return found["name"].strip(), unit or written.strip()
    behind = _BEHIND.match(heading)
    if behind and (unit := known_unit(behind["unit"])) not in (None, "1"):
        return behind["name"].strip(), str(unit)
    return split_unit(heading)
