"""The page ``chapters.html``: what the stages strategies, quarter_car and bench have found, one section each."""

from __future__ import annotations

from collections.abc import Iterator

from bench.chapters import Chapters
from bench.report import chapters, simulated
from bench.simulated import BenchTests
from figures.files import File
from report import quarter_car, strategies
from vehicle.quarter_car_stage import QuarterCarRides
from vehicle.strategies import Strategies


def files(found: Chapters, laws: Strategies, rides: QuarterCarRides, tests: BenchTests) -> Iterator[File]:
    """The headline numbers and the page."""
    yield chapters.table(found)
    parts = (strategies.section(laws), quarter_car.section(rides), simulated.section(tests))
    yield chapters.page((chapters.section(found), *parts))
