"""Load-proportional loss of the rig."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from effects.base import ResponseEffect
from effects.damper_design import Damper
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Odd, Power, Touches

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
    signature = (
        Odd("damping_velocity.force", ("velocity",)),
        Power("damping_velocity.force", "velocity", 1.0),
        Touches("damping_shunt.damping"),
        Touches("impedance.re"),
        Touches("impedance.im"),
    )
    model_error = 0.008
    model_error_source = "benchmarks/law_errors.py: against another rounding of the reversal"
    base_rate = 0.02
    base_rate_source = "engineering judgement: force estimated through a belt or gear, one rig in fifty"

    share: float = parameter(
        0.0, "1", prior=LogNormal(0.03, 0.7), low=0.0, high=0.5, source="textbook: toothed belts 2 to 5 % a mesh"
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
