"""The machine that two other codes have computed: 12 slots, 10 poles, 85 mm, steel 35PN270, magnets of 1.3 T."""

from __future__ import annotations

from functools import cache

from geometry.cross_section import mesh_cross_section
from geometry.half_cell import MeshDensity
from geometry.machine import Machine, hanselman_machine
from geometry.winding import star_of_slots
from magnetostatics.elements import QUADRATIC
from magnetostatics.model import FieldModel, MachineMaterials
from magnetostatics.newton import NewtonSettings
from materials.library import load_steel
from materials.magnet import Magnet
from units import MILLIMETRE

SWEEP, FINE = MeshDensity(), MeshDensity(gap_edges=360, gap_layers=2, across_iron=3.0)
TIGHT = NewtonSettings(tolerance=1e-9)
STEEL = load_steel("35PN270")
MATERIALS = MachineMaterials(STEEL, STEEL, Magnet(remanence=1.3, recoil_permeability=1.0))


def reference_machine(**changes) -> Machine:
    dimensions = dict(
        slots=12,
        pole_pairs=5,
        stator_outer_radius=42.5 * MILLIMETRE,
        rotor_outer_radius=15.7 * MILLIMETRE,
        back_iron_width=3.3 * MILLIMETRE,
        magnet_length=2.5 * MILLIMETRE,
        airgap=0.5 * MILLIMETRE,
        slot_opening=2 * MILLIMETRE,
        shoe_depth_fraction=0.52,
        shoe_aspect_ratio=1.0,
        shaft_radius=5 * MILLIMETRE,
    )
    return hanselman_machine(**dimensions | changes)


@cache
def section_of(machine: Machine, density: MeshDensity = SWEEP, whole: bool = False, layers: int = 2):
    return mesh_cross_section(machine, star_of_slots(machine.slots, machine.pole_pairs, layers), density, whole)


def model_of(
    machine: Machine,
    density: MeshDensity = SWEEP,
    *,
    whole: bool = False,
    layers: int = 2,
    materials: MachineMaterials = MATERIALS,
    settings: NewtonSettings = NewtonSettings(),
    order=QUADRATIC,
) -> FieldModel:
    return FieldModel(section_of(machine, density, whole, layers), materials, settings, order)
