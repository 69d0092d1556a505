"""The samples of a machine near its drawing, as quickly as a fit asks for them.

    f(p) = f(centre) + sum over coordinates k of [g_k(p_k) - g_k(centre_k)]

g_k: the parabola through field solutions of the drawing with coordinate k at three sizes. A coordinate is solved when a
design first differs in it. ``about`` moves the centre: exact there, the changes as at the drawing. What two changes do
together beyond their sum is left to that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from functools import partial

import numpy as np

from effects.drawn_design import DrawnAsBuilt, rim_field
from workbench.models.drawn.field import FieldSamples, State

Values = np.ndarray
_OF_A_DIMENSION = 0.1  # of itself
_OF_THE_GAP = 0.2  # of the gap: of the radius of a rim


@dataclass(frozen=True)
class Coordinate:
    """One number that the field depends on.

    read, change: it of a design, and a design with another one;  sizes: differences from the drawing that are solved,
    three of them with zero, in its own unit
    """

    name: str
    read: Callable[[DrawnAsBuilt], float]
    change: Callable[[DrawnAsBuilt, float], DrawnAsBuilt]
    sizes: tuple[float, float, float]


def coordinates(nominal: DrawnAsBuilt) -> Iterator[Coordinate]:
    """All of a machine; magnets up to 20 % weaker or 10 % stronger, steel within a grade or two."""
    b = nominal.magnet.remanence
    if b:
        yield _of_the_magnet("remanence", (-0.2 * b, 0.0, 0.1 * b))
        yield _of_the_magnet("recoil_permeability", (0.0, 0.05, 0.1))
    yield _own("field_scale", (-0.35, 0.0, 0.6))
    yield _own("saturation_scale", (-0.08, 0.0, 0.08))
    yield _own("stacking_factor", (-0.1, -0.05, 0.0))
    for part in ("stator", "rotor"):
        drawn = getattr(nominal.machine, part)
        for one in fields(drawn):
            if isinstance(getattr(drawn, one.name), float):
                yield _dimension(part, one.name, nominal)


def _of_the_magnet(name: str, sizes: tuple[float, float, float]) -> Coordinate:
    return Coordinate(name, lambda d: getattr(d.magnet, name), lambda d, v: d.with_magnet(**{name: v}), sizes)


def _own(name: str, sizes: tuple[float, float, float]) -> Coordinate:
    return Coordinate(name, lambda d: getattr(d, name), lambda d, v: replace(d, **{name: v}), sizes)


def _dimension(part: str, name: str, nominal: DrawnAsBuilt) -> Coordinate:
    drawn = getattr(nominal.machine, part)
    own = name == rim_field(drawn)
    size = _OF_THE_GAP * nominal.machine.airgap if own else _OF_A_DIMENSION * abs(getattr(drawn, name))
    return Coordinate(
        f"{part}.{name}",
        partial(_dimension_of, part, name),
        lambda d, v: d.with_dimension(part, name, v),
        (-size, 0.0, size),
    )


def _dimension_of(part: str, name: str, design: DrawnAsBuilt) -> float:
    return float(getattr(getattr(design.machine, part), name))


class Expansion:
    """Samples of designs about one of them.

    centre: where they are exact, the drawing or another design
    """

    def __init__(self, samples: FieldSamples, centre: DrawnAsBuilt | None = None):
        self.samples, self.drawn, self.drawn_turns = samples, samples.nominal.in_field, samples.nominal.turns
        self.centre = (centre or samples.nominal).in_field
        self._coordinates = tuple(coordinates(self.drawn))
        self._nodes: dict[tuple[str, float], DrawnAsBuilt] = {}

    def about(self, design: DrawnAsBuilt) -> Expansion:
        """The same, exact at another design."""
        return Expansion(self.samples, design)

    def at_centre(self, states: Sequence[State]) -> Values:
        """Samples at the centre (states, 4)."""
        return self.samples.at(self.centre, states)

    def change(self, design: DrawnAsBuilt, states: Sequence[State]) -> Values:
        """By how much the samples of a design differ from those at the centre (states, 4)."""
        total = np.zeros((len(states), 4))
        for c in self._coordinates:
            here, centre = c.read(design), c.read(self.centre)
            if here != centre:
                start = c.read(self.drawn)
                weights = _parabola(c.sizes, here - start) - _parabola(c.sizes, centre - start)
                total += sum(w * self._node(c, size, states) for w, size in zip(weights, c.sizes, strict=True))
        return total

    def _node(self, c: Coordinate, size: float, states: Sequence[State]) -> Values:
        if (c.name, size) not in self._nodes:  # kept, so that the name of its field is made once
            self._nodes[c.name, size] = c.change(self.drawn, c.read(self.drawn) + size) if size else self.drawn
        return self.samples.at(self._nodes[c.name, size], states)


def _parabola(nodes: tuple[float, float, float], x: float) -> Values:
    """Weights of the values at three nodes (3,)."""
    return np.array([
        np.prod([(x - other) / (node - other) for other in nodes if other != node]) for node in nodes
    ])  # fmt: skip
