"""What a machine's file says of a winding that is yet to be chosen: keys, ranges and words of ``study.schema``."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from study.errors import StudyError
from study.schema import Quantity, Section, SweepSection, WindingChoiceSection, WindingSection
from study.sentences import expected, shown

_S = TypeVar("_S", bound=Section)
SELECTION, POINTS = "winding_selection", "operating_points"
# Where a machine's file says what a study says in [winding_selection].
_ELSEWHERE = {
    "dc_bus_voltage_V": "dc_bus_voltage_V",
    "phase_current_max_rms_A": "line_current_peak_A, the amplitude",
    "speed_max_rpm": "speed_max_rpm",
    "winding_temperature_degC": "winding_temperature_degC",
}


def _note(section: type[Section], key: str) -> Quantity:
    found = section.quantity(key)
    assert found is not None  # both are numbers
    return found


class MachineWindingSelection(WindingChoiceSection):
    """Wires and limits from which turns, strands and connection of a drawn machine are chosen; its supply stands in
    [drive]."""

    packing_factor: Annotated[float, _note(WindingSection, "packing_factor")]
    j_overload_rms_A_per_mm2: Annotated[float, _note(SweepSection, "j_overload_rms_A_per_mm2")]


class OperatingPointSection(Section):
    """A torque that is asked of the shaft, and up to which speed."""

    torque_Nm: Annotated[float, Quantity("torque of the shaft", 1e-6, 1e6)]
    speed_rpm: Annotated[float, Quantity("speed of the shaft", 0, 2e5)]


def read_selection(path: Path, sections: Mapping[str, Any]) -> MachineWindingSelection | None:
    """Of a machine's file, None where it has none. Raises StudyError with one sentence."""
    if SELECTION not in sections:
        if POINTS in sections:
            raise StudyError(f"{path}: [[{POINTS}]] are for a winding to be chosen: add [{SELECTION}] or remove them.")
        return None
    return _read(MachineWindingSelection, sections[SELECTION], path, f"[{SELECTION}]")


def read_points(path: Path, sections: Mapping[str, Any]) -> tuple[OperatingPointSection, ...]:
    """What a winding is chosen for. Raises StudyError with one sentence."""
    found = sections.get(POINTS)
    if not isinstance(found, list) or not found:
        raise StudyError(
            f"{path}: [{SELECTION}] chooses for operating points, one at least: add [[{POINTS}]] with torque_Nm and "
            "speed_rpm."
        )
    return tuple(_read(OperatingPointSection, one, path, f"[[{POINTS}]]") for one in found)


def _read(cls: type[_S], stated: object, path: Path, where: str) -> _S:
    if not isinstance(stated, dict):
        raise StudyError(f"{path}: {where} is expected to be a table, found {shown(stated)}.")
    try:
        return cls.model_validate(stated)
    except ValidationError as error:
        unknown_first = sorted(error.errors(), key=lambda one: one["type"] != "extra_forbidden")  # a slip leaves a gap
        raise StudyError(f"{path}: {where} {_sentence(cls, unknown_first[0])}.") from None


def _sentence(cls: type[Section], problem: ErrorDetails) -> str:
    key, found = str(problem["loc"][0]), problem["input"]
    if problem["type"] == "missing":
        return f"lacks {key}; add it: {expected(cls, key)}"
    if problem["type"] == "extra_forbidden":
        return f"has no key {key}; {_advice(cls, key)}"
    if problem["type"] == "value_error":
        return f"{key} = {shown(found)} {problem['ctx']['error']}"
    return f"{key} = {shown(found)} is not accepted; give {expected(cls, key)}"


def _advice(cls: type[Section], key: str) -> str:
    if key in _ELSEWHERE:
        return f"a machine's file states it in [drive] as {_ELSEWHERE[key]}"
    near = get_close_matches(key, cls.model_fields, n=1)
    return f"did you mean {near[0]}" if near else f"known are {', '.join(cls.model_fields)}"
