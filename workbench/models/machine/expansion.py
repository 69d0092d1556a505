"""How the samples of a machine change with everything that may be different in it, from few field solutions.

At every state one factorised tangent serves all coordinates (``magnetostatics.sensitivity``); curvatures come from the
field at a finite change. Without current the derivatives are taken in one window of the cogging period: what magnet or
slot m does is what magnet or slot 0 does, seen from another place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from effects.machine_design import MachineAsBuilt
from magnetostatics.model import OperatingState
from magnetostatics.sensitivity import sensitivities
from workbench.models.machine.coordinates import (
    ARC,
    BOTH,
    LESS_ARC,
    MAGNET,
    ROTOR,
    SHIFTS,
    SLOT,
    STATOR,
    CoilVariation,
    Coordinate,
    CoordinateVariation,
    smooth_coordinates,
)
from workbench.models.machine.field import LoadedState, MachineField, complete, idle, read_whole, solve_in_turn

_BATCH = 12  # coordinates whose changed field models are kept in memory at a time

Tick = Callable[[], None]


@dataclass(frozen=True)
class Secant:
    """A finite change of a design, for a curvature."""

    name: str
    changes: tuple[tuple[Coordinate, float], ...]

    def design(self, nominal: MachineAsBuilt) -> MachineAsBuilt:
        for coordinate, change in self.changes:
            nominal = coordinate.changed(nominal, change)
        return nominal


def regular_secants(nominal: MachineAsBuilt) -> tuple[Secant, ...]:
    """One for each coordinate that leaves the machine symmetric."""
    smooth = tuple(Secant(c.name, ((c, c.size),)) for c in smooth_coordinates(nominal) if c.size and c.breaks == BOTH)
    touching = nominal.machine.magnet_arc_fraction >= 1
    return smooth + (tuple(Secant(arc_name(change), ((ARC, change),)) for change in LESS_ARC) if touching else ())


def shift_secants() -> tuple[Secant, ...]:
    """Stator and rotor moved along x, along y, and between."""
    return tuple(
        Secant(name, changes)
        for x, y in SHIFTS
        for name, changes in (
            (x.name, ((x, x.size),)),
            (y.name, ((y, y.size),)),
            (mixed_name(x), ((x, x.size / np.sqrt(2)), (y, y.size / np.sqrt(2)))),
        )
    )


def mixed_name(x: Coordinate) -> str:
    """Name of the mixed derivative of a shift, from its first component."""
    return f"{x.path[0]}[0,1]"


def arc_name(change: float) -> str:
    """Name of a secant of the arc of touching magnets."""
    return f"{ARC.name} {change:+g}"


@dataclass(frozen=True)
class Changes:
    """base: samples;  linear: derivatives by coordinate, per its unit;  secant: change of the samples by secant"""

    base: np.ndarray
    linear: Mapping[str, np.ndarray]
    secant: Mapping[str, np.ndarray]


# ---- with current ----------------------------------------------------------------------------------------------------


def loaded_changes(fields: MachineField, states: Sequence[LoadedState], tick: Tick) -> Changes:
    """Base, derivatives and secants at loaded states, each (states, 1 + coils). Shifts have derivatives only.

    Besides the coordinates: ``coil[k]``, per ampere-turn in coil k.
    """
    nominal = fields.nominal
    points = [fields.point(nominal, state, whole=True) for state in states]
    base, linear = derivatives(fields, points, smooth_coordinates(nominal), tick, coils=True)
    symmetric = fields.loaded(nominal, states)
    secant = {}
    for s in regular_secants(nominal):
        secant[s.name] = fields.loaded(s.design(nominal), states) - symmetric
        tick()
    return Changes(base, linear, secant)


def derivatives(
    fields: MachineField, points: Sequence[OperatingState], coordinates: Sequence[Coordinate], tick: Tick, coils=False
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Samples of the whole nominal machine at some states and their derivatives by coordinate."""
    solutions = solve_in_turn(fields.model(fields.nominal, whole=True), points)
    base, linear = np.array([read_whole(solution) for solution in solutions]), {}
    batches = [{c.name: CoordinateVariation(fields, c) for c in batch} for batch in _batches(coordinates, _BATCH)]
    if coils:
        batches.append({f"coil[{k}]": CoilVariation(k) for k in range(base.shape[1] - 1)})
    for variations in batches:
        rows = [sensitivities(solution, variations, read_whole) for solution in solutions]
        linear |= {name: np.array([row[name] for row in rows]) for name in variations}
        for variation in variations.values():
            variation.forget()
        tick()
    return base, linear


def _batches(items: Sequence, size: int) -> Iterator[Sequence]:
    return (items[k : k + size] for k in range(0, len(items), size))


# ---- a revolution without current ------------------------------------------------------------------------------------


def no_load_changes(fields: MachineField, tick: Tick) -> Changes:
    """Base, derivatives and secants over a revolution, each (edges, 1 + coils)."""
    nominal = fields.nominal
    base, linear, secant = fields.no_load(nominal), {}, {}
    for family in ((BOTH, MAGNET, SLOT), (STATOR,), (ROTOR,)):
        linear |= _no_load_derivatives(fields, family, tick)
    for s in regular_secants(nominal) + shift_secants():
        secant[s.name] = fields.no_load(s.design(nominal)) - base
        tick()
    for family in _families(nominal):
        first = family[0]
        window = {first.name: fields.no_load(first.changed(nominal, first.size)) - base}
        secant |= _over_revolution(fields, family, window)
        tick()
    return Changes(base, linear, secant)


def _families(nominal: MachineAsBuilt) -> list[list[Coordinate]]:
    """Coordinates that there is one of for every magnet or slot."""
    groups: dict[tuple[str, ...], list[Coordinate]] = {}
    for c in smooth_coordinates(nominal):
        if c.breaks in (MAGNET, SLOT):
            groups.setdefault(c.path, []).append(c)
    return list(groups.values())


def _no_load_derivatives(fields: MachineField, family: tuple[str, ...], tick: Tick) -> dict[str, np.ndarray]:
    """Of the coordinates that break a symmetry of this family, over a revolution (edges, 1 + coils)."""
    machine = fields.nominal.machine
    steps = {STATOR: fields.edges // machine.poles, ROTOR: fields.edges // machine.slots}.get(family[0], fields.window)
    own = [c for c in smooth_coordinates(fields.nominal) if c.breaks in family]
    _, window = derivatives(fields, [idle(2 * np.pi * n / fields.edges) for n in range(steps)], own, tick)
    groups: dict[tuple[str, ...], list[Coordinate]] = {}
    for c in own:
        groups.setdefault(c.path if c.breaks in (MAGNET, SLOT) else (c.name,), []).append(c)
    return {name: rows for group in groups.values() for name, rows in _over_revolution(fields, group, window).items()}


def _over_revolution(fields: MachineField, group: list[Coordinate], window: Mapping[str, np.ndarray]) -> dict:
    """Changes with one coordinate, or with that of every magnet or slot, from those in a window or of the first member.

    A slot pitch on, magnet m does to coil k what it did to coil k - 1, and slot s what slot s - 1 did. A pole pitch on,
    magnet m does what magnet m + 1 did, with the opposite sign, and slot s what slot s did.
    """
    slot, pole = fields.slot_pitch, fields.pole_pitch
    moves = {
        BOTH: ((slot, 0), (pole, 0)),
        MAGNET: ((slot, 0), (pole, -1)),
        SLOT: ((slot, 1), (pole, 0)),
        STATOR: ((pole, 0),),
        ROTOR: ((slot, 0),),
    }[group[0].breaks]
    known = {(n, m): row for m, c in enumerate(group) for n, row in enumerate(window.get(c.name, ()))}
    known = complete(known, fields.edges, len(group), moves)
    return {c.name: np.array([known[n, m] for n in range(fields.edges)]) for m, c in enumerate(group)}


def steps_of_work(states: int, nominal: MachineAsBuilt) -> int:
    """How often ``tick`` is called for a whole build, for a progress bar."""
    batches = -(-len(smooth_coordinates(nominal)) // _BATCH)
    both = len(regular_secants(nominal))
    return batches + 2 + both + len(shift_secants()) + len(_families(nominal)) + ((batches + 1 + both) if states else 0)
