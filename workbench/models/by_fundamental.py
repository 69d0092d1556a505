"""What the benches of machines that are solved by their field have in common: columns by phase, and the kinds of
measurement that are answered by the fundamentals, as a dq machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from effects.base import Columns
from effects.dq_design import DqMachine
from workbench.errors import WorkbenchError
from workbench.models.dq.model import BASE as DQ

PHASES = "abc"

Found = dict[str, np.ndarray]
A = TypeVar("A")


@dataclass(frozen=True, eq=False)
class Drag:
    """What brakes the rotor, as a law of the dq machine; torque: on the rotor at columns [Nm] (n,)"""

    torque: Callable[[Mapping[str, np.ndarray]], np.ndarray]

    def lost_torque(self, speed: np.ndarray, torque: np.ndarray) -> np.ndarray:
        """What does not arrive at the shaft [Nm], of the shape of both: speed [rad/s], torque [Nm]."""
        return -self.torque({"speed": speed})


def by_its_fundamental(
    kind: str, machine_of: Callable[[A], DqMachine], resistance: Callable[[A, Columns], np.ndarray]
) -> Callable[[A, Columns], Found]:
    """The answer of the dq model to a kind of measurement.

    machine_of: the dq machine of a design's answers; resistance: of a phase at columns [ohm] (n,)
    """

    def answer(answers: A, at: Columns) -> Found:
        machine = machine_of(answers)
        state = {name: values for name, values in at.items() if name not in ("winding_T", "magnet_T")}
        warm = resistance(answers, at) / machine.resistance
        return DQ.respond(machine, kind, state | {"resistance_factor": warm})

    return answer


def by_phase(quantity: str, rows: np.ndarray) -> Found:
    """A column for each phase; rows: (n, 3), in the unit of the quantity."""
    return {f"{quantity}_{x}": rows[:, k] for k, x in enumerate(PHASES)}


def phase_currents(at: Columns) -> np.ndarray:
    """Of all phases [A] (n, 3). Raises WorkbenchError where a column is missing."""
    missing = [f"i_{x}" for x in PHASES if f"i_{x}" not in at]
    if missing:
        raise WorkbenchError(f"a loaded row needs the currents of all phases: the column {missing[0]} is missing")
    return np.stack([at[f"i_{x}"] for x in PHASES], axis=1)
