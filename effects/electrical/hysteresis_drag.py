"""Hysteresis drag of the iron."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.law_effects import ForceEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches

REVERSAL = 1e-4  # m/s, rounds the reversal; the build-up over the distance is far wider


@dataclass(frozen=True)
class HysteresisDrag(ForceEffect):
    """Magnetic hysteresis of the iron: a drag that does not depend on velocity and builds up over a distance.

    After a turn at -A:  F = level (1 - 2 exp(-(x + A) / d) / (1 + exp(-2 A / d))), mirrored on the way back; the
    rate-independent loop of Dahl (1968). At constant velocity F = level sign(v), as Coulomb friction.
    """

    title = "hysteresis drag of the iron"
    looks_like = "as Coulomb friction at constant velocity, but smaller and springy at small amplitude"
    remedy = ("impedance at two amplitudes", "drag with a dummy without magnets")
    signature = (
        Odd("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "velocity", 0.0),
        Power("impedance.re", "frequency", -1.0, 4.0),
        Touches("impedance.im"),
    )
    model_error = 0.07
    size_error = 0.255
    model_error_source = "benchmarks/law_errors.py: against Dahl's law with the exponent 2"
    base_rate = 0.02
    base_rate_source = "engineering judgement: slotted machines have it, one in fifty above its friction"

    level: float = parameter(
        0.0,
        "N",
        prior=LogNormal(5.0, 1.5),
        low=0.0,
        high=1e3,
        source="engineering judgement: 1 to 5 % of rated force of slotted machines",
    )
    distance: float = parameter(
        1e-3,
        "m",
        prior=LogNormal(1e-3, 0.5),
        low=1e-5,
        high=0.05,
        source="engineering judgement: a tenth of a tooth pitch",
    )

    def force(self, position, velocity):
        direction = np.tanh(velocity / REVERSAL)
        amplitude = np.abs(position).max(axis=-1, keepdims=True) if position.ndim > 1 else np.inf
        gone = np.exp(-(position * np.sign(velocity) + amplitude) / self.distance)
        return self.level * direction * (1.0 - 2.0 * gone / (1.0 + np.exp(-2.0 * amplitude / self.distance)))

    @property
    def is_null(self):
        return self.level == 0.0
