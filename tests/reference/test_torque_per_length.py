"""Torque-to-length values must not move unnoticed."""

from dataclasses import fields

import pandas as pd
import pytest

from pipeline.reference_torques import TABLE, Case, cases, solve

ALLOWED = 1e-3  # relative

rows = pd.read_csv(TABLE, keep_default_na=False).to_dict("records")


def case_of(row):
    return Case(*(row[one.name] for one in fields(Case)))


def name(row):
    return f"{row['overrides'] or 'study'} {row['angle_deg']:g} deg {row['j_rms_A_per_mm2']:g} A/mm2"


def test_the_table_holds_every_case():
    assert [case_of(row) for row in rows] == cases()


@pytest.mark.parametrize("row", rows, ids=name)
def test_torque_has_not_moved(row):
    now = solve(case_of(row))
    for route in ("torque_arkkio_Nm_per_m", "torque_maxwell_Nm_per_m"):
        assert now[route] == pytest.approx(row[route], rel=ALLOWED, abs=1e-3)
