"""What this room refuses."""

from __future__ import annotations


class ThermalError(ValueError):
    """A thermal network that is none, or a machine that cannot be kept cool; the message says what to change."""


class NoSteadyState(ThermalError):
    """The loss rises faster with the temperature than the heat that leaves: it warms without end."""
