"""Gain of the speed measurement."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingGain
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class SpeedGain(ReadingGain):
    """The velocity or speed reads too much: v = v_read / (1 + gain). Impedance, F / v_read, reads too little."""

    title = "gain of the speed measurement"
    looks_like = "back-EMF and damping off by the same share"
    remedy = ("count revolutions or travel over a minute",)
    readings = ()
    inverse_readings = ("re", "im")
    set_points = ("speed", "velocity", "amplitude")

    gain: float = parameter(0.0, "1", prior=Normal(0.02), low=-0.3, high=0.3, source="tachogenerators 1 to 3 %")
