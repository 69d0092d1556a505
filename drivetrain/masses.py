"""Masses and inertias of the active parts of a machine: laminations, magnets, shaft and copper as they are drawn.

``SteelCylinder`` is the thesis's motor, a solid cylinder of steel in which a solid rotor turns; it stays for the
numbers that the thesis prints. It is some 40 % too heavy: most of a slot is air and insulation.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Protocol

from geometry.areas import part_areas
from geometry.machine import Machine
from geometry.parts import DrawnMachine


@dataclass(frozen=True)
class PartMaterials:
    """Densities of the parts, and how much of a stack is iron.

    lamination_density, magnet_density, copper_density, shaft_density: [kg/m^3]
    stacking: relative, thickness of the steel over the thickness of the stack of laminations, 0 to 1
    """

    lamination_density: float
    magnet_density: float
    copper_density: float
    shaft_density: float
    stacking: float


@dataclass(frozen=True)
class CopperBars:
    """The copper of a winding: so many straight sides, each with an end turn.

    area: copper in one coil side [m^2], packing times A_s or turns times strands times wire
    sides: coil sides of the machine, 6 N_c with N_c coils in series in each of three phases
    end_turn_length: of one end turn [m]
    """

    area: float
    sides: int
    end_turn_length: float

    def volume(self, active_length: float) -> float:
        """V = n A (l + l_et) [m^3], active length l [m]; as in the phase resistance (3.82)."""
        return self.sides * self.area * (active_length + self.end_turn_length)


@dataclass(frozen=True)
class PartMasses:
    """Masses of the active parts and inertias of those that turn, about the axis [kg m^2].

    stator_laminations, rotor_laminations, magnets, shaft, copper: masses [kg]
    """

    stator_laminations: float
    rotor_laminations: float
    magnets: float
    shaft: float
    copper: float
    rotor_laminations_inertia: float
    magnets_inertia: float
    shaft_inertia: float

    @property
    def total(self) -> float:
        """All active parts [kg]."""
        return self.stator_laminations + self.rotor_laminations + self.magnets + self.shaft + self.copper

    @property
    def rotor_mass(self) -> float:
        """Everything that turns [kg]."""
        return self.rotor_laminations + self.magnets + self.shaft

    @property
    def rotor_inertia(self) -> float:
        """Everything that turns [kg m^2]."""
        return self.rotor_laminations_inertia + self.magnets_inertia + self.shaft_inertia

    @property
    def rows(self) -> tuple[tuple[str, float, float], ...]:
        """(part, mass [kg], inertia about the axis [kg m^2], 0 for what stands still), the sum last."""
        return (
            ("stator laminations", self.stator_laminations, 0.0),
            ("copper with end turns", self.copper, 0.0),
            ("rotor laminations", self.rotor_laminations, self.rotor_laminations_inertia),
            ("magnets", self.magnets, self.magnets_inertia),
            ("shaft", self.shaft, self.shaft_inertia),
            ("active parts", self.total, self.rotor_inertia),
        )


def part_masses(
    machine: DrawnMachine, active_length: float, copper: CopperBars, materials: PartMaterials
) -> PartMasses:
    """Masses and inertias of the drawn parts.

    m = rho k A l and J = rho k l (integral of r^2 dA), with the stacking k for laminations and 1 for the others.
    machine: as drawn; active_length: [m]; copper: of the whole machine; materials: densities and stacking
    Left out: what stands beside the active length (shaft ends, bearings, casing), insulation, glue, wedges.
    Areas agree with the meshed regions to 0.2 %.
    """
    areas, length = part_areas(machine), active_length
    iron = materials.lamination_density * materials.stacking * length
    magnet, shaft = materials.magnet_density * length, materials.shaft_density * length
    return PartMasses(
        stator_laminations=iron * areas.stator_laminations,
        rotor_laminations=iron * areas.rotor_laminations,
        magnets=magnet * areas.magnets,
        shaft=shaft * areas.shaft,
        copper=materials.copper_density * copper.volume(length),
        rotor_laminations_inertia=iron * areas.rotor_laminations_moment,
        magnets_inertia=magnet * areas.magnets_moment,
        shaft_inertia=shaft * areas.shaft_moment,
    )


class SectionWithCopper(Protocol):
    """What a mass model asks of a cross-section; ``drivetrain.match.SizedSection`` has it."""

    @property
    def machine(self) -> Machine:
        """The machine as drawn."""

    def copper(self, packing: float) -> CopperBars:
        """The copper at a packing factor."""


class MassModel:
    """What motor and rotor weigh; the concrete models are below."""

    def mass(self, section: SectionWithCopper, length: float) -> float:
        """Mass of the motor [kg] at an active length [m]."""
        raise NotImplementedError

    def rotor_inertia(self, section: SectionWithCopper, length: float) -> float:
        """Inertia of the rotor about its axis [kg m^2] at an active length [m]."""
        raise NotImplementedError

    def mass_and_inertia(self, section: SectionWithCopper, length: float) -> tuple[float, float]:
        """Both, [kg] and [kg m^2], at an active length [m]; a search asks for them together."""
        return self.mass(section, length), self.rotor_inertia(section, length)


@dataclass(frozen=True)
class DrawnParts(MassModel):
    """The drawn parts, see ``part_masses``; packing: copper over the area of a coil side."""

    materials: PartMaterials
    packing: float

    def parts(self, section: SectionWithCopper, length: float) -> PartMasses:
        """Part by part, at an active length [m]."""
        return part_masses(section.machine, length, section.copper(self.packing), self.materials)

    def mass(self, section: SectionWithCopper, length: float) -> float:
        """See ``MassModel``."""
        return self.parts(section, length).total

    def rotor_inertia(self, section: SectionWithCopper, length: float) -> float:
        """See ``MassModel``."""
        return self.parts(section, length).rotor_inertia

    def mass_and_inertia(self, section: SectionWithCopper, length: float) -> tuple[float, float]:
        """See ``MassModel``."""
        parts = self.parts(section, length)
        return parts.total, parts.rotor_inertia


@dataclass(frozen=True)
class SteelCylinder(MassModel):
    """The thesis's motor: steel throughout, without ends; density [kg/m^3].

    m_em = rho pi R_so^2 l                    (3.101)
    J_em = 1/2 rho pi R_ro^4 l                (3.102, which prints R_ro^2 and so gives no inertia)
    """

    density: float

    def mass(self, section: SectionWithCopper, length: float) -> float:
        """See ``MassModel``."""
        return self.density * pi * section.machine.stator_outer_radius**2 * length

    def rotor_inertia(self, section: SectionWithCopper, length: float) -> float:
        """See ``MassModel``."""
        return self.density * pi * section.machine.rotor_outer_radius**4 * length / 2
