"""Drift of the voltage measurement."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from effects.dq_design import DqMachine
from effects.instrument.readings import ReadingDrift, one_a_phase
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Like


@dataclass(frozen=True)
class VoltageDrift(ReadingDrift):
    """The zero of one voltage channel drifts through each scan: V_read = V + drift * order, order from 0 to 1.

    No effect on a dq bench, for the reason given at ``VoltageOffset``.
    """

    title = "drift of the voltage measurement"
    looks_like = "residual voltage of one channel that grows with the order of acquisition"
    remedy = ("repeat the first point at the end",)
    signature = (
        Like("back_emf.voltage", lambda at: at["order"]),
        Like("back_emf.v_a", lambda at: at["order"]),
    )
    base_rate = 0.01
    base_rate_source = "engineering judgement: half as often as a zero that is off from the start"

    phase: str = ""  # a, b or c; the only channel when empty
    drift: float = parameter(
        0.0,
        "V",
        prior=Normal(0.05),
        low=-10.0,
        high=10.0,
        source="data sheet class: warming amplifiers, 0.1 % of range",
    )

    @classmethod
    def can_act_on(cls, design: Any) -> bool:
        return not isinstance(design, DqMachine)

    @classmethod
    def variants(cls, design: Any) -> tuple[VoltageDrift, ...]:
        return one_a_phase(cls) if isinstance(design, MachineAsBuilt) else (cls(),)

    @property
    def readings(self) -> tuple[str, ...]:
        return (f"v_{self.phase}",) if self.phase else ("voltage",)
