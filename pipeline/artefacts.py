"""Artefacts that a command needs of a study that has been run."""

from __future__ import annotations

from typing import Any

from pipeline.codec import CodecError
from pipeline.results import Results
from study.errors import StudyError
from study.schema import Study


def artefact(study: Study, results: Results, name: str) -> Any:
    """The artefact of a stage. Raises StudyError where it has not run or its result was edited."""
    try:
        if results.record(name) is not None:
            return results.load(name)
    except CodecError:
        pass
    raise StudyError(
        f"{results.folder} has no usable result of {name}: run `airgap run {study.path} --to {name}` first."
    )
