"""A turning machine piece by piece: neighbouring rotor angles, each solved from the field of the one before.

An arc is a task, so that several workers share a turn; its angles stay together because a start at hand saves half of
the iterations.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geometry.parts import DrawnMachine
from magnetostatics.case import FieldCase
from magnetostatics.model import FieldModel, FieldSolution, OperatingPoint
from magnetostatics.positions import null_angle

_TOGETHER = 12  # angles of an arc


@dataclass(frozen=True)
class Arc:
    """Some neighbouring rotor angles [rad] of a machine."""

    case: FieldCase
    machine: DrawnMachine
    angles: tuple[float, ...]

    def model(self) -> FieldModel:
        """Of the machine on the mesh of the sweep."""
        return self.case.model(self.machine)


def arcs(case: FieldCase, machine: DrawnMachine, angles: Sequence[float]) -> dict[str, Arc]:
    """Rotor angles [rad] in their order, as tasks by name."""
    firsts = range(0, len(angles), _TOGETHER)
    return {f"arc {k}": Arc(case, machine, tuple(angles[k : k + _TOGETHER])) for k in firsts}


def angles_from_null(case: FieldCase, machine: DrawnMachine, span: float, steps: int) -> list[float]:
    """Evenly over a span [rad] from the null position on, its end left out [rad]."""
    return (null_angle(machine, case.layout(machine)) + span * np.arange(steps) / steps).tolist()


def solved_over(
    model: FieldModel, angles: Sequence[float], density: float, packing: float, start: FieldSolution | None = None
) -> list[FieldSolution]:
    """The current on the q axis at each of the angles [rad]; density: its amplitude in the copper [A/m^2].

    packing: copper share of the slot; start: of the first angle, None where nothing is at hand
    """
    solved: list[FieldSolution] = []
    for angle in angles:
        point = OperatingPoint(angle, density, 0.0, packing)
        solved.append(model.solve(point, start=solved[-1] if solved else start))
    return solved
