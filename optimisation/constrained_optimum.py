"""Largest torque of a cross-section under a flux-density limit, refined with the field solver beyond any grid.

Around the current point both torque and limited flux density are fitted by quadratics in (back-iron width, rotor
radius) to nine field solutions in a trust box; the constrained maximum of the quadratics is the next point; the box
moves when the maximum lies on its edge and shrinks otherwise. The nine designs move one mesh, so that they differ by
their dimensions alone. At the end the machine is meshed anew and a last step in the width puts the limit to its
tolerance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import nan

import numpy as np
from scipy.optimize import minimize

from geometry.errors import GeometryError
from geometry.family import Combination
from geometry.machine import Machine
from optimisation.design import Design, DesignSolver, Judge
from units import MILLIMETRE

_FIRST_BOX = (0.06, 0.045)  # half widths of the trust box relative to (w_bi, R_ro)
_LAST_BOX = (0.02, 0.015)
_BOX = (
    (0, 0),
    (1, 0),
    (1, 1),
    (0, 1),
    (-1, 1),
    (-1, 0),
    (-1, -1),
    (0, -1),
    (1, -1),
)  # the centre, which is meshed, first
_SHRINK = 1 / 3
_MOST_ROUNDS = 8
_LIMIT_TOLERANCE = 2e-4  # relative, of the limited flux density at the optimum
_MOST_CORRECTIONS = 6


class NoOptimumError(ValueError):
    """No design of the family holds the limit, or the search did not settle; the message says which."""


@dataclass(frozen=True)
class BestDesign:
    """The design of the largest torque, whether the limit binds, and how many designs were solved."""

    design: Design
    limit_binds: bool
    solves: int


@dataclass
class _Search:
    """Field solutions by (width, radius) for one combination and stator radius; every point is solved once."""

    solver: DesignSolver
    combination: Combination
    stator_outer_radius: float
    limit: float
    known: dict[tuple[float, float], Design | None] = field(default_factory=dict)
    solves: int = 0  # before the last new mesh

    @property
    def all_solves(self) -> int:
        return self.solves + len(self.known)

    def design(self, width: float, radius: float) -> Design | None:
        """The judged design, None when it cannot be built."""
        key = (float(width), float(radius))
        if key not in self.known:
            try:
                self.known[key] = self.solver.design(self._machine(*key))
            except GeometryError:
                self.known[key] = None
        return self.known[key]

    def _machine(self, width: float, radius: float) -> Machine:
        return self.solver.judge.case.family.machine(
            self.combination,
            stator_outer_radius=self.stator_outer_radius,
            back_iron_width=width,
            rotor_outer_radius=radius,
        )

    def start_anew(self) -> None:
        """Mesh the next design anew and solve every point again."""
        self.solver.mesh_anew()
        self.solves += len(self.known)
        self.known.clear()


def find_optimum(
    judge: Judge,
    combination: Combination,
    stator_outer_radius: float,
    limit: float,
    start: tuple[float, float],
) -> BestDesign:
    """Largest torque with the limited flux density at most ``limit`` [T].

    judge: its objective says which torque; stator_outer_radius [m]
    start: (back-iron width, rotor radius) [m], for example ``DesignMap.best_point``
    Returns the best design with the limit held to 0.02 %.
    Raises NoOptimumError.
    """
    search = _Search(DesignSolver(judge), combination, stator_outer_radius, limit)
    point, box = np.array(start), np.array(_FIRST_BOX)
    for _ in range(_MOST_ROUNDS):
        target, on_edge = _round(search, point, box * point)
        point = target
        if on_edge:
            continue
        if np.all(box <= np.array(_LAST_BOX) * 1.001):
            return _settle(search, point)
        box = np.maximum(box * _SHRINK, _LAST_BOX)
    return _settle(search, point)


def _round(search: _Search, centre: np.ndarray, half: np.ndarray) -> tuple[np.ndarray, bool]:
    """Constrained maximum of the quadratics around a centre, and whether it lies on the edge of the box."""
    offsets = np.array(_BOX, dtype=float)
    designs = [search.design(*(centre + half * offset)) for offset in offsets]
    built = [k for k, design in enumerate(designs) if design is not None]
    if len(built) < 6:
        raise NoOptimumError(_where(search, centre) + "too few designs can be built to look for an optimum there")
    torque, limited = (_quadratic(offsets[built], [read(designs[k]) for k in built]) for read in (_torque, _limited))
    best = _maximise(torque, limited, search.limit)
    return centre + half * best, bool(np.any(np.abs(best) > 0.999))


def _torque(design: Design | None) -> float:
    return design.torque if design is not None else nan


def _limited(design: Design | None) -> float:
    return design.limited if design is not None else nan


def _terms(x: np.ndarray) -> np.ndarray:
    a, b = np.moveaxis(np.asarray(x, dtype=float), -1, 0)
    return np.stack([np.ones_like(a), a, b, a * a, a * b, b * b], axis=-1)


def _quadratic(offsets: np.ndarray, values: list[float]) -> np.ndarray:
    return np.linalg.lstsq(_terms(offsets), np.array(values), rcond=None)[0]


def _maximise(torque: np.ndarray, limited: np.ndarray, limit: float) -> np.ndarray:
    """argmax of one quadratic under another one's limit in the unit box; nearest approach when nothing is feasible."""
    scale = abs(torque[0])

    def room(x: np.ndarray) -> float:
        return (limit - _terms(x) @ limited) / limit

    allowed = {"type": "ineq", "fun": room}
    results = [
        minimize(
            lambda x: -(_terms(x) @ torque) / scale, start, method="SLSQP", bounds=[(-1, 1)] * 2, constraints=[allowed]
        )
        for start in ((0.0, 0.0), (1.0, 0.0), (0.5, -0.5), (0.5, 0.5))
    ]
    feasible = [r for r in results if room(r.x) > -1e-6]
    if not feasible:  # move towards the limit
        return minimize(lambda x: _terms(x) @ limited, (0.0, 0.0), bounds=[(-1, 1)] * 2).x
    return min(feasible, key=lambda r: r.fun).x


def _settle(search: _Search, point: np.ndarray) -> BestDesign:
    """Put the width on the limit (secant) where it binds, and return the design."""
    width, radius = point
    search.start_anew()
    design = _require(search, width, radius)
    if design.limited < search.limit * (1 - 5e-3):
        return BestDesign(design, False, search.all_solves)
    other_width = width * 1.01
    other = _require(search, other_width, radius)
    for _ in range(_MOST_CORRECTIONS):
        if abs(design.limited / search.limit - 1) < _LIMIT_TOLERANCE:
            return BestDesign(design, True, search.all_solves)
        slope = (other.limited - design.limited) / (other_width - width)
        other_width, other = width, design
        width = width + (search.limit - design.limited) / slope
        design = _require(search, width, radius)
    raise NoOptimumError(
        _where(search, point) + f"the limit of {search.limit:g} T could not be met by moving the back iron alone: "
        f"reached {design.limited:.4f} T; widen the sweep or change the limit"
    )


def _require(search: _Search, width: float, radius: float) -> Design:
    design = search.design(width, radius)
    if design is None:
        raise NoOptimumError(_where(search, (width, radius)) + "the optimum lies where no machine can be built")
    return design


def _where(search: _Search, point: Sequence[float] | np.ndarray) -> str:
    width, radius = (length / MILLIMETRE for length in point)
    return (
        f"{search.combination.words}, stator radius {search.stator_outer_radius / MILLIMETRE:g} mm, near back iron "
        f"{width:.3f} mm and rotor radius {radius:.3f} mm: "
    )
