"""Static eccentricity."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.machine.eccentricity import Eccentricity
from effects.machine_design import MachineAsBuilt


@dataclass(frozen=True)
class StaticEccentricity(Eccentricity):
    """The stator stands beside the axis of rotation: the narrowest gap stays in one place.

    The shift is ``share`` of the air gap in ``direction``.
    """

    title = "static eccentricity"
    looks_like = "faint cogging orders near multiples of the poles; even in its size for a machine of two alike halves"
    base_rate = 0.03
    base_rate_source = "judgement: bearing seats and end shields of prototypes"
    # NGSolve has 10 % less (12 slots, 10 poles) and 15 % more (9, 8) cogging of the order of the poles than the mesh
    # of a bench model; on 720 edges in 360's place 3 % of the second remain.
    model_error = 0.12

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        if self.is_null:
            return design
        return replace(design, stator_shift=self.beyond(design.stator_shift, design.machine.airgap))
