"""Outlines of the parts of the whole machine: closed contours of straight lines and of arcs.

They come from the drawing of the half pitches that is meshed (``geometry.parts``), so that what is ordered is what
was solved: a part is some copies of a region, and a curve that two of its copies share lies inside it and is left out.
"""

from __future__ import annotations

from cmath import phase, rect
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from math import pi, sin

from geometry.parts import DrawnMachine, Rim, Rotor
from geometry.parts import Part as DrawnPart
from geometry.plane_mesh import Drawing

SHAFT = "shaft"  # region of a rotor whose shaft is drawn
_ANY_RIM = Rim(edges=8, edge_length=1.0, across_iron=1.0)  # how finely it is meshed moves no corner
_SAME_PLACE = 1e-9  # m; far below any dimension, far above round-off
_SAME_DIRECTION = 1e-9  # rad
_FULL_TURN = 2 * pi


@dataclass(frozen=True)
class Line:
    """A straight line between two points x + jy [m]."""

    start: complex
    end: complex

    @property
    def length(self) -> float:
        """[m]"""
        return abs(self.end - self.start)

    def at(self, share: float) -> complex:
        """A place on it x + jy [m]; share: 0 at its start, 1 at its end, dimensionless"""
        return self.start + share * (self.end - self.start)

    def part(self, first: float, last: float) -> Line:
        """From one place on it to another; first, last: shares, dimensionless, falling to run backwards"""
        return Line(self.at(first), self.at(last))

    def turned(self, angle: float) -> Line:
        """About the axis by an angle [rad]."""
        return Line(self.start * rect(1.0, angle), self.end * rect(1.0, angle))

    @property
    def mirrored(self) -> Line:
        """At the x axis."""
        return Line(self.start.conjugate(), self.end.conjugate())

    @property
    def swept(self) -> float:
        """Area that the ray from the axis sweeps [m^2], positive counter-clockwise."""
        return (self.start.conjugate() * self.end).imag / 2

    @property
    def swept_moment(self) -> float:
        """Polar moment of that area about the axis [m^4]."""
        squares = abs(self.start) ** 2 + abs(self.end) ** 2 + (self.start.conjugate() * self.end).real
        return self.swept * squares / 6

    def joined(self, other: Curve) -> Curve | None:
        """One line in the place of this and the next, None where they make a corner."""
        if not isinstance(other, Line):
            return None
        turn = phase((other.end - other.start) / (self.end - self.start))
        return Line(self.start, other.end) if abs(turn) < _SAME_DIRECTION else None


@dataclass(frozen=True)
class Arc:
    """A circular arc.

    radius: [m]; first: angle of its start about its centre [rad]; sweep: [rad], positive counter-clockwise, a full
    circle at 2 pi; centre: x + jy [m], the axis of the machine where none is given
    """

    radius: float
    first: float
    sweep: float
    centre: complex = 0j

    @property
    def start(self) -> complex:
        """First point x + jy [m]."""
        return self.at(0.0)

    @property
    def end(self) -> complex:
        """Last point x + jy [m]."""
        return self.at(1.0)

    @property
    def length(self) -> float:
        """[m]"""
        return abs(self.radius * self.sweep)

    def at(self, share: float) -> complex:
        """A place on it x + jy [m]; share: 0 at its start, 1 at its end, dimensionless"""
        return self.centre + rect(self.radius, self.first + share * self.sweep)

    def part(self, first: float, last: float) -> Arc:
        """From one place on it to another; first, last: shares, dimensionless, falling to run backwards"""
        return replace(self, first=self.first + first * self.sweep, sweep=(last - first) * self.sweep)

    def turned(self, angle: float) -> Arc:
        """About the axis by an angle [rad]."""
        return replace(self, first=self.first + angle, centre=self.centre * rect(1.0, angle))

    @property
    def mirrored(self) -> Arc:
        """At the x axis."""
        return Arc(self.radius, -self.first, -self.sweep, self.centre.conjugate())

    @property
    def is_circle(self) -> bool:
        """Whether it closes on itself."""
        return abs(abs(self.sweep) - _FULL_TURN) < _SAME_DIRECTION

    @property
    def swept(self) -> float:
        """Area that the ray from the axis sweeps [m^2], positive counter-clockwise."""
        chord = (self.centre.conjugate() * (self.end - self.start)).imag
        return (self.radius**2 * self.sweep + chord) / 2

    @property
    def swept_moment(self) -> float:
        """Polar moment of that area about the axis [m^4].

        1/4 integral of r^2 (x dy - y dx), with r^2 = R^2 + c^2 + 2 R c cos(psi), x dy - y dx = R (R + c cos(psi)) dpsi,
        psi counted from the direction of the centre at c
        """
        radius, distance = self.radius, abs(self.centre)
        ends = (self.first - phase(self.centre), self.first + self.sweep - phase(self.centre))
        cosine = sin(ends[1]) - sin(ends[0])
        square = self.sweep / 2 + (sin(2 * ends[1]) - sin(2 * ends[0])) / 4
        sum_of_squares = radius**2 + distance**2
        constant = radius * sum_of_squares * self.sweep + distance * (sum_of_squares + 2 * radius**2) * cosine
        return radius / 4 * (constant + 2 * radius * distance**2 * square)

    def joined(self, other: Curve) -> Curve | None:
        """One arc in the place of this and the next, None where they make a corner."""
        if not isinstance(other, Arc) or abs(other.radius - self.radius) > _SAME_PLACE:
            return None
        goes_on = self.sweep * other.sweep > 0 and abs(other.centre - self.centre) < _SAME_PLACE
        return replace(self, sweep=self.sweep + other.sweep) if goes_on else None


Curve = Line | Arc


@dataclass(frozen=True)
class Contour:
    """Curves in order, each from the end of the one before, the last one back to the first."""

    curves: tuple[Curve, ...]

    @property
    def area(self) -> float:
        """What it encloses [m^2], negative for a hole, which runs clockwise."""
        return sum(curve.swept for curve in self.curves)

    @property
    def moment(self) -> float:
        """Its polar moment about the axis [m^4], negative for a hole."""
        return sum(curve.swept_moment for curve in self.curves)


@dataclass(frozen=True)
class Part:
    """One piece of the machine: its contour, and those of its holes, which run clockwise."""

    contours: tuple[Contour, ...]

    @property
    def area(self) -> float:
        """Of the section [m^2]."""
        return sum(contour.area for contour in self.contours)

    @property
    def moment(self) -> float:
        """Polar moment of the section about the axis [m^4]."""
        return sum(contour.moment for contour in self.contours)


@dataclass(frozen=True)
class Outline:
    """Every part of the whole machine with pole 0 on the axis of tooth 0.

    stator, rotor: laminations; magnets: by number; coil_sides: by (slot, side), see ``geometry.winding``
    shaft: a solid bar, without contours in a rotor that leaves no room for one
    """

    stator: Part
    rotor: Part
    shaft: Part
    magnets: tuple[Part, ...]
    coil_sides: dict[tuple[int, str], Part]


def outline_of(machine: DrawnMachine) -> Outline:
    """The outline of a machine that can be built (``geometry.checks``)."""
    stator, rotor = _Ring(machine.stator, 2 * machine.slots), _Ring(machine.rotor, 2 * machine.repeats)
    return Outline(
        stator=stator.whole("iron"),
        rotor=rotor.whole("iron"),
        shaft=_shaft(machine.rotor, rotor),
        magnets=tuple(rotor.part(*one) for one in _magnets(machine.rotor)),
        coil_sides={
            (slot, side): stator.part("copper", [2 * slot + place])
            for slot in range(machine.slots)
            for side, place in (("R", 1), ("L", 2))
        },
    )


def region_contours(part: DrawnPart) -> dict[str, Contour]:
    """Of the regions of half a pitch of a stator or rotor."""
    drawing = part.draw(_ANY_RIM)
    return {
        name: Contour(tuple(curve for corners in faces for curve in _loop(drawing, corners)))
        for name, faces in drawing.regions.items()
    }


def _magnets(rotor: Rotor) -> Iterator[tuple[str, range]]:
    """Region and half pitches of every magnet: two for one on the axis of its pole, one for one beside it."""
    each, halves = 2 if rotor.magnets_per_pitch == 1 else 1, range(2 * rotor.repeats)
    for first in halves[::each]:
        yield from ((region, halves[first : first + each]) for region in rotor.magnet_regions)


def _shaft(rotor: Rotor, ring: _Ring) -> Part:
    if rotor.bore_radius > 0:
        return Part((Contour((Arc(rotor.bore_radius, 0.0, _FULL_TURN),)),))
    return ring.whole(SHAFT) if SHAFT in ring.regions else Part(())


class _Ring:
    """Copies of half a pitch round the machine, numbered and mirrored as in ``geometry.cross_section.Piece``."""

    def __init__(self, part: DrawnPart, copies: int) -> None:
        self.pitch, self.ray, self.copies = part.pitch, part.first_ray, copies
        self.regions = {name: contour.curves for name, contour in region_contours(part).items()}

    def whole(self, region: str) -> Part:
        """A region in all copies as one part."""
        return self.part(region, range(self.copies))

    def part(self, region: str, copies: Iterable[int]) -> Part:
        """A region in some copies as one part."""
        drawn = self.regions[region]
        curves = [_placed(curve, copy, self.pitch).turned(self.ray) for copy in copies for curve in drawn]
        return Part(tuple(Contour(_smooth(loop)) for loop in _loops(_outer(curves))))


def _loop(drawing: Drawing, corners: tuple[str, ...]) -> list[Curve]:
    """Curves of a region, counter-clockwise."""
    curves = [_curve(drawing, start, end) for start, end in zip(corners, corners[1:] + corners[:1])]
    return curves if Contour(tuple(curves)).area > 0 else [one.part(1.0, 0.0) for one in reversed(curves)]


def _curve(drawing: Drawing, start: str, end: str) -> Curve:
    drawn = (start, end) if (start, end) in drawing.curves else (end, start)
    is_arc, _ = drawing.curves[drawn]
    a, b = (complex(*drawing.points[name][:2]) for name in (start, end))
    return _arc(a, b, complex(*drawing.centres.get(drawn, (0.0, 0.0)))) if is_arc else Line(a, b)


def _arc(start: complex, end: complex, centre: complex) -> Arc:
    spoke = start - centre
    return Arc(abs(spoke), phase(spoke), phase((end - centre) / spoke), centre)


def _placed(curve: Curve, copy: int, pitch: float) -> Curve:
    """A curve of the half cell in one copy; even ones are mirrored at the axis, and so run backwards."""
    drawn = curve.part(1.0, 0.0).mirrored if copy % 2 == 0 else curve
    return drawn.turned(copy // 2 * pitch)


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
