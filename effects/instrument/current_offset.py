"""Zero of one current channel."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import InstrumentEffect
from effects.instrument.readings import changed, one_a_phase
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Touches


@dataclass(frozen=True)
class CurrentOffset(InstrumentEffect):
    """One current probe has a zero error: the current of that phase is truly i_x,read - offset.

    On a dq bench the offset of a phase turns with the rotor and averages out, so it is no effect there.
    """

    title = "zero of one current channel"
    looks_like = "torque without the set current that turns with the angle as that phase's would; back-EMF right"
    remedy = ("open the circuit and read", "degauss the probe")
    designs = (MachineAsBuilt,)
    signature = (
        Touches("locked_rotor.torque"),
        Touches("flux_linkage.dpsi_a"),
    )
    base_rate = 0.03
    base_rate_source = "engineering judgement: Hall probes that nobody zeroed, one bench in thirty"

    phase: str = "a"
    offset: float = parameter(
        0.0, "A", prior=Normal(0.3), low=-20.0, high=20.0, source="data sheet class: Hall probes, 0.5 % of 50 to 100 A"
    )

    @classmethod
    def variants(cls, design):
        return one_a_phase(cls)

    def on_condition(self, conditions, kind):
        return changed(conditions, (f"i_{self.phase}",), lambda read: read - self.offset)
