"""What ``campaign.toml`` holds: every section and key with its meaning. Unknown keys are refused with the nearest known
one; a wrong value is one sentence that says where it stands and what belongs there."""

from __future__ import annotations

import re
import tomllib
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated, Any, Final, Literal, get_args

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator
from pydantic_core import ErrorDetails

from workbench.errors import WorkbenchError

FILE: Final = "campaign.toml"
LARGEST_FILE: Final = 10_000_000  # bytes; two hundred columns take fifty thousand
LAST_REPEAT: Final = "last repeat of every table"
BY_REGION: Final = "by region"
NO_HOLDOUT: Final = "none"
OF_A_COLUMN: Final = "column:"
Role = Literal["condition", "response", "scan", "repeat", "group", "holdout"]
ROLES: Final[tuple[str, ...]] = get_args(Role)
SMALLEST, LARGEST = 1e-30, 1e30  # of an uncertainty, in any unit; beyond, it is a slip of the pen
_ID = re.compile(r"\w[\w.-]{0,99}")


def folder_name(text: str) -> str:
    """The text, where it can name a folder; ValueError otherwise."""
    if not _ID.fullmatch(text):
        raise ValueError('names the folder of the results; write letters, digits, "-", "_" and ".", a letter first')
    return text


def _holdout(entry: object) -> str:
    return holdout_rule(entry)


def _formula(value: object) -> object:
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise ValueError('must be a number or a formula in quotes, such as "0.3 + 0.01*abs(y)"')
    return value


def _size(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not SMALLEST <= value <= LARGEST:
        raise ValueError(f"must be a positive number from {SMALLEST:g} to {LARGEST:g}")
    return float(value)


def _names(value: object) -> tuple[str, ...]:
    found = [value] if isinstance(value, str) else value
    if not isinstance(found, list) or not all(isinstance(name, str) for name in found):
        raise ValueError("must be a name or a list of names")
    return tuple(found)


def _decimal(text: str) -> str:
    if text not in (",", "."):
        raise ValueError('must be "," or "."')
    return text


def _delimiter(text: str) -> str:
    if len(text) != 1 or text in '"\n\r' or text.isalnum():
        raise ValueError('must be one sign, such as ";" or "\\t"')
    return text


def _constant(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value != value:
        raise ValueError("must be a number, the same for all rows; inf for an open circuit")
    return float(value)


Formula = Annotated[Any, BeforeValidator(_formula)]
Constant = Annotated[Any, BeforeValidator(_constant)]
Size = Annotated[Any, BeforeValidator(_size)]
Text = Annotated[str, Field(strict=True)]
Note = Annotated[Any, Field(description="for people, not looked at")]


class Section(BaseModel):
    """A section of the file; no unknown keys, no conversions of type."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class CampaignSection(Section):
    """What the campaign is."""

    id: Annotated[str | None, AfterValidator(lambda text: text if text is None else folder_name(text))] = Field(
        None, description="name of the folder of the results: letters, digits, - _ and .; default: the folder's name"
    )
    repeats: Annotated[int | None, Field(ge=1, le=10**6)] = Field(
        None, description="how often every table was measured, for the check that all are there"
    )
    holdout: Annotated[str, BeforeValidator(_holdout)] = Field(
        BY_REGION, description="which rows no fit may see, see below"
    )
    predictions: Text | None = Field(
        None, description="CSV file of what is predicted for a device that is not measured yet, shown by compare"
    )
    title: Note = None
    date: Note = None
    operator: Note = None
    device: Note = None
    comment: Note = None


class ColumnEntry(Section):
    """How one column of a file is to be understood."""

    role: Role = Field(description="condition, response, scan, repeat, group or holdout, see below")
    unit: Text | None = Field(None, description="unit of the numbers; default: the end of the heading")
    name: Text | None = Field(None, description="quantity that the column holds, where its heading is another word")
    from_: Text | None = Field(None, alias="from", description="heading in the file, where the key is the quantity")
    u_random: Formula | None = Field(
        None, description="standard uncertainty of one reading, number or formula, in the unit of the column"
    )
    u: Formula | None = Field(None, description="the same in short")
    u_sys: Annotated[tuple[str, ...], BeforeValidator(_names)] = Field(
        (), description="entries of [systematic] that act on the column, a name or a list"
    )
    repeats: Annotated[tuple[str, ...], BeforeValidator(_names)] = Field(
        (), description="of a response: headings of further columns that hold it again, a repeat each"
    )
    bandwidth: Size | None = Field(None, description="frequency above which the recorder lets nothing pass [Hz]")
    optional: bool = Field(False, description="true: the column may be missing")
    instrument: Note = None
    source: Note = None
    comment: Note = None

    @model_validator(mode="after")
    def _said_once(self) -> ColumnEntry:
        for a, b, words in (("u", "u_random", "u and u_random are the same"), ("name", "from_", "name and from")):
            if getattr(self, a) is not None and getattr(self, b) is not None:
                raise ValueError(f"{words}; keep one")
        if self.repeats and self.role != "response":
            raise ValueError(f"repeats are of a response, and the role is {self.role}")
        return self


class TableEntry(Section):
    """One file of measurements."""

    file: Text = Field(description="CSV, text or Parquet file in the folder of the campaign")
    kind: Text = Field(description="what was measured, see below")
    repeats: Annotated[tuple[str, ...], BeforeValidator(_names)] = Field(
        (), description="further files with the same columns, in which all was measured again, a repeat each"
    )
    columns: dict[str, ColumnEntry] | None = Field(
        None, description="what the columns are, by their headings; columns that are not named are not read"
    )
    u_random: dict[str, Formula] | None = Field(
        None, description="instead of columns: uncertainty by column, where headings say quantity and unit"
    )
    alias: dict[str, Text] = Field({}, description='heading = "quantity_unit", so that no file is ever rewritten')
    constants: dict[str, Constant] = Field(
        {}, description="conditions that no column holds as they were the same in all rows, such as { shunt_ohm = 1.5 }"
    )
    bandwidth_Hz: Size | None = Field(None, description="frequency above which the recorder lets nothing pass")
    decimal: Annotated[str | None, AfterValidator(lambda t: t if t is None else _decimal(t))] = Field(
        None, description='"," or "."; default: found out'
    )
    delimiter: Annotated[str | None, AfterValidator(lambda t: t if t is None else _delimiter(t))] = Field(
        None, description="sign between cells; default: found out"
    )
    encoding: Text | None = Field(None, description="of the text; default: found out")
    order: Literal["row"] = Field("row", description='"row", the only one: rows stand as they were acquired')
    instrument: Note = None
    source: Note = None
    comment: Note = None

    @model_validator(mode="after")
    def _one_spelling(self) -> TableEntry:
        if self.columns is not None and self.u_random is not None:
            raise ValueError("give columns or u_random, not both: with columns the uncertainty stands in each of them")
        if len({self.file, *self.repeats}) <= len(self.repeats):
            raise ValueError("file and repeats name a file twice; name every file once")
        return self


class ToleranceEntry(Section):
    """An input of the model that is known to within sigma."""

    sigma: Size | None = Field(None, description="standard uncertainty, in the unit of the name or of unit")
    sigma_rel: Size | None = Field(None, description="the same, relative to the nominal value")
    unit: Text | None = Field(None, description="unit of sigma; default: the end of the name")
    source: Note = None
    instrument: Note = None
    comment: Note = None

    @model_validator(mode="after")
    def _one_size(self) -> ToleranceEntry:
        if (self.sigma is None) == (self.sigma_rel is None):
            raise ValueError("give either sigma (in the unit of the name) or sigma_rel")
        return self


class SystematicEntry(Section):
    """An error shared by all rows of an instrument."""

    sigma: Size = Field(description="standard uncertainty; of an offset in the unit of the name or of unit")
    kind: Literal["gain", "offset"] = Field(description='"gain" (relative) or "offset"')
    unit: Text | None = Field(None, description="unit of the sigma of an offset; default: the end of the name")
    source: Note = None
    instrument: Note = None
    comment: Note = None


class CampaignFile(Section):
    """The whole file."""

    campaign: CampaignSection = Field(description="what the campaign is")
    table: Annotated[list[TableEntry], Field(min_length=1)] = Field(description="files of measurements, [[table]] each")
    device: dict[str, Any] = Field({}, description="the device as drawn: keys of the model that answers for it")
    tolerance: dict[str, ToleranceEntry] = Field({}, description="inputs of the model that are uncertain")
    systematic: dict[str, SystematicEntry] = Field({}, description="errors shared by all rows of an instrument")
    conventions: dict[str, Any] = Field({}, description="signs, phase order, zeros and units of the bench")


def holdout_rule(entry: object) -> str:
    """The rule as one text: "by region", "last repeat of every table", "column:NAME" or "none".

    Raises:
        WorkbenchError: the rule is another one.
    """
    rule = entry
    if isinstance(entry, dict) and len(entry) == 1:
        rule = entry.get("rule", f"{OF_A_COLUMN}{entry['column']}" if isinstance(entry.get("column"), str) else entry)
    known = (BY_REGION, LAST_REPEAT, NO_HOLDOUT)
    if isinstance(rule, str) and (rule in known or (rule.startswith(OF_A_COLUMN) and rule != OF_A_COLUMN)):
        return rule
    raise WorkbenchError(
        f'is not understood; write {{ rule = "{BY_REGION}" }}, {{ rule = "{LAST_REPEAT}" }}, "column:NAME" or "none"'
    )


# ---- the file ------------------------------------------------------------------------------------------------------


def campaign_file(folder: Path) -> CampaignFile:
    """The content of ``campaign.toml``, checked.

    Raises:
        WorkbenchError: one sentence, the first thing that is wrong and how many more are.
    """
    content = _toml(folder / FILE)
    try:
        return CampaignFile.model_validate(content)
    except ValidationError as error:
        raise WorkbenchError(_sentence(error.errors())) from None


def _toml(path: Path) -> dict[str, Any]:
    if not path.is_file():
        raise WorkbenchError(
            f"{path.parent}: there is no {FILE}; a campaign is a folder with that file and its CSV tables."
        )
    if path.stat().st_size > LARGEST_FILE:
        raise WorkbenchError(f"{path}: is larger than any campaign file ({LARGEST_FILE} bytes).")
    try:
        return tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise WorkbenchError(f"{path}: is no text in UTF-8 (byte {error.start}); save it as UTF-8.") from None
    except RecursionError:
        raise WorkbenchError(f"{path}: is nested too deeply to be read.") from None
    except ValueError as error:  # also an integer of more digits than Python reads
        said = " ".join(str(error).partition(";")[0].split())
        raise WorkbenchError(f"{path}: is not valid TOML: {said}.") from None
    except OSError as error:
        raise WorkbenchError(f"{path}: cannot be read ({error.strerror}).") from None


# ---- sentences -----------------------------------------------------------------------------------------------------

Location = tuple[str | int, ...]
MOST_SAID: Final = 3  # things that are wrong at once: more are no sentence
_OF_NAMED: Final[dict[str, type[Section]]] = {"tolerance": ToleranceEntry, "systematic": SystematicEntry}


def _sentence(errors: list[ErrorDetails]) -> str:
    """The first things that are wrong; unknown keys before the missing ones that they probably were."""
    ordered = sorted(errors, key=lambda error: error["type"] != "extra_forbidden")
    first, *others = dict.fromkeys(f"{_place(error['loc'])}{_said(error)}" for error in ordered)
    said = "".join(f" Also, {words}." for words in others[: MOST_SAID - 1])
    more = len(others) + 1 - MOST_SAID
    end = f" (And {more} more {'thing is' if more == 1 else 'things are'} wrong.)" if more > 0 else ""
    return f"{first}.{said}{end}"


def _place(loc: Location) -> str:
    words = [FILE]
    if loc[0] == "table" and len(loc) > 1:
        words.append(f"table {int(loc[1]) + 1}")
        words += [f"{'column' if loc[2] == 'columns' else loc[2]} {loc[3]!r}"] if len(loc) > 3 else []
    elif len(loc) > 1:
        words.append(f"[{loc[0]}]" + (f" {loc[1]}" if loc[0] in _OF_NAMED else ""))
    return ", ".join(words) + ": "


def _said(error: ErrorDetails) -> str:
    loc, kind = error["loc"], error["type"]
    key = _key(loc)
    if kind == "missing":
        return _missing(loc)
    if kind == "extra_forbidden":
        return _unknown(loc)
    if key is None:
        words = str(error["ctx"]["error"]) if kind == "value_error" else "must be a section with keys"
        return words if kind == "value_error" else f"{'.'.join(map(str, loc))} = {shown(error['input'])} {words}"
    if kind == "value_error":
        return f"{key} = {shown(error['input'])} {error['ctx']['error']}"
    return f"{key} = {shown(error['input'])} is not accepted; {_expected(loc, key)}"


def _key(loc: Location) -> str | None:
    """The key that an error is about; None where it is about a whole section."""
    keys = _keys_at(loc[:-1])
    name = str(loc[-1])
    if keys is not None and name in keys:
        return name
    within = _keys_at(loc[:-2]) if len(loc) > 1 else None  # an entry of u_random or alias
    return f"{loc[-2]}.{name}" if within is not None and str(loc[-2]) in ("u_random", "alias") else None


def _section_at(loc: Location) -> type[Section] | None:
    if not loc:
        return CampaignFile
    if loc == ("campaign",):
        return CampaignSection
    if loc[0] in _OF_NAMED and len(loc) == 2:
        return _OF_NAMED[str(loc[0])]
    if loc[0] == "table":
        return {2: TableEntry, 4: ColumnEntry}.get(len(loc))
    return None


def _keys_at(loc: Location) -> dict[str, str] | None:
    """Keys of the section at a place and what they mean."""
    section = _section_at(loc)
    return keys_of(section) if section is not None else None


def keys_of(section: type[Section]) -> dict[str, str]:
    """Keys of a section as a file spells them, with their meaning."""
    return {field.alias or name: field.description or "" for name, field in section.model_fields.items()}


def _missing(loc: Location) -> str:
    if loc == ("table",):
        return "no [[table]] is given; name at least one CSV file and its kind"
    if len(loc) == 1:
        return f"the section [{loc[0]}] is missing"
    return f"the key {loc[-1]!r} is missing; give {_meaning(loc)}"


def _meaning(loc: Location) -> str:
    """For a sentence, not for a manual that goes on below."""
    return (_keys_at(loc[:-1]) or {}).get(str(loc[-1]), "it").removesuffix(", see below")


def _unknown(loc: Location) -> str:
    name, known = str(loc[-1]), _keys_at(loc[:-1]) or {}
    close = get_close_matches(name, known, n=1, cutoff=0.5)
    if len(loc) == 1:
        ending = f"the nearest known one is [{close[0]}]" if close else f"the sections are {', '.join(known)}"
        return f"the section [{_short(name)}] is unknown; {ending}"
    ending = f"the nearest known one is {close[0]!r}" if close else f"known are {', '.join(known)}"
    return f"the key {_short(name)!r} is unknown; {ending}"


def _expected(loc: Location, key: str) -> str:
    if key == "role":
        return f"use {', '.join(ROLES[:-1])} or {ROLES[-1]}"
    if loc[0] == "systematic" and key == "kind":
        return 'give kind = "gain" or "offset"'
    return f"give {_meaning(loc)}" if _meaning(loc) != "it" else "give text in quotes"


def shown(value: object) -> str:
    """A value, shortened, in one line."""
    try:
        return _short(repr(value))
    except ValueError:  # an integer of more digits than Python writes
        return "a number of thousands of digits"


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= 60 else text[:57] + "..."
