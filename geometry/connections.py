"""Which lead of which coil goes where: the star of slots as the workshop winds it, phases in star.

The leads are taken to lie at the end of the stack that the cross-section shows (+z, towards the viewer). All coils are
wound alike; one whose sign is -1 is connected the other way round. Coils of a phase follow each other in series by
rising index, from the terminal to the star point.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from geometry.winding import Coil, WindingLayout


@dataclass(frozen=True)
class Connection:
    """One coil between two others; slots, teeth and coils are counted from 0, see ``geometry.winding``.

    coil, phase: indices; reversed: whether it is connected the other way round
    from_slot: where a positive phase current goes down from the leads, in -z; to_slot: where it comes back, in +z
    teeth: inside the coil, counter-clockwise
    previous: index of the coil before, None where the terminal of the phase is; following: None at the star point
    """

    coil: int
    phase: int
    reversed: bool
    from_slot: int
    to_slot: int
    teeth: tuple[int, ...]
    previous: int | None
    following: int | None


def connections(layout: WindingLayout) -> tuple[Connection, ...]:
    """Every coil of the winding, phase by phase in the order of its current."""
    return tuple(one for phase in range(layout.phases) for one in _in_series(layout, layout.coils_of(phase)))


def _in_series(layout: WindingLayout, coils: tuple[Coil, ...]) -> Iterator[Connection]:
    indices = [None, *(coil.index for coil in coils), None]
    for coil, (previous, _), (_, following) in zip(coils, pairwise(indices), pairwise(indices[1:])):
        down, up = (coil.back, coil.go) if coil.sign > 0 else (coil.go, coil.back)
        yield Connection(coil.index, coil.phase, coil.sign < 0, down[0], up[0], _teeth(layout, coil),
                         previous, following)  # fmt: skip


def _teeth(layout: WindingLayout, coil: Coil) -> tuple[int, ...]:
    """Tooth k+1 follows slot k counter-clockwise; a coil goes back in slot k - y."""
    return tuple((coil.back[0] + 1 + step) % layout.slots for step in range(layout.coil_pitch))
