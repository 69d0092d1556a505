"""Solves pieces after one another, with the memory that the pieces of one kind need."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

from workbench.models.machine.pieces import Arrays, Fields, Kind, Machinery, Piece, States, Task

_NO_LOAD_WHOLE = (False, True)


class Solver:
    """The field problems of a machine in this process, of one kind of pieces at a time.

    The patterns of all rotor angles are most of the memory (70 MB of a whole machine), and the next kind has no use for
    those of the kind before.
    """

    def __init__(self, machinery: Machinery):
        self.fields = Fields(machinery)
        self._kind: Kind | None = None

    def solve(self, piece: Piece, states: States) -> Arrays:
        """The results of a piece."""
        self._prepare(piece.kind)
        return piece.solve(self.fields, states)

    def _prepare(self, kind: Kind | None) -> None:
        if kind is None or kind == self._kind:
            return
        self._kind = kind
        for field in self.fields.all:
            field.forget_meshes()
        if kind == _NO_LOAD_WHOLE:
            self._solve_drawing()

    def _solve_drawing(self) -> None:
        """The samples that every change without current is taken from, before the whole machine is meshed: they are of
        a sector, whose mesh is not needed beside it."""
        self.fields.idle.no_load(self.fields.nominal)
        self.fields.idle.forget_meshes()


def in_kinds(pieces: Iterable[Piece]) -> list[Piece]:
    """The same pieces, those of a kind after each other, the kinds in the order of their first pieces."""
    kinds: dict[Kind | None, list[Piece]] = {}
    for piece in pieces:
        kinds.setdefault(piece.kind, []).append(piece)
    return [piece for those in kinds.values() for piece in those]


def solved(task: Task) -> Arrays:
    """The piece of a task, on meshes that this process keeps for the next one of the kind."""
    return solver_of(task.machinery).solve(task.piece, task.states)


@lru_cache(maxsize=1)
def solver_of(machinery: Machinery) -> Solver:
    """The solver of the machine asked last."""
    return Solver(machinery)
