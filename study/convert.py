"""The border between the study file's drawing units and the SI dataclasses of the packages.

Functions that need a slow package import it themselves, so that reading a study stays fast.
"""

from __future__ import annotations

from dataclasses import replace

from geometry.machine import (
    Machine,
    Magnetisation,
    ParallelMagnetisation,
    RadialMagnetisation,
    hanselman_machine,
)
from study.schema import MachineSection, MatchSection, MaterialsSection, MeshSection, RequirementsSection, Study
from units import AMPERE_PER_SQUARE_MILLIMETRE, DEGREE, MILLIMETRE, RPM

MEGAPASCAL, GIGAPASCAL = 1e6, 1e9  # Pa
KILO = 1e3

_MAGNETISATIONS = {"parallel": ParallelMagnetisation(), "radial": RadialMagnetisation()}


def magnetisation(section: MachineSection) -> Magnetisation:
    """The magnetisation pattern that the study names."""
    return _MAGNETISATIONS[section.magnetisation]


def to_machine(section: MachineSection, **changes) -> Machine:
    """The machine that the study describes, in SI.

    Tooth width and shoe follow from the back iron (thesis eqs 3.53, 3.57, 3.58) where the study does not state them.
    changes: arguments of ``hanselman_machine`` in SI that replace the study's, such as ``back_iron_width=4e-3`` for
    one design of the sweep; what follows from them is derived anew.
    """
    derived = hanselman_machine(**{**_hanselman_arguments(section), **changes})
    return replace(derived, **_stated_dimensions(section))


def _hanselman_arguments(section: MachineSection) -> dict:
    return {
        "slots": section.slots,
        "pole_pairs": section.poles // 2,
        "stator_outer_radius": section.stator_outer_radius_mm * MILLIMETRE,
        "rotor_outer_radius": section.rotor_outer_radius_mm * MILLIMETRE,
        "back_iron_width": section.back_iron_width_mm * MILLIMETRE,
        "magnet_length": section.magnet_length_mm * MILLIMETRE,
        "airgap": section.airgap_mm * MILLIMETRE,
        "slot_opening": section.slot_opening_mm * MILLIMETRE,
        "shoe_depth_fraction": section.shoe_depth_fraction,
        "shoe_aspect_ratio": section.shoe_aspect_ratio,
        "shaft_radius": section.shaft_radius_mm * MILLIMETRE,
        "magnet_arc_fraction": section.magnet_arc_fraction,
        "magnetisation": magnetisation(section),
    }


def _stated_dimensions(section: MachineSection) -> dict:
    """Dimensions in m that the study states although they could be derived."""
    stated = {
        "tooth_width": section.tooth_width_mm,
        "shoe_d1": section.shoe_d1_mm,
        "shoe_d2": section.shoe_d2_mm,
    }
    return {name: length * MILLIMETRE for name, length in stated.items() if length is not None}


def to_mesh_density(section: MeshSection):
    """``geometry.half_cell.MeshDensity`` with what the study states."""
    from geometry.half_cell import MeshDensity

    stated = {
        "gap_edges": section.gap_edges_per_revolution,
        "gap_layers": section.gap_layers,
        "across_iron": section.elements_across_tooth,
    }
    return MeshDensity(**{name: value for name, value in stated.items() if value is not None})


def to_magnet(section: MaterialsSection):
    """``materials.magnet.Magnet``; the study states the remanence at the temperature of operation."""
    from materials.magnet import Magnet

    return Magnet(section.remanence_T, section.recoil_permeability)


def to_conductor(section: MaterialsSection):
    """``materials.conductor.Conductor``, the copper of the winding."""
    from materials.conductor import Conductor

    return Conductor(
        reference_resistivity=section.copper_resistivity_Ohm_m,
        temperature_coefficient=section.copper_temperature_coefficient_per_K,
        reference_temperature=section.copper_reference_temperature_degC,
    )


def winding_resistivity(study: Study) -> float:
    """Resistivity of the copper at the temperature of the winding [Ohm m]."""
    return to_conductor(study.materials).resistivity(study.winding_selection.winding_temperature_degC)


def to_wire(study: Study):
    """``electrical.winding_selection.Wire`` at the temperature of the winding."""
    from electrical.winding_selection import Wire

    return Wire(study.winding_selection.wire_diameter_mm * MILLIMETRE, winding_resistivity(study))


def to_winding_limits(study: Study):
    """``electrical.winding_selection.WindingLimits``: packing, overload current density, supply."""
    from electrical.winding_selection import WindingLimits

    section = study.winding_selection
    return WindingLimits(
        packing_limit=study.winding.packing_factor,
        packing_tolerance=section.packing_tolerance,
        overload_current_density=study.sweep.j_overload_rms_A_per_mm2 * AMPERE_PER_SQUARE_MILLIMETRE,
        dc_voltage=section.dc_bus_voltage_V,
        maximum_speed=section.speed_max_rpm * RPM,
        phase_current_rms=section.phase_current_max_rms_A,
    )


def to_winding_requirement(study: Study, transmission_ratio: float):
    """``electrical.winding_selection.WindingRequirement`` at the overall ratio tau_t [m/rad]."""
    from electrical.winding_selection import winding_requirement

    required = study.requirements
    return winding_requirement(
        peak_force=required.force_peak_N,
        velocity_at_peak_force=required.velocity_at_force_peak_m_per_s,
        peak_power=required.power_peak_W,
        transmission_ratio=transmission_ratio,
    )


def to_actuator_requirements(section: RequirementsSection):
    """``drivetrain.match.ActuatorRequirements``, at the wheel."""
    from drivetrain.match import ActuatorRequirements

    return ActuatorRequirements(
        regenerative_damping=section.maximum_damping_kNs_per_m * KILO,
        force_rms=section.force_rms_N,
        velocity_rms=section.velocity_rms_m_per_s,
        velocity_peak=section.velocity_peak_m_per_s,
        force_peak=section.force_peak_N,
        velocity_at_force_peak=section.velocity_at_force_peak_m_per_s,
        power_peak=section.power_peak_W,
    )


def to_copper_loading(study: Study):
    """``drivetrain.match.CopperLoading``: nominal current density, packing and warm copper of the damping demand."""
    from drivetrain.match import CopperLoading

    density = study.sweep.j_nominal_rms_A_per_mm2 * AMPERE_PER_SQUARE_MILLIMETRE
    return CopperLoading(density, study.winding.packing_factor, winding_resistivity(study))


def to_match_limits(section: MatchSection):
    """``drivetrain.match.MatchLimits``: active length and rotor speed."""
    from drivetrain.match import MatchLimits

    return MatchLimits(section.length_max_mm * MILLIMETRE, section.speed_max_rad_per_s)


def to_cost_scales(section: MatchSection):
    """``drivetrain.match.CostScales``: what counts as 1 in each term of the cost."""
    from drivetrain.match import CostScales

    return CostScales(section.mass_max_kg, section.equivalent_mass_max_kg, section.radius_limit_mm * MILLIMETRE)


def to_cost_weights(section: MatchSection):
    """``drivetrain.match.CostWeights``."""
    from drivetrain.match import CostWeights

    return CostWeights(section.weight_inertia, section.weight_radius)


def to_gear_laws(section: MatchSection):
    """``drivetrain.planetary.GearLaws``, with the dynamic factor as the thesis prints it (eq. 3.118)."""
    from drivetrain.planetary import GearLaws, PrintedDynamicFactor

    return GearLaws(
        density=section.steel_density_kg_per_m3,
        youngs_modulus=section.gear_youngs_modulus_GPa * GIGAPASCAL,
        poisson_ratio=section.gear_poisson_ratio,
        contact_strength=section.gear_contact_stress_MPa * MEGAPASCAL,
        pressure_angle=section.gear_pressure_angle_deg * DEGREE,
        overload_factor=section.gear_overload_factor,
        contact_ratio_factor=section.gear_contact_ratio_factor,
        ring_fraction=section.gear_ring_diameter_fraction,
        dynamic_factor=PrintedDynamicFactor(),
    )


def to_gearbox_design(study: Study):
    """``drivetrain.planetary.GearboxDesign`` at the nominal linkage ratio."""
    from drivetrain.planetary import GearboxDesign

    return GearboxDesign(
        stage_count=study.match.gearbox_stages,
        linkage_ratio=study.linkage.ratio_nominal_mm_per_rad * MILLIMETRE,
        force_rms=study.requirements.force_rms_N,
        velocity_rms=study.requirements.velocity_rms_m_per_s,
        laws=to_gear_laws(study.match),
    )
