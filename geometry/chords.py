"""How many straight edges an arc needs: chords lie inside of the circle and take away from narrow iron beside it."""

from __future__ import annotations

from math import acos, atan2, ceil, hypot, log, pi

from geometry.plane_mesh import Drawing

_OFF = 0.02  # of the edges on the sliding circle: how far the middle of a chord may lie from its arc


def with_short_chords(drawing: Drawing, edge_length: float) -> Drawing:
    """The drawing, in which arcs whose ends ask for too long edges have a number of equal ones.

    edge_length: on the sliding circle [m]; a chord over the angle t lies r (1 - cos(t/2)) from its arc, so that the
    error of the outline falls with the square of the edges there, as fast as that of straight elements anywhere
    """
    for (start, end), (is_arc, edges) in list(drawing.curves.items()):
        if is_arc and edges is None:
            needed = _needed(drawing, start, end, _OFF * edge_length)
            if needed > natural_edges(drawing, start, end):
                drawing.curves[start, end] = (True, needed)
    return drawing


def natural_edges(drawing: Drawing, start: str, end: str) -> float:
    """How many edges a curve has [1] by the lengths that its ends ask for, which change linearly in between."""
    first, last = drawing.points[start][2], drawing.points[end][2]
    length, growth = curve_length(drawing, start, end), log(last / first)
    return max(1.0, length / first if abs(growth) < 1e-6 else length * growth / (last - first))


def curve_length(drawing: Drawing, start: str, end: str) -> float:
    """[m]"""
    if drawing.curves[start, end][0]:
        radius, turn = _arc(drawing, start, end)
        return radius * turn
    (x, y, _), (u, v, _) = drawing.points[start], drawing.points[end]
    return hypot(u - x, v - y)


def _needed(drawing: Drawing, start: str, end: str, off: float) -> int:
    radius, turn = _arc(drawing, start, end)
    return ceil(turn / (2 * acos(max(1 - off / radius, 0.0))))


def _arc(drawing: Drawing, start: str, end: str) -> tuple[float, float]:
    """Radius [m] and angle [rad], less than half a turn."""
    (x, y, _), (u, v, _) = drawing.points[start], drawing.points[end]
    a, b = drawing.centres.get((start, end), (0.0, 0.0))
    turn = atan2(v - b, u - a) - atan2(y - b, x - a)
    return hypot(x - a, y - b), abs((turn + pi) % (2 * pi) - pi)
