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

from actuator.terminals import Terminals
from export.fmu import write_fmu
from figures.hardware_loop import loop_runs
from figures.style import save_png
from pipeline.modules import PROJECT
from tests.actuator.thesis import PEAK_TORQUE, prototype
from units import GRAVITY
from vehicle.hardware_case import ENCODER, LOAD_CELL, LoopTest, WantedLoop, loop_numbers, low_levels
from vehicle.hardware_loop import Device, LoopRun, SimulatedDevice, measured
from vehicle.printed_car import PRINTED_CAR, PRINTED_ROAD, PRINTED_SPEED
from vehicle.real_time import first_in_line
from vehicle.ride import Scenario
from vehicle.road import IsoRoad, roughness_of_class

FOLDER = PROJECT / "results" / "reference" / "benchmarks"
DURATION = float(sys.argv[1]) if len(sys.argv) > 1 else 4.0  # s
DAMPINGS = (1000.0, 4000.0)  # Ns/m: that of the thesis's test (section 5.5), and more
WANTED = WantedLoop()
SAMPLE = WANTED.sample_time
TERMINALS = Terminals(48.0, (0.0, PEAK_TORQUE), (0.0, PEAK_TORQUE / 42.7e-3))  # identified constant of Table 4.2
DEVICE = prototype()
LEVELS = low_levels(DEVICE, WANTED)


@dataclass(frozen=True)
class Case:
    """What is driven; bench: what stands in for the hardware; damping [Ns/m]."""

    low_level: str
    damping: float
    bench: str = "stepped actuator"


def driven(case: Case, device: Device) -> tuple[LoopRun, str]:
    """One paced run, and how it was scheduled."""
    road = Scenario("road", PRINTED_SPEED, DURATION, IsoRoad(roughness_of_class(PRINTED_ROAD), 0))
    test = LoopTest(PRINTED_CAR, road, case.damping, SAMPLE)
    test.warm_up(device, LEVELS[case.low_level]())
    with first_in_line() as scheduling:
        return test.run(device, LEVELS[case.low_level](), paced=True), scheduling


def row(case: Case, run: LoopRun, scheduling: str) -> dict[str, object]:
    """Of the table."""
    road = Scenario("road", PRINTED_SPEED, DURATION, IsoRoad(roughness_of_class(PRINTED_ROAD), 0))
    numbers = loop_numbers(LoopTest(PRINTED_CAR, road, case.damping, SAMPLE), run)
    numbers["comfort_g"] = numbers.pop("comfort_rms_m_per_s2") / GRAVITY
    found: dict[str, object] = {"bench": case.bench, "low_level": case.low_level} | numbers
    machine = {"scheduling": scheduling, "load": os.getloadavg()[0], "cores": os.cpu_count()}
    return found | (run.timing.row() if run.timing is not None else {}) | machine


def simulated() -> Iterator[tuple[Case, LoopRun, str]]:
    """Every low-level control at every damping."""
    for damping in DAMPINGS:
        for kind in LEVELS:
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
        case = Case(LOAD_CELL, DAMPINGS[0], "exported unit in FMPy")
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
    shown = {(case.low_level, case.damping): run for case, run, _ in runs if case.bench == "stepped actuator"}
    save_png(loop_runs(shown), FOLDER / "hardware_in_the_loop.png")
    print(table.to_string(index=False))
    if len(runs) > 2 * 3:
        same = np.abs(runs[1][1].force - runs[-1][1].force).max()
        print(f"largest difference of the force, stepped actuator against exported unit: {same:.3g} N")


if __name__ == "__main__":
    main()
