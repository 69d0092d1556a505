"""Can this machine be built? Every rule names what is wrong and which parameter to move."""

from __future__ import annotations

from math import isfinite
from typing import Any

from geometry.errors import GeometryError, in_mm
from geometry.parts import DrawnMachine
from units import MILLIMETRE

_SMALLEST_GAP = 0.001 * MILLIMETRE  # below this stator and rotor are one piece to any drawing


def check_machine(machine: DrawnMachine) -> None:
    """Raise GeometryError with one sentence for the first rule that the machine breaks."""
    for whole in (machine, machine.stator, machine.rotor):
        _check_numbers(whole)
    machine.stator.check()
    machine.rotor.check()
    if machine.airgap < _SMALLEST_GAP:
        raise GeometryError(
            f"stator and rotor begin at {in_mm(machine.stator.rim_radius)} and {in_mm(machine.rotor.rim_radius)}, "
            "there is no air gap between them: move one of the two radii"
        )


def _check_numbers(part: Any) -> None:
    free: frozenset[str] = getattr(part, "of_any_sign", frozenset())
    lengths = {name: value for name, value in vars(part).items() if isinstance(value, float) and name not in free}
    for name, value in lengths.items():
        if not isfinite(value) or value <= 0:
            raise GeometryError(f"{name} must be a positive finite number, found {value}: correct {name}")
