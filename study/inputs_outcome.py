"""What a study says about supply, limits and assembly, in SI, as the outcome reads it."""

from __future__ import annotations

from drivetrain.outcome import Features, OutcomeInputs, StatedActuator
from gearbox.layout import Housing
from study.inputs_drive import friction_at, largest_equivalent_mass
from study.inputs_match import part_materials
from study.schema import AssemblySection, PrintedActuatorSection, Study


def outcome_inputs(study: Study) -> OutcomeInputs:
    """Currents, supply, limits, materials, casing and friction."""
    sweep, match, supply, friction = study.sweep.si, study.match.si, study.winding_selection.si, friction_at(study)
    return OutcomeInputs(
        overload_density=sweep.j_overload_rms,
        dc_voltage=supply.dc_bus_voltage,
        phase_current_max=supply.phase_current_max_rms,
        rotor_speed_max=match.speed_max,
        active_length_max=match.length_max,
        equivalent_mass_max=largest_equivalent_mass(study),
        housing=housing(study.assembly),
        casing_mass=study.assembly.si.casing_mass,
        materials=part_materials(study),
        viscous_friction=friction.viscous,
        coulomb_friction=friction.coulomb,
        load_inertia=None if study.drive is None else study.drive.si.load_inertia,
        stated=_stated(study.printed_actuator),
    )


def housing(section: AssemblySection) -> Housing:
    """What the casing adds to gearbox and machine."""
    si = section.si
    return Housing(si.casing_wall, si.lever_side, si.bearing_seat, si.sensor_cover)


def _stated(section: PrintedActuatorSection | None) -> StatedActuator | None:
    """Somebody else's actuator, None where the study states none."""
    if section is None:
        return None
    si = section.si
    features = Features(
        effort_peak=si.force_peak,
        slow_shaft_torque=si.actuator_torque_peak,
        machine_torque=si.machine_torque_peak,
        equivalent_mass=si.equivalent_mass,
        transmission_ratio=si.linkage_ratio / si.gearbox_ratio,
        gear_ratio=si.gearbox_ratio,
        linkage_ratio=si.linkage_ratio,
        mass=si.mass,
        diameter=si.diameter,
        length=si.length,
    )
    return StatedActuator(section.source, features)
