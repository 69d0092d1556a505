"""A machine whose phases are short-circuited: a damper that needs no power."""

from __future__ import annotations


def winding_damping(*, torque_constant: float, phase_resistance: float, transmission_ratio: float) -> float:
    """Damping of a wound machine in short circuit, 2 K_t^2 / (3 R_ph tau_t^2) [Ns/m] (3.75).

    torque_constant: [Nm per peak ampere]; phase_resistance: [ohm]; transmission_ratio: [m/rad]. Well below the
    electrical pole, p omega << R/L.
    """
    return 2 * torque_constant**2 / (3 * phase_resistance * transmission_ratio**2)
