"""The field side of a study in SI: what every field solution shares, the grid of the sweep and the saturation limit."""

from __future__ import annotations

from math import sqrt

from geometry.half_cell import MeshDensity
from magnetostatics.case import FamilyCase
from magnetostatics.model import MachineMaterials
from materials.library import load_steel
from optimisation.states import READINGS
from optimisation.sweep import SaturationLimit, SweepGrid
from study.inputs_machine import combinations, machine_family, mesh_density
from study.magnet_choice import design_magnet
from study.schema import Study

# Twice the resolution of the sweep, for single states that are looked at.
_DETAIL = MeshDensity(gap_edges=360, longest_gap_edge=0.75, gap_layers=2, across_iron=3.0)


def field_case(study: Study) -> FamilyCase:
    """Machines, materials, winding, meshes and current densities; MaterialError where the steel cannot be read."""
    density = mesh_density(study.mesh)
    return FamilyCase(
        family=machine_family(study.machine),
        materials=machine_materials(study),
        layers=study.winding.layers,
        coil_pitch=study.winding.coil_pitch,
        packing=study.winding.packing_factor,
        density=density,
        detail=density if study.mesh.model_fields_set else _DETAIL,
        nominal_density=sqrt(2) * study.sweep.si.j_nominal_rms,  # amplitudes; a study states RMS
        overload_density=sqrt(2) * study.sweep.si.j_overload_rms,
    )


def machine_materials(study: Study) -> MachineMaterials:
    """Steel, whose path counts from the study file, and magnet with the remanence at the working temperature."""
    steel = load_steel(study.materials.steel, study.path.parent)
    return MachineMaterials(steel, steel, design_magnet(study))


def sweep_grid(study: Study) -> SweepGrid:
    """What the cross-section optimisation varies."""
    s = study.sweep
    return SweepGrid(
        combinations=combinations(study),
        stator_outer_radii=tuple(diameter / 2 for diameter in s.si.stator_diameters),
        back_iron_fractions=(s.back_iron_fraction_min, s.back_iron_fraction_max),
        back_iron_steps=s.back_iron_steps,
        rotor_radius_fractions=(s.rotor_radius_fraction_min, s.rotor_radius_fraction_max),
        rotor_radius_steps=s.rotor_radius_steps,
    )


def saturation_limit(study: Study) -> SaturationLimit:
    """The limit on the flux density of the stator, and how it is read."""
    section = study.saturation
    return SaturationLimit(READINGS[section.reading], section.si.limit, section.si.limits_compared)
