"""What force is asked of the actuator: a damper curve, a feedback of the vehicle's states, or a controller.

A damper curve is ``vehicle.damping.DamperCurve``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vehicle.damping import DamperCurve
from vehicle.errors import require_positive


@dataclass(frozen=True)
class Feedback:
    """F_act = row x: coefficients of the stroke [N/m], wheel height [N/m], body and wheel velocity [Ns/m].

    x = [z_s - z_u, z_u, z_s', z_u'] (4.19), from static equilibrium, above the actuated axle
    """

    row: tuple[float, float, float, float]
    name: str = "state feedback"


@dataclass(frozen=True)
class Felt:
    """What a controller is told at one of its instants.

    time [s]; stroke [m], wheel_height [m], body_velocity and wheel_velocity [m/s] of the actuated axle; force: of the
    actuator on the suspension [N]; body_acceleration [m/s^2]
    """

    time: float
    stroke: float
    wheel_height: float
    body_velocity: float
    wheel_velocity: float
    force: float
    body_acceleration: float


@dataclass(frozen=True)
class Controller:
    """A controller of one's own, asked once a sample; its answer is held until the next one.

    law: wanted force [N], positive against rebound, of what is felt; sample_time [s], a multiple of the scenario's step
    """

    law: Callable[[Felt], float]
    sample_time: float
    name: str = "controller"

    def __post_init__(self) -> None:
        require_positive(f"controller '{self.name}'", sample_time=self.sample_time)


Command = DamperCurve | Feedback | Controller
