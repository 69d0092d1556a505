"""Mean values of a machine that feeds a six-pulse diode bridge, without control.

It asks for next to nothing, since it goes into the exported actuator.
"""

from __future__ import annotations

from math import pi, sqrt

import numpy as np

from units import Values

BRIDGE_MEAN = 3 * sqrt(3.0) / pi  # mean voltage of a six-pulse bridge over the peak of a phase; textbook (Mohan ch. 5)
OVERLAP = 3 / pi  # mean voltage that commutation costs over omega_e L I; textbook (Mohan ch. 5)


def bridge_current(
    omega: Values, *, flux: float, inductance: float, resistance: Values, voltage: float
) -> np.ndarray:
    """Mean direct current of a six-pulse bridge [A], (3 sqrt(3)/pi omega psi_m - V) / (R + 3/pi omega L), 0 below V.

    bridge_current: of the shape of its arguments, which broadcast. omega: electrical, magnitude [rad/s], any shape;
    flux: psi_m [Wb]; inductance: L of a phase [H]; resistance: R of the whole circuit [ohm]; voltage: V, which the
    current must overcome, of diodes and load [V]. See ``Bridge``.
    """
    left = np.maximum(BRIDGE_MEAN * flux * np.asarray(omega) - voltage, 0.0)
    return np.asarray(left / (resistance + OVERLAP * omega * inductance))


def bridge_torque(current: np.ndarray, speed: Values, *, resistance: Values, voltage: float) -> np.ndarray:
    """I (I R + V) / w [Nm], 0 at rest, with the sign of the speed, of the shape of the current.

    bridge_torque, current: direct [A], any shape; speed: mechanical [rad/s]; resistance [ohm] and voltage [V] as in
    ``bridge_current``. The overlap costs voltage and no power.
    """
    power, speed = current * (current * resistance + voltage), np.asarray(speed)
    return power * np.divide(1.0, speed, out=np.zeros_like(power), where=speed != 0)
