"""How fast an actuator can move on its own: what bounds the step of an integration."""

from __future__ import annotations

from math import sqrt

import numpy as np

from actuator.model import Actuator
from actuator.parts import CompliantMount

_SHARES = np.linspace(0.0, 1.5, 31)  # of the transition, over which the tangent is sought


def steepest_tangent(mount: CompliantMount) -> tuple[float, float]:
    """Largest stiffness [N/m] and damping [Ns/m] of a mount over its deformation."""
    tangents = [mount.tangent(mount.play + max(mount.transition, 1e-9) * (share + 1e-9)) for share in _SHARES]
    return max(k for k, _ in tangents), max(c for _, c in tangents)


def fastest_rate(actuator: Actuator) -> float:
    """Bound of the rates of an actuator held at its output [1/s]: mount on the equivalent mass, friction, lag."""
    rates = [1e-3]
    lightest = actuator.equivalent_mass * min((actuator.ratio.nominal / tau) ** 2 for tau in actuator.ratio.value)
    if isinstance(actuator.mount, CompliantMount):
        stiffness, damping = steepest_tangent(actuator.mount)
        friction = actuator.loss.viscous + actuator.loss.coulomb / actuator.loss.breakaway_speed
        rates += [sqrt(stiffness / lightest), (damping + friction) / lightest]
    if actuator.drive.time_constant > 0:
        rates.append(1 / actuator.drive.time_constant)
    return max(rates)
