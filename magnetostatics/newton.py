"""Newton's method for a smooth convex problem, with backtracking and a record that can be shown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

import numpy as np

Residual = Callable[[np.ndarray], np.ndarray]

_WORTH = 0.4  # share of the residual that a chord step may leave for another one to follow


class FieldSolutionError(RuntimeError):
    """Newton's method did not converge; the message carries its record."""


@dataclass(frozen=True)
class NewtonSettings:
    """When to stop.

    tolerance: residual relative to the load
    most_iterations: more than this and the solve is given up
    smallest_step: shortest fraction of a step that backtracking may take
    always_step: take one step even from a start that is good enough
    chords_within: in tolerances, dimensionless; from a residual below this, chord steps take the place of Newton steps
        as long as they are worth it, with quadratic elements. They stop just below the tolerance, where a Newton step
        would have gone far beyond: torque is then within 0.003 % of the converged one, without them within 0.0004 %
    """

    tolerance: float = 2e-4
    most_iterations: int = 40
    smallest_step: float = 1.0 / 1024
    always_step: bool = True
    chords_within: float = 0.0


@dataclass(frozen=True)
class NewtonRecord:
    """residuals: relative, after every iteration and its chord steps; steps: fraction of the Newton step it took."""

    residuals: tuple[float, ...]
    steps: tuple[float, ...]

    @property
    def iterations(self) -> int:
        """How many steps it took, chord steps not counted."""
        return len(self.residuals)


def newton(
    start: np.ndarray,
    scale: float,
    residual: Residual,
    direction: Callable[[np.ndarray, np.ndarray], np.ndarray],
    settings: NewtonSettings = NewtonSettings(),
    again: Callable[[np.ndarray], np.ndarray] | None = None,
) -> tuple[np.ndarray, NewtonRecord]:
    """Potential u [Wb/m], (n,), with residual(u) = 0, and the record of how it was found.

    start: first guess [Wb/m], (n,);  scale: size of the load that the residual is compared with [A]
    residual(u) -> [A], (n,);  direction(u, residual) -> Newton step [Wb/m], (n,)
    again(residual) -> step [Wb/m], (n,), with the tangent of the last Newton step, where that is much cheaper
    The first step is taken whole whatever the residual does (from zero field it always grows in saturated iron); later
    ones are halved until the residual falls. Where ``again`` is given, such chord steps, which cost a fifth and divide
    the residual by some three, take the place of the last Newton steps, and one more follows at the end, if the
    residual falls by it. The record is that of the Newton steps, each with the chord steps after it.
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
        if again is not None:
            u, r = _chords(u, r, settings.tolerance * scale, settings.chords_within, residual, again)
        size = float(np.linalg.norm(r) / scale)
        residuals.append(size)
        steps.append(step)
    if again is not None and residuals:
        u, r = _closer(u, r, residual, again)
    return u, NewtonRecord(tuple(residuals), tuple(steps))


def _chords(
    u: np.ndarray, r: np.ndarray, wanted: float, within: float, residual: Residual, again: Residual
) -> tuple[np.ndarray, np.ndarray]:
    """Field [Wb/m] and residual [A], (n,) each, after steps with the last tangent, as long as these are worth it.

    wanted: residual to come below [A]; within: times it from which on they are tried
    """
    before, size = inf, float(np.linalg.norm(r))
    while wanted < size < min(within * wanted, _WORTH * before):
        before = size
        u, r = _closer(u, r, residual, again)
        size = float(np.linalg.norm(r))
    return u, r


def _closer(u: np.ndarray, r: np.ndarray, residual: Residual, again: Residual) -> tuple[np.ndarray, np.ndarray]:
    """Field [Wb/m] and residual [A], (n,) each, after a step with the last tangent, if the residual falls by it."""
    other = u + again(r)
    trial = residual(other)
    return (other, trial) if np.linalg.norm(trial) < np.linalg.norm(r) else (u, r)


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
