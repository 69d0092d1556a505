"""A rotor whose mechanics the tests look at, with the stage's inputs as a study has them by default."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr

from gearbox.bodies import Construction
from gearbox.planetary_set import planetary_set
from gearbox.stage import GearboxOutcome
from gearbox.train import DirectDrive, GearTrain, Stage
from magnetostatics.gap_stress_stage import GapStress
from magnetostatics.rotation import Rotation
from mechanics.stage import RotorDuty, mechanics_stage
from study.inputs_mechanics import mechanics_inputs
from study.read import read_study
from tests.magnetostatics.reference_machine import reference_machine

MACHINE = reference_machine()
INPUTS = replace(mechanics_inputs(read_study("motorcycle")), bearing=None)
DUTY = RotorDuty(
    machine=MACHINE, active_length=40e-3, bearing_span=80e-3, mass=0.2, lamination_density=7650.0,
    magnet_density=7500.0, stacking=0.95, speed_max=1600.0, speed_rms=40.0, peak_torque=4.0,
    torque=np.array([0.5, -0.5, 0.5]), speed=np.array([0.0, 40.0, 0.0]), step=0.1,
)  # fmt: skip
STRESS = GapStress(Rotation(MACHINE, 0.0, xr.Dataset()), np.zeros(1), 50e-6, np.array([16e6, 14e6]), np.zeros(2))
TEETH = planetary_set((14, 46, -109), (0.483, 0.076), 0.75e-3).plain
BUILD = Construction(bore_fraction=0.45, flange_fraction=0.25, least_flange=1.5e-3, axial_gap=0.5e-3)
GEARS = GearboxOutcome(GearTrain((Stage(TEETH, 12e-3), Stage(TEETH, 4.5e-3)), 85e-3, BUILD, 7800.0, 0.06), 0.170)
DIRECT = GearboxOutcome(DirectDrive(), 1.0)


def strength(gears=GEARS, stress=STRESS, inputs=INPUTS, **duty):
    """The outcome of the stage with some of the duty changed."""
    return mechanics_stage(stress, gears, replace(DUTY, **duty), inputs)
