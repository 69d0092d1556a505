"""Torque-to-length values must not move unnoticed."""

import pandas as pd
import pytest

from pipeline.reference_torques import TABLE, cases, solve

ALLOWED = 1e-3  # relative

rows = pd.read_csv(TABLE, keep_default_na=False).to_dict("records")


def name(row):
    return f"{row['overrides'] or 'study'} {row['angle_deg']:g} deg {row['j_rms_A_per_mm2']:g} A/mm2"


def test_the_table_holds_every_case():
    inputs = ("overrides", "angle_deg", "j_rms_A_per_mm2", "current_angle_deg")
    assert [[row[key] for key in inputs] for row in rows] == [[case[key] for key in inputs] for case in cases()]


@pytest.mark.parametrize("row", rows, ids=name)
def test_torque_has_not_moved(row):
    now = solve(row)
    for route in ("torque_arkkio_Nm_per_m", "torque_maxwell_Nm_per_m"):
        assert now[route] == pytest.approx(row[route], rel=ALLOWED, abs=1e-3)
