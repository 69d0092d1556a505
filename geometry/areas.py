"""Areas and polar moments of the drawn parts of a machine, in closed form.

The outline is that of ``geometry.half_cell``: straight tooth flanks and taper, arcs about the axis for everything else.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import asin, cos, pi, sin

from geometry.machine import Machine

_Point = tuple[float, float]  # radius [m], angle [rad]


@dataclass(frozen=True)
class PartAreas:
    """Areas [m^2] and polar moments of area about the axis [m^4] of the whole machine.

    stator_laminations, rotor_laminations, magnets, shaft: areas [m^2]; the shaft is a solid bar
    half_slot: half a slot without its opening, as far as copper may lie [m^2]
    rotor_laminations_moment, magnets_moment, shaft_moment: integral of r^2 dA [m^4]
    """

    stator_laminations: float
    half_slot: float
    rotor_laminations: float
    magnets: float
    shaft: float
    rotor_laminations_moment: float
    magnets_moment: float
    shaft_moment: float


@lru_cache(maxsize=1024)
def part_areas(machine: Machine) -> PartAreas:
    """Areas and moments of the parts as drawn, lengths of the machine in m; nothing is checked."""
    arc, inner, outer = machine.magnet_arc_fraction, machine.rotor_core_radius, machine.rotor_outer_radius
    opening_and_slot = _half_slot_area(machine, 0)
    return PartAreas(
        stator_laminations=_ring_area(machine.stator_inner_radius, machine.stator_outer_radius)
        - 2 * machine.slots * opening_and_slot,
        half_slot=_half_slot_area(machine, 1),
        rotor_laminations=_ring_area(machine.shaft_radius, inner),
        magnets=arc * _ring_area(inner, outer),
        shaft=_ring_area(0.0, machine.shaft_radius),
        rotor_laminations_moment=_ring_moment(machine.shaft_radius, inner),
        magnets_moment=arc * _ring_moment(inner, outer),
        shaft_moment=_ring_moment(0.0, machine.shaft_radius),
    )


def _ring_area(inner: float, outer: float) -> float:
    return pi * (outer**2 - inner**2)


def _ring_moment(inner: float, outer: float) -> float:
    return pi / 2 * (outer**4 - inner**4)


def _half_slot_area(machine: Machine, first: int) -> float:
    """Half a slot [m^2] from its tooth to its centre line, from the outline's point number ``first`` outwards.

    Half the integral of r^2 dphi around it: along the tooth, arcs at both ends, nothing on the centre line.
    """
    outline, axis = _tooth_side(machine)[first:], machine.slot_pitch / 2
    (r_in, from_in), (r_out, from_out) = outline[0], outline[-1]
    side = sum(_swept(a, b) for a, b in pairwise(outline))
    return side + r_out**2 * (axis - from_out) / 2 - r_in**2 * (axis - from_in) / 2


def _tooth_side(machine: Machine) -> tuple[_Point, ...]:
    """The slot's side of tooth 0: tip at the bore, end of the parallel opening, ends of the taper, end of the flank.

    End of the opening and start of the taper are one point unless the taper touches the shoe (``taper_angle``).
    """
    axis, half, tooth = machine.slot_pitch / 2, machine.opening_width / 2, machine.tooth_width / 2
    bore, opening = machine.stator_inner_radius, machine.opening_top_radius
    shoe, bottom = machine.shoe_top_radius, machine.slot_bottom_radius
    return (
        (bore, axis - asin(half / bore)),
        (opening, machine.opening_top_angle),
        (opening, machine.taper_angle),
        (shoe, asin(tooth / shoe)),
        (bottom, asin(tooth / bottom)),
    )


def _swept(a: _Point, b: _Point) -> float:
    """Signed area [m^2] between the axis and the way from a to b, positive counter-clockwise: a sector where both have
    one radius, otherwise the triangle of a straight line."""
    (r_a, at_a), (r_b, at_b) = a, b
    if r_a == r_b:
        return r_a**2 * (at_b - at_a) / 2
    return r_a * r_b * (cos(at_a) * sin(at_b) - sin(at_a) * cos(at_b)) / 2
