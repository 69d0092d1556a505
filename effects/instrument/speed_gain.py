"""Gain of the speed measurement."""

from __future__ import annotations

from dataclasses import dataclass

from effects.instrument.readings import ReadingGain
from effects.parameter import parameter
from effects.prior import Normal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class SpeedGain(ReadingGain):
    """The velocity or speed reads too much: v = v_read / (1 + gain). Impedance and damping, F / v_read, read
    too little."""

    title = "gain of the speed measurement"
    looks_like = "back-EMF and damping off by the same share"
    remedy = ("count revolutions or travel over a minute",)
    readings = ()
    inverse_readings = ("re", "im", "damping")
    set_points = ("speed", "velocity", "amplitude")
    signature = (
        Power("damping_velocity.force", "velocity", 1.0),
        Power("back_emf.voltage", "velocity", 1.0),
        Touches("damping_shunt.damping"),
        Touches("impedance.re"),
        Touches("impedance.im"),
        Touches("dq_operation.v_d"),
        Touches("short_circuit.*"),
        Touches("dq_supply.*"),
        Touches("back_emf.v_?"),
        Power("back_emf.v_ll", "speed", 1.0),
        Power("dq_operation.v_q", "speed", 1.0),
    )
    base_rate = 0.02
    base_rate_source = "engineering judgement: pulses per turn or tacho constant a little off, one bench in fifty"

    gain: float = parameter(
        0.0, "1", prior=Normal(0.02), low=-0.3, high=0.3, source="data sheet class: tachogenerators 1 to 3 %"
    )
