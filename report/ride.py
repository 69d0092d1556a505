"""The vehicle with the designed actuator for people: working points and histories as figures, and the section."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from drivetrain.actuator_limits import ActuatorLimits
from drivetrain.requirements import Requirements
from figures.files import File, figure_file, picture_name
from figures.report import Picture, Section, Table
from figures.vehicle import force_velocity_cloud, time_histories
from report.requirements import means_table, span_shown
from units import drawn
from vehicle.ride_again import DESIGNED_NAME, IDEAL_NAME, RideAgain, driven_actuator

_WORST = ("force_peak_N", "velocity_peak_m_per_s", "stroke_peak_mm", "tyre_load_min_N", "tyre_load_max_N",
          "time_saturated_ms")  # fmt: skip
_REACHED = 1e-3  # s; a limit that holds the actuator back for less is not reached


def files(found: RideAgain, limits: ActuatorLimits, requirements: Requirements) -> Iterator[File]:
    """Figures of the worst case with both actuators."""
    pair = found.worst_traces.by_name
    points = [("required peak force", requirements.force_peak, requirements.velocity_at_force_peak)]
    cloud = force_velocity_cloud(pair, limit=driven_actuator(limits).drive.limit.driving_at, required=points)
    yield figure_file("outcome_points", cloud)
    span = span_shown(pair, on_road=found.set_by.seed is not None)
    yield figure_file("outcome_histories", time_histories(pair, span=span))


def section(found: RideAgain, limits: ActuatorLimits) -> Section:
    """Ride and worst case with the ideal and with the designed actuator."""
    return Section(
        "The vehicle with the designed actuator",
        (
            _text(found, limits),
            Picture(picture_name("outcome_points"), "Working points of the worst case with the limit of the actuator."),
            Picture(picture_name("outcome_histories"), "The worst case with the ideal and with the designed actuator."),
            Table(worst_table(found), "The worst case."),
            Table(ride_table(found), "The random road, means over the seeds."),
        ),
    )


def worst_table(found: RideAgain) -> pd.DataFrame:
    """The worst case, one row an actuator."""
    cases = {IDEAL_NAME: found.ideal, DESIGNED_NAME: found.designed}
    return pd.DataFrame([{"actuator": name, **drawn(one, _WORST)} for name, one in cases.items()])


def ride_table(found: RideAgain) -> pd.DataFrame:
    """Means over the seeds, both actuators of a damping below each other."""
    both = {IDEAL_NAME: found.road_ideal, DESIGNED_NAME: found.road_designed}
    tables = [means_table(means).assign(actuator=name) for name, means in both.items()]
    rows = pd.concat(tables).sort_index(kind="stable").drop(columns=["velocity_rms_m_per_s", "power_rms_W"])
    return rows[["damping", "actuator", *(c for c in rows.columns if c not in ("damping", "actuator"))]]


def _text(found: RideAgain, limits: ActuatorLimits) -> str:
    ideal, designed = found.ideal, found.designed
    held = designed.time_saturated
    limit = f"its limit holds it back for {1e3 * held:.0f} ms" if held >= _REACHED else "its limit is not reached"
    return (
        f"The designed actuator in the vehicle: its force-speed limit, {limits.equivalent_mass:.1f} kg of equivalent "
        f"inertia and {limits.viscous_friction:g} Ns/m of friction in the place of the ideal one. In the worst case "
        f"({found.set_by.words}) {limit}; the largest force of the machine is {designed.force_peak:.0f} instead of "
        f"{ideal.force_peak:.0f} N, the largest tyre load {designed.tyre_load_max:.0f} instead of "
        f"{ideal.tyre_load_max:.0f} N."
    )
