"""Which lead of which coil goes where: the star of slots as the workshop winds it.

The leads are taken to lie at the end of the stack that the cross-section shows (+z, towards the viewer). All coils are
wound alike; one whose sign is -1 is connected the other way round. Coils of a path follow each other in series by
rising index, from the terminal where the phase begins to where it ends: the star point, or a delta's next terminal.
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
    path: of its phase, from 0; teeth: inside the coil, counter-clockwise
    previous: index of the coil before, None where the phase begins; following: None where it ends
    """

    coil: int
    phase: int
    path: int
    reversed: bool
    from_slot: int
    to_slot: int
    teeth: tuple[int, ...]
    previous: int | None
    following: int | None


def connections(layout: WindingLayout, paths: int) -> tuple[Connection, ...]:
    """Every coil of the winding with ``paths`` parallel paths a phase, path by path in the order of its current.

    Raises GeometryError when the star of slots has no such division.
    """
    return tuple(
        one
        for phase in range(layout.phases)
        for path, coils in enumerate(layout.paths_of(phase, paths))
        for one in _in_series(layout, path, coils)
    )


def _in_series(layout: WindingLayout, path: int, coils: tuple[Coil, ...]) -> Iterator[Connection]:
    indices = [None, *(coil.index for coil in coils), None]
    for coil, (previous, _), (_, following) in zip(coils, pairwise(indices), pairwise(indices[1:])):
        down, up = (coil.back, coil.go) if coil.sign > 0 else (coil.go, coil.back)
        yield Connection(coil.index, coil.phase, path, coil.sign < 0, down[0], up[0], _teeth(layout, coil),
                         previous, following)  # fmt: skip


def _teeth(layout: WindingLayout, coil: Coil) -> tuple[int, ...]:
    """Tooth k+1 follows slot k counter-clockwise; a coil goes back in slot k - y."""
    return tuple((coil.back[0] + 1 + step) % layout.slots for step in range(layout.coil_pitch))
