"""Scatter of the magnets' places."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from effects.base import DesignEffect
from effects.machine.around import waves
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from units import DEGREE

_ONE: dict[str, Any] = dict(
    prior=Normal(0.15 * DEGREE), low=-2 * DEGREE, high=2 * DEGREE, source="gluing without pockets, 0.05 to 0.2 mm"
)


@dataclass(frozen=True)
class MagnetPositionScatter(DesignEffect):
    """The magnets sit too far on and too far back round the rotor, all a little.

    Part k of n: sum over m = 1, 2, 3 of cosine_m cos(2 pi m k/n) + sine_m sin(2 pi m k/n). Higher waves are left out.
    """

    title = "scatter of the magnets' places"
    looks_like = (
        "several cogging orders that are multiples of the slots, hardly a trace in the fundamental of the voltage"
    )
    remedy = ("angles between the poles with a gaussmeter",)
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: as gluing by hand"

    cosine_1: float = parameter(0.0, "rad", **_ONE)
    sine_1: float = parameter(0.0, "rad", **_ONE)
    cosine_2: float = parameter(0.0, "rad", **_ONE)
    sine_2: float = parameter(0.0, "rad", **_ONE)
    cosine_3: float = parameter(0.0, "rad", **_ONE)
    sine_3: float = parameter(0.0, "rad", **_ONE)

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        if self.is_null:
            return design
        amplitudes = (self.cosine_1, self.sine_1, self.cosine_2, self.sine_2, self.cosine_3, self.sine_3)
        return design.with_scattered("magnet_turns", waves(len(design.magnet_turns), amplitudes))
