"""Areas and polar moments of the drawn parts of a machine, in closed form from the outline that is meshed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import pi

from geometry.outline import SHAFT, Contour, region_contours
from geometry.parts import DrawnMachine

_NOTHING = Contour(())


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
def part_areas(machine: DrawnMachine) -> PartAreas:
    """Areas and moments of the parts as drawn, lengths of the machine in m; nothing is checked."""
    stator, rotor = region_contours(machine.stator), region_contours(machine.rotor)
    iron, shaft = (rotor.get(name, _NOTHING) for name in ("iron", SHAFT))
    magnets = [rotor[name] for name in machine.rotor.magnet_regions]
    slots, halves, bore = 2 * machine.slots, 2 * machine.repeats, machine.rotor.bore_radius
    return PartAreas(
        stator_laminations=slots * stator["iron"].area,
        half_slot=stator["copper"].area,
        rotor_laminations=halves * iron.area,
        magnets=halves * sum(magnet.area for magnet in magnets),
        shaft=halves * shaft.area + pi * bore**2,
        rotor_laminations_moment=halves * iron.moment,
        magnets_moment=halves * sum(magnet.moment for magnet in magnets),
        shaft_moment=halves * shaft.moment + pi / 2 * bore**4,
    )
