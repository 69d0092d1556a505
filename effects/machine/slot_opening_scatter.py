"""Scatter of the slot openings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from effects.base import DesignEffect
from effects.machine.around import waves
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from units import MILLIMETRE

_ONE: dict[str, Any] = dict(
    prior=Normal(0.05 * MILLIMETRE),
    low=-0.5 * MILLIMETRE,
    high=0.5 * MILLIMETRE,
    source="punched sheets +-0.02 mm, segments put together +-0.1 mm",
)


@dataclass(frozen=True)
class SlotOpeningScatter(DesignEffect):
    """The slot openings are wider and narrower than their mean round the bore, all a little.

    Part k of n: sum over m = 1, 2, 3 of cosine_m cos(2 pi m k/n) + sine_m sin(2 pi m k/n). Higher waves are left out.
    """

    title = "scatter of the slot openings"
    looks_like = "several cogging orders that are multiples of the poles, no new orders in the voltage"
    remedy = ("width of the openings with gauge blocks",)
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: stators put together from segments have it, punched rings do not"

    cosine_1: float = parameter(0.0, "m", **_ONE)
    sine_1: float = parameter(0.0, "m", **_ONE)
    cosine_2: float = parameter(0.0, "m", **_ONE)
    sine_2: float = parameter(0.0, "m", **_ONE)
    cosine_3: float = parameter(0.0, "m", **_ONE)
    sine_3: float = parameter(0.0, "m", **_ONE)

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        if self.is_null:
            return design
        amplitudes = (self.cosine_1, self.sine_1, self.cosine_2, self.sine_2, self.cosine_3, self.sine_3)
        return design.with_scattered("opening_changes", waves(len(design.opening_changes), amplitudes))
