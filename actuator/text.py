"""An actuator with its terminals as text, and back, for whoever drives it without the study that it came from."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

import numpy as np

from actuator.drive import DiodeBridge, LossLaw, MappedLoss, MappedMotor, QuadraticLoss, TorqueLimit
from actuator.errors import ActuatorError
from actuator.model import Actuator
from actuator.parts import CompliantMount, GearEfficiency, MechanicalLoss, Ratio
from actuator.terminals import Terminals


def text_of(actuator: Actuator, terminals: Terminals) -> str:
    """JSON in SI, by the names of the dataclasses.

    Raises ActuatorError for a diode bridge or a rigid mount, which nobody commands step by step.
    """
    if isinstance(actuator.drive, DiodeBridge) or not isinstance(actuator.mount, CompliantMount):
        raise ActuatorError(
            "actuator as text: expected a motor under torque control behind a compliant mount, found "
            f"{type(actuator.drive).__name__} behind {type(actuator.mount).__name__}; give it a drive and a mount"
        )
    content = {"actuator": asdict(actuator), "terminals": asdict(terminals)}
    return json.dumps(content, default=np.ndarray.tolist)


def actuator_of(text: str) -> tuple[Actuator, Terminals]:
    """What ``text_of`` wrote. Raises ActuatorError for a text that lacks a part, or parts that do not fit."""
    content = json.loads(text)
    try:
        return _actuator(content["actuator"]), Terminals(**_tuples(content["terminals"]))
    except (KeyError, TypeError) as wrong:
        raise ActuatorError(f"actuator as text: {wrong} does not fit; export the actuator again") from None


def _actuator(parts: dict[str, Any]) -> Actuator:
    drive = parts["drive"]
    return Actuator(
        drive=MappedMotor(TorqueLimit(**_tuples(drive["limit"])), _loss_law(drive["loss"]), drive["time_constant"]),
        ratio=Ratio(**_tuples(parts["ratio"])),
        equivalent_mass=parts["equivalent_mass"],
        mount=CompliantMount(**parts["mount"]),
        loss=MechanicalLoss(**parts["loss"]),
        gears=GearEfficiency(**parts["gears"]),
    )


def _loss_law(parts: dict[str, Any]) -> LossLaw:
    if "power" in parts:
        return MappedLoss(**{name: np.array(value, dtype=float) for name, value in parts.items()})
    return QuadraticLoss(**parts)


def _tuples(parts: dict[str, Any]) -> dict[str, Any]:
    return {name: tuple(value) if isinstance(value, list) else value for name, value in parts.items()}
