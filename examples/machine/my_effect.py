"""Bearing friction that changes with the angle: a raceway that is tight on one side."""

from dataclasses import dataclass

import numpy as np

from effects.base import ResponseEffect
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class TightBearing(ResponseEffect):
    """M = -direction (a cos theta + b sin theta): friction once a revolution, against the motion either way."""

    title = "bearing tight on one side"
    looks_like = "order 1 in the cogging torque, odd under direction, nothing in the voltage"
    remedy = ("the same table with the rotor without magnets",)
    designs = (MachineAsBuilt,)

    cosine: float = parameter(0.0, "Nm", prior=Normal(5e-3), low=-0.1, high=0.1, source="a tenth of small bearings")
    sine: float = parameter(0.0, "Nm", prior=Normal(5e-3), low=-0.1, high=0.1, source="a tenth of small bearings")

    def on_response(self, response, conditions, kind, design):
        if kind != "cogging" or self.is_null:
            return response
        theta = conditions["angle_mech"]
        friction = self.cosine * np.cos(theta) + self.sine * np.sin(theta)
        return {**response, "torque": response["torque"] - conditions["direction"] * friction}
