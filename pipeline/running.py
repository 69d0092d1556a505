"""What ``airgap run`` does with a graph, be it that of a study or that of a machine's file: pool, stages, report."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from figures.files import File
from figures.report import Part, Picture, Remark, Section, write_report
from pipeline.graph import Graph
from pipeline.pools import DaskCluster
from pipeline.run import Failure, PageOf, Run, git_commit
from pipeline.sentences import EXIT_FAILED
from processes import Pool, Processes
from study.errors import StudyError

REPORT = "report.html"
# What stages load at first use: workers share it instead of loading it each.
SHARED = ("scipy.integrate", "scipy.signal")


def add_pool(parser: argparse.ArgumentParser) -> None:
    """The arguments that say where tasks run."""
    parser.add_argument("--jobs", type=int, metavar="N", help="processes that work at once (default: the cores)")
    parser.add_argument("--executor", choices=("processes", "dask"), default="processes", help="where tasks run")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a dask cluster, tcp://host:8786")


def run_all(run: Run, last: str | None, page_of: PageOf) -> None:
    """Every stage, or those up to one, and the report; SystemExit where one could not go on."""
    with run.results.held():
        run.all(run.graph.usual if last is None else run.graph.before(run.graph.stage(last)))
        if last is None or run.failures:
            run.write_report(page_of)
            print(f"report: {run.results.folder / REPORT}")
    if run.failures:
        raise SystemExit(EXIT_FAILED)


def wanted(graph: Graph, name: str | None) -> str | None:
    """The last stage that is asked for, None for all. Raises StudyError for one that is not there."""
    if name is None or name == "report":
        return None
    names = [stage.name for stage in graph.stages]
    if name not in names:
        raise StudyError(f"--to {name}: there is no such stage; give one of {', '.join(names)}, report.")
    return name


@contextmanager
def pools_of(options: argparse.Namespace, graph: Graph) -> Iterator[tuple[Pool, Pool]]:
    """Where tasks run, as the arguments of ``add_pool`` say, and where files are drawn meanwhile: what that loads and
    leaves behind does not make the process of the stages larger."""
    if options.scheduler and options.executor != "dask":
        raise StudyError("--scheduler goes with --executor dask.")
    if options.jobs is not None and options.jobs < 1:
        raise StudyError(f"--jobs {options.jobs}: give one process or more.")
    shared = (*modules_of(graph), *SHARED)
    dask = options.executor == "dask"
    pool: Pool = DaskCluster(options.jobs, options.scheduler) if dask else Processes(options.jobs, shared)
    pools = pool, Processes(1, shared)
    try:
        yield pools
    except BaseException:
        for one in pools:
            one.end(now=True)
        raise
    for one in pools:
        one.end()


def modules_of(graph: Graph) -> tuple[str, ...]:
    """Where the stages stand: workers load these before they are forked, and share them."""
    return tuple({stage.function.__module__: None for stage in graph.stages})


def page(title: str, subtitle: str, source: dict[str, str], sections: list[Section], failures: list[Failure]) -> File:
    """A report: what could not go on first, then what was found; source: of what it is and by which packages."""
    told = [_failed(failures)] if failures else []
    provenance = {**source, "commit": git_commit() or "unknown"}

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
