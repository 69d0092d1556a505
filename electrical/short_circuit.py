"""A machine whose phases are short-circuited: a damper that needs no power."""

from __future__ import annotations


def shaft_damping(*, torque_constant: float, phase_resistance: float) -> float:
    """Damping of a wound machine in short circuit at its shaft, 2 K_t^2 / (3 R_ph) [Nms/rad].

    torque_constant: [Nm per peak ampere]; phase_resistance: [ohm]. Well below the electrical pole, p omega << R/L.
    """
    return 2 * torque_constant**2 / (3 * phase_resistance)


def winding_damping(*, torque_constant: float, phase_resistance: float, transmission_ratio: float) -> float:
    """The same behind a transmission, 2 K_t^2 / (3 R_ph tau_t^2) [Ns/m] (3.75).

    torque_constant: K_t [Nm per peak ampere]; transmission_ratio: tau_t [m/rad]
    """
    return shaft_damping(torque_constant=torque_constant, phase_resistance=phase_resistance) / transmission_ratio**2
