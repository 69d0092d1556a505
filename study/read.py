"""From a study file to a ``Study``, or to the sentences that say what is wrong with it."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Sequence

from pydantic import ValidationError

from geometry.checks import check_machine
from geometry.machine import GeometryError
from geometry.winding import star_of_slots
from study.chain import check_chain, check_libraries
from study.convert import to_machine
from study.errors import StudyError
from units import split_unit
from study.schema import MachineSection, Study
from study.sentences import sections_with, sentences

STUDIES = Path(__file__).resolve().parent.parent / "studies"
_BARE_WORD = re.compile(r"[\w./-]+")


def read_study(path_or_name: str | Path, overrides: Sequence[str] = ()) -> Study:
    """Read a study and check every number, the winding and the machine's geometry; the steel's curve is not opened.

    path_or_name: path of a TOML file, or the name of a file in ``studies/`` without its ending
    overrides: texts ``section.key=value`` with the value as TOML writes it (a bare word counts as text)
    Raises StudyError with one sentence for each problem. ``check_study`` opens the steel's curve as well.
    """
    path = study_path(path_or_name)
    data, changes = _table(path), [_override(text) for text in overrides]
    for section, key, value, _ in changes:
        _put(data, section, key, value)
    if not data:
        raise StudyError(f"{path} is empty; copy studies/template.toml there and fill it in.")
    study = _validated(data, path, {(section, key): text for section, key, _, text in changes})
    study._path = path
    origin = _origin(path, overrides)
    _check_winding(study, "machine.slots", study.machine.slots, origin)
    _check_geometry(study, origin)
    check_chain(study, origin)
    return study


def check_study(study: Study) -> None:
    """What only the whole pipeline needs, and what takes a second: sweep, steel, vehicle, linkage and gears."""
    check_sweep(study)
    check_steel(study)
    check_libraries(study)


def check_sweep(study: Study) -> None:
    """Every slot count of the sweep must have a balanced winding; StudyError with a sentence otherwise."""
    for slots in study.sweep.slots:
        _check_winding(study, "sweep.slots", slots, str(study.path))


def check_steel(study: Study) -> None:
    """The steel must exist and its curve be usable; StudyError with a sentence otherwise."""
    from materials.errors import MaterialError  # imports scipy, which takes a second
    from materials.library import load_steel

    key = f'{study.path}: materials.steel = "{study.materials.steel}"'
    try:
        load_steel(study.materials.steel, study.path.parent)
    except MaterialError as error:
        raise StudyError(f"{key} cannot be used, {_sentence_part(error)}.") from error
    except (OSError, UnicodeDecodeError) as error:
        raise StudyError(f"{key} cannot be read ({error}); give a readable csv file or a known grade.") from error


def study_path(path_or_name: str | Path) -> Path:
    """The file that a path or a name means; StudyError when there is none."""
    text = str(path_or_name)
    is_name = re.fullmatch(r"[\w-]+", text) is not None
    path = STUDIES / f"{text}.toml" if is_name else Path(text)
    if not path.exists():
        known = ", ".join(sorted(file.stem for file in STUDIES.glob("*.toml")))
        raise StudyError(f"{_short(path)} does not exist; give the path of a study file or one of the names {known}.")
    return _short(path)


def study_files(study: Study) -> list[Path]:
    """Files of the user's own that the study refers to, for input hashes: the steel's csv where it is not a grade."""
    steel = study.materials.steel
    return [study.path.parent / steel] if steel.lower().endswith(".csv") else []


def _origin(path: Path, overrides: Sequence[str]) -> str:
    """Where a combination of values comes from."""
    return " ".join((str(path), *(f"--set {text}" for text in overrides)))


def _short(path: Path) -> Path:
    """The path as seen from the current folder where it lies below it."""
    try:
        return path.resolve().relative_to(Path.cwd())
    except ValueError:
        return path


def _table(path: Path) -> dict:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise StudyError(f"{path} cannot be read ({error.strerror}); give a readable TOML file.") from error
    except UnicodeDecodeError as error:
        raise StudyError(
            f"{path} is not a text file in UTF-8 (byte {error.start}); save it as UTF-8 text or give the right file."
        ) from error
    except tomllib.TOMLDecodeError as error:
        raise StudyError(f"{path} is not valid TOML: {error}; correct that place.") from error


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
    try:
        return tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError as error:
        if _BARE_WORD.fullmatch(value):
            return value
        raise StudyError(f"--set {text}: {value or 'nothing'} is not a TOML value; give a number, "
                         'a list in brackets or a text in quotes.') from error


def _put(data: dict, section: str, key: str, value: object) -> None:
    table = data.setdefault(section, {})
    if isinstance(table, dict):  # anything else is reported by the validation
        table[key] = value


def _validated(data: dict, path: Path, overridden: dict) -> Study:
    def place(loc: tuple) -> str:
        return f"--set {overridden[loc[:2]]}" if loc[:2] in overridden else str(path)

    try:
        return Study.model_validate(data)
    except ValidationError as error:
        raise StudyError(*sentences(error, place)) from None


# ------------------------------------------------------------------------- checks by the packages that know


def _check_winding(study: Study, key: str, slots: int, origin: str) -> None:
    poles = study.machine.poles
    try:
        star_of_slots(slots, poles // 2, study.winding.layers, study.winding.coil_pitch)
    except GeometryError as error:
        raise StudyError(f"{origin}: {key} = {slots}, machine.poles = {poles}: {_sentence_part(error)}.") from error


def _check_geometry(study: Study, origin: str) -> None:
    try:
        check_machine(to_machine(study.machine))
    except GeometryError as error:
        said = _with_key_names(_sentence_part(error))
        raise StudyError(f"{origin}: [machine] cannot be built, {said}{_present_values(study, said)}.") from error


def _sentence_part(error: Exception) -> str:
    return str(error).rstrip(".")


def _with_key_names(message: str) -> str:
    """The message with the file's key names, ``airgap_mm`` where the geometry says ``airgap``."""
    for key in MachineSection.model_fields:
        stem = split_unit(key)[0]
        message = re.sub(rf"\b{stem}\b(?!_)", key, message) if stem != key else message
    return message


def _present_values(study: Study, message: str) -> str:
    """What the file states for the keys that a message names."""
    stated = study.machine.model_dump(exclude_none=True)
    named = [f"{key} = {value}" for key, value in stated.items() if re.search(rf"\b{key}\b", message)]
    return f" (now {', '.join(named)})" if named else ""
