"""The loop of thesis Fig. 5.15 in real time on this machine: ``python -m benchmarks.hardware_in_the_loop [SECONDS]``.

The prototype of chapter 4 on a simulated bench against the quarter car on an ISO-B road at 70 km/h, without force loop,
with one around the load cell, and with one around the observer, each at the 1000 Ns/m of the thesis's test and at 4000.
Where FMPy is installed (extra ``fmi``) the exported unit takes the place of the bench as well, after its checks.

Writes results/reference/benchmarks/hardware_in_the_loop.csv (and .png): force errors, step times, jitter, missed
deadlines. The times are those of an ordinary Linux; scheduling and load of the machine stand beside them.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd

from actuator.linear import tangent_plant
from actuator.observer import ForceObserver
from actuator.terminals import Terminals
from benchmarks.hardware_figure import draw
from control.design import loop_for
from control.sampled_loop import SampledLoop
from export.fmu import write_fmu
from pipeline.modules import PROJECT
from tests.actuator.thesis import PEAK_TORQUE, RATIO, prototype
from tests.vehicle.thesis import CRUISE_SPEED, quarter_car
from units import GRAVITY
from vehicle.comfort import weighted_acceleration
from vehicle.hardware_loop import (
    Device,
    HydraulicAxis,
    LoadCellLoop,
    LoopRun,
    LowLevel,
    NoLoop,
    ObserverLoop,
    Platform,
    SimulatedDevice,
    measured,
    run_loop,
)
from vehicle.indices import rms
from vehicle.real_time import Pace, first_in_line
from vehicle.road import IsoRoad, roughness_of_class

FOLDER = PROJECT / "results" / "reference" / "benchmarks"
SAMPLE = 5e-4  # s
DURATION = float(sys.argv[1]) if len(sys.argv) > 1 else 4.0  # s
AXIS = 100.0  # Hz, stand-in: see ``HydraulicAxis``
ENCODER = 2**14  # counts of a turn, a usual resolution
DAMPINGS = (1000.0, 4000.0)  # Ns/m: that of the thesis's test (section 5.5), and more
BANDWIDTH, MARGIN, WORKING_FORCE = 100.0, np.radians(50.0), 300.0  # Hz, rad, N: what the force loop is made for
OBSERVER = 200.0  # Hz, twice the bandwidth of the loop
TERMINALS = Terminals(48.0, (0.0, PEAK_TORQUE), (0.0, PEAK_TORQUE / 42.7e-3))  # identified constant of Table 4.2
DEVICE = prototype()
NONE, CELL, OBSERVED = "no force loop", "load cell", "observer"


def low_level(kind: str) -> LowLevel:
    """One of the three."""
    if kind == NONE:
        return NoLoop()
    loop = SampledLoop(loop_for(tangent_plant(DEVICE, WORKING_FORCE), BANDWIDTH, MARGIN), SAMPLE, PEAK_TORQUE / RATIO)
    return LoadCellLoop(loop) if kind == CELL else ObserverLoop(loop, ForceObserver(DEVICE, SAMPLE, OBSERVER))


@dataclass(frozen=True)
class Case:
    """What is driven; bench: what stands in for the hardware; damping [Ns/m]."""

    low_level: str
    damping: float
    bench: str = "stepped actuator"


def driven(case: Case, device: Device) -> tuple[LoopRun, str]:
    """One paced run, and how it was scheduled."""
    time = np.arange(0.0, DURATION + SAMPLE, SAMPLE)
    road = IsoRoad(roughness_of_class("B"), 0).heights(time, CRUISE_SPEED)[:, None]
    platform = Platform(
        quarter_car(),
        lambda told: case.damping * (told.body_velocity - told.wheel_velocity),
        low_level(case.low_level),
        SAMPLE,
    )
    run_loop(platform, device, HydraulicAxis(AXIS), 0 * road[:20])  # compiles, at rest
    with first_in_line() as scheduling:
        return run_loop(platform, device, HydraulicAxis(AXIS), road, Pace(SAMPLE)), scheduling


def row(case: Case, run: LoopRun, scheduling: str) -> dict[str, object]:
    """Of the table."""
    found: dict[str, object] = {
        "bench": case.bench, "low_level": case.low_level, "damping_Ns_per_m": case.damping,
        "wanted_rms_N": rms(run.wanted), "force_rms_N": rms(run.force), "force_error_rms_N": run.force_error,
        "force_peak_N": float(np.abs(run.force).max()),
        "comfort_g": rms(weighted_acceleration(run.acceleration, SAMPLE)) / GRAVITY,
    }  # fmt: skip
    machine = {"scheduling": scheduling, "load": os.getloadavg()[0], "cores": os.cpu_count()}
    return found | (run.timing.row() if run.timing is not None else {}) | machine


def simulated() -> Iterator[tuple[Case, LoopRun, str]]:
    """Every low-level control at every damping."""
    for damping in DAMPINGS:
        for kind in (NONE, CELL, OBSERVED):
            case = Case(kind, damping)
            yield case, *driven(case, SimulatedDevice(DEVICE, SAMPLE, ENCODER))


def exported() -> Iterator[tuple[Case, LoopRun, str]]:
    """The same bench as an exported unit, checked and run by FMPy."""
    if find_spec("fmpy") is None:
        print("FMPy is not installed: the exported unit is left out; .venv/bin/pip install -e '.[fmi]' adds it")
        return
    with TemporaryDirectory() as folder:
        path = Path(folder) / "actuator.fmu"
        write_fmu(path, DEVICE, TERMINALS)
        case = Case(CELL, DAMPINGS[0], "exported unit in FMPy")
        yield case, *driven(case, UnitDevice(path, Path(folder) / "unit"))


class UnitDevice:
    """The exported unit under FMPy, its own checks passed."""

    def __init__(self, path: Path, folder: Path) -> None:
        from fmpy import extract, read_model_description
        from fmpy.fmi2 import FMU2Slave
        from fmpy.validation import validate_fmu

        problems = validate_fmu(str(path))
        assert not problems, problems
        description = read_model_description(str(path))
        self.references = {one.name: one.valueReference for one in description.modelVariables}
        identifier = description.coSimulation.modelIdentifier
        extract(str(path), str(folder))
        self.unit = FMU2Slave(
            guid=description.guid, unzipDirectory=str(folder), modelIdentifier=identifier, instanceName="bench"
        )
        self.unit.instantiate()
        self.unit.setupExperiment(startTime=0.0)
        self.unit.enterInitializationMode()
        self.unit.exitInitializationMode()
        self.samples = 0

    def respond(self, velocity: float, force: float):
        """After one more sample at a velocity of the output [m/s] and a force asked of the motor [N]."""
        of = self.references
        self.unit.setReal([of["velocity"], of["force_demand"]], [velocity, force])
        self.unit.doStep(self.samples * SAMPLE, SAMPLE)
        self.samples += 1
        found = self.unit.getReal([of["force"], of["rotor_angle"], of["torque"]])
        return measured(*found, 2 * np.pi / ENCODER)


def main() -> None:
    """Run, write, draw."""
    runs = [*simulated(), *exported()]
    table = pd.DataFrame([row(*one) for one in runs])
    FOLDER.mkdir(parents=True, exist_ok=True)
    table.to_csv(FOLDER / "hardware_in_the_loop.csv", index=False, float_format="%.6g")
    draw({(case.low_level, case.damping): run for case, run, _ in runs if case.bench == "stepped actuator"},
         FOLDER / "hardware_in_the_loop.png")  # fmt: skip
    print(table.to_string(index=False))
    if len(runs) > 2 * 3:
        same = np.abs(runs[1][1].force - runs[-1][1].force).max()
        print(f"largest difference of the force, stepped actuator against exported unit: {same:.3g} N")


if __name__ == "__main__":
    main()
