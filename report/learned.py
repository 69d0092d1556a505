"""What a bench has taught, what each lesson costs the first design, and the design before and after."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from drivetrain.learned import Learned
from drivetrain.outcome import Outcome
from drivetrain.output import Output, labelled
from drivetrain.second_design import AS_DESIGNED, FirstDesign, LessonCost, LessonCosts
from electrical.winding_stage import WindingOutcome
from figures.files import File, table_file
from figures.report import Remark, Section, Table
from report.outcome import checks_table, features_table
from units import MILLIMETRE

_METHOD = (
    "The first design with each lesson alone, nothing else changed: its field solved again at the current of its peak "
    "torque and at that for good, which the temperatures allow (or the nominal current density, where the study says "
    "so), the mean over the rotor angles of its flux map. Friction, resistance, iron loss and end leakage act by their "
    "laws. The active length is the one that would meet peak and continuous {effort} with the same winding and "
    "currents; the efficiency is at the RMS {effort} and speed that are asked, with the current in proportion to the "
    "torque and the iron loss of the first loss map."
)


def files(costs: LessonCosts, output: Output) -> Iterator[File]:
    """The costs as a table."""
    yield table_file("lessons.csv", costs_table(costs, output))


def section(
    learned: Learned,
    costs: LessonCosts,
    first: FirstDesign,
    outcome: Outcome,
    winding: WindingOutcome,
    output: Output,
) -> Section:
    """The lessons, their costs, and the two designs beside each other."""
    return Section(
        "What the bench has taught",
        (
            f"Designed again with {learned.source}. " + _lessons(learned),
            *(Remark(f"Not used: {sentence}") for sentence in learned.unused),
            Table(costs_table(costs, output), _METHOD.format(effort=output.effort)),
            Table(designs_table(first, outcome, winding, output), "The design before and after."),
            Table(requirements_table(first, outcome, output), "What is asked, and what each design reaches; the first "
                  "as it was believed to be when it was designed."),
        ),
    )  # fmt: skip


def _lessons(learned: Learned) -> str:
    return " ".join(f"{one.title.capitalize()}: {one.words}." for one in learned.lessons)


def costs_table(costs: LessonCosts, output: Output) -> pd.DataFrame:
    """One lesson a row, with its change against the first design as designed."""
    base = next(row for row in costs.rows if row.reason == AS_DESIGNED)
    return pd.DataFrame([_cost_row(row, base, output) for row in costs.rows])


def _cost_row(row: LessonCost, base: LessonCost, output: Output) -> dict[str, object]:
    unit = output.effort_unit
    return {
        "lesson": row.reason,
        "what": row.words,
        f"peak_{output.effort}_{unit}": row.peak_effort,
        "peak_change_percent": 100 * (row.peak_effort / base.peak_effort - 1),
        f"continuous_{output.effort}_{unit}": row.continuous_effort,
        "continuous_change_percent": 100 * (row.continuous_effort / base.continuous_effort - 1),
        "length_needed_mm": row.length / MILLIMETRE,
        "length_change_mm": (row.length - base.length) / MILLIMETRE,
        "efficiency_percent": 100 * row.efficiency,
        "efficiency_change_points": 100 * (row.efficiency - base.efficiency),
    }


def designs_table(first: FirstDesign, outcome: Outcome, winding: WindingOutcome, output: Output) -> pd.DataFrame:
    """Features of both designs, with active length, turns and wires in hand."""
    before, after = (features_table(one, output) for one in (first.outcome, outcome))
    rows = [
        {"feature": name, "first": old, "second": new}
        for name, old, new in zip(before.feature, before.ours, after.ours, strict=True)
    ]
    lengths = (one.wound.active_length / MILLIMETRE for one in (first.winding, winding))
    radii = (one.wound.dimensions.stator_outer_radius / MILLIMETRE for one in (first.winding, winding))
    rows.append(_both(labelled("active length", "mm"), lengths))
    rows.append(_both(labelled("stator outer radius", "mm"), radii))
    rows.append(_both("turns of a coil", (one.chosen.turns for one in (first.winding, winding))))
    rows.append(_both("wires in hand", (one.chosen.strands for one in (first.winding, winding))))
    return pd.DataFrame(rows)


def _both(name: str, values: Iterator[float]) -> dict[str, object]:
    old, new = values
    return {"feature": name, "first": old, "second": new}


def requirements_table(first: FirstDesign, outcome: Outcome, output: Output) -> pd.DataFrame:
    """Every requirement with what both designs reach."""
    before, after = (checks_table(one, output) for one in (first.outcome, outcome))
    table = before[["requirement", "sense", "needed", "unit"]].assign(first=before.reached, second=after.reached)
    return table.assign(first_holds=before.holds, second_holds=after.holds)
