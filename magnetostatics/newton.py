"""Newton's method for a smooth convex problem, with backtracking and a record that can be shown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Residual = Callable[[np.ndarray], np.ndarray]


class FieldSolutionError(RuntimeError):
    """Newton's method did not converge; the message carries its record."""


@dataclass(frozen=True)
class NewtonSettings:
    """When to stop.

    tolerance: residual relative to the load
    most_iterations: more than this and the solve is given up
    smallest_step: shortest fraction of a step that backtracking may take
    always_step: take one step even from a start that is good enough
    """

    tolerance: float = 2e-4
    most_iterations: int = 40
    smallest_step: float = 1.0 / 1024
    always_step: bool = True


@dataclass(frozen=True)
class NewtonRecord:
    """residuals: relative, after every iteration; steps: fraction of the Newton step it took."""

    residuals: tuple[float, ...]
    steps: tuple[float, ...]

    @property
    def iterations(self) -> int:
        """How many steps it took."""
        return len(self.residuals)


def newton(
    start: np.ndarray,
    scale: float,
    residual: Residual,
    direction: Callable[[np.ndarray, np.ndarray], np.ndarray],
    settings: NewtonSettings = NewtonSettings(),
) -> tuple[np.ndarray, NewtonRecord]:
    """Potential u [Wb/m], (n,), with residual(u) = 0, and the record of how it was found.

    start: first guess [Wb/m], (n,);  scale: size of the load that the residual is compared with [A]
    residual(u) -> [A], (n,);  direction(u, residual) -> Newton step [Wb/m], (n,)
    The first step is taken whole whatever the residual does (from zero field it always grows in saturated iron); later
    ones are halved until the residual falls.
    Raises FieldSolutionError with the record when the tolerance is not reached.
    """
    if scale == 0.0:  # neither magnets nor currents
        return np.zeros_like(start), NewtonRecord((), ())
    residuals: list[float] = []
    steps: list[float] = []
    u, r = start, residual(start)
    size = float(np.linalg.norm(r) / scale)
    while size > settings.tolerance or (settings.always_step and not residuals):
        if len(residuals) == settings.most_iterations:
            raise FieldSolutionError(_complaint(residuals, settings))
        u, r, step = _step(u, r, residual, direction(u, r), bool(residuals), settings)
        size = float(np.linalg.norm(r) / scale)
        residuals.append(size)
        steps.append(step)
    return u, NewtonRecord(tuple(residuals), tuple(steps))


def _step(
    u: np.ndarray,
    r: np.ndarray,
    residual: Residual,
    direction: np.ndarray,
    must_fall: bool,
    settings: NewtonSettings,
) -> tuple[np.ndarray, np.ndarray, float]:
    before, length = np.linalg.norm(r), 1.0
    there = u + direction
    trial = residual(there)
    while must_fall and np.linalg.norm(trial) >= before and length > settings.smallest_step:
        length /= 2
        there = u + length * direction
        trial = residual(there)
    return there, trial, length


def _complaint(residuals: list[float], settings: NewtonSettings) -> str:
    record = ", ".join(f"{r:.1e}" for r in residuals)
    return (
        f"the field did not converge to a relative residual of {settings.tolerance:g} in {settings.most_iterations} "
        f"Newton iterations (residuals {record}): check the BH curve, the remanence and the current density"
    )
