"""The rotor of the SzESynRM (Toroid-project/SynRM, MIT licence) as its outline file has it, half of a pole.

The real rotor has two wide and two narrow poles; a part of a machine repeats itself from pole to pole, so there is one
drawing for each side, and the truth lies between the two machines. Fillets are corners here.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, hypot

import numpy as np

from geometry.errors import GeometryError
from geometry.parts import Length, Rim, Rotor
from geometry.plane_mesh import Drawing

Corner = tuple[float, float]
# Corners [mm]: along the axis of low permeance, and from it towards that of high permeance; the narrower side first.
CUT = (
    ((64.98, 0), (64.98, 21.31), (74.79, 34.60), (75.06, 37.73)),
    ((65.00, 0), (65.00, 27.92), (72.38, 39.36), (72.45, 42.51)),
)
BARRIERS = (
    (
        ((60.60, 0), (60.60, 22.78), (72.65, 39.11), (72.71, 40.20), (72.16, 41.15), (70.49, 41.24), (57.60, 23.77)),
        ((60.70, 0), (60.70, 29.37), (69.85, 43.55), (69.84, 44.65), (69.06, 45.83), (67.38, 45.82), (57.40, 30.35)),
    ),
    (
        ((52.10, 0), (52.10, 25.58), (67.41, 46.32), (67.41, 47.51), (66.79, 48.35), (65.18, 48.36), (49.10, 26.57)),
        ((51.90, 0), (51.90, 31.97), (64.13, 50.91), (64.05, 52.10), (63.58, 52.66), (61.98, 52.56), (49.20, 32.76)),
    ),
)
HOLE = (
    ((35.17, 35.17), (40.79, 29.54), (42.30, 29.65), (59.67, 53.19), (57.33, 55.71), (52.92, 52.92)),
    ((35.17, 35.17), (40.97, 29.37), (41.82, 29.72), (41.82, 35.35), (52.92, 52.92)),
)
COARSE, FINE = 4.0, 0.6  # mm, edges of triangles in the iron and at the ends of barriers


@dataclass(frozen=True)
class SzESynRM(Rotor):
    """side: 0, 1: of the narrower and the wider cut-out; lengths in m."""

    poles: int
    side: int
    outer_radius: Length
    shaft_radius: Length

    rim_radius = property(lambda self: self.outer_radius)
    grounded_radius = property(lambda self: self.shaft_radius)
    magnets_per_pole = property(lambda self: 0)

    def direction(self, position_angle: np.ndarray, axis: float, which: int) -> np.ndarray:
        """There are no magnets."""
        raise GeometryError("a reluctance rotor has no magnets")

    def check(self) -> None:
        if self.side not in (0, 1):
            raise GeometryError(f"side is 0 or 1, found {self.side}")

    def draw(self, rim: Rim) -> Drawing:
        """From the axis of high permeance to that of low permeance."""
        d, half = Drawing(), self.pitch / 2
        for name, angle in (("shaft", 0.0), ("shaft_low", half)):
            d.point(name, self.shaft_radius, angle, 2e-3 * COARSE)
        for name, angle in (("top", 0.0), ("top_low", half)):
            d.point(name, self.outer_radius, angle, 2 * rim.edge_length)
        hole = self._corners(d, "hole", HOLE[self.side], COARSE)
        cut = self._corners(d, "cut", CUT[self.side], 1e3 * rim.edge_length)
        barriers = [self._barrier(d, k, shape[self.side]) for k, shape in enumerate(BARRIERS)]
        open_edges = round(rim.edges * atan2(CUT[self.side][-1][1], CUT[self.side][-1][0]) / half)
        d.arc("top", cut[-1], rim.edges - open_edges)
        d.arc(cut[-1], "top_low", open_edges)
        d.arc("shaft", "shaft_low")
        d.path("shaft", *hole, "top")
        d.line(hole[0], hole[-1])
        d.path(*reversed(cut), *barriers[0], *barriers[1], "shaft_low")
        d.line("top_low", cut[0])
        for barrier in barriers:
            d.line(barrier[0], barrier[-1])
        d.region("iron", "shaft", *hole, "top", *reversed(cut), *barriers[0], *barriers[1], "shaft_low")
        d.region("cut", cut[0], *cut[1:], "top_low")
        for name, corners in (("hole", hole), ("outer", barriers[0]), ("inner", barriers[1])):
            d.region(name, *corners)
        return d

    def _barrier(self, d: Drawing, number: int, shape: tuple[Corner, ...]) -> list[str]:
        """There and back to the axis of low permeance."""
        return self._corners(d, f"barrier_{number}", (*shape, (shape[-1][0], 0.0)), FINE)

    def _corners(self, d: Drawing, name: str, shape: tuple[Corner, ...], size: float) -> list[str]:
        """Points of a shape; those near the surface have triangles of ``size`` [mm] at the most."""
        for k, (along, beside) in enumerate(shape):
            radius = min(1e-3 * hypot(along, beside), self.outer_radius)  # the last one of the cut-out lies on it
            length = size if radius > 0.9 * self.outer_radius else COARSE
            d.point(f"{name}_{k}", radius, self.pitch / 2 - atan2(beside, along), 1e-3 * length)
        return [f"{name}_{k}" for k in range(len(shape))]
