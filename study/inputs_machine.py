"""The machines that a study describes, in SI."""

from __future__ import annotations

from itertools import product

from geometry.family import Combination, MachineFamily
from geometry.half_cell import MeshDensity
from geometry.magnetisation import PATTERNS
from study.schema import MachineSection, MeshSection, Study

# Keys of [mesh] by what ``geometry.half_cell.MeshDensity`` calls them.
MESH_NAMES = {
    "gap_edges": "gap_edges_per_revolution",
    "gap_layers": "gap_layers",
    "across_iron": "elements_across_tooth",
}


def machine_family(section: MachineSection) -> MachineFamily:
    """The machine of the study and all that differ from it in slots, poles and some dimensions."""
    si = section.si
    return MachineFamily(
        slots=si.slots,
        pole_pairs=si.poles // 2,
        stator_outer_radius=si.stator_outer_radius,
        rotor_outer_radius=si.rotor_outer_radius,
        back_iron_width=si.back_iron_width,
        magnet_length=si.magnet_length,
        airgap=si.airgap,
        slot_opening=si.slot_opening,
        shoe_depth_fraction=si.shoe_depth_fraction,
        shoe_aspect_ratio=si.shoe_aspect_ratio,
        shaft_radius=si.shaft_radius,
        magnet_arc_fraction=si.magnet_arc_fraction,
        magnetisation=PATTERNS[si.magnetisation],
        tooth_width=si.tooth_width,
        shoe_d1=si.shoe_d1,
        shoe_d2=si.shoe_d2,
    )


def combinations(study: Study) -> tuple[Combination, ...]:
    """Every slot count of the sweep with every pole count; that of the machine where the sweep names none."""
    poles = study.sweep.poles or (study.machine.poles,)
    return tuple(Combination(*one) for one in product(study.sweep.slots, poles))


def mesh_density(section: MeshSection) -> MeshDensity:
    """Resolution of the mesh of the sweep; what the study does not state has its default."""
    stated = {name: getattr(section, key) for name, key in MESH_NAMES.items()}
    return MeshDensity(**{name: value for name, value in stated.items() if value is not None})
