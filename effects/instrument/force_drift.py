"""Drift of the force cell."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingDrift
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Like


@dataclass(frozen=True)
class ForceDrift(ReadingDrift):
    """The force cell's zero drifts through each scan: F_read = F + drift * order, order from 0 to 1."""

    title = "drift of the force cell"
    looks_like = "residual that grows with the order of acquisition, whatever is measured"
    remedy = ("repeat the first point at the end", "random order of points")
    readings = ("force",)
    signature = (Like("damping_velocity.force", lambda at: at["order"]),)
    base_rate = 0.02
    base_rate_source = "engineering judgement: no warm-up before the first scan, one in fifty"

    drift: float = parameter(
        0.0,
        "N",
        prior=Normal(2.0),
        low=-200.0,
        high=200.0,
        source="data sheet class: 0.02 % of full scale per kelvin, 0.5 to 5 kN cells",
    )
