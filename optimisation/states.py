"""Rotor positions and currents at which a cross-section is judged, and how its saturation limit is read there.

The thesis looks at one state only: a magnet exactly on a tooth and the current of phase A at its peak ("null electrical
angle"). A magnet meets a tooth every 2 pi / lcm(slots, poles); of these positions the null state is the one closest to
the q axis (12/10: 3 mechanical degrees from it, theta = -24 deg, gamma = +15 deg electrical).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, lcm, pi
from typing import ClassVar

from geometry.machine import Machine
from geometry.winding import WindingLayout
from magnetostatics.model import OperatingPoint

STEPS_OVER_PERIOD = 6  # in 60 electrical degrees; over all teeth these repeat for the rest of the period


def q_axis_angle(machine: Machine, layout: WindingLayout) -> float:
    """Rotor angle at which the q-axis current has its peak in phase A [rad]: p theta = axis_A - 90 deg."""
    return (layout.phase_axis - pi / 2) / machine.pole_pairs


def null_angle(machine: Machine, layout: WindingLayout) -> float:
    """Rotor angle nearest to the q-axis angle with a magnet centred on a tooth [rad]; of two equals the smaller."""
    step = 2 * pi / lcm(machine.slots, machine.poles)
    return step * ceil(q_axis_angle(machine, layout) / step - 0.5 - 1e-9)


def null_point(machine: Machine, layout: WindingLayout, amplitude: float, packing: float) -> OperatingPoint:
    """The null state: a magnet on a tooth, phase A at its peak.

    amplitude: of the current density in the copper [A/m^2]; packing: copper share of the slot
    """
    return OperatingPoint(null_angle(machine, layout), amplitude, null_current_angle(machine, layout), packing)


def period_points(
    machine: Machine, layout: WindingLayout, amplitude: float, packing: float, steps: int
) -> list[OperatingPoint]:
    """The q-axis current at ``steps`` rotor positions from the null position on, evenly over 60 electrical degrees.

    After these a balanced winding sees the same field in other teeth, so they stand for the whole period.
    """
    first, span = null_angle(machine, layout), pi / 3 / machine.pole_pairs
    return [OperatingPoint(first + span * k / steps, amplitude, 0.0, packing) for k in range(steps)]


def null_current_angle(machine: Machine, layout: WindingLayout) -> float:
    """Current angle gamma at which phase A has its peak in the null position [rad]."""
    return machine.pole_pairs * (q_axis_angle(machine, layout) - null_angle(machine, layout))


def aligned_teeth(machine: Machine, angle: float) -> tuple[int, ...]:
    """Teeth of the whole machine that have a magnet exactly in front of them at a rotor angle [rad]."""
    return tuple(k for k in range(machine.slots) if _distance_to_magnet(machine, k, angle) < 1e-6)


def _distance_to_magnet(machine: Machine, tooth: int, angle: float) -> float:
    """Angle from a tooth to the nearest magnet centre, as a share of the pole pitch."""
    position = (tooth * machine.slot_pitch - angle) / machine.pole_pitch
    return abs(position - round(position))


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
        """The limited flux density from those of the aligned teeth, the worst tooth and the worst back iron [T]."""
        raise NotImplementedError


class NullStateReading(SaturationReading):
    """Readings that look at the null state alone."""

    def states(
        self, machine: Machine, layout: WindingLayout, amplitude: float, packing: float
    ) -> list[OperatingPoint]:
        return [null_point(machine, layout, amplitude, packing)]


@dataclass(frozen=True)
class AlignedTooth(NullStateReading):
    """The thesis's reading: the tooth with a magnet exactly on it."""

    name: str = "aligned_tooth"

    def limited(self, aligned: float, tooth: float, back_iron: float) -> float:
        return aligned


@dataclass(frozen=True)
class EveryTooth(NullStateReading):
    """Every tooth."""

    name: str = "every_tooth"

    def limited(self, aligned: float, tooth: float, back_iron: float) -> float:
        return tooth


@dataclass(frozen=True)
class EveryToothAndBackIronOverPeriod(SaturationReading):
    """The rigorous reading: every tooth and the back iron, worst over one electrical period, on the q axis.

    Some steps inside 60 electrical degrees cover the period once all teeth are looked at (``period_points``).
    """

    name: str = "every_tooth_and_back_iron_over_period"
    covers_period: ClassVar[bool] = True

    def states(
        self, machine: Machine, layout: WindingLayout, amplitude: float, packing: float
    ) -> list[OperatingPoint]:
        return period_points(machine, layout, amplitude, packing, STEPS_OVER_PERIOD)

    def limited(self, aligned: float, tooth: float, back_iron: float) -> float:
        return max(tooth, back_iron)


READINGS = {reading.name: reading for reading in (AlignedTooth(), EveryTooth(), EveryToothAndBackIronOverPeriod())}
