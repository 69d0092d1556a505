"""Zero of the force cell."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingOffset
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Even, Power


@dataclass(frozen=True)
class ForceOffset(ReadingOffset):
    """The force cell was not zeroed: F_read = F + offset. A preload of the rod by gas or a seal reads the same."""

    title = "zero of the force cell"
    looks_like = "the same force added in both directions of motion"
    remedy = ("zero the cell unloaded, before and after", "rod disconnected: a preload goes, an offset stays")
    readings = ("force",)
    signature = (
        Power("damping_velocity.force", "velocity", 0.0),
        Even("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "shunt", 0.0),
    )
    base_rate = 0.03
    base_rate_source = "engineering judgement: not zeroed after clamping, one in thirty"

    offset: float = parameter(
        0.0,
        "N",
        prior=Normal(2.0),
        low=-200.0,
        high=200.0,
        source="data sheet class: 0.1 to 1 % of full scale, 0.2 to 2 kN cells",
    )
