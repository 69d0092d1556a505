"""What is asked of the machine at its own shaft, whatever it drives."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ShaftDemand:
    """Demands at the rotor, magnitudes.

    base_speed: up to which the full torque is asked [rad/s]; power: to be reached at the base speed [W]
    torque_peak: for short times, at the overload current density [Nm]
    torque_rms: for good [Nm]
    damping: of the short-circuited machine [Nms/rad], 0 where none is asked for
    """

    base_speed: float
    power: float
    torque_peak: float
    torque_rms: float
    damping: float
