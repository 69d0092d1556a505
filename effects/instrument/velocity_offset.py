"""Zero of the velocity measurement."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import InstrumentEffect
from effects.damper_design import Damper
from effects.instrument.readings import changed
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Even, Power


@dataclass(frozen=True)
class VelocityOffset(InstrumentEffect):
    """The velocity sensor was not zeroed: the velocity is truly v_read - offset. At a sine it has no fundamental."""

    title = "zero of the velocity measurement"
    looks_like = "a force added in both directions that is larger at low shunt, and the same voltage at every speed"
    remedy = ("read the sensor at standstill",)
    designs = (Damper,)
    signature = (
        Even("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "velocity", 0.0),
        Power("back_emf.voltage", "velocity", 0.0),
    )
    base_rate = 0.01
    base_rate_source = "engineering judgement: velocities mostly come from a position, which has no such zero"

    offset: float = parameter(
        0.0, "m/s", prior=Normal(1e-3), low=-0.1, high=0.1, source="data sheet class: tachogenerators 0.1 % of 1 m/s"
    )

    def on_condition(self, conditions, kind):
        return changed(conditions, ("velocity",), lambda read: read - self.offset)
