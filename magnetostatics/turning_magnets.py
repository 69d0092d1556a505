"""The magnets of a turning rotor under several currents; a task is one rotor angle with all of them.

A machine drives and brakes, both ways round: each current counts with its mirror image on the q axis.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import pi

import numpy as np

from geometry.parts import DrawnMachine
from magnetostatics.case import FieldCase
from magnetostatics.demagnetisation import MagnetFlux, MagnetMap, magnet_flux, magnet_map
from magnetostatics.flux_map import map_angles, operating_point
from tasks import Workers

Current = tuple[float, float]  # (i_d, i_q)


@dataclass(frozen=True)
class MagnetTask:
    """The magnets at one rotor angle [rad] under several currents.

    currents: (i_d, i_q), ampere-turns of a coil [A peak]; knee: flux density along the magnetisation [T]
    """

    case: FieldCase
    machine: DrawnMachine
    angle: float
    currents: tuple[Current, ...]
    knee: float


@dataclass(frozen=True, eq=False)
class SolvedMagnets:
    """What they show there, in the order of the currents.

    smallest: of the magnets of the sector, at the points of one [T], (n, Q, E); lost: share below the knee, (n,)
    """

    smallest: np.ndarray
    lost: np.ndarray


@dataclass(frozen=True, eq=False)
class TurningMagnets:
    """The magnets under one current, or its mirror image, over a turn of the rotor.

    turn: one magnet, the smallest over the turn; lost: share of all below the knee at the worst angle alone
    angle: that angle, mechanical [rad]; current: (i_d, i_q) there, ampere-turns of a coil [A peak]
    """

    turn: MagnetFlux
    lost: float
    angle: float
    current: Current


def turning_magnets(
    case: FieldCase, machine: DrawnMachine, currents: Iterable[Current], knee: float, angles: int, workers: Workers
) -> list[TurningMagnets]:
    """The magnets under each of the currents, on the finer mesh.

    currents: (i_d, i_q), ampere-turns of a coil [A peak]; knee: flux density along the magnetisation [T]
    angles: number of rotor angles over 60 electrical degrees
    """
    wanted, model = list(currents), case.detailed_model(machine)
    senses = tuple(dict.fromkeys(sense for one in wanted for sense in _senses(one)))
    turn = map_angles(model, angles).tolist()
    tasks = {f"angle {k}": MagnetTask(case, machine, angle, senses, knee) for k, angle in enumerate(turn)}
    solved = list(workers.map("magnets", solve_magnets, tasks).values())
    areas = model.magnet_elements(0).weights
    rows = [[senses.index(sense) for sense in _senses(one)] for one in wanted]
    return [_over_a_turn(some, senses, turn, solved, areas) for some in rows]


def solve_magnets(task: MagnetTask) -> SolvedMagnets:
    """All currents at one rotor angle, each from the field of the one before."""
    model, solution = task.case.detailed_model(task.machine), None
    smallest, lost = [], []
    for i_d, i_q in task.currents:
        solution = model.solve(operating_point(model, task.angle, i_d, i_q), start=solution)
        seen = magnet_flux(solution)
        smallest.append(seen.smallest)
        lost.append(seen.share_below(task.knee))
    return SolvedMagnets(np.array(smallest), np.array(lost))


def magnet_maps(case: FieldCase, machine: DrawnMachine, seen: TurningMagnets) -> tuple[MagnetMap, MagnetMap]:
    """For drawing: one magnet over the turn, upright, and all of the sector at the worst angle."""
    model = case.detailed_model(machine)
    solution = model.solve(operating_point(model, seen.angle, *seen.current))
    return magnet_map(model, seen.turn, pi / 2), magnet_map(model, magnet_flux(solution), seen.angle)


def _senses(current: Current) -> tuple[Current, ...]:
    """A current and its mirror image, once where they are one."""
    i_d, i_q = current
    return tuple(dict.fromkeys(((i_d, i_q), (i_d, -i_q))))


def _over_a_turn(
    rows: list[int],
    senses: Sequence[Current],
    turn: Sequence[float],
    solved: Sequence[SolvedMagnets],
    areas: np.ndarray,
) -> TurningMagnets:
    """Of what was solved at the angles of a turn the rows of one current and its mirror image.

    The worst angle is the one where most is lost, and where nothing is, the one with the smallest flux density.
    """
    smallest = np.stack([one.smallest[rows] for one in solved])
    lost = np.stack([one.lost[rows] for one in solved])
    worst = np.lexsort((smallest.min(axis=(2, 3)).ravel(), -lost.ravel()))[0]
    angle, sense = divmod(int(worst), len(rows))
    turn_of_one = MagnetFlux(smallest.min(axis=(0, 1))[None], areas)
    return TurningMagnets(turn_of_one, float(lost.max()), turn[angle], senses[rows[sense]])
