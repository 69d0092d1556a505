"""Machines of a family by their numbers, as the tests of the sweep name them."""

from geometry.family import Combination


def machine_of(family, slots, outer, width, radius):
    """Ten poles; outer: stator radius, width: of the back iron, radius: of the rotor [m]."""
    lengths = {"stator_outer_radius": outer, "back_iron_width": width, "rotor_outer_radius": radius}
    return family.machine(Combination(slots, 10), **lengths)
