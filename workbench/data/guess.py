"""What the columns of a laboratory's file probably are, by their words and units. Only drafts are written from this."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatch
from typing import Final

import numpy as np

from workbench.data.kinds import KINDS, Kind
from workbench.data.raw_table import Heading, RawTable

_PLAIN: Final = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss"})
_PHASES: Final = {
    "a": "a", "b": "b", "c": "c", "u": "a", "v": "b", "w": "c", "1": "a", "2": "b", "3": "c", "l1": "a", "l2": "b",
    "l3": "c", "ua": "a", "ub": "b", "uc": "c", "ia": "a", "ib": "b", "ic": "c", "u1": "a", "u2": "b", "u3": "c",
    "i1": "a", "i2": "b", "i3": "c", "va": "a", "vb": "b", "vc": "c",
}  # fmt: skip
_BOOKS: Final = {
    "repeat": ("repeat", "repetition", "wiederholung", "lauf", "run", "durchgang"), "scan": ("scan", "sweep"),
    "direction": ("direction", "richtung", "drehrichtung"), "holdout": ("holdout",),
}  # fmt: skip
# Words of a heading -> quantity, for headings without a unit that is known.
_WORDS: Final = {
    "force": "force", "kraft": "force", "torque": "torque", "moment": "torque", "drehmoment": "torque",
    "velocity": "velocity", "geschwindigkeit": "velocity", "speed": "speed", "drehzahl": "speed",
    "angle": "angle_mech", "winkel": "angle_mech", "phi": "angle_mech", "theta": "angle_mech", "frequency": "frequency",
    "frequenz": "frequency", "power": "power", "leistung": "power", "voltage": "voltage", "spannung": "voltage",
    "current": "current", "strom": "current", "shunt": "shunt", "amplitude": "amplitude",
}  # fmt: skip
# Unit -> quantity, and the prefix that a phase or an axis takes.
_UNITS: Final = {
    "N": ("force", ""), "Nm": ("torque", ""), "rpm": ("speed", ""), "rad_per_s": ("speed", ""),
    "deg_per_s": ("speed", ""), "m_per_s": ("velocity", ""), "deg": ("angle_mech", ""), "rad": ("angle_mech", ""),
    "Hz": ("frequency", ""), "W": ("power", ""), "V": ("voltage", "v"), "A": ("current", "i"), "Vs": ("", "psi"),
    "Wb": ("", "psi"), "H": ("", "l"), "ohm": ("resistance", "r"), "m": ("displacement", ""),
    "Ns_per_m": ("damping", ""), "s": ("time", ""),
}  # fmt: skip
_SCALED: Final = re.compile(r"^(?:m|k|u|M|c)(?=[A-Z]|ohm|Ohm|m_per_s|m$|s$)")


@dataclass(frozen=True)
class Guess:
    """place, heading: of the column;  quantity: "" where nothing fits;  unit: "" where it is not known"""

    place: int
    heading: Heading
    quantity: str
    unit: str


def guesses(raw: RawTable) -> list[Guess]:
    """One guess for each column; a quantity is given to the first column that may be it."""
    found: list[Guess] = []
    for place, heading in enumerate(raw.headings):
        quantity = "time" if raw.holds_times(place) else _quantity(heading)
        if any(quantity == other.quantity for other in found):
            quantity = ""
        unit = "s" if raw.holds_times(place) else heading.unit
        found.append(Guess(place, heading, quantity, unit))
    return _shunted(found)


def _shunted(found: list[Guess]) -> list[Guess]:
    """A resistance beside a force is that of a shunt."""
    if not any(g.quantity == "force" for g in found) or any(g.quantity == "shunt" for g in found):
        return found
    return [Guess(g.place, g.heading, "shunt", g.unit) if g.quantity == "resistance" else g for g in found]


def _quantity(heading: Heading) -> str:
    if is_known(heading.name):
        return heading.name
    words = [w for w in re.split(r"[^a-z0-9]+", heading.name.lower().translate(_PLAIN)) if w]
    for book, names in _BOOKS.items():
        if not heading.unit and set(words) & set(names):
            return book
    if heading.unit in ("degC", "K", "degF"):
        return _temperature(words)
    return _by_unit(heading.unit, words) or next((_WORDS[w] for w in words if w in _WORDS), "")


def is_known(name: str) -> bool:
    """Whether a name is one that kinds or the bookkeeping know."""
    patterns = {p for kind in KINDS.values() for p in (*kind.responses, *kind.axes)}
    return name in (*_BOOKS, "magnet_T", "winding_T") or any(fnmatch(name, p) for p in patterns)


def _temperature(words: Sequence[str]) -> str:
    if any(w.startswith(("magnet", "rotor")) for w in words):
        return "magnet_T"
    coil = ("winding", "wicklung", "coil", "spule", "copper", "kupfer", "stator")
    return "winding_T" if any(w.startswith(coil) for w in words) else ""


def _by_unit(unit: str, words: Sequence[str]) -> str:
    plain, prefix = _UNITS.get(_base(unit), ("", ""))
    last = words[-1] if words else ""
    if prefix and last in ("d", "q", "ud", "uq", "id", "iq", "vd", "vq") and prefix in "vi":
        return f"{prefix}_{last[-1]}"
    if prefix == "v" and {"ll", "line", "verkettet", "leiter"} & set(words):
        return "v_ll"
    if prefix and last in _PHASES:
        return f"{prefix}_{_PHASES[last]}"
    if plain == "displacement" and "amplitude" in words:
        return "amplitude"
    if plain == "resistance" and {"shunt", "load", "last", "lastwiderstand"} & set(words):
        return "shunt"
    if plain == "damping" and {"re", "real", "im", "imag", "imaginary"} & set(words):
        return "re" if {"re", "real"} & set(words) else "im"
    return plain


def _base(unit: str) -> str:
    """N of kN, ohm of mOhm, Vs of mVs."""
    known = {"Ohm": "ohm"}
    if unit in _UNITS:
        return unit
    bare = _SCALED.sub("", unit)
    return known.get(bare, bare)


def likely_kind(quantities: Sequence[str]) -> str:
    """The kind whose responses and axes cover most of the columns, and of equal ones the one that has least besides."""
    return max(KINDS, key=lambda name: (_cover(KINDS[name], quantities), name == "generic"))


def _cover(kind: Kind, quantities: Sequence[str]) -> tuple[int, float]:
    """Columns that are a response or an axis, and the shares of the kind's own responses and axes that are there."""
    answers = [q for q in quantities if kind.is_response(q)]
    asked = [q for q in quantities if any(fnmatch(q, axis) for axis in kind.axes)]
    if not answers or not asked:
        return 0, 0.0
    used = [sum(any(fnmatch(q, p) for q in quantities) for p in patterns) for patterns in (kind.responses, kind.axes)]
    return len({*answers, *asked}), used[0] / len(kind.responses) + used[1] / len(kind.axes)


def likely_model(kinds: Sequence[str], quantities: Sequence[str]) -> str:
    """The model whose device was probably measured."""
    if {"force", "velocity", "shunt", "damping", "re"} & set(quantities):
        return "damper"
    if {"v_d", "v_q", "v_ll"} & set(quantities) or any(kind.startswith("dq") for kind in kinds):
        return "dq"
    return "machine" if set(quantities) & {"v_a", "angle_mech", "i_a", "r_a"} else "?"


def noise_of(values: np.ndarray, axes: Sequence[np.ndarray]) -> float | None:
    """Standard uncertainty of one reading from neighbouring rows, None for few rows: third differences along the last
    axis, robust, and the step of the digits over the square root of twelve."""
    order = np.lexsort(axes) if len(axes) else np.arange(len(values))
    sorted_values = values[order]
    good = sorted_values[np.isfinite(sorted_values)]
    if len(good) < 12:
        return None
    rough = 1.4826 * float(np.median(np.abs(np.diff(good, 3)))) / np.sqrt(20.0)
    steps = np.diff(np.unique(good))
    digits = float(steps.min()) / np.sqrt(12.0) if steps.size else 0.0
    return max(rough, digits) or None
