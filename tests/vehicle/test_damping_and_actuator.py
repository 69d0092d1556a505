"""Damper curves: what is refused, what mixing, capping and limiting make of them; the real actuator."""

import numpy as np
import pytest

from tests.vehicle.thesis import MAXIMUM_REGENERATIVE_DAMPING, REAR_DAMPER_LARGEST_DAMPING, motorcycle_damping
from vehicle.actuator import Actuator, ForceSpeedLimit
from vehicle.damping import DamperCurve, added, capped, linear_damper, mixed, read_damper_curve
from vehicle.errors import VehicleError
from vehicle.motion import Hinges

DENSE = np.linspace(-5.9, 5.9, 200_001)


def curve(velocity, force):
    return DamperCurve("test", tuple(velocity), tuple(force), "test")


@pytest.mark.parametrize(
    ("velocity", "force", "sentence"),
    [
        ((-1.0, 0.5, 0.2, 1.0), (-1.0, 0.0, 0.0, 1.0), "velocities must rise from row to row, found 0.2 m/s after 0.5"),
        ((-1.0, 0.0, 0.0, 1.0), (-1.0, 0.0, 0.0, 1.0), "velocities must rise"),
        ((-1.0, 1.0), (-1.0, 2.0), "no force at rest"),
        ((-1.0, 0.0, 1.0), (1.0, 0.0, 1.0), "never a force along the motion"),
        ((0.0, 1.0), (0.0, 1.0), "both sides of zero"),
        ((-1.0, 0.0, 1.0), (-1.0, 0.0, np.inf), "finite"),
        ((-1.0, 0.0, 1.0), (-1.0, 1.0), "as many finite forces as velocities"),
    ],
)
def test_a_curve_that_no_damper_has_is_refused(velocity, force, sentence):
    with pytest.raises(VehicleError, match=sentence):
        curve(velocity, force)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("velocity_m_per_s,force_N\n-1,-1\n0,nan\n", "row 2, column force_N: expected a finite number, found 'nan'"),
        ("velocity_m_per_s,force_N\n-1,-1\n0,zero\n", "found 'zero'"),
        ("velocity_m_per_s,force_N\n-1,-1\n0\n", "row 2, column force_N"),
        ("velocity,force_N\n-1,-1\n0,0\n", "velocity_m_per_s is missing"),
        ("velocity_m_per_s,force_N\n-1,-1\n", "two rows or more"),
    ],
)
def test_a_csv_that_is_not_a_table_is_refused(tmp_path, text, sentence):
    path = tmp_path / "curve.csv"
    path.write_text(text)
    with pytest.raises(VehicleError, match=sentence):
        read_damper_curve(path, "test")


def test_a_missing_csv_is_named(tmp_path):
    with pytest.raises(VehicleError, match="nowhere.csv: cannot be read"):
        read_damper_curve(tmp_path / "nowhere.csv", "test")


def test_a_users_csv_takes_the_place_of_the_stand_in(tmp_path):
    path = tmp_path / "mine.csv"
    path.write_text("# mine\nvelocity_m_per_s,force_N\n-2,-100\n0,0\n1,300\n")
    mine = read_damper_curve(path, "mine")
    assert mine.at(0.5) == 150 and mine.at(-1.0) == -50 and mine.source == "mine.csv"


def test_mixed_is_one_curve_in_rebound_and_the_other_in_bump():
    maximum, minimum, mix = motorcycle_damping()
    assert np.allclose(mix.at(DENSE), np.where(DENSE > 0, maximum.at(DENSE), minimum.at(DENSE)))


def test_cap_bounds_the_damping_and_nothing_else():
    maximum = motorcycle_damping()[0]
    assert maximum.largest_damping == pytest.approx(REAR_DAMPER_LARGEST_DAMPING)
    cap = capped(maximum, MAXIMUM_REGENERATIVE_DAMPING)
    assert cap.largest_damping == pytest.approx(MAXIMUM_REGENERATIVE_DAMPING)
    expected = np.sign(DENSE) * np.minimum(np.abs(maximum.at(DENSE)), MAXIMUM_REGENERATIVE_DAMPING * np.abs(DENSE))
    assert np.allclose(cap.at(DENSE), expected, atol=1e-9)


def test_sum_of_ramps_is_the_table():
    curves = [[linear_damper(1e3, "a", fastest=6.0), *motorcycle_damping()]]
    velocity = np.linspace(-5.9, 5.9, 997)
    forces = np.array([Hinges(curves).at(np.full((1, 4), v))[0] for v in velocity])
    assert np.allclose(forces, np.transpose([c.at(velocity) for c in curves[0]]), rtol=1e-12, atol=1e-9)


def test_limited_machine_follows_its_command_as_far_as_it_can():
    limit = ForceSpeedLimit((0.0, 1.0, 2.0), (1500.0, 1500.0, 500.0))
    command = linear_damper(2000.0, "command", fastest=5.0)
    force = Actuator(limit=limit).machine_curve(command).at(np.array([0.5, 0.75, 1.0, 1.5, 2.0, 2.1, -0.5, -1.5]))
    assert force == pytest.approx([1000, 1500, 1500, 1000, 500, 0, -1000, -1000])


def test_friction_adds_to_the_machine_against_the_motion():
    actuator = Actuator(coulomb_friction=50.0, viscous_friction=20.0, breakaway_speed=0.01)
    total = actuator.suspension_curve(linear_damper(100.0, "command"))
    assert total.at(np.array([0.005, 0.01, 1.0, -1.0])) == pytest.approx([25.6, 51.2, 170.0, -170.0])
    assert actuator.machine_curve(linear_damper(100.0, "command")).at(1.0) == 100


def test_sum_of_curves_is_the_sum():
    first, second = motorcycle_damping()[:2]
    assert np.allclose(added(first, second, "both").at(DENSE), first.at(DENSE) + second.at(DENSE))


@pytest.mark.parametrize(
    ("speed", "force"), [((0.0, 1.0), (1.0, -1.0)), ((0.1, 1.0), (1.0, 1.0)), ((0.0, 0.0), (1.0, 1.0))]
)
def test_a_limit_that_no_machine_has_is_refused(speed, force):
    with pytest.raises(VehicleError, match="speeds that rise from 0"):
        ForceSpeedLimit(speed, force)


def test_negative_inertia_is_refused():
    with pytest.raises(VehicleError, match="equivalent mass must not be negative"):
        Actuator(equivalent_mass=-1.0)


def test_mixed_keeps_the_rebound_order():
    """Exchanged curves would give the small force in rebound."""
    maximum, minimum, _ = motorcycle_damping()
    assert mixed(rebound=maximum, bump=minimum).at(0.1) > 3 * mixed(rebound=minimum, bump=maximum).at(0.1)
