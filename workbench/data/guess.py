"""What the columns of a laboratory's file probably are, by their words and units. Only drafts are written from this."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatch
from typing import Final

import numpy as np

from units import QUANTITIES
from workbench.data.kinds import KINDS, Kind
from workbench.data.raw_table import Heading, RawTable

_PLAIN: Final = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss", "η": "eta", "φ": "phi"})
_PHASES: Final = {
    "a": "a", "b": "b", "c": "c", "u": "a", "v": "b", "w": "c", "1": "a", "2": "b", "3": "c", "l1": "a", "l2": "b",
    "l3": "c", "ua": "a", "ub": "b", "uc": "c", "ia": "a", "ib": "b", "ic": "c", "u1": "a", "u2": "b", "u3": "c",
    "i1": "a", "i2": "b", "i3": "c", "va": "a", "vb": "b", "vc": "c",
    "iu": "a", "iv": "b", "iw": "c", "uu": "a", "uv": "b", "uw": "c",
}  # fmt: skip
# Two lines, as a meter between them is called: uv is ab. Which comes first counts for a voltage alone.
_LINE_PAIRS: Final = {
    x[k] + x[(k + 1) % 3]: pair for x in ("abc", "uvw", "123") for k, pair in enumerate(("ab", "bc", "ca"))
}
_EITHER_WAY: Final = _LINE_PAIRS | {pair[::-1]: name for pair, name in _LINE_PAIRS.items()}
UNTOLD_INDUCTANCE: Final = "l_?"  # of a phase or of two lines, which differ by a factor of two and in their angle
_BOOKS: Final = {
    "repeat": ("repeat", "repetition", "rep", "run", "trial", "wiederholung", "wdh", "wdhlg", "lauf", "durchgang",
               "messung", "messreihe"),
    "scan": ("scan", "sweep"),
    "direction": ("direction", "richtung", "drehrichtung"), "holdout": ("holdout",),
}  # fmt: skip
_NUMBERS: Final = {"nr", "no", "nummer", "number"}
LEAST_ROWS: Final = 5  # of every repeat that a column without another name counts
_OF_DQ: Final = ("dq", "dyno_map", "no_load")  # how the names of kinds begin that a dq model answers first
# Words of a heading -> quantity, for headings without a unit that is known.
_WORDS: Final = {
    "force": "force", "kraft": "force", "torque": "torque", "moment": "torque", "drehmoment": "torque",
    "velocity": "velocity", "geschwindigkeit": "velocity", "speed": "speed", "drehzahl": "speed",
    "angle": "angle_mech", "winkel": "angle_mech", "phi": "angle_mech", "theta": "angle_mech", "frequency": "frequency",
    "frequenz": "frequency", "power": "power", "leistung": "power", "voltage": "voltage", "spannung": "voltage",
    "current": "current", "strom": "current", "shunt": "shunt", "amplitude": "amplitude",
    "widerstand": "resistance", "inductance": UNTOLD_INDUCTANCE, "induktivitaet": UNTOLD_INDUCTANCE,
}  # fmt: skip
_COMPOUNDS: Final = ("kraft", "moment", "drehzahl", "geschwindigkeit", "spannung", "strom", "widerstand")
# Unit -> quantity, and the prefix that a phase or an axis takes.
_UNITS: Final = {
    "N": ("force", ""), "Nm": ("torque", ""), "rpm": ("speed", ""), "rad_per_s": ("speed", ""),
    "deg_per_s": ("speed", ""), "m_per_s": ("velocity", ""), "deg": ("angle_mech", ""), "rad": ("angle_mech", ""),
    "Hz": ("frequency", ""), "W": ("power", ""), "V": ("voltage", "v"), "A": ("current", "i"), "Vs": ("", "psi"),
    "Wb": ("", "psi"), "H": ("", "l"), "ohm": ("resistance", "r"), "m": ("displacement", ""),
    "Ns_per_m": ("damping", ""), "s": ("time", ""),
}  # fmt: skip
_LINES: Final = {"i_a", "i_b", "i_c"}
_RATIOS: Final[dict[str, tuple[set[str], ...]]] = {
    "efficiency": ({"efficiency"}, {"eta"}, {"wirkungsgrad"}),
    "power_factor": ({"power", "factor"}, {"pf"}, {"cos"}, {"cosphi"}, {"leistungsfaktor"}),
}
_SHAFT: Final = {"mech", "mechanical", "mechanisch", "mechanische", "shaft", "welle"}
_SHAFT_POWER: Final = "power of the shaft"  # follows from torque, and beside none is that of a drive
_LINE_VOLTAGES: Final = {"v_ab", "v_bc", "v_ca"}
_PHASE_VOLTAGES: Final = {"v_a", "v_b", "v_c"}
# Words of a file's name -> its kind, where columns alone do not tell: an inverter's map has a current over speed and
# torque, too.
_FILES: Final = {
    "kurzschluss": "short_circuit", "shortcircuit": "short_circuit", "schlepp": "drag", "rastmoment": "cogging",
}  # fmt: skip
_RMS: Final = {"rms", "eff", "effektiv", "arms", "vrms", "aeff", "veff"}
_MEANS: Final = {*_RMS, "peak", "mean", "avg", "mittel", "ist", "mess", "meas"}  # which value of a quantity it is
# Words of what was asked for, which is not what was measured where that has a column too.
_WANTED: Final = {"soll", "sollwert", "set", "setpoint", "target", "ref", "reference", "cmd", "command", "demand"}
_THERMAL: Final = {"t", "temp", "temperature", "temperatur"}
_AT_END: Final = re.compile(r"[\s_.#-]*(\d{1,2})$")  # the number that a name ends in
_BASES: Final = {unit: base for row in QUANTITIES for base in row if base in _UNITS for unit in row}


@dataclass(frozen=True)
class Guess:
    """place, heading: of the column;  quantity: "" where nothing fits;  unit: "" where it is not known"""

    place: int
    heading: Heading
    quantity: str
    unit: str


def guesses(raw: RawTable) -> list[Guess]:
    """One guess for each column; a quantity is given to the first column that may be it, what was asked for last."""
    named = ["time" if raw.holds_times(place) else _quantity(h) for place, h in enumerate(raw.headings)]
    holders: dict[str, int] = {}
    for place in sorted(range(len(named)), key=lambda place: bool(_WANTED & set(_words(raw.headings[place].name)))):
        holders.setdefault(named[place], place)
    found: list[Guess] = []
    for place, heading in enumerate(raw.headings):
        quantity = named[place] if holders[named[place]] == place else ""
        unit = "s" if raw.holds_times(place) else heading.unit or _usual_unit(quantity, heading)
        found.append(Guess(place, heading, quantity or _counted(raw, place), unit))
    for settled in (_of_a_sine, _shunted, _of_a_line, _of_lines, _of_a_damper, _of_a_drive):
        found = settled(found)
    return found


def side_by_side(found: Sequence[Guess], kind: Kind) -> dict[str, tuple[str, ...]]:
    """Repeats of responses beside one another, F1, F2, F3: headings of the further ones by that of the first. None
    where a column counts repeats, or responses have unlike numbers of them."""
    answers = [g for g in found if kind.is_response(g.quantity)]
    beside = {g.heading.written: _again(g, found) for g in answers}
    unlike = len({len(again) for again in beside.values()}) != 1
    return {} if unlike or any(g.quantity == "repeat" for g in found) else {k: p for k, p in beside.items() if p}


def _again(first: Guess, found: Sequence[Guess]) -> tuple[str, ...]:
    """Headings of columns that nothing else is known of, as that of another but for a number that goes on."""
    stem, number = numbered(first.heading.name)
    alike = [g.heading for g in found if not g.quantity and g.unit == first.unit]
    unknown = {numbered(heading.name): heading.written for heading in alike}
    again: list[str] = []
    while (stem, number + 1 + len(again)) in unknown:
        again.append(unknown[stem, number + 1 + len(again)])
    return tuple(again)


def numbered(name: str) -> tuple[str, int]:
    """("force", 2) of "force 2"; what has no number is the first."""
    number = _AT_END.search(name)
    return name.removesuffix(number.group() if number else "").lower(), int(number.group(1)) if number else 1


def _counted(raw: RawTable, place: int) -> str:
    """Repeats, where a column called a number counts few and each of them has several rows."""
    if not _NUMBERS & set(_words(raw.headings[place].name)) or not raw.holds_numbers(place):
        return ""
    values, rows = np.unique(raw.values(place), return_counts=True)
    few = np.array_equal(values, np.arange(1, len(values) + 1)) and len(values) > 1
    return "repeat" if few and rows.min() >= LEAST_ROWS else ""


def _usual_unit(quantity: str, heading: Heading) -> str:
    if quantity in _RATIOS:
        return "1"
    return "degC" if quantity.endswith("_T") and _words(heading.name)[-1] == "c" else ""


def _of_a_sine(found: list[Guess]) -> list[Guess]:
    """Size and angle over a frequency are no damping and no place of a rotor: an impedance has re and im. Beside a
    force and what moves, an angle is that of the sine."""
    there = {g.quantity for g in found}
    if "force" in there and {"displacement", "velocity"} & there:
        return [replace(g, quantity="phase") if g.quantity == "angle_mech" else g for g in found]
    if "frequency" not in there or "re" in there:
        return found
    return [replace(g, quantity="") if g.quantity in ("damping", "angle_mech") else g for g in found]


def _shunted(found: list[Guess]) -> list[Guess]:
    """A resistance beside a force is that of a shunt."""
    if not any(g.quantity == "force" for g in found) or any(g.quantity == "shunt" for g in found):
        return found
    return [replace(g, quantity="shunt") if g.quantity == "resistance" else g for g in found]


def _of_a_line(found: list[Guess]) -> list[Guess]:
    """One current of three beside a speed or a torque, and no angle: a meter's RMS."""
    return _alone(found, _LINES, {"speed", "torque"}, "current")


def _of_lines(found: list[Guess]) -> list[Guess]:
    """One voltage between lines likewise, where none is of a phase."""
    if _PHASE_VOLTAGES & {g.quantity for g in found}:
        return found
    return _alone(found, _LINE_VOLTAGES, {"speed", "torque"}, "v_ll")


def _of_a_damper(found: list[Guess]) -> list[Guess]:
    """One voltage beside a velocity: a damper has one circuit."""
    return _alone(found, _PHASE_VOLTAGES, {"velocity"}, "voltage")


def _alone(found: list[Guess], names: set[str], beside: set[str], quantity: str) -> list[Guess]:
    """One of these names beside one of others, and no angle, is another quantity."""
    there = {g.quantity for g in found}
    if "angle_mech" in there or not beside & there or len(names & there) != 1:
        return found
    return [replace(g, quantity=quantity) if g.quantity in names else g for g in found]


def _of_a_drive(found: list[Guess]) -> list[Guess]:
    """Power of the shaft, which is left out where torque or the power of the terminals is read."""
    known = {"torque", "power"} & {g.quantity for g in found}
    return [replace(g, quantity="" if known else "power") if g.quantity == _SHAFT_POWER else g for g in found]


def is_driven(columns: Sequence[Guess]) -> bool:
    """Whether the power is that of a drive at the shaft."""
    return any(g.quantity == "power" and _of_shaft(g.heading) for g in columns)


def is_rms(heading: Heading) -> bool:
    """Whether a heading says that its values are RMS."""
    return bool(_RMS & set(_words(heading.written)))


def _of_shaft(heading: Heading) -> bool:
    return bool(_SHAFT & set(_words(heading.name)))


def _words(text: str) -> list[str]:
    return [w for w in re.split(r"[^a-z0-9]+", text.lower().translate(_PLAIN)) if w]


def _quantity(heading: Heading) -> str:
    if is_known(heading.name):
        return heading.name
    words = _words(heading.name)
    if (ratio := next((name for name, asked in _RATIOS.items() if any(a <= set(words) for a in asked)), "")) != "":
        return ratio
    if "power" in (_UNITS.get(_base(heading.unit), ("",))[0], *(_WORDS.get(w) for w in words)) and _of_shaft(heading):
        return _SHAFT_POWER
    for book, names in _BOOKS.items():
        if heading.unit in ("", "1") and set(words) & set(names):
            return book
    if heading.unit in ("degC", "K", "degF") or (words[:1] and words[0] in _THERMAL and words[-1] == "c"):
        return _temperature(words)
    if not heading.unit and _is_thermal(words):
        return _temperature(words)
    return _by_unit(heading.unit, words) or next(filter(None, map(_by_word, words)), "")


def _by_word(word: str) -> str:
    """The quantity of a word or of one that German ends in: Losbrechmoment, Klemmenspannung."""
    ends = (end for end in _COMPOUNDS if word.endswith(end))
    return _WORDS.get(word) or next((_WORDS[end] for end in ends), "")


def is_known(name: str) -> bool:
    """Whether a name is one that kinds or the bookkeeping know."""
    patterns = {p for kind in KINDS.values() for p in (*kind.responses, *kind.axes)}
    return name in (*_BOOKS, "magnet_T", "winding_T") or any(fnmatch(name, p) for p in patterns)


def _is_thermal(words: Sequence[str]) -> bool:
    """Whether words without a unit name a temperature that conditions know; T of a rotor or a stator is a torque."""
    is_named = any(w.endswith(("temp", "temperature", "temperatur")) for w in words)
    has_letter = "t" in words and {"rotor", "stator"}.isdisjoint(words)
    return (is_named or has_letter) and _temperature(words) != ""


def _temperature(words: Sequence[str]) -> str:
    if any(w.startswith(("magnet", "rotor")) for w in words):
        return "magnet_T"
    coil = ("winding", "wicklung", "coil", "spule", "copper", "kupfer", "stator")
    return "winding_T" if "cu" in words or any(w.startswith(coil) for w in words) else ""


def _by_unit(unit: str, words: Sequence[str]) -> str:
    plain, prefix = _UNITS.get(_base(unit), ("", ""))
    words = [w for w in words if w not in _MEANS] or words
    last = words[-1] if words else ""
    if prefix and last in ("d", "q", "ud", "uq", "id", "iq", "vd", "vq") and prefix in "vi":
        return f"{prefix}_{last[-1]}"
    if prefix == "v" and {"ll", "line", "verkettet", "leiter"} & set(words):
        return "v_ll"
    if pair := _lines_of(prefix, words):
        return f"{prefix}_{pair}"
    phases = [w for w in (last, *words[:1]) if w in _PHASES and (w == last or len(w) == 2)]  # ia_mes, but u_mes is none
    if prefix and phases:
        return f"{prefix}_{_PHASES[phases[0]]}"
    if plain == "displacement" and ("amplitude" in words or words == ["a"]):
        return "amplitude"
    if plain == "resistance" and {"shunt", "load", "last", "lastwiderstand"} & set(words):
        return "shunt"
    if plain == "damping" and {"re", "real", "im", "imag", "imaginary"} & set(words):
        return "re" if {"re", "real"} & set(words) else "im"
    return UNTOLD_INDUCTANCE if prefix == "l" and last not in ("d", "q", "ld", "lq") else plain


def _lines_of(prefix: str, words: Sequence[str]) -> str:
    """bc of L_vw and of "Induktivitaet wv"; a voltage Uv is that of a phase, U_uv and Uuv are not."""
    if prefix in ("l", "r"):
        return _EITHER_WAY.get(words[-1], "") if words else ""
    between = "".join(words)
    return _LINE_PAIRS.get(between[1:], "") if prefix == "v" and between[:1] in ("u", "v") else ""


def _base(unit: str) -> str:
    """N of kN, ohm of mOhm, Nm of Ncm."""
    return unit if unit in _UNITS else _BASES.get(unit, unit)


def likely_kind(quantities: Sequence[str], file: str = "") -> str:
    """The kind whose responses and axes cover most of the columns, and of equal ones the one that has least besides;
    first one that the name of the file names, where it has any of them."""
    covers = {name: _cover(kind, quantities) for name, kind in KINDS.items()}
    letters = re.sub("[^a-z]", "", file.lower())
    named = {kind for word, kind in _FILES.items() if word in letters and covers[kind][0]}
    return max(KINDS, key=lambda name: (name in named, covers[name], name == "generic"))


def _cover(kind: Kind, quantities: Sequence[str]) -> tuple[int, float]:
    """Columns that are a response or an axis, and the shares of the kind's own responses and axes that are there;
    nothing where the kind needs an axis that is not."""
    if not set(kind.needs) <= set(quantities):
        return 0, 0.0
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
    if {"v_d", "v_q", "v_ll"} & set(quantities) or any(kind.startswith(_OF_DQ) for kind in kinds):
        return "dq"
    return "machine" if set(quantities) & {"v_a", "angle_mech", "i_a", "r_a"} else "?"
