"""Dynamic eccentricity."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.machine.eccentricity import Eccentricity
from effects.machine_design import MachineAsBuilt


@dataclass(frozen=True)
class DynamicEccentricity(Eccentricity):
    """The rotor stands beside the axis it turns about: the narrowest gap turns with it.

    The shift is ``share`` of the air gap in ``direction``, from the axis of magnet 0.
    """

    title = "dynamic eccentricity"
    looks_like = "faint cogging orders near multiples of the slots; even in its size for a machine of two alike halves"
    base_rate = 0.02
    base_rate_source = "judgement: bent or badly centred rotors of prototypes"

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        if self.is_null:
            return design
        return replace(design, rotor_shift=self.beyond(design.rotor_shift, design.machine.airgap))
