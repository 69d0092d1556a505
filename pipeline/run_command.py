"""``airgap run STUDY``: all stages of a study, or those up to one, in this process and its workers."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from drivetrain.learned import Learned
from drivetrain.outcome import Outcome
from drivetrain.requirements import Requirements, Transmission
from drivetrain.second_design import FirstDesign
from electrical.final_length import ContinuousNeed
from electrical.winding_stage import WindingOutcome
from figures.files import File
from figures.report import Part, Picture, Remark, Section, write_report
from losses.stage import LossMap
from magnetostatics.case import FieldCase
from magnetostatics.flux_map_stage import FluxMap
from pipeline.closure import packages_of
from pipeline.graph import Graph
from pipeline.learning import learned_from
from pipeline.own_effects import add_own_effects, exit_on_wrong_campaign, own_library
from pipeline.pools import DaskCluster
from pipeline.results import Results, results_of
from pipeline.run import Failure, Missing, PageOf, Run, git_commit
from pipeline.sentences import EXIT_FAILED, sentences
from pipeline.stages import graph_of, graph_of_second_design
from processes import Pool, Processes
from study.errors import StudyError
from study.read import read_study
from study.schema import Study
from study.usable import check_study
from thermal.stage import HeatOutcome

REPORT = "report.html"


def add_run(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap run``."""
    parser.add_argument("study", help="name of a file in studies/ or a path")
    parser.add_argument("--to", metavar="STAGE", help="the last stage; without it all of them and the report")
    add_pool(parser)
    parser.add_argument("--with", dest="model", metavar="MODEL.toml", help="design again with what a bench has taught")
    parser.add_argument("--out", metavar="DIR", help="of the second design; default results/<study>-learned/")
    add_own_effects(parser)
    parser.set_defaults(run=run_command)


def add_pool(parser: argparse.ArgumentParser) -> None:
    """The arguments that say where tasks run."""
    parser.add_argument("--jobs", type=int, metavar="N", help="processes that work at once (default: the cores)")
    parser.add_argument("--executor", choices=("processes", "dask"), default="processes", help="where tasks run")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a dask cluster, tcp://host:8786")


def run_command(options: argparse.Namespace) -> None:
    """Run the graph of a study. Exit codes: 0 all done, 1 a stage could not go on (the report says why), 130 Ctrl-C.

    With a model file the first design is run as far as it is not current, then the second one beside it.
    """
    study = read_study(options.study)
    check_study(study)
    graph = graph_of(study)
    last = wanted(graph, options.to)
    learned = _learned(options)
    with sentences(), pool_of(options, graph) as pool:
        first = Run(graph, study, results_of(study), pool)
        run_all(first, None if learned is not None else last, page_of)
        if learned is not None:
            again = graph_of_second_design(study, learned, first_design(first))
            run_all(Run(again, study, _results_again(study, options.out), pool), last, page_of)


def run_all(run: Run, last: str | None, page_of: PageOf) -> None:
    """Every stage, or those up to one, and the report; SystemExit where one could not go on."""
    with run.results.held():
        run.all(run.graph.usual if last is None else run.graph.before(run.graph.stage(last)))
        if last is None or run.failures:
            run.write_report(page_of)
            print(f"report: {run.results.folder / REPORT}")
    if run.failures:
        raise SystemExit(EXIT_FAILED)


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


def wanted(graph: Graph, name: str | None) -> str | None:
    """The last stage that is asked for, None for all. Raises StudyError for one that is not there."""
    if name is None or name == "report":
        return None
    names = [stage.name for stage in graph.stages]
    if name not in names:
        raise StudyError(f"--to {name}: there is no such stage; give one of {', '.join(names)}, report.")
    return name


@contextmanager
def pool_of(options: argparse.Namespace, graph: Graph) -> Iterator[Pool]:
    """Where tasks run, as the arguments of ``add_pool`` say."""
    if options.scheduler and options.executor != "dask":
        raise StudyError("--scheduler goes with --executor dask.")
    if options.jobs is not None and options.jobs < 1:
        raise StudyError(f"--jobs {options.jobs}: give one process or more.")
    modules = tuple({stage.function.__module__: None for stage in graph.stages})
    dask = options.executor == "dask"
    pool: Pool = DaskCluster(options.jobs, options.scheduler) if dask else Processes(options.jobs, modules)
    try:
        yield pool
    except BaseException:
        pool.end(now=True)
        raise
    pool.end()


def page_of(study: Study, sections: list[Section], failures: list[Failure]) -> File:
    """The report of a study."""
    title, subtitle = study.study.title, "From what is asked to a wound machine, stage by stage"
    return page(title, subtitle, {"study": study.path.name}, sections, failures)


def page(title: str, subtitle: str, source: dict[str, str], sections: list[Section], failures: list[Failure]) -> File:
    """A report: what could not go on first, then what was found; source: of what it is, for its foot."""
    told = [_failed(failures)] if failures else []
    provenance = {**source, "commit": git_commit() or "unknown", **packages_of(run_command)}

    def write(path: Path) -> None:
        pictures = path.parent  # the temporary file lies where the report will
        shown = (*told, *(_with_what_is_there(section, pictures) for section in sections))
        write_report(path, shown, pictures, title=title, subtitle=subtitle, provenance=provenance)

    return File(REPORT, write)


def _with_what_is_there(section: Section, folder: Path) -> Section:
    """The section with a remark in the place of each picture that was not drawn: it is in the failures, too."""

    def there(part: Part) -> Part:
        if not isinstance(part, Picture) or not isinstance(part.image, (str, Path)) or (folder / part.image).is_file():
            return part
        return Remark(f"Not drawn: {part.caption}")

    return replace(section, content=tuple(there(part) for part in section.content))


def _failed(failures: list[Failure]) -> Section:
    """The section that heads the report of a run that did not reach its end."""
    lines = tuple(Remark(f"{failure.stage}: {failure.reason}") for failure in failures)
    return Section("This run could not go on", ("What was found before that stands below.", *lines))
