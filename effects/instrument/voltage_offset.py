"""Zero of the voltage measurement."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from effects.dq_design import DqMachine
from effects.instrument.readings import ReadingOffset, one_a_phase
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Even, Orders, Power


@dataclass(frozen=True)
class VoltageOffset(ReadingOffset):
    """One voltage channel has a zero error: V_read = V + offset. Three phases have three channels, each its own zero.

    No effect on a dq bench: an offset o of phase a is 2/3 o (cos theta, -sin theta) in v_d, v_q. It turns with the
    rotor and averages out of every steady reading, and line-to-line RMS sees it in second order only.
    """

    title = "zero of the voltage measurement"
    looks_like = "the same voltage added at every speed and angle, on one channel"
    remedy = ("short the leads and read",)
    signature = (
        Power("back_emf.voltage", "velocity", 0.0),
        Even("back_emf.voltage", ("velocity",)),
        Orders("back_emf.v_a", (0,)),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: amplifier not zeroed, one bench in fifty"

    phase: str = ""  # a, b or c; the only channel when empty
    offset: float = parameter(
        0.0,
        "V",
        prior=Normal(0.05),
        low=-10.0,
        high=10.0,
        source="data sheet class: amplifier zero, 0.1 % of 10 to 100 V",
    )

    @classmethod
    def can_act_on(cls, design: Any) -> bool:
        return not isinstance(design, DqMachine)

    @classmethod
    def variants(cls, design: Any) -> tuple[VoltageOffset, ...]:
        return one_a_phase(cls) if isinstance(design, MachineAsBuilt) else (cls(),)

    @property
    def readings(self) -> tuple[str, ...]:
        return (f"v_{self.phase}",) if self.phase else ("voltage",)
