"""Between gearbox, losses and the heat of the machine: what it is built into, what is asked of it, what it loses, and
how long it must be for that."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drivetrain.outcome import OutcomeInputs, active_masses, machine_envelope
from drivetrain.requirements import Requirements
from electrical.final_length import ContinuousNeed, LengthByDensity
from electrical.flux_map_machine import FluxMapMachine
from electrical.shaft_demand import ShaftDemand
from electrical.winding_stage import WindingInputs, WindingOutcome
from electrical.wound_machine import WoundMachine
from gearbox.layout import actuator_layout
from gearbox.stage import GearboxOutcome
from geometry.family import MatchedMachine
from losses.stage import CurrentLosses, LossMap
from magnetostatics.flux_map_stage import FluxMap
from thermal.continuous_length import LengthByTemperature
from thermal.field_loss import FieldLoss, MappedLoss
from thermal.machine import Casing, Weights
from thermal.stage import BuiltMachine, Duty, HeatInputs


@dataclass(frozen=True)
class WholeActuator:
    """Casing, gears and bearings around whichever machine is wound, an ``Enclosure``."""

    gears: GearboxOutcome
    inputs: OutcomeInputs

    def around(self, wound: WoundMachine) -> BuiltMachine:
        """The machine in the casing of the whole actuator, with the friction of its gears and bearings."""
        inputs, ratio = self.inputs, self.gears.transmission_ratio
        masses, envelope = active_masses(wound, inputs.materials), machine_envelope(wound)
        layout, seat = actuator_layout(self.gears.train, envelope, inputs.housing), inputs.housing.bearing_seat
        dry, viscous = inputs.friction(ratio)
        return BuiltMachine(
            Weights(masses.copper, masses.stator_laminations, masses.rotor_laminations, masses.magnets, masses.shaft),
            inputs.materials.stacking,
            Casing(layout.diameter, layout.length, inputs.casing_mass, seat, envelope.end_winding_length),
            ratio,
            viscous,
            dry,
        )


def built_machine(winding: WindingOutcome, gears: GearboxOutcome, inputs: OutcomeInputs) -> BuiltMachine:
    """What the wound machine is built into."""
    return WholeActuator(gears, inputs).around(winding.wound)


def length_by_density(flux_map: FluxMap, demand: ShaftDemand, windings: WindingInputs) -> ContinuousNeed:
    """How long the machine must be for its RMS torque at the nominal current density."""
    machine = FluxMapMachine.from_per_turn(flux_map.data, turns=1, active_length=1.0, resistance=0.0)
    return LengthByDensity(machine, demand.torque_rms / (1 - flux_map.torque_error), windings.nominal_density)


def length_by_temperature(
    flux_map: FluxMap,
    matched: MatchedMachine,
    losses: CurrentLosses | None,
    demand: ShaftDemand,
    duty: Duty,
    gears: GearboxOutcome,
    windings: WindingInputs,
    inputs: OutcomeInputs,
    heat: HeatInputs,
) -> ContinuousNeed:
    """How long the machine must be for its RMS torque, at the RMS speed for which the heat rates it."""
    return LengthByTemperature(
        flux_map,
        matched.machine,
        None if losses is None else losses.table,
        WholeActuator(gears, inputs),
        heat,
        demand.torque_rms,
        duty.speed_rms / gears.transmission_ratio,
        windings.longest,
    )


def stated_duty(required: Requirements) -> Duty:
    """RMS effort and RMS speed at once, where no history is at hand."""
    return Duty(np.array([required.force_rms]), np.array([required.velocity_rms]), 0.0)


def mapped_loss(found: LossMap) -> FieldLoss:
    """Iron and magnets of the loss map."""
    return MappedLoss(found.losses)
