"""The actuator in the place of the damper: ideal, or with force-speed limits, reflected inertia and friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vehicle.damping import DamperCurve, added, bounded
from vehicle.errors import VehicleError, require_not_negative, require_positive


@dataclass(frozen=True)
class ForceSpeedLimit:
    """Largest force over speed at the wheel, the same in all quadrants, straight between the points.

    speed [m/s], rising from 0; force [N], not negative. Beyond the last speed there is no force.
    From the machine's envelope: F = T / tau_t, v = omega tau_t (thesis eqs 3.3, 3.4).
    """

    speed: tuple[float, ...]
    force: tuple[float, ...]

    def __post_init__(self) -> None:
        v, f = np.array(self.speed, dtype=float), np.array(self.force, dtype=float)
        sound = v.shape == f.shape and v.size >= 2 and np.isfinite(v).all() and np.isfinite(f).all()
        if not (sound and v[0] == 0 and (np.diff(v) > 0).all() and (f >= 0).all()):
            raise VehicleError(
                "force-speed limit: expected finite forces of zero or more over speeds that rise from 0, found "
                f"{v.size} speeds and {f.size} forces; correct the table"
            )

    def at(self, velocity: ArrayLike) -> np.ndarray:
        """Largest force [N] at these velocities [m/s], of their shape."""
        return np.interp(np.abs(velocity), self.speed, self.force, right=0.0)


@dataclass(frozen=True)
class Actuator:
    """What lies between the commanded force and the suspension; without arguments an ideal actuator.

    limit: force-speed limit, None for no limit; equivalent_mass: m_eq = J / tau_t^2 [kg] (3.5), acts between body and
    wheel; coulomb_friction [N], viscous_friction [Ns/m] at the wheel; breakaway_speed: below it the Coulomb force is
    proportional to the velocity [m/s].
    """

    limit: ForceSpeedLimit | None = None
    equivalent_mass: float = 0.0
    coulomb_friction: float = 0.0
    viscous_friction: float = 0.0
    breakaway_speed: float = 5e-3

    def __post_init__(self) -> None:
        require_not_negative(
            "actuator",
            equivalent_mass=self.equivalent_mass,
            coulomb_friction=self.coulomb_friction,
            viscous_friction=self.viscous_friction,
        )
        require_positive("actuator", breakaway_speed=self.breakaway_speed)

    def machine_curve(self, command: DamperCurve) -> DamperCurve:
        """Force of the machine for this command: as commanded, as far as the limit allows."""
        if self.limit is None:
            return command
        last = self.limit.speed[-1]
        knots = (*self.limit.speed, last * (1 + 1e-6))  # beyond the last speed the force ends in a narrow ramp
        return bounded(command, self.limit.at, tuple(s * k for k in knots for s in (-1, 1)), "force-speed limit")

    def suspension_curve(self, command: DamperCurve) -> DamperCurve:
        """Force at the suspension without the inertia: machine and friction."""
        machine = self.machine_curve(command)
        if self.coulomb_friction == self.viscous_friction == 0:
            return machine
        return added(machine, self._friction(machine.velocity[0], machine.velocity[-1]), f"{command.name}, friction")

    def _friction(self, low: float, high: float) -> DamperCurve:
        v = np.array([low, -self.breakaway_speed, 0.0, self.breakaway_speed, high])
        coulomb = self.coulomb_friction * np.clip(v / self.breakaway_speed, -1, 1)
        return DamperCurve("friction", tuple(v), tuple(coulomb + self.viscous_friction * v), "friction")


IDEAL = Actuator()
