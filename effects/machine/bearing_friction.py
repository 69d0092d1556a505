"""Dry friction of the bearings of a machine on its bench."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import Columns, ResponseEffect
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal

KINDS = ("cogging", "drag")  # measured while the rotor turns; a locked rotor does not move


@dataclass(frozen=True)
class BearingFriction(ResponseEffect):
    """Dry friction of the bearings between torque cell and rotor: the cell reads T - level sign(motion)."""

    title = "dry friction of the bearings"
    looks_like = "both directions of a cogging scan apart by twice the same torque"
    remedy = ("drag with a rotor without magnets",)
    designs = (MachineAsBuilt,)

    level: float = parameter(
        0.0, "Nm", prior=LogNormal(0.01, 1.0), low=0.0, high=1.0, source="small ball bearings with seals, 1 to 50 mNm"
    )

    def on_response(self, response: Columns, conditions: Columns, kind: str, design: MachineAsBuilt) -> Columns:
        if kind not in KINDS or self.is_null:
            return response
        return {**response, "torque": response["torque"] - self.level * np.sign(moving(conditions))}


def moving(conditions: Columns) -> np.ndarray:
    """Speed [rad/s] where it is known, or the direction of the motion as +1 and -1; zero where neither is."""
    for name in ("speed", "direction"):
        if name in conditions:
            return np.asarray(conditions[name], dtype=float)
    return np.zeros_like(next(iter(conditions.values())), dtype=float)
