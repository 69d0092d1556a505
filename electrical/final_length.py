"""Active length of the wound machine behind its real gears.

The match finds a length for a packing factor and a ratio that are any number. Turns, wires in hand and teeth are whole
ones, so that ampere-turns and ratio come out a few per cent beside; the length, which can be cut to any number of
sheets, takes up the difference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, inf, sqrt
from typing import ClassVar

from electrical.dq import DqMachine, mtpa_currents
from electrical.winding_design import WindingDesign
from units import MILLIMETRE

LENGTH_STEP = 0.1 * MILLIMETRE  # to which lengths are rounded up
_ROUNDING = 1e-6  # of a step; a length this far above one counts as lying on it


@dataclass(frozen=True)
class LengthNeed:
    """One demand and the active length that it asks for [m], infinite where no length meets it."""

    name: str
    length: float


class ContinuousNeed:
    """The active length that the torque for good asks for; what limits it is known by the concrete one.

    name: of the demand, in words
    """

    name: ClassVar[str]

    @property
    def density(self) -> float | None:
        """RMS current density in the copper for good [A/m^2], None where the temperatures decide."""
        return None

    def length(self, design: WindingDesign) -> float:
        """Of a machine with this winding [m], infinite where no length is enough; only gauge, copper and closing of
        the design count."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class LengthByDensity(ContinuousNeed):
    """By a current density that is stated; machine: of one turn and one metre; torque: for good, with what the mesh may
    have put on top [Nm]; stated: RMS in the copper [A/m^2]."""

    machine: DqMachine
    torque: float
    stated: float
    name: ClassVar[str] = "the RMS torque at the nominal current density"

    @property
    def density(self) -> float:
        """density: the stated one [A/m^2]"""
        return self.stated

    def length(self, design: WindingDesign) -> float:
        """[m]"""
        currents = mtpa_currents(self.machine, sqrt(2) * self.stated * design.copper_area)
        return length_for_torque(self.torque, float(self.machine.torque(*currents)))


@dataclass(frozen=True)
class FinalLength:
    """The length [m], every demand, and the longest length that is allowed [m]."""

    length: float
    needs: tuple[LengthNeed, ...]
    longest: float

    @property
    def set_by(self) -> LengthNeed:
        """The demand that asks for most, of those that some length meets."""
        return hardest(self.needs)

    @property
    def short(self) -> bool:
        """Whether the longest allowed length is too short for what sets it."""
        return self.set_by.length > self.longest


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
    """The largest of the needs that some length meets, rounded up to ``LENGTH_STEP``, at most ``longest`` [m].

    One of them at least is finite.
    """
    rounded = ceil(hardest(needs).length / LENGTH_STEP - _ROUNDING) * LENGTH_STEP
    return FinalLength(min(rounded, longest), tuple(needs), longest)


def hardest(needs: Sequence[LengthNeed]) -> LengthNeed:
    """The one that asks for most, of those that some length meets; one of them at least does."""
    return max((one for one in needs if one.length < inf), key=lambda one: one.length)
