"""Hysteresis of the torque cell."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingHysteresis
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Touches


@dataclass(frozen=True)
class TorqueHysteresis(ReadingHysteresis):
    """The torque cell reads low while its load rises and high while it falls; see ``ReadingHysteresis`` for the law."""

    title = "hysteresis of the torque cell"
    looks_like = "readings depend on whether the row before had more or less torque; random order makes noise of it"
    remedy = ("weights on and off the cell", "the same points in the reverse order")
    readings = ("torque",)
    signature = (
        Touches("short_circuit.torque"),
        Touches("dq_operation.torque"),
        Touches("cogging.torque"),
        Touches("locked_rotor.torque"),
    )
    base_rate = 0.01
    base_rate_source = "engineering judgement: cells are chosen far above the load, then it shows; one in a hundred"

    level: float = parameter(
        0.0,
        "Nm",
        prior=LogNormal(0.01, 1.0),
        low=0.0,
        high=5,
        source="data sheet class: strain gauge cells, 0.03 to 0.1 % of 10 to 50 Nm",
    )
    width: float = parameter(
        1.0,
        "Nm",
        prior=LogNormal(1.0, 1.0),
        low=0.01,
        high=1000,
        source="engineering judgement: the loop is full after some per cent of the range",
    )

    @property
    def is_null(self):
        return self.level == 0.0
