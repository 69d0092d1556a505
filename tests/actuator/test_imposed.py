"""An actuator whose output is moved: exact linear answer, energy balance, step size, limits of the drive."""

from dataclasses import replace

import numpy as np
import pytest

from actuator.drive import MappedMotor, TorqueLimit
from actuator.errors import ActuatorError
from actuator.imposed import imposed_motion
from actuator.model import Actuator
from actuator.parts import CompliantMount, GearEfficiency, MechanicalLoss, Ratio, fixed_ratio
from tests.actuator.thesis import RATIO, prototype

pytestmark = pytest.mark.physics
BENCH = 1 / 4000  # s, sampling of the identification, text to eq. 4.28


def sine(frequency, amplitude, duration, step=BENCH):
    time = np.arange(0.0, duration, step)
    omega = 2 * np.pi * frequency
    return time, amplitude * np.sin(omega * time), amplitude * omega * np.cos(omega * time)


@pytest.mark.parametrize("frequency", [5.0, 30.0, 80.0])
def test_linear_actuator_has_the_impedance_of_appendix_b(frequency):
    """Equation B.4 with open terminals, parameters of Table B.1; the last ten periods, when all else has died out."""
    mass, friction, stiffness, damping = 5.6, 250.0, 2e5, 50.0
    actuator = Actuator(
        equivalent_mass=mass, mount=CompliantMount(stiffness, damping), loss=MechanicalLoss(viscous=friction)
    )
    time, x, v = sine(frequency, 1e-3, 1.0 + 10 / frequency, step=1e-4)
    found = imposed_motion(actuator, time, x, v, 0 * time)
    tail = time > time[-1] - 10 / frequency
    s = 2j * np.pi * frequency
    basis = np.exp(-s * time[tail])
    measured = (found.force[tail] @ basis) / (v[tail] @ basis)
    numerator = (s + friction / mass) * (s * damping + stiffness)
    assert measured == pytest.approx(numerator / (s**2 + s * (friction + damping) / mass + stiffness / mass), rel=1e-4)


ROUGH = Actuator(
    drive=MappedMotor(time_constant=2e-3),
    ratio=Ratio((-0.1, 0.1), (1.0e-3, 1.6e-3)),
    equivalent_mass=5.0,
    mount=CompliantMount(5e5, 300.0, 2e-4, 100.0, 1.5e-3),
    loss=MechanicalLoss(viscous=70.0, coulomb=60.0, breakaway_speed=0.02),
    gears=GearEfficiency(0.9, 0.88),
)


@pytest.mark.parametrize("actuator", [prototype(), ROUGH, replace(ROUGH, mount=Actuator().mount)])
def test_what_goes_in_is_lost_or_stored(actuator):
    time, x, v = sine(7.0, 20e-3, 0.6)
    found = imposed_motion(actuator, time, x, v, 1.5 * np.sin(50 * time), finest=2e-5)
    lost = sum(one[-1] for one in (found.mount_work, found.gear_work, found.friction_work, found.motor_work))
    mass = actuator.equivalent_mass * (actuator.ratio.nominal / actuator.ratio.at(found.mass_stroke)) ** 2
    energy = mass * found.mass_velocity**2 / 2
    if isinstance(actuator.mount, CompliantMount):
        energy = energy + actuator.mount.energy(x - found.mass_stroke)
    moved = float(np.trapezoid(np.abs(found.force * v), time))
    assert found.work - lost - (energy[-1] - energy[0]) == pytest.approx(0.0, abs=1e-4 * moved)
    assert min(one[-1] for one in (found.mount_work, found.gear_work, found.friction_work)) >= 0


@pytest.mark.parametrize(("actuator", "bound"), [(prototype(), 1e-4), (ROUGH, 2e-3)])
def test_a_finer_step_changes_nothing(actuator, bound):
    time, x, v = sine(15.0, 3e-3, 0.5)
    torque = 4e3 * v * RATIO
    coarse, fine = (imposed_motion(actuator, time, x, v, torque, finest=step).force for step in (None, BENCH / 40))
    assert np.abs(coarse - fine).max() < bound * np.abs(fine).max()


def test_torque_follows_its_command_with_its_lag_and_within_its_limit():
    limit = TorqueLimit((0.0, 100.0, 200.0), (3.0, 3.0, 1.0), (4.0, 4.0, 2.0))
    actuator = Actuator(drive=MappedMotor(limit, time_constant=5e-3), ratio=fixed_ratio(1e-3))
    time = np.arange(0.0, 0.05, 1e-4)
    command = np.where(time > 0, 2.0, 0.0)
    still = imposed_motion(actuator, time, 0 * time, 0 * time, command)
    assert np.interp(5e-3, time, still.torque) == pytest.approx(2 * (1 - np.exp(-1)), rel=0.02)
    assert still.force == pytest.approx(1e3 * still.torque)
    asked = ((50.0, 9.0, 4.0), (50.0, -9.0, -3.0), (-150.0, 9.0, 2.0), (-150.0, -9.0, -3.0), (250.0, 1.0, 0.0))
    for speed, command, torque in asked:
        v = np.full_like(time, speed * 1e-3)
        moving = imposed_motion(actuator, time, v * time, v, np.full_like(time, command))
        assert moving.torque[-1] == pytest.approx(torque, abs=1e-3)


def test_records_that_do_not_match_are_refused():
    time, x, v = sine(5.0, 1e-3, 0.1)
    with pytest.raises(ActuatorError, match="same equally spaced times"):
        imposed_motion(prototype(), time, x[:-1], v, 0 * v)
    with pytest.raises(ActuatorError, match="same equally spaced times"):
        imposed_motion(prototype(), time**2, x, v, 0 * v)
