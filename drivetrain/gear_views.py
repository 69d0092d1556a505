"""Between match, linkage and gearbox: what is asked of the gears, under which loads, and the transmission they make."""

from __future__ import annotations

from drivetrain.matching import MatchOutcome
from drivetrain.requirements import Linkage, Requirements, Transmission
from electrical.braking_stage import BrakingDemand
from gearbox.stage import GearboxOutcome, GearDemand, GearInputs, GearLoads, NormalLoads
from gearbox.train import DirectDrive


def gear_demand(found: MatchOutcome, linkage: Linkage, required: Requirements) -> GearDemand:
    """The ratio of the match with the largest linkage ratio, inside the stator's diameter, for the peak effort."""
    return GearDemand(
        ratio=linkage.ratio_max / found.chosen.transmission_ratio,
        envelope_diameter=2 * found.machine.stator_outer_radius,
        linkage_ratio=linkage.ratio_nominal,
        linkage_ratio_max=linkage.ratio_max,
        effort_peak=required.force_peak,
        speed_at_effort_peak=required.velocity_at_force_peak,
    )


def stated_loads(required: Requirements, inputs: GearInputs) -> GearLoads:
    """Where no history is at hand: a normal distribution with the RMS values that are asked for."""
    return NormalLoads(required.force_rms, required.velocity_rms, inputs.swing)


def direct_drive(linkage: Linkage) -> GearboxOutcome:
    """The place of the gearbox where there is none: the rotor sits on the slow shaft."""
    return GearboxOutcome(DirectDrive(), linkage.ratio_nominal)


def braking_demand(required: Requirements, transmission: Transmission) -> BrakingDemand:
    """The damping that is asked for, and over which speeds."""
    return BrakingDemand(required.maximum_damping, required.velocity_rms, required.velocity_peak, transmission.nominal)


def transmission(gears: GearboxOutcome, linkage: Linkage) -> Transmission:
    """Output travel per rotor angle with the teeth as they are."""
    return Transmission(linkage.ratio_nominal / gears.train.ratio, linkage.ratio_max / gears.train.ratio)
