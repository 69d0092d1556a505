"""``airgap run STUDY``: all stages of a study, or those up to one, in this process and its workers."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from drivetrain.learned import Learned
from drivetrain.outcome import Outcome
from drivetrain.requirements import Requirements, Transmission
from drivetrain.second_design import FirstDesign
from electrical.final_length import ContinuousNeed
from electrical.winding_stage import WindingOutcome
from figures.files import File
from figures.report import Section
from losses.stage import LossMap
from magnetostatics.case import FieldCase
from magnetostatics.flux_map_stage import FluxMap
from pipeline.closure import packages_of
from pipeline.learning import learned_from
from pipeline.machine_command import machine_command
from pipeline.own_effects import add_own_effects, exit_on_wrong_campaign, own_library
from pipeline.results import Results, results_of
from pipeline.run import Failure, Missing, Run
from pipeline.running import add_pool, page, pools_of, run_all, wanted
from pipeline.sentences import sentences
from pipeline.stages import graph_of, graph_of_second_design
from study.errors import StudyError
from study.machine_file import names_machine
from study.read import read_study
from study.schema import Study
from study.usable import check_study
from thermal.stage import HeatOutcome


def add_run(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap run``."""
    parser.add_argument("study", help="name of a file in studies/ or machines/, or a path")
    parser.add_argument("--to", metavar="STAGE", help="the last stage; without it all of them and the report")
    add_pool(parser)
    parser.add_argument("--with", dest="model", metavar="MODEL.toml", help="design again with what a bench has taught")
    parser.add_argument("--out", metavar="DIR", help="of the second design; default results/<study>-learned/")
    add_own_effects(parser)
    parser.set_defaults(run=run_command)


def run_command(options: argparse.Namespace) -> None:
    """Run the graph of a study. Exit codes: 0 all done, 1 a stage could not go on (the report says why), 130 Ctrl-C.

    With a model file the first design is run as far as it is not current, then the second one beside it. The file of a
    machine that is stated whole has a graph of its own, see ``machine_command``.
    """
    if names_machine(options.study):
        return _run_machine(options)
    study = read_study(options.study)
    check_study(study)
    graph = graph_of(study)
    last = wanted(graph, options.to)
    learned = _learned(options)
    with sentences(), pools_of(options, graph) as pools:
        first = Run(graph, study, results_of(study), *pools)
        run_all(first, None if learned is not None else last, page_of)
        if learned is not None:
            again = graph_of_second_design(study, learned, first_design(first))
            run_all(Run(again, study, _results_again(study, options.out), *pools), last, page_of)


def _run_machine(options: argparse.Namespace) -> None:
    if options.model is not None:
        raise StudyError(f"--with: what a bench teaches goes into a study; {options.study} is a machine's file.")
    machine_command(argparse.Namespace(**vars(options), machine=options.study))


def _learned(options: argparse.Namespace) -> Learned | None:
    """What the model file teaches, said at once; None without one."""
    if options.model is None:
        if options.out is not None:
            raise StudyError("--out goes with --with: the first design has its place in results/<study>/.")
        return None
    with exit_on_wrong_campaign():
        learned = learned_from(Path(options.model), own_library(options))
    for lesson in learned.lessons:
        print(f"learned: {lesson.reason}: {lesson.words}", flush=True)
    for sentence in learned.unused:
        print(f"not used: {sentence}", flush=True)
    return learned


def _results_again(study: Study, out: str | None) -> Results:
    """The folder of the second design, never that of the first."""
    first = results_of(study).folder
    folder = first.with_name(f"{first.name}-learned") if out is None else Path(out)
    if folder.resolve() == first.resolve():
        raise StudyError(f"--out {out}: is the folder of the first design; name another one.")
    return Results(folder)


def first_design(run: Run) -> FirstDesign:
    """The artefacts and inputs of a run that came to its end."""
    return FirstDesign(
        case=run.value(FieldCase),
        flux_map=run.value(FluxMap),
        winding=run.value(WindingOutcome),
        outcome=run.value(Outcome),
        required=run.value(Requirements),
        transmission=run.value(Transmission),
        continuous=run.value(ContinuousNeed),
        heat=run.value(HeatOutcome),
        losses=_if_there(run, LossMap),
    )


def _if_there(run: Run, kind: type) -> Any:
    try:
        return run.value(kind)
    except Missing:
        return None


def page_of(study: Study, sections: list[Section], failures: list[Failure]) -> File:
    """The report of a study."""
    title, subtitle = study.study.title, "From what is asked to a wound machine, stage by stage"
    return page(title, subtitle, {"study": study.path.name, **packages_of(run_command)}, sections, failures)
