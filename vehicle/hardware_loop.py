"""Hardware in the loop (thesis Fig. 5.15): an actuator on a test bench against the vehicle model, sample by sample.

On the bench a hydraulic axis moves the actuator as the suspension of the model moves, and its force is measured. The
platform holds the vehicle, the law that wants a force, and the low-level control that makes the actuator give it. What
is measured at a sample acts over the next one, on the vehicle as on the bench.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, pi
from typing import Protocol

import numpy as np

from actuator.model import IDEAL, Actuator
from actuator.observer import ForceObserver
from actuator.step import Moment, SteppedActuator
from control.sampled_loop import SampledLoop
from vehicle.commands import Controller, Felt
from vehicle.equations import equations, largest_step
from vehicle.errors import require_positive
from vehicle.indices import rms
from vehicle.models import Vehicle
from vehicle.motion import follow
from vehicle.real_time import Pace, Timing
from vehicle.ride import felt

Law = Callable[[Felt], float]  # wanted force [N]
_UNBOUNDED = 1e5  # N, a hundred times what an actuator gives: the loop has lost it


@dataclass(frozen=True)
class Signals:
    """What is measured on the bench: force of the load cell [N], rotor angle [rad], torque from the current [Nm]."""

    force: float
    angle: float
    torque: float


class Device(Protocol):
    """The actuator on the bench."""

    def respond(self, velocity: float, force: float) -> Signals:
        """After one more sample at a velocity of the output [m/s] and a force asked of the motor [N]."""


class SimulatedDevice:
    """The stepped actuator in the place of hardware; encoder: counts of the rotor's angle in a turn."""

    def __init__(self, actuator: Actuator, sample_time: float, encoder: int) -> None:
        self.stepped, self.sample_time, self.count = SteppedActuator(actuator), sample_time, 2 * pi / encoder
        self.moment: Moment = self.stepped.at_rest()

    def respond(self, velocity: float, force: float) -> Signals:
        """After one more sample at a velocity of the output [m/s] and a force asked of the motor [N]."""
        self.moment = self.stepped.after(self.moment, velocity, force, self.sample_time)
        return measured(self.moment.answer.force, self.stepped.actuator.ratio.angle(self.moment.mass_stroke),
                        self.moment.answer.torque, self.count)  # fmt: skip


def measured(force: float, angle: float, torque: float, count: float) -> Signals:
    """With the angle in whole counts; force [N], angle [rad], torque [Nm], count: of the encoder [rad]."""
    return Signals(force, count * round(angle / count), torque)


@dataclass
class HydraulicAxis:
    """The axis that moves the actuator: it follows the stroke as a critically damped oscillator.

    x'' = w^2 (z - x) - 2 w x', the stroke z held over a sample
    bandwidth: w / (2 pi) [Hz], a stand-in: the thesis prints neither gains nor bandwidth of its position control
    (section 5.5); stroke [m] and velocity [m/s]: where it is
    """

    bandwidth: float
    stroke: float = 0.0
    velocity: float = 0.0

    def __post_init__(self) -> None:
        require_positive("hydraulic axis", bandwidth=self.bandwidth)

    def follow(self, wanted: float, sample_time: float) -> float:
        """Mean velocity over a sample [m/s], exact; wanted: stroke of the model [m]; sample_time [s]."""
        w, h, before = 2 * pi * self.bandwidth, sample_time, self.stroke
        error, decay = self.stroke - wanted, np.exp(-2 * pi * self.bandwidth * sample_time)
        grown = self.velocity + w * error
        self.stroke = wanted + float(decay) * (error + grown * h)
        self.velocity = float(decay) * (self.velocity - w * grown * h)
        return (self.stroke - before) / h


class LowLevel(Protocol):
    """What makes the actuator give the wanted force."""

    def motor_force(self, wanted: float, signals: Signals) -> float:
        """Asked of the motor, at the wheel [N]; wanted: [N]; signals: of the last sample."""


class NoLoop:
    """The motor is asked for the wanted force itself, as in the thesis's preliminary test."""

    def motor_force(self, wanted: float, signals: Signals) -> float:
        """The wanted force [N]."""
        return wanted


@dataclass
class LoadCellLoop:
    """A force loop around the load cell."""

    loop: SampledLoop

    def motor_force(self, wanted: float, signals: Signals) -> float:
        """From the error of the measured force [N]; wanted: [N]."""
        return self.loop.output(wanted - signals.force)


@dataclass
class ObserverLoop:
    """A force loop around what the observer makes of current and angle; the load cell is not looked at."""

    loop: SampledLoop
    observer: ForceObserver

    def motor_force(self, wanted: float, signals: Signals) -> float:
        """From the error of the observed force [N]; wanted: [N]."""
        return self.loop.output(wanted - self.observer.force(signals.angle, signals.torque))


@dataclass(frozen=True)
class Platform:
    """What runs in real time beside the bench.

    vehicle: with the actuator at its last axle; law: asks for a force; low_level: makes the actuator give it
    sample_time: of all of it [s]
    """

    vehicle: Vehicle
    law: Law
    low_level: LowLevel
    sample_time: float


@dataclass(frozen=True, eq=False)
class LoopRun:
    """A run over the samples (t,).

    time [s], (t,); stroke: of the model [m], (t,); axis: stroke of the bench [m], (t,); wanted and force: on the
    suspension [N], (t,); motor_force: asked [N], (t,); acceleration: of the body [m/s^2], (t,)
    wheel: height of the model's wheel [m], (t,); angle [rad], (t,), and torque [Nm], (t,): of the rotor as measured
    timing: of the paced loop, None for one as fast as it goes; lost: whether the force left all bounds, where it ended
    """

    time: np.ndarray
    stroke: np.ndarray
    axis: np.ndarray
    wanted: np.ndarray
    force: np.ndarray
    motor_force: np.ndarray
    acceleration: np.ndarray
    wheel: np.ndarray
    angle: np.ndarray
    torque: np.ndarray
    timing: Timing | None
    lost: bool

    @property
    def force_error(self) -> float:
        """RMS of force less wanted force [N]."""
        return rms(self.force - self.wanted)


def run_loop(
    platform: Platform, device: Device, axis: HydraulicAxis, road: np.ndarray, pace: Pace | None = None
) -> LoopRun:
    """Drive the vehicle over a road with the actuator on the bench.

    road: heights under the wheels at the samples [m], (t, n); pace: the clock of this machine, None: without one
    Ends early where the force leaves all bounds.
    """
    model, rows, signals = _Model(platform), [], Signals(0.0, 0.0, 0.0)
    for k in range(len(road) - 1):
        if pace is not None:
            pace.wait()
        told = model.felt(k)
        wanted = platform.law(told)
        asked = platform.low_level.motor_force(wanted, signals)
        rows.append((k * platform.sample_time, told.stroke, axis.stroke, wanted, signals.force, asked,
                     told.body_acceleration, told.wheel_height, signals.angle, signals.torque))  # fmt: skip
        velocity = axis.follow(told.stroke, platform.sample_time)
        model.move(road[k : k + 2], signals.force)
        signals = device.respond(velocity, asked)
        if pace is not None:
            pace.done()
        if lost := not abs(signals.force) < _UNBOUNDED:
            break
    columns = dict(zip(_COLUMNS, np.array(rows).T, strict=True))
    return LoopRun(**columns, timing=None if pace is None else pace.timing, lost=lost)


# What is written down of a sample, in this order.
_COLUMNS = ("time", "stroke", "axis", "wanted", "force", "motor_force", "acceleration", "wheel", "angle", "torque")


class _Model:
    """The vehicle in the loop, with the measured force in the place of its actuator."""

    def __init__(self, platform: Platform) -> None:
        vehicle, self.step = platform.vehicle, platform.sample_time
        held = Controller(lambda _: 0.0, self.step)
        self.equations, self.axles = equations(vehicle, IDEAL, held, None, 0.0), len(vehicle.axles)
        self.parts = ceil(self.step / largest_step(vehicle, IDEAL, held, self.equations))
        self.state = np.zeros(self.equations.size)
        self.states, self.seen = np.zeros((2, self.equations.size)), np.zeros((2, self.equations.seen))

    def felt(self, sample: int) -> Felt:
        """What the law is told at a sample."""
        return felt(sample * self.step, self.state, self.seen[1], self.axles)

    def move(self, road: np.ndarray, force: float) -> None:
        """One sample on; road: heights at its ends [m], (2, n); force: on the suspension [N]."""
        self.equations.held[0] = force
        imposed = np.column_stack([road, (0.0, 0.0)])  # nothing but the road and the actuator acts
        follow(self.equations, self.state, imposed, self.step, self.parts, self.states, self.seen)
