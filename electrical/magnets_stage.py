"""What the currents of the wound machine do to its magnets: how much of them goes beyond the knee for good.

Each state is solved over 60 electrical degrees of the rotor with the grade's magnets at the temperature at which their
coercivity is smaller (hot, but cold for ferrites). What counts is the volume that goes beyond the knee somewhere in a
turn: a magnet does not get it back, and a fault may come at any angle. The first check of a magnet, by local B on its
straight recoil line; see ``magnetostatics.demagnetisation`` and ``materials.magnet_grade``.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from electrical.braking import Braking
from electrical.braking_stage import BrakingOutcome
from electrical.flux_map_machine import FluxMapMachine
from electrical.sudden_short_circuit import first_peak
from electrical.winding_stage import WindingOutcome
from electrical.wound_machine import WoundMachine
from geometry.machine import Machine
from magnetostatics.case import FieldCase
from magnetostatics.demagnetisation import MagnetFlux, MagnetMap, magnet_flux, magnet_map
from magnetostatics.flux_map import map_angles, operating_point
from magnetostatics.flux_map_stage import FluxMap
from magnetostatics.model import FieldModel
from materials.magnet_grade import MagnetGrade
from tasks import Workers

ANGLES = 10  # over 60 electrical degrees, each seen by every magnet of the sector at another place
# Currents against the magnets, over the overload current, between which the demagnetising one is interpolated.
_AGAINST = (0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0)

NO_LOAD, OVERLOAD = "no load", "overload, on the q axis"
STEADY, SUDDEN = "shorted, steady", "shorted at full speed, first peak"
FAULT = "overload, against the magnets"

Current = tuple[float, float]  # (i_d, i_q), peak [A]


@dataclass(frozen=True)
class MagnetInputs:
    """The magnets and what they must stand.

    grade: of the magnets; cold, hot: between which temperatures they work [degC]
    lost_max: share of their volume that may go beyond the knee
    """

    grade: MagnetGrade
    cold: float
    hot: float
    lost_max: float


@dataclass(frozen=True)
class MagnetState:
    """The magnets under one current, over a turn of the rotor; a current off the d axis in both senses.

    i_d, i_q: peak phase currents [A]
    least: smallest flux density along the magnetisation [T]; exceeded: by all but the allowed share of the volume [T]
    lost: share of the volume beyond the knee somewhere in a turn; lost_at_once: share at the worst angle alone
    angle: that rotor angle, mechanical [rad]
    """

    name: str
    i_d: float
    i_q: float
    least: float
    exceeded: float
    lost: float
    lost_at_once: float
    angle: float


@dataclass(frozen=True, eq=False)
class MagnetsOutcome:
    """Which states the magnets stand.

    inputs: grade, temperatures and limit; temperature: of the two that is worse [degC]; knee: of the grade there [T]
    states: no load first; demagnetising_current: against the magnets, at which the allowed share of their volume goes
        beyond the knee, peak [A]; 0 where it does without current, infinite where it does not up to largest_current [A]
    peak_in_map: whether the first peak of a sudden short circuit lies in the flux map that it was followed on
    turn: one magnet in the worst state, the smallest over a turn; at_once: all magnets of the machine's sector at that
        state's worst angle
    """

    inputs: MagnetInputs
    temperature: float
    knee: float
    states: tuple[MagnetState, ...]
    demagnetising_current: float
    largest_current: float
    peak_in_map: bool
    turn: MagnetMap
    at_once: MagnetMap

    @property
    def worst(self) -> MagnetState:
        """The state with the smallest margin."""
        return min(self.states, key=self.margin)

    @property
    def lost(self) -> float:
        """Share of the magnets' volume beyond the knee in the state where it is largest."""
        return max(state.lost for state in self.states)

    def margin(self, state: MagnetState) -> float:
        """Flux density [T] between the knee and what all but the allowed share of the volume exceeds."""
        return state.exceeded - self.knee


@dataclass(frozen=True)
class MagnetTask:
    """The magnets at one rotor angle [rad] under several currents; knee: of their grade [T].

    currents: (i_d, i_q), ampere-turns of a coil [A peak]
    """

    case: FieldCase
    machine: Machine
    angle: float
    currents: tuple[Current, ...]
    knee: float


@dataclass(frozen=True, eq=False)
class SolvedMagnets:
    """What they show there, in the order of the currents.

    smallest: of the magnets of the sector, at the points of one [T], (n, Q, E); lost: share beyond the knee, (n,)
    """

    smallest: np.ndarray
    lost: np.ndarray


@dataclass(frozen=True, eq=False)
class TurningMagnets:
    """The magnets under one current, or its mirror image, over a turn of the rotor.

    turn: one magnet, the smallest over the turn; lost: share beyond the knee at the worst angle alone
    angle: that angle, mechanical [rad]; current: (i_d, i_q) there, of the two senses the worse [A]
    """

    turn: MagnetFlux
    lost: float
    angle: float
    current: Current


def magnets_stage(
    case: FieldCase,
    flux_map: FluxMap,
    winding: WindingOutcome,
    braking: BrakingOutcome,
    inputs: MagnetInputs,
    workers: Workers,
) -> MagnetsOutcome:
    """Solve the magnets under no load, overload, both short circuits and a controller's fault; a task is one angle.

    Raises MaterialError where the grade has nothing left at its temperatures, FieldSolutionError when a current does
    not converge.
    """
    wound, largest = winding.wound, winding.limits.current_peak
    temperature = inputs.grade.weaker_of(inputs.cold, inputs.hot)
    knee, case = inputs.grade.knee_at(temperature), with_grade(case, inputs.grade, temperature)
    machine = wound.on_map(flux_map.data).with_resistance(wound.phase_resistance * braking.heat.cold_resistance)
    named = currents_of(machine, largest, braking.cold)
    against = [(-share * largest, 0.0) for share in _AGAINST]
    model = case.detailed_model(wound.machine)
    seen = _solved(case, model, wound, [*named.values(), *against], knee, workers)
    states = tuple(_state(name, one, seen[one], knee, inputs.lost_max) for name, one in named.items())
    worst = seen[named[min(states, key=lambda state: state.exceeded).name]]
    return MagnetsOutcome(
        inputs,
        temperature,
        knee,
        states,
        demagnetising_current(against, [seen[one].turn.exceeded(inputs.lost_max) for one in against], knee),
        -against[-1][0],
        bool(machine.holds(*named[SUDDEN])),
        magnet_map(model, worst.turn, 0.0),
        magnet_map(model, _flux_at(model, worst.angle, wound.turns, worst.current), worst.angle),
    )


def currents_of(machine: FluxMapMachine, largest: float, shorted: Braking) -> dict[str, Current]:
    """The currents that the magnets must stand, by name.

    machine: with the resistance of the cold copper, with which short circuits are strongest; largest: overload current,
    peak [A]; shorted: steady states of the same machine over the speed, the last the fastest
    """
    starts = ((0.0, -largest), (0.0, largest))  # braking and motoring
    peaks = [first_peak(machine, float(shorted.speed[-1]), *start) for start in starts]
    return {
        NO_LOAD: (0.0, 0.0),
        OVERLOAD: (0.0, largest),
        STEADY: steady_current(machine, shorted),
        SUDDEN: min(peaks),
        FAULT: (-largest, 0.0),
    }


def steady_current(machine: FluxMapMachine, shorted: Braking) -> Current:
    """The steady state with shorted phases that has most current against the magnets.

    Where the speeds lead out of the map it is the current that leaves no flux, on the d axis: the limit at high speed,
    which no steady state exceeds.
    """
    if np.isnan(shorted.i_d).any():
        i_d, i_q, _ = machine.continued_currents(0.0, 0.0)
        return float(i_d), float(i_q)
    worst = int(np.argmin(shorted.i_d))
    return float(shorted.i_d[worst]), float(shorted.i_q[worst])


def with_grade(case: FieldCase, grade: MagnetGrade, temperature: float) -> FieldCase:
    """The case with the magnets of a grade at a temperature [degC], magnetised as they were."""
    made = grade.magnet_at(temperature)
    return replace(
        case, materials=case.materials.with_magnets(lambda magnet: replace(made, axis_error=magnet.axis_error))
    )


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


def demagnetising_current(against: Sequence[Current], exceeded: Sequence[float], knee: float) -> float:
    """The current [A] against the magnets at which the flux density that all but a share exceeds falls to the knee.

    against: currents against the magnets, each larger than the one before [A]; exceeded: flux densities there [T]
    knee: [T]. Linear between; infinite where it is not reached, 0 where it is without current.
    """
    falling = np.minimum.accumulate(exceeded)
    if falling[-1] > knee:
        return inf
    return float(np.interp(-knee, -falling, [-i_d for i_d, _ in against]))


def _solved(
    case: FieldCase, model: FieldModel, wound: WoundMachine, currents: Iterable[Current], knee: float, workers: Workers
) -> dict[Current, TurningMagnets]:
    """The magnets under each current [A] and its mirror image: a machine drives and brakes, both ways round."""
    wanted = tuple(dict.fromkeys(currents))
    senses = tuple(dict.fromkeys(sense for one in wanted for sense in _senses(one)))
    ampere_turns = tuple((wound.turns * i_d, wound.turns * i_q) for i_d, i_q in senses)
    angles = map_angles(model, ANGLES).tolist()
    tasks = {f"angle {k}": MagnetTask(case, wound.machine, at, ampere_turns, knee) for k, at in enumerate(angles)}
    solved = list(workers.map("magnets", solve_magnets, tasks).values())
    areas = model.magnet_elements(0).weights
    return {one: _turning(one, senses, angles, solved, areas) for one in wanted}


def _turning(
    current: Current,
    senses: tuple[Current, ...],
    angles: Sequence[float],
    solved: Sequence[SolvedMagnets],
    areas: np.ndarray,
) -> TurningMagnets:
    rows = [senses.index(sense) for sense in _senses(current)]
    smallest = np.min([one.smallest[rows].min(axis=0) for one in solved], axis=0)
    lost = np.array([one.lost[rows] for one in solved])
    angle, sense = divmod(int(np.argmax(lost)), len(rows))
    return TurningMagnets(MagnetFlux(smallest[None], areas), float(lost.max()), angles[angle], senses[rows[sense]])


def _senses(current: Current) -> tuple[Current, ...]:
    """A current and its mirror image on the q axis, once where they are one."""
    i_d, i_q = current
    return tuple(dict.fromkeys(((i_d, i_q), (i_d, -i_q))))


def _state(name: str, current: Current, seen: TurningMagnets, knee: float, allowed: float) -> MagnetState:
    turn = seen.turn
    return MagnetState(
        name, *current, turn.least, turn.exceeded(allowed), turn.share_below(knee), seen.lost, seen.angle
    )


def _flux_at(model: FieldModel, angle: float, turns: int, current: Current) -> MagnetFlux:
    i_d, i_q = current
    return magnet_flux(model.solve(operating_point(model, angle, turns * i_d, turns * i_q)))
