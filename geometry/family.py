"""The machines of one study: everything that is stated stays, slots, poles and some dimensions vary."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

from geometry.machine import Machine, dimensions_of, hanselman_machine
from geometry.magnetisation import Magnetisation
from geometry.parts import DrawnMachine

_STATED = ("tooth_width", "shoe_d1", "shoe_d2")


@dataclass(frozen=True, order=True)
class Combination:
    """How many slots and poles a machine has: its slot-pole combination."""

    slots: int
    poles: int

    @classmethod
    def of(cls, machine: Machine) -> Combination:
        """That of a machine."""
        return cls(machine.slots, machine.poles)

    @property
    def pole_pairs(self) -> int:
        """Half the poles."""
        return self.poles // 2

    @property
    def words(self) -> str:
        """The combination as a sentence names it."""
        return f"{self.slots} slots, {self.poles} poles"


@dataclass(frozen=True)
class MachineFamily:
    """What ``hanselman_machine`` derives a machine from, lengths in m, with the dimensions that are stated instead.

    shoe_aspect_ratio: depth of the parallel opening over that of the taper, dimensionless
    tooth_width, shoe_d1, shoe_d2 [m]: None where they follow from the back iron (thesis eqs 3.53, 3.57, 3.58)
    """

    slots: int
    pole_pairs: int
    stator_outer_radius: float
    rotor_outer_radius: float
    back_iron_width: float
    magnet_length: float
    airgap: float
    slot_opening: float
    shoe_depth_fraction: float
    shoe_aspect_ratio: float
    shaft_radius: float
    magnet_arc_fraction: float
    magnetisation: Magnetisation
    tooth_width: float | None = None
    shoe_d1: float | None = None
    shoe_d2: float | None = None

    @property
    def reference(self) -> Machine:
        """The machine that the study states."""
        arguments = {f.name: getattr(self, f.name) for f in fields(self)}
        stated = {name: arguments.pop(name) for name in _STATED}
        return replace(
            hanselman_machine(**arguments), **{name: length for name, length in stated.items() if length is not None}
        )

    @property
    def combination(self) -> Combination:
        """Slots and poles of the reference machine."""
        return Combination(self.slots, 2 * self.pole_pairs)

    def machine(self, combination: Combination, **dimensions: float) -> Machine:
        """The study's machine with other slots, poles and dimensions; what follows from them is derived anew.

        dimensions: by the names of the fields above [m or 1]
        """
        changed: dict[str, Any] = {"slots": combination.slots, "pole_pairs": combination.pole_pairs, **dimensions}
        return replace(self, **changed).reference


@dataclass(frozen=True)
class MatchedMachine:
    """The cross-section that gearbox and motor were matched to; its winding is chosen by the stages behind it."""

    machine: DrawnMachine

    @property
    def dimensions(self) -> Machine:
        """See ``geometry.machine.dimensions_of``."""
        return dimensions_of(self.machine)


@dataclass(frozen=True)
class StatedMachine:
    """The cross-section that a study states."""

    machine: DrawnMachine
