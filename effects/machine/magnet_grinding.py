"""Magnets ground thinner."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.grinding import ground_depth
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt


@dataclass(frozen=True)
class MagnetGrinding(DesignEffect):
    """The magnets were ground to a smaller radius than drawn; rotor core and stator stay: l_m - depth, g + depth."""

    title = "magnets ground thinner"
    looks_like = "voltage and torque fall more than by a larger gap alone, the inductance rises hardly"
    remedy = ("diameter over the magnets", "thickness of a spare magnet")
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: where fits are made by hand"

    depth: float = ground_depth("rotors ground after gluing, +-0.05 mm")

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        return replace(design, magnet_grinding=design.magnet_grinding + self.depth)
