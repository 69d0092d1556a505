"""Drift of the torque cell."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingDrift
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Like, Touches


@dataclass(frozen=True)
class TorqueDrift(ReadingDrift):
    """The torque cell's zero drifts through each scan: T_read = T + drift * order, order from 0 to 1."""

    title = "drift of the torque cell"
    looks_like = "residual that grows with the order of acquisition, whatever is measured"
    remedy = ("repeat the first point at the end", "random order of points")
    readings = ("torque",)
    signature = (
        Like("dq_operation.torque", lambda at: at["order"]),
        Like("cogging.torque", lambda at: at["order"]),
        Touches("drag.torque"),
        Touches("short_circuit.torque"),
        Touches("locked_rotor.torque"),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: no warm-up before the first scan, one in fifty"

    drift: float = parameter(
        0.0,
        "Nm",
        prior=Normal(0.02),
        low=-5.0,
        high=5.0,
        source="data sheet class: 0.02 % of full scale per kelvin, 10 to 50 Nm cells",
    )
