"""A stator around its rotor, cut out of the outline of its lamination."""

from __future__ import annotations

from cmath import phase, rect
from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import ClassVar

from geometry.arrangement import Face, cut_out, drawing_of, places_on, touches
from geometry.errors import GeometryError
from geometry.outline import Curve
from geometry.parts import Angle, Length, Rim, Segment, StatorRoundRotor
from geometry.plane_mesh import Drawing


@dataclass(frozen=True)
class OutlineStator(StatorRoundRotor):
    """The slots of a drawing in a round stack; a slot must be closed towards its opening by a line. Lengths in m.

    Copper fills the slot behind that line. axis: of a tooth in the drawing [rad]; the lamination must be its own mirror
    image there and at the middle of the next slot.
    """

    slots: int
    outline: tuple[Curve, ...]
    bore_radius: Length
    outer_radius: Length
    axis: Angle = 0.0
    of_any_sign: ClassVar[frozenset[str]] = frozenset({"axis"})

    @property
    def slot_radii(self) -> tuple[float, float]:
        """Along the axis of a slot [m]."""
        places, middle = [one.start for one in self._faces["copper"].curves], pi / self.slots
        on_axis = [abs(place) for place in places if abs(phase(place) - middle) < 1e-6]
        return min(on_axis), max(on_axis)

    @property
    def tooth_probe(self) -> Segment:
        """At mid height of the slot [m]."""
        radius = sum(self.slot_radii) / 2
        angle = min(phase(place) for place in places_on(self._faces["copper"], radius))
        corner = rect(radius, angle)
        return (corner.real, -corner.imag), (corner.real, corner.imag)

    @property
    def back_iron_probe(self) -> Segment:
        """Radially [m]."""
        return (self.slot_radii[1], 0.0), (self.outer_radius, 0.0)

    def check(self) -> None:
        if not 0 < self.bore_radius < self.outer_radius:
            raise GeometryError("bore_radius must be smaller than outer_radius")
        assert self._faces

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of tooth 0 to the centre of slot 0; regions iron, copper, opening, ..."""
        (_, low), (_, high) = self.tooth_probe
        regions = {name: [face] for name, face in self._faces.items()}
        return drawing_of(regions, rim, self.bore_radius, (high - low) / rim.across_iron)

    @cached_property
    def _faces(self) -> dict[str, Face]:
        turned = [curve.turned(-self.axis) for curve in self.outline]
        faces = cut_out(turned, (0.0, pi / self.slots), (self.bore_radius, self.outer_radius))
        ring = [face for face in faces if min(abs(curve.at(0.5)) for curve in face.curves) > self.bore_radius / 2]
        iron = [face for face in ring if touches(face, self.outer_radius)]
        air = [face for face in ring if face not in iron]
        opening = [face for face in air if touches(face, self.bore_radius)]
        copper = [face for face in air if face not in opening]
        if len(iron) != 1 or len(copper) != 1:
            raise GeometryError(
                f"half a slot pitch of the outline has {len(iron)} pieces of iron and {len(copper)} of copper where "
                "one of each is expected: close every slot towards its opening by a line, leave out other lines (name "
                "the layer), or correct axis"
            )
        return {"iron": iron[0], "copper": copper[0]} | dict(zip(("opening", "opening_1"), opening))
