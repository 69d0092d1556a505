"""Derivatives on a moved mesh against machines that are meshed anew: ``python -m benchmarks.tolerance_slopes [STUDY]``.

The stage ``tolerances`` moves the nodes of one mesh and solves nothing again. Here every dimension is changed both ways
by ``CHANGE``, and each machine is meshed and solved by itself. Central differences of new meshes carry the scatter of
two meshes, so the change is larger than a tolerance, and small derivatives drown: the last column says what the
difference of the two makes at the tolerance of the study, which is what it means for the report.

Needs the study's results (``make tolerances``). Writes results/reference/benchmarks/tolerance_slopes.csv.
"""

from __future__ import annotations

import sys

import numpy as np
import pandas as pd

from magnetostatics.case import FieldCase
from pipeline.modules import PROJECT
from pipeline.results import Results
from study.inputs_field import field_case
from study.read import read_study
from uncertainty.deviations import SectionDimension
from uncertainty.field_slopes import Cogging, FieldState, LoadedIron, NoLoad, StateTask, solve_slopes
from units import MILLIMETRE

TABLE = PROJECT / "results" / "reference" / "benchmarks" / "tolerance_slopes.csv"
CHANGE = 0.1 * MILLIMETRE


def states_of(results: Results) -> tuple[FieldState, ...]:
    """At the currents of the wound machine."""
    winding, law = results.load("winding"), results.load("losses").law
    full = winding.wound.turns * winding.direct_current, winding.wound.turns * winding.quadrature_current
    frequency = winding.wound.machine.pole_pairs * winding.chosen.base_speed / (2 * np.pi)
    return NoLoad(), LoadedIron(*full, law, frequency), Cogging()


def meshed_anew(case: FieldCase, one: SectionDimension, task: StateTask) -> np.ndarray:
    """Central differences over the values in the middle [1/m], (k,)."""
    ends = []
    for change in (CHANGE, -CHANGE):
        model = case.model(one.moved(task.machine, change))
        ends.append(task.state.read(task.state.solutions(model)))
    return (ends[0] - ends[1]) / (2 * CHANGE) / (0.5 * (ends[0] + ends[1]))


def main(name: str) -> None:
    case, results, rows = field_case(read_study(name)), Results(PROJECT / "results" / name), []
    found = results.load("tolerances")
    deviations = tuple(one for one in found.tolerances.deviations if isinstance(one, SectionDimension))
    machine = results.load("winding").wound.machine
    deviations = tuple(one for one in deviations if one.centre(machine) == machine)
    for state in states_of(results):
        task = StateTask(case, machine, state, deviations)
        slopes = solve_slopes(task)
        for one in deviations:
            anew = meshed_anew(case, one, task)
            for quantity, moved, new in zip(state.quantities, slopes.of(one), anew):
                rows.append(row(one, quantity, float(moved), float(new)))
                print(rows[-1])
    pd.DataFrame(rows).to_csv(TABLE, index=False, float_format="%.5g")


def row(one: SectionDimension, quantity: str, moved: float, new: float) -> dict[str, object]:
    """Both derivatives in per cent a millimetre, and their difference at the tolerance in per cent."""
    return {
        "dimension": one.name,
        "quantity": quantity,
        "moved_percent_per_mm": 100 * moved * MILLIMETRE,
        "meshed_anew_percent_per_mm": 100 * new * MILLIMETRE,
        "apart_at_the_tolerance_percent": 100 * (moved - new) * one.half_width,
    }


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "motorcycle")
