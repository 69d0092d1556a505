"""``airgap hil STUDY``: the actuator of a study on a bench in the loop of thesis Fig. 5.15, paced by the clock."""

from __future__ import annotations

import argparse
import os
from collections.abc import Mapping
from dataclasses import replace
from math import isfinite
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from actuator.errors import ActuatorError
from actuator.model import Actuator
from control.errors import ControlError
from disk import write_atomically
from figures.hardware_loop import loop_runs
from figures.style import save_png
from pipeline.export_fmu_command import designed_unit
from pipeline.results import Results, results_of
from study.errors import StudyError
from study.inputs_vehicle import ride_case
from study.read import read_study
from units import FACTORS
from vehicle.demands import RideCase
from vehicle.errors import VehicleError
from vehicle.hardware_case import ENCODER, LoopTest, WantedLoop, loop_numbers, low_levels
from vehicle.hardware_loop import LoopRun, SimulatedDevice
from vehicle.real_time import first_in_line

TABLE, FIGURE = "hardware_in_the_loop.csv", "hardware_in_the_loop.png"
MILLISECOND = FACTORS["ms"]


def add_hil(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap hil``."""
    parser.add_argument("study", help="name of a file in studies/ or a path; its stage energy must have been run")
    parser.add_argument("--seconds", type=float, default=4.0, help="of the random road (default 4)")
    parser.add_argument("--damping-kNs-per-m", type=float, default=1.0, help="that is asked for (default 1)")
    parser.add_argument("--sample-ms", type=float, default=0.5, help="step of the loop (default 0.5)")
    parser.add_argument("--bandwidth-Hz", type=float, default=100.0, help="of the force loop (default 100)")
    parser.add_argument("--margin-deg", type=float, default=50.0, help="its phase margin (default 50)")
    parser.add_argument("--results", metavar="DIR", help="of the design; default results/<study>/")
    parser.set_defaults(run=hil)


def hil(options: argparse.Namespace) -> None:
    """Run the loop without force loop, with one around a load cell and with one around the observer; table, picture.

    The actuator on the bench is the simulated one: a rig takes its place as a ``vehicle.hardware_loop.Device``.
    """
    study = read_study(options.study)
    results = results_of(study) if options.results is None else Results(Path(options.results))
    actuator, _ = designed_unit(study, results)
    try:
        test, wanted = _test(options, ride_case(study))
        runs, scheduling = _runs(test, actuator, wanted)
    except (ActuatorError, ControlError, VehicleError) as error:
        raise StudyError(f"{study.path.name}: {error}.") from None
    table = loop_table(test, runs, scheduling)
    write_atomically(results.folder / TABLE, lambda path: table.to_csv(path, index=False, float_format="%.6g"))
    write_atomically(results.folder / FIGURE, lambda path: save_png(_figure(test, runs), path))
    print(_shown(table).to_string(index=False))
    print(f"wrote {results.folder / TABLE} and {FIGURE}; the actuator on the bench was simulated")


def _test(options: argparse.Namespace, case: RideCase) -> tuple[LoopTest, WantedLoop]:
    for name in ("seconds", "damping_kNs_per_m", "sample_ms", "bandwidth_Hz", "margin_deg"):
        value = getattr(options, name)
        if not (isfinite(value) and value > 0):
            raise StudyError(f"--{name.replace('_', '-')}: expected a number above zero, found {value:g}; give one.")
    sample = options.sample_ms * MILLISECOND
    wanted = WantedLoop(options.bandwidth_Hz, float(np.radians(options.margin_deg)), sample_time=sample)
    scenario = replace(case.road[0], duration=options.seconds)
    return LoopTest(case.vehicle, scenario, options.damping_kNs_per_m * FACTORS["kNs_per_m"], sample), wanted


def _runs(test: LoopTest, actuator: Actuator, wanted: WantedLoop) -> tuple[dict[str, LoopRun], str]:
    """Paced runs by low-level control, and how they were scheduled."""
    levels, found = low_levels(actuator, wanted), {}
    for name, make in levels.items():
        test.warm_up(_device(actuator, wanted), make())
        with first_in_line() as scheduling:
            found[name] = test.run(_device(actuator, wanted), make(), paced=True)
    return found, scheduling


def _device(actuator: Actuator, wanted: WantedLoop) -> SimulatedDevice:
    return SimulatedDevice(actuator, wanted.sample_time, ENCODER)


def loop_table(test: LoopTest, runs: Mapping[str, LoopRun], scheduling: str) -> pd.DataFrame:
    """One run a row: forces, comfort, step times, jitter and missed deadlines [SI]; scheduling: of the process."""
    machine = {"scheduling": scheduling, "load": os.getloadavg()[0], "cores": os.cpu_count()}
    return pd.DataFrame(
        [
            {"low_level": name, "lost": run.lost} | loop_numbers(test, run) | _timing(run) | machine
            for name, run in runs.items()
        ]
    )


def _timing(run: LoopRun) -> dict[str, float]:
    return {} if run.timing is None else run.timing.row()


def _shown(table: pd.DataFrame) -> pd.DataFrame:
    """What the console says, in milliseconds."""
    times = ("step_time_median", "step_time_p99", "jitter_p99", "jitter_worst")
    columns = {f"{name}_ms": table[f"{name}_s"] / MILLISECOND for name in times}
    shown = table[["low_level", "wanted_rms_N", "force_error_rms_N", "steps", "missed_deadlines"]].assign(**columns)
    return shown.round(4)


def _figure(test: LoopTest, runs: Mapping[str, LoopRun]) -> Figure:
    return loop_runs({(name, test.damping): run for name, run in runs.items()})
