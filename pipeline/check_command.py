"""``airgap check STUDY``: is this study file usable? Prints a summary, or what is wrong (exit code 2)."""

from __future__ import annotations

import argparse

from pipeline.arguments import add_overrides
from study.check import summary
from study.read import read_study
from study.usable import check_study


def add_check(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap check``."""
    parser.add_argument("study", help="name of a file in studies/ or a path")
    add_overrides(parser)
    parser.set_defaults(run=check)


def check(options: argparse.Namespace) -> None:
    """Everything that can be found before computing."""
    study = read_study(options.study, options.set)
    check_study(study)
    print(summary(study))
