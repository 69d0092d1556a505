"""The force observer against the force of the actuator that it watches, and against a model that is wrong."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from actuator.errors import ActuatorError
from actuator.imposed import imposed_motion
from actuator.observer import ForceObserver
from actuator.parts import Ratio
from tests.actuator.test_imposed import ROUGH, sine
from tests.actuator.thesis import RATIO, prototype

pytestmark = pytest.mark.physics
SAMPLE = 2.5e-4  # s


def seen_by(observer, found):
    angles = [observer.actuator.ratio.angle(x) for x in found.mass_stroke]
    return np.array([observer.force(angle, torque) for angle, torque in zip(angles, found.torque)])


def error(actuator, believed, bandwidth=400.0):
    """Of the observed force over a sine of 5 Hz, RMS relative to the true one, one sample late behind the low-pass."""
    time, x, v = sine(5.0, 10e-3, 0.6, SAMPLE)
    found = imposed_motion(actuator, time, x, v, 1200 * v * RATIO)
    observed = seen_by(ForceObserver(believed, SAMPLE, bandwidth), found)
    share = 1 - np.exp(-2 * np.pi * bandwidth * SAMPLE)
    true = lfilter([0.0, share], [1.0, share - 1], found.force)
    settled = time > 0.2
    return np.sqrt(np.mean((observed - true)[settled] ** 2) / np.mean(found.force[settled] ** 2))


@pytest.mark.parametrize(("actuator", "bound"), [(prototype(), 0.003), (ROUGH, 0.01)])
def test_current_and_angle_give_the_force(actuator, bound):
    """Friction, gears, play and a ratio that changes are in the model; nothing but the lag of the observer is left."""
    assert error(actuator, actuator) < bound


def test_what_the_model_does_not_know_is_missing_in_the_force():
    device = prototype()
    assert error(device, replace(device, loss=replace(device.loss, viscous=0.0))) > 0.06
    assert error(ROUGH, replace(ROUGH, gears=type(ROUGH.gears)())) > 0.06


def test_angle_of_a_changing_ratio_is_its_integral():
    ratio = Ratio((-0.1, 0.0, 0.1), (1.0e-3, 1.3e-3, 1.1e-3))
    z = np.linspace(0.0, -0.15, 200_001)
    assert ratio.angle(-0.15) == pytest.approx(np.trapezoid(1 / ratio.at(z), z), rel=1e-9)
    assert ratio.angle(0.07) > 0.07 / 1.3e-3 and ratio.angle(0.0) == 0


def test_an_observer_needs_a_bandwidth():
    with pytest.raises(ActuatorError, match="bandwidth must be above zero"):
        ForceObserver(prototype(), SAMPLE, 0.0)
