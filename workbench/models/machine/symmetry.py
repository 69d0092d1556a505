"""How samples of a machine follow from those at other angles and with other currents.

A sample is [torque, psi of coil 0, psi of coil 1, ...], see ``field.py``. Currents look on as fluxes do:

    a slot pitch on, with the same rotor:  coil k sees what coil k - 1 saw
    a pole pitch on, with the same stator: every coil sees the same with the opposite sign
    in a mirror, with both as they are:    the torque is the opposite, coil -k sees what coil k saw
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import lcm, pi

import numpy as np

from effects.machine_design import MachineAsBuilt

_FINEST = 1e-6  # of an angle [deg] and of ampere-turns: states that differ by less are one


@dataclass(frozen=True, eq=False)
class Symmetry:
    """At step ``way * n + steps`` the sample is ``sign * sample[place]`` of the one at n; way: -1 of a mirror, or 1"""

    steps: int
    place: np.ndarray
    sign: np.ndarray
    way: int = 1

    def __call__(self, n: int) -> int:
        """The step that it leads to from step n."""
        return self.way * n + self.steps

    def change(self, sample: np.ndarray) -> np.ndarray:
        """The sample there from the one here (..., 1 + coils)."""
        return self.sign * sample[..., self.place]

    def after(self, first: Symmetry) -> Symmetry:
        """The two, one after the other."""
        place, sign = first.place[self.place], self.sign * first.sign[self.place]
        return Symmetry(self(first.steps), place, sign, self.way * first.way)

    def key(self, count: int) -> tuple:
        """What tells it from others, with ``count`` steps to a revolution."""
        return self.way, self.steps % count, self.place.tobytes(), self.sign.tobytes()


def slot_pitch(edges: int, slots: int) -> Symmetry:
    """A slot pitch on, where the stator is regular."""
    place = np.append(0, 1 + np.roll(np.arange(slots), 1))
    return Symmetry(edges // slots, place, np.ones(1 + slots))


def pole_pitch(edges: int, slots: int, poles: int) -> Symmetry:
    """A pole pitch on, where the rotor is regular."""
    return Symmetry(edges // poles, np.arange(1 + slots), np.append(1.0, -np.ones(slots)))


def mirror(edges: int, slots: int, poles: int, tooth: int = 0, magnet: int = 0) -> Symmetry:
    """The mirror in which tooth 0 is seen at ``tooth`` and magnet 0 at ``magnet``.

    Flux outwards stays so, but for the sign of the poles where north is seen at south.
    """
    place = np.append(0, 1 + (tooth - np.arange(slots)) % slots)
    sign = np.append(-1.0, np.full(slots, (-1.0) ** magnet))
    return Symmetry(tooth * edges // slots - magnet * edges // poles, place, sign, way=-1)


def symmetries_of(design: MachineAsBuilt, edges: int) -> tuple[Symmetry, ...]:
    """Those that all others of a design follow from; ``edges``: steps to a revolution."""
    slots, poles, axes = design.machine.slots, design.machine.poles, mirror_axes(design)
    found = (slot_pitch(edges, slots),) if stator_is_regular(design) else ()
    found += (pole_pitch(edges, slots, poles),) if rotor_is_regular(design) else ()
    return found if axes is None else (*found, mirror(edges, slots, poles, *axes))


# ---- a revolution without current ------------------------------------------------------------------------------------


def window_of(design: MachineAsBuilt, edges: int) -> range:
    """The steps without current that all others of a revolution follow from."""
    slots, poles, axes = design.machine.slots, design.machine.poles, mirror_axes(design)
    parts = {(True, True): lcm(slots, poles), (True, False): slots, (False, True): poles}
    period = edges // parts.get((stator_is_regular(design), rotor_is_regular(design)), 1)
    return range(period) if axes is None else half_of(period, mirror(edges, slots, poles, *axes).steps)


def half_of(period: int, steps: int) -> range:
    """Of the steps of a period those that all others follow from in a mirror, which leads from n to ``steps`` - n."""
    return range(-(-steps // 2), (steps + period) // 2 + 1)


def complete(
    known: dict[tuple[int, int], np.ndarray], count: int, members: int, moves: Iterable[tuple[Symmetry, int]]
) -> dict[tuple[int, int], np.ndarray]:
    """Samples of a whole revolution by (step, member) from those of a window.

    count: steps of a revolution; members: of a family of equal parts, 1 when there is none
    moves: a symmetry, and by how much the number of the member grows with it; a mirror counts them backwards
    """
    known, waiting = dict(known), list(known)
    while waiting:
        n, m = waiting.pop()
        for symmetry, shift in moves:
            there = symmetry(n) % count, (symmetry.way * m + shift) % members
            if there not in known:
                known[there] = symmetry.change(known[n, m])
                waiting.append(there)
    return known


# ---- states with current ---------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Alike:
    """Which of some states have to be solved, and how the samples at all of them follow.

    solved: numbers of states;  place, moves: of every state, the one of the solved that it follows from and how
    """

    solved: tuple[int, ...]
    place: tuple[int, ...]
    moves: tuple[Symmetry, ...]

    def of(self, states: Sequence) -> tuple:
        """Those to solve."""
        return tuple(states[k] for k in self.solved)

    def rows(self, found: np.ndarray) -> np.ndarray:
        """Samples at all states (states, ..., 1 + coils) from those at the solved ones, or derivatives by what leaves
        the symmetry."""
        return np.array([move.change(found[k]) for k, move in zip(self.place, self.moves, strict=True)])

    @property
    def are_mirrored(self) -> np.ndarray:
        """Whether a state is seen in a mirror, what lies ahead of it there behind it here (states,)."""
        return np.array([move.way < 0 for move in self.moves])


def alike(angles: np.ndarray, ampere_turns: np.ndarray, symmetries: Sequence[Symmetry], edges: int) -> Alike:
    """States that are one but for symmetries, with ``edges`` steps to a revolution.

    angles: of the rotor [rad] (n,);  ampere_turns: of the coils (n, coils) [A]
    """
    group = _group(symmetries, edges, ampere_turns.shape[1])
    known: dict[bytes, tuple[int, Symmetry]] = {}
    solved, found = [], []
    for number, (angle, currents) in enumerate(zip(angles, ampere_turns, strict=True)):
        here = _keys(angle[None], currents[None])[0]
        if here not in known:
            for key, move in zip(_images(group, edges, angle, currents), group):
                known.setdefault(key, (len(solved), move))
            solved.append(number)
        found.append(known[here])
    return Alike(tuple(solved), tuple(k for k, _ in found), tuple(move for _, move in found))


def _group(symmetries: Sequence[Symmetry], edges: int, coils: int) -> list[Symmetry]:
    """All that some symmetries make one after another, nothing the first."""
    nothing = Symmetry(0, np.arange(1 + coils), np.ones(1 + coils))
    known, waiting = {nothing.key(edges): nothing}, [nothing]
    while waiting:
        last = waiting.pop()
        for more in (symmetry.after(last) for symmetry in symmetries):
            if more.key(edges) not in known:
                known[more.key(edges)] = more
                waiting.append(more)
    return list(known.values())


def _images(group: Sequence[Symmetry], edges: int, angle: float, currents: np.ndarray) -> list[bytes]:
    """Where a state is seen by each of a group."""
    angles = np.array([move(0) * 2 * pi / edges + move.way * angle for move in group])
    seen = np.array([move.change(np.append(1.0, currents))[1:] for move in group])
    return _keys(angles, seen)


def _keys(angles: np.ndarray, currents: np.ndarray) -> list[bytes]:
    degrees = np.rint(np.degrees(angles) / _FINEST) % round(360 / _FINEST)
    rows = np.column_stack([degrees, np.rint(currents / _FINEST)]).astype(np.int64)
    return [row.tobytes() for row in rows]


# ---- what a design has -----------------------------------------------------------------------------------------------


def stator_is_regular(design: MachineAsBuilt) -> bool:
    """All slots alike and the bore about the axis of rotation."""
    return not any(design.opening_changes) and not any(design.stator_shift)


def rotor_is_regular(design: MachineAsBuilt) -> bool:
    """All magnets alike, in their places, and about the axis of rotation."""
    equal = all(strength == 1.0 for strength in design.magnet_strengths)
    return equal and not any(design.magnet_turns) and not any(design.rotor_shift)


def is_symmetric(design: MachineAsBuilt) -> bool:
    """Stator and rotor are regular."""
    return stator_is_regular(design) and rotor_is_regular(design)


def mirror_axes(design: MachineAsBuilt) -> tuple[int, int] | None:
    """Tooth and magnet at which a mirror that changes nothing of the design shows tooth 0 and magnet 0; None where
    there is no such mirror. A shift is looked for along the axis of tooth 0 or magnet 0 only."""
    tooth = next((k for k in range(design.machine.slots) if _stator_is_mirrored(design, k)), None)
    magnet = next((k for k in range(design.machine.poles) if _rotor_is_mirrored(design, k)), None)
    return None if tooth is None or magnet is None else (tooth, magnet)


def _stator_is_mirrored(design: MachineAsBuilt, tooth: int) -> bool:
    """Slot s lies between teeth s and s + 1, which are seen at tooth - s and tooth - s - 1."""
    return _is_along(design.stator_shift, tooth) and design.opening_changes == _seen(design.opening_changes, tooth - 1)


def _rotor_is_mirrored(design: MachineAsBuilt, magnet: int) -> bool:
    turns = tuple(-turn for turn in design.magnet_turns)
    equal = design.magnet_strengths == _seen(design.magnet_strengths, magnet)
    return _is_along(design.rotor_shift, magnet) and equal and design.magnet_turns == _seen(turns, magnet)


def _is_along(shift: tuple[float, float], number: int) -> bool:
    return not any(shift) or (number == 0 and shift[1] == 0.0)


def _seen(numbers: tuple[float, ...], first: int) -> tuple[float, ...]:
    """Those that a mirror shows at 0, 1, ... when it shows the first one at ``first``."""
    return tuple(numbers[(first - k) % len(numbers)] for k in range(len(numbers)))
