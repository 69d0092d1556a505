"""What each lesson of a bench costs the design that was made without it.

The first design stays as it is: cross-section, winding, length and the currents of its peak and its continuous torque.
For each lesson alone its field is solved again at these two currents over the rotor angles of its flux map, so that
saturation is in the number; friction, resistance, iron loss and end leakage act by their laws.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from drivetrain.learned import IRON_LOSS, NOTHING_LEARNED, RESISTANCE, Learned, case_as_learned
from drivetrain.outcome import Outcome
from drivetrain.requirements import Requirements, Transmission
from electrical.dq import mtpa_currents
from electrical.final_length import ContinuousNeed
from electrical.winding_stage import WindingOutcome
from geometry.machine import Machine
from losses.stage import LossMap
from magnetostatics.case import FieldCase
from magnetostatics.flux_linkage import flux_linkage_torque
from magnetostatics.flux_map import map_angles, operating_point
from magnetostatics.flux_map_stage import FluxMap, kept_model
from tasks import Workers
from thermal.stage import HeatOutcome

AS_DESIGNED, ALL_TOGETHER = "as it was designed", "all together"


@dataclass(frozen=True, eq=False)
class FirstDesign:
    """The design that was made before anything was learned: inputs and artefacts of its run.

    continuous: what its length for good was made by; heat: its temperatures
    losses: None where the study has no loss data
    """

    case: FieldCase
    flux_map: FluxMap
    winding: WindingOutcome
    outcome: Outcome
    required: Requirements
    transmission: Transmission
    continuous: ContinuousNeed
    heat: HeatOutcome
    losses: LossMap | None

    @property
    def continuous_current(self) -> float:
        """For good, peak of a phase [A]: of the density that is stated, else of the temperatures at the RMS speed."""
        density = self.continuous.density
        return self.heat.at_speed.current if density is None else self.winding.wound.current_peak(density)

    @property
    def warm_share(self) -> float:
        """Torque for good over that of the same current with magnets as they are mapped, dimensionless."""
        if self.continuous.density is not None:
            return 1.0
        machine = self.winding.wound.on_map(self.flux_map.data)
        return self.heat.at_speed.torque / float(machine.torque(*mtpa_currents(machine, self.continuous_current)))


@dataclass(frozen=True)
class LessonCost:
    """The first design under one lesson, or under all.

    peak_effort, continuous_effort: at the output, at rest [N or Nm]
    length: active length that would meet peak and continuous effort with its winding and currents [m]
    efficiency: at the RMS effort and speed that are asked, dimensionless, NaN without loss data
    """

    reason: str
    words: str
    peak_effort: float
    continuous_effort: float
    length: float
    efficiency: float


@dataclass(frozen=True)
class LessonCosts:
    """As designed, each lesson alone, all together."""

    rows: tuple[LessonCost, ...]


@dataclass(frozen=True)
class TorqueTask:
    """Mean torque at currents of a coil [A peak], (i_d, i_q) pairs, over ``angles`` rotor angles; active_length [m]."""

    case: FieldCase
    machine: Machine
    active_length: float
    currents: tuple[tuple[float, float], ...]
    angles: int


def lesson_costs_stage(first: FirstDesign, learned: Learned, workers: Workers) -> LessonCosts:
    """Solve the first design under each lesson; a task is one lesson.

    Raises FieldSolutionError when a current does not converge.
    """
    cases = _cases(learned)
    task = TorqueTask(
        first.case,
        first.winding.wound.dimensions,
        first.winding.wound.active_length,
        _ampere_turns(first),
        first.flux_map.data.sizes["angle"],
    )
    tasks = {
        f"{number} {name}": replace(task, case=case_as_learned(first.case, part))
        for number, (name, _, part) in enumerate(cases)
    }
    torques = workers.map("lessons", mean_torques, tasks).values()
    warm = first.warm_share
    rows = (
        _cost(name, words, part, first, (peak, warm * continuous))
        for (name, words, part), (peak, continuous) in zip(cases, torques, strict=True)
    )
    return LessonCosts(tuple(rows))


def _cases(learned: Learned) -> list[tuple[str, str, Learned]]:
    """(reason, words, what counts) of every row."""
    alone = [(one.reason, one.words, learned.alone(one)) for one in learned.lessons]
    return [(AS_DESIGNED, "", NOTHING_LEARNED), *alone, (ALL_TOGETHER, "", learned)]


def _ampere_turns(first: FirstDesign) -> tuple[tuple[float, float], ...]:
    """(i_d, i_q) of one coil [A peak] at the peak torque and at the continuous one."""
    wound, winding = first.winding.wound, first.winding
    machine = wound.on_map(first.flux_map.data)
    continuous = mtpa_currents(machine, first.continuous_current)
    peak = winding.direct_current, winding.quadrature_current
    return tuple(wound.ampere_turns(float(i_d), float(i_q)) for i_d, i_q in (peak, continuous))


def mean_torques(task: TorqueTask) -> tuple[float, ...]:
    """Mean torque of the first design at each current [Nm], less what the ends keep."""
    model = kept_model(task.case, task.machine)
    found = []
    for i_d, i_q in task.currents:
        points = [operating_point(model, float(angle), i_d, i_q) for angle in map_angles(model, task.angles)]
        found.append(float(np.mean([flux_linkage_torque(model.solve(point)) for point in points])))
    return tuple(task.case.kept * task.active_length * torque for torque in found)


def _cost(name: str, words: str, part: Learned, first: FirstDesign, torques: tuple[float, ...]) -> LessonCost:
    friction, ratio = part.friction, first.transmission.nominal
    peak, continuous = (friction.left(torque / ratio, 0.0, ratio) for torque in torques)
    length = _length(part, first, torques)
    return LessonCost(name, words, peak, continuous, length, _efficiency(part, first, torques[1]))


def _length(part: Learned, first: FirstDesign, torques: tuple[float, ...]) -> float:
    """Longest of the lengths that peak and continuous torque ask for [m]; torques: of the first design [Nm]."""
    asked, ratio = first.required, first.transmission.largest
    efforts = (asked.force_peak, asked.velocity_at_force_peak), (asked.force_rms, asked.velocity_rms)
    needed = [part.friction.needed(effort, speed, ratio) * ratio for effort, speed in efforts]
    surely = 1 - first.flux_map.torque_error
    pairs = zip(needed, torques, strict=True)
    return max(first.winding.wound.active_length * wanted / (surely * torque) for wanted, torque in pairs)


def _efficiency(part: Learned, first: FirstDesign, continuous: float) -> float:
    """Output over input power at the RMS effort and speed; continuous: torque at the current for good [Nm].

    The current is in proportion to the torque, the iron loss that of the first loss map at this torque and speed.
    """
    if first.losses is None or not first.required.force_rms * first.required.velocity_rms:
        return nan
    ratio, required = first.transmission.nominal, first.required
    torque = part.friction.needed(required.force_rms, required.velocity_rms, ratio) * ratio
    speed = required.velocity_rms / ratio
    wound = first.winding.wound
    current = torque / continuous * first.continuous_current
    copper = 1.5 * part.of(RESISTANCE) * wound.phase_resistance * current**2
    iron = part.of(IRON_LOSS) * _iron_loss(first.losses, torque, speed)
    return required.force_rms * required.velocity_rms / (torque * speed + copper + iron)


def _iron_loss(losses: LossMap, torque: float, speed: float) -> float:
    """Of stator, rotor, magnets and what circulates in a delta, at a torque [Nm] and a speed [rad/s] of the map [W];
    NaN outside."""
    plane = losses.losses
    axes = plane.torque[:, 0], plane.speed[0]
    lost = plane.stator_iron + plane.rotor_iron + plane.magnet + plane.circulating
    table = RegularGridInterpolator(axes, lost, bounds_error=False, fill_value=nan)
    return float(table((torque, speed)))
