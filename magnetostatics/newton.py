"""Newton's method for a smooth convex problem, with backtracking and a record that can be shown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable

import numpy as np


class FieldSolutionError(RuntimeError):
    """Newton's method did not converge; the message carries its record."""


@dataclass(frozen=True)
class NewtonSettings:
    """When to stop.

    tolerance: residual relative to the load
    most_iterations: more than this and the solve is given up
    smallest_step: shortest fraction of a step that backtracking may take
    """

    tolerance: float = 1e-4
    most_iterations: int = 40
    smallest_step: float = 1.0 / 1024


@dataclass(frozen=True)
class NewtonRecord:
    """Relative residual after every iteration and the step length it took."""

    residuals: tuple[float, ...]
    steps: tuple[float, ...]

    @property
    def iterations(self) -> int:
        return len(self.residuals)


def newton(
    start: np.ndarray,
    scale: float,
    residual: Callable[[np.ndarray], np.ndarray],
    direction: Callable[[np.ndarray, np.ndarray], np.ndarray],
    settings: NewtonSettings = NewtonSettings(),
) -> tuple[np.ndarray, NewtonRecord]:
    """Solve residual(u) = 0.

    start: first guess (n,);  scale: size of the load that the residual is compared with
    residual(u) -> (n,);  direction(u, residual) -> Newton step (n,)
    The first step is taken whole whatever the residual does (from zero field it always grows in saturated iron); later
    ones are halved until the residual falls.
    Raises FieldSolutionError with the record when the tolerance is not reached.
    """
    if scale == 0.0:  # neither magnets nor currents
        return np.zeros_like(start), NewtonRecord((), ())
    u, r, residuals, steps = start, residual(start), [], []
    while not residuals or residuals[-1] > settings.tolerance:
        if len(residuals) == settings.most_iterations:
            raise FieldSolutionError(_complaint(residuals, settings))
        u, r, step = _step(u, r, residual, direction(u, r), bool(residuals), settings)
        residuals.append(float(np.linalg.norm(r) / scale))
        steps.append(step)
    return u, NewtonRecord(tuple(residuals), tuple(steps))


def _step(u, r, residual, direction, must_fall: bool, settings: NewtonSettings):
    before, length = np.linalg.norm(r), 1.0
    trial = residual(u + direction)
    while must_fall and np.linalg.norm(trial) >= before and length > settings.smallest_step:
        length /= 2
        trial = residual(u + length * direction)
    return u + length * direction, trial, length


def _complaint(residuals: list[float], settings: NewtonSettings) -> str:
    record = ", ".join(f"{r:.1e}" for r in residuals)
    return (
        f"the field did not converge to a relative residual of {settings.tolerance:g} in {settings.most_iterations} "
        f"Newton iterations (residuals {record}): check the BH curve, the remanence and the current density"
    )
