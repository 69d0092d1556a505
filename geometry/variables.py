"""Dimensions of the cross-section that may be varied, by name: what sweep, optima, fits and reports speak of."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

from geometry.machine import Machine
from units import FACTORS, written


@dataclass(frozen=True)
class Variable:
    """A dimension that may be varied: the field of ``MachineFamily`` that is replaced, and of the drawn ``Machine``.

    name: of the field; words: as people say it; unit: drawing unit, a key of ``units.FACTORS``, empty for a pure number
    low, high: its bounds [m or 1]
    """

    name: str
    words: str
    unit: str
    low: float = 0.0
    high: float = inf

    def between(self, low: float, high: float) -> Variable:
        """The same with these bounds [m or 1]."""
        return replace(self, low=low, high=high)

    def inside(self, value: float) -> float:
        """The value [m or 1], or the bound that it lies beyond."""
        return min(max(value, self.low), self.high)

    def of(self, machine: Machine) -> float:
        """Its value in a machine [m or 1]."""
        return float(getattr(machine, self.name))

    @property
    def key(self) -> str:
        """The name with its drawing unit, as keys and columns have it: ``airgap_mm``."""
        return f"{self.name}_{self.unit}" if self.unit else self.name

    def drawn(self, value: float) -> float:
        """A value [m or 1] in the drawing unit."""
        return value / FACTORS[self.unit] if self.unit else value

    def amount(self, value: float) -> str:
        """A value [m or 1] as people read it, with its unit."""
        return f"{self.drawn(value):.4g} {written(self.unit)}".rstrip()


BACK_IRON = Variable("back_iron_width", "back-iron width", "mm")
ROTOR_RADIUS = Variable("rotor_outer_radius", "rotor outer radius", "mm")
SWEPT = (BACK_IRON, ROTOR_RADIUS)  # over which the sweep maps torque and flux density
MAGNET_LENGTH = Variable("magnet_length", "magnet length", "mm")
MAGNET_ARC = Variable("magnet_arc_fraction", "magnet arc over pole pitch", "")
AIRGAP = Variable("airgap", "air gap", "mm")
TOOTH_WIDTH = Variable("tooth_width", "tooth width", "mm")
SLOT_OPENING = Variable("slot_opening", "slot opening", "mm")
SHOE_D1 = Variable("shoe_d1", "depth of the parallel-sided slot opening", "mm")
SHOE_D2 = Variable("shoe_d2", "depth of the shoe's taper", "mm")
FURTHER = (MAGNET_LENGTH, MAGNET_ARC, AIRGAP, TOOTH_WIDTH, SLOT_OPENING, SHOE_D1, SHOE_D2)  # that an optimum may free
