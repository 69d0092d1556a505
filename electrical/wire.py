"""One wire as it is wound: its copper, its enamel and what it resists."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi


@dataclass(frozen=True)
class Wire:
    """One round enamelled wire: bare and overall diameter [m], resistivity at its temperature [ohm m]."""

    copper_diameter: float
    outer_diameter: float
    resistivity: float

    @property
    def area(self) -> float:
        """Copper section A_w [m^2]."""
        return pi * self.copper_diameter**2 / 4

    @property
    def enamel_area(self) -> float:
        """Section of the enamel [m^2]."""
        return pi * (self.outer_diameter**2 - self.copper_diameter**2) / 4
