"""Force laws of the parts: energy, tangent, and the compiled equations that say them a second time."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from actuator.compiled import inside
from actuator.drive import DcLoad, DiodeBridge, TorqueLimit, flat_limit
from actuator.errors import ActuatorError
from actuator.model import Actuator
from actuator.parts import CompliantMount, GearEfficiency, MechanicalLoss, Ratio, fixed_ratio
from tests.actuator.thesis import prototype

MOUNT = CompliantMount(5e5, damping=300.0, play=2e-4, contact_damping=100.0, transition=1.5e-3)
MOUNTS = (MOUNT, replace(MOUNT, play=0.0, transition=0.0), replace(MOUNT, transition=0.0), prototype().mount)


@pytest.mark.physics
@pytest.mark.parametrize("mount", MOUNTS)
def test_force_is_the_slope_of_the_energy_and_its_slope_the_tangent(mount):
    for d in (-5e-3, -9e-4, 1e-4, 3e-4, 1.2e-3, 4e-3):
        work = quad(lambda x: float(mount.force(x, 0.0)), 0.0, d, points=[np.sign(d) * mount.play], epsabs=1e-14)[0]
        assert float(mount.energy(d)) == pytest.approx(work, rel=1e-9, abs=1e-12)
        stiffness = (mount.force(d + 1e-9, 0.0) - mount.force(d - 1e-9, 0.0)) / 2e-9
        assert mount.tangent(d)[0] == pytest.approx(float(stiffness), rel=1e-4, abs=1.0)
        assert mount.tangent(d)[1] == pytest.approx(float(mount.force(d, 1.0) - mount.force(d, 0.0)))


@pytest.mark.physics
def test_mount_is_free_in_its_play_and_hard_beyond_its_transition():
    assert MOUNT.force(1.9e-4, 0.5) == pytest.approx(300 * 0.5)  # the damping alone
    assert MOUNT.force(3e-3, 0.0) == pytest.approx(5e5 * 2.8e-3)
    assert MOUNT.force(-3e-3, 0.0) == pytest.approx(-5e5 * 2.8e-3)


@pytest.mark.parametrize("mount", MOUNTS)
def test_compiled_force_is_that_of_the_parts(mount):
    draw = np.random.default_rng(1)
    part = Actuator(mount=mount, equivalent_mass=5.0).numbers
    for d, rate in zip(draw.normal(scale=1.5e-3, size=200), draw.normal(size=200), strict=True):
        found = inside(part.numbers, part.ratio, d, rate, 0.0, 0.0, 0.0)
        assert found.force == pytest.approx(float(mount.force(d, rate)), rel=1e-12, abs=1e-12)


@pytest.mark.physics
@pytest.mark.parametrize("mount", [{}, {"mount": CompliantMount(1e6), "equivalent_mass": 5.0}])
def test_gears_take_their_share_in_both_directions(mount):
    """A motor of 2 Nm behind 1 mm/rad: what the output gives when it drives, and gets when it is driven."""
    gears = GearEfficiency(driven=0.8, driving=0.9)
    part = Actuator(ratio=fixed_ratio(1e-3), gears=gears, **mount).numbers
    for torque, force in ((2.0, 2000 / 0.8), (-2.0, -2000 * 0.9)):
        deformation = force / 1e6 if mount else 0.0
        found = inside(part.numbers, part.ratio, deformation, 0.5, 0.0, 0.5, torque)
        assert found.force == pytest.approx(force) and found.acceleration == pytest.approx(0.0, abs=1e-9)
        assert found.gears == pytest.approx(0.5 * (force - 1e3 * torque))
    backwards = inside(part.numbers, part.ratio, -2e3 / 0.8 / 1e6 if mount else 0.0, -0.5, 0.0, -0.5, -2.0)
    assert backwards.force == pytest.approx(-2000 / 0.8) and backwards.gears > 0


@pytest.mark.physics
def test_bridge_against_its_waveforms():
    """Ideal diodes and a resistance: at each instant the largest line-to-line voltage less two drops drives it.

    The power of the waveform exceeds that of its mean by the square of its ripple, 0.2 %.
    """
    bridge = DiodeBridge(0.05, 0.03, 0.0, 5, DcLoad(0.1), diode_drop=0.4, fastest=500.0)
    speed = np.array([40.0, 150.0, 400.0])
    phase = np.linspace(0.0, 2 * np.pi, 6000, endpoint=False)[:, None] + 2 * np.pi / 3 * np.arange(3)
    for w in speed:
        voltages = 2 / 3 * 0.05 * w * np.cos(phase)
        line = voltages.max(axis=1) - voltages.min(axis=1)
        current = np.maximum(line - 0.8, 0) / (2 * 0.03 + 0.1)
        shaft = float(np.mean(line * current))
        assert float(bridge.torque(np.array([w]))[0]) * w == pytest.approx(shaft, rel=4e-3)
        lost = float(np.mean(line * current - 0.1 * current**2))
        assert float(bridge.at(np.array([shaft / w]), np.array([w]))[0]) == pytest.approx(lost, rel=6e-3)


@pytest.mark.physics
def test_bridge_begins_at_its_diodes_and_fades_with_its_inductance():
    bridge = DiodeBridge(0.05, 0.03, 2e-4, 5, DcLoad(0.0), diode_drop=0.4, fastest=3000.0)
    silent = 0.8 / (1.6540 * 2 / 3 * 0.05)
    assert bridge.torque(np.array([0.99 * silent]))[0] == 0 < bridge.torque(np.array([1.01 * silent]))[0]
    torque = bridge.torque(np.array([20.0, 80.0, 3000.0]))
    assert torque[1] > torque[0] and torque[1] > torque[2]
    assert bridge.time_constant == pytest.approx(2e-4 / 0.03)


def test_ratio_between_its_points_and_beyond():
    ratio = Ratio((-0.1, 0.02), (2.0e-3, 2.6e-3))
    assert ratio.nominal == pytest.approx(2.5e-3)
    assert ratio.at(0.5) == 2.6e-3 and ratio.at(-0.04) == pytest.approx(2.3e-3)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: CompliantMount(-5e5), "compliant mount: stiffness must be above zero, found -500000"),
        (lambda: CompliantMount(5e5, play=-1e-4), "play must not be negative"),
        (lambda: Actuator(mount=MOUNT), "behind a compliant mount: equivalent mass must be above zero"),
        (lambda: Actuator(equivalent_mass=-1.0), "equivalent mass must not be negative"),
        (lambda: GearEfficiency(driving=1.2), "efficiency when driving must lie above 0 and not above 1, found 1.2"),
        (lambda: MechanicalLoss(viscous=-1.0), "viscous must not be negative"),
        (lambda: Ratio((0.0, 0.0), (1.0, 1.0)), "strokes that rise"),
        (lambda: fixed_ratio(0.0), "expected positive finite ratios"),
        (lambda: TorqueLimit((0.1, 1.0), (1.0, 1.0), (1.0, 1.0)), "speeds that rise from 0"),
        (lambda: flat_limit(-1.0, 100.0), "torques of zero or more"),
        (lambda: DiodeBridge(0.05, 0.0, 0.0, 5, DcLoad(1.0), 0.4, 100.0), "phase resistance must be above zero"),
    ],
)
def test_what_no_actuator_has_is_refused(make, sentence):
    with pytest.raises(ActuatorError, match=sentence):
        make()
