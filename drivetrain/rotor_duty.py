"""The rotor of the wound machine and what the output asks of it, for the checks of its strength."""

from __future__ import annotations

from drivetrain.outcome import OutcomeInputs, active_masses, machine_envelope
from drivetrain.requirements import Requirements, Transmission
from electrical.winding_stage import WindingOutcome
from mechanics.stage import RotorDuty
from thermal.stage import Duty


def rotor_duty(
    winding: WindingOutcome, required: Requirements, transmission: Transmission, duty: Duty, inputs: OutcomeInputs
) -> RotorDuty:
    """Bearings sit in the middle of their seats beside the end windings; speeds with the nominal transmission, torques
    with the largest."""
    wound, materials = winding.wound, inputs.materials
    masses, envelope = active_masses(wound, materials), machine_envelope(wound)
    return RotorDuty(
        machine=wound.dimensions,
        active_length=wound.active_length,
        bearing_span=wound.active_length + 2 * envelope.end_winding_length + inputs.housing.bearing_seat,
        mass=masses.rotor_mass,
        lamination_density=materials.lamination_density,
        magnet_density=materials.magnet_density,
        stacking=materials.stacking,
        speed_max=required.velocity_peak / transmission.nominal,
        speed_rms=required.velocity_rms / transmission.nominal,
        peak_torque=winding.peak_torque,
        torque=duty.effort * transmission.largest,
        speed=duty.speed / transmission.nominal,
        step=duty.step,
    )
