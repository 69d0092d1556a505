"""How warm the machine becomes under a ride that goes on and on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from electrical.winding_stage import WindingOutcome
from magnetostatics.flux_map_stage import FluxMap
from thermal.course import course
from thermal.errors import NoSteadyState
from thermal.field_loss import FieldLoss
from thermal.machine import MAGNETS, SLOT
from thermal.rating import state_of
from thermal.stage import Assembled, BuiltMachine, Duty, HeatInputs
from vehicle.ride import RideHistory

FOLLOWED = 7200.0  # s; the casing of such a machine has settled by then


@dataclass(frozen=True, eq=False)
class RideTemperature:
    """Under the mean losses of a ride, from the temperature of the surroundings on.

    time [s], (t,); copper, magnets: means of the wires in the slots and of the magnets [degC], (t,)
    hottest_copper: in the end [degC], nan where it runs away
    """

    command: str
    time: np.ndarray
    copper: np.ndarray
    magnets: np.ndarray
    hottest_copper: float


def thermal_machine(
    flux_map: FluxMap, winding: WindingOutcome, built: BuiltMachine, field: FieldLoss, inputs: HeatInputs
) -> Assembled:
    """The machine in its casing, ready for a duty."""
    return Assembled(flux_map, winding, built, field, inputs)


def ride_temperature(command: str, history: RideHistory, machine: Assembled) -> RideTemperature:
    """Follow the temperatures with the losses that torque and speed of the rotor have in the mean over the ride."""
    inside, ratio = history.inside, machine.built.ratio
    step = float(history.time[1] - history.time[0])
    duty = Duty(inside.torque / ratio, inside.rotor_speed * ratio, step)
    load = machine.under(duty, machine.history(duty, machine.heated(duty.speed_rms).operation))
    found = course(load, load.machine.cold(), FOLLOWED)
    try:
        hottest = state_of(load).hottest_copper
    except NoSteadyState:
        hottest = float("nan")
    return RideTemperature(command, found.time, found.of(SLOT), found.of(MAGNETS), hottest)
