"""A rotor of one's own: a reluctance rotor whose layers hold bars of ferrite, all of them of one size."""

from dataclasses import dataclass
from math import asin, cos, hypot, sin, tan

from geometry.errors import GeometryError
from geometry.parts import Buried, Length
from geometry.plane_mesh import Drawing


@dataclass(frozen=True)
class AssistedReluctance(Buried):
    """A layer: a bar across the axis of the pole, from its ends arms of air along the axes between two poles."""

    poles: int
    layers: int
    outer_radius: Length
    shaft_radius: Length
    depth: Length  # from the axis of the machine to the innermost bar
    magnet_length: Length
    magnet_width: Length
    iron_width: Length  # between two bars
    bridge: Length  # between the arms and the gap
    magnets_per_pitch = property(lambda self: 2 * self.layers)  # halves of bars

    def direction(self, position_angle, axis, which):  # of the magnetisation: along the axis of the pole
        return 0.0 * position_angle + axis

    def faces(self, layer):  # of a bar, on the axis of the pole; layer 0 is the outermost
        inner = self.depth + (self.layers - 1 - layer) * (self.magnet_length + self.iron_width)
        return inner, inner + self.magnet_length

    def check(self):
        if self.depth < max(self.shaft_radius, self.magnet_width / 2 / tan(self.pitch / 2)):
            raise GeometryError("the innermost layer meets the shaft or its neighbours: enlarge depth")
        if hypot(self.faces(0)[1], self.magnet_width / 2) > self.outer_radius - self.bridge:
            raise GeometryError("the outermost bar reaches the bridge: reduce layers, depth or magnet_width")

    def draw(self, rim):  # from the axis of pole 0 to half a pitch
        d, size, around = Drawing(), self.iron_width / rim.across_iron, ["shaft"]
        for name, radius, edges in (("shaft", self.shaft_radius, None), ("top", self.outer_radius, rim.edges)):
            d.arc(d.point(name, radius, 0, size), d.point(f"{name}_low", radius, self.pitch / 2, size), edges)
        for k in reversed(range(self.layers)):
            (a, b, c), (f, e, g) = (self.side(d, f"{side}_{k}", x, size) for side, x in enumerate(self.faces(k)))
            d.path(around[-1], a, f, e, b)
            d.arc(c, g)
            d.region(f"magnet_{k}" if k else "magnet", a, f, e, b)
            d.region(f"hole_{k}", b, e, g, c)
            around += [a, b, c, g, e, f]
        d.path(around[-1], "top")
        d.path("shaft_low", "top_low")
        d.region("iron", *around, "top", "top_low", "shaft_low")
        return d

    def side(self, d, name, x, size):  # of a layer: along the face of its bar and on to the bridge
        w, r, thin = self.magnet_width / 2, self.outer_radius - self.bridge, self.bridge / 3
        end = self.pitch / 2 - asin((x * sin(self.pitch / 2) - w * cos(self.pitch / 2)) / r)
        names = d.place(name, x, 0, size), d.place(f"{name}_corner", x, w, size), d.point(f"{name}_end", r, end, thin)
        d.path(*names)
        return names
