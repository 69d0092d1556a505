"""How fast the field solver is, against the project's own targets: ``python -m benchmarks.speed``.

CPU times (user and system, workers included) on one BLAS thread, medians where a measurement is repeated. The sweep is
the thesis's: ten stator radii, two slot counts, 15 x 15 designs, meshes included. Writes
results/reference/benchmarks/speed.json, .csv and .png.
"""

from __future__ import annotations

import json
import resource
import time
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd

from benchmarks.reference_case import reference_materials, reference_section
from benchmarks.this_machine import machine_name
from figures.style import new_figure, save_png, show_grid, styled
from geometry.half_cell import MeshDensity
from magnetostatics.model import FieldModel, OperatingPoint
from magnetostatics.torque import arkkio_torque
from optimisation.states import null_angle, null_current_angle
from pipeline.checkpoint import Checkpoint
from pipeline.models import layout_of, nominal_amplitude
from pipeline.parallel import run_parallel
from pipeline.stage import write_atomically
from study.read import read_study
from units import DEGREE

RESULTS = Path(__file__).resolve().parent.parent / "results" / "reference" / "benchmarks"
STUDY = "motorcycle"
SWEEP = ("sweep.back_iron_steps=15", "sweep.rotor_radius_steps=15")
_REPEATS = 9
_REFERENCE = MeshDensity(720, 0.4, 3, 4.0)


@dataclass(frozen=True)
class Row:
    """One measurement with its target (NaN: none)."""

    quantity: str
    measured: float
    target: float
    unit: str


def cpu_seconds() -> float:
    """CPU time of this process and its finished children."""
    kinds = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return sum(usage.ru_utime + usage.ru_stime for usage in map(resource.getrusage, kinds))


def cost(action) -> float:
    """CPU seconds of a call."""
    began = cpu_seconds()
    action()
    return cpu_seconds() - began


def null_point() -> OperatingPoint:
    """The state of the sweep on the reference machine."""
    study = read_study(STUDY)
    machine, layout = reference_section().machine, layout_of(study)
    return OperatingPoint(null_angle(machine, layout), nominal_amplitude(study), null_current_angle(machine, layout))


def cold_solves() -> list[Row]:
    """One converged solve of the half model, meshed section in memory, and its error against a fine mesh."""
    section, materials, point = reference_section(), reference_materials(), null_point()
    cold = [cost(lambda: FieldModel(section, materials).solve(point)) for _ in range(_REPEATS)]
    model = FieldModel(section, materials)
    model.solve(point)
    prepared = [cost(lambda: model.solve(point)) for _ in range(_REPEATS)]
    exact = arkkio_torque(FieldModel(reference_section(density=_REFERENCE), materials).solve(point))
    error = abs(arkkio_torque(model.solve(point)) / exact - 1)
    return [
        Row("cold solve, half model, numbering and pattern included", 1e3 * median(cold), np.nan, "ms"),
        Row("cold solve, half model, pattern prepared", 1e3 * median(prepared), 30.0, "ms"),
        Row("its torque error", 100 * error, 0.2, "%"),
    ]


def period() -> list[Row]:
    """60 rotor steps over one electrical period at one current, each from the field before."""
    model, point = FieldModel(reference_section(), reference_materials()), null_point()
    solution = model.solve(point)

    def turn():
        found = solution
        for k in range(60):
            angle = point.angle + k * 72 / 60 * DEGREE
            found = model.solve(OperatingPoint(angle, point.current_density, 0.0), start=found)

    first = cost(turn)
    return [
        Row("60 rotor steps, first time round", first, 0.7, "s"),
        Row("60 rotor steps, second time round", cost(turn), 0.7, "s"),
    ]


def sweep(processes: int = 2) -> list[Row]:
    """The thesis's 4500 designs."""
    from pipeline.sweep import solve_column, tasks_of

    tasks = tasks_of(read_study(STUDY, SWEEP))
    with TemporaryDirectory() as folder:
        checkpoint = Checkpoint(Path(folder) / "sweep.jsonl", "benchmark")
        began = time.perf_counter()
        seconds = cost(lambda: run_parallel(solve_column, tasks, processes, checkpoint, "sweep of 4500 designs"))
    wall = time.perf_counter() - began
    return [
        Row("4500 designs, meshes included", seconds, 100.0, "s"),
        Row("the same, wall, two processes", wall, np.nan, "s"),
    ]


def solve_optimum(task: dict) -> float:
    """Torque of one constrained optimum by gradients."""
    from optimisation.gradient_optimum import find_optimum_by_gradients
    from pipeline.models import StudyFamily, judge_of

    study = read_study(STUDY)
    radius = task["radius"]
    start = task["width_share"] * radius, task["rotor_share"] * radius
    judge = judge_of(study)
    return find_optimum_by_gradients(judge, StudyFamily(study.machine), task["slots"], radius, 1.2, start).design.torque


def optima() -> list[Row]:
    """All twenty optima by gradients from one rough guess (shares of the stator radius) for each slot count."""
    guesses = {9: (0.061, 0.41), 12: (0.064, 0.345)}
    radii = [d / 2e3 for d in read_study(STUDY).sweep.stator_diameters_mm]
    tasks = [
        {"slots": slots, "radius": radius, "width_share": guess[0], "rotor_share": guess[1]}
        for slots, guess in guesses.items()
        for radius in radii
    ]
    torques: list[float] = []
    seconds = cost(lambda: torques.extend(map(solve_optimum, tasks)))
    known = pd.read_csv(RESULTS.parent / "optima.csv").torque_nominal_Nm_per_m.to_numpy()
    return [
        Row("20 constrained optima by gradients", seconds, 20.0, "s"),
        Row(
            "largest difference from the refined grid optima",
            100 * np.abs(np.array(torques) / known - 1).max(),
            0.1,
            "%",
        ),
    ]


def scaling() -> pd.DataFrame:
    """CPU time of a cold solve over the number of unknowns."""
    materials, point, rows = reference_materials(), null_point(), []
    for density in (
        MeshDensity(120, 3, 1, 1.0),
        MeshDensity(),
        MeshDensity(480, 1, 2, 3.0),
        MeshDensity(960, 1, 3, 5.0),
    ):
        section = reference_section(density=density)
        model = FieldModel(section, materials)
        seconds = median(cost(lambda: FieldModel(section, materials).solve(point)) for _ in range(3))
        rows.append({"unknowns": model.unknowns.count, "cold_solve_s": seconds})
    return pd.DataFrame(rows)


def work(number: int) -> int:
    """A few designs for the measurement of parallel efficiency."""
    from pipeline.models import StudyFamily, judge_of

    study = read_study(STUDY)
    for k in range(4):
        judge_of(study).judge(StudyFamily(study.machine).machine(12, 42.5e-3, (3.0 + 0.05 * k) * 1e-3, 15.7e-3))
    return number


def efficiency() -> list[Row]:
    """Wall time on one process over twice that on two."""
    walls = {}
    for processes in (1, 2):
        with TemporaryDirectory() as folder:
            checkpoint = Checkpoint(Path(folder) / "x.jsonl", "benchmark")
            began = time.perf_counter()
            run_parallel(work, {str(k): k for k in range(24)}, processes, checkpoint, f"{processes} process(es)")
            walls[processes] = time.perf_counter() - began
    return [Row("parallel efficiency of two processes", walls[1] / (2 * walls[2]), 0.85, "1")]


@styled
def draw(table: pd.DataFrame):
    """Cost of a cold solve over the unknowns, with lines of order 1 and 1.5."""
    figure = new_figure(4.2)
    axes = figure.subplots()
    axes.loglog(table.unknowns, table.cold_solve_s, "o-", label="measured")
    for order in (1.0, 1.5):
        line = table.cold_solve_s.iloc[0] * (table.unknowns / table.unknowns.iloc[0]) ** order
        axes.loglog(table.unknowns, line, "--", label=f"order {order:g}")
    axes.set(xlabel="free unknowns", ylabel="CPU time of a cold solve / s")
    axes.legend()
    show_grid(axes)
    return figure


def main() -> None:
    """Measure, print and write."""
    machine, table = machine_name(), scaling()
    rows = [row for measure in (cold_solves, period, efficiency, optima, sweep) for row in measure()]
    machine["load_average_at_end"] = machine_name()["load_average"]
    frame = pd.DataFrame([asdict(row) for row in rows])
    print(frame.to_string(index=False))
    content = {"machine": machine, "rows": frame.to_dict("records"), "scaling": table.to_dict("records")}
    write_atomically(RESULTS / "speed.json", lambda path: path.write_text(json.dumps(content, indent=2) + "\n"))
    write_atomically(RESULTS / "speed.csv", partial(frame.to_csv, index=False))
    write_atomically(RESULTS / "speed.png", lambda path: save_png(draw(table), path))


if __name__ == "__main__":
    main()
