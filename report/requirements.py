"""Requirements for people: every run as a table, histories and working points as figures, and the report's section."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from drivetrain.output import Output, in_unit, labelled
from drivetrain.requirements import Requirements, StatedRequirements
from figures.files import File, figure_file, picture_name, table_file
from figures.report import Picture, Section, Table, heading
from figures.vehicle import force_velocity_cloud, obstacle_peaks, requirement_bars, time_histories
from units import FACTORS, drawn, split_unit
from vehicle.demands import ROAD_SHOWN, RideCase, RideRequirements, required
from vehicle.indices import RideSummary, WorkingPoint
from vehicle.ride_means import RideMeans
from vehicle.road import Obstacle
from vehicle.traces import Trace

RUNS = "runs.csv"
OBSTACLE_SHOWN = 1.0  # s of a run over an obstacle that a figure shows
_MOST_AMPLITUDES = 7  # of obstacles in one figure: as many as there are colours
# The values as they are shown, magnitudes at the wheel.
_REQUIRED = ("maximum_damping_kNs_per_m", "force_rms_N", "velocity_rms_m_per_s", "power_rms_W",
             "velocity_peak_m_per_s", "force_peak_N", "velocity_at_force_peak_m_per_s", "power_peak_W",
             "force_at_power_peak_N", "velocity_at_power_peak_m_per_s")  # fmt: skip
_MEANS = ("comfort_rms_m_per_s2", "road_holding_rms", "stroke_peak_mm", "force_rms_N", "velocity_rms_m_per_s",
          "power_rms_W", "power_mean_W")  # fmt: skip
_SUMMARY = ("comfort_rms_m_per_s2", "comfort_peak_m_per_s2", "road_holding_rms", "road_holding_peak",
            "stroke_peak_mm", "force_rms_N", "velocity_rms_m_per_s", "power_rms_W", "power_mean_W",
            "velocity_peak_m_per_s", "energy_error")  # fmt: skip
_POINT = ("force_N", "velocity_m_per_s", "power_W")


def files(found: RideRequirements, case: RideCase, stated: StatedRequirements | None) -> Iterator[File]:
    """Table of all runs and the figures; stated: values of the study that are shown beside the ones found."""
    yield table_file(RUNS, runs_table(found))
    road, worst = found.road_traces.by_name, found.worst_traces.by_name
    on_road = found.demands.force_peak.set_by.seed is not None
    yield figure_file("ride_road", time_histories(road))
    yield figure_file("ride_worst", time_histories(worst, span=span_shown(worst, on_road)))
    yield figure_file("ride_points", force_velocity_cloud(worst, required=_points(found)))
    yield figure_file("requirements", requirement_bars(_bars(found, stated), reference="study file"))
    if _crosses_obstacles(case):
        yield figure_file("ride_obstacles", _obstacle_figure(found, case))


def section(found: RideRequirements, case: RideCase, stated: StatedRequirements | None) -> Section:
    """What the actuator must do, and which scenario asks for it."""
    return Section(
        "Requirements from the vehicle",
        (
            _runs_text(found),
            Picture(picture_name("ride_road"), "The random road with each damping strategy."),
            Table(means_table(found.ride), "The random road, means over the seeds."),
            *_obstacle_picture(case),
            Picture(picture_name("ride_worst"), "The case that sets the peak force."),
            Picture(picture_name("ride_points"), "Its working points; the damper curve of each strategy is seen."),
            Table(_table(found, stated), "What the actuator is asked for at the wheel, magnitudes."),
            *_comparison(stated),
        ),
    )


def remarks(found: RideRequirements) -> Iterator[str]:
    """What the run says at once: every value, and the scenario that set it."""
    yield from (f"{name} = {value:.4g} ({words})" for name, value, _, words in _bars(found, None))


def stated_section(requirements: Requirements, output: Output) -> Section:
    """The requirements of a study that drives no vehicle."""
    rows = [(labelled(words, unit), in_unit(getattr(requirements, name), unit)) for name, words, unit in output.demands]
    table = pd.DataFrame(rows, columns=["requirement", "value"])
    place = output.place[:1].upper() + output.place[1:]
    return Section("Requirements", ("As stated in the study file.", Table(table, f"{place}.")))


def runs_table(found: RideRequirements) -> pd.DataFrame:
    """Every run, one a row; columns end in their unit."""
    parts = {"road": found.road, "overload": found.overload}
    rows = [{"part": part, **_run_row(run)} for part, runs in parts.items() for run in runs]
    return pd.DataFrame(rows).astype({"seed": "Int64"})  # whole numbers, empty where there is none


def means_table(means: tuple[RideMeans, ...]) -> pd.DataFrame:
    """Ride on the random road, one row a damping."""
    return pd.DataFrame([{"damping": one.damping, **drawn(one, _MEANS)} for one in means])


def span_shown(traces: Mapping[str, Trace], on_road: bool) -> tuple[float, float]:
    """First and last time [s] that are drawn: an obstacle from its start, a road around the largest force of all."""
    time = next(iter(traces.values())).time
    if not on_road:
        return 0.0, min(OBSTACLE_SHOWN, float(time[-1]))
    force = np.max([np.abs(one.actuator_force) for one in traces.values()], axis=0)
    last = min(max(float(time[force.argmax()]) + ROAD_SHOWN / 2, ROAD_SHOWN), float(time[-1]))
    return max(last - ROAD_SHOWN, 0.0), last


def _run_row(run: RideSummary) -> dict[str, object]:
    row = {"scenario": run.scenario, "seed": run.seed, "damping": run.damping, **drawn(run, _SUMMARY)}
    for name, point in (("force_peak", run.at_force_peak), ("power_peak", run.at_power_peak)):
        row |= {f"at_{name}_{key}": value for key, value in drawn(point, _POINT).items()}
    return row


def _points(found: RideRequirements) -> list[tuple[str, float, float]]:
    demands = found.demands
    return [
        ("peak force", demands.force_peak.value, demands.velocity_at_force_peak.value),
        ("peak power", demands.force_at_power_peak.value, demands.velocity_at_power_peak.value),
    ]


def _set_by(found: RideRequirements) -> dict[str, str]:
    """What set each value, in words, by the name of the value without its unit."""
    words = {f.name: getattr(found.demands, f.name).set_by.words for f in fields(found.demands)}
    return {"maximum_damping": "given", **words}


def _bars(found: RideRequirements, stated: StatedRequirements | None) -> list[tuple[str, Any, Any, str]]:
    values, words = drawn(required(found), _REQUIRED), _set_by(found)
    given = drawn(stated.requirements, _REQUIRED) if stated is not None else {}
    return [(heading(name), values[name], given.get(name), words[split_unit(name)[0]]) for name in _REQUIRED]


def _table(found: RideRequirements, stated: StatedRequirements | None) -> pd.DataFrame:
    rows = pd.DataFrame(_bars(found, stated), columns=["requirement", "value", "stated", "set by"])
    return rows if stated is not None else rows.drop(columns="stated")


def _runs_text(found: RideRequirements) -> str:
    modes = ", ".join(f"{frequency:.2f}" for frequency in found.natural_frequencies)
    over = f" and {len(found.overload)} over obstacles and manoeuvres" if found.overload else ""
    peaks_from = "obstacles and manoeuvres" if found.overload else "the random road"
    return (
        f"{len(found.road)} runs on the random road{over}, each with {_dampings(found)} damping{_cap(found)}. Undamped "
        f"natural frequencies of the vehicle: {modes} Hz. The energy balance of every run closes to "
        f"{100 * found.energy_error:.2f} %. The RMS values are those of the damping with the largest RMS force; the "
        f"peaks come from {peaks_from}."
    )


def _dampings(found: RideRequirements) -> str:
    *others, last = (one.damping for one in found.ride)
    return f"{', '.join(others)} and {last}" if others else last


def _cap(found: RideRequirements) -> str:
    if found.maximum_damping == 0:
        return "; no regenerative damping is asked for"
    limit = found.maximum_damping / FACTORS["kNs_per_m"]
    return f", none above the regenerative damping of {limit:g} kNs/m"


def _obstacle_picture(case: RideCase) -> tuple[Picture, ...]:
    if not _crosses_obstacles(case):
        return ()
    return (Picture(picture_name("ride_obstacles"), "Peaks over speed and amplitude of the obstacle."),)


def _comparison(stated: StatedRequirements | None) -> tuple[Picture | str, ...]:
    if stated is None:
        return ("Decision: these values feed the match; the study states none of its own.",)
    said = "Decision: these values feed the match; what the stated ones would give is shown beside it."
    return (Picture(picture_name("requirements"), "Against the values that the study states."), said)


def _crosses_obstacles(case: RideCase) -> bool:
    return any(isinstance(scenario.road, Obstacle) for scenario in case.overload)


def _obstacle_figure(found: RideRequirements, case: RideCase) -> Figure:
    """Peaks over the speed of some amplitudes, with the damping that sets the peak force."""
    points = _obstacle_points(found, case)
    speeds = sorted({speed for speed, _ in points})
    amplitudes = _few(sorted({amplitude for _, amplitude in points}))
    peaks = {a: [(abs(points[v, a].force), abs(points[v, a].velocity)) for v in speeds] for a in amplitudes}
    return obstacle_peaks(speeds, peaks)


def _obstacle_points(found: RideRequirements, case: RideCase) -> dict[tuple[float, float], WorkingPoint]:
    """Working point of the peak force by speed [m/s] and amplitude [m]."""
    points, damping = {}, found.demands.force_peak.set_by.damping
    for run, one in zip(case.overload_runs, found.overload, strict=True):
        road = run.scenario.road
        if isinstance(road, Obstacle) and run.command.name == damping:
            points[run.scenario.speed, road.amplitude] = one.at_force_peak
    return points


def _few(amplitudes: list[float]) -> list[float]:
    """Not more amplitudes than there are colours, the ends among them."""
    last = len(amplitudes) - 1
    if last < _MOST_AMPLITUDES:
        return amplitudes
    return [amplitudes[round(k * last / (_MOST_AMPLITUDES - 1))] for k in range(_MOST_AMPLITUDES)]
