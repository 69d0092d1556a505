"""Half a pitch of a part cut out of its outline: curves of a whole drawing between two rays, and the faces they bound.

An outline is what a workshop has: lines and arcs about any centre, in any order. Between the axis of a pole or tooth
and half a pitch further on it is cut at both rays and at given circles; every face between curves becomes a region.
Places closer than ``SAME_PLACE`` are one.
"""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import pi, sqrt

from geometry.chords import with_short_chords
from geometry.errors import GeometryError, in_mm
from geometry.outline import Arc, Contour, Curve, Line
from geometry.parts import Rim
from geometry.plane_mesh import Drawing

SAME_PLACE = 2e-6  # m; drawings close to a micrometre or two


@dataclass(frozen=True)
class Face:
    """corners: points x + jy [m] in order, counter-clockwise; curves: from each to the next"""

    curves: tuple[Curve, ...]

    @property
    def contour(self) -> Contour:
        """Its boundary."""
        return Contour(self.curves)

    @property
    def inside(self) -> complex:
        """Some place in it, x + jy [m]: just inside of the middle of its longest curve."""
        longest = max(self.curves, key=lambda curve: abs(curve.end - curve.start))
        middle, forward = longest.at(0.5), longest.at(0.51) - longest.at(0.49)
        return middle + 1j * forward / abs(forward) * 10 * SAME_PLACE

    @property
    def centre(self) -> complex:
        """Mean of its corners x + jy [m]."""
        return sum(curve.start for curve in self.curves) / len(self.curves)

    def lies_along(self, angle: float) -> bool:
        """Whether one of its curves runs along the ray at an angle [rad]."""
        seen = (curve.turned(-angle) for curve in self.curves)
        return any(max(abs(curve.at(share).imag) for share in (0.0, 0.5, 1.0)) < SAME_PLACE for curve in seen)


def cut_out(outline: Sequence[Curve], rays: Sequence[float], circles: Sequence[float]) -> tuple[Face, ...]:
    """The faces of an outline between the first and the last of some rays [rad], cut at those between them.

    circles: radii of further arcs from ray to ray [m], the outermost of which ends the part
    Raises GeometryError where the curves do not close.
    """
    within = _split_at_ends([piece for curve in outline for piece in _between(curve, rays)])
    arcs = [
        one
        for radius in circles
        for a, b in zip(rays, rays[1:])
        for one in _split_at_places(Arc(radius, a, b - a), within)
    ]
    pieces = _split_by_circles(within, circles) + arcs
    reach = max(circles) + SAME_PLACE
    kept = _once([one for one in pieces if abs(one.at(0.5)) < reach])
    return tuple(_faces(_once([*kept, *_rays(kept, rays)])))


def is_inside(outline: Sequence[Curve], place: complex) -> bool:
    """Whether an odd number of contours runs round a place x + jy [m]."""
    return sum(_crosses(piece, place) for curve in outline for piece in _rising_or_falling(curve)) % 2 == 1


def _rising_or_falling(curve: Curve) -> Iterator[Curve]:
    """Pieces along which y only rises or only falls."""
    return iter([curve]) if isinstance(curve, Line) else _split(curve, (_share(curve, a) for a in (pi / 2, -pi / 2)))


def _crosses(piece: Curve, place: complex) -> bool:
    """Whether it meets the line from a place on in the direction of x."""
    a, b, y = piece.start, piece.end, place.imag
    if (a.imag > y) == (b.imag > y):
        return False
    if isinstance(piece, Line):
        return a.real + (y - a.imag) / (b.imag - a.imag) * (b.real - a.real) > place.real
    aside = sqrt(max(0.0, piece.radius**2 - (y - piece.centre.imag) ** 2))
    return piece.centre.real + (aside if piece.at(0.5).real > piece.centre.real else -aside) > place.real


def touches(face: Face, radius: float) -> bool:
    """Whether a face reaches a circle about the axis [m] with a curve along it."""
    return any(_along(curve, radius) for curve in face.curves)


def places_on(face: Face, radius: float) -> list[complex]:
    """Where the boundary of a face crosses a circle about the axis [m], x + jy [m]."""
    return [curve.at(share) for curve in face.curves for share in _on_circle(curve, radius) if 0 <= share <= 1]


def drawing_of(regions: Mapping[str, Sequence[Face]], rim: Rim, radius: float, coarse: float) -> Drawing:
    """Faces of regions by their names; the rim lies on the circle of a radius [m].

    coarse: longest edge [m]; at a place it is no longer than the shortest curve there, down to those of the rim
    """
    d = Drawing()
    curves = _once([curve for faces in regions.values() for face in faces for curve in face.curves])
    names = _named([place for curve in curves for place in (curve.start, curve.end)])
    for place, name in names.items():
        shortest = min(one.length for one in curves if place in _ends(one, names))
        d.place(name, place.real, place.imag, min(coarse, max(shortest, rim.edge_length)))
    edges = _edges_on([curve for curve in curves if _along(curve, radius)], rim.edges)
    for curve in curves:
        start, end = (names[place] for place in _ends(curve, names))
        if isinstance(curve, Line):
            d.line(start, end, edges.get(curve))
        else:
            d.arc(start, end, edges.get(curve), centre=(curve.centre.real, curve.centre.imag))
    for region, face in ((region, face) for region, faces in regions.items() for face in faces):
        d.region(region, *(names[_known_in(names, curve.start)] for curve in face.curves))
    return with_short_chords(d, rim.edge_length)


def _edges_on(rim: Sequence[Curve], count: int) -> dict[Curve, int]:
    """How many edges of the rim each of its pieces has: one at least, ``count`` in all, shared out by length."""
    total, done, found = sum(curve.length for curve in rim), 0.0, {}
    bounds = [0]
    for number, curve in enumerate(sorted(rim, key=lambda one: phase(one.at(0.5)))):
        done += curve.length
        least, most = bounds[-1] + 1, count - (len(rim) - number - 1)
        bounds.append(min(max(round(count * done / total), least), most))
        found[curve] = bounds[-1] - bounds[-2]
    if min(found.values()) < 1:
        raise GeometryError(f"the rim has {len(rim)} pieces and only {count} edges: refine gap_edges_per_revolution")
    return found


def _along(curve: Curve, radius: float) -> bool:
    return all(abs(abs(curve.at(share)) - radius) < SAME_PLACE for share in (0.0, 0.5, 1.0))


def _named(places: Iterable[complex]) -> dict[complex, str]:
    known: list[complex] = []
    for place in places:
        _known(known, place)
    return {place: f"p{number}" for number, place in enumerate(known)}


def _ends(curve: Curve, names: Mapping[complex, str]) -> tuple[complex, complex]:
    return _known_in(names, curve.start), _known_in(names, curve.end)


def _known_in(names: Mapping[complex, str], place: complex) -> complex:
    return min(names, key=lambda one: abs(one - place))


# ---- pieces of curves ------------------------------------------------------------------------------------------------


def _split(curve: Curve, shares: Iterable[float]) -> Iterator[Curve]:
    """At shares of it, none of the pieces shorter than ``SAME_PLACE``."""
    least = SAME_PLACE / max(curve.length, SAME_PLACE)
    inner = sorted(share for share in shares if least < share < 1 - least)
    ends = [0.0, *(b for a, b in zip([-1.0, *inner], inner) if b - a > least), 1.0]
    return (curve.part(a, b) for a, b in zip(ends, ends[1:]))


def _between(curve: Curve, rays: Sequence[float]) -> list[Curve]:
    """The pieces of a curve between the first and the last ray."""
    shares = [share for angle in rays for share in _on_ray(curve, angle)]
    return [one for one in _split(curve, shares) if _is_between(one.at(0.5), rays[0], rays[-1])]


def _is_between(place: complex, first: float, last: float) -> bool:
    """Not on a ray: those are drawn anew. Half a pitch is less than half a turn."""
    away = ((place * rect(1.0, -first)).imag, (place * rect(1.0, -last)).imag)
    return away[0] > SAME_PLACE / 2 and away[1] < -SAME_PLACE / 2


def _on_ray(curve: Curve, angle: float) -> list[float]:
    """Where a curve meets the line through the axis of the machine at an angle, as shares of the curve."""
    seen = curve.turned(-angle)
    if isinstance(seen, Line):
        rise = seen.end.imag - seen.start.imag
        return [] if rise == 0 else [-seen.start.imag / rise]
    height = -seen.centre.imag / seen.radius
    if abs(height) > 1:
        return []
    run = sqrt(1 - height**2)
    return [_share(seen, phase(complex(sign * run, height))) for sign in (1, -1)]


def _share(arc: Arc, angle: float) -> float:
    """Of an arc at an angle about its centre [rad]; beyond 1 where the arc does not reach."""
    ahead = (angle - arc.first) * (1 if arc.sweep > 0 else -1)
    return (ahead % (2 * pi)) / abs(arc.sweep)


def _on_circle(curve: Curve, radius: float) -> list[float]:
    """Where a curve meets a circle about the axis, as shares of the curve; none where it runs along it."""
    if isinstance(curve, Line):
        along = curve.end - curve.start
        b, c = (curve.start.conjugate() * along).real / abs(along), abs(curve.start) ** 2 - radius**2
        under = b * b - c
        return [] if under < 0 else [(-b + sign * sqrt(under)) / abs(along) for sign in (1, -1)]
    distance = abs(curve.centre)
    if distance < SAME_PLACE:
        return []
    cosine = (radius**2 - distance**2 - curve.radius**2) / (2 * distance * curve.radius)
    if abs(cosine) > 1:
        return []
    off = phase(complex(cosine, sqrt(1 - cosine**2)))
    return [_share(curve, phase(curve.centre) + sign * off) for sign in (1, -1)]


def _split_by_circles(curves: Iterable[Curve], circles: Sequence[float]) -> list[Curve]:
    return [
        piece
        for curve in curves
        for piece in _split(curve, (share for radius in circles for share in _on_circle(curve, radius)))
    ]


def _split_at_ends(curves: Sequence[Curve]) -> list[Curve]:
    """Every curve where another one ends on it, so that two that run along each other have pieces in common."""
    ends = [place for one in curves for place in (one.start, one.end)]
    return [piece for one in curves for piece in _split(one, (_share_at(one, place) for place in ends))]


def _share_at(curve: Curve, place: complex) -> float:
    """Share of a curve at a place on it, 0 where the place is off."""
    if isinstance(curve, Line):
        along = curve.end - curve.start
        share = ((place - curve.start) * along.conjugate()).real / abs(along) ** 2
    elif place == curve.centre:
        return 0.0
    else:
        share = _share(curve, phase(place - curve.centre))
    return share if abs(curve.at(share) - place) < SAME_PLACE else 0.0


def _split_at_places(arc: Arc, curves: Sequence[Curve]) -> list[Curve]:
    """An arc about the axis at every end of a curve on it, and where a curve crosses it."""
    pieces = _split_by_circles(curves, [arc.radius])
    places = [place for one in pieces for place in (one.start, one.end)]
    shares = (phase(p * rect(1.0, -arc.first)) / arc.sweep for p in places if abs(abs(p) - arc.radius) < SAME_PLACE)
    return list(_split(arc, shares))


def _rays(curves: Sequence[Curve], rays: Sequence[float]) -> Iterator[Curve]:
    """Every ray from the axis on, from end to end of what meets it."""
    ends = [place for one in curves for place in (one.start, one.end)]
    for angle in rays:
        seen = [place * rect(1.0, -angle) for place in ends]
        radii = sorted({0.0, *(abs(place) for place in seen if abs(place.imag) < SAME_PLACE and place.real > 0)})
        apart = [r for k, r in enumerate(radii) if k == 0 or r - radii[k - 1] > SAME_PLACE]
        yield from (Line(rect(a, angle), rect(b, angle)) for a, b in zip(apart, apart[1:]))


def _once(curves: Sequence[Curve]) -> list[Curve]:
    """Without those that run along another one, and without those of no length."""
    found: dict[tuple[frozenset[complex], complex], Curve] = {}
    places: list[complex] = []
    for curve in curves:
        ends = frozenset((_known(places, curve.start), _known(places, curve.end)))
        if len(ends) == 2:
            found.setdefault((ends, _known(places, curve.at(0.5))), curve)
    return list(found.values())


def _known(places: list[complex], place: complex) -> complex:
    """The place of the list that this one is, or itself, added to the list."""
    near = next((one for one in places if abs(one - place) < SAME_PLACE), None)
    if near is None:
        places.append(place)
        return place
    return near


# ---- faces -----------------------------------------------------------------------------------------------------------


def _faces(curves: Sequence[Curve]) -> Iterator[Face]:
    """Every bounded face, found by turning as far left as possible at each place."""
    places: list[complex] = []
    ways = [one for curve in curves for one in (curve, curve.part(1.0, 0.0))]
    from_to = [(_known(places, one.start), _known(places, one.end)) for one in ways]
    leaving: dict[complex, list[int]] = {}
    for number, (start, _) in enumerate(from_to):
        leaving.setdefault(start, []).append(number)
    _check_closed(leaving)
    left = set(range(len(ways)))
    while left:
        loop = _loop(min(left), ways, from_to, leaving)
        left -= set(loop)
        face = Face(tuple(ways[number] for number in loop))
        if face.contour.area > 0:
            yield face


def _check_closed(leaving: dict[complex, list[int]]) -> None:
    loose = [place for place, numbers in leaving.items() if len(numbers) < 2]
    if loose:
        raise GeometryError(
            f"the outline does not close at x = {in_mm(loose[0].real)}, y = {in_mm(loose[0].imag)} (turned so that the "
            "axis of a pole or tooth lies on x): join the curves there"
        )


def _loop(
    first: int, ways: Sequence[Curve], from_to: Sequence[tuple[complex, complex]], leaving: dict[complex, list[int]]
) -> list[int]:
    loop, at = [first], first
    while True:
        arrived, back = from_to[at][1], _heading_back(ways[at])
        onward = [number for number in leaving[arrived] if number != (at ^ 1)]
        at = min(onward, key=lambda number: (back - _heading(ways[number])) % (2 * pi))
        if at == first:
            return loop
        if len(loop) > len(ways):
            place = ways[at].start
            raise GeometryError(
                f"curves of the outline run along each other at x = {in_mm(place.real)}, y = {in_mm(place.imag)} "
                "(turned so that the axis of a pole or tooth lies on x): draw each once"
            )
        loop.append(at)


def _heading(curve: Curve) -> float:
    """Direction in which a curve leaves its start [rad]; seen a little way on, so that arcs which touch differ."""
    return phase(curve.at(min(0.1, 20 * SAME_PLACE / curve.length)) - curve.start)


def _heading_back(curve: Curve) -> float:
    """Direction from the end of a curve back along it [rad]."""
    return phase(curve.at(1 - min(0.1, 20 * SAME_PLACE / curve.length)) - curve.end)

