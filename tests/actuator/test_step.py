"""The stepped actuator: against the exact answer of a linear one, the whole record, and senseless inputs."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import cont2discrete

from actuator.errors import ActuatorError
from actuator.imposed import imposed_motion
from actuator.model import Actuator
from actuator.parts import RIGID, CompliantMount, MechanicalLoss, fixed_ratio
from actuator.step import Imposed, SteppedActuator, carry, pieces, stable_step
from tests.actuator.test_imposed import ROUGH, sine
from tests.actuator.thesis import RATIO, prototype

pytestmark = pytest.mark.physics


def stepped(actuator, step, velocity, force):
    """Moments after each held velocity and force."""
    one = SteppedActuator(actuator)
    moments = [one.at_rest()]
    for v, f in zip(velocity, force):
        moments.append(one.after(moments[-1], v, f, step))
    return moments[1:]


def test_linear_actuator_with_held_inputs_is_exact():
    """m x'' = k (z - x) + c (z' - x') - b x' - F with z' and F held: the matrix exponential."""
    mass, stiffness, damping, friction, step = 5.6, 2e5, 300.0, 70.0, 2.5e-4
    device = Actuator(
        ratio=fixed_ratio(RATIO),
        equivalent_mass=mass,
        mount=CompliantMount(stiffness, damping),
        loss=MechanicalLoss(friction),
    )
    a = np.array([[0, 1, 0], [-stiffness / mass, -(damping + friction) / mass, stiffness / mass], [0, 0, 0]])
    b = np.array([[0, 0], [damping / mass, -1 / mass], [1, 0]])
    a_d, b_d, *_ = cont2discrete((a, b, np.eye(3), np.zeros((3, 2))), step)
    draw = np.random.default_rng(1)
    inputs, state, exact = draw.normal(size=(200, 2)) * [0.2, 300.0], np.zeros(3), []
    for v, f in inputs:
        state = a_d @ state + b_d @ [v, f]
        exact.append(stiffness * (state[2] - state[0]) + damping * (v - state[1]))
    found = [one.answer.force for one in stepped(device, step, *inputs.T)]
    assert found == pytest.approx(exact, abs=1e-5 * np.abs(exact).max())


@pytest.mark.parametrize("actuator", [prototype(), ROUGH])
def test_step_by_step_is_the_whole_record(actuator):
    """Each step from what is imposed at its ends alone, to the last bit."""
    time, x, v = sine(12.0, 10e-3, 0.2)
    torque = 1.5 * np.sin(50 * time)
    whole, step = imposed_motion(actuator, time, x, v, torque), time[1] - time[0]
    state = np.zeros(7)
    state[:3] = x[0], v[0], torque[0]
    force = [whole.force[0]]
    for k in range(1, time.size):
        imposed = Imposed(step, x[k - 1], x[k], v[k - 1], v[k], torque[k - 1], torque[k])
        force.append(carry(actuator.numbers, imposed, pieces(step, stable_step(actuator)), state).force)
    assert (np.array(force) == whole.force).all()
    assert state[3:] == pytest.approx([whole.mount_work[-1], whole.gear_work[-1], whole.friction_work[-1],
                                       whole.motor_work[-1]], rel=1e-12)  # fmt: skip


def test_held_inputs_come_near_the_smooth_motion_with_the_step():
    """Halving the step halves the distance from the record of a smooth motion, or better."""
    device, errors = prototype(), []
    for step in (2e-4, 1e-4, 5e-5):
        time = np.arange(0.0, 0.3, step)
        x, v = 8e-3 * (1 - np.cos(60 * time)), 0.48 * np.sin(60 * time)
        force = 200 * np.sin(90 * time)
        whole = imposed_motion(device, time, x, v, force * RATIO)
        held = stepped(device, step, np.diff(x) / step, (force[1:] + force[:-1]) / 2)
        found = np.array([one.answer.force for one in held])
        errors.append(np.sqrt(np.mean((found - whole.force[1:]) ** 2)) / np.abs(whole.force).max())
    assert errors[0] < 0.03 and errors[1] < 0.6 * errors[0] and errors[2] < 0.6 * errors[1]


def test_senseless_steps_are_refused():
    device = SteppedActuator(prototype())
    with pytest.raises(ActuatorError, match="expected a finite velocity and force, found nan m/s"):
        device.after(device.at_rest(), float("nan"), 0.0, 1e-3)
    with pytest.raises(ActuatorError, match="duration must be above zero"):
        device.after(device.at_rest(), 0.0, 0.0, 0.0)
    with pytest.raises(ActuatorError, match="expected a compliant mount"):
        SteppedActuator(replace(prototype(), mount=RIGID))
