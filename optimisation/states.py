"""How a saturation limit is read: the states in which a cross-section is looked at, and which probes count there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from geometry.machine import Machine
from geometry.winding import WindingLayout
from magnetostatics.model import OperatingPoint
from magnetostatics.positions import null_point, period_points

STEPS_OVER_PERIOD = 6  # in 60 electrical degrees; over all teeth these repeat for the rest of the period


class SaturationReading:
    """Which states are solved, and which probe flux density [T] the limit applies to.

    The reading says how a limit is read; the torque of a design does not depend on it (``optimisation.torque``).
    """

    name: str
    covers_period: ClassVar[bool] = False  # whether the states are the q-axis current over one electrical period

    def states(self, machine: Machine, layout: WindingLayout, amplitude: float, packing: float) -> list[OperatingPoint]:
        """The states to solve for a current density amplitude [A/m^2]."""
        raise NotImplementedError

    def limited(self, aligned: float, tooth: float, back_iron: float) -> float:
        """The limited flux density [T] from those of the aligned teeth, the worst tooth and the worst back iron.

        aligned, tooth, back_iron: [T]
        """
        raise NotImplementedError


class NullStateReading(SaturationReading):
    """Readings that look at the null state alone."""

    def states(self, machine: Machine, layout: WindingLayout, amplitude: float, packing: float) -> list[OperatingPoint]:
        """The null state; amplitude: of the current density in the copper [A/m^2]."""
        return [null_point(machine, layout, amplitude, packing)]


@dataclass(frozen=True)
class AlignedTooth(NullStateReading):
    """The thesis's reading: the tooth with a magnet exactly on it."""

    name: str = "aligned_tooth"

    def limited(self, aligned: float, tooth: float, back_iron: float) -> float:
        """That of the aligned teeth [T]; aligned, tooth, back_iron: [T]."""
        return aligned


@dataclass(frozen=True)
class EveryTooth(NullStateReading):
    """Every tooth."""

    name: str = "every_tooth"

    def limited(self, aligned: float, tooth: float, back_iron: float) -> float:
        """That of the worst tooth [T]; aligned, tooth, back_iron: [T]."""
        return tooth


@dataclass(frozen=True)
class EveryToothAndBackIronOverPeriod(SaturationReading):
    """The rigorous reading: every tooth and the back iron, worst over one electrical period, on the q axis.

    Some steps inside 60 electrical degrees cover the period once all teeth are looked at (``period_points``).
    """

    name: str = "every_tooth_and_back_iron_over_period"
    covers_period: ClassVar[bool] = True

    def states(self, machine: Machine, layout: WindingLayout, amplitude: float, packing: float) -> list[OperatingPoint]:
        """Positions of the period; amplitude: of the current density in the copper [A/m^2]."""
        return period_points(machine, layout, amplitude, packing, STEPS_OVER_PERIOD)

    def limited(self, aligned: float, tooth: float, back_iron: float) -> float:
        """The larger one [T] of worst tooth and back iron; aligned, tooth, back_iron: [T]."""
        return max(tooth, back_iron)


READINGS = {reading.name: reading for reading in (AlignedTooth(), EveryTooth(), EveryToothAndBackIronOverPeriod())}
