"""Heat out of the copper of a slot: wires in their filler as one substance, and the liner around it.

Half a slot lies against the flank of one tooth and, at its bottom, against the yoke; no heat crosses the middle of the
slot, and none leaves through its opening.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from geometry.machine import Machine
from thermal.errors import ThermalError

ENAMEL_CONDUCTIVITY = 0.22  # W/(m K), polyesterimide and polyamide-imide, makers' data 0.2 to 0.25; estimate
MEAN_OF_SLAB = 1 / 3  # of the whole way, where a slab is heated throughout and cooled on one side
_SLICES = 100  # of a slot: to 0.1 %


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

        v: share of copper. Round wires that do not touch, anywhere, and no bubbles in the filler; within 3 % of a
        square array up to v = 0.4. Source: Simpson, Wrobel and Mellor, IEEE Trans. Ind. Appl. 49(6) (2013) 2505.
        """
        v, rest = self.copper, 1 - self.copper
        around = (self.enamel * ENAMEL_CONDUCTIVITY + (rest - self.enamel) * self.filler_conductivity) / rest
        copper = self.copper_conductivity
        return around * ((1 + v) * copper + rest * around) / (rest * copper + (1 + v) * around)


@dataclass(frozen=True)
class Liner:
    """Slot liner: thickness [m], conductivity [W/(m K)]."""

    thickness: float
    conductivity: float

    def conductance(self, area: float) -> float:
        """[W/K]; area: of it [m^2]."""
        return self.conductivity * area / self.thickness


@dataclass(frozen=True)
class SlotPaths:
    """Out of the copper of all slots together, from its mean temperature.

    flank: to the teeth, bottom: to the yoke [W/K]; peak: hottest place over the mean of the rise, dimensionless
    """

    flank: float
    bottom: float
    peak: float

    def hottest(self, mean: float, teeth: float, yoke: float) -> float:
        """Hottest place of the winding [degC]; mean: of the winding, teeth, yoke: of the walls [degC].

        Once the heat has spread: in the first seconds of an overload the winding is more even than that.
        """
        walls = (self.flank * teeth + self.bottom * yoke) / (self.flank + self.bottom)
        return walls + self.peak * (mean - walls)


def slot_paths(machine: Machine, active_length: float, conductivity: float, liner: Liner) -> SlotPaths:
    """Both ways out of the copper of all slots.

    active_length: [m]; conductivity: of the winding across its wires [W/(m K)]
    The heat of a slot whose walls are equally warm, shared as they take it: by reciprocity these shares are also what
    the two walls count for where they are not. What goes from wall to wall through the winding is left out.
    """
    found = half_slot(machine, conductivity, liner)
    conductance = 2 * machine.slots * active_length * float(np.sum(found.area)) / found.mean
    return SlotPaths(conductance * found.flank_share, conductance * (1 - found.flank_share), found.largest / found.mean)


@dataclass(frozen=True, eq=False)
class HeatedSlices:
    """Half a slot in slices of equal radius, heated with 1 W/m^3, its walls at zero; of one metre of length.

    area: of each slice [m^2], (n,); inside: from the mean of a slice to its liner [K m/W], (n,); liner: to the flank
        [K m/W], (n,); rise: of its mean [K], (n,)
    """

    area: np.ndarray
    inside: np.ndarray
    liner: np.ndarray
    rise: np.ndarray

    @property
    def mean(self) -> float:
        """Over all of the copper [K]."""
        return float(self.area @ self.rise / np.sum(self.area))

    @property
    def largest(self) -> float:
        """In the middle of the slot: the parabola of a slab rises by half of its mean above it [K]."""
        return float(np.max(self.rise * (1 + self.inside / (self.inside + self.liner) / 2)))

    @property
    def flank_share(self) -> float:
        """Share of the heat that leaves through the flank of the tooth, dimensionless."""
        return float(np.sum(self.rise / (self.inside + self.liner)) / np.sum(self.area))


def half_slot(machine: Machine, conductivity: float, liner: Liner) -> HeatedSlices:
    """Slices between the flank of a tooth and the middle of its slot, from the shoe to the bottom.

    Around, each is a slab that is heated throughout, w / (3 k) from its mean to the wall; outwards heat goes from slice
    to slice and through the last one's liner into the yoke. As a fin is calculated, so that its mean is too warm by 1 %
    where it is deep and narrow, 10 % where a bare slot widens to a square; the taper under the shoe is left out.

    conductivity: of the winding across its wires [W/(m K)]
    """
    step = (machine.slot_bottom_radius - machine.shoe_top_radius) / _SLICES
    radius = machine.shoe_top_radius + step * (np.arange(_SLICES) + 0.5)
    width = radius * (machine.slot_pitch / 2 - np.arcsin(machine.tooth_width / 2 / radius))
    return heated_slices(width, step, conductivity, liner)


def heated_slices(width: np.ndarray, step: float, conductivity: float, liner: Liner) -> HeatedSlices:
    """width: of the slices [m] (n,), the last at the bottom; step: their thickness [m]; conductivity [W/(m K)]."""
    inside, behind = MEAN_OF_SLAB * width / (conductivity * step), np.full(len(width), 1 / liner.conductance(step))
    along = conductivity * (width[1:] + width[:-1]) / 2 / step
    bottom = 1 / (step / 2 / (conductivity * width[-1]) + 1 / liner.conductance(width[-1]))
    matrix = np.diag(1 / (inside + behind)) - np.diag(along, 1) - np.diag(along, -1)
    matrix += np.diag(np.append(along, bottom)) + np.diag(np.append(0.0, along))
    return HeatedSlices(width * step, inside, behind, np.linalg.solve(matrix, width * step))


def equal_area_perimeter(area: float) -> float:
    """Of a round bundle [m]; area: its section [m^2]."""
    return 2 * (pi * area) ** 0.5
