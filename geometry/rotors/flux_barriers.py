"""A reluctance rotor inside its stator: round layers of air in the iron, without magnets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import acos, cos, sin

from geometry.chords import with_short_chords
from geometry.errors import GeometryError, in_mm
from geometry.parts import Buried, Length, Rim, Segment, WithoutMagnets, radial
from geometry.plane_mesh import Drawing

_ACROSS_BRIDGE = 3  # elements across the thinnest iron, which saturates hard


@dataclass(frozen=True)
class FluxBarriers(WithoutMagnets, Buried):
    """Barriers of equal width between layers of iron of equal width, all of them arcs about a point on the axis of low
    permeance, between two poles. They end at the bridges under the surface. Lengths in m.

    poles: their axes are those of high permeance; layers: number of barriers between two of them
    centre_distance: of the arcs' centre, from the axis of the machine
    first_radius: of the outermost barrier's outer face, about that centre
    barrier_width, iron_width: of the air and of the iron between two barriers; bridge: iron between air and surface
    """

    poles: int
    layers: int
    outer_radius: Length
    shaft_radius: Length
    centre_distance: Length
    first_radius: Length
    barrier_width: Length
    iron_width: Length
    bridge: Length

    @property
    def probes(self) -> Mapping[str, Segment]:
        """Across the bridge at the end of every barrier, the outermost first."""
        return {f"layer_{layer}_bridge": self._across_bridge(layer) for layer in range(self.layers)}

    def _across_bridge(self, layer: int) -> Segment:
        outer, inner = (self._end_angle(radius) for radius in self._radii(layer))
        return radial(self._end_radius, self.outer_radius, (outer + inner) / 2)

    def check(self) -> None:
        last = self._radii(self.layers - 1)[1]
        if self.centre_distance - last <= self.shaft_radius:
            raise GeometryError(
                f"the innermost barrier comes to {in_mm(self.centre_distance - last)} from the axis, into the shaft of "
                f"{in_mm(self.shaft_radius)}: reduce layers, barrier_width, iron_width or first_radius"
            )
        if not abs(self.centre_distance - self._end_radius) < self.first_radius:
            raise GeometryError(
                f"the outermost barrier does not reach the bridge: enlarge first_radius ({in_mm(self.first_radius)})"
            )
        if self._end_angle(last) <= 0:
            raise GeometryError(
                "the innermost barriers of neighbouring poles meet: reduce layers, barrier_width, iron_width or "
                "first_radius"
            )

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of pole 0 to the axis of low permeance; regions iron, hole_0, hole_1, ... from the outside."""
        d = Drawing()
        self._frame(d, rim)
        outline = ["shaft", "top", "top_low"]
        for layer in range(self.layers):
            self._barrier(d, rim, layer)
            outline += [f"outer_{layer}", f"outer_end_{layer}", f"inner_end_{layer}", f"inner_{layer}"]
            d.line("top_low" if layer == 0 else f"inner_{layer - 1}", f"outer_{layer}")
        d.line(f"inner_{self.layers - 1}", "shaft_low")
        d.region("iron", *outline, "shaft_low")
        return with_short_chords(d, rim.edge_length)

    def _frame(self, d: Drawing, rim: Rim) -> None:
        half, inside = self.pitch / 2, 2 * self.iron_width / rim.across_iron
        for name, angle in (("", 0.0), ("_low", half)):
            d.point(f"shaft{name}", self.shaft_radius, angle, inside)
            d.point(f"top{name}", self.outer_radius, angle, 2 * rim.edge_length)
        d.line("shaft", "top")
        d.arc("shaft", "shaft_low")
        d.arc("top", "top_low", rim.edges)

    def _barrier(self, d: Drawing, rim: Rim, layer: int) -> None:
        half, size, thin = self.pitch / 2, self.iron_width / rim.across_iron, self.bridge / _ACROSS_BRIDGE
        centre = (self.centre_distance * cos(half), self.centre_distance * sin(half))
        for face, radius in zip(("outer", "inner"), self._radii(layer), strict=True):
            d.point(f"{face}_{layer}", self.centre_distance - radius, half, size)
            d.point(f"{face}_end_{layer}", self._end_radius, self._end_angle(radius), min(thin, size))
            d.arc(f"{face}_{layer}", f"{face}_end_{layer}", centre=centre)
        names = (f"outer_{layer}", f"outer_end_{layer}", f"inner_end_{layer}", f"inner_{layer}")
        d.arc(names[1], names[2])
        d.line(names[3], names[0])
        d.region(f"hole_{layer}", *names)

    def _radii(self, layer: int) -> tuple[float, float]:
        """Of the outer and the inner face of a barrier about the centre [m]."""
        outer = self.first_radius + layer * (self.barrier_width + self.iron_width)
        return outer, outer + self.barrier_width

    @property
    def _end_radius(self) -> float:
        """Where the barriers end, about the axis of the machine [m]."""
        return self.outer_radius - self.bridge

    def _end_angle(self, radius: float) -> float:
        """Angle from the axis of the pole at which a face ends [rad]; its radius is about the centre [m]."""
        a, b = self.centre_distance, self._end_radius
        return self.pitch / 2 - acos(min(1.0, max(-1.0, (a * a + b * b - radius * radius) / (2 * a * b))))
