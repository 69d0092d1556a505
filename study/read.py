"""From a study file to a ``Study``, or to the sentences that say what is wrong with it."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from geometry.checks import check_machine
from geometry.errors import GeometryError
from geometry.family import Combination
from geometry.winding import star_of_slots
from study.chain import check_chain
from study.errors import StudyError
from study.inputs_machine import MESH_NAMES, machine_family
from study.schema import MachineSection, Study
from study.sentences import Location, sections_with, sentences
from study.toml_file import parsed, read_table
from units import split_unit

STUDIES = Path(__file__).resolve().parent.parent / "studies"
_LONGEST_SHOWN = 200
_BARE_WORD = re.compile(r"[\w./-]+")


def read_study(path_or_name: str | Path, overrides: Sequence[str] = ()) -> Study:
    """Read a study and check every number, the winding and the machine's geometry; the steel's curve is not opened.

    path_or_name: path of a TOML file, or the name of a file in ``studies/`` without its ending
    overrides: texts ``section.key=value`` with the value as TOML writes it (a bare word counts as text)
    Raises StudyError with one sentence for each problem. ``study.usable.check_study`` finds what takes a second.
    """
    path = study_path(path_or_name)
    data, changes = read_table(path), [_override(text) for text in overrides]
    for section, key, value, _ in changes:
        _put(data, section, key, value)
    if not data:
        raise StudyError(f"{path} is empty; copy studies/template.toml there and fill it in.")
    study = _validated(data, path, {(section, key): text for section, key, _, text in changes})
    study._path = path
    origin = _origin(path, overrides)
    check_winding(study, machine_family(study.machine).combination, ("machine.slots", "machine.poles"), origin)
    _check_geometry(study, origin)
    _check_sleeve(study, origin)
    check_chain(study, origin)
    return study


def study_path(path_or_name: str | Path) -> Path:
    """The file that a path or a name means; StudyError when there is none."""
    text = str(path_or_name)
    is_name = re.fullmatch(r"[\w-]+", text) is not None
    path = STUDIES / f"{text}.toml" if is_name else Path(text)
    if os.path.islink(path) and not os.path.exists(path):
        raise StudyError(f"{path} is a symbolic link that leads to no file; give the path of the study file itself.")
    if not _may_be_there(path):
        known = ", ".join(sorted(file.stem for file in STUDIES.glob("*.toml")))
        raise StudyError(f"{_short(path)} does not exist; give the path of a study file or one of the names {known}.")
    return _short(path)


def _may_be_there(path: Path) -> bool:
    """Whether to go on to open the file; a folder that may not be looked into is reported there."""
    try:
        return path.exists()
    except OSError:
        return True


def _origin(path: Path, overrides: Sequence[str]) -> str:
    """Where a combination of values comes from."""
    return " ".join((str(path), *(f"--set {text[:_LONGEST_SHOWN]}" for text in overrides)))


def _short(path: Path) -> Path:
    """The path as seen from the current folder where it lies below it."""
    try:
        return path.resolve().relative_to(Path.cwd())
    except (ValueError, OSError):
        return path


def _override(text: str) -> tuple[str, str, object, str]:
    """Section, key, value and the text itself of one ``section.key=value``."""
    name, equals, value = text.partition("=")
    section, dot, key = name.strip().partition(".")
    if not equals or not dot or not key or "." in key:
        raise StudyError(f"--set {text}: {_how_to_override(section, equals)}.")
    return section, key, _value(text, value.strip()), text


def _how_to_override(key: str, equals: str) -> str:
    homes = sections_with(key)
    if equals and homes:
        return f"{key} needs its section; write {homes[0]}.{key}=value"
    return "this is not of the form section.key=value, such as machine.airgap_mm=0.6"


def _value(text: str, value: str) -> object:
    subject = f"--set {text[:_LONGEST_SHOWN]}: {value[:_LONGEST_SHOWN] or 'nothing'} is not a TOML value, "
    try:
        return parsed(f"value = {value}", subject, "give a number, a list in brackets or a text in quotes")["value"]
    except StudyError:
        if _BARE_WORD.fullmatch(value):
            return value
        raise


def _put(data: dict[str, Any], section: str, key: str, value: object) -> None:
    table = data.setdefault(section, {})
    if isinstance(table, dict):  # anything else is reported by the validation
        table[key] = value


def _validated(data: dict[str, Any], path: Path, overridden: dict[Location, str]) -> Study:
    def place(loc: Location) -> str:
        return f"--set {overridden[loc[:2]][:_LONGEST_SHOWN]}" if loc[:2] in overridden else str(path)

    try:
        return Study.model_validate(data)
    except ValidationError as error:
        raise StudyError(*sentences(error, place)) from None


# ------------------------------------------------------------------------- checks by the packages that know


def check_winding(study: Study, combination: Combination, keys: tuple[str, str], origin: str) -> None:
    """StudyError unless slots and poles, which stand under two keys, carry a balanced winding."""
    winding = study.winding
    try:
        star_of_slots(combination.slots, combination.pole_pairs, winding.layers, winding.coil_pitch)
    except GeometryError as error:
        pitch = "" if winding.coil_pitch is None else f", winding.coil_pitch = {winding.coil_pitch}"
        stated = f"{keys[0]} = {combination.slots}, {keys[1]} = {combination.poles}{pitch}"
        raise StudyError(f"{origin}: {stated}: {sentence_part(error)}.") from error


def _check_sleeve(study: Study, origin: str) -> None:
    """A sleeve over the magnets turns inside the air gap."""
    thickness, airgap = study.mechanics.sleeve_thickness_mm, study.machine.airgap_mm
    if thickness is not None and thickness >= airgap:
        raise StudyError(
            f"{origin}: mechanics.sleeve_thickness_mm = {thickness:g} fills machine.airgap_mm = {airgap:g}, in which "
            "the sleeve turns; take a thinner sleeve or a larger air gap."
        )


def _check_geometry(study: Study, origin: str) -> None:
    try:
        check_machine(machine_family(study.machine).reference)
    except GeometryError as error:
        raise StudyError(f"{origin}: [machine] cannot be built, {with_keys(study, error)}.") from error


def with_keys(study: Study, error: GeometryError) -> str:
    """What the geometry says, with the keys of the file and the values that it states for them."""
    said = _with_key_names(sentence_part(error))
    return said + _present_values(study, said)


def sentence_part(error: Exception) -> str:
    """The words of an error, to be gone on with."""
    return str(error).rstrip(".")


def _with_key_names(message: str) -> str:
    """The message with the file's key names, ``airgap_mm`` where the geometry says ``airgap``."""
    for key in MachineSection.model_fields:
        stem = split_unit(key)[0]
        message = re.sub(rf"\b{stem}\b(?!_)", key, message) if stem != key else message
    for name, key in MESH_NAMES.items():
        message = re.sub(rf"\b{name}\b(?!_)", f"mesh.{key}", message)
    return message


def _present_values(study: Study, message: str) -> str:
    """What the file states for the keys that a message names."""
    stated = {**study.machine.model_dump(exclude_none=True), **study.mesh.model_dump(exclude_none=True)}
    named = [f"{key} = {value}" for key, value in stated.items() if re.search(rf"\b{key}\b", message)]
    return f" (now {', '.join(named)})" if named else ""
