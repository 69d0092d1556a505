"""What the currents of the wound machine do to its magnets: how much of them goes beyond the knee for good.

Each state is solved over 60 electrical degrees of the rotor with the grade's magnets at the temperature at which their
coercivity is smaller (hot, but cold for ferrites). What counts is the volume that goes beyond the knee somewhere in a
turn: a magnet does not get it back, and a fault may come at any angle. The first check of a magnet, by local B on its
straight recoil line; see ``magnetostatics.demagnetisation`` and ``materials.magnet_grade``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from electrical.braking import Braking
from electrical.braking_stage import BrakingOutcome
from electrical.flux_map_machine import FluxMapMachine
from electrical.sudden_short_circuit import first_peak
from electrical.winding_stage import WindingOutcome
from magnetostatics.case import FieldCase
from magnetostatics.demagnetisation import MagnetFlux, MagnetMap
from magnetostatics.flux_map_stage import FluxMap
from magnetostatics.turning_magnets import TurningMagnets, magnet_maps, turning_magnets
from materials.magnet_grade import MagnetGrade
from tasks import Workers
from units import MU_0

# Currents against the magnets, over the overload current, between which the demagnetising one is interpolated.
_AGAINST = (0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0)

NO_LOAD, OVERLOAD = "no load", "overload, on the q axis"
STEADY, SUDDEN = "shorted, steady", "shorted at full speed, first peak"
FAULT = "overload, against the magnets"

Current = tuple[float, float]  # (i_d, i_q), peak of a phase [A]


@dataclass(frozen=True)
class MagnetInputs:
    """The magnets and what they must stand.

    grade: of the magnets; cold, hot: between which temperatures they work [degC]
    lost_max: share of their volume that may go beyond the knee
    angles: of the rotor that are solved, over 60 electrical degrees
    """

    grade: MagnetGrade
    cold: float
    hot: float
    lost_max: float
    angles: int


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
    flux: of one magnet in the worst state, the smallest over a turn; turn: that to be drawn, upright
    at_once: all magnets of the sector at that state's worst angle
    """

    inputs: MagnetInputs
    temperature: float
    knee: float
    states: tuple[MagnetState, ...]
    demagnetising_current: float
    largest_current: float
    peak_in_map: bool
    flux: MagnetFlux
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

    @property
    def at_knee(self) -> float | None:
        """The demagnetising current [A] where there is one, None where none is needed or none is reached."""
        return self.demagnetising_current if 0 < self.demagnetising_current < inf else None

    @property
    def field_at_knee(self) -> float:
        """Field strength against the magnets at the knee [A/m]."""
        return self._opposing(self.knee)

    @property
    def opposing_field(self) -> float:
        """Field strength that all but the allowed share of the volume stays below in the worst state [A/m]."""
        return self._opposing(self.worst.exceeded)

    def _opposing(self, flux_density: float) -> float:
        """(B_r - B) / (mu_0 mu_r) [A/m] at a flux density along the magnetisation [T]."""
        magnet = self.inputs.grade.magnet_at(self.temperature)
        return (magnet.remanence - flux_density) / (MU_0 * magnet.recoil_permeability)

    def knee_off_by(self, relative: float) -> float:
        """The knee [T], were the opposing field in the worst state larger by a share of itself, dimensionless."""
        magnet = self.inputs.grade.magnet_at(self.temperature)
        return self.knee + relative * (magnet.remanence - self.worst.exceeded)

    def margin(self, state: MagnetState) -> float:
        """Flux density [T] between the knee and what all but the allowed share of the volume exceeds."""
        return state.exceeded - self.knee


def magnets_stage(
    case: FieldCase,
    flux_map: FluxMap,
    winding: WindingOutcome,
    braking: BrakingOutcome,
    inputs: MagnetInputs,
    workers: Workers,
) -> MagnetsOutcome:
    """Solve the magnets under no load, overload, both short circuits and a controller's fault.

    Raises MaterialError where the grade has nothing left at its temperatures, FieldSolutionError when a current does
    not converge.
    """
    wound, largest, grade = winding.wound, winding.limits.current_peak, inputs.grade
    machine = wound.on_map(flux_map.data).with_resistance(wound.phase_resistance * braking.heat.cold_resistance)
    named = currents_of(machine, largest, braking.cold)
    against = [(-share * largest, 0.0) for share in _AGAINST]
    temperature = grade.weaker_of(inputs.cold, inputs.hot)
    knee, case = grade.knee_at(temperature), with_grade(case, grade, temperature)
    ampere_turns = [wound.ampere_turns(*current) for current in (*named.values(), *against)]
    seen = turning_magnets(case, wound.machine, ampere_turns, knee, inputs.angles, workers)
    under, weakened = seen[: len(named)], seen[len(named) :]
    exceeded = [one.turn.exceeded(inputs.lost_max) for one in weakened]
    worst = min(under, key=lambda one: one.turn.exceeded(inputs.lost_max))
    return MagnetsOutcome(
        inputs,
        temperature,
        knee,
        tuple(_state(*one, found, knee, inputs.lost_max) for one, found in zip(named.items(), under, strict=True)),
        demagnetising_current([-i_d for i_d, _ in against], exceeded, knee),
        _AGAINST[-1] * largest,
        bool(machine.holds(*named[SUDDEN])),
        worst.turn,
        *magnet_maps(case, wound.machine, worst),
    )


def currents_of(machine: FluxMapMachine, largest: float, shorted: Braking) -> dict[str, Current]:
    """The currents that the magnets must stand, by name.

    They are those of the map's magnets, which are stronger than hot ones, so that a short circuit is rather too strong.
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


def demagnetising_current(against: Sequence[float], exceeded: Sequence[float], knee: float) -> float:
    """The current [A] against the magnets at which the flux density that all but a share exceeds falls to the knee.

    against: rising currents against the magnets, peak [A]; exceeded: flux densities [T] there; knee: [T]
    Linear between; infinite where it is not reached, 0 where it is without current.
    """
    falling = np.minimum.accumulate(exceeded)
    if falling[-1] > knee:
        return inf
    return float(np.interp(-knee, -falling, against))


def _state(name: str, current: Current, seen: TurningMagnets, knee: float, allowed: float) -> MagnetState:
    turn = seen.turn
    return MagnetState(
        name, *current, turn.least, turn.exceeded(allowed), turn.share_below(knee), seen.lost, seen.angle
    )
