"""What a vehicle needs to know of an actuator to be driven with it, as the outcome of a design states it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class ActuatorLimits:
    """Force over speed, inertia and friction of a designed actuator, all at the wheel.

    speed: rising from 0 [m/s], (n,); force: largest force at each of them, in either direction [N], (n,)
    equivalent_mass: m_eq = J / tau_t^2 [kg] (thesis eq. 3.5)
    coulomb_friction [N], viscous_friction [Ns/m]
    """

    speed: np.ndarray
    force: np.ndarray
    equivalent_mass: float
    coulomb_friction: float
    viscous_friction: float
