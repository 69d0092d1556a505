"""An obstacle seen ahead: the plan against another optimiser, against the simulation, its limits, and the LQR."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.optimize import minimize

from actuator.drive import LOSS_FREE, MappedMotor, TorqueLimit
from actuator.model import Actuator
from actuator.parts import MechanicalLoss, fixed_ratio
from tests.actuator.thesis import prototype
from tests.vehicle.thesis import obstacle_shape, quarter_car
from vehicle.commands import Controller, Feedback, Felt
from vehicle.errors import VehicleError
from vehicle.models import EndStops
from vehicle.preview import PreviewTask, PreviewWeights, _Motion, force_limits, plan, with_preview
from vehicle.printed_car import TRADE_OFF
from vehicle.quarter_car import lqr
from vehicle.ride import Run, Scenario, simulate
from vehicle.road import Obstacle, Road

CAR = replace(quarter_car(), stops=EndStops(-0.08, 0.08, 1e6))
POTHOLE = Scenario("pothole", 50 / 3.6, 0.5, Obstacle(obstacle_shape(), -0.05), time_step=2.5e-4)
WEIGHTS = PreviewWeights(TRADE_OFF.wheel / CAR.sprung_mass, TRADE_OFF.stroke / CAR.sprung_mass)
RIGID = replace(prototype(), mount=Actuator().mount)


def task(ahead, actuator=RIGID, car=CAR, step=1e-2, depth=-0.05, weights=WEIGHTS):
    scenario = with_preview(replace(POTHOLE, road=Obstacle(obstacle_shape(), depth)), ahead)
    return PreviewTask(car, actuator, scenario.road, scenario.speed, scenario.duration, weights, step)


@dataclass(frozen=True)
class AtNodes(Road):
    """The road of a task as its plan sees it."""

    one: PreviewTask

    def heights(self, time, speed):
        return np.interp(time, self.one.time, self.one.road.heights(self.one.time, speed))


def cost(one, found):
    rate = np.diff(found.motor_force) / (one.car.sprung_mass * one.step)
    weights = one.weights
    squares = found.acceleration**2 + weights.tyre * found.tyre**2 + weights.stroke * found.stroke**2
    return one.step * (squares.sum() + weights.rate * (rate**2).sum())


@pytest.mark.physics
def test_no_force_nearby_and_no_other_optimiser_is_better():
    """The free optimum by BFGS on the cost of the motion."""
    one = task(0.1, step=2e-2, depth=-0.02)
    found, motion = plan(one), _Motion.of(one)

    def of(force):
        inputs = np.vstack([motion.states(force), force, motion.road])
        states = inputs[:4]
        rate = np.diff(force) / (one.car.sprung_mass * one.step)
        squares = (motion.accelerations[0] @ inputs) ** 2 + WEIGHTS.tyre * (states[1] - motion.road) ** 2
        squares = squares + WEIGHTS.stroke * (states[0] - states[1]) ** 2
        return one.step * (squares.sum() + WEIGHTS.rate * (rate**2).sum())

    free = minimize(lambda u: of(1e3 * u), np.zeros(one.time.size), method="BFGS", options={"gtol": 1e-9})
    assert of(found.motor_force) == pytest.approx(cost(one, found), rel=1e-9)
    assert of(found.motor_force) == pytest.approx(free.fun, rel=1e-4) and np.abs(1e3 * free.x).max() < 1740


@pytest.mark.physics
def test_the_plan_is_what_the_simulation_does_with_its_force():
    """Linear car, rigid actuator, planned motor force held over samples, the road straight between the nodes."""
    one = task(0.2)
    found = plan(one)
    scenario = replace(with_preview(POTHOLE, 0.2), road=AtNodes(one))

    def law(felt):
        return float(np.interp(felt.time + 1.25e-4, found.time, found.motor_force))

    still = replace(RIGID, drive=replace(RIGID.drive, time_constant=0.0))
    history = simulate([Run(CAR, Controller(law, 2.5e-4), scenario, still)])[0]
    stroke = np.interp(found.time, history.time, history.stroke)
    assert np.abs(stroke - found.stroke).max() < 0.01 * np.abs(found.stroke).max()
    force = np.interp(found.time, history.time, history.suspension_force)
    assert np.abs(force - found.force)[2:-2].max() < 0.05 * np.abs(found.force).max()


@pytest.mark.physics
def test_half_the_step_between_nodes_changes_little():
    """Nodes of 5 ms, as the plans are made, against 2.5 ms: cost to 0.5 %, force to 5 % RMS, travel to 1 %."""
    for ahead in (0.0, 0.2):
        usual, fine = ((one, plan(one)) for one in (task(ahead, step=5e-3), task(ahead, step=2.5e-3)))
        assert cost(*usual) == pytest.approx(cost(*fine), rel=5e-3)
        force = np.interp(usual[1].time, fine[1].time, fine[1].motor_force)
        assert np.std(usual[1].motor_force - force) < 0.05 * np.std(force)
        assert usual[1].stroke.max() == pytest.approx(fine[1].stroke.max(), rel=0.01)


@pytest.mark.physics
def test_force_travel_and_tyre_keep_their_bounds():
    narrow = replace(CAR, stops=EndStops(-0.06, 0.07, 1e6))
    weak = replace(
        RIGID, drive=MappedMotor(TorqueLimit((0.0, 300.0, 900.0), (1.2, 1.2, 0.3), (1.6, 1.6, 0.9)), LOSS_FREE)
    )
    for one in (task(0.3, weak, narrow), task(0.3, weak, CAR)):
        found = plan(one)
        lowest, highest = force_limits(one.actuator, found.states)
        room = 2e-3 * np.abs(found.motor_force).max()
        assert (found.motor_force <= highest + room).all() and (found.motor_force >= lowest - room).all()
        stops = one.car.stops
        assert (
            found.overtravel < 1e-6
            and stops.bump - 1e-6 < found.stroke.min() < found.stroke.max() < stops.rebound + 1e-6
        )
        assert found.lift < 1e-6 and found.tyre.max() <= one.car.actuated.static_tyre_deflection + 1e-6
    assert np.abs(plan(task(0.3)).motor_force).max() > 1.2 / RIGID.ratio.nominal  # without the limit it takes more


@pytest.mark.physics
def test_what_cannot_be_kept_is_said():
    tight = replace(CAR, stops=EndStops(-0.002, 0.002, 1e6))
    weak = replace(RIGID, drive=MappedMotor(TorqueLimit((0.0, 3e3), (0.2, 0.2), (0.2, 0.2)), LOSS_FREE))
    assert plan(task(0.0, weak, tight)).overtravel > 1e-3


@pytest.mark.physics
def test_the_further_it_sees_the_better_and_better_than_the_lqr():
    costs = [cost(task(ahead), plan(task(ahead))) for ahead in (0.0, 0.1, 0.3)]
    assert costs[0] > costs[1] > costs[2]
    history = simulate([Run(CAR, lqr(CAR, TRADE_OFF), POTHOLE, Actuator())])[0]
    squares = history.body_acceleration**2 + WEIGHTS.tyre * (history.wheel_heights[0] - history.road[0]) ** 2
    assert costs[0] < np.trapezoid(squares + WEIGHTS.stroke * history.stroke**2, history.time)


def test_limits_turn_with_the_velocity():
    """Braking along the velocity, driving against it."""
    motor = MappedMotor(TorqueLimit((0.0, 1e3), (1.0, 1.0), (2.0, 2.0)), LOSS_FREE)
    states = np.array([[0.0, 0.0], [0.0, 0.0], [0.1, 0.0], [0.0, 0.1]])
    lowest, highest = force_limits(Actuator(motor, fixed_ratio(1e-3), loss=MechanicalLoss()), states)
    assert lowest == pytest.approx([-1000.0, -2000.0]) and highest == pytest.approx([2000.0, 1000.0])


def test_a_plan_holds_to_its_states_by_feedback():
    found = plan(task(0.1))
    law = found.controller(Feedback((1e4, 0.0, 0.0, 0.0)), 1e-3).law
    k = 20
    felt = Felt(found.time[k], found.stroke[k] + 1e-3, found.states[1, k], *found.states[2:, k], 0.0, 0.0)
    assert law(felt) == pytest.approx(found.force[k] + 10.0)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: PreviewWeights(-1.0, 1.0), "tyre must not be negative"),
        (lambda: task(0.1, step=0.0), "step must be above zero"),
        (lambda: PreviewTask(CAR, RIGID, POTHOLE.road, 0.0, 1.0, WEIGHTS), "speed must be above zero"),
    ],
)
def test_wrong_input_is_one_sentence(make, sentence):
    with pytest.raises(VehicleError, match=sentence):
        make()
