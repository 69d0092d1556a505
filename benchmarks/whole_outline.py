"""The drawing of a whole machine as curves with a region on either side: what another code's own mesher begins with.

No node and no triangle of this project's mesh is in it: every half pitch of stator and rotor as it is drawn
(``geometry.outline``), mirrored and turned to its place, the rotor at an angle; the gap is what is left between.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from benchmarks.conforming_mesh import merge
from geometry.outline import Arc, Curve, region_contours
from geometry.parts import DrawnMachine, Part

AIR, GAP, NOTHING = "air", "gap", ""
OUTER, RIM = "outer", "rotor_rim"  # names of boundaries: potential zero, and where the gap meets the rotor
_WIDEST = np.pi / 3  # rad, of one piece of an arc
_ON_CIRCLE = 1e-9  # m
_Placed = tuple[Curve, str]  # a curve and the region on its left
_Names = Callable[[str, int], str]  # of a region in a copy of half a pitch
_Key = tuple[int, int, int]  # indices of the points where a curve begins, passes half-way and ends


@dataclass(frozen=True, eq=False)
class WholeOutline:
    """Curves (k,) of a machine with its rotor turned.

    points (n, 2) [m]; ends (k, 2), middle (k,): indices of points, where a curve begins, ends and passes half-way
    is_arc (k,); left, right, boundary: names of the regions beside a curve, seen from its start, and of the curve
    """

    points: np.ndarray
    ends: np.ndarray
    middle: np.ndarray
    is_arc: np.ndarray
    left: tuple[str, ...]
    right: tuple[str, ...]
    boundary: tuple[str, ...]


def whole_outline(machine: DrawnMachine, angle: float) -> WholeOutline:
    """The drawing of a machine with its rotor at an angle [rad]."""
    placed = [*_copies(machine.stator, machine.slots, _stator_names(machine))]
    placed += [(c.turned(angle), name) for c, name in _copies(machine.rotor, machine.repeats, _rotor_names(machine))]
    curves = list(_short(placed))
    places = np.array([(curve.start, curve.at(0.5), curve.end) for curve, _ in curves])
    points, number = merge(np.column_stack([places.ravel().real, places.ravel().imag]))
    return _with_sides(machine, points, number.reshape(-1, 3), curves)


def _copies(part: Part, pitches: int, names: _Names) -> Iterator[_Placed]:
    """Curves of all half pitches, each region's counter-clockwise, with the name of their region."""
    for region, contour in region_contours(part).items():
        for copy in range(2 * pitches):
            for curve in contour.curves:
                drawn = curve if copy % 2 else curve.part(1.0, 0.0).mirrored
                yield drawn.turned(part.first_ray + copy // 2 * part.pitch), names(region, copy)


def _stator_names(machine: DrawnMachine) -> _Names:
    def name(region: str, copy: int) -> str:
        slot = f"slot_{(copy - 1) // 2 % machine.slots}_{'R' if copy % 2 else 'L'}"
        return {"iron": "stator_iron", "copper": slot}.get(region, AIR)

    return name


def _rotor_names(machine: DrawnMachine) -> _Names:
    rotor = machine.rotor
    per_half, regions = max(1, rotor.magnets_per_pitch // 2), rotor.magnet_regions

    def name(region: str, copy: int) -> str:
        if region in regions:
            half = copy if rotor.magnets_per_pitch > 1 else copy // 2
            return f"magnet_{half * per_half + regions.index(region)}"
        return "rotor_iron" if region == "iron" else AIR

    return name


def _short(placed: list[_Placed]) -> Iterator[_Placed]:
    """Arcs in pieces of no more than a sixth of a turn."""
    for curve, name in placed:
        pieces = int(np.ceil(abs(curve.sweep) / _WIDEST)) if isinstance(curve, Arc) else 1
        for k in range(pieces):
            yield curve.part(k / pieces, (k + 1) / pieces), name


def _with_sides(machine: DrawnMachine, points: np.ndarray, number: np.ndarray, curves: list[_Placed]) -> WholeOutline:
    """Each curve once, those within one region left out."""
    sides, is_arc = _sides(number, curves)
    kept = [key for key, (left, right) in sides.items() if left != right]
    found = np.array(kept)
    left, right, boundary = zip(*(_named(machine, points[key[1]], *sides[key]) for key in kept))
    arcs = np.array([is_arc[key] for key in kept])
    return WholeOutline(points, found[:, [0, 2]], found[:, 1], arcs, left, right, boundary)


def _sides(number: np.ndarray, curves: list[_Placed]) -> tuple[dict[_Key, list[str]], dict[_Key, bool]]:
    """Regions beside every curve: its own runs along it with the region on the left, the neighbour's the other way."""
    sides: dict[_Key, list[str]] = {}
    is_arc: dict[_Key, bool] = {}
    for (start, middle, end), (curve, name) in zip(number.tolist(), curves, strict=True):
        if (end, middle, start) in sides:
            sides[end, middle, start][1] = name
        else:
            sides[start, middle, end] = [name, NOTHING]
            is_arc[start, middle, end] = isinstance(curve, Arc)
    return sides, is_arc


def _named(machine: DrawnMachine, middle: np.ndarray, left: str, right: str) -> tuple[str, str, str]:
    """A curve with nothing on its right lies at the gap, on a circle of zero potential, or bounds the model."""
    if right != NOTHING:
        return left, right, NOTHING
    radius = float(np.hypot(*middle))
    if abs(radius - machine.rotor.rim_radius) < _ON_CIRCLE:
        return left, GAP, RIM
    if abs(radius - machine.stator.rim_radius) < _ON_CIRCLE:
        return left, GAP, NOTHING
    grounded = (machine.stator.grounded_radius, machine.rotor.grounded_radius)
    zero = any(circle is not None and abs(radius - circle) < _ON_CIRCLE for circle in grounded)
    return left, NOTHING, OUTER if zero else NOTHING
