"""``airgap check STUDY`` and ``airgap graph STUDY``: what a study asks for, before anything is computed."""

from __future__ import annotations

import argparse

from pipeline.arguments import add_overrides
from pipeline.graph import drawing
from pipeline.stages import graph_of
from study.check import summary
from study.read import read_study
from study.usable import check_study


def add_check(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap check``."""
    parser.add_argument("study", help="name of a file in studies/ or a path")
    add_overrides(parser)
    parser.set_defaults(run=check)


def add_graph(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap graph``."""
    parser.add_argument("study", help="name of a file in studies/ or a path")
    parser.set_defaults(run=graph)


def check(options: argparse.Namespace) -> None:
    """Everything that can be found before computing."""
    study = read_study(options.study, options.set)
    check_study(study)
    print(summary(study))


def graph(options: argparse.Namespace) -> None:
    """The stages of a study as a Mermaid flowchart."""
    print(drawing(graph_of(read_study(options.study))))
