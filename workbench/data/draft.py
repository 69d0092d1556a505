"""Writes the ``campaign.toml`` of plain data files: what can be seen in them is filled in, what only the laboratory
knows is a "?"."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatch
from pathlib import Path

import numpy as np

from disk import write_atomically
from workbench.data.cells import UntoldSign
from workbench.data.column_units import FACTORS, split_unit
from workbench.data.device_keys import CALIBRATIONS, DEVICE_KEYS, TOLERANCES, ZERO_DRIFT, ZEROS, DeviceKey, Spread
from workbench.data.guess import (
    UNTOLD_INDUCTANCE,
    Guess,
    guesses,
    is_driven,
    is_rms,
    likely_kind,
    likely_model,
    numbered,
    side_by_side,
)
from workbench.data.headings import known_unit
from workbench.data.kinds import KINDS
from workbench.data.raw_table import Layout, RawTable, read_raw, used_twice
from workbench.data.scatter import noise_of
from workbench.data.schema import FILE, ColumnEntry, TableEntry, campaign_file
from workbench.data.side_by_side import NUMBER, stacked
from workbench.errors import WorkbenchError

_OF_THE_LARGEST = f"assumed: {100 * ZERO_DRIFT:g} % of the largest reading"
_SAME_PLACE, _SAME_ANSWER = 0.01, 0.2  # of the largest value: files that differ by less may repeat one another
_BOOKKEEPING = ("scan", "repeat", "holdout")
_WHICH_INDUCTANCE = "name: l_a of a phase fed alone, l_bc (l_ab, l_ca) between two lines, l_m of B by A"
_OF_AXES = ("i_d", "i_q", "v_d", "v_q")
_HEAD = """# A campaign: what was measured, and how well it is known. Fill in every "?"; see docs/campaign.md.
[campaign]
id = {id}  # names the folder of the results
repeats = {repeats}  # two or more show the size of the noise
holdout = {{ rule = "by region" }}  # operating conditions that no fit sees, to test the prediction
"""
_TOLERANCE = "[tolerance]  # how well the device is known: what has none counts as exact; better your own figures"
_SYSTEMATIC = "[systematic]  # errors that all rows of an instrument share; better those of its certificate"


@dataclass(frozen=True, eq=False)
class _Sheet:
    """A data file, or some that repeat it, with what its columns probably are.

    files: names, that of the first repeat first;  beside: headings of the repeats beside a response, by its own
    before: what another campaign says of the same headings;  decimal: sign that has to be declared
    kind_is: where the kind is from;  constants: what was the same in all rows of another campaign
    """

    files: tuple[str, ...]
    raw: RawTable
    columns: tuple[Guess, ...]
    kind: str
    beside: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    before: Mapping[str, ColumnEntry] = field(default_factory=dict)
    decimal: str | None = None
    kind_is: str = "a guess"
    constants: Mapping[str, object] = field(default_factory=dict)

    @property
    def entry(self) -> TableEntry:
        """What is declared of its repeats."""
        columns = {h: ColumnEntry(role="response", repeats=list(again)) for h, again in self.beside.items()}
        return TableEntry(file=self.files[0], kind=self.kind, repeats=list(self.files[1:]), columns=columns or None)


def draft_of(paths: Sequence[Path], like: Path | None = None, decimal: str | None = None) -> str:
    """The text of a ``campaign.toml`` for some data files of one folder.

    like: folder of a campaign of the same device, whose device, tolerances, instruments and, under the same headings,
        columns are taken over
    decimal: sign of the files, "," or ".", where they do not show it
    Raises:
        WorkbenchError: a file is not there, is no table, or lies in another folder.
    """
    tables = [] if like is None else campaign_file(like).table
    read = _sheets(paths, decimal, tables)
    folder = paths[0].resolve().parent
    if any(path.resolve().parent != folder for path in paths):
        raise WorkbenchError(f"all files of a campaign lie in one folder; put them beside {paths[0]}.")
    sheets = [_as_before(_below(repeats), tables) for repeats in _repeated(read)]
    quantities = [guess.quantity for sheet in sheets for guess in sheet.columns]
    repeats = max(_repeats(sheet) for sheet in sheets)
    name = re.sub(r"[^\w.-]+", "-", folder.name).strip("-.") or "campaign"
    head = _HEAD.format(id=_text(name), repeats=repeats)
    model = likely_model([sheet.kind for sheet in sheets], quantities)
    device = _device(model, quantities, _zeros(sheets)) if like is None else _taken_over(like)
    return head + device + "".join(map(_table, sheets))


def campaign_like(folder: Path, name: str) -> str:
    """The text of a ``campaign.toml`` without tables for measurements of the device of another campaign.

    Raises:
        WorkbenchError: the other campaign cannot be read.
    """
    return f"[campaign]\nid = {_text(name)}\n" + _taken_over(folder)


def write_draft(paths: Sequence[Path], like: Path | None = None, decimal: str | None = None) -> tuple[Path, list[int]]:
    """Writes the draft beside the data files, which are only read; returns its path and the lines to fill in.

    Raises:
        WorkbenchError: there is a campaign file already, or a file is no table.
    """
    target = paths[0].parent / FILE
    text = draft_of(paths, like, decimal)
    if target.exists():
        raise WorkbenchError(f"{target}: exists already; it is not overwritten.")
    try:
        write_atomically(target, lambda part: part.write_text(text, encoding="utf-8"))
    except OSError as error:
        raise WorkbenchError(f"{target}: cannot be written ({error.strerror}).") from None
    return target, [number for number, line in enumerate(text.splitlines(), 1) if _is_open(line)]


def _is_open(line: str) -> bool:
    return '= "?"' in line.partition("#")[0] or 'unit = "?"' in line.partition(" # ")[0]


def _sheets(paths: Sequence[Path], decimal: str | None, tables: Sequence[TableEntry]) -> list[_Sheet]:
    """The files; one that does not show its decimal sign has a comma where another one has, or had before."""
    read = {path: _shown(path, decimal) for path in paths}
    commas = {table.decimal for table in tables} | {sheet.raw.decimal for sheet in read.values() if sheet is not None}
    sign = "," if "," in commas else None
    return [sheet or _sheet(path, sign) for path, sheet in read.items()]


def _shown(path: Path, decimal: str | None) -> _Sheet | None:
    """None where a file does not show its decimal sign."""
    try:
        return _sheet(path, decimal)
    except UntoldSign:
        return None


def _sheet(path: Path, decimal: str | None) -> _Sheet:
    if path.is_dir():
        raise WorkbenchError(f"{path}: is a folder; name the files in it, {path}/*.csv.")
    if not path.is_file():
        raise WorkbenchError(f"{path}: cannot be read as CSV: there is no such file.")
    raw = read_raw(path, Layout(decimal=decimal))
    for heading, count in Counter(heading.written for heading in raw.headings if heading.written).items():
        if count > 1:
            raise used_twice(path.name, count, heading)
    columns = tuple(guesses(raw))
    kind = likely_kind([guess.quantity for guess in columns], path.stem)
    return _Sheet((path.name,), raw, columns, kind, side_by_side(columns, KINDS[kind]), decimal=decimal)


def _repeated(sheets: Sequence[_Sheet]) -> list[list[_Sheet]]:
    """Files with those that repeat them: the same columns and places under names that differ by a number."""
    groups: list[list[_Sheet]] = []
    for sheet in sheets:
        group = next((group for group in groups if _repeats_it(group[0], sheet)), None)
        if group is None:
            groups.append([sheet])
        else:
            group.append(sheet)
    return groups


def _repeats_it(first: _Sheet, sheet: _Sheet) -> bool:
    names = {numbered(Path(one.files[0]).stem) for one in (first, sheet)}
    same_name = len(names) == 2 and len({stem for stem, _ in names}) == 1
    layouts = {(one.raw.headings, one.raw.rows, one.raw.decimal) for one in (first, sheet)}
    if not same_name or len(layouts) > 1 or any(guess.quantity == "repeat" for guess in sheet.columns):
        return False
    answers = [guess for guess in sheet.columns if _is_answer(guess.quantity, sheet)]
    within = [(guess, _SAME_PLACE) for guess in _settings(sheet)] + [(guess, _SAME_ANSWER) for guess in answers]
    return all(_is_alike(first.raw.values(g.place), sheet.raw.values(g.place), share) for g, share in within)


def _is_alike(one: np.ndarray, other: np.ndarray, share: float) -> bool:
    """Whether values differ by less than a share of the largest."""
    known = np.isfinite(one) & np.isfinite(other)
    apart, reach = np.linalg.norm(one[known] - other[known]), np.abs(one[known]).max(initial=0.0)
    return bool(apart <= np.sqrt(known.sum()) * share * reach)


def _below(sheets: Sequence[_Sheet]) -> _Sheet:
    """The repeats of a sheet as one, in files and beside one another; the number that counts them is a guess, too."""
    files = tuple(file for sheet in sheets for file in sheet.files)
    whole = replace(sheets[0], files=files)
    if len(files) == 1 and not whole.beside:
        return whole
    raw, _ = stacked([sheet.raw for sheet in sheets], whole.entry)
    number = Guess(len(raw.headings) - 1, raw.headings[-1], "repeat", "")
    return replace(whole, raw=raw, columns=(*whole.columns, number))


def _as_before(sheet: _Sheet, tables: Sequence[TableEntry]) -> _Sheet:
    """Read as the table of another campaign that is most like it by its headings; its kind, where the file has most of
    these headings, and two or more."""
    headings = {guess.heading.written for guess in sheet.columns}
    known = [table.columns or {} for table in tables]
    likeness = [len(headings & columns.keys()) / max(len(headings | columns.keys()), 1) for columns in known]
    if not any(likeness):
        return sheet
    nearest = int(np.argmax(likeness))
    shared = {heading: entry for heading, entry in known[nearest].items() if heading in headings}
    is_same = len(shared) > max(1, len(known[nearest]) / 2)
    columns = tuple(replace(guess, quantity=_known_as(guess, shared)) for guess in sheet.columns)
    sheet = replace(sheet, columns=columns, before=shared)
    if not is_same:
        return sheet
    return replace(sheet, kind=tables[nearest].kind, kind_is="as before", constants=tables[nearest].constants or {})


def _known_as(guess: Guess, before: Mapping[str, ColumnEntry]) -> str:
    entry = before.get(guess.heading.written)
    if entry is None:
        return guess.quantity
    return entry.role if entry.role in _BOOKKEEPING else entry.name or guess.heading.name


def _repeats(sheet: _Sheet) -> int:
    """As many as have half the rows of the longest, at least: a broken row is none."""
    place = next((guess.place for guess in sheet.columns if guess.quantity == "repeat"), None)
    rows = Counter([] if place is None else map(str, sheet.raw.columns[place]))
    return max(sum(2 * count >= max(rows.values()) > 1 for count in rows.values()), 1)


# ---- the device ----------------------------------------------------------------------------------------------------


_OTHER_MACHINES = {
    "machine": (
        "# Below is an inner rotor with magnets on its surface. Any other machine (outer rotor, buried magnets,",
        '# reluctance, one of your own): model = "drawn", machine_file = "the path of its file", slots and poles',
        "# alone; machines/ has such files to copy.",
    )
}


def _device(model: str, quantities: Sequence[str], zeros: Sequence[Spread]) -> str:
    """Keys to fill in, and how well such devices and the instruments of these quantities are usually known.

    zeros: of the instruments of these files
    """
    if model in DEVICE_KEYS:
        keys = [f'{key.key} = "?"  # {key.meaning}' for key in DEVICE_KEYS[model] if key.needed]
        keys += [_optional(key, quantities) for key in DEVICE_KEYS[model] if not key.needed]
        lines = ["[device]  # as drawn", *_OTHER_MACHINES.get(model, ()), f"model = {_text(model)}", *keys]
    else:
        lines = ["[device]", f'model = "?"  # {", ".join(DEVICE_KEYS)}, and the keys it needs']
    lines += ["", _TOLERANCE, *map(_spread, TOLERANCES.get(model, ()))]
    gains = [spread for read, spread in CALIBRATIONS.items() if _reads(read, quantities)]
    lines += ["", _SYSTEMATIC, *map(_spread, [*gains, *zeros])]
    return "\n" + "\n".join(lines) + "\n"


def _optional(key: DeviceKey, quantities: Sequence[str]) -> str:
    if key.usual is not None and key.usual[2] in quantities:
        return f"{key.key} = {key.usual[0]}  # {key.meaning}; that of {key.usual[1]}"
    return f"# {key.key} =   # {key.meaning}"


def _spread(spread: Spread) -> str:
    return f"{spread.key} = {{ {spread.size}, source = {_text(spread.source)} }}"


def _zeros(sheets: Sequence[_Sheet]) -> list[Spread]:
    """Errors of the zeros of load and torque cells, by the largest reading of all files."""
    largest: dict[str, tuple[float, float, str]] = {}
    for guess, values in ((g, sheet.raw.values(g.place)) for sheet in sheets for g in sheet.columns):
        readings = np.abs(values[np.isfinite(values)])
        if guess.quantity in ZEROS and guess.unit in FACTORS and readings.size:
            here = (readings.max() * FACTORS[guess.unit], ZERO_DRIFT * float(readings.max()), guess.unit)
            largest[guess.quantity] = max(here, largest.get(guess.quantity, here))
    return [
        Spread(ZEROS[name], f'sigma = {size:.2g}, kind = "offset", unit = "{unit}"', _OF_THE_LARGEST)
        for name, (_, size, unit) in largest.items()
    ]


def _reads(patterns: Sequence[str], quantities: Sequence[str]) -> bool:
    return any(fnmatch(quantity, pattern) for quantity in quantities for pattern in patterns)


def _taken_over(folder: Path) -> str:
    """Device, tolerances and instruments of another campaign."""
    content = campaign_file(folder)
    entries = {
        name: {key: entry.model_dump(exclude_none=True) for key, entry in getattr(content, name).items()}
        for name in ("tolerance", "systematic")
    }
    text = "\n[device]\n" + _lines(content.device)
    return text + "".join(f"\n[{name}]\n{_lines(section)}" for name, section in entries.items())


def _lines(section: Mapping[str, object]) -> str:
    return "".join(f"{_key(key)} = {_value(value)}\n" for key, value in section.items())


def _value(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {_value(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_value, value)) + "]"
    return _text(value) if isinstance(value, str) else str(value)


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _text(name)


def _text(value: str) -> str:
    """A text as TOML writes it."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


# ---- tables --------------------------------------------------------------------------------------------------------


def _table(sheet: _Sheet) -> str:
    kind = f"kind = {_text(sheet.kind)}  # what was measured, {sheet.kind_is}; the kinds stand in docs/campaign.md"
    sign = [f"decimal = {_text(sheet.decimal)}"] if sheet.decimal else []
    more = [f"repeats = {_value(sheet.files[1:])}  # the same measured again, a guess"] if sheet.files[1:] else []
    lines = ["", "[[table]]", f"file = {_text(sheet.files[0])}", *more, *sign, kind, *_constants(sheet)]
    columns = [_line(g, sheet) for g in sheet.columns if g.heading.written and g.heading != NUMBER]
    return "\n".join([*lines, "[table.columns]  # heading = what the column holds", *columns]) + "\n"


_OFTEN_CONSTANT = {"shunt": "shunt_ohm", "frequency": "frequency_Hz", "amplitude": "amplitude_mm"}


def _constants(sheet: _Sheet) -> list[str]:
    """Conditions of the kind that no column holds, as before or to be filled in."""
    there, kind = {guess.quantity for guess in sheet.columns}, KINDS[sheet.kind]
    if known := {key: value for key, value in sheet.constants.items() if split_unit(key)[0] not in there}:
        return [f"constants = {_value(known)}  # as before"]
    missing = [k for axis, k in _OFTEN_CONSTANT.items() if axis in kind.axes + kind.besides and axis not in there]
    listed = ", ".join(f"{key} = ?" for key in missing)
    return [f"# constants = {{ {listed} }}  # what was the same in all rows and no column holds"] if missing else []


def _unknown(unit: str) -> str:
    known = not unit or known_unit(unit) is not None
    return "" if known else f": the unit {unit} is not known; those that are stand in docs/campaign.md"


def _as_parts(guess: Guess, sheet: _Sheet) -> str:
    sine = guess.heading.unit == "Ns_per_m" and any(other.quantity == "frequency" for other in sheet.columns)
    return ": an impedance is read as re and im, |Z| cos(phi) and |Z| sin(phi)" if sine else ""


def _line(guess: Guess, sheet: _Sheet) -> str:
    heading, quantity = _text(guess.heading.written), guess.quantity
    named, asked = _name(guess)
    if guess.heading.written in sheet.before:
        entry = sheet.before[guess.heading.written].model_dump(exclude_defaults=True, by_alias=True)
        return f"{heading} = {_value(entry)}"
    if any(guess.heading.written in again for again in sheet.beside.values()):
        return f"# {heading} is a repeat, a guess"
    if not quantity or quantity == "time":
        return f"# {heading} = {{ ... }}  # not read{_unknown(guess.heading.unit) or _as_parts(guess, sheet)}"
    if quantity == "direction" and not sheet.raw.holds_numbers(guess.place):
        return f"# {heading} = {{ ... }}  # not read: a direction is +1 or -1, counter-clockwise +1"
    if quantity not in _BOOKKEEPING and not sheet.raw.holds_numbers(guess.place):
        return f"# {heading} = {{ ... }}  # not read: it holds no number"
    if quantity in _BOOKKEEPING:
        return f'{heading} = {{ role = "{quantity}" }}'
    if quantity == "direction":
        return f'{heading} = {{ {named}role = "group" }}'
    unit = _text(guess.unit or "?")
    if not _is_answer(quantity, sheet):
        return f'{heading} = {{ {named}unit = {unit}, role = "condition" }}{asked}'
    size, note = _noise(guess, sheet)
    again = f", repeats = {_value(beside)}" if (beside := sheet.beside.get(guess.heading.written)) else ""
    return f'{heading} = {{ {named}unit = {unit}, role = "response", u_random = {size}{again} }}{note}{asked}'


def _is_answer(quantity: str, sheet: _Sheet) -> bool:
    """Whether a column is a response; where a drive turns the open machine, its voltage is one, too."""
    opened = sheet.kind == "no_load" and is_driven(sheet.columns)
    return KINDS[sheet.kind].is_response(quantity) or (opened and quantity == "v_ll")


def _name(guess: Guess) -> tuple[str, str]:
    """The key that names a quantity, where its heading does not, and a comment on what is to be filled in."""
    if guess.quantity == UNTOLD_INDUCTANCE:
        return 'name = "?", ', f"  # {_WHICH_INDUCTANCE}"
    peak = is_rms(guess.heading) and guess.quantity in _OF_AXES
    note = "  # RMS: peak is meant, `airgap diagnose` says the text for [conventions]" if peak else ""
    return ("" if guess.quantity == guess.heading.name else f"name = {_text(guess.quantity)}, "), note


def _noise(guess: Guess, sheet: _Sheet) -> tuple[str, str]:
    """Uncertainty of a reading as the file is to say it, and a comment on where it comes from."""
    books = [sheet.raw.values(g.place) for g in sheet.columns if g.quantity in _BOOKKEEPING]
    conditions = {g.quantity: sheet.raw.values(g.place) for g in _settings(sheet)}
    found = noise_of(sheet.raw.values(guess.place), conditions, books)
    if found is None:
        return _text("?"), ""
    return found[0], f"  # u_random: scatter of {found[1]}; better the data sheet's"


def _settings(sheet: _Sheet) -> list[Guess]:
    """What was set in a table; rows are sorted by the first of these within all others. Temperatures are only logged
    where the kind does not ask for them."""
    kind = KINDS[sheet.kind]
    axes = [g for axis in kind.axes for g in sheet.columns if fnmatch(g.quantity, axis)]
    others = [g for g in sheet.columns if g not in axes and g.quantity not in ("", "time", *_BOOKKEEPING)]
    return axes + [g for g in others if not kind.is_response(g.quantity) and not g.quantity.endswith("_T")]
