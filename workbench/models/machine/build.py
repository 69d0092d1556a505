"""Builds the surrogate of a machine from field solutions, on all cores; what is solved is on disk at once."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import as_completed
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from effects.machine_design import MachineAsBuilt
from materials.library import load_steel
from materials.reluctivity import Reluctivity
from processes import LostWorker, Processes, give_memory_back
from workbench.models.kept import KeptArrays, key_of
from workbench.models.machine.field import LoadedState
from workbench.models.machine.pieces import (
    DEFAULT_PLAN,
    Arrays,
    LoadedAt,
    Machinery,
    MeshPlan,
    NoLoadAt,
    Piece,
    States,
    Task,
    loaded_pieces,
    no_load_pieces,
)
from workbench.models.machine.solver import Solver, in_kinds, solved
from workbench.models.machine.surrogate import Surrogate, surrogate_of

Progress = Callable[[str], None]
_CODE = ("field", "symmetry", "coordinates", "expansion", "pieces", "spectra")  # what results on disk depend on


class SurrogateBuilder:
    """Makes surrogates of one nominal machine.

    cache: folder for what has been solved; None keeps nothing;  steel: from the grade's name to its law
    workers: processes that solve at once; 1 solves in this process
    """

    def __init__(
        self,
        nominal: MachineAsBuilt,
        plan: MeshPlan = DEFAULT_PLAN,
        cache: Path | None = None,
        steel: Callable[[str], Reluctivity] = load_steel,
        workers: int = 1,
    ):
        self.machinery = Machinery(nominal, plan, steel)
        self.pool = Processes(workers, preload=(solved.__module__,)) if workers > 1 else None
        self.store = Store(cache / f"machine-{_key(self.machinery)}" if cache else None)
        self._about: tuple | None = None

    @property
    def nominal(self) -> MachineAsBuilt:
        """The machine as drawn."""
        return self.machinery.nominal

    @cached_property
    def solver(self) -> Solver:
        """The field problems in this process."""
        return Solver(self.machinery)

    def build(self, states: Sequence[LoadedState], progress: Progress | None = None) -> Surrogate:
        """The surrogate with the given loaded states; solves what is not on disk yet."""
        states = tuple(dict.fromkeys(states))
        pieces = (loaded_pieces(self.nominal) if states else ()) + no_load_pieces(self.nominal)
        found = self._found(pieces, states, progress)
        return surrogate_of(self.nominal, found, states)

    def about(self, surrogate: Surrogate, design: MachineAsBuilt, turn: float = 0.0) -> Surrogate:
        """The surrogate of the drawing moved to another design by field solutions: exact there, with the old
        derivatives. turn: of the rotor beyond its loaded states, where what currents add is solved [rad]"""
        if self._about is None or self._about[0] != (id(surrogate), design, turn):
            self._about = (id(surrogate), design, turn), self._moved(surrogate, design, turn)
        return self._about[1]

    def _moved(self, surrogate: Surrogate, design: MachineAsBuilt, turn: float) -> Surrogate:
        name = hashlib.sha256(repr(design).encode()).hexdigest()[:16]
        pieces, states = [NoLoadAt(design, f"design {name} no load")], ()
        if surrogate.states is not None:
            pieces.append(LoadedAt(design, turn, f"design {name} {turn:+.9e} rad loaded"))
            states = surrogate.states.list
        found = self._found(pieces, states, None)
        return surrogate.about(design, turn, *(found[piece.name]["base"] for piece in pieces))

    # ---- solving --------------------------------------------------------------------------------------------------

    def _found(self, pieces: Sequence[Piece], states: States, progress: Progress | None) -> dict[str, Arrays]:
        """Results of all pieces by name, from disk where they are there."""
        found = {piece.name: self.store.load(piece, states) for piece in pieces}
        tasks = {}
        for piece in in_kinds(pieces):
            missing = found[piece.name].missing
            if missing is not None:
                tasks[piece.name] = Task(self.machinery, piece, missing)
        for done, (name, arrays) in enumerate(self._solved(tasks), 1):
            found[name] = self.store.save(found[name], arrays)
            if progress is not None:
                progress(f"field solutions of this machine: {done} of {len(tasks)}, kept for the next time")
        return {name: one.rows(states) for name, one in found.items()}

    def _solved(self, tasks: dict[str, Task]) -> Iterator[tuple[str, Arrays]]:
        """Results as they come. Where a worker is lost the rest is solved in this process."""
        waiting = dict(tasks)
        if self.pool is not None and len(tasks) > 1:
            try:
                for name, arrays in self._pooled(tasks):
                    del waiting[name]
                    yield name, arrays
            except LostWorker:
                self.pool.end(now=True)
        for name, task in waiting.items():
            arrays = self.solver.solve(task.piece, task.states)
            give_memory_back()  # workers do after every task
            yield name, arrays

    def _pooled(self, tasks: dict[str, Task]) -> Iterator[tuple[str, Arrays]]:
        futures = {self.pool.submit(solved, task): name for name, task in tasks.items()}
        try:
            for future in as_completed(futures):
                yield futures[future], self.pool.result(future)
        except BaseException:  # Ctrl-C too: the workers end, what was solved is on disk
            self.pool.end(now=True)
            raise


# ---- on disk ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Kept:
    """What is known of a piece: its results, of a loaded piece one row for every one of ``states``.

    missing: states to solve, () for a piece without current; None where nothing is missing
    """

    piece: Piece
    states: States
    arrays: Arrays | None
    missing: States | None

    def rows(self, states: States) -> Arrays:
        """The results in the order of the states."""
        if not self.piece.with_current:
            return self.arrays
        place = {state: k for k, state in enumerate(self.states)}
        order = [place[state] for state in states]
        return {name: rows[order] for name, rows in self.arrays.items()}

    def joined(self, arrays: Arrays) -> Kept:
        """With what was missing."""
        states = self.states + self.missing
        if self.arrays is not None:
            arrays = {name: np.concatenate([self.arrays[name], rows]) for name, rows in arrays.items()}
        return replace(self, states=states, arrays=arrays, missing=None)


class Store(KeptArrays):
    """Results of pieces in a folder, a file each; None keeps nothing."""

    def load(self, piece: Piece, states: States) -> Kept:
        """What was kept of a piece, and which of the states are missing; a file that cannot be read is none."""
        arrays = self.read(piece.name)
        if not piece.with_current:
            return Kept(piece, (), arrays, () if arrays is None else None)
        known = () if arrays is None else _states(arrays.pop("states"))
        there = set(known)
        return Kept(piece, known, arrays, tuple(state for state in states if state not in there) or None)

    def save(self, kept: Kept, arrays: Arrays) -> Kept:
        """Adds what was missing."""
        kept = kept.joined(arrays)
        states = np.array([(s.angle, *s.currents) for s in kept.states]).reshape(-1, 4)
        self.write(kept.piece.name, kept.arrays | ({"states": states} if kept.piece.with_current else {}))
        return kept


def _states(rows: np.ndarray) -> States:
    return tuple(LoadedState(angle, (a, b, c)) for angle, a, b, c in rows.tolist())


def _key(machinery: Machinery) -> str:
    """Of the machine, the meshes and every line of code and every material curve that the solutions depend on."""
    steel = machinery.steel
    words = [repr(machinery.nominal), repr(machinery.plan), steel.__module__ + steel.__name__]
    return key_of(json.dumps(words), [Path(__file__).parent / f"{part}.py" for part in _CODE])
