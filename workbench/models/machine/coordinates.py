"""Everything a machine as built may differ in from the one as drawn, as numbers: the coordinates of its surrogate."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from effects.machine_design import MachineAsBuilt
from magnetostatics.currents import CoilCurrents
from magnetostatics.model import FieldModel, OperatingState
from units import MILLIMETRE
from workbench.models.machine.field import MachineField

BOTH, MAGNET, SLOT, STATOR, ROTOR = "both", "magnet", "slot", "stator", "rotor"


@dataclass(frozen=True)
class Coordinate:
    """One number of a design.

    path: names of the fields that lead to it, ("machine", "airgap");  index: in a tuple, -1 for a plain number
    step: for a derivative;  size: at which the curvature is taken, zero for none;  both in the number's own unit
    breaks: the symmetry that is left, BOTH when every magnet and slot stays like the others
    """

    path: tuple[str, ...]
    step: float
    size: float = 0.0
    index: int = -1
    breaks: str = BOTH

    @property
    def name(self) -> str:
        return ".".join(self.path) + (f"[{self.index}]" if self.index >= 0 else "")

    def read(self, design: MachineAsBuilt) -> float:
        """The number in a design."""
        value: Any = design
        for name in self.path:
            value = getattr(value, name)
        return float(value[self.index] if self.index >= 0 else value)

    def changed(self, design: MachineAsBuilt, change: float) -> MachineAsBuilt:
        """The design with the number changed by ``change``."""
        if self.index >= 0:
            return design.with_one(self.path[0], self.index, self.read(design) + change)
        return _replaced(design, self.path, self.read(design) + change)


def _replaced(thing: Any, path: tuple[str, ...], value: float) -> Any:
    first, *rest = path
    return replace(thing, **{first: _replaced(getattr(thing, first), tuple(rest), value) if rest else value})


STATOR_SHIFT = tuple(Coordinate(("stator_shift",), 1e-7, 0.1 * MILLIMETRE, k, STATOR) for k in (0, 1))
ROTOR_SHIFT = tuple(Coordinate(("rotor_shift",), 1e-7, 0.1 * MILLIMETRE, k, ROTOR) for k in (0, 1))
SHIFTS = (STATOR_SHIFT, ROTOR_SHIFT)
ARC = Coordinate(("machine", "magnet_arc_fraction"), 1e-4, -0.06)
LESS_ARC = (-0.03, -0.08, -0.13)  # where neighbouring magnets touch a smaller arc is another mesh: secants


def smooth_coordinates(nominal: MachineAsBuilt) -> tuple[Coordinate, ...]:
    """All coordinates that the field follows smoothly, so that a back-substitution gives their derivative."""
    arc = (ARC,) if nominal.machine.magnet_arc_fraction < 1 else ()
    return (
        *arc,
        Coordinate(("magnet", "remanence"), 1e-4, 0.06),
        Coordinate(("magnet", "recoil_permeability"), 1e-4, 0.06),
        Coordinate(("machine", "airgap"), 1e-7, 0.06 * MILLIMETRE),
        Coordinate(("magnet_grinding",), 1e-7, 0.06 * MILLIMETRE),
        Coordinate(("bore_grinding",), 1e-7, 0.06 * MILLIMETRE),
        Coordinate(("machine", "slot_opening"), 1e-7, 0.3 * MILLIMETRE),
        Coordinate(("field_scale",), 1e-4, 0.5),
        Coordinate(("saturation_scale",), 1e-4, -0.05),
        Coordinate(("stacking_factor",), 1e-4, -0.04),
        Coordinate(("edge_damage",), 1e-4, 0.4),
        Coordinate(("radial_share",), 1e-4, 0.3),
        *(Coordinate(("magnet_strengths",), 1e-4, -0.12, k, MAGNET) for k in range(nominal.machine.poles)),
        *(Coordinate(("magnet_turns",), 1e-5, 0.012, k, MAGNET) for k in range(nominal.machine.poles)),
        *(Coordinate(("opening_changes",), 1e-7, 0.3 * MILLIMETRE, k, SLOT) for k in range(nominal.machine.slots)),
        *STATOR_SHIFT,
        *ROTOR_SHIFT,
    )


@dataclass(eq=False)
class CoordinateVariation:
    """A coordinate as ``magnetostatics.sensitivity`` asks for it; the changed field models are kept."""

    fields: MachineField
    coordinate: Coordinate
    _models: dict[float, FieldModel] = field(default_factory=dict)

    @property
    def step(self) -> float:
        return self.coordinate.step

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        if change not in self._models:
            design = self.coordinate.changed(self.fields.nominal, change)
            self._models[change] = self.fields.model(design, whole=True)
        return self._models[change], point

    def forget(self) -> None:
        """Give the memory of the changed models back."""
        self._models.clear()


@dataclass(frozen=True)
class CoilVariation:
    """Ampere-turns of one coil of ``CoilCurrents`` [A]."""

    coil: int
    step: float = 1.0

    def at(self, model: FieldModel, point: CoilCurrents, change: float) -> tuple[FieldModel, CoilCurrents]:
        currents = list(point.coil_ampere_turns)
        currents[self.coil] += change
        return model, replace(point, coil_ampere_turns=tuple(currents))

    def forget(self) -> None:
        """Nothing is kept."""
