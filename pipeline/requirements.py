"""Requirements on the actuator from runs of the vehicle over speed, amplitude and damping strategy (thesis Table 3.7).

Reads the study and its tables, writes ``requirements.json`` (values, and the scenario that set each), ``runs.csv``
(every run), ``road_histories.nc`` (the actuator on the random road with the damping that sets the RMS force, for the
fatigue of the gears) and figures. A task is a handful of runs, which are integrated together.
"""

from __future__ import annotations

import json
import sys
from functools import lru_cache

from pipeline.feeds import REQUIREMENTS as OUTPUT
from pipeline.stage import Stage, StageError, command, results_folder
from study.chain import drives
from study.read import read_study

RUNS, HISTORIES = "runs.csv", "road_histories.nc"
FIGURES = {
    "ride_road": "figures/ride_road.png",
    "ride_worst": "figures/ride_worst.png",
    "ride_points": "figures/ride_points.png",
    "requirements": "figures/requirements.png",
}
OBSTACLE_FIGURE = {"ride_obstacles": "figures/ride_obstacles.png"}  # of a study with obstacles
SECTIONS = ("chain", "motorcycle", "quarter_car", "dampers", "ride", "obstacles", "acceleration", "requirements")
CODE = ("units", "vehicle", "figures.style", "figures.vehicle", "study.convert_vehicle", "pipeline.requirements")
_TOGETHER = {"road": 9, "overload": 48}  # runs of a task
_SHOWN_ROAD, _SHOWN_OBSTACLE = 6.0, 1.0  # s of a history that are drawn


def figures_of(study) -> dict[str, str]:
    """Figures of the stage by name: fewer without obstacles, none where the requirements are stated."""
    if not drives(study):
        return {}
    return FIGURES | (OBSTACLE_FIGURE if study.obstacles is not None else {})


def stage_of(study) -> Stage:
    """The requirements of a study."""
    from study.convert_vehicle import vehicle_files

    outputs = (OUTPUT, RUNS, HISTORIES, *figures_of(study).values())
    return Stage(
        "requirements", results_folder(study.study.id), study.subset(*SECTIONS), vehicle_files(study), CODE, outputs
    )


def runs_of_part(study, part: str) -> list:
    """All runs of the "road" or of the "overload", in a fixed order."""
    from study import convert_vehicle as convert
    from vehicle.requirements import runs_of

    scenarios = {"road": convert.to_road_scenarios, "overload": convert.to_overload_scenarios}[part](study)
    return runs_of(convert.to_vehicle(study), convert.to_damping(study), scenarios)


def solve_runs(task: dict) -> list[dict]:
    """Summaries of the runs of a task."""
    from vehicle.requirements import summaries

    runs = _runs(task["study"], task["part"])[task["first"] : task["first"] + _TOGETHER[task["part"]]]
    return [found.as_dict() for found in summaries(runs)]


@lru_cache(maxsize=2)
def _runs(path: str, part: str):
    return runs_of_part(read_study(path), part)


def tasks_of(study) -> dict[str, dict]:
    """Handfuls of runs by their names."""
    path = str(study.path.resolve())
    return {
        f"{part}, from run {first}": {"study": path, "part": part, "first": first}
        for part, size in _TOGETHER.items()
        for first in range(0, len(runs_of_part(study, part)), size)
    }


def summaries_of(results: dict[str, list[dict]]) -> dict[str, list]:
    """``RideSummary`` of all runs, by part."""
    from vehicle.indices import RideSummary

    return {
        part: [RideSummary.from_dict(row) for name, rows in results.items() if name.startswith(part) for row in rows]
        for part in _TOGETHER
    }


def required_of(study, parts: dict[str, list]):
    """``Requirements``; without obstacles and manoeuvres the peaks are those on the random road."""
    from vehicle.requirements import requirements

    damping = study.ride.maximum_regenerative_damping_kNs_per_m * 1e3
    return requirements(damping, parts["road"], parts["overload"] or parts["road"])


def as_section(required) -> dict[str, float]:
    """The keys of [requirements], magnitudes in drawing units."""
    from units import split_unit
    from study.schema import RequirementsSection

    factors = _factors()
    names = {key: split_unit(key) for key in RequirementsSection.model_fields}
    return {key: abs(getattr(required, name).value) / factors[unit] for key, (name, unit) in names.items()}


def _scenarios(required) -> dict[str, str]:
    from units import split_unit
    from study.schema import RequirementsSection

    return {key: getattr(required, split_unit(key)[0]).scenario for key in RequirementsSection.model_fields}


def _outcome(study, required, parts) -> dict:
    from dataclasses import asdict

    worst = max(run.energy_error for runs in parts.values() for run in runs)
    return {
        "values": as_section(required),
        "scenarios": _scenarios(required),
        "signed_SI": {name: entry["value"] for name, entry in asdict(required).items()},
        "runs": {part: len(runs) for part, runs in parts.items()},
        "ride": _ride_of_damping(parts["road"]),
        "largest_energy_error": worst,
        "natural_frequencies_Hz": _frequencies(study),
        "peaks_from": "obstacles and manoeuvres" if parts["overload"] else "the random road",
    }


def _frequencies(study) -> list[float]:
    from study.convert_vehicle import to_vehicle

    return [float(value) for value in to_vehicle(study).natural_frequencies]


def _ride_of_damping(runs: list) -> list[dict]:
    """Means over the seeds on the random road, one row a damping (thesis Table 3.4)."""
    columns = ("comfort_rms_m_per_s2", "road_holding_rms", "stroke_peak_mm", "force_rms_N", "velocity_rms_m_per_s",
               "power_rms_W", "power_mean_W")  # fmt: skip
    dampings = dict.fromkeys(run.damping for run in runs)
    return [
        {"damping": damping, **mean_of_seeds([run for run in runs if run.damping == damping], columns)}
        for damping in dampings
    ]


def mean_of_seeds(runs: list, columns) -> dict[str, float]:
    """Means over runs, in drawing units; magnitudes, since the sign of a peak differs from seed to seed."""
    import numpy as np
    from units import split_unit

    found = {}
    for column in columns:
        name, unit = split_unit(column)
        values = np.abs([getattr(run, name) for run in runs])
        found[column] = float(values.mean() / _factors()[unit])
    return found


def _factors() -> dict[str, float]:
    """SI value of every unit that a key may end in."""
    from units import QUANTITIES

    return {"": 1.0} | {unit: factor for row in QUANTITIES for unit, factor in row.items()}


def _table(parts: dict[str, list]):
    import pandas as pd

    return pd.json_normalize([{"part": part, **run.as_dict()} for part, runs in parts.items() for run in runs])


def nominal_damping(required) -> str:
    """Name of the damping that sets the RMS force."""
    return required.force_rms.scenario.split(", ")[1].removesuffix(" damping")


def run_named(study, part: str, scenario: str) -> list:
    """The runs of one scenario, one a damping."""
    return [run for run in runs_of_part(study, part) if run.scenario.name == scenario]


def _simulated(study, parts, required) -> dict[str, list]:
    """Histories that are kept or drawn, in one go: "nominal" over the seeds, "road" and "worst" with each damping."""
    from vehicle.ride import simulate

    road, damping = runs_of_part(study, "road"), nominal_damping(required)
    wanted = {
        "nominal": [run for run in road if run.damping.name == damping],
        "road": road[:3],
        "worst": run_named(study, *_worst(parts, required)),
    }
    found = iter(simulate([run for runs in wanted.values() for run in runs]))
    return {name: [next(found) for _ in runs] for name, runs in wanted.items()}


def _histories(study, nominal: list, damping: str):
    """Force, velocity and stroke of the actuator on the random road, (seed, time)."""
    import numpy as np
    import xarray as xr

    columns = {"force_N": "actuator_force", "velocity_m_per_s": "velocity", "stroke_m": "stroke"}
    data = {key: (("seed", "time_s"), np.array([getattr(h, name) for h in nominal])) for key, name in columns.items()}
    seeds = list(study.ride.road_seeds)
    return xr.Dataset(data, {"seed": seeds, "time_s": nominal[0].time}, {"damping": damping})


def _draw(study, required, parts, kept: dict[str, list]):
    """Yield (name, Figure)."""
    from figures import vehicle as draw

    road, worst = ({one.run.damping.name: one for one in kept[name]} for name in ("road", "worst"))
    yield "ride_road", draw.time_histories(road, span=(0.0, min(_SHOWN_ROAD, study.ride.road_duration_s)))
    yield "ride_worst", draw.time_histories(worst, span=span_shown(_worst(parts, required)[0], kept["worst"]))
    points = [
        ("peak force", required.force_peak.value, required.velocity_at_force_peak.value),
        ("peak power", required.force_at_power_peak.value, required.velocity_at_power_peak.value),
    ]
    yield "ride_points", draw.force_velocity_cloud(worst, required=points)
    yield "requirements", draw.requirement_bars(_bars(study, required), reference="study file")
    if study.obstacles is not None:
        yield "ride_obstacles", _obstacle_figure(study, parts["overload"], required)


def span_shown(part: str, histories) -> tuple[float, float]:
    """First and last time [s] that are drawn: an obstacle from its start, a road around the largest force of all."""
    import numpy as np

    time, force = next(iter(histories)).time, np.max([np.abs(one.actuator_force) for one in histories], axis=0)
    if part == "overload":
        return 0.0, min(_SHOWN_OBSTACLE, time[-1])
    last = min(max(time[force.argmax()] + _SHOWN_ROAD / 2, _SHOWN_ROAD), time[-1])
    return max(last - _SHOWN_ROAD, 0.0), last


def _worst(parts, required) -> tuple[str, str]:
    """(part, scenario) that set the peak force."""
    part = "overload" if parts["overload"] else "road"
    return part, required.force_peak.scenario.rsplit(", ", 1)[0]


def _bars(study, required):
    from figures.report import heading

    given = study.requirements.model_dump() if study.requirements is not None else {}
    values, scenarios = as_section(required), _scenarios(required)
    return [(heading(key), value, given.get(key), scenarios[key]) for key, value in values.items()]


def _obstacle_figure(study, runs, required):
    """Peaks over the speed of every other amplitude, with the damping that sets the peak force."""
    from figures.vehicle import obstacle_peaks
    from units import MILLIMETRE
    from vehicle.requirements import obstacle_name

    damping = required.force_peak.scenario.rsplit(", ", 1)[1].removesuffix(" damping")
    found = {run.scenario: run.at_force_peak for run in runs if run.damping == damping}
    speeds = sorted(speed / 3.6 for speed in study.obstacles.speeds_km_per_h)
    amplitudes = _few(sorted(amplitude * MILLIMETRE for amplitude in study.obstacles.amplitudes_mm))
    points = {a: [found[obstacle_name(speed, a)] for speed in speeds] for a in amplitudes}
    peaks = {a: [(abs(point.force), abs(point.velocity)) for point in row] for a, row in points.items()}
    return obstacle_peaks(speeds, peaks)


def _few(amplitudes: list[float], most: int = 7) -> list[float]:
    """Not more amplitudes than there are colours, the ends among them."""
    if len(amplitudes) <= most:
        return amplitudes
    steps = [round(k * (len(amplitudes) - 1) / (most - 1)) for k in range(most)]
    return [amplitudes[k] for k in steps]


def _run(study, checkpoint) -> dict[str, list[dict]]:
    """All tasks in parallel; VehicleError where one was refused by the vehicle."""
    from pipeline.parallel import default_workers, run_parallel
    from vehicle.errors import VehicleError

    try:
        return run_parallel(solve_runs, tasks_of(study), default_workers(), checkpoint, "requirements")
    except StageError as error:
        if isinstance(error.__cause__, VehicleError):
            raise error.__cause__ from None
        raise


def main(name: str) -> None:
    """Run the vehicle of a study."""
    study = read_study(name)
    if not drives(study):
        print("requirements: stated in the study, no vehicle is run")
        return

    def work(run):
        from figures.style import save_png
        from study.usable import check_study
        from vehicle.errors import VehicleError

        check_study(study)
        try:
            results = _run(study, run.checkpoint())
            parts = summaries_of(results)
            required = required_of(study, parts)
            kept = _simulated(study, parts, required)
        except VehicleError as error:
            raise StageError(f"no requirements: {error}") from None
        outcome = _outcome(study, required, parts)
        for key, value in outcome["values"].items():
            print(f"requirements: {key} = {value:.4g} ({outcome['scenarios'][key]})")
        run.note(runs=outcome["runs"], largest_energy_error=outcome["largest_energy_error"])
        run.write_text(OUTPUT, json.dumps(outcome, indent=2) + "\n")
        run.write(RUNS, lambda path: _table(parts).to_csv(path, index=False))
        histories = _histories(study, kept["nominal"], nominal_damping(required))
        run.write(HISTORIES, lambda path: histories.to_netcdf(path))
        for figure_name, figure in _draw(study, required, parts, kept):
            run.write(figures_of(study)[figure_name], lambda path, figure=figure: save_png(figure, path))

    stage_of(study).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
