"""What rotors that are cut out of the outline of their lamination have in common."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import ClassVar

from geometry.arrangement import Face, cut_out, drawing_of, is_inside
from geometry.errors import GeometryError, in_mm
from geometry.outline import SHAFT, Curve
from geometry.parts import Angle, Length, Rim, Rotor, Share
from geometry.plane_mesh import Drawing
from units import percent


@dataclass(frozen=True)
class CutOutRotor(Rotor):
    """Iron is what an odd number of contours runs round; what is left of the round rotor is air. Lengths in m.

    outer_radius: of the whole rotor, where the gap begins; axis: of a pole, without magnets the direction of high
    permeance, in the drawing [rad]
    unequal: how far the iron of the other half pitches may differ from that of the first, which is drawn, relative
    """

    poles: int
    outline: tuple[Curve, ...]
    outer_radius: Length
    axis: Angle = 0.0
    unequal: Share = 1e-3
    of_any_sign: ClassVar[frozenset[str]] = frozenset({"axis"})

    @property
    def rim_radius(self) -> float:
        return self.outer_radius

    def check(self) -> None:
        reach = max(abs(curve.at(share)) for curve in self.drawn for share in (0.0, 0.5))
        if abs(reach - self.outer_radius) > 1e-3 * self.outer_radius:
            raise GeometryError(
                f"the outline reaches {in_mm(reach)} from the axis and outer_radius is {in_mm(self.outer_radius)}: "
                "correct outer_radius, or the unit of the drawing, which is taken for mm"
            )
        self._check_alike()

    def _check_alike(self) -> None:
        """Every half pitch has the iron of the first."""
        halves = [self._seen(self.outline, k * self.pitch / 2) for k in range(2 * self.repeats)]
        iron = [sum(face.contour.area for face in self._iron(half, half)) for half in halves]
        off = max(abs(area / iron[0] - 1) for area in iron)
        if off > self.unequal:
            raise GeometryError(
                f"half poles of the outline differ by {percent(off, 2)} of their iron: correct axis, say repeats_after "
                f"= 2 if every second pole is alike, or allow it by unequal = {off * 1.01:.3f}, which takes all to be "
                "like the one behind axis"
            )

    def draw(self, rim: Rim) -> Drawing:
        """From the first ray to half a pitch; regions iron, shaft, those of magnets, hole_0, hole_1, ..."""
        coarse = self.outer_radius * pi / self.poles / (6 * rim.across_iron)
        return drawing_of(self.faces(), rim, self.outer_radius, coarse)

    @property
    def drawn(self) -> tuple[Curve, ...]:
        """All curves of the drawing that bound a region."""
        return self.outline

    @property
    def _rays(self) -> tuple[float, ...]:
        """Axes of poles and those between, of half a pitch from the first ray on [rad]: no hole lies free of them."""
        return tuple(k * pi / self.poles for k in range(self.poles // self.repeats + 1))

    def _seen(self, curves: Sequence[Curve], angle: float = 0.0) -> list[Curve]:
        """Turned so that the ray at an angle from the first one [rad] lies on x."""
        return [curve.turned(-self.axis - self.first_ray - angle) for curve in curves]

    def is_magnet(self, face: Face) -> bool:
        """Whether a face of half a pitch, seen from the first ray, is one of its magnets."""
        return False

    def faces(self) -> dict[str, list[Face]]:
        """Those of the regions of half a pitch by their names."""
        cut = self._seen(self.drawn)
        iron = self._iron(self._seen(self.outline), cut)
        air = [face for face in cut_out(cut, self._rays, (self.outer_radius,)) if face not in iron]
        magnets = sorted((face for face in air if self.is_magnet(face)), key=lambda face: abs(face.centre))
        shaft = [face for face in air if min(abs(curve.start) for curve in face.curves) == 0]
        holes = [face for face in air if face not in shaft and face not in magnets]
        found = {"iron": iron} | ({SHAFT: shaft} if shaft else {})
        found |= {f"magnet_{k}" if k else "magnet": [face] for k, face in enumerate(magnets)}
        return found | {f"hole_{k}": [face] for k, face in enumerate(holes)}

    def _iron(self, outline: Sequence[Curve], cut: Sequence[Curve]) -> list[Face]:
        """The piece between each two rays; outline: of the lamination; cut: all curves"""
        pieces = len(self._rays) - 1
        iron = [face for face in cut_out(cut, self._rays, (self.outer_radius,)) if is_inside(outline, face.inside)]
        if len(iron) != pieces:
            raise GeometryError(
                f"half a pitch of the outline has {len(iron)} pieces of iron, expected {pieces}: correct axis or the "
                "drawing; a hole must be cut by the axis of a pole or by the one between two poles"
            )
        return iron
