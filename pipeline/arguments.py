"""Arguments that several commands share."""

from __future__ import annotations

import argparse
from math import isfinite
from pathlib import Path

from study.errors import StudyError


def add_overrides(parser: argparse.ArgumentParser) -> None:
    """``--set section.key=value``."""
    text = "replace a value of the study; repeatable"
    parser.add_argument("--set", action="append", default=[], metavar="SECTION.KEY=VALUE", help=text)


def finite(option: str, value: float) -> float:
    """A number that an option was given; StudyError where it is none or not finite."""
    if not isfinite(value):
        raise StudyError(f"{option} must be a finite number, found {value:g}.")
    return value


def writable(target: str) -> Path:
    """The path of a file to write; StudyError where its folder does not exist."""
    path = Path(target)
    if not path.resolve().parent.is_dir():
        raise StudyError(f"cannot write {target}: the folder {path.parent} does not exist; create it first.")
    return path
