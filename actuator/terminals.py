"""The electrical side of an actuator: what its torque costs in phase current, and what flows to the battery."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from actuator.errors import ActuatorError, require_positive


@dataclass(frozen=True)
class Terminals:
    """Direct voltage and phase current of an actuator's drive.

    bus_voltage: taken as constant [V]; torque: of the rotor, rising from 0 [Nm]; current: peak phase current that gives
    each at the least current [A]
    Valid below the base speed; above it the drive adds a current that weakens the field.
    Raises ActuatorError for a table that does not rise from zero.
    """

    bus_voltage: float
    torque: tuple[float, ...]
    current: tuple[float, ...]

    def __post_init__(self) -> None:
        require_positive("terminals", bus_voltage=self.bus_voltage)
        t, i = np.array(self.torque, dtype=float), np.array(self.current, dtype=float)
        rises = t.shape == i.shape and t.size >= 2 and t[0] == i[0] == 0
        if not (rises and (np.diff(t) > 0).all() and (np.diff(i) > 0).all()):
            raise ActuatorError(
                f"terminals: expected currents that rise with the torque from 0, found {i.size} currents over {t.size} "
                "torques; correct the table"
            )

    def current_at(self, torque: float | np.ndarray) -> np.ndarray:
        """Peak phase current [A], of that shape, negative where the torque is; torque: [Nm], any shape."""
        return np.asarray(np.sign(torque) * np.interp(np.abs(torque), self.torque, self.current))

    def torque_of(self, current: float | np.ndarray) -> np.ndarray:
        """Torque of the rotor [Nm], of that shape; current: signed peak of a phase [A], any shape."""
        return np.asarray(np.sign(current) * np.interp(np.abs(current), self.current, self.torque))
