"""Equations of motion: exact linear solution, statics, free fall, end stops, conservation of energy."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import fsolve

from actuator.model import Actuator
from actuator.parts import MechanicalLoss
from tests.vehicle.thesis import (
    CRUISE_SPEED,
    LONGITUDINAL_ACCELERATION,
    motorcycle,
    motorcycle_damping,
    obstacle_shape,
    quarter_car,
)
from units import GRAVITY
from vehicle.damping import DamperCurve, linear_damper
from vehicle.equations import equations
from vehicle.errors import VehicleError
from vehicle.models import NO_STOPS, Axle, EndStops, Motorcycle, QuarterCar, Tyre
from vehicle.motion import SEEN, act, ride
from vehicle.ride import HarmonicForce, Run, Scenario, simulate
from vehicle.road import IsoRoad, Obstacle, ObstacleShape, Road, roughness_of_class

pytestmark = pytest.mark.physics

BIKE = replace(motorcycle(), front_damper=linear_damper(900.0, "front"))
FREE = replace(BIKE, rear=replace(BIKE.rear, stops=NO_STOPS))
NO_DAMPING = DamperCurve("none", (-9.0, 9.0), (0.0, 0.0), "test")
SHORT_RAMP = ObstacleShape((0.0, 0.5, 1.5, 2.0), (0.0, 1.0, 1.0, 0.0), "test")


class Step(Road):
    """The road rises by this much in a millisecond and stays there."""

    def __init__(self, height):
        self.height = height

    def heights(self, time, speed):
        return self.height * np.clip(np.asarray(time) / 1e-3, 0, 1)


def linear_system(bike, rear_damping, equivalent_mass=0.0):
    """A and road columns of the linearised motorcycle, built from matrices of Lagrange's equations."""
    strokes = bike.stretch_matrix
    masses = np.diag([bike.sprung_mass, bike.pitch_inertia, bike.front.unsprung_mass, bike.rear.unsprung_mass])
    masses += equivalent_mass * np.outer(strokes[1], strokes[1])
    springs = np.diag([bike.front.spring_stiffness, bike.rear.spring_stiffness])
    tyres = np.diag([0.0, 0.0, bike.front.tyre.stiffness, bike.rear.tyre.stiffness])
    dampers = strokes.T @ np.diag([bike.front_damper.steepest, rear_damping]) @ strokes
    inverse = np.linalg.inv(masses)
    stiffness = strokes.T @ springs @ strokes + tyres
    a = np.block([[np.zeros((4, 4)), np.eye(4)], [-inverse @ stiffness, -inverse @ dampers]])
    return a, np.vstack([np.zeros((4, 2)), (inverse @ tyres)[:, 2:]])


@pytest.mark.parametrize("equivalent_mass", [0.0, 4.9])
def test_small_motions_follow_the_matrix_exponential(equivalent_mass):
    height, rear = 1e-5, linear_damper(1500.0, "rear")
    scenario = Scenario("step", 1e6, 0.4, Step(height))
    history = simulate([Run(FREE, rear, scenario, Actuator(equivalent_mass=equivalent_mass))])[0]
    a, b = linear_system(FREE, 1500.0, equivalent_mass)
    size, ramp = 8, 1e-3
    block = np.zeros((10, 10))  # states, ramping input
    block[:size, :size], block[:size, 8] = a, b @ np.full(2, height / ramp)
    block[8, 9] = 1.0
    state = expm(block * ramp) @ np.array([0.0] * 9 + [1.0])
    held = np.zeros((9, 9))
    held[:size, :size], held[:size, 8] = a, b @ np.full(2, height)
    state = expm(held * (history.time[-1] - ramp)) @ np.append(state[:8], 1.0)
    got = [history.body_height[-1], history.pitch[-1], *history.wheel_heights[:, -1]]
    assert got == pytest.approx(state[:4], rel=2e-5, abs=1e-5 * height)


def test_natural_frequencies_of_the_motorcycle():
    assert BIKE.natural_frequencies[0] == pytest.approx(1.85, abs=0.01)
    assert BIKE.natural_frequencies == pytest.approx([1.852, 2.54, 13.7, 18.4], rel=3e-3)
    assert BIKE.rigid_tyre_frequencies[0] == pytest.approx(1.913, abs=1e-3)
    eigenvalues = np.linalg.eigvals(linear_system(replace(FREE, front_damper=NO_DAMPING), 0.0)[0])
    assert np.sort(np.abs(eigenvalues.imag))[::2] / (2 * np.pi) == pytest.approx(BIKE.natural_frequencies)


def test_natural_frequencies_of_the_quarter_car():
    body, wheel = quarter_car().natural_frequencies
    assert (2 * np.pi) ** 4 * (body * wheel) ** 2 == pytest.approx(23e3 * 126e3 / (417 * 40))  # product of the squares


def test_static_deflections():
    assert 1e3 * BIKE.rear.static_spring_deflection == pytest.approx(31.4, abs=0.05)
    assert 1e3 * BIKE.front.static_spring_deflection == pytest.approx(68.4, abs=0.05)
    assert 1e3 * BIKE.rear.static_tyre_deflection == pytest.approx(8.1, abs=0.05)
    assert 1e3 * BIKE.front.static_tyre_deflection == pytest.approx(5.3, abs=0.05)


@pytest.mark.parametrize("vehicle", [BIKE, FREE, quarter_car()], ids=["stops", "no stops", "car"])
def test_the_acceleration_is_that_of_the_forces(vehicle):
    """m a = F for each body, beyond the stops and in the air too (3.8), and the torque of the propulsion."""
    count, draw = len(vehicle.axles), np.random.default_rng(3)
    curve, propulsion = motorcycle_damping()[2], 500.0
    actuator = Actuator(equivalent_mass=5.0)
    e = equations(vehicle, actuator, curve, None, propulsion)
    seen, change, still = np.empty(e.seen), np.empty(e.size), np.zeros(count + 1)
    position = np.array([axle.position for axle in vehicle.axles])
    unsprung = np.array([axle.unsprung_mass for axle in vehicle.axles])
    for _ in range(50):
        state = np.zeros(e.size)
        state[: 4 + 2 * count] = draw.normal(size=4 + 2 * count) * np.repeat([0.1, 0.7], 2 + count)
        imposed = np.append(0.05 * draw.normal(size=count), 300.0 * draw.normal())
        ride(e, state, imposed, still, change, seen)
        act(e, state, change, seen)
        tyre, stroke, moving, stop = seen[len(SEEN) :].reshape(4, count)
        sine, cosine = np.sin(state[1]), np.cos(state[1])
        assert stroke == pytest.approx(state[0] + position * sine - state[2 : 2 + count])
        assert moving == pytest.approx(
            state[2 + count] + position * cosine * state[3 + count] - state[4 + count :][:count]
        )
        acceleration = change[2 + count : 4 + 2 * count]
        relative = acceleration[0] + position[-1] * (cosine * acceleration[1] - sine * state[3 + count] ** 2)
        own = curve.at(moving[-1]) + 5.0 * (relative - acceleration[-1])
        forces = [damper.at(v) for damper, v in zip(vehicle.passive_dampers, moving, strict=False)] + [own]
        pull = np.array([axle.spring_stiffness for axle in vehicle.axles]) * stroke + stop + forces
        assert vehicle.sprung_mass * acceleration[0] == pytest.approx(imposed[-1] - pull.sum())
        turning = (state[0] + vehicle.cog_height) * propulsion
        moment = turning - cosine * (position * pull).sum()
        assert vehicle.pitch_inertia * acceleration[1] == pytest.approx(moment, abs=1e-6)
        assert unsprung * acceleration[2:] == pytest.approx(pull - tyre)
    ride(equations(vehicle, actuator, curve, None, 0.0), 0 * state, still, still, change, seen)
    assert not change.any()


def test_vehicle_at_rest_stays_at_rest():
    history = simulate([Run(motorcycle(), linear_damper(1e3, "rear"), Scenario("rest", 0.0, 0.5))])[0]
    assert not history.stroke.any() and not history.pitch.any()
    assert history.tyre_loads[:, -1] == pytest.approx([axle.static_load for axle in BIKE.axles])


def test_a_harmonic_force_shakes_the_body_as_the_transfer_function_says():
    """Settled, against (-w^2 M + j w C + K) x = F; its work is what the damper takes."""
    car, damping, shaking = quarter_car(), 2e3, HarmonicForce(50.0, 1.3)
    step, w = 1e-3, 2 * np.pi * 1.3
    found = simulate([Run(car, linear_damper(damping, "c"), Scenario("shaken", 0.0, 12.0, body_force=shaking))])[0]
    between = car.spring_stiffness + 1j * w * damping
    dynamic = np.array([[between - w**2 * car.sprung_mass, -between],
                        [-between, between + car.tyre_stiffness - w**2 * car.unsprung_mass]])  # fmt: skip
    body, wheel = np.linalg.solve(dynamic, [50.0, 0.0])
    turn, late = np.exp(1j * w * found.time), found.time > 10.0
    for seen, expected in ((found.body_height, body), (found.stroke, body - wheel)):
        assert seen[late] == pytest.approx((expected * turn).imag[late], abs=2e-4 * abs(expected))
    work = np.trapezoid(shaking.at(found.time) * np.gradient(found.body_height, step), dx=step)
    assert found.energy.lift == pytest.approx(work, rel=1e-3) and found.energy.error < 1e-6
    with pytest.raises(VehicleError, match="frequency must be above zero, found 0"):
        HarmonicForce(50.0, 0.0)


def statics(bike, propulsion):
    """Body height, pitch, rear stroke under a propulsion force, from the balance of forces and moments."""

    def unbalance(x):
        height, pitch, front_force = x
        strokes = [front_force / bike.front.spring_stiffness, -front_force / bike.rear.spring_stiffness]
        wheels = [front_force / bike.front.tyre.stiffness, -front_force / bike.rear.tyre.stiffness]
        front = height + bike.front.position * np.sin(pitch) - wheels[0] - strokes[0]
        rear = height + bike.rear.position * np.sin(pitch) - wheels[1] - strokes[1]
        moment = (height + bike.cog_height) * propulsion - np.cos(pitch) * bike.wheelbase * front_force
        return front, rear, moment / 1e3

    height, pitch, front_force = fsolve(unbalance, (0.0, 0.0, 100.0), xtol=1e-12)
    return height, pitch, -front_force / bike.rear.spring_stiffness


def test_acceleration_ends_in_the_static_squat():
    rear = linear_damper(1500.0, "rear")
    history = simulate([Run(BIKE, rear, Scenario("0.9 g", 0.0, 12.0, longitudinal=LONGITUDINAL_ACCELERATION))])[0]
    propulsion = 275.0 * LONGITUDINAL_ACCELERATION
    assert propulsion == pytest.approx(2427, abs=0.5)
    height, pitch, stroke = statics(BIKE, propulsion)
    found = [history.body_height[-1], history.pitch[-1], history.stroke[-1]]
    assert found == pytest.approx((height, pitch, stroke), rel=1e-5)
    assert 1e3 * stroke == pytest.approx(-24.8, abs=0.3)


def test_end_stop_takes_the_load_beyond_the_free_stroke():
    stops = EndStops(bump=-0.010, rebound=0.020, stiffness=1e7)
    bike = replace(BIKE, rear=replace(BIKE.rear, stops=stops))
    history = simulate([Run(bike, linear_damper(3e3, "rear"), Scenario("squat", 0.0, 6.0, longitudinal=8.0))])[0]
    assert history.stroke[-1] == pytest.approx(-0.010, abs=1e-4) and history.stroke[-1] < -0.010
    assert history.stop_force[-1] == pytest.approx(1e7 * (history.stroke[-1] + 0.010))
    late = history.time > 3.0  # on the stop only the front damps
    force = bike.rear.spring_stiffness * history.stroke[late].mean() + history.stop_force[late].mean()
    assert history.tyre_loads[1, late].mean() - bike.rear.static_load == pytest.approx(-force, rel=5e-3)


def test_a_car_in_the_air_falls_freely():
    """Centre of mass between leaving the road and landing: a parabola with g."""
    car = quarter_car()
    run = Run(car, linear_damper(1500.0, "car", fastest=20.0), Scenario("jump", 15.0, 0.6, Obstacle(SHORT_RAMP, 0.15)))
    history = simulate([run])[0]
    airborne = np.flatnonzero(history.tyre_loads[0] == 0)
    first = airborne[: np.flatnonzero(np.diff(airborne, append=airborne[-1] + 9) > 1)[0] + 1]
    assert len(first) > 40
    heights = (car.sprung_mass * history.body_height + car.unsprung_mass * history.wheel_heights[0]) / car.total_mass
    curvature = np.polyfit(history.time[first], heights[first], 2)[0]
    assert 2 * curvature == pytest.approx(-GRAVITY, rel=1e-3)
    assert history.road_holding[first] == pytest.approx(1.0)
    assert (history.tyre_loads >= 0).all()


def test_energy_is_conserved_without_dampers():
    bike = replace(motorcycle(), front_damper=NO_DAMPING)
    for step, error in ((2.5e-4, 5e-3), (1.25e-4, 1e-3)):
        roads = [Obstacle(SHORT_RAMP, amplitude) for amplitude in (0.02, -0.05)]  # the pothole ends on the stops
        scenarios = [Scenario("free", 10.0, 2.0, road, time_step=step) for road in roads]
        for history in simulate([Run(bike, NO_DAMPING, scenario) for scenario in scenarios]):
            assert history.energy.passive == history.energy.actuator == 0
            assert history.energy.stored > 1 and history.energy.error < error


@pytest.mark.parametrize("actuator", [Actuator(), Actuator(equivalent_mass=15.0, loss=MechanicalLoss(coulomb=70.0))])
def test_energy_balances_over_road_pothole_and_acceleration(actuator):
    bike, rear = motorcycle(), linear_damper(1500.0, "rear")
    scenarios = (
        Scenario("road", CRUISE_SPEED, 4.0, IsoRoad(roughness_of_class("D"), seed=1)),
        Scenario("pothole", 50 / 3.6, 2.0, Obstacle(obstacle_shape(), -0.05), time_step=2.5e-4),
        Scenario("acceleration", 0.0, 4.0, longitudinal=LONGITUDINAL_ACCELERATION),
    )
    for history in simulate([Run(bike, rear, scenario, actuator) for scenario in scenarios]):
        assert history.energy.error < 5e-3
        assert history.energy.actuator > 0
        if history.run.scenario.name == "acceleration":
            assert history.energy.road == 0 and history.energy.propulsion > 0


def test_locked_suspension_moves_as_one():
    """A very large equivalent mass holds the stroke; both masses then ride on the tyre alone."""
    car = QuarterCar(417.0, 40.0, 23e3, 126e3)
    actuator = Actuator(equivalent_mass=1e7)
    history = simulate([Run(car, NO_DAMPING, Scenario("step", 1.0, 2.0, Step(1e-3)), actuator)])[0]
    assert np.abs(history.stroke).max() < 2e-6
    omega = np.sqrt(126e3 / 457.0)
    expected = 1e-3 * (1 - np.cos(omega * (history.time - 0.5e-3)))
    assert history.body_height[5:] == pytest.approx(expected[5:], abs=1e-5)


def test_equivalent_mass_appears_in_the_suspension_force():
    """Force on the wheel from the tyre and the suspension gives its acceleration."""
    car, step = quarter_car(), 2.5e-4
    actuator = Actuator(equivalent_mass=6.7)
    scenario = Scenario("bump", 5.0, 1.0, Obstacle(SHORT_RAMP, 0.02), time_step=step)
    history = simulate([Run(car, linear_damper(2e3, "c"), scenario, actuator)])[0]
    body = -(car.spring_stiffness * history.stroke + history.suspension_force) / car.sprung_mass
    assert body == pytest.approx(history.body_acceleration, abs=1e-9)
    rate = np.gradient(np.gradient(history.body_height, step), step)
    assert np.sqrt(np.mean((rate - body)[4:-4] ** 2)) < 0.02 * np.sqrt(np.mean(body**2))


def test_runs_together_are_the_runs_alone():
    rear = (linear_damper(1500.0, "a"), linear_damper(900.0, "b"))
    runs = [Run(BIKE, c, Scenario("s", 12.0, 0.5, Obstacle(obstacle_shape(), a))) for c in rear for a in (0.02, -0.03)]
    runs.insert(2, Run(quarter_car(), rear[0], Scenario("s", 12.0, 0.5, Obstacle(obstacle_shape(), 0.01))))
    together, alone = simulate(runs), [simulate([run])[0] for run in runs]
    for one, other in zip(together, alone, strict=True):
        assert one.run == other.run
        assert one.stroke == pytest.approx(other.stroke, abs=1e-12)


def test_smaller_steps_change_little():
    rear, road = linear_damper(1500.0, "a"), Obstacle(obstacle_shape(), -0.05)
    coarse, fine = simulate([Run(BIKE, rear, Scenario("s", 50 / 3.6, 1.0, road, time_step=h)) for h in (1e-3, 1.25e-4)])
    assert coarse.stroke == pytest.approx(fine.stroke[::8], abs=2e-4)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda: replace(BIKE, sprung_mass=-227.0), "sprung mass must be above zero, found -227"),
        (lambda: replace(BIKE, sprung_mass=300.0), "the axles carry 227 kg of a body of 300 kg"),
        (lambda: replace(BIKE, pitch_inertia=0.0), "pitch inertia must be above zero"),
        (lambda: replace(BIKE.rear, unsprung_mass=-28.0), "unsprung mass must be above zero, found -28"),
        (lambda: replace(BIKE, front=BIKE.rear, rear=BIKE.front), "front axle must lie ahead"),
        (lambda: QuarterCar(417.0, -40.0, 23e3, 126e3), "unsprung mass must be above zero"),
        (lambda: Tyre(float("nan")), "stiffness must be above zero, found nan"),
        (lambda: EndStops(0.02, -0.14, 1e7), "bump must be below"),
        (lambda: Axle(0.0, 1.0, 1.0, -5.0, Tyre(1.0)), "spring stiffness must be above zero"),
    ],
)
def test_impossible_vehicles_are_refused(change, sentence):
    with pytest.raises(VehicleError, match=sentence):
        change()


def test_motorcycle_is_a_value():
    assert motorcycle() == motorcycle() and isinstance(motorcycle(), Motorcycle)


def test_leaving_the_damper_curve_is_refused():
    slow = linear_damper(1500.0, "slow", fastest=0.5)
    with pytest.raises(VehicleError, match="the damper curve 'slow' is known from -0.5 to 0.5 m/s; extend the curve"):
        simulate([Run(BIKE, slow, Scenario("pothole", 50 / 3.6, 1.0, Obstacle(obstacle_shape(), -0.05)))])
