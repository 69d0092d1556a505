"""The actuator about an operating point: what its force loop has to control."""

from __future__ import annotations

from math import pi

from actuator.errors import ActuatorError
from actuator.model import Actuator
from actuator.parts import CompliantMount
from actuator.stiffness import steepest_tangent
from control.errors import ControlError
from control.force_loop import ForceLoop
from control.transfer import TransferFunction


def blocked_force(actuator: Actuator, stiffness: float, damping: float) -> TransferFunction:
    """Force at the held suspension over the force that is asked of the motor, dimensionless.

    G = (c s + k) / (m s^2 + (c + c_loss) s + k) / (t s + 1)

    stiffness: k of the mount [N/m]; damping: c [Ns/m]; both about a deformation, see ``tangent_plant``
    Dry friction, the loss of the gears and the limits of the motor are left out.
    """
    mass, friction = actuator.equivalent_mass, actuator.loss.viscous
    moving = TransferFunction((damping, stiffness), (mass, damping + friction, stiffness))
    return moving.times(TransferFunction((1.0,), (actuator.drive.time_constant, 1.0)))


def tangent_plant(actuator: Actuator, force: float) -> TransferFunction:
    """``blocked_force`` about the deformation at which the mount gives a steady force [N].

    Raises ActuatorError for a rigid mount, whose force is the motor's.
    """
    return blocked_force(actuator, *_tangent_about(actuator, force))


def stiffness_about(actuator: Actuator, force: float) -> float:
    """Of the mount at a steady force [N/m]; force [N]. Raises ActuatorError for a rigid mount."""
    return _tangent_about(actuator, force)[0]


def _tangent_about(actuator: Actuator, force: float) -> tuple[float, float]:
    mount = actuator.mount
    if not isinstance(mount, CompliantMount):
        raise ActuatorError("the plant of a force loop needs a compliant mount, found a rigid one; leave the loop out")
    return mount.tangent(mount.deformation(force))


def require_stable(actuator: Actuator, loop: ForceLoop) -> None:
    """ControlError for a loop that swings by itself at the held output, in full contact or where the mount is steepest.

    In its play a mount has no stiffness, so that a loop around it has nothing to swing with.
    """
    mount = actuator.mount
    if not isinstance(mount, CompliantMount):
        return
    full = mount.tangent(mount.play + 2 * mount.transition + _BEYOND)
    for stiffness, damping in (full, steepest_tangent(mount)):
        closed = blocked_force(actuator, stiffness, damping).times(loop.transfer).closed
        worst = max(closed.poles, key=lambda pole: pole.real)
        if worst.real >= 0:
            raise ControlError(
                f"force loop: unstable where the mount has {stiffness:.3g} N/m, it swings at "
                f"{abs(worst.imag) / (2 * pi):.3g} Hz; lower its gains, raise the derivative or damp the mount"
            )


_BEYOND = 1e-6  # m
