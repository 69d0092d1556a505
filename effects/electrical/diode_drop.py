"""Voltage drop of a rectifier."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import CircuitEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Touches


@dataclass(frozen=True)
class DiodeDrop(CircuitEffect):
    """A rectifier keeps a constant voltage to itself, so that a small back-EMF drives no current.

    left(u) = u + (sqrt((u - U)^2 + k^2) - sqrt((u + U)^2 + k^2)) / 2;   ideal: sign(u) max(|u| - U, 0)
    Slope resistance of the diodes is another effect. Source: thesis section 5.2.1 (0.4 V), Sedra and Smith ch. 4.
    """

    title = "voltage drop of a rectifier"
    looks_like = "no braking below a threshold of velocity, a constant loss of voltage above it"
    remedy = ("slow force-velocity points at low shunt", "voltage on both sides of the rectifier")
    signature = (
        Odd("damping_velocity.force", ("velocity",)),
        Touches("back_emf.voltage"),
        Touches("damping_shunt.damping"),
        Touches("impedance.re"),
    )
    model_error = 0.004
    model_error_source = "benchmarks/law_errors.py: against exponential (softplus) bridge"
    base_rate = 0.01
    base_rate_source = "engineering judgement: a rectifier is seldom forgotten, one damper in a hundred"

    drop: float = parameter(
        0.0,
        "V",
        prior=LogNormal(0.5, 1.0),
        low=0.0,
        high=5.0,
        source="thesis section 5.2.1: 0.4 V; data sheet class: silicon bridge 1.4 V",
    )
    knee: float = parameter(
        0.05,
        "V",
        prior=LogNormal(0.05, 0.7),
        low=1e-3,
        high=1.0,
        source="textbook: two diodes at 25 mV of thermal voltage (Sedra and Smith)",
    )

    def left(self, voltage, resistance):
        squares, product = voltage**2 + (self.drop**2 + self.knee**2), 2 * self.drop * voltage
        lengths = np.sqrt(squares - product) + np.sqrt(squares + product)  # of voltage -+ drop with the knee; no hypot:
        return voltage - product / lengths  # it takes four times as long, and a damper is asked thousands of times

    @property
    def is_null(self):
        return self.drop == 0.0
