"""How long a ball bearing lives under a steady radial load."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi


@dataclass(frozen=True)
class Bearing:
    """Either bearing of the rotor: dynamic_capacity C [N] of its data sheet, life: wanted [s], None where none is."""

    dynamic_capacity: float
    life: float | None

    def rating_life(self, load: float, speed: float) -> float:
        """L_10 [s], (C/P)^3 million turns at a speed [rad/s] under a radial load P [N]; infinite without either.

        Ball bearings under a radial load alone, rotating, reliability of 90 %. Source: ISO 281.
        """
        if not (load and speed):
            return inf
        turns = 1e6 * (self.dynamic_capacity / load) ** 3
        return turns * 2 * pi / speed
