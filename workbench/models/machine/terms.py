"""What a change of design does to samples, from what was solved: a sum of known rows, each with a weight.

Along one coordinate x, piecewise cubics through nodes with their slopes (Hermite): exact in value and slope at every
node, C1 between, the last piece goes on beyond. A toleranced coordinate t beside it changes its effect:

    f(x, t) = f(x) + g(t) + t (d f/dt(x) - d f/dt(0)),   d f/dt known at the nodes of x, piecewise cubics between

A shift by r in the direction a: the same in r, with a sum of cos n(a - a_k) through the directions a_k.

Steel that carries s times the flux at s times the field, between magnets of s times the remanence, makes the same field
s times over: psi(B_r, s) = s psi(B_r/s, 1), torque with s^2. So what a steel does is first what other magnets do to the
drawing, exactly for the saturation without current, and only the rest is a curve of its own.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import combinations

import numpy as np

from effects.machine_design import MachineAsBuilt
from workbench.models.machine.coordinates import BOTH, REMANENCE, ROTOR, SHIFTS, STEEL, Coordinate, all_coordinates
from workbench.models.machine.expansion import LEAST_DIRECTIONS, Node, shift_of, toleranced

_REMEMBERED = 1024  # cubics at a place of their coordinate


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

    @property
    def name(self) -> str:
        """Of the coordinate that it is about."""
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

    @property
    def name(self) -> str:
        return self.c.name

    @cached_property
    def nodes(self) -> tuple[float, ...]:
        return tuple(sorted((0.0, *self.c.sizes)))

    def weights(self, p: np.ndarray) -> np.ndarray | None:
        """Of the values and slopes at the nodes, then for every partner of the change of its slope there."""
        x = p[self.place]
        if x == 0.0:
            return None
        crossed = through(self.nodes, x) if self.partners else np.zeros(0)
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
        if slopes[self.nodes.index(0.0)] is None:
            slopes = list(np.tensordot(_lagrange_slopes(np.array(self.nodes)), np.array(_alike(values)), 1))
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

    @property
    def name(self) -> str:
        return self.x.name

    @cached_property
    def radii(self) -> tuple[float, ...]:
        return (0.0, *self.x.sizes)

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
        crossed = through(self.radii, r)[1:]
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
class Twice(Part):
    """Two toleranced coordinates, whose curves both hold their mixed second derivative: once too often."""

    first: Curve
    second: Curve

    @property
    def name(self) -> str:
        return f"{self.first.name} {self.second.name}"

    def weights(self, p: np.ndarray) -> np.ndarray | None:
        both = p[self.first.place] * p[self.second.place]
        return None if both == 0.0 else np.array([-both])

    def lines(self) -> dict[str, np.ndarray]:
        return {}

    def rows(self, changes: Changes) -> np.ndarray | None:
        """The mixed second derivative at the drawing, as the curve of the first has it (1, 1 + coils, n)."""
        nodes, partner = self.first.nodes, self.second.c
        found = [changes.at(self.first.c, size) if size else {} for size in nodes]
        crossed = np.array(_alike([_crossed(node, changes, partner) for node in found]))
        return np.tensordot(parabola_slopes(nodes)[nodes.index(0.0)], crossed, 1)[None]


@dataclass(frozen=True, eq=False)
class Scaling:
    """place, remanence: of the magnets as drawn;  steel: places of the factors of the flux in the steel, as drawn"""

    place: int
    remanence: float
    steel: tuple[tuple[int, float], ...]

    def factor(self, p: np.ndarray) -> float:
        """By which the steel carries more flux than as drawn."""
        return float(np.prod([1.0 + p[place] / drawn for place, drawn in self.steel]))

    def magnets(self, p: np.ndarray) -> np.ndarray:
        """Coordinates of the drawn steel between the magnets that make the same field but for the factor."""
        moved = p.copy()
        moved[self.place] = (self.remanence + p[self.place]) / self.factor(p) - self.remanence
        moved[[place for place, _ in self.steel]] = 0.0
        return moved


@dataclass(frozen=True, eq=False)
class Terms:
    """drawn: samples of the drawing (q, n);  parts: with their rows (terms, q, n);  steel: those of the steel"""

    drawn: np.ndarray
    scaling: Scaling
    parts: tuple[tuple[Part, np.ndarray], ...]
    steel: tuple[tuple[Part, np.ndarray], ...]

    def __call__(self, p: np.ndarray) -> np.ndarray:
        """The change of the samples at coordinates p (q, n)."""
        factor = self.scaling.factor(p)
        if factor == 1.0:
            return self._sum(self.parts, p) + self._sum(self.steel, p)
        scales = factor ** np.where(np.arange(len(self.drawn)) == 0, 2, 1)[:, None]  # the torque stands first
        scaled = scales * (self.drawn + self._sum(self.parts, self.scaling.magnets(p))) - self.drawn
        return scaled + self._sum(self.steel, p)

    def _sum(self, parts: Sequence[tuple[Part, np.ndarray]], p: np.ndarray) -> np.ndarray:
        total = np.zeros(self.drawn.shape, self.drawn.dtype)
        numbers = total.reshape(-1).view(float)
        for part, rows in parts:
            weights = part.weights(p)
            if weights is not None:
                numbers += weights @ rows.reshape(len(rows), -1).view(float)
        return total

    def each(self, form: Callable[[np.ndarray], np.ndarray]) -> Terms:
        """The terms with ``form`` of their rows (q, n), which must be linear and leave the torque first."""
        parts, steel = (
            tuple((part, np.array([form(row) for row in rows])) for part, rows in those)
            for those in (self.parts, self.steel)
        )
        return Terms(form(self.drawn), self.scaling, parts, steel)

    def projected(self, matrix: np.ndarray) -> Terms:
        """The terms with a matrix times their rows (q, n), torque first; kept, for the same is asked about every design
        that a bench is exact at."""
        key = matrix.shape, matrix.tobytes()
        if key not in self._projected:
            self._projected[key] = self.each(lambda rows: matrix @ rows)
        return self._projected[key]

    @cached_property
    def _projected(self) -> dict[tuple, Terms]:
        return {}

    def none(self) -> Terms:
        """No change, whatever is changed."""
        return Terms(np.zeros_like(self.drawn), self.scaling, (), ())


def parts_of(nominal: MachineAsBuilt) -> tuple[Part, ...]:
    """All parts of a machine."""
    coordinates = all_coordinates(nominal)
    places = {c.name: k for k, c in enumerate(coordinates)}
    partners = tuple((c, places[c.name]) for c in toleranced(nominal))
    shifts = [shift_of(path, nominal) for path, _ in SHIFTS]
    moving = {c.name for pair in shifts for c in pair}
    curves = [Curve(c, places[c.name], _others(c, partners)) for c in coordinates if c.name not in moving]
    polar = [Shift(x, y, (places[x.name], places[y.name]), partners, _count(x, nominal)) for x, y in shifts]
    named = {curve.name: curve for curve in curves}
    twice = [Twice(named[a.name], named[b.name]) for (a, _), (b, _) in combinations(partners, 2)]
    return (*curves, *polar, *twice)


def scaling_of(nominal: MachineAsBuilt) -> Scaling:
    """Of the magnets and the steel of a machine."""
    places = {c.path: (k, c.read(nominal)) for k, c in enumerate(all_coordinates(nominal))}
    return Scaling(*places[REMANENCE], tuple(places[path] for path in STEEL))


def _others(c: Coordinate, partners: tuple[tuple[Coordinate, int], ...]) -> tuple[tuple[Coordinate, int], ...]:
    """The partners of a coordinate that was solved beside the drawing."""
    return tuple(pair for pair in partners if pair[0] != c) if c.sizes else ()


def _count(x: Coordinate, nominal: MachineAsBuilt) -> int:
    return nominal.machine.poles if x.breaks == ROTOR else nominal.machine.slots


def terms_of(nominal: MachineAsBuilt, drawn: np.ndarray, changes: Changes) -> Terms:
    """Without current; drawn (1 + coils, orders), rows (terms, 1 + coils, orders)."""
    return _built(nominal, drawn, changes, lambda part: part.rows(changes))


def loaded_terms_of(nominal: MachineAsBuilt, drawn: np.ndarray, changes: Changes, without: Terms, at: Changes) -> Terms:
    """With current; drawn (1 + coils, states), rows (terms, 1 + coils, states). What was not solved with current goes
    as without it beyond its first derivative.

    without: the terms without current at the angles of the states;  at: the slopes without current there
    """
    idle = {part.name: rows for part, rows in without.parts}

    def rows_of(part: Part) -> np.ndarray:
        found = part.rows(changes)
        if found is not None:
            return found
        lines = {c: line for c, line in part.lines().items() if c in changes.slopes}
        return idle[part.name] + sum(np.multiply.outer(v, changes.slopes[c] - at.slopes[c]) for c, v in lines.items())

    return _built(nominal, drawn, changes, rows_of)


def _built(
    nominal: MachineAsBuilt, drawn: np.ndarray, changes: Changes, rows_of: Callable[[Part], np.ndarray]
) -> Terms:
    parts, scaling = parts_of(nominal), scaling_of(nominal)
    places = [place for place, _ in scaling.steel]
    steel = [part for part in parts if isinstance(part, Curve) and part.place in places]
    plain = tuple((part, rows_of(part)) for part in parts if part not in steel)
    alone = Terms(drawn, scaling, plain, ())
    rest = tuple((part, part.rows(_beyond(part, alone, changes, len(all_coordinates(nominal))))) for part in steel)
    return replace(alone, steel=rest)


def _beyond(curve: Curve, alone: Terms, changes: Changes, count: int) -> Changes:
    """The changes along a coordinate of the steel less what other magnets explain of them."""

    def slope(p: np.ndarray, c: Coordinate, place: int) -> np.ndarray:
        step = c.step * np.eye(count)[place]
        return (alone(p + step) - alone(p - step)) / (2 * c.step)

    nodes = {}
    for size in curve.c.sizes:
        p, name = size * np.eye(count)[curve.place], Node(((curve.c, size),)).name
        less = {"change": alone(p), f"along {curve.c.name}": slope(p, curve.c, curve.place)}
        for c, place in curve.partners:
            less[f"along {c.name}"] = slope(p, c, place) - changes.slopes[c.name]
        nodes[name] = {key: rows - less[key] for key, rows in changes.nodes[name].items()}
    here = changes.slopes[curve.c.name] - slope(np.zeros(count), curve.c, curve.place)
    return Changes({**changes.slopes, curve.c.name: here}, nodes)


def _crossed(node: Mapping[str, np.ndarray], changes: Changes, partner: Coordinate) -> np.ndarray | float:
    """By how much the slope along a partner differs at a node; the drawing is none."""
    return node[f"along {partner.name}"] - changes.slopes[partner.name] if node else 0.0


def _alike(rows: Sequence[np.ndarray | float]) -> list[np.ndarray]:
    """All of one shape, zeros for a plain zero."""
    shape = next(np.shape(row) for row in rows if np.ndim(row))
    return [np.broadcast_to(row, shape) for row in rows]


# ---- interpolation ---------------------------------------------------------------------------------------------------


@lru_cache(maxsize=_REMEMBERED)
def hermite(nodes: tuple[float, ...], x: float) -> tuple[np.ndarray, np.ndarray]:
    """Weights of the values and of the slopes at the nodes (k,) of the piecewise cubic at x; one node: its tangent.
    Kept: most coordinates stay from one design to the next."""
    values, slopes = np.zeros(len(nodes)), np.zeros(len(nodes))
    if len(nodes) == 1:
        values[0], slopes[0] = 1.0, x - nodes[0]
        return values, slopes
    i = min(max(bisect_left(nodes, x) - 1, 0), len(nodes) - 2)
    h = nodes[i + 1] - nodes[i]
    t = (x - nodes[i]) / h
    values[i], values[i + 1] = 1 - t * t * (3 - 2 * t), t * t * (3 - 2 * t)
    slopes[i], slopes[i + 1] = h * t * (1 - t) ** 2, -h * t * t * (1 - t)
    return values, slopes


@lru_cache(maxsize=_REMEMBERED)
def through(nodes: tuple[float, ...], x: float) -> np.ndarray:
    """Weights of the values at the nodes (k,) of a piecewise cubic at x, its slopes those of the parabola through each
    node and its neighbours."""
    values, slopes = hermite(nodes, x)
    return values + slopes @ parabola_slopes(nodes)


@lru_cache(maxsize=256)
def parabola_slopes(nodes: tuple[float, ...]) -> np.ndarray:
    """Slopes at all nodes as a matrix of the values (k, k): of the parabola through a node and its neighbours."""
    k, found = len(nodes), np.zeros((len(nodes), len(nodes)))
    for i in range(k):
        first = min(max(i - 1, 0), max(k - 3, 0))
        near = np.arange(first, min(first + 3, k))
        found[i, near] = _lagrange_slopes(np.array(nodes)[near])[i - first]
    return found


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
