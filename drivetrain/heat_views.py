"""Between gearbox, losses and the heat of the machine: what it is built into, what is asked of it, what it loses."""

from __future__ import annotations

import numpy as np

from drivetrain.outcome import OutcomeInputs, active_masses, machine_envelope
from drivetrain.requirements import Requirements
from electrical.winding_stage import WindingOutcome
from gearbox.layout import actuator_layout
from gearbox.stage import GearboxOutcome
from losses.stage import LossMap
from thermal.field_loss import FieldLoss, MappedLoss
from thermal.machine import Casing, Weights
from thermal.stage import BuiltMachine, Duty


def built_machine(winding: WindingOutcome, gears: GearboxOutcome, inputs: OutcomeInputs) -> BuiltMachine:
    """The machine in the casing of the whole actuator, with the friction of its gears and bearings."""
    masses, envelope = active_masses(winding.wound, inputs.materials), machine_envelope(winding.wound)
    layout = actuator_layout(gears.train, envelope, inputs.housing)
    dry, viscous = inputs.friction(gears.transmission_ratio)
    return BuiltMachine(
        Weights(masses.copper, masses.stator_laminations, masses.rotor_laminations, masses.magnets, masses.shaft),
        inputs.materials.stacking,
        Casing(
            layout.diameter,
            layout.length,
            inputs.casing_mass,
            inputs.housing.bearing_seat,
            envelope.end_winding_length,
        ),
        gears.transmission_ratio,
        viscous,
        dry,
    )


def stated_duty(required: Requirements) -> Duty:
    """RMS effort and RMS speed at once, where no history is at hand."""
    return Duty(np.array([required.force_rms]), np.array([required.velocity_rms]), 0.0)


def mapped_loss(found: LossMap) -> FieldLoss:
    """Iron and magnets of the loss map."""
    return MappedLoss(found.losses)
