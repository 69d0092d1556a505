"""Load-proportional loss of the rig."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import ResponseEffect
from effects.damper_design import Damper
from effects.parameter import parameter
from effects.prior import LogNormal

ANGLES = 2 * np.pi * (np.arange(64) + 0.5) / 64  # of one period


@dataclass(frozen=True)
class RigLoss(ResponseEffect):
    """Belt, pulleys or gears of the rig lose a share of what passes through: F_read = F + share |F| sign(v).

    Impedance: the fundamental of that law for F = Re(Z V e^jwt).
    Source: thesis section 5.2.1, where the force is estimated from the current of the drive.
    """

    title = "load-proportional loss of the rig"
    looks_like = "as a gain of the force at constant velocity; less where force and velocity are out of phase"
    remedy = ("a force cell between rig and damper",)
    designs = (Damper,)

    share: float = parameter(
        0.0, "1", prior=LogNormal(0.03, 0.7), low=0.0, high=0.5, source="toothed belts 2 to 5 % a mesh"
    )

    def on_response(self, response, conditions, kind, design):
        changed = dict(response)
        if "force" in response and "velocity" in conditions:
            direction = np.sign(conditions["velocity"])
            changed["force"] = response["force"] + self.share * np.abs(response["force"]) * direction
        if "damping" in response:
            changed["damping"] = response["damping"] * (1.0 + self.share)
        if "re" in response:
            z = response["re"] + 1j * response["im"]
            lost = self.share * self._fundamental(z)
            changed["re"], changed["im"] = response["re"] + lost.real, response["im"] + lost.imag
        return changed

    def _fundamental(self, z):
        force = np.outer(z.real, np.cos(ANGLES)) - np.outer(z.imag, np.sin(ANGLES))
        lost = np.abs(force) * np.sign(np.cos(ANGLES))
        return 2.0 / len(ANGLES) * (lost @ np.cos(ANGLES) - 1j * (lost @ np.sin(ANGLES)))
