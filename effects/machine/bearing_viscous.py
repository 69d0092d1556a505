"""Viscous friction of the bearings of a machine on its bench."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import Columns, ResponseEffect
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal

KINDS = ("drag",)  # measured while the rotor turns; a locked rotor does not move


@dataclass(frozen=True)
class BearingViscous(ResponseEffect):
    """Viscous drag of bearings and grease: T - slope speed."""

    title = "viscous friction of the bearings"
    looks_like = "drag in proportion to the speed"
    remedy = ("drag with a rotor without magnets",)
    designs = (MachineAsBuilt,)

    slope: float = parameter(0.0, "Nms/rad", prior=LogNormal(2e-5, 1.0), low=0.0, high=0.1, source="greased bearings")

    def on_response(self, response: Columns, conditions: Columns, kind: str, design: MachineAsBuilt) -> Columns:
        if kind not in KINDS or self.is_null:
            return response
        return {**response, "torque": response["torque"] - self.slope * moving(conditions)}


def moving(conditions: Columns) -> np.ndarray:
    """Speed [rad/s] where it is known, or the direction of the motion as +1 and -1; zero where neither is."""
    for name in ("speed", "direction"):
        if name in conditions:
            return np.asarray(conditions[name], dtype=float)
    return np.zeros_like(next(iter(conditions.values())), dtype=float)
