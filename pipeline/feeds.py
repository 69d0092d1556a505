"""What the stages before found in the place of what the study states, for match, winding and gearbox."""

from __future__ import annotations

import json

from pipeline.stage import StageError, results_folder
from study.chain import drives, searches_linkage
from study.schema import LinkageSection, RequirementsSection, Study

REQUIREMENTS, LINKAGE = "requirements.json", "linkage.json"  # written by the stages of these names


def fed(study: Study) -> Study:
    """The study with [requirements] from runs of its vehicle and [linkage] from the front, where its [chain] says so.

    Raises StageError when such a stage has not run.
    """
    changes = {}
    if drives(study):
        changes["requirements"] = RequirementsSection(**read_result(study, REQUIREMENTS)["values"])
    if searches_linkage(study):
        found = read_result(study, LINKAGE)["section"]
        changes["linkage"] = LinkageSection(**{**study.linkage.model_dump(), **found})
    return study.model_copy(update=changes)


def stated(study: Study) -> Study | None:
    """The study fed with what it states, for the comparison; None where it is so fed or states no requirement."""
    if study.requirements is None or not (drives(study) or searches_linkage(study)):
        return None
    return study.model_copy(update={"chain": None})


def read_result(study: Study, name: str) -> dict:
    """A JSON result of a finished stage; StageError where it is not there."""
    path = results_folder(study.study.id) / name
    if not path.is_file():
        stage = name.partition(".")[0]
        raise StageError(f"{name} of the study {study.study.id} does not exist; run `make {stage}` or `make pipeline`.")
    return json.loads(path.read_text(encoding="utf-8"))
