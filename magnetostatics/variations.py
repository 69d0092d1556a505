"""Parameters whose sensitivities can be asked for: magnet, steel, current, and everything that moves nodes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Callable

from geometry.machine import Machine
from geometry.morph import Morpher
from magnetostatics.model import FieldModel, OperatingPoint
from materials.reluctivity import Reluctivity


@dataclass(frozen=True)
class Remanence:
    """Remanence of all magnets [T]."""

    step: float = 1e-4

    def at(self, model: FieldModel, point: OperatingPoint, change: float):
        magnet = model.materials.magnet
        changed = replace(magnet, remanence=magnet.remanence + change)
        return model.like(materials=replace(model.materials, magnet=changed)), point


@dataclass(frozen=True)
class RecoilPermeability:
    """Relative recoil permeability of all magnets; the remanence stays."""

    step: float = 1e-4

    def at(self, model: FieldModel, point: OperatingPoint, change: float):
        magnet = model.materials.magnet
        changed = replace(magnet, recoil_permeability=magnet.recoil_permeability + change)
        return model.like(materials=replace(model.materials, magnet=changed)), point


@dataclass(frozen=True)
class CurrentDensity:
    """Amplitude of the current density [A/m^2]."""

    step: float = 1e3

    def at(self, model: FieldModel, point: OperatingPoint, change: float):
        return model, replace(point, current_density=point.current_density + change)


@dataclass(frozen=True)
class CurrentAngle:
    """Current angle gamma [rad]."""

    step: float = 1e-4

    def at(self, model: FieldModel, point: OperatingPoint, change: float):
        return model, replace(point, current_angle=point.current_angle + change)


@dataclass(frozen=True)
class SteelStrength:
    """Scale of H in both steels: 0.01 means one per cent more field for the same flux density."""

    step: float = 1e-4

    def at(self, model: FieldModel, point: OperatingPoint, change: float):
        m = model.materials
        steels = ScaledReluctivity(m.stator_steel, 1 + change), ScaledReluctivity(m.rotor_steel, 1 + change)
        return model.like(materials=replace(m, stator_steel=steels[0], rotor_steel=steels[1])), point


@dataclass(frozen=True)
class ScaledReluctivity(Reluctivity):
    """Another law with H multiplied by a factor at every flux density."""

    law: Reluctivity
    factor: float

    def nu(self, b2):
        return self.factor * self.law.nu(b2)

    def nu_and_derivative(self, b2):
        nu, slope = self.law.nu_and_derivative(b2)
        return self.factor * nu, self.factor * slope

    def field_strength(self, b):
        return self.factor * self.law.field_strength(b)

    def flux_density(self, h):
        return self.law.flux_density(h / self.factor)

    def energy_density(self, b):
        return self.factor * self.law.energy_density(b)


@dataclass(frozen=True, eq=False)
class Dimension:
    """Anything that changes the drawn machine: the nodes of the mesh follow.

    morpher: of the cross-section that the solution was made on, or was moved from
    machine: change -> machine, for example ``lambda d: replace(base, airgap=base.airgap + d)``
    """

    morpher: Morpher
    machine: Callable[[float], Machine]
    step: float = 1e-6  # m

    def at(self, model: FieldModel, point: OperatingPoint, change: float):
        return model.like(self.morpher.to(self.machine(change))), point
