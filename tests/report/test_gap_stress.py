"""What people read of the stress in the gap: known waves, torques and pulls come out in words and drawing units."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from figures.report import render_report
from magnetostatics.gap_stress_stage import GapStress
from magnetostatics.rotation import STATES, Rotation
from materials.magnet import Magnet
from report import gap_stress as report
from tests.magnetostatics.reference_machine import reference_machine

STEPS = 24
CASE = SimpleNamespace(materials=SimpleNamespace(magnet=Magnet(1.3, 1.0)))


def of_waves(centred=0.0):
    """A mean of 0.3 MPa, the magnets' wave 10, 2 and one of two periods against the rotor, growing with the current."""
    step = np.arange(STEPS)
    stress = np.zeros((3, STEPS, 2, 13))
    stress[:, :, 0, 0] = 3e5
    stress[:, :, 0, 10], stress[:, :, 1, 10] = 5e4 * np.cos(two(step)), -5e4 * np.sin(two(step))
    for state in (1, 2):
        stress[state, :, 0, 2], stress[state, :, 1, 2] = state * 1e4 * np.array([np.cos(two(step)), np.sin(two(step))])
    torque = np.array([0.0, 50.0, 120.0])[:, None] + np.array([0.4, 1.0, 3.0])[:, None] * np.cos(3 * two(step))
    data = xr.Dataset(
        {"torque": (("state", "angle"), torque), "stress": (("state", "angle", "part", "order"), stress)},
        {"state": list(STATES), "angle": np.pi / 5 * step / STEPS, "part": ["real", "imaginary"]},
    )
    cogging, pull = np.array([0.0, 0.35, 0.0, -0.35]), np.array([15e6, 14e6])
    return GapStress(Rotation(reference_machine(), 0.0, data), cogging, 50e-6, pull, np.full(2, centred))


def two(step):
    """Twice the electrical angle."""
    return 2 * np.pi * step / STEPS


def test_torques_are_told_from_peak_to_peak_and_by_orders():
    table = report.ripple_table(of_waves().rotation).set_index("current")
    assert table.loc["overload", "mean_torque_Nm_per_m"] == pytest.approx(120.0)
    assert table.loc["overload", "ripple_peak_to_peak_Nm_per_m"] == pytest.approx(6.0)
    assert table.loc["nominal", "ripple_percent"] == pytest.approx(4.0)
    assert table.iloc[0, -1].startswith("6: 2.00 %")


def test_waves_are_told_by_both_orders_and_in_every_state():
    table = report.waves_table(of_waves().rotation)
    assert table[["spatial_order", "temporal_order"]].values.tolist() == [[0, 0], [10, 2], [-2, 2]]
    assert table.iloc[1, 2:].tolist() == pytest.approx([0.1, 0.1, 0.1])
    assert table.iloc[2, 2:].tolist() == pytest.approx([0.0, 0.02, 0.04])


def test_the_section_says_cogging_lowest_order_and_pull():
    said = " ".join(part for part in report.section(of_waves(), CASE).content if isinstance(part, str))
    assert "by 0.7 Nm/m every 6° of the rotor" in said and "0.1 Nm/m apart" in said
    assert "0.3 MPa in the mean" in said
    assert "is -2 at 2 times the electrical frequency, with an amplitude of 0.04 MPa" in said
    assert "0.75 kN/m of length without current and 0.7 kN/m at the overload" in said
    assert "is pulled nowhere" in said and "Even in the middle" not in said


def test_a_machine_without_symmetry_is_said_to_pull():
    said = report.section(of_waves(centred=400.0), CASE).content[-1]
    assert said.startswith("Even in the middle of the bore the rotor is pulled aside, with up to 0.4 kN/m of length.")


def test_files_and_page(tmp_path):
    (tmp_path / "figures").mkdir()
    found = of_waves()
    for one in report.files(found):
        one.write(tmp_path / one.name)
    assert len(pd.read_csv(tmp_path / "gap_stress_waves.csv")) == 3
    assert "largest orders" in render_report((report.section(found, CASE),), tmp_path, title="", subtitle="")
