"""Thesis chapters 4 and 5 for the actuator of a study in one list: what it comes to, beside what is printed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from bench.simulated import BenchTests
from units import GRAVITY
from vehicle.energy import scatter
from vehicle.printed_energy import printed_energy
from vehicle.quarter_car_stage import QuarterCarRides
from vehicle.strategies import Strategies

PRINTED_TRADE_OFF = 1.4e-2  # g, comfort index, Table 4.1


@dataclass(frozen=True)
class Beside:
    """One number beside the printed one.

    place: in the thesis; quantity: with its unit; here, printed: [of that unit], nan where none is printed
    """

    place: str
    quantity: str
    here: float
    printed: float


@dataclass(frozen=True)
class Chapters:
    """The headline numbers of both chapters."""

    rows: tuple[Beside, ...]


def chapters_stage(laws: Strategies, rides: QuarterCarRides, tests: BenchTests) -> Chapters:
    """Headline numbers of what the three stages have found."""
    return Chapters((*_of_laws(laws), *_of_rides(rides), *_of_tests(tests)))


def _of_laws(laws: Strategies) -> Iterator[Beside]:
    trade_off = next(one for one in laws.settings if one.name == "trade-off")
    comfort = trade_off.indices.comfort / GRAVITY
    yield Beside("Table 4.1", "comfort of the trade-off LQR, own vehicle / g", comfort, PRINTED_TRADE_OFF)


def _of_rides(rides: QuarterCarRides) -> Iterator[Beside]:
    cases = {(one.command, one.actuator): one for one in rides.energy.cases}
    for printed in printed_energy():
        values = scatter(cases[printed.command, printed.actuator].energies)
        words = f"{printed.command}, {printed.actuator}"
        yield Beside(f"Table {printed.table}", f"{words}: to battery / W", values["battery.active"].mean,
                     printed.electrical)  # fmt: skip
        yield Beside(f"Table {printed.table}", f"{words}: comfort / g", values["comfort"].mean / GRAVITY,
                     printed.comfort / GRAVITY)  # fmt: skip


def _of_tests(tests: BenchTests) -> Iterator[Beside]:
    best = max(row.best_efficiency for row in tests.shunts if not np.isnan(row.best_efficiency))
    yield Beside("Table 5.1", "best conversion efficiency into a shunt / %", 100 * best, 59.9)
    shorted = next(row.damping for row in tests.shunts if row.shunt == 0)
    yield Beside("Table 5.1", "damping of the short circuit / (kNs/m)", shorted / 1e3, 19.57)
    resonance = float(tests.active.frequency[int(np.argmax(tests.active.force.values))])
    yield Beside("Fig. 5.13", "resonance with the output held / Hz", resonance, 65.0)
    for row in tests.in_the_loop:
        yield Beside("Fig. 5.16", f"error of the force in the loop, {row.low_level} / N",
                     row.numbers["force_error_rms_N"], float("nan"))  # fmt: skip
