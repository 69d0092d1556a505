"""Detent (cogging) force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Power, Touches


@dataclass(frozen=True)
class DetentForce(ForceEffect):
    """Magnets pull towards teeth: F = amplitude sin(2 pi x / pitch), which takes no power over a period.

    In the impedance of a rigid mount: Im Z = -2 amplitude J1(2 pi A / pitch) / (A omega). The part that is even about
    mid-stroke has no fundamental at a sine and is left out.
    Source: Hanselman, Brushless Permanent Magnet Motor Design (2003), ch. 4.
    """

    title = "detent (cogging) force"
    looks_like = "imaginary part of the impedance off with 1 / omega, and differently at each amplitude"
    remedy = ("slow pull over the whole stroke, open terminals", "impedance at three amplitudes, low frequency")
    signature = (Touches("impedance.im"), Power("impedance.im", "frequency", -1.0))
    base_rate = 0.02
    base_rate_source = "engineering judgement: every slotted machine has it, most are measured where it averages out"

    amplitude: float = parameter(
        0.0,
        "N",
        prior=LogNormal(5.0, 1.2),
        low=0.0,
        high=1e3,
        source="engineering judgement: 1 to 5 % of rated force of slotted linear machines",
    )
    pitch: float = parameter(
        5e-3,
        "m",
        prior=LogNormal(5e-3, 0.7),
        low=5e-4,
        high=0.2,
        source="geometry: slot pitches 5 to 20 mm, less through a gear",
    )

    def force(self, position, velocity):
        return self.amplitude * np.sin(2 * np.pi * position / self.pitch)

    @property
    def is_null(self):
        return self.amplitude == 0.0
