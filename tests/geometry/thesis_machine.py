"""The machine of the thesis (Figs 3.19 and 3.20) with any dimension changed, and its mesh."""

from geometry.cross_section import mesh_cross_section
from geometry.machine import hanselman_machine
from geometry.winding import star_of_slots

MM = 1e-3
THESIS = {
    "slots": 12,
    "pole_pairs": 5,
    "stator_outer_radius": 42.5 * MM,
    "rotor_outer_radius": 15.7 * MM,
    "back_iron_width": 3.3 * MM,
    "magnet_length": 2.5 * MM,
    "airgap": 0.5 * MM,
    "slot_opening": 2.0 * MM,
    "shoe_depth_fraction": 0.52,
    "shoe_aspect_ratio": 1.0,
    "shaft_radius": 5.0 * MM,
}


def machine(**changes):
    return hanselman_machine(**{**THESIS, **changes})


def section(whole=False, **changes):
    m = machine(**changes)
    return mesh_cross_section(m, star_of_slots(m.slots, m.pole_pairs), whole=whole)
