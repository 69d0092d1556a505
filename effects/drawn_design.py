"""A machine of any kind on the bench as the effects see it: as drawn, and where all of it may differ as built."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from math import isclose

import numpy as np

from effects.machine_design import BuiltMachine
from geometry.half_cell import MeshDensity
from geometry.parts import ComposedMachine, Part
from geometry.winding import WindingLayout
from materials.reluctivity import Reluctivity


@dataclass(frozen=True, eq=False)
class Drawing:
    """What no effect changes of a machine.

    machine: with the dimensions as drawn;  stator_steel, rotor_steel: grades;  density: how finely it is meshed
    end_turn: length of one [m]
    coil_currents: of A, B and C over the currents of the three lines (3, 3) [1], in a delta without what goes round it
    star_lag: of the equivalent star behind the coils, electrical [rad];  is_delta: whether a current goes round
    """

    machine: ComposedMachine
    layout: WindingLayout
    stator_steel: Reluctivity
    rotor_steel: Reluctivity
    density: MeshDensity
    end_turn: float
    coil_currents: np.ndarray = field(default_factory=lambda: np.eye(3))
    star_lag: float = 0.0
    is_delta: bool = False


@dataclass(frozen=True)
class DrawnAsBuilt(BuiltMachine):
    """A stator and a rotor of any kind. All poles, slots and coils are alike: no defect of a single one is in here.

    Currents, flux linkages and what follows from them are those of the equivalent star that the terminals see.
    machine: dimensions as built;  turns: of every coil [1]
    phase_resistance: of a phase of the star at 20 degC [ohm], half of what is between two terminals, in the mean
    resistance_shares: of A, B and C over that mean [1]; under load all phases count as alike
    largest_current: of a phase on its bench, peak, up to which flux linkages are mapped [A]
    copper_area: of a turn [m^2], zero where the wire is not known
    """

    drawing: Drawing
    machine: ComposedMachine
    turns: float
    phase_resistance: float = 0.0
    largest_current: float = 0.0
    copper_area: float = 0.0
    resistance_shares: tuple[float, float, float] = (1.0, 1.0, 1.0)

    @property
    def phase_resistances(self) -> tuple[float, float, float]:
        """Of A, B and C of the star at 20 degC [ohm]."""
        a, b, c = self.resistance_shares
        return a * self.phase_resistance, b * self.phase_resistance, c * self.phase_resistance

    @cached_property
    def in_field(self) -> DrawnAsBuilt:
        """The design with what its field does not know left out, so that alike fields are found again."""
        magnet = replace(self.magnet, temperature_coefficient=0.0, reference_temperature=0.0)
        return DrawnAsBuilt(
            self.drawing,
            self.machine,
            turns=1.0,
            magnet=magnet,
            length=1.0,
            field_scale=self.field_scale,
            saturation_scale=self.saturation_scale,
            stacking_factor=self.stacking_factor,
        )

    @cached_property
    def field_name(self) -> str:
        """The same for designs of a drawing whose fields are alike; an outline has hundreds of curves to be read."""
        d = self.in_field
        words = repr((d.machine, d.magnet, d.field_scale, d.saturation_scale, d.stacking_factor))
        return hashlib.sha256(words.encode()).hexdigest()[:16]

    def with_phase_resistances(self, a: float, b: float, c: float) -> DrawnAsBuilt:
        """Those of the three phases [ohm]."""
        mean = (a + b + c) / 3
        return replace(self, phase_resistance=mean, resistance_shares=(a / mean, b / mean, c / mean))

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
