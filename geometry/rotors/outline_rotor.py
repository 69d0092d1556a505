"""A rotor inside its stator without magnets, cut out of the outline of its lamination."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from geometry.arrangement import Face, cut_out, drawing_of, is_inside
from geometry.errors import GeometryError, in_mm
from geometry.outline import SHAFT, Curve
from geometry.parts import Angle, Length, Rim, Share, WithoutMagnets
from geometry.plane_mesh import Drawing


@dataclass(frozen=True)
class OutlineRotor(WithoutMagnets):
    """Iron is what an odd number of contours runs round; what is left of the round rotor is air. Lengths in m.

    outer_radius: of the whole rotor, where the gap begins; axis: of a pole, the direction of high permeance, in the
    drawing [rad]; all poles are drawn like the half pole that follows it
    unequal: how far the iron of the other half poles may differ from it, relative
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
        reach = max(abs(curve.at(share)) for curve in self.outline for share in (0.0, 0.5))
        if abs(reach - self.outer_radius) > 1e-3 * self.outer_radius:
            raise GeometryError(
                f"the outline reaches {in_mm(reach)} from the axis and outer_radius is {in_mm(self.outer_radius)}: "
                "correct outer_radius, or the unit of the drawing, which is taken for mm"
            )
        self._check_alike()

    def _check_alike(self) -> None:
        """Every half pole has the iron of the first."""
        halves = [[one.turned(-self.axis - k * self.pitch / 2) for one in self.outline] for k in range(2 * self.poles)]
        iron = [_iron(half, self.pitch / 2, self.outer_radius).contour.area for half in halves]
        off = max(abs(area / iron[0] - 1) for area in iron)
        if off > self.unequal:
            raise GeometryError(
                f"half poles of the outline differ by {off:.2%} of their iron: correct axis, or allow it by unequal = "
                f"{off * 1.01:.3f}, where all are taken to be like the one behind axis"
            )

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of pole 0 to half a pole pitch; regions iron, shaft, hole_0, hole_1, ..."""
        half = self.pitch / 2
        return drawing_of(self._faces(), rim, self.outer_radius, self.outer_radius * half / (6 * rim.across_iron))

    def _faces(self) -> dict[str, Face]:
        turned = [curve.turned(-self.axis) for curve in self.outline]
        iron = _iron(turned, self.pitch / 2, self.outer_radius)
        air = [face for face in cut_out(turned, self.pitch / 2, (self.outer_radius,)) if face != iron]
        shaft = [face for face in air if min(abs(curve.start) for curve in face.curves) == 0]
        holes = [face for face in air if face not in shaft]
        return {"iron": iron} | dict(zip((SHAFT,), shaft)) | {f"hole_{k}": one for k, one in enumerate(holes)}


def _iron(outline: Sequence[Curve], half: float, radius: float) -> Face:
    """Of half a pole from the ray at 0 on; half [rad], radius of the rim [m]."""
    iron = [face for face in cut_out(outline, half, (radius,)) if is_inside(outline, face.inside)]
    if len(iron) != 1:
        raise GeometryError(
            f"half a pole of the outline has {len(iron)} pieces of iron where one is expected: correct axis or the "
            "drawing; a hole must be cut by the axis of a pole or by the one between two poles"
        )
    return iron[0]
