"""Damper curves: what is refused, what mixing and capping make of them."""

import numpy as np
import pytest

from tests.vehicle.thesis import MAXIMUM_REGENERATIVE_DAMPING, REAR_DAMPER_LARGEST_DAMPING, motorcycle_damping
from vehicle.damping import DamperCurve, capped, mixed, read_damper_curve
from vehicle.errors import VehicleError

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


def test_mixed_keeps_the_rebound_order():
    """Exchanged curves would give the small force in rebound."""
    maximum, minimum, _ = motorcycle_damping()
    assert mixed(rebound=maximum, bump=minimum).at(0.1) > 3 * mixed(rebound=minimum, bump=maximum).at(0.1)
