"""A small graph with everything a large one has: a source, a view, stages with and without tasks, files, sections."""

import multiprocessing
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from figures.files import text_file
from figures.report import Section
from pipeline.graph import Graph, Source, Stage, View
from tasks import Workers


class NoFit(ValueError):
    """What the room of this graph refuses with."""


@dataclass(frozen=True)
class Inputs:
    count: int
    refuse: bool = False


@dataclass(frozen=True)
class Squares:
    values: tuple[int, ...]
    data: xr.Dataset


@dataclass(frozen=True)
class Largest:
    value: int


@dataclass(frozen=True)
class Summary:
    text: str
    remark: str | None


@dataclass(frozen=True)
class Extra:
    text: str


@dataclass(frozen=True)
class StudyOfToys:
    """Stands for a study."""

    count: int = 3
    refuse: bool = False
    counter: Path | None = None


def inputs(study: StudyOfToys) -> Inputs:
    return Inputs(study.count, study.refuse)


def square(number: int) -> int:
    return number**2


def squares_stage(inputs: Inputs, workers: Workers) -> Squares:
    found = workers.map("squares", square, {f"number {k}": k for k in range(inputs.count)})
    values = tuple(found.values())
    return Squares(values, xr.Dataset({"square": ("k", np.array(values, dtype=float))}))


def largest(squares: Squares) -> Largest:
    return Largest(max(squares.values))


def summary_stage(largest: Largest, inputs: Inputs, extra: Extra | None) -> Summary:
    if inputs.refuse:
        raise NoFit("no summary: refuse is set; set it to false")
    return Summary(f"the largest is {largest.value}", extra and extra.text)


def after_stage(summary: Summary) -> Extra:
    return Extra(summary.text + "!")


def summary_files(summary: Summary):
    yield text_file("summary.txt", summary.text + "\n")


def file_of_a_process(summary: Summary):
    """Says who wrote it."""
    yield text_file("summary.txt", str(os.getpid()))


def file_of_a_survivor(summary: Summary):
    """Says who wrote it; a worker dies of it."""
    if multiprocessing.parent_process() is not None:
        os._exit(1)
    yield from file_of_a_process(summary)


def file_of_nobody(summary: Summary):
    raise ZeroDivisionError("nothing to divide by")
    yield


def squares_section(squares: Squares) -> Section:
    return Section("Squares", (f"{len(squares.values)} squares.",))


def summary_section(summary: Summary) -> Section:
    return Section("Summary", (summary.text,))


@dataclass(frozen=True)
class Never:
    """Nothing makes it."""


def never(study: StudyOfToys) -> Never | None:
    return None


SQUARES = Stage("squares", squares_stage, "squares of numbers")
SUMMARY = Stage("summary", summary_stage, "the largest in words", summary_files)
# Declared in another order than they run in.
GRAPH = Graph((SUMMARY, Source(inputs), View(largest), SQUARES), (squares_section, summary_section), refusals=(NoFit,))
