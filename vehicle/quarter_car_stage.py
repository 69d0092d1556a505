"""The actuator of a study in the quarter car of thesis chapter 4, so that its tables stand beside the printed ones."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from labelled import xr
from tasks import Workers
from vehicle.designed import DesignedActuator
from vehicle.energy_stage import STEP as FINE
from vehicle.energy_stage import EnergyOutcome, energy_stage, outcome_of, quasi_ideal
from vehicle.printed_car import COMFORT, PRINTED_CAR, PRINTED_DAMPING, printed_case, printed_road
from vehicle.quarter_car import lqr
from vehicle.ride import RideHistory, Run, simulate
from vehicle.shaken import shaken

SEEDS = range(6)  # the thesis has one road, whose seed it does not print
STEP = 1e-3  # s, of the ride with the comfort setting
WITHOUT_LOOP = "no force loop"


@dataclass(frozen=True, eq=False)
class QuarterCarRides:
    """What the rides of Tables 4.6-4.14 come to with an actuator of one's own.

    energy: the same commands and actuators as in the tables; comfort: the quasi-ideal actuator with the comfort
    setting, whose linear optimum may lift the wheel (Fig. 4.28), over time [s], (t,): felt [m/s^2], tyre_load [N] and
    force [N], each (t,)
    alone: the minimum damping without the force loop on the first road (Figs 4.52 and 4.53)
    shaken: a harmonic force on the body, see ``vehicle.shaken``
    """

    energy: EnergyOutcome
    comfort: xr.Dataset
    alone: EnergyOutcome
    shaken: EnergyOutcome


def quarter_car_stage(own: DesignedActuator, workers: Workers) -> QuarterCarRides:
    """Every command of chapter 4 with the actuator of a study, once a seed.

    Raises what ``vehicle.energy_stage`` raises.
    """
    found = energy_stage(printed_case(SEEDS), own, None, workers)
    road = replace(printed_road(SEEDS[0]), time_step=STEP)
    history = simulate([Run(PRINTED_CAR, lqr(PRINTED_CAR, COMFORT), road, quasi_ideal(own))])[0]
    return QuarterCarRides(found, _comfort(history), without_loop(own), shaken(own))


def without_loop(own: DesignedActuator) -> EnergyOutcome:
    """The minimum damping on the first road with the motor asked for the wanted force itself (Figs 4.52 and 4.53)."""
    road = replace(printed_road(SEEDS[0]), time_step=FINE)
    return outcome_of(own, {WITHOUT_LOOP: Run(PRINTED_CAR, PRINTED_DAMPING[1], road, own.actuator)})


def _comfort(history: RideHistory) -> xr.Dataset:
    values = {
        "felt": history.weighted_acceleration,
        "tyre_load": history.tyre_loads[-1],
        "force": history.suspension_force,
    }
    return xr.Dataset({name: ("time", np.asarray(one)) for name, one in values.items()}, {"time": history.time})
