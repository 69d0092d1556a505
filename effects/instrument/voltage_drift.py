"""Drift of the voltage measurement."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingDrift
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class VoltageDrift(ReadingDrift):
    """The voltmeter's zero drifts through each scan: V_read = V + drift * order, order from 0 to 1."""

    title = "drift of the voltage measurement"
    looks_like = "residual voltage that grows with the order of acquisition"
    remedy = ("repeat the first point at the end",)
    readings = ("voltage", "v_[abcdq]")

    drift: float = parameter(0.0, "V", prior=Normal(0.05), low=-10.0, high=10.0, source="warming amplifiers")
