"""``airgap graph STUDY``: the stages of a study and what flows between them."""

from __future__ import annotations

import argparse

from pipeline.graph import drawing
from pipeline.stages import graph_of
from study.read import read_study


def add_graph(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap graph``."""
    parser.add_argument("study", help="name of a file in studies/ or a path")
    parser.set_defaults(run=graph)


def graph(options: argparse.Namespace) -> None:
    """Print a Mermaid flowchart."""
    print(drawing(graph_of(read_study(options.study))))
