"""Gain of one voltage channel."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingGain, one_a_phase
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Touches


@dataclass(frozen=True)
class PhaseVoltageGain(ReadingGain):
    """One of three voltage channels reads too much: v_x,read = (1 + gain) v_x; flux linkage, its integral, too."""

    title = "gain of one voltage channel"
    looks_like = "one phase off by a share in voltage and flux linkage, its resistance and all torques right"
    remedy = ("exchange the channels",)
    designs = (MachineAsBuilt,)
    signature = (Touches("back_emf.v_a"), Touches("flux_linkage.dpsi_a"))
    base_rate = 0.02
    base_rate_source = "engineering judgement: one divider of three, one bench in fifty"

    phase: str = "a"
    gain: float = parameter(
        0.0, "1", prior=Normal(0.01), low=-0.3, high=0.3, source="data sheet class: resistors of dividers, 1 %"
    )

    @classmethod
    def variants(cls, design):
        return one_a_phase(cls)

    @property
    def readings(self):
        return (f"v_{self.phase}", f"psi_{self.phase}", f"dpsi_{self.phase}")
