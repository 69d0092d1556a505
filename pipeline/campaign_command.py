"""``airgap campaign-from STUDY``: the folder of a bench campaign of what was designed, before it is measured."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from disk import write_atomically
from pipeline.artefacts import artefact
from pipeline.campaign_draft import BENCHES, Designed, Draft
from pipeline.results import Results, results_of
from study.errors import StudyError
from study.read import read_study
from study.schema import Study

FILE = "campaign.toml"


def add_campaign_from(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap campaign-from``."""
    parser.add_argument("study", help="name of a file in studies/ or a path; it must have been run")
    bench = parser.add_mutually_exclusive_group()
    words = {
        "machine": "cross-section and winding, answered by the field (the default)",
        "dq": "the machine at its terminals and shaft, answered by constant parameters",
        "actuator": "machine, gears and linkage, measured at the output",
    }
    for name, says in words.items():
        bench.add_argument(f"--{name}", dest="bench", action="store_const", const=name, help=says)
    parser.add_argument("--out", metavar="DIR", help="folder to write; default measurements/<study>-<bench>/")
    parser.add_argument("--results", metavar="DIR", help="of the design; default results/<study>/")
    parser.set_defaults(run=campaign_from, bench="machine")


def campaign_from(options: argparse.Namespace) -> None:
    """Write the campaign; a folder that holds one is left alone."""
    study = read_study(options.study)
    results = results_of(study) if options.results is None else Results(Path(options.results))
    draft = BENCHES[options.bench].draft(designed(study, results))
    folder = Path(options.out or f"measurements/{study.study.id}-{options.bench}")
    write_campaign(folder, draft, f"{study.path.name} as it lies in {results.folder.name}")
    print(
        f"wrote {folder}: {FILE} and {len(draft.tables)} tables; fill in the readings, then `airgap compare {folder}`"
    )


def designed(study: Study, results: Results) -> Designed:
    """The design in a results folder. Raises StudyError where a stage has not run or its result was edited."""
    gears = artefact(study, results, "gearbox") if study.match.gearbox_stages else None
    winding, flux_map, outcome = (artefact(study, results, name) for name in ("winding", "flux_map", "outcome"))
    return Designed(study, winding, flux_map, outcome, gears)


def write_campaign(folder: Path, draft: Draft, source: str) -> None:
    """The campaign file and its tables. Raises StudyError where one of them is there already."""
    files = {FILE: draft.text(folder.name, source)} | {f"{one.name}.csv": one.text for one in draft.tables}
    there = [name for name in files if (folder / name).exists()]
    if there:
        raise StudyError(f"{folder / there[0]}: exists already; it is not overwritten, name another folder with --out.")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            write_atomically(folder / name, _writer(text))
    except OSError as error:
        raise StudyError(f"{folder} cannot be written ({error.strerror or error}).") from None


def _writer(text: str) -> Any:
    return lambda path: path.write_text(text, encoding="utf-8")
