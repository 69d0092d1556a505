"""The copper outside the iron, one kind of winding an object: how long an end turn is and what flux of its own it has.

A kind refuses the coils that it says nothing about. ``usual_end_turn`` is the rule where none is stated.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import asin, pi
from typing import ClassVar

from geometry.parts import DrawnMachine
from magnetostatics.end_effects import bundle_radius, end_turn_inductance
from units import MU_0


@dataclass(frozen=True)
class CoilSeat:
    """The slots that a coil lies in. Raises ValueError where they have no room for it.

    slots: N_s; pole_pairs: p; coil_pitch: y [slots], one or more; layers: coil sides of a slot, 1 or 2
    slot_inner_radius, slot_outer_radius: where a coil side begins and ends; R_1 = R_ro + g + d_1 + d_2 and
        R_2 = R_so - w_bi inside a stator around its rotor [m] (thesis eq. 3.86)
    tooth_width: w_tb [m]
    """

    slots: int
    pole_pairs: int
    slot_inner_radius: float
    slot_outer_radius: float
    tooth_width: float
    coil_pitch: int
    layers: int = 2

    def __post_init__(self) -> None:
        if self.coil_pitch < 1:
            raise ValueError(f"a coil spans one slot pitch or more; found {self.coil_pitch}")
        _check_slot(self.slots, self.slot_inner_radius, self.slot_outer_radius, self.tooth_width)

    @property
    def slot_pitch(self) -> float:
        """Arc between the axes of two slots at mid slot, tau_u [m]."""
        return pi * (self.slot_inner_radius + self.slot_outer_radius) / self.slots

    @property
    def span(self) -> float:
        """Arc between the axes of the two slots of a coil at mid slot, y tau_u [m]."""
        return self.coil_pitch * self.slot_pitch

    @property
    def tooth_coil_distance(self) -> float:
        """Arc between the centres of the two half-slots that a coil round one tooth fills, D_et [m].

        D_et = (R_1 + R_2)/2 theta_w                        (3.85)
        theta_w = pi/N_s + asin(w_tb / (R_1 + R_2))         (3.89)

        Equation 3.90 writes R_1 + R_2 without d_1 + d_2, against its own definition 3.86; the shoe is kept here (16.30
        mm of end turn instead of 15.72 mm on the 85 mm, 12-slot machine). Source: thesis eqs 3.85-3.89.
        """
        diameter = self.slot_inner_radius + self.slot_outer_radius
        return diameter / 2 * (pi / self.slots + asin(self.tooth_width / diameter))


def coil_seat(machine: DrawnMachine, coil_pitch: int, layers: int = 2) -> CoilSeat:
    """The slots of a machine that a coil lies in; coil_pitch [slots], layers: 1 or 2, dimensionless."""
    inner, outer = machine.stator.slot_radii
    width = machine.stator.probed_tooth_width
    return CoilSeat(machine.slots, machine.pole_pairs, inner, outer, width, coil_pitch, layers)


class EndTurn:
    """How the coils of a winding go round the ends of the stack; the concrete kinds are below."""

    name: ClassVar[str]

    def length(self, seat: CoilSeat) -> float:
        """Of one end turn, l_et [m]. Raises ValueError for a coil that the kind knows nothing of."""
        raise NotImplementedError

    def inductance(self, seat: CoilSeat, turns: float, coils_in_series: int, copper_area: float) -> float:
        """Leakage inductance of the end turns of one phase, both ends [H].

        turns: of a coil; coils_in_series: of a phase; copper_area: of a coil side [m^2]
        Raises ValueError for a coil that the kind knows nothing of.
        """
        raise NotImplementedError


@dataclass(frozen=True)
class ToothCoil(EndTurn):
    """Coils round single teeth: half a circle from half-slot to half-slot.

    l_et = pi D_et / 2 (thesis eq. 3.84); leakage: ``magnetostatics.end_effects.end_turn_inductance``, both half circles
    of a coil together a ring in air, without the coils beside it.
    """

    name: ClassVar[str] = "tooth_coil"

    def length(self, seat: CoilSeat) -> float:
        """Of one half circle [m]."""
        self._check(seat)
        return pi * seat.tooth_coil_distance / 2

    def inductance(self, seat: CoilSeat, turns: float, coils_in_series: int, copper_area: float) -> float:
        """Of rings in air [H]; turns: of a coil, copper_area [m^2]"""
        self._check(seat)
        return end_turn_inductance(seat.tooth_coil_distance / 2, bundle_radius(copper_area), turns, coils_in_series)

    def _check(self, seat: CoilSeat) -> None:
        if seat.coil_pitch != 1:
            raise ValueError(f"a tooth coil spans one slot pitch, found {seat.coil_pitch}: take the end turn of a lap")


@dataclass(frozen=True)
class Lap(EndTurn):
    """Coils over several slots that go back to the next coil of their own pole, of round wire.

    l_et = pi/2 (tau_u + w_tb)/2 + k_ov tau_u (y - 1)

    with tau_u the slot pitch at mid slot: the bend of a coil round one tooth, and on over y - 1 slots by as much more
    than the arc as it must rise to pass the other coils. Source: Bianchi, Bolognani and Frare, IEEE Trans. Energy
    Convers. 21(2) (2006) 421, as the documentation of Severson-Group/eMach quotes it, with its k_ov. Measured on the
    Prius 2004 (0.069 ohm): k_ov = 2.11; with 1.8 its phase has 8.5 % too little, with half circles 12.6 %.

    L = 2 mu_0 (N_c N)^2/p lambda,  lambda = 0.34 (l_et - 0.64 y tau_u) in two layers, 0.67 l_et - 0.43 y tau_u in one

    Source: Boldea and Nasar, The Induction Machines Design Handbook, eqs 15.75-15.79; as any such formula a mean over
    built machines (Vogt has lambda = 0.2 to 0.3 l_et), good to a third.

    overlength: k_ov, length of an end turn over the arc that it spans, one or more, dimensionless
    """

    overlength: float = 1.8
    name: ClassVar[str] = "lap"

    def length(self, seat: CoilSeat) -> float:
        """Of one end turn [m]."""
        self._check(seat)
        bend = pi * seat.tooth_coil_distance / 2
        return bend + self.overlength * seat.slot_pitch * (seat.coil_pitch - 1)

    def inductance(self, seat: CoilSeat, turns: float, coils_in_series: int, copper_area: float) -> float:
        """By the length alone [H]; turns: of a coil, copper_area [m^2] does not count.

        Raises ValueError for coils longer than a pole.
        """
        if 2 * seat.pole_pairs * seat.coil_pitch > seat.slots:
            raise ValueError(
                f"a coil pitch of {seat.coil_pitch} slots is longer than a pole of "
                f"{seat.slots / (2 * seat.pole_pairs):g}; the leakage of such end turns is not known: reduce coil_pitch"
            )
        length, span = self.length(seat), seat.span
        permeance = 0.34 * (length - 0.64 * span) if seat.layers == 2 else 0.67 * length - 0.43 * span
        return 2 * MU_0 * (coils_in_series * turns) ** 2 / seat.pole_pairs * permeance

    def _check(self, seat: CoilSeat) -> None:
        if self.overlength < 1:
            raise ValueError(f"an end turn is no shorter than its arc, found an overlength of {self.overlength:g}")
        if seat.coil_pitch == 1:
            raise ValueError(f'coils of a {self.name} winding span two slots or more, found 1: take "tooth_coil"')


@dataclass(frozen=True)
class Wave(Lap):
    """Coils that go on to the next pole pair: as long as those of a lap winding where all spans are a whole pole.

    A short-pitched one has two spans, y on one end and N_s/p - y on the other, and its leakage is not known here.
    """

    name: ClassVar[str] = "wave"

    def _check(self, seat: CoilSeat) -> None:
        super()._check(seat)
        if 2 * seat.pole_pairs * seat.coil_pitch != seat.slots:
            raise ValueError(
                f"a wave winding pitched by {seat.coil_pitch} slots in poles of "
                f"{seat.slots / (2 * seat.pole_pairs):g} has different spans at both ends, its leakage is not known: "
                'take the full pitch or "lap"'
            )


END_TURNS: Mapping[str, type[EndTurn]] = {kind.name: kind for kind in (ToothCoil, Lap, Wave)}


def usual_end_turn(coil_pitch: int) -> EndTurn:
    """Where none is stated: a tooth coil over one slot pitch, a lap over more; coil_pitch [slots]."""
    return ToothCoil() if coil_pitch == 1 else Lap()


def _check_slot(slots: int, slot_inner_radius: float, slot_outer_radius: float, tooth_width: float) -> None:
    if slot_outer_radius <= slot_inner_radius:
        raise ValueError(
            f"the slot has no depth: its bottom radius is {slot_outer_radius:.6g} m, the top of the shoe "
            f"{slot_inner_radius:.6g} m; reduce the rotor radius, the shoe or the back iron"
        )
    pitch = pi * (slot_inner_radius + slot_outer_radius) / slots
    if not 0 < tooth_width < pitch:
        raise ValueError(
            f"tooth width must lie between 0 and the slot pitch at mid slot, {pitch:.6g} m; found {tooth_width:.6g} m"
        )
