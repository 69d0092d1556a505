"""Control laws over their settings on the vehicle of a study: carpets, best settings, LQR in time and frequency.

The actuator is ideal here and the car linear, as in thesis section 4.2.2; a vehicle of several axles is taken by the
corner that carries the actuator.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from labelled import xr
from tasks import Workers
from vehicle.comfort import WEIGHTING
from vehicle.commands import Feedback
from vehicle.demands import RideCase
from vehicle.errors import VehicleError
from vehicle.models import QuarterCar, Vehicle
from vehicle.printed_car import COMFORT, HANDLING, PRINTED_CAR, TRADE_OFF
from vehicle.quarter_car import LqrWeights, groundhook, lqr, skyhook, spring_negation
from vehicle.road import IsoRoad
from vehicle.spectral import Carpet, RideIndices, carpet, ensemble_indices, indices_from_rest, ride_of

_NODES = np.arange(50) / 49  # of the grids of section 4.2.2, which follow from its printed settings
_ROADS = range(200)  # over which the largest stroke is averaged
_SAMPLE = 1e-2  # s, between the samples of those roads
FREQUENCIES = np.geomspace(0.1, 100.0, 400)  # Hz, of the responses
SETTINGS = {"comfort-oriented": COMFORT, "trade-off": TRADE_OFF, "handling-oriented": HANDLING}  # Table 4.1


@dataclass(frozen=True)
class Law:
    """A control law with two settings.

    name; law: of a car and both settings [SI]; first, second: what they are, with the unit, as thesis section 4.2.2
    prints them; grids: of the car -> values of both [SI], (n,) and (m,)
    """

    name: str
    law: Callable[[QuarterCar, float, float], Feedback]
    first: str
    second: str
    grids: Callable[[QuarterCar], tuple[np.ndarray, np.ndarray]]


def _skyhook(car: QuarterCar, c: float, hook: float) -> Feedback:
    return skyhook(c, hook)


def _groundhook(car: QuarterCar, c: float, hook: float) -> Feedback:
    return groundhook(c, hook)


def _negation(car: QuarterCar, c: float, stiffness: float) -> Feedback:
    return spring_negation(c, stiffness)


def _lqr(car: QuarterCar, stroke: float, wheel: float) -> Feedback:
    return lqr(car, LqrWeights(stroke, wheel))


_DAMPING, _HOOK = 10 * 1000**_NODES, 10 * 2000**_NODES  # Ns/m
_WEIGHTS = 10 ** (8 * _NODES)  # kg/s^4
LAWS = (
    Law("skyhook", _skyhook, "c / (Ns/m)", "c_SH / (Ns/m)", lambda car: (_DAMPING, _HOOK)),
    Law("groundhook", _groundhook, "c / (Ns/m)", "c_GH / (Ns/m)", lambda car: (_DAMPING, _HOOK[:30])),
    Law("spring negation", _negation, "c / (Ns/m)", "k_SN / (N/m)",
        lambda car: (_DAMPING, car.spring_stiffness**_NODES)),
    Law("LQR", _lqr, "r_s / (kg/s⁴)", "r_h / (kg/s⁴)", lambda car: (_WEIGHTS, _WEIGHTS)),
)  # fmt: skip


@dataclass(frozen=True)
class CarpetTask:
    """One law, by name, over its settings. car; road: random; speed [m/s]."""

    law: str
    car: QuarterCar
    road: IsoRoad
    speed: float


@dataclass(frozen=True)
class LqrSetting:
    """A setting of Table 4.1.

    name; weights: of this car; feedback: the law; indices: RMS values from rest over the duration of a road
    stroke_peak: largest stroke over that time, mean over roads [m]
    """

    name: str
    weights: LqrWeights
    feedback: Feedback
    indices: RideIndices
    stroke_peak: float


@dataclass(frozen=True, eq=False)
class Strategies:
    """What the control laws make of a car.

    car: the corner of the vehicle; carpets: one a law, by name; settings: of the LQR
    responses: magnitudes over (setting, frequency): frequency [Hz], (f,), felt: weighted acceleration over road height
    [1/s^2], tyre: deflection over road height, dimensionless, each (setting, f)
    """

    car: QuarterCar
    carpets: dict[str, Carpet]
    settings: tuple[LqrSetting, ...]
    responses: xr.Dataset


def corner(vehicle: Vehicle) -> QuarterCar:
    """The actuated axle with the part of the body that rests on it."""
    axle = vehicle.actuated
    return QuarterCar(axle.sprung_mass, axle.unsprung_mass, axle.spring_stiffness, axle.tyre.stiffness, axle.stops)


def weights_for(car: QuarterCar, weights: LqrWeights) -> LqrWeights:
    """Weights of the thesis's car for another: with R = 1/m_s they weigh the squared acceleration as r / m_s does."""
    share = car.sprung_mass / PRINTED_CAR.sprung_mass
    return LqrWeights(weights.stroke * share, weights.wheel * share)


def strategies_stage(case: RideCase, workers: Workers) -> Strategies:
    """Carpets of every law by covariance, and the LQR settings of Table 4.1.

    Raises VehicleError where the study has no random road.
    """
    car, scenario = corner(case.vehicle), case.road[0]
    if not isinstance(scenario.road, IsoRoad):
        raise VehicleError("control laws are judged on a random road, found none; state one in [ride]")
    road, speed = scenario.road, scenario.speed
    carpets = workers.map("carpets", carpet_of, {one.name: CarpetTask(one.name, car, road, speed) for one in LAWS})
    settings = [_setting(name, one, car, road, speed, scenario.duration) for name, one in SETTINGS.items()]
    return Strategies(car, carpets, tuple(settings), _responses(car, {one.name: one.feedback for one in settings}))


def carpet_of(task: CarpetTask) -> Carpet:
    """A law over its settings, stationary."""
    one = next(law for law in LAWS if law.name == task.law)
    return carpet(task.car, task.road, task.speed, lambda a, b: one.law(task.car, a, b), *one.grids(task.car))


def _setting(
    name: str, printed: LqrWeights, car: QuarterCar, road: IsoRoad, speed: float, duration: float
) -> LqrSetting:
    weights = weights_for(car, printed)
    feedback = lqr(car, weights)
    ride = ride_of(car, feedback, road, speed)
    drawn = ensemble_indices(ride, duration, _ROADS, _SAMPLE)
    indices = indices_from_rest(ride, duration)
    return LqrSetting(name, weights, feedback, indices, float(np.mean(drawn.stroke_peak)))


def _responses(car: QuarterCar, laws: dict[str, Feedback]) -> xr.Dataset:
    """Magnitudes of the closed loops over the road's height (thesis Fig. 4.18)."""
    found = np.array([response(car, feedback, FREQUENCIES) for feedback in laws.values()])
    data = {name: (("setting", "frequency"), np.abs(found[:, k])) for k, name in enumerate(("felt", "tyre"))}
    return xr.Dataset(data, {"setting": list(laws), "frequency": FREQUENCIES})


def response(car: QuarterCar, feedback: Feedback, frequency: np.ndarray) -> np.ndarray:
    """Weighted acceleration [1/s^2] and tyre deflection (dimensionless) over the road's height, complex, (2, f).

    frequency: [Hz], (f,)
    m_s s^2 z_s = -(k_s + K) x, m_u s^2 z_u = (k_s + K) x - k_u (z_u - z_r), solved at every frequency
    """
    s = 2j * np.pi * frequency
    stroke, wheel, body_rate, wheel_rate = feedback.row
    on_body = stroke + car.spring_stiffness + s * body_rate  # force per z_s
    on_wheel = wheel - stroke - car.spring_stiffness + s * wheel_rate  # force per z_u
    a = np.array(
        [
            [car.sprung_mass * s**2 + on_body, on_wheel],
            [-on_body, car.unsprung_mass * s**2 - on_wheel + car.tyre_stiffness],
        ]
    )
    b = np.array([0.0 * s, car.tyre_stiffness + 0.0 * s])
    body, under = np.linalg.solve(np.moveaxis(a, -1, 0), b.T[..., None])[..., 0].T
    filtered = np.polyval(WEIGHTING[0], s) / np.polyval(WEIGHTING[1], s)
    return np.array([filtered * s**2 * body, under - 1])
