"""Active length of the wound machine behind its real gears.

The match finds a length for a packing factor and a ratio that are any number. Turns, wires in hand and teeth are whole
ones, so that ampere-turns and ratio come out a few per cent beside; the length, which can be cut to any number of
sheets, takes up the difference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, sqrt

from units import MILLIMETRE

LENGTH_STEP = 0.1 * MILLIMETRE  # to which lengths are rounded up
_ROUNDING = 1e-6  # of a step; a length this far above one counts as lying on it


@dataclass(frozen=True)
class LengthNeed:
    """One demand and the active length that it asks for [m]."""

    name: str
    length: float


@dataclass(frozen=True)
class FinalLength:
    """The length [m], the demand that sets it, and whether the longest allowed length is too short for it."""

    length: float
    set_by: LengthNeed
    short: bool


def length_for_torque(torque: float, torque_per_length: float) -> float:
    """l = T / r (3.66) [m]; torque [Nm], torque_per_length: of the wound machine [Nm/m]."""
    return torque / torque_per_length


def length_for_damping(damping: float, *, reached: float, length: float, end_turn_length: float) -> float:
    """Length with a damping, from the damping ``reached`` at another length [m]: c ~ l^2 / (l + l_et) (3.91).

    damping, reached: [Nms/rad or Ns/m], both the same

    The positive root of l^2 = a (l + l_et),  a = c / c_reached l_0^2 / (l_0 + l_et)
    """
    a = damping / reached * length**2 / (length + end_turn_length)
    return (a + sqrt(a * a + 4 * a * end_turn_length)) / 2


def final_length(needs: Sequence[LengthNeed], longest: float) -> FinalLength:
    """The largest of the needs, rounded up to ``LENGTH_STEP``, at most ``longest`` [m]."""
    hardest = max(needs, key=lambda need: need.length)
    rounded = ceil(hardest.length / LENGTH_STEP - _ROUNDING) * LENGTH_STEP
    return FinalLength(min(rounded, longest), hardest, hardest.length > longest)
