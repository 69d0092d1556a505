"""Rotor positions and currents with a name: the q-axis position, the null state and the positions of a period.

The thesis looks at one state only: a magnet exactly on a tooth and the current of phase A at its peak ("null electrical
angle"). A magnet meets a tooth every 2 pi / lcm(slots, poles); of these positions the null state is the one closest to
the q axis (12/10: 3 mechanical degrees from it, theta = -24 deg, gamma = +15 deg electrical).
"""

from __future__ import annotations

from math import ceil, lcm, pi

from geometry.parts import DrawnMachine
from geometry.winding import WindingLayout
from magnetostatics.model import OperatingPoint


def torque_period(machine: DrawnMachine) -> float:
    """Electrical angle after which every quantity in the rotor frame of three balanced phases repeats [rad]: a sixth of
    a period, a third where north and south poles are not alike."""
    return pi / 3 if machine.half_wave else 2 * pi / 3


def angles_past_slots(machine: DrawnMachine, fewest: int) -> int:
    """How many rotor angles a mean over a period of the torque is taken of: ``fewest``, or the next number that is not
    blind to the slots.

    n angles over a period theta of the torque cannot tell the electrical order n 2 pi/theta from the mean, that of the
    slots is lcm(slots, pitches of the rotor)/p: at 48 slots and 4 poles four over 60 degrees are a slot pitch apart, at
    12 slots and 10 poles two.
    """
    count, slots = fewest, lcm(machine.slots, machine.repeats) // machine.pole_pairs
    while slots % round(count * 2 * pi / torque_period(machine)) == 0:
        count += 1
    return count


def q_axis_angle(machine: DrawnMachine, layout: WindingLayout) -> float:
    """Rotor angle at which the q-axis current has its peak in phase A [rad]: p theta = axis_A - 90 deg."""
    return (layout.phase_axis - pi / 2) / machine.pole_pairs


def null_angle(machine: DrawnMachine, layout: WindingLayout) -> float:
    """Rotor angle nearest to the q-axis angle with a magnet centred on a tooth [rad]; of two equals the smaller."""
    step = 2 * pi / lcm(machine.slots, machine.repeats)
    return step * ceil(q_axis_angle(machine, layout) / step - 0.5 - 1e-9)


def null_point(machine: DrawnMachine, layout: WindingLayout, amplitude: float, packing: float) -> OperatingPoint:
    """The null state: a magnet on a tooth, phase A at its peak.

    amplitude: of the current density in the copper [A/m^2]; packing: copper share of the slot
    """
    return OperatingPoint(null_angle(machine, layout), amplitude, null_current_angle(machine, layout), packing)


def period_points(
    machine: DrawnMachine, layout: WindingLayout, amplitude: float, packing: float, steps: int
) -> list[OperatingPoint]:
    """The q-axis current at ``steps`` rotor positions from the null position on, evenly over a period of the torque.

    amplitude: of the current density in the copper [A/m^2]
    After these a balanced winding sees the same field in other teeth, so they stand for the whole period.
    """
    first, span = null_angle(machine, layout), torque_period(machine) / machine.pole_pairs
    return [OperatingPoint(first + span * k / steps, amplitude, 0.0, packing) for k in range(steps)]


def null_current_angle(machine: DrawnMachine, layout: WindingLayout) -> float:
    """Current angle gamma at which phase A has its peak in the null position [rad]."""
    return machine.pole_pairs * (q_axis_angle(machine, layout) - null_angle(machine, layout))


def aligned_teeth(machine: DrawnMachine, angle: float) -> tuple[int, ...]:
    """Teeth of the whole machine that have a magnet exactly in front of them at a rotor angle [rad]."""
    return tuple(k for k in range(machine.slots) if _distance_to_magnet(machine, k, angle) < 1e-6)


def _distance_to_magnet(machine: DrawnMachine, tooth: int, angle: float) -> float:
    """Angle from a tooth to the nearest magnet centre, as a share of the pole pitch."""
    position = (tooth * machine.slot_pitch - angle) / machine.rotor.pitch
    return abs(position - round(position))
