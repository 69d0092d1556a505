"""A wound machine turned through 60 electrical degrees without current and at its full current, phase by phase."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2

import numpy as np

from electrical.driven_machine import DrivenMachine
from electrical.performance import Performance
from geometry.parts import DrawnMachine
from magnetostatics.case import FieldCase
from magnetostatics.flux_map import map_angles
from magnetostatics.flux_map_stage import kept_model
from magnetostatics.probes import probe_reader
from magnetostatics.turn import Supply, Turned, read_turn, solved_turn
from tasks import Workers

STEPS = 48  # over 60 electrical degrees: 16 in a period of the cogging of 9 slots and 8 poles


@dataclass(frozen=True, eq=False)
class TurningMachine:
    """idle, full: without current, and at the full current with the most torque.

    probes: names; flux_density: at full current [T], (angles, probes)
    """

    idle: Turned
    full: Turned
    probes: tuple[str, ...]
    flux_density: np.ndarray

    def largest(self, probe: str) -> float:
        """Largest mean flux density [T] across the probes whose name begins so, over the angles."""
        where = [name.startswith(probe) for name in self.probes]
        return float(self.flux_density[:, where].max())


@dataclass(frozen=True)
class TurnTask:
    """A machine with its supply; active_length [m]."""

    case: FieldCase
    machine: DrawnMachine
    supply: Supply
    active_length: float


@dataclass(frozen=True, eq=False)
class ProbedTurn:
    """turned; probes: names; flux_density: of them [T], (angles, probes)"""

    turned: Turned
    probes: tuple[str, ...]
    flux_density: np.ndarray


def turning_stage(case: FieldCase, driven: DrivenMachine, performance: Performance, workers: Workers) -> TurningMachine:
    """Solve both turns; a task is one of them. Raises FieldSolutionError."""
    supplies = {"idle": Supply(0.0, 0.0, driven.wound.equivalent_turns), "full": full_supply(driven, performance)}
    tasks = {
        name: TurnTask(case, driven.wound.machine, supply, driven.wound.active_length)
        for name, supply in supplies.items()
    }
    found = workers.map("turning", solve_turn, tasks)
    return TurningMachine(found["idle"].turned, found["full"].turned, found["full"].probes, found["full"].flux_density)


def full_supply(driven: DrivenMachine, performance: Performance) -> Supply:
    """The full current at which the torque is largest."""
    full = performance.full
    return Supply(driven.limits.current_peak, atan2(-full.direct, full.quadrature), driven.wound.equivalent_turns)


def solve_turn(task: TurnTask) -> ProbedTurn:
    """Over 60 electrical degrees from the d axis on the axis of phase A on."""
    model = kept_model(task.case, task.machine)
    reader, angles = probe_reader(model), map_angles(model, STEPS)
    solutions = solved_turn(model, task.supply, angles)
    flux = np.array([list(reader.read(one).values()) for one in solutions])
    return ProbedTurn(read_turn(solutions, task.supply.turns, task.active_length), reader.names, flux)
