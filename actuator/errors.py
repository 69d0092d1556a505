"""What goes wrong with an actuator."""

from __future__ import annotations

from math import isfinite


class ActuatorError(ValueError):
    """An actuator that cannot be; the message says what was expected, what was found, what to do."""


def require_positive(owner: str, **values: float) -> None:
    """ActuatorError unless every value is a finite number above zero."""
    for name, value in values.items():
        if not (isfinite(value) and value > 0):
            raise ActuatorError(f"{owner}: {name.replace('_', ' ')} must be above zero, found {value:g}; correct it")


def require_not_negative(owner: str, **values: float) -> None:
    """ActuatorError unless every value is a finite number of zero or more."""
    for name, value in values.items():
        if not (isfinite(value) and value >= 0):
            raise ActuatorError(f"{owner}: {name.replace('_', ' ')} must not be negative, found {value:g}; correct it")
