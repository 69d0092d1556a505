"""Heat out of the copper of a slot: wires in their filler as one substance, and the liner around it.

Half a slot lies against the flank of one tooth and, at its bottom, against the yoke; no heat crosses the middle of the
slot, and none leaves through its opening. It counts as a rectangle as deep as the flank is long.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from geometry.areas import part_areas
from geometry.machine import Machine
from thermal.errors import ThermalError

ENAMEL_CONDUCTIVITY = 0.22  # W/(m K), polyesterimide and polyamide-imide, makers' data 0.2 to 0.25; estimate
MEAN_OF_SLAB = 1 / 3  # mean over largest conduction path of a slab that is heated throughout and cooled on one side


@dataclass(frozen=True)
class Filling:
    """What lies in a slot.

    copper, enamel: shares of its area, dimensionless; the rest is filler
    copper_conductivity, filler_conductivity: [W/(m K)]
    """

    copper: float
    enamel: float
    copper_conductivity: float
    filler_conductivity: float

    def __post_init__(self) -> None:
        if not (self.copper > 0 and self.enamel >= 0 and self.copper + self.enamel < 1):
            raise ThermalError(
                f"copper and enamel fill {self.copper:.3g} and {self.enamel:.3g} of the slot; together less than 1"
            )

    @property
    def conductivity(self) -> float:
        """Across the wires [W/(m K)].

        k = k_f ((1 + v) k_c + (1 - v) k_f) / ((1 - v) k_c + (1 + v) k_f)      Hashin-Shtrikman, lower bound
        k_f = (v_e k_e + v_r k_r) / (v_e + v_r)                               enamel and filler side by side

        v: share of copper. Round wires that do not touch, anywhere; within 10 % of the measured up to v = 0.6 where the
        filler holds no bubbles. Source: Simpson, Wrobel and Mellor, IEEE Trans. Ind. Appl. 49(6) (2013) 2505.
        """
        v, rest = self.copper, 1 - self.copper
        around = (self.enamel * ENAMEL_CONDUCTIVITY + (rest - self.enamel) * self.filler_conductivity) / rest
        copper = self.copper_conductivity
        return around * ((1 + v) * copper + rest * around) / (rest * copper + (1 + v) * around)


def enamel_share(copper: float, wire_diameter: float, insulation: float) -> float:
    """Share of the slot that the enamel fills, dimensionless.

    copper: share of the slot, dimensionless; wire_diameter: of the copper [m]; insulation: its thickness [m]
    """
    return copper * ((1 + 2 * insulation / wire_diameter) ** 2 - 1)


@dataclass(frozen=True)
class Liner:
    """Slot liner: thickness [m], conductivity [W/(m K)]."""

    thickness: float
    conductivity: float

    def resistance(self, area: float) -> float:
        """Of an area [m^2] of it [K/W]."""
        return self.thickness / (self.conductivity * area)


@dataclass(frozen=True)
class WallPath:
    """From the mean temperature of the copper to one wall; inside: of the winding [K/W]; liner: of the liner [K/W]."""

    inside: float
    liner: float

    @property
    def conductance(self) -> float:
        """Of both in line [W/K]."""
        return 1 / (self.inside + self.liner)

    def hottest(self, mean: float, wall: float) -> float:
        """Hottest place of the winding [degC] where its mean and the wall have these temperatures [degC].

        The parabola of a slab: three halves of its mean rise over its own edge.
        """
        return mean + (mean - wall) * self.inside / (self.inside + self.liner) / 2


@dataclass(frozen=True)
class SlotPaths:
    """Of all slots together, in parallel; flank: to the teeth, bottom: to the yoke."""

    flank: WallPath
    bottom: WallPath


def slot_paths(machine: Machine, active_length: float, conductivity: float, liner: Liner) -> SlotPaths:
    """Both ways out of the copper of all slots.

    R = w / (3 k A) + t / (k_l A): width w of the winding across the wall, area A of the wall

    active_length: [m]; conductivity: of the winding across its wires [W/(m K)]
    Each way on its own, as if the other were not there (the cuboid of Wrobel and Mellor, IEEE Trans. Energy Convers.
    25(4) (2010) 943, whose central node is left out): warmer than the rectangle is by at most 18 %, in a square without
    a liner; by a few per cent in a slot that is deep and narrow.
    """
    depth = machine.slot_bottom_radius - machine.shoe_top_radius
    width = part_areas(machine).half_slot / depth
    halves = 2 * machine.slots
    flank, bottom = (halves * side * active_length for side in (depth, width))
    return SlotPaths(
        WallPath(MEAN_OF_SLAB * width / (conductivity * flank), liner.resistance(flank)),
        WallPath(MEAN_OF_SLAB * depth / (conductivity * bottom), liner.resistance(bottom)),
    )


def equal_area_perimeter(area: float) -> float:
    """Of a round bundle [m]; area: its section [m^2]."""
    return 2 * (pi * area) ** 0.5
