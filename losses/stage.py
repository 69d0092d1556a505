"""Losses of the cross-section over its currents, and the loss and efficiency map of the wound machine, as motor and as
generator."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from electrical.dq import OperatingMap, operating_map, peak_torque, torque_speed_envelope
from electrical.driven_machine import DrivenMachine
from electrical.plane import plane_dataset, plane_record
from geometry.family import MatchedMachine
from geometry.parts import DrawnMachine
from labelled import xr
from losses.magnet import NDFEB_RESISTIVITY
from losses.map import (
    FieldLosses,
    FieldLossTable,
    LossGrid,
    PowerLosses,
    current_point,
    field_losses,
    power_losses,
)
from magnetostatics.case import FieldCase
from magnetostatics.flux_map_stage import FluxMap, kept_model
from materials.errors import MaterialError
from materials.iron_loss import IronLossLaw, iron_loss_law
from tasks import Workers

_TORQUES, _SPEEDS = 161, 121  # of the motoring half; the generating half has as many torques again
_LARGEST = 1.02  # of the fullest coil side's peak ampere-turns: the corner of the map lies on the current limit


class LossError(ValueError):
    """No loss map can be made from these inputs; the message says which key to change."""


@dataclass(frozen=True)
class LossInputs:
    """Whose loss data count.

    steel: of the study; loss_grade: grade whose data stand for it, None where the study names none
    winding_temperature: of the copper [degC], in the resistivity of the wound machine already
    iron_factor: iron loss over that of the data, dimensionless; another one where a bench has shown it
    magnet_resistivity: [ohm m]
    """

    steel: str
    loss_grade: str | None
    winding_temperature: float
    iron_factor: float = 1.0
    magnet_resistivity: float = NDFEB_RESISTIVITY


@dataclass(frozen=True)
class BestPoint:
    """The largest efficiency of a quadrant and where it is: torque [Nm], speed [rad/s]."""

    efficiency: float
    torque: float
    speed: float


@dataclass(frozen=True, eq=False)
class CurrentLosses:
    """Iron and magnet losses of the cross-section over the ampere-turns of a coil, whatever is wound; law: iron loss of
    the sheet that they rest on."""

    table: FieldLossTable
    law: IronLossLaw


@dataclass(frozen=True, eq=False)
class LossMap:
    """Losses of the wound machine over torque (first index, negative as a generator) and speed, and what they rest on.

    data: losses [W] over the whole plane, a data set of ``PowerLosses``, NaN out of reach
    law: iron loss of the sheet; steel: whose name the study gives, another one where the law stands in for it
    winding_temperature: [degC]; end_turn_share: of the copper loss
    motor, generator: best points
    """

    data: xr.Dataset
    law: IronLossLaw
    steel: str
    winding_temperature: float
    end_turn_share: float
    motor: BestPoint
    generator: BestPoint

    @property
    def losses(self) -> PowerLosses:
        """Losses over the whole plane."""
        return plane_record(PowerLosses, self.data)

    @property
    def law_is_of_another_grade(self) -> bool:
        """Whether the loss data are those of another sheet than the study's."""
        return self.law.grade != self.steel


@dataclass(frozen=True)
class LossTask:
    """Iron and magnet losses at one current; direct, quadrature: ampere-turns of a coil on the axes [A peak].

    resistivity: of the magnets [ohm m]
    """

    case: FieldCase
    machine: DrawnMachine
    direct: float
    quadrature: float
    law: IronLossLaw
    resistivity: float = NDFEB_RESISTIVITY


def current_losses_stage(
    case: FieldCase, flux_map: FluxMap, matched: MatchedMachine, inputs: LossInputs, workers: Workers
) -> CurrentLosses:
    """Solve the losses over the currents up to the overload of the fullest coil side; a task is one current.

    Raises LossError for a study whose steel has no loss data and that names no grade to stand in.
    """
    law, machine = loss_law(inputs), matched.machine
    grid = LossGrid.of(machine.rotor, _LARGEST * flux_map.overload_ampere_turns)
    tasks = {
        f"d {d:.0f} A, q {q:.0f} A": LossTask(case, machine, d, q, law, inputs.magnet_resistivity)
        for d, q in grid.points
    }
    found = workers.map("current_losses", losses_at_current, tasks)
    return CurrentLosses(grid.table(list(found.values())), law)


def losses_stage(found: CurrentLosses, flux_map: FluxMap, driven: DrivenMachine, inputs: LossInputs) -> LossMap:
    """The losses over the currents, read along the operating map of the wound machine."""
    wound, operating = driven.wound, both_senses(flux_map, driven)
    losses = power_losses(operating, wound, found.table, flux_map.data)
    return LossMap(
        plane_dataset(losses),
        found.law,
        inputs.steel,
        inputs.winding_temperature,
        wound.end_turn_share,
        best_point(losses, losses.torque > 0),
        best_point(losses, losses.torque < 0),
    )


def loss_law(inputs: LossInputs) -> IronLossLaw:
    """The law of the grade that the study names. Raises LossError without one."""
    try:
        return iron_loss_law(inputs.loss_grade).times(inputs.iron_factor)
    except MaterialError as error:
        raise LossError(f"no losses for steel {inputs.steel} (materials.loss_grade): {error}") from None


def losses_at_current(task: LossTask) -> FieldLosses:
    """Iron and magnet losses at one current, whole machine per metre."""
    model = kept_model(task.case, task.machine)
    point = current_point(model.section, task.direct, task.quadrature, task.case.packing)
    return field_losses(model, point, task.law, resistivity=task.resistivity)


def both_senses(flux_map: FluxMap, driven: DrivenMachine) -> OperatingMap:
    """Least currents on the flux map over torques from generating to motoring and speeds up to the last one reached."""
    machine, limits = driven.wound.on_map(flux_map.data), driven.limits
    envelope = torque_speed_envelope(machine, limits, np.linspace(0.0, driven.fastest, _SPEEDS))
    top = float(envelope.speed[np.flatnonzero(np.isfinite(envelope.torque))[-1]])
    torque = torques_of(float(peak_torque(machine, limits)))
    return operating_map(machine, limits, torque[:, None], np.linspace(0.0, top, _SPEEDS))


def torques_of(peak: float) -> np.ndarray:
    """From generating to motoring [Nm], (n,), each sense the mirror image of the other; peak: the largest [Nm].

    The one in the middle is zero and not what rounding leaves of it: half the map begins there.
    """
    motoring = np.linspace(0.0, peak, _TORQUES)
    return np.concatenate([-motoring[:0:-1], motoring])


def best_point(losses: PowerLosses, where: np.ndarray) -> BestPoint:
    """The largest efficiency among the points where a mask says so; where: whether each counts, shape of the losses."""
    efficiency = np.where(where, losses.efficiency, np.nan)
    if np.isnan(efficiency).all():
        raise LossError("no point of the plane has an efficiency: speed_max_rpm of winding_selection is too low")
    best = np.unravel_index(np.nanargmax(efficiency), efficiency.shape)
    return BestPoint(float(efficiency[best]), float(losses.torque[best]), float(losses.speed[best]))
