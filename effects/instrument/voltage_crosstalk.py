"""Crosstalk between voltage channels."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations

from effects.base import InstrumentEffect
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Touches

QUANTITIES = ("v", "psi", "dpsi")  # voltages, and flux linkages that are integrals of them


@dataclass(frozen=True)
class VoltageCrosstalk(InstrumentEffect):
    """A channel shows a share of another: v_x,read = v_x + share v_y, flux linkages from their integrals likewise."""

    title = "crosstalk between voltage channels"
    looks_like = "one phase voltage off by a share of another phase, as if its zero were shifted and its size off"
    remedy = ("short one input and drive the other",)
    designs = (MachineAsBuilt,)
    signature = (Touches("back_emf.v_a"), Touches("flux_linkage.dpsi_a"))
    base_rate = 0.01
    base_rate_source = "engineering judgement: multiplexed inputs behind high-ohmic dividers, one bench in a hundred"

    into: str = "a"
    of: str = "b"
    share: float = parameter(
        0.0,
        "1",
        prior=Normal(0.005),
        low=-0.2,
        high=0.2,
        source="data sheet class: -40 to -80 dB, the worst with unbuffered dividers",
    )

    @classmethod
    def variants(cls, design: MachineAsBuilt) -> tuple[VoltageCrosstalk, ...]:
        return tuple(cls(into=x, of=y) for x, y in permutations("abc", 2))

    def on_reading(self, response, conditions, kind):
        pairs = [(f"{q}_{self.into}", f"{q}_{self.of}") for q in QUANTITIES]
        shown = {x: response[x] + self.share * response[y] for x, y in pairs if x in response and y in response}
        return {**response, **shown}
