"""One sentence for each thing that pydantic found wrong with a study."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from difflib import get_close_matches
from math import isfinite
from typing import Literal, get_args, get_origin

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from study.schema import Section, Study
from units import converted, same_quantity, split_unit

_TEMPLATE = "studies/template.toml"
_LONGEST_SHOWN = 60

Location = tuple[str | int, ...]  # section, key, and the position in a list


def sentences(error: ValidationError, place: Callable[[Location], str]) -> list[str]:
    """The problems as sentences, file order lost, each once.

    place: function that names where a key comes from, given its location: the file, or the override that set it
    """
    problems = error.errors()
    meant = {_meant(problem["loc"]) for problem in problems if problem["type"] == "extra_forbidden"}
    told = [problem for problem in problems if problem["type"] != "missing" or problem["loc"] not in meant]
    return [f"{place(problem['loc'])}: {_sentence(problem)}." for problem in told]


def shown(value: object) -> str:
    """A value as a study file would state it, shortened."""
    if isinstance(value, float) and not isfinite(value):
        return str(value)
    text = json.dumps(value, default=str, ensure_ascii=False)
    return text if len(text) <= _LONGEST_SHOWN else text[:_LONGEST_SHOWN] + " ..."


def sections_with(key: str) -> list[str]:
    """Names of the sections that have this key."""
    return [name for name in Study.model_fields if key in section_class(name).model_fields]


def section_class(name: str) -> type[Section]:
    """The class of a section, also of one that may be left out."""
    annotation = Study.model_fields[name].annotation
    return annotation if isinstance(annotation, type) else get_args(annotation)[0]


def _sentence(problem: ErrorDetails) -> str:
    if problem["type"] == "missing":
        return _missing(problem["loc"])
    if problem["type"] == "extra_forbidden":
        return _unknown(problem["loc"], problem["input"])
    if problem["type"] == "value_error":
        return _own(problem["loc"], problem["input"], str(problem["ctx"]["error"]))
    return _wrong_kind(problem["loc"], problem["input"])


def _missing(loc: Location) -> str:
    if len(loc) == 1:
        return f"section [{loc[0]}] is missing; take it over from {_TEMPLATE}"
    section, key = _names(loc)
    return f"{section}.{key} is missing; add it under [{section}]: {expected(section_class(section), key)}"


def _own(loc: Location, found: object, said: str) -> str:
    """A problem found by a rule of the schema: the rule says it, the key and the value are put in front."""
    if len(loc) == 1:
        return f"[{loc[0]}] {said}"
    return f"{_dotted(loc)} = {shown(found)} {said}"


def _wrong_kind(loc: Location, found: object) -> str:
    if len(loc) == 1:
        return f"{loc[0]} = {shown(found)} stands where the section [{loc[0]}] is expected; make it a table"
    section, key = _names(loc)
    hint = ", without quotes and without a unit" if isinstance(found, str) and re.match(r"\s*[-+.\d]", found) else ""
    return f"{_dotted(loc)} = {shown(found)} is not accepted; give {expected(section_class(section), key)}{hint}"


def _names(loc: Location) -> tuple[str, str]:
    """Section and key."""
    return str(loc[0]), str(loc[1])


def _dotted(loc: Location) -> str:
    section, key = _names(loc)
    position = "".join(f"[{index}]" for index in loc[2:] if isinstance(index, int))
    return f"{section}.{key}{position}"


def expected(cls: type[Section], key: str) -> str:
    """What a key of a section takes, in words."""
    field, quantity = cls.model_fields[key], cls.quantity(key)
    if quantity is not None:
        return f"{_kind(field.annotation)} ({quantity.meaning}, {quantity.allowed(key)})"
    if choices := _choices(field.annotation):
        return " or ".join(map(shown, choices))
    if field.annotation is bool:
        return "true or false"
    return "a text in quotes" + (" of a-z, 0-9, - and _" if key == "id" else "")


def _choices(annotation: object) -> tuple[object, ...]:
    """The values of a literal, also of one that may be left out; none for other kinds."""
    if get_origin(annotation) is Literal:
        return get_args(annotation)
    return tuple(choice for one in get_args(annotation) for choice in _choices(one))


def _kind(annotation: object) -> str:
    number = "an integer" if "int" in str(annotation) else "a number"
    return f"a list, each entry {number}" if "uple" in str(annotation) else number


# ------------------------------------------------------------------------------------- unknown keys


def _unknown(loc: Location, found: object) -> str:
    if len(loc) == 1:
        return _unknown_section(str(loc[0]))
    section, key = _names(loc)
    meant = _meant(loc)
    if meant and split_unit(meant[1])[0] == split_unit(key)[0]:
        return _wrong_unit(section, key, meant[1], found)
    if meant:
        return f"{section}.{key} = {shown(found)} is an unknown key; the nearest known one is {meant[0]}.{meant[1]}"
    if homes := sections_with(key):
        return f"{section}.{key} = {shown(found)} is in the wrong section; it belongs under [{homes[0]}]"
    known = ", ".join(section_class(section).model_fields)
    return f"{section}.{key} = {shown(found)} is an unknown key; [{section}] has {known}"


def _unknown_section(name: str) -> str:
    if homes := sections_with(name):
        return f"{name} stands outside every section; it belongs under [{homes[0]}]"
    if meant := _meant((name,)):
        return f"section [{name}] is unknown; rename it to [{meant[0]}]"
    return f"section [{name}] is unknown; the sections are {', '.join(Study.model_fields)}"


def _wrong_unit(section: str, key: str, meant: str, found: object) -> str:
    unit, right = split_unit(key)[1], split_unit(meant)[1]
    if not unit:
        return f"{section}.{key} = {shown(found)} lacks its unit; write {meant}, the value in {right}"
    if not right:
        return f"{section}.{key} = {shown(found)} is a pure number, not one in {unit}; write {meant}"
    if not same_quantity(unit, right):
        return f"{section}.{key} = {shown(found)} cannot be in {unit}; write {meant}, the value in {right}"
    write = f"{meant} = {_in_unit(found, unit, right)}"
    return f"{section}.{key} = {shown(found)} is in {unit}, but this is read in {right}; write {write}"


def _in_unit(found: object, unit: str, right: str) -> str:
    number = isinstance(found, (int, float)) and not isinstance(found, bool) and converted(found, unit, right)
    return f"<value in {right}>" if number is False or number is None else f"{number:.6g}"


def _meant(loc: Location) -> tuple[str, ...] | None:
    """The location that an unknown key was probably meant to be, in the same section."""
    if len(loc) == 1:
        close = get_close_matches(str(loc[0]), list(Study.model_fields), n=1)
        return (close[0],) if close else None
    section, key = _names(loc)
    known = list(section_class(section).model_fields)
    same = [other for other in known if split_unit(other)[0] == split_unit(key)[0]]
    close = same or ([] if sections_with(key) else get_close_matches(key, known, n=1, cutoff=0.7))
    return (section, close[0]) if close else None
