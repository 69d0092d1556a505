"""Which degrees of freedom are free, and how the others follow from them.

    outer boundary      a = 0 (no flux leaves the stator)
    end of the sector   a = +-a(start), minus in an antiperiodic sector
    rotor side of the sliding circle: a = the stator node it has been turned to
Every degree of freedom therefore is plus or minus one free unknown, or zero: two index arrays, no matrix. The numbering
of the free unknowns is the same at every angle; only the rotor side of the sliding circle looks up other ones.

The rotor turns by whole edges of the sliding circle. The rest of the angle, at most half an edge, shears the structured
gap layers on the rotor side, which stay conforming: ``Turn`` holds both parts.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from geometry.cross_section import CrossSection
from magnetostatics.elements import LINEAR, TriangleOrder, dof_locations

_SIDES = "start", "end"


@dataclass(frozen=True)
class Turn:
    """A rotor angle as whole edges of the sliding circle and the rest [rad], at most half an edge either way."""

    edges: int
    rest: float


@dataclass(frozen=True, eq=False)
class Unknowns:
    """column (n,), an index of the unknowns, and sign (n,), dimensionless, of every degree of freedom with the rotor at
    angle zero; sign 0 means a = 0."""

    column: np.ndarray
    sign: np.ndarray
    count: int
    free_dofs: np.ndarray  # index of the degree of freedom of every free unknown, (count,)
    stator_slide: np.ndarray  # indices (k,) in the order of angle, without the end of the sector
    rotor_slide: np.ndarray  # indices (k + 1,) in the order of angle, with the end of the sector; (k,) for a whole one
    edge_angle: float  # of one edge of the sliding circle [rad]
    offset: float  # rotor start angle minus stator start angle at rotor angle zero [rad]
    sector_sign: int
    steps_per_edge: int  # degrees of freedom along one edge of the sliding circle

    def turn(self, angle: float) -> Turn:
        """Split a rotor angle [rad] into whole edges and a rest."""
        edges = round((angle + self.offset) / self.edge_angle)
        rest = angle + self.offset - edges * self.edge_angle
        return Turn(edges, rest if abs(rest) > 1e-9 * self.edge_angle else 0.0)

    def turned(self, edges: int) -> tuple[np.ndarray, np.ndarray]:
        """(column, sign), index and dimensionless, (n,) each, with the rotor turned by whole edges."""
        position = self.steps_per_edge * edges + np.arange(len(self.rotor_slide))
        sectors_passed, index = np.divmod(position, len(self.stator_slide))
        column, sign = self.column.copy(), self.sign.copy()
        column[self.rotor_slide] = self.column[self.stator_slide[index]]
        sign[self.rotor_slide] = np.where(sectors_passed % 2, self.sector_sign, 1)
        return column, sign


def number_unknowns(section: CrossSection, order: TriangleOrder) -> Unknowns:
    """Number the free unknowns of a meshed cross-section; those of nodes come first, so orders share their numbers."""
    locations = dof_locations(section.mesh, order)
    steps_per_edge = 1 if order is LINEAR else 2
    rotor = section.machine.rotor
    starts = -section.machine.slot_pitch / 2, rotor.first_ray - rotor.pitch / 2
    stator_slide = _around(section, locations, "stator_slide", starts[0])
    rotor_slide = _around(section, locations, "rotor_slide", starts[1])
    sign, master = np.ones(locations.shape[1]), np.arange(locations.shape[1])
    for start, end in _ray_pairs(section, locations):
        master[end], sign[end] = start, section.sign
    sign[_on(section, "outer", locations)] = 0.0
    if section.sign < 0:
        sign[np.hypot(*locations) < 1e-12] = 0.0  # the centre would have to equal its own negative
    is_free = (master == np.arange(len(master))) & (sign != 0)
    is_free[rotor_slide] = False
    number = np.cumsum(is_free) - 1
    sign = np.where(sign[master] == 0, 0.0, sign)
    masters = stator_slide[:-1] if section.sectors > 1 else stator_slide
    return Unknowns(
        column=np.where(is_free[master], number[master], 0),
        sign=sign,
        count=int(is_free.sum()),
        free_dofs=np.flatnonzero(is_free),
        stator_slide=masters,
        rotor_slide=rotor_slide,
        edge_angle=2 * pi * steps_per_edge / section.sectors / len(masters),
        offset=starts[1] - starts[0],
        sector_sign=section.sign,
        steps_per_edge=steps_per_edge,
    )


def _on(section: CrossSection, name: str, locations: np.ndarray) -> np.ndarray:
    """Degrees of freedom on a named boundary: its nodes and, where the edges carry some, its edges."""
    edges, nodes = section.mesh.boundaries[name], section.mesh.p.shape[1]
    is_on = np.zeros(nodes, dtype=bool)
    is_on[section.mesh.facets[:, edges]] = True
    on_nodes = np.flatnonzero(is_on)
    return on_nodes if locations.shape[1] == nodes else np.concatenate([on_nodes, nodes + edges])


def _around(section: CrossSection, locations: np.ndarray, name: str, start: float) -> np.ndarray:
    """Degrees of freedom on a circle in the order of angle, from the start of its sector [rad]."""
    dofs = _on(section, name, locations)
    x, y = locations[:, dofs]
    angle = np.mod(np.arctan2(y, x) - start + 1e-9, 2 * pi)
    return dofs[np.argsort(angle)]


def _ray_pairs(section: CrossSection, locations: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """(start, end) degrees of freedom of the periodic rays of stator and rotor, both in the order of radius."""
    if section.sectors == 1:
        return []
    ends = [[_outwards(section, locations, f"{piece}_{side}") for side in _SIDES] for piece in ("stator", "rotor")]
    return [(start, end) for start, end in ends]


def _outwards(section: CrossSection, locations: np.ndarray, name: str) -> np.ndarray:
    """Degrees of freedom on a ray in the order of radius."""
    dofs = _on(section, name, locations)
    return dofs[np.argsort(np.hypot(*locations[:, dofs]), kind="stable")]
