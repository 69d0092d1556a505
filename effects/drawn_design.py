"""A machine of any kind on the bench as the effects see it: as drawn, and where all of it may differ as built."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from math import isclose

from effects.machine_design import BuiltMachine
from geometry.half_cell import MeshDensity
from geometry.parts import ComposedMachine, Part
from geometry.winding import WindingLayout
from materials.iron_loss import IronLossLaw
from materials.magnet import Magnet
from materials.reluctivity import Reluctivity


@dataclass(frozen=True, eq=False)
class Drawing:
    """What no effect changes of a machine.

    machine: with the dimensions as drawn;  stator_steel, rotor_steel: grades;  density: how finely it is meshed
    """

    machine: ComposedMachine
    layout: WindingLayout
    stator_steel: Reluctivity
    rotor_steel: Reluctivity
    density: MeshDensity


@dataclass(frozen=True)
class DrawnAsBuilt(BuiltMachine):
    """A stator and a rotor of any kind. All poles, slots and coils are alike: no defect of a single one is in here.

    machine: dimensions as built;  length: active length [m];  turns: of every coil, all coils of a phase in series [1]
    phase_resistance: of a phase at 20 degC [ohm];  end_winding_inductance: of a phase [H]
    largest_current: of a phase on its bench, peak, up to which flux linkages are mapped [A]
    copper_area: of a turn [m^2], zero where the wire is not known;  the others as in ``MachineAsBuilt``
    """

    drawing: Drawing
    machine: ComposedMachine
    magnet: Magnet
    length: float
    turns: float
    phase_resistance: float = 0.0
    end_winding_inductance: float = 0.0
    field_scale: float = 1.0
    saturation_scale: float = 1.0
    stacking_factor: float = 1.0
    end_leakage: float = 0.0
    dry_friction: float = 0.0
    viscous_friction: float = 0.0
    windage: float = 0.0
    iron_loss: IronLossLaw | None = None
    iron_loss_factor: float = 1.0
    largest_current: float = 0.0
    copper_area: float = 0.0

    def with_airgap(self, change: float) -> DrawnAsBuilt:
        stator, rotor = self.machine.stator, self.machine.rotor
        outwards = change if stator.rim_radius > rotor.rim_radius else -change
        name = rim_field(stator)
        return self.with_dimension("stator", name, getattr(stator, name) + outwards)

    def with_dimension(self, part: str, name: str, value: float) -> DrawnAsBuilt:
        """Another length or angle [m or rad] of the "stator" or the "rotor"."""
        changed = replace(getattr(self.machine, part), **{name: value})
        return replace(self, machine=replace(self.machine, **{part: changed}))

    def with_turns(self, factor: float) -> DrawnAsBuilt:
        """``factor`` times the turns in the same slots: as much more resistance of thinner wire, factor^2."""
        return replace(self, turns=self.turns * factor, phase_resistance=self.phase_resistance * factor**2)


def rim_field(part: Part) -> str:
    """Name of the dimension of a part that is the radius of its rim."""
    named = [one.name for one in fields(part)]  # type: ignore[arg-type]
    return next(name for name in named if name.endswith("radius") and isclose(getattr(part, name), part.rim_radius))
