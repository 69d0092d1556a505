"""The force loop of an actuator: a PID with a filtered derivative in parallel structure (thesis eq. 4.30)."""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import isfinite

from control.errors import ControlError
from control.transfer import TransferFunction


@dataclass(frozen=True)
class ForceLoop:
    """u = P e + I / s e + D s / (s / N + 1) e: force of the motor for the error of the force at the suspension.

    proportional: P, dimensionless; integral: I [1/s]; derivative: D [s]; filter: N [rad/s]
    Table 4.5 gives I in N/s and D in Ns; only with a force for a force do its numbers make a loop that holds.
    The motor's limit bounds u, and the integral rests meanwhile (dynamic saturation, conditional integration).
    Raises ControlError for a negative gain, or a derivative without a filter.
    """

    proportional: float
    integral: float
    derivative: float
    filter: float

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not (isfinite(value) and value >= 0):
                raise ControlError(f"force loop: {field.name} must not be negative, found {value:g}; correct it")
        if self.derivative > 0 and self.filter == 0:
            raise ControlError("force loop: a derivative needs a filter above zero, found 0 rad/s; give one")

    @property
    def transfer(self) -> TransferFunction:
        """u over e, dimensionless."""
        p, i, d = self.proportional, self.integral, self.derivative
        if self.derivative == 0:
            return TransferFunction((p, i), (1.0, 0.0))
        n = self.filter
        return TransferFunction((p / n + d, p + i / n, i), (1 / n, 1.0, 0.0))
