"""What is not as drawn in one machine: eccentricity, magnets out of place, a slot or a tooth of another width.

Each moves nodes of the mesh of the whole machine (``Morpher.to``), smoothly in its amount and by nothing at zero. The
sliding circle stays where it is, a circle about the axis of rotation with equal edges, so the rotor turns as before.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, sin

import numpy as np

from geometry.cross_section import Assembly, CrossSection
from geometry.errors import GeometryError
from geometry.gap import GapHalf
from geometry.machine import Machine, dimensions_of
from geometry.morph import Defect, Morpher
from units import MILLIMETRE


def deformed(section: CrossSection, *defects: Defect) -> CrossSection:
    """A meshed whole machine with defects; see ``Morpher.to``, which also changes the machine."""
    return Morpher(section).to(section.machine, defects)


@dataclass(frozen=True)
class Eccentricity(Defect):
    """Stator or rotor stands beside the axis of rotation; the concrete ones are below.

    All of that part moves, its half of the gap stretches on one side and shrinks on the other.
    Valid up to nearly half of the air gap; of both kinds together each.

    amplitude: [m]; direction: in which the part is shifted, in its own coordinates [rad]
    """

    amplitude: float
    direction: float = 0.0

    @property
    def vector(self) -> np.ndarray:
        """Shift (2,) [m]."""
        return self.amplitude * np.array([cos(self.direction), sin(self.direction)])

    def _moves(self, section: CrossSection, gap: GapHalf, part: slice) -> np.ndarray:
        if abs(self.amplitude) >= abs(gap.depth):
            raise GeometryError(
                f"an eccentricity of {self.amplitude / MILLIMETRE:.4f} mm needs more than the half of the air gap that "
                f"can give way, {abs(gap.depth) / MILLIMETRE:.4f} mm: take less"
            )
        moves = np.zeros_like(section.mesh.p)
        moves[:, part] = self.vector[:, None] * np.clip(gap.height(section.mesh.p[:, part]), 0.0, 1.0)
        return moves


@dataclass(frozen=True)
class StaticEccentricity(Eccentricity):
    """The stator stands beside the axis of rotation; the narrowest gap stays, opposite to where the stator has gone.

    g(phi) = g + amplitude cos(phi - direction)
    """

    def moves(self, morpher: Morpher, section: CrossSection) -> np.ndarray:
        """Moves of the nodes [m], (2, n)."""
        return self._moves(section, section.stator_gap, slice(0, first_rotor_node(section)))

    def assemble(self, assembly: Assembly) -> Assembly:
        return replace(assembly, stator_centre=_sum(assembly.stator_centre, self.vector))


@dataclass(frozen=True)
class DynamicEccentricity(Eccentricity):
    """The rotor stands beside the axis that it turns about; the narrowest gap turns with it.

    g(phi) = g - amplitude cos(phi - direction - theta), the direction counted from the axis of magnet 0
    """

    def moves(self, morpher: Morpher, section: CrossSection) -> np.ndarray:
        """Moves of the nodes [m], (2, n)."""
        return self._moves(section, section.rotor_gap, slice(first_rotor_node(section), None))

    def assemble(self, assembly: Assembly) -> Assembly:
        return replace(assembly, rotor_centre=_sum(assembly.rotor_centre, self.vector))


@dataclass(frozen=True)
class MagnetPosition(Defect):
    """One magnet sits too far on, counter-clockwise, and its magnetisation has turned with it.

    Between the magnets the gap to the neighbour ahead narrows and that behind widens. Where the magnets touch
    (``magnet_arc_fraction`` 1) a joint lies midway between the two edges that meet there: those of the magnet move by
    half the angle, its magnetisation turns by the whole. The same error of all magnets turns the rotor in both cases.
    """

    number: int
    angle: float  # [rad], about the rotor's centre

    def moves(self, morpher: Morpher, section: CrossSection) -> np.ndarray:
        """Moves of the nodes [m], (2, n)."""
        return _turn_rotor(section, self.number, self.angle, self.angle)

    def assemble(self, assembly: Assembly) -> Assembly:
        return replace(assembly, magnet_turns=assembly.magnet_turns + ((self.number, self.angle),))


@dataclass(frozen=True)
class MagnetArc(Defect):
    """One magnet covers a larger angle than drawn, half of it on either side; its magnetisation stays.

    Where the magnets touch, their joint lies midway between the two edges that meet there, and moves by half as much.
    """

    number: int
    change: float  # of the whole arc [rad]

    def moves(self, morpher: Morpher, section: CrossSection) -> np.ndarray:
        """Moves of the nodes [m], (2, n)."""
        return _turn_rotor(section, self.number, -self.change / 2, self.change / 2)


@dataclass(frozen=True)
class SlotOpening(Defect):
    """One slot opens wider to the gap than the others: both shoes beside it are shorter."""

    slot: int  # between tooth ``slot`` and the next
    change: float  # of the opening width [m]

    def moves(self, morpher: Morpher, section: CrossSection) -> np.ndarray:
        """Moves of the nodes [m], (2, n)."""
        m = dimensions_of(section.machine)
        wanted = m.opening_width + self.change
        if wanted >= m.slot_pitch * m.stator_inner_radius - m.tooth_width:
            raise GeometryError(
                f"slot {self.slot} cannot open to {wanted / MILLIMETRE:.3f} mm, it would cut into the teeth: take less"
            )
        _check_number("slot", self.slot, m.slots)
        machine = replace(m, slot_opening=wanted)
        return morpher.copies_moved(machine, section, (2 * self.slot + 1, 2 * self.slot + 2))


@dataclass(frozen=True)
class ToothWidth(Defect):
    """One tooth is wider than the others, behind the shoe; the slots beside it are narrower."""

    tooth: int
    change: float  # [m]

    def moves(self, morpher: Morpher, section: CrossSection) -> np.ndarray:
        """Moves of the nodes [m], (2, n)."""
        _check_number("tooth", self.tooth, section.machine.slots)
        drawn = dimensions_of(section.machine)
        machine = replace(drawn, tooth_width=drawn.tooth_width + self.change)
        return morpher.copies_moved(machine, section, (2 * self.tooth, 2 * self.tooth + 1))


def first_rotor_node(section: CrossSection) -> int:
    """Nodes of the stator come first."""
    return int(section.pieces[0].nodes.max()) + 1


def _turn_rotor(section: CrossSection, number: int, first: float, last: float) -> np.ndarray:
    """Moves (2, n) of the rotor when the clockwise and the counter-clockwise edge of a magnet turn [rad].

    Between two edges the angle is interpolated, so is it down to the shaft and up to the sliding circle.
    """
    m, rotor = dimensions_of(section.machine), slice(first_rotor_node(section), None)
    points = section.mesh.p[:, rotor]
    x, y = points
    depth = np.clip((np.hypot(x, y) - m.shaft_radius) / (m.rotor_core_radius - m.shaft_radius), 0.0, 1.0)
    depth *= np.clip(section.rotor_gap.height(points), 0.0, 1.0)
    turn = depth * np.interp(np.arctan2(y, x), *_turns(m, number, first, last), period=2 * np.pi)
    moves = np.zeros_like(section.mesh.p)
    moves[:, rotor] = x * (np.cos(turn) - 1) - y * np.sin(turn), x * np.sin(turn) + y * (np.cos(turn) - 1)
    return moves


def _turns(m: Machine, number: int, first: float, last: float) -> tuple[np.ndarray, list[float]]:
    """Angles of the magnet's centre and edges and where its neighbours rest, and what each turns by [rad]."""
    _check_number("magnet", number, m.poles)
    half, touching = m.magnet_arc_fraction * m.pole_pitch / 2, m.magnet_arc_fraction >= 1
    rest = m.pole_pitch if touching else m.pole_pitch - half  # a neighbour's centre, or its edge
    share = 0.5 if touching else 1.0  # a joint lies midway between the edges that meet there
    offsets = np.array([-rest, -half, 0.0, half, rest])
    return number * m.pole_pitch + offsets, [0.0, share * first, (first + last) / 2, share * last, 0.0]


def _check_number(what: str, number: int, count: int) -> None:
    if not 0 <= number < count:
        raise GeometryError(f"there is no {what} {number}: they are numbered from 0 to {count - 1}")


def _sum(centre: tuple[float, float], shift: np.ndarray) -> tuple[float, float]:
    return centre[0] + float(shift[0]), centre[1] + float(shift[1])
