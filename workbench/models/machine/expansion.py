"""How the samples of a machine change with everything that may be different in it, from few field solutions.

At every state one factorised tangent serves all coordinates (``magnetostatics.sensitivity``). At nodes, designs some
way off, the field is solved again, with its derivatives there. Without current they are taken in one window of the
cogging period: what magnet or slot m does is what magnet or slot 0 does, seen from another place, and a shift of the
stator towards slot m is one towards slot 0 seen from there. In a mirror, half of the window is the other half.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from effects.machine_design import MachineAsBuilt
from magnetostatics.model import FieldSolution
from magnetostatics.sensitivity import sensitivities
from workbench.models.machine.coordinates import (
    BOTH,
    MAGNET,
    ROTOR,
    SHIFTS,
    SLOT,
    STATOR,
    TOLERANCED,
    CoilVariation,
    Coordinate,
    CoordinateVariation,
    all_coordinates,
    smooth_coordinates,
)
from workbench.models.machine.field import LoadedState, MachineField, read, solve_idle
from workbench.models.machine.symmetry import Symmetry, complete, half_of, is_symmetric, symmetries_of

BATCH = 12  # coordinates whose changed field models are kept in memory at a time
_IDLE_BATCH = 6  # on the finer mesh without current
NO_LOAD_FAMILIES = ((BOTH, MAGNET, SLOT), (STATOR,), (ROTOR,))
LEAST_DIRECTIONS = 5  # of a shift, to know how its square goes with the direction


@dataclass(frozen=True)
class Node:
    """A design some way off the drawing: value and slopes are wanted there.

    moves: coordinates and by how much;  along: coordinates of the slopes
    """

    moves: tuple[tuple[Coordinate, float], ...]
    along: tuple[Coordinate, ...] = ()

    @property
    def name(self) -> str:
        return " ".join(f"{c.name} {change:+.6g}" for c, change in self.moves)

    def design(self, nominal: MachineAsBuilt) -> MachineAsBuilt:
        for coordinate, change in self.moves:
            nominal = coordinate.changed(nominal, change)
        return nominal


def toleranced(nominal: MachineAsBuilt) -> tuple[Coordinate, ...]:
    """The coordinates of ``TOLERANCED``."""
    return tuple(c for c in smooth_coordinates(nominal) if c.path in TOLERANCED)


def regular_nodes(nominal: MachineAsBuilt) -> tuple[Node, ...]:
    """Those of the coordinates that leave the machine symmetric."""
    return tuple(node for c in all_coordinates(nominal) if c.breaks == BOTH for node in _nodes_of(c, nominal))


def irregular_nodes(nominal: MachineAsBuilt) -> tuple[Node, ...]:
    """Of the first magnet, the first slot, and shifts along x; where that leaves few directions, one between too."""
    smooth = smooth_coordinates(nominal)
    first = tuple(node for c in smooth if c.breaks != BOTH and c.index == 0 for node in _nodes_of(c, nominal))
    between = [
        Node(((x, size * np.cos(turn)), (y, size * np.sin(turn))), (x, y, *toleranced(nominal)))
        for (x, y), directions in ((shift_of(path, nominal), count) for path, count in _directions(nominal))
        if directions < LEAST_DIRECTIONS
        for turn in (np.pi / directions,)
        for size in x.sizes
    ]
    return first + tuple(between)


def shift_of(path: tuple[str, ...], nominal: MachineAsBuilt) -> tuple[Coordinate, Coordinate]:
    """The two components of a shift."""
    x, y = (c for c in smooth_coordinates(nominal) if c.path == path)
    return x, y


def _directions(nominal: MachineAsBuilt) -> list[tuple[tuple[str, ...], int]]:
    """Of every shift, how many directions follow from one."""
    counts = {STATOR: nominal.machine.slots, ROTOR: nominal.machine.poles}
    return [(path, counts[breaks]) for path, breaks in SHIFTS]


def _nodes_of(c: Coordinate, nominal: MachineAsBuilt) -> list[Node]:
    """Designs with another arc than touching magnets have meshes of their own, and no slope along the arc."""
    own = (c,) if c in smooth_coordinates(nominal) else ()
    along = own + tuple(other for other in toleranced(nominal) if other != c)
    return [Node(((c, size),), along) for size in c.sizes]


# ---- with current ----------------------------------------------------------------------------------------------------


def loaded_slopes(
    fields: MachineField, states: Sequence[LoadedState], coordinates: Sequence[Coordinate]
) -> dict[str, np.ndarray]:
    """Derivatives by some coordinates at loaded states of the drawing (states, 1 + coils) each."""
    variations = {c.name: CoordinateVariation(fields, c, fields.nominal, True) for c in coordinates}
    return _slopes(_whole(fields, states), variations)


def coil_slopes(fields: MachineField, states: Sequence[LoadedState]) -> dict[str, np.ndarray]:
    """Derivatives by the ampere-turns of every coil, ``coil[k]`` (states, 1 + coils) each."""
    return _slopes(
        _whole(fields, states), {f"coil[{k}]": CoilVariation(k) for k in range(fields.nominal.machine.slots)}
    )


def _whole(fields: MachineField, states: Sequence[LoadedState]) -> list[FieldSolution]:
    return fields.nominal_solutions(tuple(states), whole=True)


def loaded_node(fields: MachineField, states: Sequence[LoadedState], node: Node) -> dict[str, np.ndarray]:
    """Change and slopes at a node with current; a regular one, whose slopes leave the machine symmetric too."""
    design = node.design(fields.nominal)
    alike = fields.alike(design, states)
    solutions = fields.loaded_solutions(design, alike.of(states))
    found = {"change": alike.rows(np.array([read(s) for s in solutions])) - fields.loaded(fields.nominal, states)}
    along = _along(solutions, _variations(fields, node, design, whole=False))
    return found | {name: alike.rows(rows) for name, rows in along.items()}


def _variations(fields: MachineField, node: Node, design: MachineAsBuilt, whole: bool) -> dict:
    return {c.name: CoordinateVariation(fields, c, design, whole) for c in node.along}


def _along(solutions: Sequence[FieldSolution], variations: Mapping) -> dict[str, np.ndarray]:
    return {f"along {name}": rows for name, rows in _slopes(solutions, variations).items()}


def _slopes(solutions: Sequence[FieldSolution], variations: Mapping) -> dict[str, np.ndarray]:
    rows = [sensitivities(solution, variations, read) for solution in solutions] if variations else []
    return {name: np.array([row[name] for row in rows]) for name in variations}


# ---- a revolution without current ------------------------------------------------------------------------------------


def no_load_slopes(fields: MachineField, family: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Derivatives over a revolution by the coordinates that break a symmetry of this family (edges, 1 + coils) each."""
    nominal = fields.nominal
    own = [c for c in smooth_coordinates(nominal) if c.breaks in family]
    parts = {STATOR: nominal.machine.poles, ROTOR: nominal.machine.slots}.get(family[0], fields.edges // fields.window)
    steps, window = half_of(fields.edges // parts, _of_drawing(fields)[2].steps), {}
    solutions = solve_idle(fields.model(nominal, whole=True), steps, fields.edges)
    for batch in (own[k : k + _IDLE_BATCH] for k in range(0, len(own), _IDLE_BATCH)):
        window |= _slopes(solutions, {c.name: CoordinateVariation(fields, c, nominal, True) for c in batch})
    found = {}
    for group in _families(own):
        known = {(n, m): row for m, c in enumerate(group) for n, row in zip(steps, window[c.name], strict=True)}
        moves = (*_moves(fields, group[0].breaks), _mirror(fields, group[0]))
        rows = complete(known, fields.edges, len(group), moves)
        found |= {c.name: _revolution(rows, fields.edges, m) for m, c in enumerate(group)}
    return found


def _families(coordinates: Sequence[Coordinate]) -> list[list[Coordinate]]:
    """Coordinates that there is one of for every magnet or slot together, all others alone."""
    groups: dict[str, list[Coordinate]] = {}
    for c in coordinates:
        groups.setdefault(str(c.path) if c.breaks in (MAGNET, SLOT) else c.name, []).append(c)
    return list(groups.values())


def _moves(fields: MachineField, breaks: str) -> tuple:
    """A slot pitch on, magnet m does to coil k what it did to coil k - 1, and slot s what slot s - 1 did. A pole pitch
    on, magnet m does what magnet m + 1 did, with the opposite sign, and slot s what slot s did."""
    slot, pole, _ = _of_drawing(fields)
    return {
        BOTH: ((slot, 0), (pole, 0)),
        MAGNET: ((slot, 0), (pole, -1)),
        SLOT: ((slot, 1), (pole, 0)),
        STATOR: ((pole, 0),),
        ROTOR: ((slot, 0),),
    }[breaks]


def _mirror(fields: MachineField, c: Coordinate) -> tuple[Symmetry, int]:
    """In the mirror through tooth 0 and magnet 0, magnet m is seen at -m, and slot s, after tooth s, at -1 - s."""
    mirror = _of_drawing(fields)[2]
    return replace(mirror, sign=c.in_mirror * mirror.sign), -1 if c.breaks == SLOT else 0


def _of_drawing(fields: MachineField) -> tuple[Symmetry, ...]:
    """A slot pitch on, a pole pitch on, and in a mirror."""
    return symmetries_of(fields.nominal, fields.edges)


def no_load_node(fields: MachineField, node: Node) -> dict[str, np.ndarray]:
    """Change and slopes at a node over a revolution, (members, edges, 1 + coils): a member for every magnet or slot
    that the same may happen to, or direction that the shift may have."""
    design, nominal = node.design(fields.nominal), fields.nominal
    window = fields.no_load_window(design)
    found = {"change": fields.over_revolution(design, [read(s) for s in window]) - fields.no_load(nominal)}
    slopes = _along(window, _variations(fields, node, design, whole=not is_symmetric(design)))
    found |= {name: fields.over_revolution(design, rows) for name, rows in slopes.items()}
    return {name: _members(fields, node.moves[0][0].breaks, rows) for name, rows in found.items()}


def _members(fields: MachineField, breaks: str, rows: np.ndarray) -> np.ndarray:
    """The change by every member of a family from that by the first, over a revolution (members, edges, 1 + coils)."""
    machine = fields.nominal.machine
    like = {STATOR: SLOT, ROTOR: MAGNET}.get(breaks, breaks)  # a direction counts like the part that lies in it
    members = {SLOT: machine.slots, MAGNET: machine.poles, BOTH: 1}[like]
    known = complete({(n, 0): row for n, row in enumerate(rows)}, fields.edges, members, _moves(fields, like))
    return np.array([_revolution(known, fields.edges, m) for m in range(members)])


def _revolution(known: Mapping[tuple[int, int], np.ndarray], edges: int, member: int) -> np.ndarray:
    return np.array([known[n, member] for n in range(edges)])
