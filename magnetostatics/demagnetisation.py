"""How far the magnets are driven down: flux density along the magnetisation, and the share of them under a knee.

    b = B . m        m: unit vector of the magnetisation

on the straight recoil line. Where b falls under the knee of the grade the magnet loses remanence for good. That it
changes there is not fed back into the field: the standard first check, exact up to the knee.

Balanced currents in step with the rotor show every magnet the same, one after another. So the smallest b over the
magnets of a sector and 60 electrical degrees is that of one magnet over a whole turn; where not all magnets of a sector
see the same, it is the smallest of any.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from magnetostatics.model import FieldModel, FieldSolution


@dataclass(frozen=True, eq=False)
class MagnetFlux:
    """Flux density along the magnetisation, in one magnet after another.

    values: [T], (M, Q, E): at the Q quadrature points of the E elements of M magnets, each magnet listed as the one
        before it; areas: that belong to the points of one of them [m^2], (Q, E)
    """

    values: np.ndarray
    areas: np.ndarray

    @property
    def smallest(self) -> np.ndarray:
        """Of all magnets, at each point of one [T], (Q, E)."""
        return self.values.min(axis=0)

    @property
    def least(self) -> float:
        """The smallest of all [T]."""
        return float(self.values.min())

    def share_below(self, knee: float) -> float:
        """Share of the magnets' volume in which it is below the knee [T]."""
        return float((self.areas * (self.values < knee)).sum() / (len(self.values) * self.areas.sum()))

    def exceeded(self, share: float) -> float:
        """Flux density [T] that all but this share of the volume exceeds."""
        order = np.argsort(self.values, axis=None)
        below = np.cumsum(np.broadcast_to(self.areas, self.values.shape).ravel()[order])
        return float(self.values.ravel()[order][np.searchsorted(below, share * below[-1])])


def magnet_flux(solution: FieldSolution) -> MagnetFlux:
    """Flux density along the magnetisation in the magnets of the sector."""
    model = solution.model
    values = [_along(model, number, solution.a) for number in range(model.section.magnets)]
    return MagnetFlux(np.stack(values), model.magnet_elements(0).weights)


def _along(model: FieldModel, number: int, a: np.ndarray) -> np.ndarray:
    """B . m (Q, E) with B = (dA/dy, -dA/dx)."""
    dx, dy = model.magnet_elements(number).gradient(a)
    x, y = model.magnetisation(number)
    return x * dy - y * dx


@dataclass(frozen=True, eq=False)
class MagnetMap:
    """Flux density along the magnetisation, ready to be drawn.

    corners: of the elements [m], (2, 3, E); flux: along the magnetisation in the corners [T], (3, E), linear between
    """

    corners: np.ndarray
    flux: np.ndarray

    def turned(self, angle: float) -> MagnetMap:
        """The same turned about the axis by an angle [rad]."""
        (x, y), (c, s) = self.corners, (np.cos(angle), np.sin(angle))
        return MagnetMap(np.stack([c * x - s * y, s * x + c * y]), self.flux)


def magnet_map(model: FieldModel, seen: MagnetFlux, angle: float) -> MagnetMap:
    """The magnets of the sector, or the first alone, with the rotor turned to an angle [rad]."""
    regions = [model.topology.regions[f"magnet_{number}"] for number in range(len(seen.values))]
    mesh = model.section.mesh
    corners = mesh.p[:, mesh.t[:, np.concatenate(regions)]]
    return MagnetMap(corners, np.hstack([_in_corners(model, one) for one in seen.values])).turned(angle)


def _in_corners(model: FieldModel, values: np.ndarray) -> np.ndarray:
    """Values (3, E) in the corners of what is linear in an element and known at its three quadrature points (3, E)."""
    x, y = model.order.points
    return np.linalg.solve(np.stack([1 - x - y, x, y], axis=1), values)
