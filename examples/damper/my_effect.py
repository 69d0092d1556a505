"""The force constant falls towards the ends of the stroke, where the coil leaves the field of its magnets."""

from dataclasses import dataclass

import numpy as np

from effects.law_effects import CouplingEffect
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class ForceConstantOverStroke(CouplingEffect):
    """K(x) = K cos(k x): the sine-shaped field of a row of magnets with pole pitch pi / k, coil in the middle."""

    title = "force constant over the stroke"
    looks_like = "damping at large amplitude is below that at small amplitude, at every frequency"
    remedy = ("open-circuit voltage at both ends of the stroke",)

    wave_number: float = parameter(
        0.0, "rad/m", prior=LogNormal(100.0, 0.7), low=0.0, high=600.0, source="pole pitches of 10 to 100 mm"
    )

    def coupling(self, position, current):
        return np.cos(self.wave_number * position)
