"""The machines of one study: everything that is stated stays, four numbers vary."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

from geometry.machine import Machine, hanselman_machine
from geometry.magnetisation import Magnetisation

_STATED = ("tooth_width", "shoe_d1", "shoe_d2")


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

    def machine(
        self, slots: int, stator_outer_radius: float, back_iron_width: float, rotor_outer_radius: float
    ) -> Machine:
        """The study's machine with four numbers changed, lengths in m; what follows from them is derived anew."""
        return replace(
            self,
            slots=slots,
            stator_outer_radius=stator_outer_radius,
            back_iron_width=back_iron_width,
            rotor_outer_radius=rotor_outer_radius,
        ).reference


@dataclass(frozen=True)
class MatchedMachine:
    """The cross-section that gearbox and motor were matched to; its winding is chosen by the stages behind it."""

    machine: Machine
