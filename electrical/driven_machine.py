"""A wound machine on its power electronics: what stages behind the choice of the winding need of it."""

from __future__ import annotations

from dataclasses import dataclass

from electrical.dq import DriveLimits
from electrical.winding_stage import WindingInputs, WindingOutcome
from electrical.wound_machine import WoundMachine


@dataclass(frozen=True)
class DrivenMachine:
    """limits: peak phase current [A] and voltage [V] of the equivalent star; fastest: largest speed [rad/s]"""

    wound: WoundMachine
    limits: DriveLimits
    fastest: float


def driven_machine(winding: WindingOutcome, inputs: WindingInputs) -> DrivenMachine:
    """The machine with the winding that was chosen."""
    return DrivenMachine(winding.wound, winding.limits, inputs.limits.maximum_speed)


@dataclass(frozen=True)
class CopperTemperature:
    """That the resistance of a winding is stated at. value: [degC]"""

    value: float
