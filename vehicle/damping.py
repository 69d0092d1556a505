"""Damper characteristics at the wheel as tables, and what can be made of them: mixed, capped, limited.

A damping strategy of the actuator is such a curve: ``maximum``, ``minimum``, ``mixed(rebound=maximum, bump=minimum)``,
each ``capped`` at the regenerative damping.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from vehicle.errors import VehicleError, require_positive
from vehicle.tables import read_columns

_AT_REST = 1e-9  # of the largest force: what counts as no force


@dataclass(frozen=True)
class DamperCurve:
    """Force over velocity, straight between the points; rebound (extension) is positive, bump negative.

    velocity [m/s], rising; force [N], never with the sign against the velocity, zero at rest; source: where from.
    Valid between the first and the last velocity; a simulation that leaves them is refused.
    Raises VehicleError for a table that is not rising in velocity, not passive, or not finite.
    """

    name: str
    velocity: tuple[float, ...]
    force: tuple[float, ...]
    source: str

    def __post_init__(self) -> None:
        v, f = np.array(self.velocity, dtype=float), np.array(self.force, dtype=float)
        if v.ndim != 1 or v.shape != f.shape or v.size < 2 or not (np.isfinite(v).all() and np.isfinite(f).all()):
            raise VehicleError(
                f"damper curve '{self.name}': expected as many finite forces as velocities, two or more, found "
                f"{f.size} and {v.size}; complete the table"
            )
        falling = np.flatnonzero(np.diff(v) <= 0)
        if falling.size:
            k = falling[0]
            raise VehicleError(
                f"damper curve '{self.name}': velocities must rise from row to row, found {v[k + 1]:g} m/s after "
                f"{v[k]:g} m/s; sort the table and remove doubles"
            )
        if not (v[0] < 0 < v[-1]) or abs(np.interp(0.0, v, f)) > _AT_REST * np.abs(f).max() or (v * f < 0).any():
            raise VehicleError(
                f"damper curve '{self.name}': a damper needs velocities on both sides of zero, no force at rest and "
                "never a force along the motion; correct the table"
            )

    def at(self, velocity: float | np.ndarray) -> np.ndarray:
        """Force [N] at the velocity [m/s], of its shape."""
        return np.asarray(np.interp(velocity, self.velocity, self.force))

    @property
    def steepest(self) -> float:
        """Largest slope of the curve [Ns/m]."""
        return float(np.max(np.diff(self.force) / np.diff(self.velocity)))

    @property
    def largest_damping(self) -> float:
        """Largest ratio of force and velocity c = F / v [Ns/m]; at rest the slope stands for it."""
        v, f = np.array(self.velocity), np.array(self.force)
        at_rest = np.interp([-_SMALL, _SMALL], v, f) / np.array([-_SMALL, _SMALL])
        moving = np.abs(v) > _SMALL
        return float(max(np.max(f[moving] / v[moving]), at_rest.max()))


_SMALL = 1e-6  # m/s, beside zero


def read_damper_curve(path: Path, name: str) -> DamperCurve:
    """Curve from a CSV file with the columns velocity_m_per_s and force_N."""
    velocity, force = read_columns(path, "velocity_m_per_s", "force_N")
    return DamperCurve(name, velocity, force, source=Path(path).name)


def linear_damper(damping: float, name: str, fastest: float = 10.0) -> DamperCurve:
    """F = c v up to the fastest velocity [m/s]; damping: c [Ns/m]."""
    require_positive(f"damper curve '{name}'", damping=damping, fastest=fastest)
    return DamperCurve(name, (-fastest, fastest), (-damping * fastest, damping * fastest), f"linear, {damping:g} Ns/m")


def mixed(*, rebound: DamperCurve, bump: DamperCurve, name: str = "mixed") -> DamperCurve:
    """One curve in rebound, another one in bump (thesis, text to Table 3.4)."""
    points = [(v, f) for v, f in zip(bump.velocity, bump.force, strict=True) if v < 0] + [(0.0, 0.0)]
    points += [(v, f) for v, f in zip(rebound.velocity, rebound.force, strict=True) if v > 0]
    source = f"rebound of '{rebound.name}', bump of '{bump.name}'"
    velocity, force = zip(*points, strict=True)
    return DamperCurve(name, velocity, force, source)


def capped(curve: DamperCurve, maximum_damping: float) -> DamperCurve:
    """The curve with |F| <= c_max |v|: what a machine with the regenerative damping c_max can follow.

    Thesis, text to Table 3.4, limits "the slope"; here it is the damping F/v, which is what eq. 3.94 bounds.
    maximum_damping: c_max [Ns/m]
    """
    require_positive(f"cap of damper curve '{curve.name}'", maximum_damping=maximum_damping)
    return bounded(curve, lambda v: maximum_damping * np.abs(v), (0.0,), f"F/v up to {maximum_damping:g} Ns/m")


def bounded(
    curve: DamperCurve, bound: Callable[[np.ndarray], np.ndarray], knots: tuple[float, ...], note: str
) -> DamperCurve:
    """The curve with |F| <= bound(v); exact, since the points where the two cross are added.

    bound: force [N], (n,), over velocity [m/s], (n,), straight between the knots [m/s]
    """
    v = np.unique([*curve.velocity, *(k for k in knots if curve.velocity[0] < k < curve.velocity[-1]), 0.0])
    excess = np.abs(curve.at(v)) - bound(v)
    here, there = excess[:-1], excess[1:]
    across = here * there < 0
    crossing = v[:-1][across] + np.diff(v)[across] * (here / np.where(across, here - there, 1))[across]
    v = np.union1d(v, crossing)
    force = np.sign(v) * np.minimum(np.abs(curve.at(v)), bound(v))
    return replace(curve, velocity=tuple(v), force=tuple(force), source=f"{curve.source}; {note}")
