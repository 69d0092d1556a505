"""A loop that is paced by the clock of this machine, and how well that goes."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from time import perf_counter, sleep

import numpy as np

_SPUN = 1e-4  # s, before a release, that are waited for awake: a sleep may end this late
_PRIORITY = 10  # above everything that has none


@contextmanager
def first_in_line() -> Iterator[str]:
    """Before all ordinary processes while it lasts, where the system allows it; the name of the scheduling.

    Linux's first-in-first-out class, which usually takes the rights of the administrator.
    """
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_PRIORITY))
    except (AttributeError, PermissionError):
        yield "ordinary"
        return
    try:
        yield "first in, first out"
    finally:
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


@dataclass
class Pace:
    """Releases one step after another at equal times; a late step is not skipped, the next ones catch up.

    step: between releases [s]; begun: of the first one [s]; late: of each step behind its release [s]; spent: between
    the beginning and the end of each [s]; both one per step
    """

    step: float
    begun: float = 0.0
    late: list[float] = field(default_factory=list)
    spent: list[float] = field(default_factory=list)

    def wait(self) -> None:
        """Until the next step may begin."""
        if not self.late:
            self.begun = perf_counter()
        release = self.begun + len(self.late) * self.step
        if (left := release - perf_counter() - _SPUN) > 0:
            sleep(left)
        while (now := perf_counter()) < release:
            pass
        self.late.append(now - release)

    def done(self) -> None:
        """The step has ended."""
        release = self.begun + (len(self.late) - 1) * self.step
        self.spent.append(perf_counter() - release - self.late[-1])

    @property
    def timing(self) -> Timing:
        """Of all steps so far."""
        late, spent = np.array(self.late), np.array(self.spent)
        return Timing(self.step, late, spent)


@dataclass(frozen=True, eq=False)
class Timing:
    """How a paced loop went; step [s]; late, spent: as in ``Pace`` [s], (n,)."""

    step: float
    late: np.ndarray
    spent: np.ndarray

    @property
    def missed(self) -> int:
        """Steps that ended behind their deadline, the next release."""
        return int(np.sum(self.late + self.spent > self.step))

    def row(self) -> dict[str, float]:
        """Times [s] and counts by name: medians, 99 % and the worst."""
        found = {"step_s": self.step, "steps": float(self.late.size), "missed_deadlines": float(self.missed)}
        for name, values in (("step_time", self.spent), ("jitter", self.late)):
            median, high, worst = np.percentile(values, [50, 99, 100])
            found |= {f"{name}_median_s": median, f"{name}_p99_s": high, f"{name}_worst_s": worst}
        return found
