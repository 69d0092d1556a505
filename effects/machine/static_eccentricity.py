"""Static eccentricity."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, pi, sin

from effects.base import DesignEffect
from effects.machine.places import LEAKAGE
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal, Uniform


@dataclass(frozen=True)
class StaticEccentricity(DesignEffect):
    """The stator stands beside the axis of rotation: the narrowest gap stays in one place.

    The shift is ``share`` of the air gap in ``direction``.
    """

    title = "static eccentricity"
    looks_like = "faint cogging orders near multiples of the poles; even in its size for a machine of two alike halves"
    remedy = ("run-out with a dial gauge", "bearing force", "back-EMF of single coils")
    designs = (MachineAsBuilt,)
    signature = LEAKAGE
    base_rate = 0.03
    base_rate_source = "judgement: bearing seats and end shields of prototypes"
    # NGSolve has 10 % less (12 slots, 10 poles) and 15 % more (9, 8) cogging of the order of the poles than the mesh of a
    # bench model; on 720 edges in 360's place 3 % of the second remain.
    model_error = 0.12

    share: float = parameter(
        0.0, "1", prior=LogNormal(0.2, 0.5), low=0.0, high=0.45, source="gaps of small machines, 10 to 40 %"
    )
    direction: float = parameter(0.0, "rad", prior=Uniform(-pi, pi), low=-pi, high=pi, source="any")

    @property
    def is_null(self) -> bool:
        return self.share == 0.0

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        if self.is_null:
            return design
        amount, (x, y) = self.share * design.machine.airgap, design.stator_shift
        return replace(design, stator_shift=(x + amount * cos(self.direction), y + amount * sin(self.direction)))
