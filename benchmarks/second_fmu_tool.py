"""The exported unit in a tool that shares no code with FMPy: ``python -m benchmarks.second_fmu_tool``.

libcosim of the Open Simulation Platform (C++, FMI Library), by its Python binding (extra ``fmi``), drives the prototype
of chapter 4 as a unit; the same motion by our own step is the judge. Writes
results/reference/benchmarks/second_fmu_tool.csv.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd
from libcosimpy.CosimEnums import CosimVariableType
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

from actuator.step import SteppedActuator
from actuator.terminals import Terminals
from export.fmu import write_fmu
from pipeline.modules import PROJECT
from tests.actuator.thesis import PEAK_TORQUE, prototype

OUT = PROJECT / "results" / "reference" / "benchmarks" / "second_fmu_tool.csv"
STEP, STEPS = 5e-4, 2000  # s
TERMINALS = Terminals(48.0, (0.0, PEAK_TORQUE), (0.0, PEAK_TORQUE / 42.7e-3))  # identified constant of Table 4.2


def inputs() -> tuple[np.ndarray, np.ndarray]:
    """Velocity of the output [m/s] and force asked of the motor [N] over the steps."""
    time = STEP * np.arange(STEPS)
    velocity = 0.2 * np.sin(2 * np.pi * 3.0 * time) + 0.1 * np.sin(2 * np.pi * 11.0 * time)
    return velocity, 2e3 * velocity


def by_our_step() -> np.ndarray:
    """Force at the suspension after every step [N], (STEPS,)."""
    stepped, found = SteppedActuator(prototype()), []
    moment = stepped.at_rest()
    for velocity, force in zip(*inputs()):
        moment = stepped.after(moment, float(velocity), float(force), STEP)
        found.append(moment.answer.force)
    return np.array(found)


def by_libcosim(path: Path) -> np.ndarray:
    """The same by the unit in libcosim."""
    execution = CosimExecution.from_step_size(step_size=round(STEP * 1e9))
    slave = execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name="actuator"))
    variables = execution.slave_variables(slave_index=slave)
    references = {one.name.decode(): one.reference for one in variables if one.type == CosimVariableType.REAL.value}
    manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    execution.add_manipulator(manipulator=manipulator)
    execution.add_observer(observer=observer)
    given, found = [references["velocity"], references["force_demand"]], []
    for velocity, force in zip(*inputs()):
        values = [float(velocity), float(force)]
        manipulator.slave_real_values(slave_index=slave, variable_references=given, values=values)
        execution.step()
        found += observer.last_real_values(slave_index=slave, variable_references=[references["force"]])
    return np.array(found)


def main() -> None:
    """Run, compare, write."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "actuator.fmu"
        write_fmu(path, prototype(), TERMINALS)
        theirs = by_libcosim(path)
    ours = by_our_step()
    row = {"tool": "libcosim", "steps": STEPS, "step_s": STEP, "force_peak_N": float(np.abs(ours).max()),
           "largest_difference_N": float(np.abs(ours - theirs).max())}  # fmt: skip
    pd.DataFrame([row]).to_csv(OUT, index=False, float_format="%.6g")
    print(row)


if __name__ == "__main__":
    main()
