"""Parameters whose sensitivities can be asked for: magnet, steel, current, and everything that moves nodes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

from geometry.cross_section import CrossSection
from geometry.machine import Machine
from geometry.morph import Morpher
from magnetostatics.currents import PhaseCurrents
from magnetostatics.local_steel import with_law
from magnetostatics.model import FieldModel, MachineMaterials, OperatingPoint, OperatingState
from magnetostatics.sensitivity import Variation
from materials.altered_steel import ScaledReluctivity, ScaledSaturation, stacked
from materials.reluctivity import Reluctivity


@dataclass(frozen=True)
class Remanence:
    """Remanence of all magnets; step, change: [T]."""

    step: float = 1e-6

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The model with B_r + change in all magnets, the state as it is; change: [T]."""
        materials = model.materials.with_magnets(lambda m: replace(m, remanence=m.remanence + change))
        return model.like(materials=materials), point


@dataclass(frozen=True)
class RecoilPermeability:
    """Recoil permeability of all magnets; the remanence stays; step, change: dimensionless."""

    step: float = 1e-6

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The model with mu_r + change in all magnets, the state as it is; change: dimensionless."""
        materials = model.materials.with_magnets(
            lambda m: replace(m, recoil_permeability=m.recoil_permeability + change)
        )
        return model.like(materials=materials), point


@dataclass(frozen=True)
class OneMagnet:
    """A property of one magnet of a whole machine, by the name of its field in ``Magnet``.

    name: ``remanence`` [T], ``recoil_permeability`` or ``axis_error`` [rad]; step, change: [as the property]
    """

    number: int
    name: str = "remanence"
    step: float = 1e-6

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The model with that property of that magnet + change, the state as it is; change: [as the property]."""
        magnet = model.materials.magnet_at(self.number)
        changed = replace(magnet, **{self.name: getattr(magnet, self.name) + change})
        return model.like(materials=model.materials.with_magnet(self.number, changed)), point


@dataclass(frozen=True)
class CurrentDensity:
    """Amplitude of the current density; step, change: [A/m^2]."""

    step: float = 10.0

    def at(self, model: FieldModel, point: OperatingPoint, change: float) -> tuple[FieldModel, OperatingState]:
        """The model as it is, the state at J + change; change: of the amplitude [A/m^2]."""
        return model, replace(point, current_density=point.current_density + change)


@dataclass(frozen=True)
class CurrentAngle:
    """Current angle gamma; step, change: [rad]."""

    step: float = 1e-6

    def at(self, model: FieldModel, point: OperatingPoint, change: float) -> tuple[FieldModel, OperatingState]:
        """The model as it is, the state at gamma + change; change: [rad]."""
        return model, replace(point, current_angle=point.current_angle + change)


@dataclass(frozen=True)
class SteelStrength:
    """Scale of H in both steels; step, change: relative, 0.01 is 1 % more field for the same flux density."""

    step: float = 1e-6

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The model with H(B) (1 + change) in both steels, the state as it is; change: relative, dimensionless."""
        return _with_steels(model, lambda law: ScaledReluctivity(law, 1 + change)), point


@dataclass(frozen=True)
class SaturationPolarisation:
    """Scale of the saturation polarisation of both steels; step, change: relative, 0.01 is 1 % more."""

    step: float = 1e-6

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The model with J_s (1 + change) in both steels, the state as it is; change: relative, dimensionless."""
        return _with_steels(model, lambda law: ScaledSaturation(law, 1 + change)), point


@dataclass(frozen=True)
class StackingFactor:
    """Share of the steel in both stacks, from a solid one on.

    step, change: relative, -0.03 is a stacking factor of 0.97 times the present
    """

    step: float = 1e-6

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The model with 1 + change of the present steel in both stacks, the state as it is; change: dimensionless."""
        return _with_steels(model, lambda law: stacked(law, 1 + change)), point


def _with_steels(model: FieldModel, change: Callable[[Reluctivity], Reluctivity]) -> FieldModel:
    m = model.materials
    steels = with_law(m.stator_steel, change), with_law(m.rotor_steel, change)
    return model.like(materials=replace(m, stator_steel=steels[0], rotor_steel=steels[1]))


@dataclass(frozen=True, eq=False)
class Materials:
    """Anything that changes the materials.

    step: [unit of the amount]
    change: (materials of the solution, amount [any unit]) -> materials, for example
        ``lambda m, d: replace(m, stator_steel=CutEdge(steel, 0.5e-3, 0.3 + d))``
    """

    change: Callable[[MachineMaterials, float], MachineMaterials]
    step: float

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The model with the changed materials, the state as it is; change: the amount [its unit]."""
        return model.like(materials=self.change(model.materials, change)), point


class _Once:
    """Changes a model once for all its states, several of which are asked for together; the last one is kept."""

    def _once(self, model: FieldModel, change: float, make: Callable[[], FieldModel]) -> FieldModel:
        kept = self._models.get(change)
        if kept is None or not _is_same(kept[0], model):
            kept = self._models[change] = model, make()
        return kept[1]

    @cached_property
    def _models(self) -> dict[float, tuple[FieldModel, FieldModel]]:
        """By the change: the model that was changed, and what became of it."""
        return {}


def _is_same(one: FieldModel, other: FieldModel) -> bool:
    return one.section is other.section and one.materials is other.materials and one.order is other.order


@dataclass(frozen=True, eq=False)
class Dimension(_Once):
    """Anything that changes the drawn machine: the nodes of the mesh follow.

    morpher: of the cross-section that the solution was made on, or was moved from
    machine: change [m, or its unit] -> machine, for example ``lambda d: replace(base, airgap=base.airgap + d)``
    """

    morpher: Morpher
    machine: Callable[[float], Machine]
    step: float = 1e-8  # [m]

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The model on the moved mesh, of the same order of elements, the state as it is; change: [as of ``machine``].

        Raises what the drawing of the changed machine raises: GeometryError.
        """
        fine = model.finest
        changed = self._once(fine, change, lambda: fine.like(self.morpher.to(self.machine(change))))
        return changed.of_order(model.order), point


@dataclass(frozen=True, eq=False)
class Shape:
    """Anything that moves nodes, defects of one machine among them.

    section: change [m or rad] -> cross-section on the same triangles, for example
        ``lambda d: morpher.to(machine, [StaticEccentricity(0.1e-3 + d, 0.3)])``
    """

    section: Callable[[float], CrossSection]
    step: float = 1e-8  # [m or rad]

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The model on the moved cross-section, the state as it is; change: [m or rad]."""
        return model.like(self.section(change)), point


@dataclass(frozen=True, eq=False)
class SameAmpereTurns(_Once):
    """A variation of a wound machine: the current stays that of its wires, however much room the slot leaves them.

    varied: what changes, under a balanced supply; step, change: [unit of that]
    """

    varied: Variation

    @property
    def step(self) -> float:
        """That of what changes [its unit]."""
        return self.varied.step

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The varied model, its state at J A / A_changed, A the area of half a slot; change: [unit of what varies].

        Raises TypeError for a supply that is no ``OperatingPoint``.
        """
        if not isinstance(point, OperatingPoint):
            raise TypeError(
                f"ampere-turns are kept of a balanced supply, an OperatingPoint; found {type(point).__name__}"
            )
        changed = self._once(model, change, lambda: self.varied.at(model, point, change)[0])
        more_room = changed.section.half_slot_area / model.section.half_slot_area
        return changed, replace(point, current_density=point.current_density / more_room)


@dataclass(frozen=True)
class PhaseCurrent:
    """Current of one phase of ``PhaseCurrents``; step, change: [A]."""

    phase: int  # 0 A, 1 B, 2 C
    step: float = 1e-4

    def at(self, model: FieldModel, point: PhaseCurrents, change: float) -> tuple[FieldModel, OperatingState]:
        """The model as it is, the state with i + change in that phase; change: [A]."""
        a, b, c = (i + change * (k == self.phase) for k, i in enumerate(point.currents))
        return model, replace(point, currents=(a, b, c))


@dataclass(frozen=True)
class CoilTurns:
    """Turns of one coil of a whole machine; step, change: relative to those of the design."""

    coil: int  # its index in the winding
    step: float = 1e-6

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        """The model with that coil's turns + change, the state as it is; change: relative to the design's."""
        layout = model.section.layout
        now = next(coil.turns for coil in layout.coils if coil.index == self.coil)
        section = replace(model.section, layout=layout.with_turns({self.coil: now + change}))
        return model.like(section), point
