"""Have numba compile what fields or rides need, and keep it: ``python -m pipeline.first_use fields``.

Compiling takes 150 MB that a process does not give back, so those that compute find it done. ``pipeline/setup`` asks
for both at once, one on each core.
"""

from __future__ import annotations

import sys

import numpy as np

from actuator.imposed import imposed_motion
from actuator.model import Actuator
from geometry.variables import BACK_IRON, ROTOR_RADIUS
from optimisation.design import Judge
from optimisation.gradient_optimum import find_optimum_by_gradients
from optimisation.torque import QuickMeanTorque
from study.inputs_field import field_case, saturation_limit
from study.inputs_vehicle import ride_case
from study.read import read_study
from vehicle.ride import Run, Scenario, simulate

_STUDY = "motorcycle"
_INSTANT = Scenario("an instant", speed=0.0, duration=0.01)


def fields() -> None:
    """The study's optimum from its own machine: fields, their derivatives and meshes that move."""
    study = read_study(_STUDY)
    case, limit = field_case(study), saturation_limit(study)
    judge, own = Judge(case, limit.reading, case.nominal_density, QuickMeanTorque()), case.family.reference
    start = [one.of(own) for one in (BACK_IRON, ROTOR_RADIUS)]
    find_optimum_by_gradients(judge, case.family.combination, own.stator_outer_radius, limit.limit, start)


def rides() -> None:
    """An instant of the study's vehicle at rest, and of an actuator that is held."""
    case = ride_case(read_study(_STUDY))
    simulate([Run(case.vehicle, case.curves[0], _INSTANT)])
    held = np.zeros(3)
    imposed_motion(Actuator(equivalent_mass=1.0), np.array([0.0, 1e-4, 2e-4]), held, held, held)


if __name__ == "__main__":
    {"fields": fields, "rides": rides}[sys.argv[1]]()
