"""Rotor positions and currents at which a cross-section is judged, and how its saturation limit is read there.

The thesis looks at one state only: a magnet exactly on a tooth and the current of phase A at its peak ("null electrical
angle"). A magnet meets a tooth every 2 pi / lcm(slots, poles); of these positions the null state is the one closest to
the q axis (12/10: 3 mechanical degrees from it, theta = -24 deg, gamma = +15 deg electrical).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, lcm, pi

from geometry.machine import Machine
from geometry.winding import WindingLayout
from magnetostatics.model import OperatingPoint

_STEPS_OVER_PERIOD = 6  # in 60 electrical degrees; over all teeth these repeat for the rest of the period


def q_axis_angle(machine: Machine, layout: WindingLayout) -> float:
    """Rotor angle at which the q-axis current has its peak in phase A [rad]: p theta = axis_A - 90 deg."""
    return (layout.phase_axis - pi / 2) / machine.pole_pairs


def null_angle(machine: Machine, layout: WindingLayout) -> float:
    """Rotor angle nearest to the q-axis angle with a magnet centred on a tooth [rad]; of two equals the smaller."""
    step = 2 * pi / lcm(machine.slots, machine.poles)
    return step * ceil(q_axis_angle(machine, layout) / step - 0.5 - 1e-9)


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
    """Which states are solved, and which probe flux density [T] the limit applies to."""

    name: str

    def states(self, machine: Machine, layout: WindingLayout, amplitude: float, packing: float) -> list[OperatingPoint]:
        """The states to solve for a current density amplitude [A/m^2]."""
        raise NotImplementedError

    def limited(self, aligned: float, tooth: float, back_iron: float) -> float:
        """The limited flux density from those of the aligned teeth, the worst tooth and the worst back iron [T]."""
        raise NotImplementedError


class NullStateReading(SaturationReading):
    """Readings that look at the null state alone."""

    def states(self, machine, layout, amplitude, packing):
        angle, gamma = null_angle(machine, layout), null_current_angle(machine, layout)
        return [OperatingPoint(angle, amplitude, gamma, packing)]


@dataclass(frozen=True)
class AlignedTooth(NullStateReading):
    """The thesis's reading: the tooth with a magnet exactly on it."""

    name: str = "aligned_tooth"

    def limited(self, aligned, tooth, back_iron):
        return aligned


@dataclass(frozen=True)
class EveryTooth(NullStateReading):
    """Every tooth."""

    name: str = "every_tooth"

    def limited(self, aligned, tooth, back_iron):
        return tooth


@dataclass(frozen=True)
class EveryToothAndBackIronOverPeriod(SaturationReading):
    """The rigorous reading: every tooth and the back iron, worst over one electrical period, on the q axis.

    After 60 electrical degrees a balanced winding sees the same field in other teeth, so that many steps inside these
    cover the period once all teeth are looked at.
    """

    name: str = "every_tooth_and_back_iron_over_period"

    def states(self, machine, layout, amplitude, packing):
        first, span = null_angle(machine, layout), pi / 3 / machine.pole_pairs
        angles = [first + span * k / _STEPS_OVER_PERIOD for k in range(_STEPS_OVER_PERIOD)]
        return [OperatingPoint(angle, amplitude, 0.0, packing) for angle in angles]

    def limited(self, aligned, tooth, back_iron):
        return max(tooth, back_iron)


READINGS = {reading.name: reading for reading in (AlignedTooth(), EveryTooth(), EveryToothAndBackIronOverPeriod())}
