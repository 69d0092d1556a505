"""What a change of design does to samples, from what was solved: a sum of known rows, each with a weight.

Along one coordinate x, piecewise cubics through nodes with their slopes (Hermite): exact in value and slope at every
node, C1 between, the last piece goes on beyond. A toleranced coordinate t beside it changes its effect:

    f(x, t) = f(x) + g(t) + t d f/dt(x)|_0,   d f/dt known at the nodes of x, a polynomial through them between

A shift by r in the direction a: the same in r, with a sum of cos n(a - a_k) through the directions a_k.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from effects.machine_design import MachineAsBuilt
from workbench.models.machine.coordinates import BOTH, ROTOR, SHIFTS, Coordinate, all_coordinates
from workbench.models.machine.expansion import LEAST_DIRECTIONS, Joint, Node, joints, shift_of, toleranced


@dataclass(frozen=True, eq=False)
class Changes:
    """slopes: derivatives by coordinate at the drawing (1 + coils, n);  nodes: by the name of the node its change and
    its slopes along coordinates (members, 1 + coils, n), a member for every place that the same may happen in"""

    slopes: Mapping[str, np.ndarray]
    nodes: Mapping[str, Mapping[str, np.ndarray]]

    def at(self, c: Coordinate, size: float) -> Mapping[str, np.ndarray] | None:
        """Of a node of a coordinate, the slope along itself as ``own``; None where it was not solved."""
        first = replace(c, index=0) if c.breaks != BOTH else c
        found = self.nodes.get(Node(((first, size),)).name)
        if found is None:
            return None
        named = {name.replace(f"along {first.name}", "own"): rows for name, rows in found.items()}
        return {name: rows[max(c.index, 0)] for name, rows in named.items()}


class Part:
    """Some terms: their rows, and the weights that they come with at coordinates p."""

    def weights(self, p: np.ndarray) -> np.ndarray | None:
        """(terms,), None where all are zero."""
        raise NotImplementedError

    def rows(self, changes: Changes) -> np.ndarray | None:
        """(terms, 1 + coils, n), None where the nodes were not solved."""
        raise NotImplementedError

    def lines(self) -> dict[str, np.ndarray]:
        """By coordinate, the numbers (terms,) that as rows would make the sum the coordinate itself."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class Curve(Part):
    """One coordinate. c: it stands at ``place`` of p;  partners: the toleranced coordinates and their places."""

    c: Coordinate
    place: int
    partners: tuple[tuple[Coordinate, int], ...]

    @cached_property
    def nodes(self) -> np.ndarray:
        return np.array(sorted((0.0, *self.c.sizes)))

    def weights(self, p: np.ndarray) -> np.ndarray | None:
        """Of the values and slopes at the nodes, then for every partner of the change of its slope there."""
        x = p[self.place]
        if x == 0.0:
            return None
        crossed = _lagrange(self.nodes, x) if self.partners else np.zeros(0)
        return np.concatenate([*hermite(self.nodes, x), *(p[place] * crossed for _, place in self.partners)])

    def lines(self) -> dict[str, np.ndarray]:
        nothing = np.zeros(len(self.partners) * len(self.nodes))
        return {self.c.name: np.concatenate([self.nodes, np.ones(len(self.nodes)), nothing])}

    def rows(self, changes: Changes) -> np.ndarray | None:
        found = [changes.at(self.c, size) if size else {} for size in self.nodes]
        if None in found:
            return None
        values = [node.get("change", 0.0) for node in found]
        slopes = [node.get("own", changes.slopes.get(self.c.name)) for node in found]
        if slopes[list(self.nodes).index(0.0)] is None:
            slopes = np.tensordot(_lagrange_slopes(self.nodes), np.array(_alike(values)), 1)
        crossed = [_crossed(node, changes, partner) for partner, _ in self.partners for node in found]
        return np.array(_alike([*values, *slopes, *crossed]))


@dataclass(frozen=True, eq=False)
class Shift(Part):
    """Both components x, y of a shift, at their places of p, from directions that are ``count`` to a turn."""

    x: Coordinate
    y: Coordinate
    places: tuple[int, int]
    partners: tuple[tuple[Coordinate, int], ...]
    count: int

    @cached_property
    def radii(self) -> np.ndarray:
        return np.array([0.0, *self.x.sizes])

    @cached_property
    def directions(self) -> np.ndarray:
        """Angles (d,); where few follow from the one along x, those from one half way to the next come after them."""
        known = 2 * np.pi * np.arange(self.count) / self.count
        return known if self.count >= LEAST_DIRECTIONS else np.concatenate([known, known + np.pi / self.count])

    def weights(self, p: np.ndarray) -> np.ndarray | None:
        """Of the slopes along x and y at the drawing; of every radius values, slopes and changes of the partners'."""
        x, y = p[self.places[0]], p[self.places[1]]
        if x == 0.0 and y == 0.0:
            return None
        r, turn = float(np.hypot(x, y)), float(np.arctan2(y, x))
        values, slopes = hermite(self.radii, r)
        crossed = _lagrange(self.radii, r)[1:]
        radial = np.concatenate([values[1:], slopes[1:], *(p[place] * crossed for _, place in self.partners)])
        along = slopes[0] * np.array([np.cos(turn), np.sin(turn)])
        return np.concatenate([along, np.outer(radial, _around(self.directions, turn)).ravel()])

    def lines(self) -> dict[str, np.ndarray]:
        found = {}
        for c, first, there in ((self.x, (1, 0), np.cos(self.directions)), (self.y, (0, 1), np.sin(self.directions))):
            radial = np.concatenate([self.radii[1:], np.ones(len(self.radii) - 1)])
            nothing = np.zeros(len(self.partners) * (len(self.radii) - 1) * len(self.directions))
            found[c.name] = np.concatenate([first, np.outer(radial, there).ravel(), nothing])
        return found

    def rows(self, changes: Changes) -> np.ndarray | None:
        nodes = [self._node(changes, r) for r in self.radii[1:]]
        if None in nodes:
            return None
        start = [changes.slopes[c.name] for c in (self.x, self.y)]
        names = ("change", "own", *(f"along {c.name}" for c, _ in self.partners))
        drawn = (0.0, 0.0, *(changes.slopes[c.name] for c, _ in self.partners))
        radial = [node[name] - less for name, less in zip(names, drawn) for node in nodes]
        return np.concatenate([start, *radial])

    def _node(self, changes: Changes, r: float) -> dict[str, np.ndarray] | None:
        """All directions of a radius (d, 1 + coils, n)."""
        found = []
        for turn in (0.0, np.pi / self.count)[: len(self.directions) // self.count]:
            moves = ((self.x, r),) if turn == 0.0 else ((self.x, r * np.cos(turn)), (self.y, r * np.sin(turn)))
            node = changes.nodes.get(Node(moves).name)
            if node is None:
                return None
            along = [node.get(f"along {c.name}", 0.0) for c in (self.x, self.y)]
            found.append(dict(node) | {"own": np.cos(turn) * along[0] + np.sin(turn) * along[1]})
        return {name: np.concatenate([node[name] for node in found]) for name in found[0] if name[-1] != "]"}


@dataclass(frozen=True, eq=False)
class Together(Part):
    """What two coordinates do together beyond what their curves say; its row is what is left at its node."""

    joint: Joint
    places: tuple[int, int]

    def weights(self, p: np.ndarray) -> np.ndarray | None:
        x, y = p[self.places[0]] / self.joint.first_size, p[self.places[1]] / self.joint.second_size
        return None if x == 0.0 or y == 0.0 else np.array([x * x * y])

    def lines(self) -> dict[str, np.ndarray]:
        return {}

    def rows(self, changes: Changes) -> np.ndarray | None:
        return changes.nodes[self.joint.node.name]["change"]


@dataclass(frozen=True, eq=False)
class Terms:
    """parts: with their rows (terms, q, n)"""

    parts: tuple[tuple[Part, np.ndarray], ...]
    shape: tuple[int, ...]

    def __call__(self, p: np.ndarray) -> np.ndarray:
        """The change of the samples at coordinates p (q, n)."""
        total: np.ndarray = np.zeros(self.shape)
        for part, rows in self.parts:
            weights = part.weights(p)
            if weights is not None:
                total = total + np.tensordot(weights, rows, 1)
        return total

    def each(self, form: Callable[[np.ndarray], np.ndarray]) -> Terms:
        """The terms with ``form`` of their rows (q, n), which must be linear."""
        parts = tuple((part, np.array([form(row) for row in rows])) for part, rows in self.parts)
        return Terms(parts, np.shape(form(np.zeros(self.shape))))


def parts_of(nominal: MachineAsBuilt) -> tuple[Part, ...]:
    """All parts, those that stand on others last."""
    coordinates = all_coordinates(nominal)
    places = {c.name: k for k, c in enumerate(coordinates)}
    partners = tuple((c, places[c.name]) for c in toleranced(nominal))
    shifts = [shift_of(path, nominal) for path, _ in SHIFTS]
    moving = {c.name for pair in shifts for c in pair}
    curves = [Curve(c, places[c.name], _others(c, partners)) for c in coordinates if c.name not in moving]
    polar = [Shift(x, y, (places[x.name], places[y.name]), partners, _count(x, nominal)) for x, y in shifts]
    both = [Together(j, (places[j.first.name], places[j.second.name])) for j in joints(nominal)]
    return (*curves, *polar, *both)


def _others(c: Coordinate, partners: tuple[tuple[Coordinate, int], ...]) -> tuple[tuple[Coordinate, int], ...]:
    """Partners of a coordinate that was solved beside the drawing; two toleranced ones count each other once."""
    if not c.sizes:
        return ()
    names = [partner.name for partner, _ in partners]
    return partners[names.index(c.name) + 1 :] if c.name in names else partners


def _count(x: Coordinate, nominal: MachineAsBuilt) -> int:
    return nominal.machine.poles if x.breaks == ROTOR else nominal.machine.slots


def terms_of(nominal: MachineAsBuilt, changes: Changes) -> Terms:
    """Without current; rows (terms, 1 + coils, orders)."""
    return _built(parts_of(nominal), changes, {})


def loaded_terms_of(nominal: MachineAsBuilt, changes: Changes, without: Terms, at: Changes) -> Terms:
    """With current; rows (terms, 1 + coils, states). What was not solved with current goes as without it beyond its
    first derivative.

    without: the terms without current at the angles of the states;  at: the slopes without current there
    """
    borrowed = {}
    for part, rows in without.parts:
        slopes = [(line, changes.slopes[c] - at.slopes[c]) for c, line in part.lines().items() if c in changes.slopes]
        borrowed[id(part)] = rows + sum(np.multiply.outer(line, slope) for line, slope in slopes)
    return _built([part for part, _ in without.parts], changes, borrowed)


def _built(parts: Sequence[Part], changes: Changes, instead: Mapping[int, np.ndarray]) -> Terms:
    built: list[tuple[Part, np.ndarray]] = []
    for part in parts:
        rows = part.rows(changes)
        rows = instead[id(part)] if rows is None else rows
        if isinstance(part, Together):
            so_far = Terms(tuple(built), rows.shape[1:])
            rows = rows - so_far(_place_of(part, parts))
        built.append((part, rows))
    return Terms(tuple(built), built[0][1].shape[1:])


def _place_of(part: Together, parts: Sequence[Part]) -> np.ndarray:
    """Coordinates of the node of a joint change."""
    p = np.zeros(1 + max(place for other in parts for place in _places(other)))
    p[list(part.places)] = part.joint.first_size, part.joint.second_size
    return p


def _places(part: Part) -> tuple[int, ...]:
    return (part.place,) if isinstance(part, Curve) else part.places


def _crossed(node: Mapping[str, np.ndarray], changes: Changes, partner: Coordinate) -> np.ndarray | float:
    """By how much the slope along a partner differs at a node; the drawing is none."""
    return node[f"along {partner.name}"] - changes.slopes[partner.name] if node else 0.0


def _alike(rows: Sequence[np.ndarray | float]) -> list[np.ndarray]:
    """All of one shape, zeros for a plain zero."""
    shape = next(np.shape(row) for row in rows if np.ndim(row))
    return [np.broadcast_to(row, shape) for row in rows]


# ---- interpolation ---------------------------------------------------------------------------------------------------


def hermite(nodes: np.ndarray, x: float) -> tuple[np.ndarray, np.ndarray]:
    """Weights of the values and of the slopes at the nodes (k,) of the piecewise cubic at x; one node: its tangent."""
    values, slopes = np.zeros(len(nodes)), np.zeros(len(nodes))
    if len(nodes) == 1:
        values[0], slopes[0] = 1.0, x - nodes[0]
        return values, slopes
    i = min(max(int(np.searchsorted(nodes, x)) - 1, 0), len(nodes) - 2)
    h = nodes[i + 1] - nodes[i]
    t = (x - nodes[i]) / h
    values[i], values[i + 1] = 1 - t * t * (3 - 2 * t), t * t * (3 - 2 * t)
    slopes[i], slopes[i + 1] = h * t * (1 - t) ** 2, -h * t * t * (1 - t)
    return values, slopes


def _lagrange(nodes: np.ndarray, x: float) -> np.ndarray:
    """Weights of the values at the nodes of the polynomial through them at x (k,)."""
    others = ~np.eye(len(nodes), dtype=bool)
    factors = (x - nodes[None]) / np.where(others, nodes[:, None] - nodes[None], 1.0)
    return np.where(others, factors, 1.0).prod(1)


def _lagrange_slopes(nodes: np.ndarray) -> np.ndarray:
    """Slopes at all nodes of the polynomial through values at them, as a matrix (k, k)."""
    powers = np.arange(len(nodes))
    matrix = nodes[:, None] ** powers
    derivative = powers * np.where(powers > 0, nodes[:, None] ** np.maximum(powers - 1, 0), 0.0)
    return derivative @ np.linalg.inv(matrix)


def _around(directions: np.ndarray, turn: float) -> np.ndarray:
    """Weights of the values at even directions of the sum of cosines through them at another one (d,)."""
    d, apart = len(directions), turn - np.sort(directions)
    orders = np.arange(1, (d - 1) // 2 + 1)
    weights = (1 + 2 * np.cos(np.outer(apart, orders)).sum(1) + (np.cos(d / 2 * apart) if d % 2 == 0 else 0.0)) / d
    return weights[np.argsort(np.argsort(directions))]
