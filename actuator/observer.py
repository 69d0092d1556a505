"""The force of an actuator at the suspension from motor current and rotor angle, without a load cell (section 6.1)."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, pi

import numpy as np

from actuator.errors import require_positive
from actuator.model import Actuator


@dataclass
class ForceObserver:
    """A disturbance observer over samples: what the mass does beyond motor and friction is the force on it.

    F_m = LP((m v)' - m'(x) v^2 / 2 + friction(v) + T / tau),   LP = w_o / (s + w_o),   m = J / tau^2

    with x and v from the angle by differences over a sample; F at the suspension from F_m by the loss of the gears.
    Everything is taken at the sample before: there the second difference of the angle is centred, and a torque of
    another instant would come back through the loop as if it were a force.
    The principle is that of Ohnishi, Shibata and Murakami, IEEE/ASME Transactions on Mechatronics 1 (1996).
    actuator: the model; sample_time [s]; bandwidth: w_o / (2 pi) [Hz]
    angle: of the rotor at the last sample [rad]; stroke: of the mass there [m]; velocity: of the mass over the sample
    before it [m/s]; momentum: m v [kg m/s]; torque: of the last sample [Nm]; estimate: of F_m [N]
    """

    actuator: Actuator
    sample_time: float
    bandwidth: float
    angle: float = 0.0
    stroke: float = 0.0
    velocity: float = 0.0
    momentum: float = 0.0
    torque: float = 0.0
    estimate: float = 0.0

    def __post_init__(self) -> None:
        require_positive("force observer", sample_time=self.sample_time, bandwidth=self.bandwidth)

    def force(self, angle: float, torque: float) -> float:
        """At the suspension [N], after one more sample; angle: of the rotor [rad]; torque: from the current [Nm]."""
        moved = float(self.actuator.ratio.at(self.stroke)) * (angle - self.angle)
        found, middle = self._balance(moved / self.sample_time)
        self.angle, self.torque, self.stroke = angle, torque, self.stroke + moved
        self.estimate += (1 - exp(-2 * pi * self.bandwidth * self.sample_time)) * (found - self.estimate)
        return self._through_gears(self.estimate, middle)

    def _balance(self, velocity: float) -> tuple[float, float]:
        """F_m [N] and v [m/s] at the last sample; velocity: of the mass over the sample that follows it [m/s]."""
        ratio, h = self.actuator.ratio, self.sample_time
        before, tau, after = (float(ratio.at(self.stroke + d)) for d in (-h * self.velocity, 0.0, h * velocity))
        middle, scale = (velocity + self.velocity) / 2, (ratio.nominal / tau) ** 2
        momentum = self.actuator.equivalent_mass * (2 * ratio.nominal / (tau + after)) ** 2 * velocity
        bending = -self.actuator.equivalent_mass * scale * (after - before) / (2 * h * tau) * middle
        found = (momentum - self.momentum) / h - bending + self._friction(middle, scale) + self.torque / tau
        self.velocity, self.momentum = velocity, momentum
        return found, middle

    def _friction(self, velocity: float, scale: float) -> float:
        loss = self.actuator.loss
        return loss.viscous * scale * velocity + loss.coulomb * self._sense(velocity)

    def _through_gears(self, force: float, velocity: float) -> float:
        """Force in front of the gears [N], from the one behind them."""
        gears, sense = self.actuator.gears, self._sense(velocity)
        share = gears.driven - 1 if force * sense > 0 else 1 / gears.driving - 1
        return force / (1 + share * abs(sense))

    def _sense(self, velocity: float) -> float:
        return float(np.clip(velocity / self.actuator.loss.breakaway_speed, -1.0, 1.0))
