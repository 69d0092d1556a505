"""The field side of a study in SI: what every field solution shares, the grid of the sweep and the saturation limit."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt
from typing import TypeVar

from geometry.family import MachineFamily
from geometry.half_cell import MeshDensity
from geometry.machine import Magnetisation, ParallelMagnetisation, RadialMagnetisation
from magnetostatics.case import FieldCase
from magnetostatics.model import MachineMaterials
from materials.library import load_steel
from materials.magnet import Magnet
from optimisation.states import READINGS
from optimisation.sweep import SaturationLimit, SweepGrid
from study.schema import MachineSection, MeshSection, Study

Number = TypeVar("Number", int, float)

_MAGNETISATIONS: dict[str, Magnetisation] = {"parallel": ParallelMagnetisation(), "radial": RadialMagnetisation()}
# Twice the resolution of the sweep, for single states that are looked at.
_DETAIL = MeshDensity(gap_edges=360, longest_gap_edge=0.75, gap_layers=2, across_iron=3.0)


def field_case(study: Study) -> FieldCase:
    """Machines, materials, winding, meshes and current densities; MaterialError where the steel cannot be read."""
    density = mesh_density(study.mesh)
    return FieldCase(
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


def machine_family(section: MachineSection) -> MachineFamily:
    """The machine that the study states, and those that differ from it in four numbers."""
    m = section.si
    return MachineFamily(
        slots=m.slots,
        pole_pairs=m.poles // 2,
        stator_outer_radius=m.stator_outer_radius,
        rotor_outer_radius=m.rotor_outer_radius,
        back_iron_width=m.back_iron_width,
        magnet_length=m.magnet_length,
        airgap=m.airgap,
        slot_opening=m.slot_opening,
        shoe_depth_fraction=m.shoe_depth_fraction,
        shoe_aspect_ratio=m.shoe_aspect_ratio,
        shaft_radius=m.shaft_radius,
        magnet_arc_fraction=m.magnet_arc_fraction,
        magnetisation=_MAGNETISATIONS[m.magnetisation],
        tooth_width=m.tooth_width,
        shoe_d1=m.shoe_d1,
        shoe_d2=m.shoe_d2,
    )


def machine_materials(study: Study) -> MachineMaterials:
    """Steel, whose path counts from the study file, and magnet with the remanence at the working temperature."""
    steel = load_steel(study.materials.steel, study.path.parent)
    section = study.materials.si
    return MachineMaterials(steel, steel, Magnet(section.remanence, section.recoil_permeability))


def mesh_density(section: MeshSection) -> MeshDensity:
    """What the study states of the mesh, the rest as it is by itself."""
    default = MeshDensity()
    return replace(
        default,
        gap_edges=_stated(section.gap_edges_per_revolution, default.gap_edges),
        gap_layers=_stated(section.gap_layers, default.gap_layers),
        across_iron=_stated(section.elements_across_tooth, default.across_iron),
    )


def _stated(value: Number | None, otherwise: Number) -> Number:
    return otherwise if value is None else value


def sweep_grid(study: Study) -> SweepGrid:
    """What the cross-section optimisation varies."""
    s = study.sweep
    return SweepGrid(
        slots=s.slots,
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
