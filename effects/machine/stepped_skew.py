"""Rotor segments turned against each other."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal
from units import DEGREE


@dataclass(frozen=True)
class SteppedSkew(DesignEffect):
    """The rotor is made of two or three segments, each turned by ``angle`` against its neighbour; the number is an
    alternative.

    Every order m over the revolution is multiplied by sin(n m angle/2)/(n sin(m angle/2)) for n segments.
    """

    title = "rotor segments turned against each other"
    looks_like = "as skew: cogging falls most, then the higher harmonics of the voltage; the highest orders come back"
    remedy = ("look along the magnets", "cogging", "high orders of the back-EMF")
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: rotors put together from segments only"

    segments: int = 2
    angle: float = parameter(
        0.0, "rad", prior=LogNormal(0.7 * DEGREE, 0.7), low=0.0, high=10 * DEGREE, source="keys and gluing jigs"
    )

    @classmethod
    def variants(cls, design: MachineAsBuilt) -> tuple[SteppedSkew, ...]:
        return cls(segments=2), cls(segments=3)

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        place = self.segments - 2
        return design.with_one("segment_angles", place, design.segment_angles[place] + self.angle)
