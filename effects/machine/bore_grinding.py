"""Bore ground wider."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.grinding import ground_depth
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt


@dataclass(frozen=True)
class BoreGrinding(DesignEffect):
    """The bore was ground wider than drawn; the slots stay, so that their shoes are thinner: g + depth, d_1 - depth."""

    title = "bore ground wider"
    looks_like = "as a larger gap, with thinner shoes that saturate earlier"
    remedy = ("bore diameter", "thickness of the shoes")
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: where fits are made by hand"

    depth: float = ground_depth("bores honed after stacking, 0.02 to 0.1 mm")

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        return replace(design, bore_grinding=design.bore_grinding + self.depth)
