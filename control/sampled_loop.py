"""The force loop as a controller runs it: asked once a sample, its answer held until the next."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp

from control.errors import ControlError
from control.force_loop import ForceLoop


@dataclass
class SampledLoop:
    """The loop of eq. 4.30 over samples: integral by rectangles, the filter of the derivative exact for held errors.

    loop: the continuous one; sample_time [s]; limit: largest force of the motor at the wheel [N], beyond which the
    integral rests (conditional integration, section 4.2.1)
    integral: of the error since the start [Ns]; filtered: error behind the filter [N]
    """

    loop: ForceLoop
    sample_time: float
    limit: float
    integral: float = 0.0
    filtered: float = 0.0

    def __post_init__(self) -> None:
        if not self.sample_time > 0:
            raise ControlError(f"force loop: its sample time must be above zero, found {self.sample_time:g}; give one")

    def output(self, error: float) -> float:
        """Force that is asked of the motor [N] for an error of the force [N]; moves the states on by a sample."""
        loop, h = self.loop, self.sample_time
        asked = loop.proportional * error + loop.integral * self.integral
        asked += loop.derivative * loop.filter * (error - self.filtered)
        if abs(asked) <= self.limit or asked * error < 0:
            self.integral += h * error
        self.filtered += (1 - exp(-loop.filter * h)) * (error - self.filtered)
        return min(max(asked, -self.limit), self.limit)
