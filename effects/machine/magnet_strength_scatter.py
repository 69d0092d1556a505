"""Scatter of the magnets' strengths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from effects.base import DesignEffect
from effects.machine.around import waves
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal

_ONE: dict[str, Any] = dict(
    prior=Normal(0.007), low=-0.2, high=0.2, source="magnets of one batch within +-1 to 2 % (makers' data sheets)"
)


@dataclass(frozen=True)
class MagnetStrengthScatter(DesignEffect):
    """The magnets are stronger and weaker than their mean round the rotor, all a little.

    Part k of n: sum over m = 1, 2, 3 of cosine_m cos(2 pi m k/n) + sine_m sin(2 pi m k/n). Higher waves are left out.
    """

    title = "scatter of the magnets' strengths"
    looks_like = "several cogging orders that are multiples of the slots, none of which one weak magnet explains"
    remedy = ("gaussmeter over every pole", "back-EMF of single coils")
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.02
    base_rate_source = "judgement: unsorted magnets are the rule, most scatter by less than a bench can see"

    cosine_1: float = parameter(0.0, "1", **_ONE)
    sine_1: float = parameter(0.0, "1", **_ONE)
    cosine_2: float = parameter(0.0, "1", **_ONE)
    sine_2: float = parameter(0.0, "1", **_ONE)
    cosine_3: float = parameter(0.0, "1", **_ONE)
    sine_3: float = parameter(0.0, "1", **_ONE)

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        if self.is_null:
            return design
        amplitudes = (self.cosine_1, self.sine_1, self.cosine_2, self.sine_2, self.cosine_3, self.sine_3)
        return design.with_scattered("magnet_strengths", waves(len(design.magnet_strengths), amplitudes))
