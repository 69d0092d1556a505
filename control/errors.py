"""What goes wrong with a control loop."""

from __future__ import annotations


class ControlError(ValueError):
    """A loop that cannot be; the message says what was expected, what was found, what to do."""
