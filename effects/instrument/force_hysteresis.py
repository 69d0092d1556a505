"""Hysteresis of the force cell."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingHysteresis
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Touches


@dataclass(frozen=True)
class ForceHysteresis(ReadingHysteresis):
    """The force cell reads low while its load rises and high while it falls; see ``ReadingHysteresis`` for the law."""

    title = "hysteresis of the force cell"
    looks_like = "readings depend on whether the row before had more or less force; random order makes noise of it"
    remedy = ("weights on and off the cell", "the same points in the reverse order")
    readings = ("force",)
    signature = (Touches("damping_velocity.force"),)
    base_rate = 0.01
    base_rate_source = "engineering judgement: cells are chosen far above the load, then it shows; one in a hundred"

    level: float = parameter(
        0.0,
        "N",
        prior=LogNormal(0.5, 1.0),
        low=0.0,
        high=250,
        source="data sheet class: strain gauge cells, 0.03 to 0.1 % of 0.5 to 5 kN",
    )
    width: float = parameter(
        50.0,
        "N",
        prior=LogNormal(50.0, 1.0),
        low=0.5,
        high=50000,
        source="engineering judgement: the loop is full after some per cent of the range",
    )

    @property
    def is_null(self):
        return self.level == 0.0
