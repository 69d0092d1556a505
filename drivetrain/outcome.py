"""What came out: the actuator as it is built, which requirements hold, and what would help where one does not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np

from drivetrain.actuator_limits import ActuatorLimits
from drivetrain.added_friction import NO_FRICTION, AddedFriction
from drivetrain.asked import (
    ActiveLength,
    Check,
    ContinuousEffort,
    ControlledDamping,
    Diameter,
    EquivalentMass,
    LostMagnets,
    LowSpeedDamping,
    PeakEffort,
    PeakEffortAtRest,
    PeakPower,
    PhaseCurrent,
    Requirement,
    RotorSpeed,
)
from drivetrain.capability import ActuatorDesign
from drivetrain.masses import CopperBars, PartMasses, PartMaterials, part_masses
from drivetrain.nearest import NearestDesign, nearest_design
from drivetrain.remedies import DIRECT_DRIVE_LEVERS, LEVERS, Lever, Remedy, remedies
from drivetrain.requirements import Linkage, Requirements
from electrical.flux_map_machine import FluxMapMachine
from electrical.magnets_stage import MagnetsOutcome
from electrical.winding_stage import WindingOutcome
from electrical.wound_machine import WoundMachine
from gearbox.layout import Housing, Layout, MachineEnvelope, actuator_layout
from gearbox.stage import GearboxOutcome, SafetyCheck
from magnetostatics.flux_map_stage import FluxMap
from mechanics.checks import LoadCheck
from mechanics.stage import MechanicsOutcome
from thermal.stage import HeatOutcome

LIMIT_SPEEDS = 61  # points of the curve of effort over speed


@dataclass(frozen=True)
class Features:
    """An actuator on one screen, SI (thesis Table 3.12).

    effort_peak: at the output, at rest [N or Nm]; slow_shaft_torque, machine_torque: at rest [Nm]
    equivalent_mass: of rotor and gears at the output [kg or kg m^2]; transmission_ratio tau_t, linkage_ratio tau_l
        [m/rad or 1]; gear_ratio: fast over slow speed, dimensionless; mass [kg]; diameter, length of the envelope [m]
    """

    effort_peak: float
    slow_shaft_torque: float
    machine_torque: float
    equivalent_mass: float
    transmission_ratio: float
    gear_ratio: float
    linkage_ratio: float
    mass: float
    diameter: float
    length: float


@dataclass(frozen=True)
class StatedActuator:
    """Somebody else's actuator, for the comparison; source: whose."""

    source: str
    features: Features


@dataclass(frozen=True)
class OutcomeInputs:
    """What a study says about supply, limits, materials and assembly, SI.

    overload_density: current density in the copper, RMS [A/m^2]; dc_voltage [V]
    phase_current_max: RMS [A]; rotor_speed_max [rad/s]; active_length_max [m]; equivalent_mass_max: at the output [kg
        or kg m^2]
    housing: what the casing adds; casing_mass: casing, bearings, shafts and lever [kg]; materials: of the drawn parts
    viscous_friction [Ns/m or Nms/rad], coulomb_friction [N or Nm] at the output
    load_inertia: what a drive moves [kg m^2], None where the load is not a mere inertia; stated: for the comparison
    added_friction: losses beyond what the study states, as a bench has shown them
    """

    overload_density: float
    dc_voltage: float
    phase_current_max: float
    rotor_speed_max: float
    active_length_max: float
    equivalent_mass_max: float
    housing: Housing
    casing_mass: float
    materials: PartMaterials
    viscous_friction: float
    coulomb_friction: float
    load_inertia: float | None = None
    stated: StatedActuator | None = None
    added_friction: AddedFriction = NO_FRICTION

    def friction(self, ratio: float) -> tuple[float, float]:
        """(dry [N or Nm], viscous [Ns/m or Nms/rad]) at the output, stated and added; ratio: tau_t [m/rad or 1]."""
        added = self.added_friction
        return self.coulomb_friction + added.coulomb(ratio), self.viscous_friction + added.viscous(ratio)


@dataclass(frozen=True)
class Outcome:
    """The designed actuator and how it stands against what is asked of it.

    checks: of the requirements; gear_checks: of the safety factors; strength_checks: of rotor, shafts and bearings
    remedies: for the checks of requirements that do not hold
    nearest: all levers together, None where every requirement holds that they move
    masses: of the active parts; gearbox_mass, casing_mass [kg]; gearbox_inertia: at the rotor shaft [kg m^2]
    active_length [m]; layout: parts along the axis; limits: effort over speed, inertia and friction at the output
    load_inertia_ratio: inertia of the load relative to that of the drive, at the output; None without a load inertia
    """

    features: Features
    stated: StatedActuator | None
    checks: tuple[Check, ...]
    gear_checks: tuple[SafetyCheck, ...]
    strength_checks: tuple[LoadCheck, ...]
    remedies: tuple[Remedy, ...]
    nearest: NearestDesign | None
    masses: PartMasses
    gearbox_mass: float
    gearbox_inertia: float
    casing_mass: float
    active_length: float
    layout: Layout
    limits: ActuatorLimits
    load_inertia_ratio: float | None


def outcome_stage(
    winding: WindingOutcome,
    flux_map: FluxMap,
    heat: HeatOutcome,
    gears: GearboxOutcome,
    required: Requirements,
    linkage: Linkage,
    inputs: OutcomeInputs,
    magnets: MagnetsOutcome | None,
    mechanics: MechanicsOutcome | None,
) -> Outcome:
    """The actuator of machine, winding and gears against everything that is asked of it.

    A requirement that does not hold is no error: the outcome says which input to move, by how much, and what would
    fail then. Raises GearError when the rotor does not fit its stator.

    magnets: None where the study names no grade; mechanics: None where the rotor was not checked
    """
    wound = winding.wound
    masses = active_masses(wound, inputs.materials)
    design = actuator_design(winding, flux_map, heat, gears, masses, inputs)
    layout = actuator_layout(gears.train, machine_envelope(wound), inputs.housing)
    features = features_of(design, gears, linkage, layout, masses.total + gears.train.mass + inputs.casing_mass)
    asked = (*requirements_of(required, linkage, layout, inputs), *_magnets_kept(magnets))
    checks = tuple(one.check(design) for one in asked)
    levers = LEVERS if gears.train.stages else DIRECT_DRIVE_LEVERS
    return Outcome(
        features=features,
        stated=inputs.stated,
        checks=checks,
        gear_checks=gears.checks,
        strength_checks=() if mechanics is None else mechanics.checks,
        remedies=remedies(design, checks, levers),
        nearest=_nearest(design, checks, levers),
        masses=masses,
        gearbox_mass=gears.train.mass,
        gearbox_inertia=gears.train.inertia_at_fast_shaft,
        casing_mass=inputs.casing_mass,
        active_length=wound.active_length,
        layout=layout,
        limits=limits_of(design, inputs),
        load_inertia_ratio=None if inputs.load_inertia is None else inputs.load_inertia / features.equivalent_mass,
    )


def _nearest(design: ActuatorDesign, checks: Sequence[Check], levers: Sequence[Lever]) -> NearestDesign | None:
    """None where every demand holds that a lever moves."""
    moved = [one for one in checks if not one.requirement.stays]
    if all(one.holds for one in moved):
        return None
    return nearest_design(design, [one.requirement for one in moved], levers)


def actuator_limits(found: Outcome) -> ActuatorLimits:
    """What a vehicle needs to be driven with the actuator."""
    return found.limits


def active_masses(wound: WoundMachine, materials: PartMaterials) -> PartMasses:
    """The drawn parts with the copper of the real winding."""
    copper = CopperBars(
        area=wound.copper_area,
        sides=6 * wound.coils_in_series,
        end_turn_length=wound.end_turn_length,
    )
    return part_masses(wound.dimensions, wound.active_length, copper, materials)


def actuator_design(
    winding: WindingOutcome,
    flux_map: FluxMap,
    heat: HeatOutcome,
    gears: GearboxOutcome,
    masses: PartMasses,
    inputs: OutcomeInputs,
) -> ActuatorDesign:
    """What can be moved to see what would help."""
    wound = winding.wound
    return ActuatorDesign(
        per_turn=FluxMapMachine.from_per_turn(flux_map.data, turns=1, active_length=1.0, resistance=0.0),
        peak_torque_per_length=winding.peak_torque / wound.active_length,
        turns=wound.equivalent_turns,
        strands=wound.copper_area / (wound.equivalent_turns * wound.design.wire.area),
        wire_area=wound.design.wire.area,
        resistivity=wound.design.wire.resistivity,
        coils_in_series=wound.coils_in_series,
        active_length=wound.active_length,
        end_turn_length=wound.end_turn_length,
        continuous_torque=heat.at_speed.torque,
        rated_length=wound.active_length,
        overload_density=inputs.overload_density,
        dc_voltage=inputs.dc_voltage,
        transmission_ratio=gears.transmission_ratio,
        rotor_inertia_per_length=masses.rotor_inertia / wound.active_length,
        gearbox_inertia=gears.train.inertia_at_fast_shaft,
        friction=inputs.added_friction,
    )


def machine_envelope(wound: WoundMachine) -> MachineEnvelope:
    """The machine as the assembly sees it; end turns are half circles: their height is their length over pi."""
    machine = wound.dimensions
    return MachineEnvelope(
        stator_outer_radius=machine.stator_outer_radius,
        rotor_outer_radius=machine.rotor_outer_radius,
        shaft_radius=machine.shaft_radius,
        active_length=wound.active_length,
        end_winding_length=wound.end_turn_length / pi,
    )


def requirements_of(
    required: Requirements, linkage: Linkage, layout: Layout, inputs: OutcomeInputs
) -> tuple[Requirement, ...]:
    """Everything that is asked of the actuator."""
    rows: list[Requirement] = [
        PeakEffortAtRest(required.force_peak),
        PeakEffort(required.force_peak, required.velocity_at_force_peak),
        PeakPower(required.power_peak, required.velocity_at_power_peak),
        ContinuousEffort(required.force_rms),
        LowSpeedDamping(required.maximum_damping),
        *_braking_of(required),
        RotorSpeed(inputs.rotor_speed_max, required.velocity_peak),
        PhaseCurrent(inputs.phase_current_max),
        ActiveLength(inputs.active_length_max),
        EquivalentMass(inputs.equivalent_mass_max),
    ]
    if linkage.envelope_radius_max is not None:
        rows.append(Diameter(2 * linkage.envelope_radius_max, layout.diameter))
    return tuple(rows)


def _braking_of(required: Requirements) -> tuple[Requirement, ...]:
    """The damping at the RMS speed, of which no more than the peak effort is asked; none where none is."""
    if not required.maximum_damping:
        return ()
    most = required.force_peak / required.velocity_rms
    return (ControlledDamping(min(required.maximum_damping, most), required.velocity_rms),)


def _magnets_kept(magnets: MagnetsOutcome | None) -> tuple[Requirement, ...]:
    """That short circuits and faults leave the magnets what they are; none where their grade is not known."""
    return () if magnets is None else (LostMagnets(magnets.inputs.lost_max, magnets.lost),)


def features_of(
    design: ActuatorDesign, gears: GearboxOutcome, linkage: Linkage, layout: Layout, mass: float
) -> Features:
    """The actuator on one screen; mass: of the whole [kg]."""
    return Features(
        effort_peak=design.effort_peak,
        slow_shaft_torque=design.effort_peak * linkage.ratio_nominal,
        machine_torque=design.peak_torque,
        equivalent_mass=design.equivalent_mass,
        transmission_ratio=design.transmission_ratio,
        gear_ratio=gears.train.ratio,
        linkage_ratio=linkage.ratio_nominal,
        mass=mass,
        diameter=layout.diameter,
        length=layout.length,
    )


def limits_of(design: ActuatorDesign, inputs: OutcomeInputs) -> ActuatorLimits:
    """Effort over speed at the output up to the largest rotor speed, with inertia and friction."""
    ratio = design.transmission_ratio
    dry, viscous = inputs.friction(ratio)
    speed = np.linspace(0.0, inputs.rotor_speed_max * ratio, LIMIT_SPEEDS)
    return ActuatorLimits(
        speed=speed,
        force=design.effort_over(speed),
        equivalent_mass=design.equivalent_mass,
        coulomb_friction=dry,
        viscous_friction=viscous,
    )
