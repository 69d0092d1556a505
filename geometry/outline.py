"""Outlines of the parts of the whole machine: closed contours of straight lines and of arcs about the axis.

They come from the drawing of the half cells that is meshed (``geometry.half_cell``), so that what is ordered is what
was solved: a part is some copies of a region, and a curve that two of its copies share lies inside it and is left out.
"""

from __future__ import annotations

from cmath import phase, rect
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import pi

from geometry.half_cell import HalfCell, MeshDensity, half_cells
from geometry.machine import Machine
from geometry.plane_mesh import Drawing

_SAME_PLACE = 1e-9  # m; far below any dimension, far above round-off
_SAME_DIRECTION = 1e-9  # rad
_FULL_TURN = 2 * pi


@dataclass(frozen=True)
class Line:
    """A straight line between two points x + jy [m]."""

    start: complex
    end: complex

    @property
    def swept(self) -> float:
        """Area that the ray from the axis sweeps [m^2], positive counter-clockwise."""
        return (self.start.conjugate() * self.end).imag / 2

    def joined(self, other: Curve) -> Curve | None:
        """One line in the place of this and the next, None where they make a corner."""
        if not isinstance(other, Line):
            return None
        turn = phase((other.end - other.start) / (self.end - self.start))
        return Line(self.start, other.end) if abs(turn) < _SAME_DIRECTION else None


@dataclass(frozen=True)
class Arc:
    """A circular arc about the axis.

    radius: [m]; first: angle of its start [rad]; sweep: [rad], positive counter-clockwise, a full circle at 2 pi
    """

    radius: float
    first: float
    sweep: float

    @property
    def start(self) -> complex:
        """First point x + jy [m]."""
        return rect(self.radius, self.first)

    @property
    def end(self) -> complex:
        """Last point x + jy [m]."""
        return rect(self.radius, self.first + self.sweep)

    @property
    def is_circle(self) -> bool:
        """Whether it closes on itself."""
        return abs(abs(self.sweep) - _FULL_TURN) < _SAME_DIRECTION

    @property
    def swept(self) -> float:
        """Area that the ray from the axis sweeps [m^2], positive counter-clockwise."""
        return self.radius**2 * self.sweep / 2

    def joined(self, other: Curve) -> Curve | None:
        """One arc in the place of this and the next, None where they make a corner."""
        if not isinstance(other, Arc) or abs(other.radius - self.radius) > _SAME_PLACE:
            return None
        return Arc(self.radius, self.first, self.sweep + other.sweep) if self.sweep * other.sweep > 0 else None


Curve = Line | Arc


@dataclass(frozen=True)
class Contour:
    """Curves in order, each from the end of the one before, the last one back to the first."""

    curves: tuple[Curve, ...]

    @property
    def area(self) -> float:
        """What it encloses [m^2], negative for a hole, which runs clockwise."""
        return sum(curve.swept for curve in self.curves)


@dataclass(frozen=True)
class Part:
    """One piece of the machine: its contour, and those of its holes, which run clockwise."""

    contours: tuple[Contour, ...]

    @property
    def area(self) -> float:
        """Of the section [m^2]."""
        return sum(contour.area for contour in self.contours)


@dataclass(frozen=True)
class Outline:
    """Every part of the whole machine with magnet 0 on the axis of tooth 0.

    stator, rotor: laminations; magnets: by number; coil_sides: by (slot, side), see ``geometry.winding``
    """

    stator: Part
    rotor: Part
    shaft: Part
    magnets: tuple[Part, ...]
    coil_sides: dict[tuple[int, str], Part]


def outline_of(machine: Machine) -> Outline:
    """The outline of a machine that can be built (``geometry.checks``)."""
    stator_cell, rotor_cell = half_cells(machine, MeshDensity())
    stator, rotor = _Ring(stator_cell, machine), _Ring(rotor_cell, machine)
    return Outline(
        stator=stator.part("iron", range(2 * machine.slots)),
        rotor=rotor.part("iron", range(2 * machine.poles)),
        shaft=rotor.part("shaft", range(2 * machine.poles)),
        magnets=tuple(rotor.part("magnet", (2 * m, 2 * m + 1)) for m in range(machine.poles)),
        coil_sides={
            (slot, side): stator.part("copper", [2 * slot + place])
            for slot in range(machine.slots)
            for side, place in (("R", 1), ("L", 2))
        },
    )


class _Ring:
    """Copies of a half cell round the machine, numbered and mirrored as in ``geometry.cross_section.Piece``."""

    def __init__(self, cell: HalfCell, machine: Machine) -> None:
        self.drawing, self.pitch = cell.draw(machine), 2 * cell.width(machine)
        self.regions = {name: _loop(self.drawing, corners) for name, corners in self.drawing.regions.items()}

    def part(self, region: str, copies: Iterable[int]) -> Part:
        """A region in some copies as one part."""
        curves = [_placed(curve, copy, self.pitch) for copy in copies for curve in self.regions[region]]
        return Part(tuple(Contour(_smooth(loop)) for loop in _loops(_outer(curves))))


def _loop(drawing: Drawing, corners: tuple[str, ...]) -> list[Curve]:
    """Curves of a region, counter-clockwise."""
    curves = [_curve(drawing, start, end) for start, end in zip(corners, corners[1:] + corners[:1])]
    return curves if Contour(tuple(curves)).area > 0 else [_backwards(one) for one in reversed(curves)]


def _curve(drawing: Drawing, start: str, end: str) -> Curve:
    is_arc, _ = drawing.curves[(start, end) if (start, end) in drawing.curves else (end, start)]
    a, b = (complex(*drawing.points[name][:2]) for name in (start, end))
    return Arc(abs(a), phase(a), phase(b / a)) if is_arc else Line(a, b)


def _backwards(curve: Curve) -> Curve:
    if isinstance(curve, Line):
        return Line(curve.end, curve.start)
    return Arc(curve.radius, curve.first + curve.sweep, -curve.sweep)


def _placed(curve: Curve, copy: int, pitch: float) -> Curve:
    """A curve of the half cell in one copy; even ones are mirrored at the axis, and so run backwards."""
    turned = copy // 2 * pitch
    if copy % 2 == 0:
        curve = _mirrored(_backwards(curve))
    if isinstance(curve, Line):
        return Line(curve.start * rect(1.0, turned), curve.end * rect(1.0, turned))
    return Arc(curve.radius, curve.first + turned, curve.sweep)


def _mirrored(curve: Curve) -> Curve:
    if isinstance(curve, Line):
        return Line(curve.start.conjugate(), curve.end.conjugate())
    return Arc(curve.radius, -curve.first, -curve.sweep)


def _outer(curves: list[Curve]) -> Iterator[Curve]:
    """Those that no other one runs along."""
    count = Counter(frozenset((_place(one.start), _place(one.end))) for one in curves)
    return (one for one in curves if count[frozenset((_place(one.start), _place(one.end)))] == 1)


def _place(point: complex) -> tuple[int, int]:
    return round(point.real / _SAME_PLACE), round(point.imag / _SAME_PLACE)


def _loops(curves: Iterable[Curve]) -> Iterator[list[Curve]]:
    """Curves in the order in which they follow each other, loop by loop."""
    following = {_place(one.start): one for one in curves}
    while following:
        _, first = following.popitem()
        loop = [first]
        while (at := _place(loop[-1].end)) in following:
            loop.append(following.pop(at))
        yield loop


def _smooth(loop: list[Curve]) -> tuple[Curve, ...]:
    """The same contour with one curve in the place of several that go on into each other."""
    corners = [k for k, (one, other) in enumerate(pairwise([*loop, loop[0]])) if one.joined(other) is None]
    first = corners[0] + 1 if corners else 0
    smooth: list[Curve] = []
    for curve in [*loop[first:], *loop[:first]]:
        whole = smooth[-1].joined(curve) if smooth else None
        smooth[-1:] = [whole] if whole is not None else [*smooth[-1:], curve]
    return tuple(smooth)
