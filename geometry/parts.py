"""What a machine is put together from: a stator and a rotor, each of which draws half a pitch of itself.

Nothing outside the files of ``geometry/stators`` and ``geometry/rotors`` asks which kind a part is: meshing, field,
probes and defects ask for what is declared here. Angles count from the axis of a tooth or of a pole.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from math import cos, gcd, hypot, pi, sin
from typing import Annotated, Any, ClassVar, Protocol, get_args, get_origin, get_type_hints

import numpy as np

from geometry.errors import GeometryError, in_mm
from geometry.magnetisation import Magnetisation
from geometry.plane_mesh import Drawing

Length = Annotated[float, "mm"]  # [m]; what it is stated in at the border stands behind
Angle = Annotated[float, "deg"]  # [rad]
Share = Annotated[float, ""]  # dimensionless
Segment = tuple[tuple[float, float], tuple[float, float]]  # from one point x, y to another [m]


def radial(inner: float, outer: float, angle: float) -> Segment:
    """Along a ray. inner, outer: radii of its ends [m]; angle: of the ray [rad]"""
    return (inner * cos(angle), inner * sin(angle)), (outer * cos(angle), outer * sin(angle))


@dataclass(frozen=True)
class Rim:
    """How finely a part is meshed.

    edges: of half a pitch along its rim; edge_length: on the sliding circle [m]
    across_iron: number of elements across a tooth or another narrow piece of iron
    """

    edges: int
    edge_length: float
    across_iron: float


class Part:
    """Stator or rotor, a ring of equal pitches, each symmetric about its axis.

    of_any_sign: names of its numbers that need not be positive
    of_the_model: names of those that nothing is built by, only solved
    asked: names of what every concrete part must say of itself
    """

    asked: ClassVar[tuple[str, ...]] = ("rim_radius", "draw", "check")
    of_any_sign: ClassVar[frozenset[str]] = frozenset()
    of_the_model: ClassVar[frozenset[str]] = frozenset()

    @property
    def pitch(self) -> float:
        """Angle after which it repeats itself [rad]."""
        raise NotImplementedError

    @property
    def first_ray(self) -> float:
        """Angle from its axis 0 to the mirror line that half a pitch is drawn from [rad]."""
        return 0.0

    @property
    def rim_radius(self) -> float:
        """Where the gap begins [m]."""
        raise NotImplementedError

    @property
    def grounded_radius(self) -> float | None:
        """Circle on which the vector potential is zero [m], None where the part has none."""
        return None

    @property
    def other_corners(self) -> str:
        """Why two drawings of it have different points and curves, to be said of a mesh that cannot be moved."""
        return "the outlines of these two machines have different corners"

    def draw(self, rim: Rim) -> Drawing:
        """Half a pitch from its axis on without the gap; the same points and curves whatever its dimensions are,
        or else ``other_corners`` says so."""
        raise NotImplementedError

    def check(self) -> None:
        """Raise GeometryError, naming the parameter to move, where it cannot be built."""
        raise NotImplementedError


class Stator(Part):
    """Regions iron, opening, copper (half a slot), and others of air; the axis is that of a tooth."""

    asked: ClassVar[tuple[str, ...]] = ("slots", *Part.asked, "slot_radii", "tooth_probe", "back_iron_probe")
    slots: int

    @property
    def pitch(self) -> float:
        """Angle between two teeth [rad]."""
        return 2 * pi / self.slots

    @property
    def slot_radii(self) -> tuple[float, float]:
        """Between which the coil sides lie, the smaller first [m]; the taper of a shoe is left out."""
        raise NotImplementedError

    @property
    def slot_depth(self) -> float:
        """Radial height of the coil sides [m]."""
        inner, outer = self.slot_radii
        return outer - inner

    @property
    def probed_tooth_width(self) -> float:
        """Of a tooth where its saturation is read [m]."""
        (x, y), (other_x, other_y) = self.tooth_probe
        return hypot(other_x - x, other_y - y)

    @property
    def tooth_probe(self) -> Segment:
        """Across tooth 0, where its saturation is read [m]."""
        raise NotImplementedError

    @property
    def back_iron_probe(self) -> Segment:
        """Through the back iron behind a slot, the axis of the slot being the x axis [m]."""
        raise NotImplementedError


class StatorRoundRotor(Stator):
    """A stack with its rotor inside: the gap begins at ``bore_radius``, the stack ends at ``outer_radius`` [m]."""

    bore_radius: Length
    outer_radius: Length

    @property
    def rim_radius(self) -> float:
        return self.bore_radius

    @property
    def grounded_radius(self) -> float:
        return self.outer_radius


class Rotor(Part):
    """Regions iron, magnet, and others of air; the axis is that of a pole. Poles of even number point outwards.

    Without magnets the axis is that of high permeance. Further magnets of half a pitch are magnet_1, magnet_2, ...
    """

    asked: ClassVar[tuple[str, ...]] = ("poles", *Part.asked, "direction")
    poles: int

    @property
    def repeats(self) -> int:
        """How many equal pitches there are, but for the sign of their magnets: as many as poles, or half as many where
        only every second pole is like the first; then the magnets of all pitches have one sign."""
        return self.poles

    @property
    def pitch(self) -> float:
        """Angle after which it repeats itself, but for the sign of its magnets [rad]."""
        return 2 * pi / self.repeats

    @property
    def magnets_per_pitch(self) -> int:
        """0: none; 1: on the axis of the pole; 2, 4, ...: beside it, all of the clockwise half first."""
        return 1

    @property
    def magnet_regions(self) -> tuple[str, ...]:
        """Names of the regions of magnets in half a pitch."""
        return ("magnet", *(f"magnet_{k}" for k in range(1, self.magnets_per_pitch // 2)))[: self.magnets_per_pitch]

    @property
    def probes(self) -> Mapping[str, Segment]:
        """Where narrow iron saturates: across what is drawn of pole 0 [m], by name; none where nothing is narrow."""
        return {}

    @property
    def bore_radius(self) -> float:
        """Of a hole in it that is not drawn, for a shaft [m]; 0 where all of the rotor is drawn."""
        return 0.0

    def direction(self, position_angle: np.ndarray, axis: float, which: int) -> np.ndarray:
        """Angle of the magnetisation of an outward pole [rad], of the shape of the positions.

        position_angle: polar angle of points of the magnet [rad], of any shape; axis: that of the pole [rad]
        which: of the pole's magnets
        """
        raise NotImplementedError


class MagnetOnAxis(Rotor):
    """One magnet on the axis of every pole, as it is magnetised.

    gap_outside: whether the gap lies outside of the magnets
    """

    magnetisation: Magnetisation
    gap_outside: ClassVar[bool] = True

    def direction(self, position_angle: np.ndarray, axis: float, which: int = 0) -> np.ndarray:
        """Of the pattern [rad], of the shape of position_angle [rad], any shape; axis: of the pole [rad]"""
        return self.magnetisation.direction_angle(position_angle, axis, self.pitch if self.gap_outside else -self.pitch)


class MagnetsOfRoundCore(MagnetOnAxis):
    """Magnets of constant thickness on a round core or let into it; radii and magnet_length [m].

    outer_radius: over the magnets; outer_name: what it is called where such a rotor is stated
    """

    outer_radius: Length
    magnet_length: Length
    shaft_radius: Length
    outer_name: ClassVar[str] = "outer_radius"

    @property
    def core_radius(self) -> float:
        """Under the magnets [m]."""
        return self.outer_radius - self.magnet_length

    @property
    def rim_radius(self) -> float:
        return self.outer_radius

    def check_core(self) -> None:
        """Raise GeometryError where no core is left between magnets and shaft."""
        if self.core_radius <= self.shaft_radius:
            raise GeometryError(
                f"the rotor core under the magnets ends at {in_mm(self.core_radius)}, inside the shaft of radius "
                f"{in_mm(self.shaft_radius)}: enlarge {self.outer_name}, or reduce magnet_length or shaft_radius"
            )


class Buried(Rotor):
    """Holes in a round lamination on a shaft that carries no flux: the gap begins at ``outer_radius`` [m]."""

    outer_radius: Length
    shaft_radius: Length

    @property
    def rim_radius(self) -> float:
        return self.outer_radius

    @property
    def grounded_radius(self) -> float:
        return self.shaft_radius

    @property
    def bore_radius(self) -> float:
        return self.shaft_radius


class WithoutMagnets(Rotor):
    """A reluctance rotor: its d axis is that of high permeance."""

    @property
    def magnets_per_pitch(self) -> int:
        return 0

    def direction(self, position_angle: np.ndarray, axis: float, which: int) -> np.ndarray:
        """None of the magnets that there are not [rad], of any shape; position_angle: [rad], of any shape; axis: [rad].

        Raises GeometryError.
        """
        raise GeometryError("a reluctance rotor has no magnets")


class DrawnMachine(Protocol):
    """What mesh and field ask of a machine, whatever its kind."""

    def __hash__(self) -> int: ...

    @property
    def stator(self) -> Stator: ...

    @property
    def rotor(self) -> Rotor: ...

    @property
    def slots(self) -> int: ...

    @property
    def pole_pairs(self) -> int: ...

    @property
    def poles(self) -> int: ...

    @property
    def slot_pitch(self) -> float:
        """Angle between two teeth [rad]."""

    @property
    def pole_pitch(self) -> float:
        """Angle between two poles [rad]."""

    @property
    def airgap(self) -> float:
        """Between the rims of stator and rotor [m]."""

    @property
    def mid_gap_radius(self) -> float:
        """Of the sliding circle [m]."""

    @property
    def repeats(self) -> int:
        """Equal pitches of the rotor, see ``Rotor.repeats``."""

    @property
    def half_wave(self) -> bool:
        """Whether the field at opposite currents is that of a pole further on, with the opposite sign."""

    @property
    def sectors(self) -> int:
        """How many times the smallest (anti)periodic sector fits into the machine: gcd(slots, repeats)."""

    @property
    def is_antiperiodic(self) -> bool:
        """True when the field changes sign from one sector to the next (odd number of poles per sector)."""


class Pitches:
    """What follows from the numbers of slots and poles."""

    slots: int
    pole_pairs: int

    @property
    def poles(self) -> int:
        return 2 * self.pole_pairs

    @property
    def slot_pitch(self) -> float:
        """Angle between two teeth [rad]."""
        return 2 * pi / self.slots

    @property
    def pole_pitch(self) -> float:
        """Angle between two poles [rad]."""
        return pi / self.pole_pairs

    @property
    def repeats(self) -> int:
        """Equal pitches of the rotor, see ``Rotor.repeats``."""
        return self.poles

    @property
    def half_wave(self) -> bool:
        """Whether the field at opposite currents is that of a pole further on, with the opposite sign."""
        return self.repeats == self.poles

    @property
    def sectors(self) -> int:
        """How many times the smallest (anti)periodic sector fits into the machine: gcd(slots, repeats)."""
        return gcd(self.slots, self.repeats)

    @property
    def is_antiperiodic(self) -> bool:
        """True when the field changes sign from one sector to the next (odd number of poles per sector)."""
        return (self.poles // self.sectors) % 2 == 1


@dataclass(frozen=True)
class ComposedMachine(Pitches):
    """Any stator with any rotor, inside or outside of it.

    Raises GeometryError where there is no gap between them.
    """

    stator: Stator
    rotor: Rotor

    @property
    def slots(self) -> int:  # type: ignore[override]  # it is what the stator says
        return self.stator.slots

    @property
    def pole_pairs(self) -> int:  # type: ignore[override]
        return self.rotor.poles // 2

    @property
    def repeats(self) -> int:
        return self.rotor.repeats

    @property
    def half_wave(self) -> bool:
        if self.repeats == self.poles:
            return True
        return self.rotor.magnets_per_pitch == 0 and self.slots % self.poles == 0  # then by the slots and the currents

    @property
    def airgap(self) -> float:
        """Between the rims of stator and rotor [m]."""
        return abs(self.stator.rim_radius - self.rotor.rim_radius)

    @property
    def mid_gap_radius(self) -> float:
        """Of the sliding circle [m]."""
        return (self.stator.rim_radius + self.rotor.rim_radius) / 2


def part_units(cls: type[Part]) -> dict[str, str]:
    """Drawing units of the fields of a part by their names, empty for a pure number."""
    hints = get_type_hints(cls, include_extras=True)
    return {one.name: _unit(hints[one.name]) for one in fields(cls)}  # type: ignore[arg-type]  # a part is a dataclass


def _unit(hint: Any) -> str:
    return str(get_args(hint)[1]) if get_origin(hint) is Annotated else ""
