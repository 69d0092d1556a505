"""What may stand in a model file, section by section; a file that differs is refused in one sentence."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError

from workbench.errors import WorkbenchError


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class ModelSection(_Section):
    """``[model]``: which base model the file is of."""

    base: str


class InputSection(_Section):
    """``[[input]]``: shift of an input of the model from the drawing, SI or relative."""

    name: str
    shift: FiniteFloat
    sigma: FiniteFloat = Field(gt=0)
    relative: bool
    source: str = ""


class CalibrationSection(_Section):
    """``[[calibration]]``: error of an instrument of the campaign, relative for a gain, SI for an offset."""

    name: str
    kind: Literal["gain", "offset"]
    shift: FiniteFloat
    sigma: FiniteFloat = Field(gt=0)


class NumericalSection(_Section):
    """``[numerical_error]``: weights of the shapes of the base model's own error, standard normal numbers."""

    weights: list[FiniteFloat]


class CovarianceSection(_Section):
    """``[covariance]``: of inputs, calibrations, parameters of effects and weights of the numerical error, SI."""

    names: list[str]
    rows: list[list[FiniteFloat]]


class RangeSection(_Section):
    """``[[learned.range]]``: where one channel was fitted. conditions: low and high, SI;  unexplained: SI"""

    kind: str
    response: str
    rows: int = Field(gt=0)
    chi2_per_n: FiniteFloat = Field(ge=0)
    unexplained: FiniteFloat = Field(ge=0)
    conditions: dict[str, Annotated[list[FiniteFloat], Field(min_length=2, max_length=2)]]


class LearnedSection(_Section):
    """``[learned]``: the campaign that the numbers are from."""

    campaign: str
    device_sha256: str
    data_sha256: dict[str, str]
    range: list[RangeSection]


class FileSchema(_Section):
    """A whole model file. Effects are checked against the library, not here."""

    model: ModelSection
    device: dict[str, Any] = Field(default_factory=dict)
    learned: LearnedSection | None = None
    effect: list[dict[str, Any]] = Field(default_factory=list)
    input: list[InputSection] = Field(default_factory=list)
    calibration: list[CalibrationSection] = Field(default_factory=list)
    numerical_error: NumericalSection | None = None
    covariance: CovarianceSection | None = None


def content_of(path: Path) -> FileSchema:
    """The checked content of a model file.

    Raises:
        WorkbenchError: not there, not TOML, or a section that is not as described here.
    """
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise WorkbenchError(f"{path}: cannot be read as a model file ({error.strerror}).") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise WorkbenchError(f"{path}: cannot be read as a model file: {error}.") from None
    try:
        return FileSchema.model_validate(content)
    except ValidationError as error:
        raise WorkbenchError(f"{path}: {_sentence(error)}") from None


def _sentence(error: ValidationError) -> str:
    """The first problem: where, what was found and what is expected."""
    problem = error.errors()[0]
    place = ".".join(str(part + 1 if isinstance(part, int) else part) for part in problem["loc"])
    if problem["type"] == "missing":
        return f"{place} is missing in this model file."
    if problem["type"] == "extra_forbidden":
        return f"{place} is no key of a model file; remove it."
    said = problem["msg"][0].lower() + problem["msg"][1:]
    return f"{place} = {str(problem['input'])[:60]} cannot be used: {said}."
