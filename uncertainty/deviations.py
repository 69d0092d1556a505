"""The dimensions and properties of the drawing that a workshop misses, each with how far and what it moves.

A tolerance of +-a says no more than that the value lies inside; so it is taken as uniform there, with the standard
uncertainty a/sqrt(3) (GUM, JCGM 100:2008, 4.3.7, a type B evaluation). This holds for every tolerance of this room.

What is drawn independently: bore and rotor are turned, and the air gap is what they leave; magnets lie on a core that
stays, so that a thicker one narrows the gap; slot, tooth and shoe are cut out of a sheet whose bore stays.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import sqrt
from typing import ClassVar

from drivetrain.masses import PartMaterials
from electrical.wound_machine import WoundMachine
from geometry.machine import Machine, dimensions_of
from geometry.morph import Morpher
from magnetostatics.sensitivity import Variation
from magnetostatics.variations import Dimension, RecoilPermeability, Remanence, StackingFactor


@dataclass(frozen=True)
class Deviation:
    """One quantity of the drawing; the concrete ones are below.

    half_width: a of +-a [unit of the quantity, SI]; unit: to show it in, a key of ``units.FACTORS``, empty for a number
    """

    half_width: float
    name: ClassVar[str]
    unit: ClassVar[str] = "mm"
    step: ClassVar[float] = 1e-8  # a small change [SI], small against any half width

    @property
    def standard_uncertainty(self) -> float:
        """a/sqrt(3) [SI]."""
        return self.half_width / sqrt(3)

    def centre(self, machine: Machine) -> Machine:
        """The machine in the middle of the tolerance: mostly the drawn one."""
        return machine

    def variation(self, morpher: Morpher) -> Variation | None:
        """What it does to a field on the mesh of the morpher; None where it does nothing there."""
        return None

    def wound(self, wound: WoundMachine, change: float) -> WoundMachine:
        """The wound machine with it; change: [SI]."""
        return wound

    def parts(self, materials: PartMaterials, change: float) -> PartMaterials:
        """What the parts are made of with it; change: [SI]."""
        return materials


class SectionDimension(Deviation):
    """A dimension of the cross-section, of all teeth or magnets alike."""

    def moved(self, machine: Machine, change: float) -> Machine:
        """The machine with it; change: [m]."""
        raise NotImplementedError

    def variation(self, morpher: Morpher) -> Variation:
        machine = dimensions_of(morpher.section.machine)
        return Dimension(morpher, lambda change: self.moved(machine, change), self.step)

    def wound(self, wound: WoundMachine, change: float) -> WoundMachine:
        """With it; change: [m]."""
        return replace(wound, machine=self.moved(wound.dimensions, change))


class BoreRadius(SectionDimension):
    """The bore of the stator, and with it the air gap; the slots stay where they are, their openings are less deep."""

    name = "bore radius"

    def moved(self, machine: Machine, change: float) -> Machine:
        """With it; change: [m]."""
        return replace(machine, airgap=machine.airgap + change, shoe_d1=machine.shoe_d1 - change)


class RotorRadius(SectionDimension):
    """The core of the rotor, and the magnets on it: the air gap is what the bore leaves."""

    name = "rotor radius"

    def moved(self, machine: Machine, change: float) -> Machine:
        """With it; change: [m]."""
        outer = machine.rotor_outer_radius + change
        return replace(machine, rotor_outer_radius=outer, airgap=machine.airgap - change)


class MagnetLength(SectionDimension):
    """Radial thickness of the magnets on a core that stays: the air gap is narrower by as much."""

    name = "magnet length"

    def moved(self, machine: Machine, change: float) -> Machine:
        """With it; change: [m]."""
        outer, length = machine.rotor_outer_radius + change, machine.magnet_length + change
        return replace(machine, rotor_outer_radius=outer, magnet_length=length, airgap=machine.airgap - change)


class MagnetArc(SectionDimension):
    """Width of the magnets along their outer arc [m].

    Magnets that fill the whole pole pitch can only be narrower: the tolerance of those lies on one side, from the
    drawn width down by 2a, and its middle is a machine whose magnets do not touch.
    """

    name = "magnet arc"

    def centre(self, machine: Machine) -> Machine:
        return self.moved(machine, -self.half_width) if machine.magnet_arc_fraction >= 1 else machine

    def moved(self, machine: Machine, change: float) -> Machine:
        """With it; change: [m]."""
        pitch = machine.pole_pitch * machine.rotor_outer_radius
        return replace(machine, magnet_arc_fraction=machine.magnet_arc_fraction + change / pitch)


class SlotOpening(SectionDimension):
    """Width of the slot openings."""

    name = "slot opening"

    def moved(self, machine: Machine, change: float) -> Machine:
        """With it; change: [m]."""
        return replace(machine, slot_opening=machine.opening_width + change)


class ToothWidth(SectionDimension):
    """Width of the teeth behind their shoes."""

    name = "tooth width"

    def moved(self, machine: Machine, change: float) -> Machine:
        """With it; change: [m]."""
        return replace(machine, tooth_width=machine.tooth_width + change)


class BackIron(SectionDimension):
    """Width of the back iron, by the bottom of the slots; the outer radius stays."""

    name = "back iron width"

    def moved(self, machine: Machine, change: float) -> Machine:
        """With it; change: [m]."""
        return replace(machine, back_iron_width=machine.back_iron_width + change)


class OpeningDepth(SectionDimension):
    """Depth of the parallel-sided slot opening, d_1; the taper ends where it did."""

    name = "shoe depth d1"

    def moved(self, machine: Machine, change: float) -> Machine:
        """With it; change: [m]."""
        return replace(machine, shoe_d1=machine.shoe_d1 + change, shoe_d2=machine.shoe_d2 - change)


class TaperDepth(SectionDimension):
    """Depth of the taper of the shoe, d_2."""

    name = "shoe depth d2"

    def moved(self, machine: Machine, change: float) -> Machine:
        """With it; change: [m]."""
        return replace(machine, shoe_d2=machine.shoe_d2 + change)


class StatorRadius(SectionDimension):
    """Outer radius of the stator; the slots stay, the back iron is wider."""

    name = "stator outer radius"

    def moved(self, machine: Machine, change: float) -> Machine:
        """With it; change: [m]."""
        outer, iron = machine.stator_outer_radius + change, machine.back_iron_width + change
        return replace(machine, stator_outer_radius=outer, back_iron_width=iron)


class MagnetRemanence(Deviation):
    """Remanence of all magnets, of their batch."""

    name, unit, step = "remanence", "T", 1e-6

    def variation(self, morpher: Morpher) -> Variation:
        return Remanence(self.step)


class MagnetPermeability(Deviation):
    """Recoil permeability of all magnets at the same remanence."""

    name, unit, step = "recoil permeability", "", 1e-6

    def variation(self, morpher: Morpher) -> Variation:
        return RecoilPermeability(self.step)


class Stacking(Deviation):
    """Share of steel in the stack, relative to that of the design."""

    name, unit, step = "stacking factor", "percent", 1e-6

    def variation(self, morpher: Morpher) -> Variation:
        return StackingFactor(self.step)

    def parts(self, materials: PartMaterials, change: float) -> PartMaterials:
        """With it; change: relative."""
        return replace(materials, stacking=materials.stacking * (1 + change))


class StackLength(Deviation):
    """Length of the stack."""

    name = "active length"

    def wound(self, wound: WoundMachine, change: float) -> WoundMachine:
        """With it; change: [m]."""
        return replace(wound, active_length=wound.active_length + change)


class WireDiameter(Deviation):
    """Copper diameter of the wires, relative."""

    name, unit, step = "wire diameter", "percent", 1e-6

    def wound(self, wound: WoundMachine, change: float) -> WoundMachine:
        """With it; change: relative."""
        design = wound.design
        wire = replace(design.wire, copper_diameter=design.wire.copper_diameter * (1 + change))
        return replace(wound, design=replace(design, wire=wire))


@dataclass(frozen=True)
class MagnetScatter:
    """How the magnets of one machine differ from each other, each +-a about its drawn value.

    remanence: [T]; position: angle about the shaft [rad]
    """

    remanence: float
    position: float


@dataclass(frozen=True)
class Tolerances:
    """Everything that is not as drawn.

    deviations: of all teeth, magnets and wires alike; scatter: from magnet to magnet
    eccentricity: of stator and rotor, each, as a share of the air gap, dimensionless
    """

    deviations: tuple[Deviation, ...]
    scatter: MagnetScatter
    eccentricity: float
