"""Motor and drive of an actuator: a mapped motor under torque control in four quadrants, or a passive diode bridge.

Torques are those of the rotor with the passive sign: T omega > 0 flows from the suspension into the machine.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from actuator.errors import ActuatorError, require_not_negative, require_positive
from electrical.diode_bridge import bridge_current, bridge_torque

UNBOUNDED = 1e200  # Nm and rad/s, of a motor without limits


@dataclass(frozen=True)
class TorqueLimit:
    """Largest torques over speed within current and voltage, straight between the points, none beyond the last.

    speed [rad/s], rising from 0; driving, braking: magnitudes [Nm] where T omega is negative and positive
    Raises ActuatorError for tables of other shapes, speeds that do not rise, or negative torques.
    """

    speed: tuple[float, ...]
    driving: tuple[float, ...]
    braking: tuple[float, ...]

    def __post_init__(self) -> None:
        w, *torques = (np.array(one, dtype=float) for one in (self.speed, self.driving, self.braking))
        alike = all(one.shape == w.shape and np.isfinite(one).all() and (one >= 0).all() for one in torques)
        if not (w.size >= 2 and alike and w[0] == 0 and (np.diff(w) > 0).all()):
            raise ActuatorError(
                "torque limit: expected finite torques of zero or more over speeds that rise from 0, found "
                f"{', '.join(str(one.size) for one in torques)} torques over {w.size} speeds; correct the table"
            )

    def driving_at(self, speed: float | np.ndarray) -> np.ndarray:
        """[Nm], of that shape; speed: [rad/s], any shape."""
        return np.asarray(np.interp(np.abs(speed), self.speed, self.driving, right=0.0))

    def braking_at(self, speed: float | np.ndarray) -> np.ndarray:
        """[Nm], of that shape; speed: [rad/s], any shape."""
        return np.asarray(np.interp(np.abs(speed), self.speed, self.braking, right=0.0))


NO_LIMIT = TorqueLimit((0.0, UNBOUNDED), (UNBOUNDED, UNBOUNDED), (UNBOUNDED, UNBOUNDED))


def flat_limit(torque: float, fastest: float) -> TorqueLimit:
    """The same torque [Nm] in all quadrants up to the fastest [rad/s]."""
    return TorqueLimit((0.0, fastest), (torque, torque), (torque, torque))


class LossLaw:
    """Losses of a machine and its drive over torque and speed; the concrete laws are below."""

    def at(self, torque: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """[W], of that shape; torque: [Nm], any shape; speed: [rad/s], any shape."""
        raise NotImplementedError


@dataclass(frozen=True)
class QuadraticLoss(LossLaw):
    """P = a T^2 + b omega^2: copper of an unsaturated machine and eddy currents at constant flux.

    copper: a [W/(Nm)^2]; iron: b [W s^2/rad^2]
    """

    copper: float
    iron: float

    def __post_init__(self) -> None:
        require_not_negative("loss law", copper=self.copper, iron=self.iron)

    def at(self, torque: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """[W], of that shape; torque: [Nm], any shape; speed: [rad/s], any shape."""
        return self.copper * np.square(torque) + self.iron * np.square(speed)


LOSS_FREE = QuadraticLoss(0.0, 0.0)


@dataclass(frozen=True, eq=False)
class MappedLoss(LossLaw):
    """Losses of a map (thesis Fig. 4.5), straight between its points; the same in both senses of rotation.

    torque: of a motor, from generating (negative) to motoring [Nm], (m,), rising; speed [rad/s], (n,), rising from 0
    power: losses [W], (m, n), NaN out of reach; there the loss at the limit of that speed stands, since a torque that
    follows its command with a lag may be beyond it for a moment
    Raises ActuatorError for tables that do not fit, or a speed at which nothing is known.
    """

    torque: np.ndarray
    speed: np.ndarray
    power: np.ndarray

    def __post_init__(self) -> None:
        known = np.isfinite(self.power)
        fits = self.power.shape == (self.torque.size, self.speed.size)
        if not (fits and known.any(axis=0).all() and self.speed[0] == 0):
            raise ActuatorError(
                f"loss map: expected losses over torque and speed from 0, some at each speed, found a table of "
                f"{self.power.shape} over {self.torque.size} torques and {self.speed.size} speeds; correct the map"
            )

    @cached_property
    def _table(self) -> RegularGridInterpolator:
        columns = [_held(self.torque, column) for column in self.power.T]
        return RegularGridInterpolator((self.torque, self.speed), np.transpose(columns))

    def at(self, torque: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """[W], of that shape; torque: [Nm], any shape; speed: [rad/s], any shape, up to the last of the map."""
        motoring = -np.asarray(torque) * np.where(np.asarray(speed) < 0, -1.0, 1.0)
        fast = np.abs(speed)
        if np.max(fast, initial=0.0) > self.speed[-1]:
            raise ActuatorError(
                f"loss map: the rotor turns with up to {np.max(fast):.4g} rad/s, the map ends at {self.speed[-1]:.4g} "
                "rad/s; map the machine up to a larger speed (speed_max_rpm)"
            )
        return np.asarray(self._table((np.clip(motoring, self.torque[0], self.torque[-1]), fast)))


def _held(torque: np.ndarray, column: np.ndarray) -> np.ndarray:
    """A column with its first and last known values beyond them."""
    known = np.isfinite(column)
    return np.interp(torque, torque[known], column[known])


@dataclass(frozen=True)
class MappedMotor:
    """A motor under torque control (thesis Fig. 4.4): limits, losses, and how fast the torque follows.

    limit: current and voltage as torques over speed; loss: of machine and drive; time_constant: of the torque [s], 0
    for one that follows at once.
    """

    limit: TorqueLimit = NO_LIMIT
    loss: LossLaw = LOSS_FREE
    time_constant: float = 0.0

    def __post_init__(self) -> None:
        require_not_negative("mapped motor", time_constant=self.time_constant)


IDEAL_MOTOR = MappedMotor()


@dataclass(frozen=True)
class DcLoad:
    """What a diode bridge feeds: a resistance [ohm] and a voltage [V] that stands against the current (a battery)."""

    resistance: float
    voltage: float = 0.0

    def __post_init__(self) -> None:
        require_not_negative("load of the diode bridge", resistance=self.resistance, voltage=self.voltage)


@dataclass(frozen=True)
class DiodeBridge(LossLaw):
    """A machine that feeds a load through a six-pulse bridge, without control.

    Current and torque of ``electrical.shunted_machine.bridge_current``, over 2 R_ph + R and against 2 V_d + V.
    torque_constant: K_t [Nm/A] of the peak phase current; phase_resistance: R_ph [ohm]; load: R [ohm] and V [V]
    phase_inductance: L [H]; pole_pairs: p; diode_drop: V_d of one diode [V]; fastest: rotor speed up to which it is
    known [rad/s]
    Valid below the speed where the overlap exceeds 60 degrees.
    """

    torque_constant: float
    phase_resistance: float
    phase_inductance: float
    pole_pairs: int
    load: DcLoad
    diode_drop: float
    fastest: float

    def __post_init__(self) -> None:
        require_positive(
            "diode bridge",
            torque_constant=self.torque_constant,
            phase_resistance=self.phase_resistance,
            fastest=self.fastest,
        )
        require_not_negative("diode bridge", phase_inductance=self.phase_inductance, diode_drop=self.diode_drop)

    def current(self, speed: np.ndarray) -> np.ndarray:
        """Mean direct current [A], of that shape; speed: [rad/s], any shape."""
        flux = self.torque_constant / (1.5 * self.pole_pairs)
        omega = self.pole_pairs * np.abs(speed)
        return bridge_current(omega, flux=flux, inductance=self.phase_inductance, **self._circuit)

    def torque(self, speed: np.ndarray) -> np.ndarray:
        """Steady braking torque [Nm], of that shape, magnitude; speed: [rad/s], any shape."""
        return bridge_torque(self.current(speed), np.abs(speed), **self._circuit)

    def at(self, torque: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Power that does not reach the load [W], of that shape; torque: [Nm], any shape; speed: [rad/s], any shape."""
        current = self.current(speed)
        return torque * speed - self.load.resistance * current**2 - self.load.voltage * current

    @property
    def _circuit(self) -> dict[str, float]:
        """Resistance [ohm] and voltage [V] that the current meets."""
        resistance = 2 * self.phase_resistance + self.load.resistance
        return {"resistance": resistance, "voltage": 2 * self.diode_drop + self.load.voltage}

    @property
    def limit(self) -> TorqueLimit:
        """The steady torque as a table, against the motion only."""
        speed = self.fastest * np.linspace(0.0, 1.0, _TABLE) ** 2  # dense where the diodes begin to conduct
        return TorqueLimit(tuple(speed), (0.0,) * _TABLE, tuple(self.torque(speed)))

    @property
    def time_constant(self) -> float:
        """Of the direct current, 2 L / (2 R_ph + R) [s]."""
        return 2 * self.phase_inductance / (2 * self.phase_resistance + self.load.resistance)

    @property
    def loss(self) -> LossLaw:
        """Of machine and diodes."""
        return self


_TABLE = 401  # speeds
Drive = MappedMotor | DiodeBridge
