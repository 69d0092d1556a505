"""Gain of one current channel."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingGain, one_a_phase
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Touches


@dataclass(frozen=True)
class PhaseCurrentGain(ReadingGain):
    """One of three current probes reads too much: the current of that phase is truly i_x,read / (1 + gain)."""

    title = "gain of one current channel"
    looks_like = "torque and flux linkage under current off with the current of one phase, back-EMF right"
    remedy = ("all probes round one conductor",)
    designs = (MachineAsBuilt,)
    readings = ()
    signature = (
        Touches("locked_rotor.torque"),
        Touches("flux_linkage.dpsi_a"),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: one probe of three, one bench in fifty"

    phase: str = "a"
    gain: float = parameter(
        0.0, "1", prior=Normal(0.01), low=-0.3, high=0.3, source="data sheet class: clamp-on Hall probes, 1 %"
    )

    @classmethod
    def variants(cls, design):
        return one_a_phase(cls)

    @property
    def set_points(self):
        return (f"i_{self.phase}",)
