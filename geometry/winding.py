"""Three-phase winding of a slotted stator by the star of slots.

Conventions: slot k lies between tooth k and tooth k+1, x axis through the centre of tooth 0, counter-clockwise
positive, z out of the page. A slot holds two sides, "R" (clockwise half, next to tooth k) and "L" (next to tooth k+1).
Coil k of pitch y goes in +z in slot k and comes back in -z in slot k-y. With y = 1 that is a coil around tooth k, and
a positive current makes flux outwards through that tooth. The magnetic axis of coil k stands at

    alpha_k = 2 pi k/N_s - (y - 1) pi/N_s   mechanical,   p alpha_k electrical

and its electrical angle decides the phase: A+ [-30, 30), C- [30, 90), B+ [90, 150), A- [150, 210), C+ [210, 270),
B- [270, 330) degrees, so that B follows A by +120 degrees. Angles are counted in whole steps of 180/N_s degrees, which
keeps the edges of these half-open sectors exact. Source: Bianchi, Dai Pre, "Use of the star of slots in designing
fractional-slot single-layer synchronous motors", IEE Proc. Electr. Power Appl. 153 (2006); the placing of the sectors
is a convention.
"""

from __future__ import annotations

from cmath import exp
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from math import ceil, gcd, pi, sin
from typing import ClassVar

from geometry.errors import GeometryError

PHASES = 3
RIGHT, LEFT, WHOLE = "R", "L", "RL"  # sides of a slot; a single-layer coil side fills both
# Phase (0 A, 1 B, 2 C) and sign of the six sectors, counter-clockwise from A+.
SECTOR_BELTS = ((0, 1), (2, -1), (1, 1), (0, -1), (2, 1), (1, -1))
WIDEST_SEARCH = 24  # slots away from an infeasible number at which neighbours are looked for


@dataclass(frozen=True)
class Coil:
    """One coil: current in phase ``phase`` flows, times ``sign``, in +z through ``go`` and in -z through ``back``.

    turns: relative to those of a coil as designed; a coil of 20 turns with two of them shorted and idle has 0.9
    """

    index: int
    phase: int  # 0 A, 1 B, 2 C
    sign: int  # +1 or -1
    go: tuple[int, str]  # slot and side
    back: tuple[int, str]
    turns: float = 1.0


@dataclass(frozen=True)
class WindingLayout:
    """Balanced three-phase winding. Build it with ``star_of_slots``.

    Fields and flux linkages are those of all coils of a phase in series; ``paths_of`` connects them in parallel.
    """

    slots: int
    pole_pairs: int
    layers: int  # coil sides per slot, 1 or 2
    coil_pitch: int  # y, in slots
    coils: tuple[Coil, ...]

    phases: ClassVar[int] = PHASES

    @property
    def coils_in_series(self) -> int:
        """Coils of one phase, all in series."""
        return len(self.coils) // self.phases

    @cached_property
    def phase_axis(self) -> float:
        """Electrical angle of the magnetic axis of phase A [rad], in [-pi/6, pi/6].

        The signed axes of a phase are equally spaced, so their mean is the direction of their sum.
        """
        return pi / self.slots * sum(self._steps_along_axis()) / self.coils_in_series

    def coils_of(self, phase_index: int) -> tuple[Coil, ...]:
        """The coils of phase 0 (A), 1 (B) or 2 (C), by rising index."""
        return tuple(coil for coil in self.coils if coil.phase == phase_index)

    @property
    def path_numbers(self) -> tuple[int, ...]:
        """Numbers of equal parallel paths that a phase divides into, rising: divisors of the number of coils that
        every direction of its star has. 12 slots, 10 poles: 1 and 2, since its four coils lie in two directions."""
        each = gcd(*(len(coils) for coils in self._directions_of(0)))
        return tuple(number for number in range(1, each + 1) if each % number == 0)

    def paths_of(self, phase_index: int, paths: int) -> tuple[tuple[Coil, ...], ...]:
        """The coils of each of ``paths`` parallel paths of a phase, by rising index.

        Each has as many coils of every direction as the others. Coils of one direction are turned into each other by
        whole poles of the rotor, so that the EMFs of the paths are equal at every load and none circulates.
        Raises GeometryError when the star of slots has no such division.
        """
        if paths not in self.path_numbers:
            raise GeometryError(
                f"{paths} parallel paths are not equal with {self.slots} slots and {2 * self.pole_pairs} poles: the "
                f"{self.coils_in_series} coils of a phase lie in {len(self._directions_of(0))} directions of the star "
                f"of slots, and every path needs as many of each; take {_one_of(self.path_numbers)}"
            )
        shares = [_in_parts(coils, paths) for coils in self._directions_of(phase_index)]
        return tuple(
            tuple(sorted((coil for part in parts for coil in part), key=lambda coil: coil.index))
            for parts in zip(*shares, strict=True)
        )

    def _directions_of(self, phase_index: int) -> list[tuple[Coil, ...]]:
        """The coils of a phase by the electrical angle of their signed axes."""
        groups: dict[int, list[Coil]] = {}
        for coil in self.coils_of(phase_index):
            angle = _axis_steps(self.slots, self.pole_pairs, self.coil_pitch, coil.index)
            groups.setdefault((angle + (coil.sign < 0) * self.slots) % (2 * self.slots), []).append(coil)
        return [tuple(coils) for coils in groups.values()]

    def with_turns(self, turns: Mapping[int, float]) -> WindingLayout:
        """The same winding with other turns in some coils: {index of the coil: turns relative to the design}.

        Raises GeometryError when there is no such coil or a number of turns is negative.
        """
        for index, number in turns.items():
            if index not in {coil.index for coil in self.coils}:
                raise GeometryError(f"there is no coil {index}: a coil has the number of the slot that it goes in")
            if not number >= 0:
                raise GeometryError(f"the relative turns of a coil are zero or more, found {number} for coil {index}")
        return replace(self, coils=tuple(replace(coil, turns=turns.get(coil.index, coil.turns)) for coil in self.coils))

    def coil_side(self, slot: int, side: str) -> tuple[int, int]:
        """Phase and direction of the current in one half of a slot: +1 in +z, -1 in -z for a positive phase current.

        slot: any integer, counted round the machine
        side: "R" or "L"
        """
        coil, direction = self.coil_at(slot, side)
        return coil.phase, coil.sign * direction

    def coil_at(self, slot: int, side: str) -> tuple[Coil, int]:
        """The coil in one half of a slot, and +1 where it goes in +z, -1 where it comes back; see ``coil_side``."""
        if side not in (RIGHT, LEFT):
            raise GeometryError(f"the sides of a slot are 'R' and 'L', found {side!r}")
        found = self._sides.get((slot % self.slots, side))
        if found is None:
            raise GeometryError(f"no coil side in slot {slot}, side {side}")
        return found

    @cached_property
    def _sides(self) -> dict[tuple[int, str], tuple[Coil, int]]:
        """The coil in every half of a slot and its direction; every field problem asks for all of them."""
        there = {half: (coil, -1) for coil in self.coils for half in _halves(coil.back)}
        return there | {half: (coil, 1) for coil in self.coils for half in _halves(coil.go)}

    def winding_factor(self, order: float = 1) -> float:
        """k_w of a harmonic: vector sum of the coils over their arithmetic sum, times the pitch factor.

            k_w = |sum_k s_k exp(j nu p alpha_k)|/n * |sin(nu p y pi/N_s)|

        order: nu, harmonic of the electrical angle; the n-th space harmonic of the machine is n/p
        Returns a number from 0 to 1. Slots count as points at their centre lines (no slot-opening factor).
        """
        step = pi / self.slots
        phasors = (
            coil.sign * exp(1j * order * self.pole_pairs * (2 * coil.index - self.coil_pitch + 1) * step)
            for coil in self.coils_of(0)
        )
        pitch_factor = abs(sin(order * self.pole_pairs * self.coil_pitch * step))
        return abs(sum(phasors)) / self.coils_in_series * pitch_factor

    def _steps_along_axis(self) -> list[int]:
        """Electrical angles of the signed axes of phase A in steps of pi/N_s, from -N_s to N_s - 1."""
        turn = 2 * self.slots
        angles = (_axis_steps(self.slots, self.pole_pairs, self.coil_pitch, coil.index) for coil in self.coils_of(0))
        turned = (angle + (coil.sign < 0) * self.slots for angle, coil in zip(angles, self.coils_of(0), strict=True))
        return [(angle + self.slots) % turn - self.slots for angle in turned]


@lru_cache
def star_of_slots(slots: int, pole_pairs: int, layers: int = 2, coil_pitch: int | None = None) -> WindingLayout:
    """The winding of a stator.

    slots: N_s; pole_pairs: p
    layers: 2, a coil per slot; 1, every second coil only, each coil side filling its slot (even N_s, odd pitch)
    coil_pitch: y in slots; None takes the pitch, up to one pole, with the largest winding factor, the shorter of equals
    Raises GeometryError when the three phases cannot be equal and 120 degrees apart, or link no flux; the message
    gives the reason and neighbouring numbers of slots that can be wound.
    """
    _check_numbers(slots, pole_pairs, layers, coil_pitch)
    reason = _obstacle(slots, pole_pairs, layers, coil_pitch)
    if reason:
        raise GeometryError(
            f"{slots} slots with {2 * pole_pairs} poles cannot carry this winding: {reason}; "
            f"{_advice(slots, pole_pairs, layers)}"
        )
    if coil_pitch is None:
        return _best_pitch(slots, pole_pairs, layers)
    return _layout(slots, pole_pairs, layers, coil_pitch)


def is_feasible(slots: int, pole_pairs: int, layers: int = 2) -> bool:
    """Whether a balanced three-phase winding exists: the star must have a multiple of three directions."""
    _check_numbers(slots, pole_pairs, layers, None)
    return not _obstacle(slots, pole_pairs, layers, None)


def sector_symmetric(layout: WindingLayout, sectors: int, antiperiodic: bool) -> bool:
    """Whether the winding repeats itself in every one of ``sectors`` equal sectors, with the sign changed from one to
    the next when ``antiperiodic`` (12 slots, 10 poles: two sectors, antiperiodic, coil k+6 is minus coil k)."""
    if layout.slots % sectors:
        return False
    step, sign = layout.slots // sectors, -1 if antiperiodic else 1
    for slot in range(layout.slots):
        for side in (RIGHT, LEFT):
            (here, go), (there, come) = layout.coil_at(slot, side), layout.coil_at(slot + step, side)
            if (there.phase, there.sign * come, there.turns) != (here.phase, sign * here.sign * go, here.turns):
                return False
    return True


def _axis_steps(slots: int, pole_pairs: int, coil_pitch: int, coil: int) -> int:
    """Electrical angle of a coil's axis in steps of pi/N_s, 2 N_s steps to the turn."""
    return pole_pairs * (2 * coil - coil_pitch + 1) % (2 * slots)


def _belt(slots: int, steps: int) -> tuple[int, int]:
    """Phase and sign of a coil at an electrical angle of ``steps`` pi/N_s: floor((angle + 30)/60) in integers."""
    return SECTOR_BELTS[(6 * steps + slots) // (2 * slots) % 6]


def _layout(slots: int, pole_pairs: int, layers: int, coil_pitch: int) -> WindingLayout:
    go_side, back_side = (RIGHT, LEFT) if layers == 2 else (WHOLE, WHOLE)
    coils = []
    for k in range(0, slots, 3 - layers):
        phase_index, sign = _belt(slots, _axis_steps(slots, pole_pairs, coil_pitch, k))
        coils.append(Coil(k, phase_index, sign, (k, go_side), ((k - coil_pitch) % slots, back_side)))
    return WindingLayout(slots, pole_pairs, layers, coil_pitch, tuple(coils))


def _best_pitch(slots: int, pole_pairs: int, layers: int) -> WindingLayout:
    """Layout with the largest fundamental winding factor; max keeps the first, that is the shortest, of equals."""
    pitches = range(1, ceil(slots / (2 * pole_pairs)) + 1, 3 - layers)
    layouts = (_layout(slots, pole_pairs, layers, pitch) for pitch in pitches)
    return max(layouts, key=lambda layout: round(layout.winding_factor(), 9))


def _in_parts(coils: tuple[Coil, ...], count: int) -> list[tuple[Coil, ...]]:
    """Equal parts of neighbouring coils."""
    each = len(coils) // count
    return [coils[k : k + each] for k in range(0, len(coils), each)]


def _one_of(numbers: tuple[int, ...]) -> str:
    return " or ".join(str(number) for number in numbers)


def _halves(place: tuple[int, str]) -> list[tuple[int, str]]:
    slot, sides = place
    return [(slot, side) for side in sides]


def _check_numbers(slots: int, pole_pairs: int, layers: int, coil_pitch: int | None) -> None:
    if slots < 3 or pole_pairs < 1:
        raise GeometryError(f"a winding needs 3 slots and 1 pole pair or more, found {slots} and {pole_pairs}")
    if layers not in (1, 2):
        raise GeometryError(f"a slot holds one or two layers, found {layers}")
    if coil_pitch is not None and not 1 <= coil_pitch < slots:
        raise GeometryError(f"a coil pitch lies between 1 and {slots - 1} slots here, found {coil_pitch}")


def _obstacle(slots: int, pole_pairs: int, layers: int, coil_pitch: int | None) -> str:
    """Why a winding is impossible; empty when it is possible."""
    if layers == 1 and slots % 2:
        return "a single layer needs an even number of slots"
    if layers == 1 and coil_pitch is not None and coil_pitch % 2 == 0:
        return f"a single layer needs an odd coil pitch, found {coil_pitch}"
    if coil_pitch is not None and pole_pairs * coil_pitch % slots == 0:
        return f"a coil pitch of {coil_pitch} slots spans whole pole pairs and links no flux"
    coils = slots * layers // 2
    directions = coils // gcd(coils, pole_pairs)
    if coils % PHASES:
        return f"{coils} coils do not divide into three phases"
    if directions % PHASES:
        return f"its coils have only {directions} electrical directions, none 120 degrees apart"
    return ""


def _advice(slots: int, pole_pairs: int, layers: int) -> str:
    """The nearest feasible numbers of slots, one on either side."""
    down = [n for n in range(slots - 1, 2, -1) if not _obstacle(n, pole_pairs, layers, None)][:1]
    up = [n for n in range(slots + 1, slots + WIDEST_SEARCH) if not _obstacle(n, pole_pairs, layers, None)][:1]
    if not _obstacle(slots, pole_pairs, layers, None):
        return "leave the coil pitch to the program or change it"
    return f"take {' or '.join(str(n) for n in down + up)} slots, or another number of poles"
