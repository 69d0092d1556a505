"""``airgap machine MACHINE``: map, torque over speed, losses and data sheet of a machine of any kind."""

from __future__ import annotations

import argparse
from pathlib import Path

from figures.files import File
from figures.report import Section
from pipeline.closure import packages_of
from pipeline.machine_stages import graph_of_machine
from pipeline.modules import PROJECT
from pipeline.results import Results
from pipeline.run import Failure, Run
from pipeline.running import add_pool, page, pools_of, run_all, wanted
from pipeline.sentences import sentences
from study.machine_file import MachineFile, read_machine

_SUBTITLE = "A machine as it is drawn and wound, solved and put on a page"


def add_machine(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap machine``."""
    parser.description = "Map, torque over speed, losses and data sheet of a machine that a file states whole."
    parser.add_argument("machine", help="name of a file in machines/ or a path")
    parser.add_argument("--to", metavar="STAGE", help="the last stage; without it all of them and the report")
    parser.add_argument("--out", metavar="DIR", help="default results/machines/<name of the file>/")
    add_pool(parser)
    parser.set_defaults(run=machine_command)


def machine_command(options: argparse.Namespace) -> None:
    """Run the graph of a machine's file. Exit codes as of ``airgap run``."""
    read = read_machine(options.machine)
    graph = graph_of_machine(read)
    folder = PROJECT / "results" / "machines" / read.path.stem if options.out is None else Path(options.out)
    last = wanted(graph, options.to)
    with sentences(), pools_of(options, graph) as pools:
        run_all(Run(graph, read, Results(folder), *pools), last, _page_of)


def _page_of(read: MachineFile, sections: list[Section], failures: list[Failure]) -> File:
    return page(read.title, _SUBTITLE, {"machine": read.path.name, **packages_of(machine_command)}, sections, failures)
