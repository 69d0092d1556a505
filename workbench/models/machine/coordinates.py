"""Everything a machine as built may differ in from the one as drawn, as numbers: the coordinates of its surrogate."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from effects.machine_design import MachineAsBuilt
from magnetostatics.currents import CoilCurrents
from magnetostatics.model import FieldModel, OperatingState
from workbench.models.machine.field import MachineField

BOTH, MAGNET, SLOT, STATOR, ROTOR = "both", "magnet", "slot", "stator", "rotor"


@dataclass(frozen=True)
class Coordinate:
    """One number of a design.

    path: names of the fields that lead to it, ("machine", "airgap");  index: in a tuple, -1 for a plain number
    step: for a derivative;  sizes: finite changes that are solved as well;  both in the number's own unit
    breaks: the symmetry that is left, BOTH when every magnet and slot stays like the others
    """

    path: tuple[str, ...]
    step: float
    sizes: tuple[float, ...] = ()
    index: int = -1
    breaks: str = BOTH

    @property
    def name(self) -> str:
        return ".".join(self.path) + (f"[{self.index}]" if self.index >= 0 else "")

    @property
    def in_mirror(self) -> int:
        """Sign that the number has in a mirror through the axes of tooth 0 and magnet 0."""
        is_y = self.breaks in (STATOR, ROTOR) and self.index == 1
        return -1 if is_y or self.path == MAGNET_TURNS else 1

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


REMANENCE, AIRGAP, MAGNET_TURNS = ("magnet", "remanence"), ("machine", "airgap"), ("magnet_turns",)
TOLERANCED = (REMANENCE, AIRGAP)  # of every machine: what they do to all other changes is known too
STEEL = (
    ("saturation_scale",),
    ("stacking_factor",),
)  # flux that the steel carries: alike to weaker or stronger magnets
LESS_ARC = (-0.03, -0.08, -0.13)  # where neighbouring magnets touch a smaller arc is another mesh: no derivative there


def smooth_coordinates(nominal: MachineAsBuilt) -> tuple[Coordinate, ...]:
    """All coordinates that the field follows smoothly, so that a back-substitution gives their derivative.

    The sizes span what a bench meets: magnets 120 K warmer or 4 % stronger, three quarters of a stack of bare sheets, a
    fifth of the gap or of the slot opening.
    """
    remanence, gap, opening = nominal.magnet.remanence, nominal.machine.airgap, nominal.machine.slot_opening
    arc = (arc_of(nominal),) if nominal.machine.magnet_arc_fraction < 1 else ()
    magnets, slots = range(nominal.machine.poles), range(nominal.machine.slots)
    return (
        *arc,
        Coordinate(REMANENCE, 1e-6, tuple(share * remanence for share in (-0.13, -0.055, 0.04, 0.09, 0.15))),
        Coordinate(("magnet", "recoil_permeability"), 1e-6, (0.08,)),
        Coordinate(AIRGAP, 1e-9, (-0.2 * gap, 0.2 * gap)),
        Coordinate(("magnet_grinding",), 1e-9, (0.15 * gap,)),
        Coordinate(("bore_grinding",), 1e-9, (0.15 * gap,)),
        Coordinate(("machine", "slot_opening"), 1e-9, (-0.2 * opening, 0.2 * opening)),
        Coordinate(("field_scale",), 1e-6, (0.6, 1.6)),
        Coordinate(("saturation_scale",), 1e-6, (-0.08, 0.05)),
        Coordinate(("rise_beyond_table",), 1e-6, (-0.9, 1.0)),
        Coordinate(("stacking_factor",), 1e-6, (-0.1, -0.04)),
        Coordinate(("edge_damage",), 1e-6, (0.5,)),
        Coordinate(("radial_share",), 1e-6, (-0.4, 0.4)),
        *(Coordinate(("magnet_strengths",), 1e-6, (-0.3, -0.12), k, MAGNET) for k in magnets),
        *(Coordinate(MAGNET_TURNS, 1e-7, (0.012,), k, MAGNET) for k in magnets),
        *(Coordinate(("opening_changes",), 1e-9, (0.15 * opening,), k, SLOT) for k in slots),
        *(Coordinate(path, 1e-9, (0.2 * gap, 0.4 * gap), k, breaks) for path, breaks in SHIFTS for k in (0, 1)),
    )


SHIFTS = ((("stator_shift",), STATOR), (("rotor_shift",), ROTOR))


def arc_of(nominal: MachineAsBuilt) -> Coordinate:
    """The share of a pole pitch that a magnet covers."""
    sizes = LESS_ARC if nominal.machine.magnet_arc_fraction >= 1 else (-0.1, -0.04)
    return Coordinate(("machine", "magnet_arc_fraction"), 1e-6, sizes)


def all_coordinates(nominal: MachineAsBuilt) -> tuple[Coordinate, ...]:
    """Those that are followed smoothly, and the arc of touching magnets."""
    arc = (arc_of(nominal),) if nominal.machine.magnet_arc_fraction >= 1 else ()
    return smooth_coordinates(nominal) + arc


@dataclass(eq=False)
class CoordinateVariation:
    """A coordinate of a design as ``magnetostatics.sensitivity`` asks for it; the changed field models are kept."""

    fields: MachineField
    coordinate: Coordinate
    design: MachineAsBuilt
    whole: bool
    _models: dict[float, FieldModel] = field(default_factory=dict)

    @property
    def step(self) -> float:
        return self.coordinate.step

    def at(self, model: FieldModel, point: OperatingState, change: float) -> tuple[FieldModel, OperatingState]:
        if change not in self._models:
            design = self.coordinate.changed(self.design, change)
            self._models[change] = self.fields.model(design, self.whole)
        return self._models[change], point

    def forget(self) -> None:
        """Give the memory of the changed models back."""
        self._models.clear()


@dataclass(frozen=True)
class CoilVariation:
    """Ampere-turns of one coil of ``CoilCurrents`` [A]."""

    coil: int
    step: float = 1e-2

    def at(self, model: FieldModel, point: CoilCurrents, change: float) -> tuple[FieldModel, CoilCurrents]:
        currents = list(point.coil_ampere_turns)
        currents[self.coil] += change
        return model, replace(point, coil_ampere_turns=tuple(currents))

    def forget(self) -> None:
        """Nothing is kept."""
