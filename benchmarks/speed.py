"""How fast the field solver is, against the project's own targets: ``python -m benchmarks.speed [part ...]``.

CPU times (user and system, workers included) on one BLAS thread, medians where a measurement is repeated. The parts are
``solve``, ``period``, ``map``, ``efficiency``, ``optima`` and ``sweep``; the sweep is the thesis's: ten stator radii,
two slot counts, 15 x 15 designs, meshes included. All parts together, on a machine that does nothing else, write
results/reference/benchmarks/speed.json, .csv and .png; single parts replace their rows in these.
"""

from __future__ import annotations

import json
import resource
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from math import sqrt
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd

from benchmarks.floors import arithmetic_floor, memory_floor
from benchmarks.reference_case import reference_materials, reference_section
from benchmarks.speed_figure import draw
from benchmarks.this_machine import machine_name
from disk import write_atomically
from figures.style import save_png
from geometry.family import Combination
from geometry.half_cell import MeshDensity
from magnetostatics.cholesky import one_thread
from magnetostatics.flux_map import CurrentGrid, map_angles, solve_angle
from magnetostatics.model import FieldModel, OperatingPoint
from magnetostatics.positions import null_angle, null_current_angle
from magnetostatics.torque import arkkio_torque
from optimisation.constrained_optimum import NoOptimumError
from optimisation.design import Judge
from optimisation.gradient_optimum import find_optimum_by_gradients
from optimisation.sweep import SweepBlock, blocks_of, solve_block
from optimisation.torque import QuickMeanTorque
from pipeline.checkpoint import Checkpoint
from pipeline.pools import PooledWorkers
from processes import Processes
from study.inputs_field import field_case, saturation_limit, sweep_grid
from study.read import read_study
from units import AMPERE_PER_SQUARE_MILLIMETRE, DEGREE

RESULTS = Path(__file__).resolve().parent.parent / "results" / "reference" / "benchmarks"
STUDY = "motorcycle"
SWEEP = ("sweep.back_iron_steps=15", "sweep.rotor_radius_steps=15")
_REPEATS = 9
_REFERENCE = MeshDensity(720, 0.4, 3, 4.0)
_DENSITIES = (MeshDensity(120, 3, 1, 1.0), MeshDensity(), MeshDensity(480, 1, 2, 3.0), MeshDensity(960, 1, 3, 5.0))
_ERROR_ANGLES = (-24.0, -22.7, -21.0, -19.3, -18.0, -13.3)  # deg
_ERROR_CURRENTS = (6.0, 20.0)  # A/mm2 RMS on the q axis
_MAP = (11, 20)  # currents along each axis, angles


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
    case, machine = field_case(read_study(STUDY)), reference_section().machine
    layout = case.layout(machine)
    return OperatingPoint(null_angle(machine, layout), case.nominal_density, null_current_angle(machine, layout))


def cold_solves() -> list[Row]:
    """One converged solve of the half model, meshed section in memory, and the error of its torque against a fine
    mesh."""
    section, materials, point = reference_section(), reference_materials(), null_point()
    cold = [cost(lambda: FieldModel(section, materials).solve(point)) for _ in range(_REPEATS)]
    model = FieldModel(section, materials)
    model.solve(point)
    prepared = [cost(lambda: model.solve(point)) for _ in range(_REPEATS)]
    fine = FieldModel(reference_section(density=_REFERENCE), materials)
    errors = [abs(arkkio_torque(model.solve(p)) / arkkio_torque(fine.solve(p)) - 1) for p in error_points()]
    return [
        Row("cold solve, half model, numbering and pattern included", 1e3 * median(cold), 25.0, "ms"),
        Row("cold solve, half model, pattern prepared", 1e3 * median(prepared), np.nan, "ms"),
        Row("largest torque error at 6 angles and 2 currents", 100 * max(errors), 0.2, "%"),
    ]


def error_points() -> list[OperatingPoint]:
    """The states over which the torque error is taken."""
    amplitudes = [sqrt(2) * current * AMPERE_PER_SQUARE_MILLIMETRE for current in _ERROR_CURRENTS]
    return [OperatingPoint(angle * DEGREE, amplitude) for angle in _ERROR_ANGLES for amplitude in amplitudes]


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
        Row("60 rotor steps, first time round", first, 0.5, "s"),
        Row("60 rotor steps, second time round", cost(turn), 0.5, "s"),
    ]


def flux_map() -> list[Row]:
    """All currents and angles of a flux map up to the overload."""
    model, (currents, angles) = FieldModel(reference_section(), reference_materials()), _MAP
    point = OperatingPoint(0.0, sqrt(2) * _ERROR_CURRENTS[1] * AMPERE_PER_SQUARE_MILLIMETRE)
    side = model.section.half_slot_area * model.section.half_slots_per_coil_side
    grid = CurrentGrid.motoring(point.current_density * point.packing_factor * side, currents)
    seconds = cost(lambda: [solve_angle(model, angle, grid) for angle in map_angles(model, angles)])
    return [Row(f"flux map of {currents} x {currents} currents and {angles} angles", seconds, 20.0, "s")]


def timed_block(block: SweepBlock) -> float:
    """CPU seconds of one block of the sweep, whichever process solves it."""
    began = time.process_time()
    solve_block(block)
    return time.process_time() - began


def thesis_blocks() -> dict[str, SweepBlock]:
    """The thesis's sweep."""
    study = read_study(STUDY, SWEEP)
    return blocks_of(field_case(study), sweep_grid(study), saturation_limit(study).reading)


def mapped(processes: int, function: Callable, tasks: dict) -> tuple[dict, float]:
    """Results of tasks on some processes, and the wall time [s]."""
    pool = Processes(processes)
    with TemporaryDirectory() as folder:
        workers = PooledWorkers("benchmark", pool, lambda what: Checkpoint(Path(folder) / "tasks.jsonl", "benchmark"))
        began = time.perf_counter()
        found = workers.map("tasks", function, tasks)
    wall = time.perf_counter() - began
    pool.end()
    return found, wall


def sweep(processes: int = 2) -> list[Row]:
    """The thesis's 4500 designs."""
    seconds, wall = mapped(processes, timed_block, thesis_blocks())
    return [
        Row("4500 designs, meshes included", sum(seconds.values()), 80.0, "s"),
        Row("the same, wall, two processes", wall, np.nan, "s"),
    ]


def solve_optimum(slots: int, radius: float, guess: tuple[float, float]) -> float:
    """Torque of one constrained optimum by gradients, NaN where the search does not settle.

    guess: shares of the radius
    """
    study = read_study(STUDY)
    case, limit = field_case(study), saturation_limit(study)
    judge = Judge(case, limit.reading, case.nominal_density, QuickMeanTorque())
    try:
        start = guess[0] * radius, guess[1] * radius
        found = find_optimum_by_gradients(judge, Combination(slots, 10), radius, limit.limit, start)
    except NoOptimumError:
        return np.nan
    return found.design.torque


def optima() -> list[Row]:
    """All twenty optima by gradients from one rough guess (shares of the stator radius) for each slot count."""
    guesses = {9: (0.064, 0.42), 12: (0.068, 0.35)}
    radii = [d / 2e3 for d in read_study(STUDY).sweep.stator_diameters_mm]
    tasks = [(slots, radius, guess) for slots, guess in guesses.items() for radius in radii]
    torques: list[float] = []
    seconds = cost(lambda: torques.extend(solve_optimum(*task) for task in tasks))
    known = pd.read_csv(RESULTS.parent / "optima.csv").torque_nominal_Nm_per_m.to_numpy()
    apart = 100 * np.nanmax(np.abs(np.array(torques) / known - 1))
    return [
        Row("20 constrained optima by gradients", seconds, 8.0, "s"),
        Row("of them settled", np.isfinite(torques).sum(), len(tasks), "1"),
        Row("largest difference from the refined grid optima", apart, 0.1, "%"),
    ]


def scaling() -> pd.DataFrame:
    """CPU time of a cold solve and of one tangent, assembled and factorised, over the unknowns, with floors."""
    materials, point = reference_materials(), null_point()
    return pd.DataFrame([_scale(FieldModel(reference_section(density=d), materials), point) for d in _DENSITIES])


def _scale(model: FieldModel, point: OperatingPoint) -> dict[str, float]:
    with one_thread():
        cold = [cost(lambda: FieldModel(model.section, model.materials).solve(point)) for _ in range(3)]
        solution = model.solve(point)
        system = model.topology.pattern(model.unknowns.turn(point.angle).edges).system
        counts = system.column_counts
        return {
            "unknowns": model.unknowns.count,
            "cold_solve_s": median(cold),
            "factorisation_s": median(cost(lambda: model.tangent(solution)) for _ in range(_REPEATS)),
            "arithmetic_floor_s": arithmetic_floor(counts),
            "memory_floor_s": memory_floor(counts),
        }


def designs_solved() -> pd.DataFrame:
    """CPU time over the number of designs of some blocks of the sweep, the imports apart from them."""
    blocks = list(thesis_blocks().values())
    solve_block(blocks[0])
    rows, seconds, designs = [], 0.0, 0
    for block in blocks[1::9]:
        seconds += cost(partial(solve_block, block))
        designs += len(block.back_iron_widths) * len(block.rotor_outer_radii)
        rows.append({"designs": designs, "cpu_s": seconds})
    return pd.DataFrame(rows)


def work(number: int) -> int:
    """A few designs for the measurement of parallel efficiency."""
    study = read_study(STUDY)
    case, limit = field_case(study), saturation_limit(study)
    for k in range(4):
        machine = case.family.machine(Combination(12, 10), back_iron_width=(3.0 + 0.05 * k) * 1e-3)
        Judge(case, limit.reading, case.nominal_density, QuickMeanTorque()).judge(machine)
    return number


def process_walls() -> dict[int, float]:
    """Wall time [s] of the same designs on one and on two processes."""
    return {processes: mapped(processes, work, {str(k): k for k in range(24)})[1] for processes in (1, 2)}


def efficiency() -> list[Row]:
    """Wall time on one process over twice that on two."""
    walls = process_walls()
    return [
        Row("24 tasks on one process, wall", walls[1], np.nan, "s"),
        Row("the same on two processes, wall", walls[2], np.nan, "s"),
        Row("parallel efficiency of two processes", walls[1] / (2 * walls[2]), 0.85, "1"),
    ]


PARTS = {
    "solve": cold_solves,
    "period": period,
    "map": flux_map,
    "efficiency": efficiency,
    "optima": optima,
    "sweep": sweep,
}


def measure(parts: list[str]) -> pd.DataFrame:
    """The rows of some parts, printed as they come."""
    rows = []
    for part in parts:
        for row in PARTS[part]():
            print(f"{row.quantity:58}{row.measured:10.3g} {row.unit:3} target {row.target:g}", flush=True)
            rows.append(asdict(row))
    return pd.DataFrame(rows)


def main(parts: list[str]) -> None:
    """Measure all parts and write them; with parts named, measure these and replace their rows in what was written."""
    unknown = set(parts) - set(PARTS)
    if unknown:
        raise SystemExit(f"no part named {', '.join(sorted(unknown))}; choose from {', '.join(PARTS)}")
    if parts:
        write(_replaced(json.loads((RESULTS / "speed.json").read_text(encoding="utf-8")), measure(parts)))
        return
    machine, solves, designs, frame = machine_name(), scaling(), designs_solved(), measure(list(PARTS))
    machine["load_average_at_end"] = machine_name()["load_average"]
    tables = {"rows": frame, "scaling": solves, "designs": designs}
    write({"machine": machine} | {name: table.to_dict("records") for name, table in tables.items()})


def _replaced(content: dict, frame: pd.DataFrame) -> dict:
    """What was written, with the rows of the same name measured anew."""
    new = {row["quantity"]: row for row in frame.to_dict("records")}
    rows = [new.pop(row["quantity"], row) for row in content["rows"]]
    return content | {"rows": rows + list(new.values())}


def write(content: dict) -> None:
    """speed.json, .csv and .png of machine, rows, scaling and designs."""
    frame, solves, designs = (pd.DataFrame(content[name]) for name in ("rows", "scaling", "designs"))
    write_atomically(RESULTS / "speed.json", lambda path: path.write_text(json.dumps(content, indent=2) + "\n"))
    write_atomically(RESULTS / "speed.csv", partial(frame.to_csv, index=False))
    walls = frame[frame.quantity.str.endswith("wall") & frame.quantity.str.contains("tasks|same on")].measured
    figure = draw(solves, designs, dict(zip((1, 2), walls)), str(content["machine"]["processor"]))
    write_atomically(RESULTS / "speed.png", lambda path: save_png(figure, path))


if __name__ == "__main__":
    main(sys.argv[1:])
