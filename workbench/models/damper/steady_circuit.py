"""Current of the damper's circuit where the inductance plays no part."""

from __future__ import annotations

import numpy as np

from effects.damper_design import Damper
from workbench.errors import WorkbenchError

STEPS = 60  # of the iteration on the coupling factor; one to four are needed
CLOSE = 1e-12  # current that is missing, of its largest value, at which it is found


def voltage_left(design: Damper, voltage: np.ndarray, resistance: np.ndarray) -> np.ndarray:
    """Voltage left for the resistances after all circuit laws [V]."""
    for law in design.circuits:
        voltage = law.left(voltage, resistance)
    return voltage


def coupling_factor(design: Damper, position: np.ndarray, current: np.ndarray) -> np.ndarray | float:
    """g(x, i), the product of all coupling laws [1]."""
    factor = 1.0
    for law in design.couplings:
        factor = factor * law.coupling(position, current)
    return factor


def circuit_current(design: Damper, position: np.ndarray, velocity: np.ndarray, shunt: np.ndarray) -> np.ndarray:
    """i of K g(x, i) v = u, i = left(u) / (R + R_shunt), without inductance [A]; arguments broadcast.

    Newton on i with the slope of the right side taken over a small step; g is near one, so it converges in a few steps.
    Raises WorkbenchError when it does not.
    """
    resistance = design.internal_resistance + shunt

    def asked(current):
        emf = design.force_constant * coupling_factor(design, position, current) * velocity
        return voltage_left(design, emf, resistance) / resistance

    current = asked(np.zeros(np.broadcast_shapes(np.shape(velocity), np.shape(shunt))))
    if not design.couplings:
        return current
    step = 1e-6 * (np.abs(current) + 1e-3)
    for _ in range(STEPS):
        missing = asked(current) - current
        if np.max(np.abs(missing)) <= CLOSE * np.max(np.abs(current)) + 1e-15:
            return current + missing
        slope = (asked(current + step) - current - missing) / step
        current = current + missing / (1.0 - np.minimum(slope, 0.5))
    raise WorkbenchError("the current of the damper's circuit was not found: a coupling law leaves no steady current")
