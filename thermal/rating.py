"""What the temperatures allow: for ever, at a duty, and for a while."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import log, sqrt

import numpy as np
from scipy.optimize import brentq

from thermal.cooling import HeatLimits
from thermal.course import course
from thermal.errors import NoSteadyState
from thermal.field_loss import FieldLoss
from thermal.load import HotCopper, LoadedMachine, Operation, steady_load
from thermal.machine import MAGNETS, CooledMachine
from thermal.network import Temperatures, settled

COPPER_LIMIT, MAGNET_LIMIT, CURRENT_LIMIT = "winding", "magnets", "current"
_CURRENT_FOUND = 1e-6  # of the largest current
_CURVE = 13  # currents between the continuous one and the largest
_DENSER = 1.7  # towards the continuous one, where the time grows fastest
_LONGEST = 1e5  # s; a current that heats for a day without reaching a limit counts as continuous
_LESS = 0.01  # relative, of the loss in the copper over which the temperatures are differentiated
FAR_BEYOND = 1e3  # K over the limit, where there is no steady state


@dataclass(frozen=True, eq=False)
class State:
    """Temperatures at rest with a loss.

    temperature: of the parts and the surroundings by name, means [degC]; hottest_copper [degC]
    heat: of the parts by name [W]; flows: ends of every way and the heat along it [W]; time_constants [s] (n,)
    """

    temperature: dict[str, float]
    hottest_copper: float
    heat: dict[str, float]
    flows: tuple[tuple[str, str, float], ...]
    time_constants: np.ndarray

    def margin(self, limits: HeatLimits) -> float:
        """Left up to the nearer limit [K], negative beyond it."""
        return -excess(self.hottest_copper, self.temperature, limits)

    @property
    def lost(self) -> float:
        """All heat [W]."""
        return sum(self.heat.values())


@dataclass(frozen=True, eq=False)
class Rating:
    """What may be asked without end at one speed.

    speed: of the rotor [rad/s]; current: peak of a phase [A]; torque: of the rotor, with warm magnets [Nm]
    bound_by: "winding", "magnets" or "current"; state: in which it ends
    """

    speed: float
    current: float
    torque: float
    bound_by: str
    state: State


@dataclass(frozen=True)
class LossSlope:
    """What the loss in the copper does to the temperatures at rest, dT / d ln P.

    copper: at the hottest place of the winding [K]; magnets: in their mean [K]
    """

    copper: float
    magnets: float


@dataclass(frozen=True, eq=False)
class Overload:
    """Torques that are allowed for a while from a start.

    duration: until the first limit is met [s], (n,), falling; torque: of the rotor, at the end of it [Nm], (n,)
    """

    duration: np.ndarray
    torque: np.ndarray


@dataclass(frozen=True, eq=False)
class Heated:
    """One machine at one speed, with any current; friction: of gears and bearings [W]."""

    machine: CooledMachine
    copper: HotCopper
    operation: Operation
    field: FieldLoss
    friction: float
    limits: HeatLimits

    def load(self, current: float) -> LoadedMachine:
        """The machine at one peak current [A]."""
        return steady_load(self.machine, self.copper, self.operation, self.field, self.friction, current)

    def excess(self, temperature: Temperatures) -> float:
        """By how much the nearer limit is passed [K]; temperature: of the parts [degC]."""
        return excess(self.machine.hottest_copper(temperature), temperature, self.limits)

    @property
    def largest(self) -> float:
        """Peak current that winding and electronics allow [A]."""
        return float(self.operation.current[-1])


def excess(hottest_copper: float, temperature: Temperatures, limits: HeatLimits) -> float:
    """By how much the nearer limit is passed [K]; hottest_copper, temperature: [degC]."""
    return max(hottest_copper - limits.copper, temperature[MAGNETS] - limits.magnets)


def state_of(load: LoadedMachine) -> State:
    """Where a load ends. Raises NoSteadyState where it runs away."""
    temperature = settled(load, load.machine.cold())
    network = load.network(temperature)
    flows = tuple((link.first, link.second, heat) for link, heat in network.flows(temperature))
    return State(
        temperature,
        load.machine.hottest_copper(temperature),
        dict(load.heat(temperature)),
        flows,
        network.time_constants(),
    )


def continuous(heated: Heated) -> Rating:
    """The largest current that keeps every limit for ever; none where friction and iron alone are too warm."""
    most = heated.largest

    def beyond(current: float) -> float:
        try:
            return heated.excess(settled(heated.load(current), heated.machine.cold()))
        except NoSteadyState:
            return FAR_BEYOND

    if beyond(most) <= 0:
        return _rating(heated, most, CURRENT_LIMIT)
    current = 0.0 if beyond(0.0) >= 0 else float(brentq(beyond, 0.0, most, xtol=_CURRENT_FOUND * most))
    return _rating(heated, current, None)


def _rating(heated: Heated, current: float, bound_by: str | None) -> Rating:
    state = state_of(heated.load(current))
    copper = state.hottest_copper - heated.limits.copper
    nearer = COPPER_LIMIT if copper >= state.temperature[MAGNETS] - heated.limits.magnets else MAGNET_LIMIT
    torque = heated.operation.torque_of(current, state.temperature[MAGNETS])
    return Rating(heated.operation.speed, current, torque, bound_by or nearer, state)


def loss_slope(heated: Heated, rating: Rating) -> LossSlope:
    """Of a machine at its rating: the loss P is that of one current as if the copper stayed cold, and what warmer
    copper adds to it is in the temperatures. Towards less loss, where there surely is a steady state."""
    cooler = state_of(heated.load(rating.current * sqrt(1 - _LESS)))
    per_loss = -1 / log(1 - _LESS)
    copper = rating.state.hottest_copper - cooler.hottest_copper
    magnets = rating.state.temperature[MAGNETS] - cooler.temperature[MAGNETS]
    return LossSlope(copper * per_loss, magnets * per_loss)


def allowed_for(heated: Heated, start: Temperatures, duration: float) -> float:
    """The largest torque [Nm] that may be asked for a duration [s] from temperatures [degC]; 0 where none may."""
    if heated.excess(start) >= 0:
        return 0.0

    def beyond(current: float) -> float:
        found = course(heated.load(current), start, duration, heated.excess)
        return duration - found.time[-1] if found.stopped else heated.excess(found.end) / FAR_BEYOND

    most = heated.largest
    current = most if beyond(most) <= 0 else float(brentq(beyond, 0.0, most, xtol=1e-4 * most))
    return heated.operation.torque_of(current, course(heated.load(current), start, duration).end[MAGNETS])


def overload(heated: Heated, start: Temperatures, rating: Rating) -> Overload:
    """Torque over the time for which it is allowed, from temperatures [degC], above a continuous rating."""
    points = [] if heated.excess(start) >= 0 else list(_points(heated, start, rating.current))
    duration, torque = np.array(points).reshape(-1, 2).T
    return Overload(duration, torque)


def _points(heated: Heated, start: Temperatures, continuous_current: float) -> Iterator[tuple[float, float]]:
    """(duration [s], torque [Nm]), from the continuous current to the largest."""
    first = max(continuous_current, 1e-3 * heated.largest)
    for current in first * (heated.largest / first) ** (np.linspace(0.0, 1.0, _CURVE)[1:] ** _DENSER):
        found = course(heated.load(float(current)), start, _LONGEST, heated.excess)
        if found.stopped:
            yield float(found.time[-1]), heated.operation.torque_of(float(current), found.end[MAGNETS])
