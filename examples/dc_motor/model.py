"""A model of one's own, plugged into the workbench by one class: a DC motor with brushes under load."""

from dataclasses import dataclass

import numpy as np

from workbench.models import device
from workbench.models.base import BaseModel


@dataclass(frozen=True)
class DcMotor:
    """torque_constant: k [Nm/A = V s/rad];  resistance: R [ohm];  friction: M_0 [Nm];  brush_drop: u_b [V]"""

    torque_constant: float
    resistance: float
    friction: float = 0.0
    brush_drop: float = 0.0


class DcMotorModel(BaseModel):
    """u = u_b + R i + k omega,  k i = M + M_0; the only kind is ``generic``: voltage, torque -> current, speed."""

    name = "dc_motor"

    def accepts(self, device_table):
        return "torque_constant" in device.names(device_table)

    def design(self, device_table):
        return DcMotor(**device.numbers(device_table, ("torque_constant", "resistance"), ("friction",)))

    def with_tolerance(self, design, tolerance, z):
        return device.moved(design, tolerance, z, ("torque_constant", "resistance", "friction"))

    def respond(self, design, kind, conditions):
        current = (conditions["torque"] + design.friction) / design.torque_constant
        left = conditions["voltage"] - design.brush_drop - design.resistance * current
        return {"current": current, "speed": np.maximum(left, 0.0) / design.torque_constant}


BASE = DcMotorModel()
