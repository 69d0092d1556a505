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


@dataclass(frozen=True)
class BegunMachine:
    """The machine whose field is mapped: wound as its file states it, or with one bar a coil where its winding is yet
    to be chosen. Only its ampere-turns count."""

    driven: DrivenMachine


def driven_machine(winding: WindingOutcome, inputs: WindingInputs) -> DrivenMachine:
    """The machine with the winding that was chosen."""
    return DrivenMachine(winding.wound, winding.limits, inputs.limits.maximum_speed)


def driven_as_begun(begun: BegunMachine) -> DrivenMachine:
    """The machine with the winding of its file."""
    return begun.driven


@dataclass(frozen=True)
class CopperTemperature:
    """That the resistance of a winding is stated at. value: [degC]"""

    value: float
