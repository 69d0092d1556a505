"""The gearbox and the assembly of a study as the objects of ``gearbox`` and ``vehicle``."""

from __future__ import annotations

from gearbox.bodies import Construction
from gearbox.flank import Lubrication
from gearbox.layout import Housing
from gearbox.load_factors import Quality
from gearbox.material import MATERIALS
from gearbox.planetary_set import PlanetarySet, planetary_set
from gearbox.rating import Rules, StageLoad
from gearbox.search import CostScale, GearRequest, Safety
from study.schema import AssemblySection, GearboxSection, Study
from units import MILLIMETRE

MICROMETRE, HOUR = 1e-6, 3600.0


def to_gear_rules(section: GearboxSection) -> Rules:
    """Steel, manufacture and oil that the teeth are rated by."""
    oil = Lubrication(
        section.oil_viscosity_mm2_per_s * MILLIMETRE**2,
        section.flank_roughness_um * MICROMETRE,
        section.root_roughness_um * MICROMETRE,
    )
    quality = Quality(section.accuracy_grade, section.application_factor)
    return Rules(MATERIALS[section.material], quality, oil)


def to_safety(section: GearboxSection) -> Safety:
    """Wanted safety factors."""
    return Safety(
        section.safety_flank, section.safety_root, section.safety_static_flank, section.safety_static_root
    )


def to_construction(section: GearboxSection) -> Construction:
    """How a stage is built around its teeth."""
    return Construction(
        bore_fraction=section.planet_bore_fraction,
        flange_fraction=section.flange_fraction,
        least_flange=section.flange_thickness_min_mm * MILLIMETRE,
        axial_gap=section.axial_gap_mm * MILLIMETRE,
    )


def life(section: GearboxSection) -> float:
    """Operating time of the life [s]."""
    return section.life_h * HOUR


def to_gear_request(study: Study, load: StageLoad, *, ratio: float, envelope_diameter: float) -> GearRequest:
    """The gearbox that is searched: ratio fast over slow, envelope [m]; cost as in the match."""
    section, match = study.gearbox, study.match
    return GearRequest(
        ratio=ratio,
        ratio_tolerance=section.ratio_tolerance,
        stage_count=match.gearbox_stages,
        envelope_diameter=envelope_diameter,
        load=load,
        rules=to_gear_rules(section),
        safety=to_safety(section),
        construction=to_construction(section),
        cost=CostScale(
            mass=match.mass_max_kg,
            equivalent_mass=match.equivalent_mass_max_kg,
            weight=match.weight_inertia,
            linkage_ratio=study.linkage.ratio_nominal_mm_per_rad * MILLIMETRE,
        ),
        friction=section.friction_coefficient,
        planets=section.planets,
    )


def to_printed_gears(section: GearboxSection) -> PlanetarySet | None:
    """The gear set that the study states, None where it does not."""
    if None in (section.printed_teeth, section.printed_module_mm, section.printed_shifts):
        return None
    sun, planet, ring = section.printed_teeth
    module = section.printed_module_mm * MILLIMETRE
    return planetary_set((sun, planet, -ring), section.printed_shifts, module, planets=section.planets)


def to_housing(section: AssemblySection) -> Housing:
    """What the casing adds to gearbox and machine."""
    return Housing(
        wall=section.casing_wall_mm * MILLIMETRE,
        lever_side=section.lever_side_mm * MILLIMETRE,
        bearing_seat=section.bearing_seat_mm * MILLIMETRE,
        sensor_cover=section.sensor_cover_mm * MILLIMETRE,
    )
