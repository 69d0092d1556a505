"""Half a V of buried magnets: the hole from the axis of a pole, or from a rib of iron on it, to the bridge under the
surface, its magnet in it."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from geometry.errors import GeometryError, in_mm
from geometry.parts import Buried, Rim, Segment, radial
from geometry.plane_mesh import Drawing

_ACROSS_BRIDGE = 3  # elements across the thinnest iron, which saturates hard
_ACROSS_HALF_A_RIB = 2  # elements across the half that is drawn


@dataclass(frozen=True)
class VLayer:
    """The holes of a pole meet on its axis, so that no iron stands between them.

    name: what its dimensions begin with, empty where there is one layer
    surface: radius over the bridge [m]
    tip_depth: of the V, from the axis of the machine to where the outer faces of the two magnets meet [m]
    tilt: of the magnets' outer faces against the axis of the pole [rad]
    magnet_length: along the magnetisation [m]; magnet_width: across it [m]
    recess: by which a magnet is sunk into the iron under it [m]
    hole_depth: from the axis of the machine to where the inner sides of the two holes meet [m]
    bridge: iron between hole and surface [m]
    bridge_start, bridge_end: angles of the outer end of the hole, from the axis of the pole [rad]
    """

    name: str
    surface: float
    tip_depth: float
    tilt: float
    magnet_length: float
    magnet_width: float
    recess: float
    hole_depth: float
    bridge: float
    bridge_start: float
    bridge_end: float

    def across(self, which: int) -> float:
        """Direction of the magnetisation from the axis of the pole on [rad]; which: 0 is the clockwise magnet."""
        across = pi / 2 - self.tilt
        return across if which == 0 else -across

    def corner(self, along: float, down: float) -> complex:
        """Point x + jy [m]. along: the outer face of the magnet from its inner end on [m]; down: from the face [m]"""
        face = np.exp(1j * self.tilt)
        return complex(self.tip_depth + along * face + down * 1j * face)

    @property
    def probes(self) -> dict[str, Segment]:
        """Across the bridge in its middle [m], by name."""
        middle = (self.bridge_start + self.bridge_end) / 2
        return {self.name + "bridge": radial(self.surface - self.bridge, self.surface, middle)}

    @property
    def inwards(self) -> str:
        """What brings the magnets nearer to the axis when it is reduced, in words."""
        return f"or {self.name}tip_depth"

    def check(self, half: float, floor: float, floor_name: str) -> None:
        """Raise GeometryError where it does not fit into half a pole [rad] above a radius or depth ``floor`` [m]."""
        n = self.name
        if not 0 < self.bridge_start < self.bridge_end < half:
            raise GeometryError(
                f"{n}bridge_start and {n}bridge_end must rise within half a pole of {half:.4f} rad, found "
                f"{self.bridge_start:.4f} and {self.bridge_end:.4f}"
            )
        end = abs(self.corner(self.magnet_width, 0.0))
        if end >= self.surface - self.bridge:
            raise GeometryError(
                f"the magnets reach {in_mm(end)} from the axis, into the bridge at "
                f"{in_mm(self.surface - self.bridge)}: reduce {n}magnet_width, {self.inwards}, or enlarge outer_radius"
            )
        if not floor < self.hole_depth < self.tip_depth:
            raise GeometryError(
                f"{floor_name}, {n}hole_depth and {n}tip_depth must rise from each to the next, found "
                f"{in_mm(floor)}, {in_mm(self.hole_depth)} and {in_mm(self.tip_depth)}"
            )

    def draw_points(self, d: Drawing, iron: float) -> None:
        """Corners of magnet and hole; iron: edge length at the magnet [m]."""
        width, length = self.magnet_width, self.magnet_length
        corners = {
            "tip": (0.0, 0.0), "face_end": (width, 0.0),
            "inner_start": (0.0, length), "inner_end": (width, length),
            "inner_shoulder": (0.0, length - self.recess), "outer_shoulder": (width, length - self.recess),
        }  # fmt: skip
        for name, (along, down) in corners.items():
            corner = self.corner(along, down)
            d.place(self.name + name, corner.real, corner.imag, iron)
        for name, angle in (("bridge_start", self.bridge_start), ("bridge_end", self.bridge_end)):
            d.point(self.name + name, self.surface - self.bridge, angle, self.bridge / _ACROSS_BRIDGE)
        d.point(self.name + "hole", self.hole_depth, 0, iron)

    def draw_curves(self, d: Drawing) -> None:
        """Round the magnet and from the axis of the pole to the bridge."""
        d.path(*self._named("tip", "face_end", "outer_shoulder", "inner_end", "inner_start", "inner_shoulder", "tip"))
        d.path(*self._named("hole", "inner_shoulder"))
        d.path(*self._named("face_end", "bridge_start"))
        d.arc(self.name + "bridge_start", self.name + "bridge_end")
        d.path(*self._named("bridge_end", "outer_shoulder"))

    def draw_regions(self, d: Drawing, magnet: str) -> None:
        """The magnet, named so, and the two ends of the hole."""
        shoulders = ("outer_shoulder", "inner_end", "inner_start", "inner_shoulder")
        d.region(magnet, *self._named("tip", "face_end", *shoulders))
        d.region(self.name + "hole_inside", *self._named("hole", "tip", "inner_shoulder"))
        d.region(self.name + "hole_outside", *self._named("face_end", "bridge_start", "bridge_end", "outer_shoulder"))

    @property
    def outline(self) -> tuple[str, ...]:
        """Names of its points as the iron meets them, from the axis of the pole under it and back over it."""
        under = ("inner_shoulder", "inner_start", "inner_end", "outer_shoulder")
        return self._named("hole", *under, "bridge_end", "bridge_start", "face_end", "tip")

    @property
    def on_axis(self) -> tuple[str, ...]:
        """Names of its points on the axis of the pole, outwards."""
        return self._named("hole", "tip")

    def _named(self, *points: str) -> tuple[str, ...]:
        return tuple(self.name + point for point in points)


@dataclass(frozen=True)
class RibbedVLayer(VLayer):
    """The same with a rib of iron on the axis of the pole: either half stands off it by half of the rib.

    rib: of iron between the two holes of a pole [m]
    """

    rib: float

    def corner(self, along: float, down: float) -> complex:
        """Point x + jy [m]. along: the outer face of the magnet from its inner end on [m]; down: from the face [m]"""
        return super().corner(along, down) + 1j * self.rib / 2

    @property
    def inwards(self) -> str:
        return f"{super().inwards} or {self.name}rib"

    @property
    def probes(self) -> dict[str, Segment]:
        """Across bridge and rib in their middles [m], by name."""
        middle, half = (self.hole_depth + self.tip_depth) / 2, self.rib / 2
        return super().probes | {self.name + "rib": ((middle, -half), (middle, half))}

    def draw_points(self, d: Drawing, iron: float) -> None:
        """Corners of rib, magnet and hole; iron: edge length at the magnet [m]."""
        super().draw_points(d, iron)
        size = min(iron, self.rib / 2 / _ACROSS_HALF_A_RIB)
        for name, depth in (("hole", self.hole_depth), ("tip", self.tip_depth)):
            d.place(self.name + name, depth, self.rib / 2, size)
            d.place(f"{self.name}rib_{name}", depth, 0.0, size)

    def draw_curves(self, d: Drawing) -> None:
        """Round the magnet, from the rib to the bridge, and between the rib and the iron over and under it."""
        super().draw_curves(d)
        d.path(*self._named("rib_hole", "hole", "tip", "rib_tip"))

    def draw_regions(self, d: Drawing, magnet: str) -> None:
        """The magnet, named so, the two ends of the hole, and the rib, which is iron."""
        super().draw_regions(d, magnet)
        d.region("iron", *self._named("rib_hole", "hole", "tip", "rib_tip"))

    @property
    def outline(self) -> tuple[str, ...]:
        """Names of its points as the iron around the rib meets them, from the axis of the pole and back over it."""
        return (*self._named("rib_hole"), *super().outline, *self._named("rib_tip"))

    @property
    def on_axis(self) -> tuple[str, ...]:
        """Names of its points on the axis of the pole, outwards."""
        return self._named("rib_hole", "rib_tip")


def draw_buried(rotor: Buried, layers: tuple[VLayer, ...], magnet_length: float, rim: Rim) -> Drawing:
    """Half a pole with layers of magnets of one thickness [m], the innermost first; regions iron, those of the magnets
    and the ends of the holes."""
    d, iron = Drawing(), magnet_length / rim.across_iron
    for layer in layers:
        layer.draw_points(d, iron)
    ends = {"top": (rotor.outer_radius, 2 * rim.edge_length), "shaft": (rotor.shaft_radius, 1.5 * iron)}
    for name, (radius, size) in ends.items():
        d.point(name, radius, 0, size)
        d.point(f"{name}_pole", radius, rotor.pitch / 2, size)
    d.path("shaft", *(name for layer in layers for name in layer.on_axis), "top")
    d.arc("top", "top_pole", rim.edges)
    d.line("top_pole", "shaft_pole")
    d.arc("shaft", "shaft_pole")
    d.region("iron", "shaft", *(name for layer in layers for name in layer.outline), "top", "top_pole", "shaft_pole")
    for layer, magnet in zip(layers, rotor.magnet_regions, strict=True):
        layer.draw_curves(d)
        layer.draw_regions(d, magnet)
    return d
