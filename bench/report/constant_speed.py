"""The page of tests at constant speed."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from bench.analysis import Analysis, CampaignTable, Records, Settings
from bench.constant_speed import SteadyPoint, StraightLine, steady_point, straight_lines
from bench.report import pictures
from figures.report import Picture, Section, Table
from units import MILLIOHM
from workbench.data.table import OPEN_CIRCUIT


def constant_speed(records: Records, settings: Settings) -> Analysis:
    """Damping and conversion efficiency of runs at constant speed over shunts."""
    points = [steady_point(record) for record in records]
    lines = straight_lines(points)
    table = _steady_table(points)
    section = Section(
        "Constant speed over a shunt",
        (
            "One record a point: means of force and velocity, and the power in the shunt over the mechanical power "
            "(thesis eq. 5.1). The lines are polynomials of first degree; their intercept is negative where a "
            "rectifier keeps a voltage to itself, and a slope says nothing about what lies below that.",
            Table(_lines_table(lines), "Straight lines over the points of one shunt."),
            Picture(pictures.steady_points(points, lines), "Force (a) and conversion efficiency (b) over velocity."),
            Table(table, "Every record."),
        ),
    )
    numbers = {"lines": _lines_table(lines).to_dict("records"), "points": table.to_dict("records")}
    return Analysis("Tests at constant speed", (section,), table, numbers, _steady_campaign(points))


def _steady_table(points: Sequence[SteadyPoint]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "record": [p.record for p in points],
            "shunt_mohm": [p.shunt / MILLIOHM for p in points],
            "velocity_m_per_s": [p.velocity for p in points],
            "force_N": [p.force for p in points],
            "force_error_N": [p.force_error for p in points],
            "shunt_power_W": [p.power for p in points],
            "efficiency_percent": [100 * p.efficiency for p in points],
            "efficiency_error_percent": [100 * p.efficiency_error for p in points],
        }
    )


def _lines_table(lines: Sequence[StraightLine]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "shunt_mohm": [line.shunt / MILLIOHM for line in lines],
            "damping_kNs_per_m": [line.damping / 1e3 for line in lines],
            "damping_error_kNs_per_m": [line.damping_error / 1e3 for line in lines],
            "intercept_N": [line.intercept for line in lines],
            "intercept_error_N": [line.intercept_error for line in lines],
            "best_efficiency_percent": [100 * line.best_efficiency for line in lines],
            "most_power_W": [line.most_power for line in lines],
        }
    )


def _steady_campaign(points: Sequence[SteadyPoint]) -> CampaignTable:
    frame = pd.DataFrame(
        {
            "velocity_m_per_s": [p.velocity for p in points],
            "shunt_mohm": [min(p.shunt, OPEN_CIRCUIT) / MILLIOHM for p in points],
            "force_N": [p.force for p in points],
        }
    )
    return CampaignTable("damping_velocity", frame, {"force_N": f"{max(p.force_error for p in points):.2g}"})
