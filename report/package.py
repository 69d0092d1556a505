"""Everything that parts are ordered by: data sheet, winding, drawing, and the files for workshop and other tools."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict

import pandas as pd

from drivetrain.outcome import Outcome
from drivetrain.output import Output
from electrical.braking_stage import BrakingOutcome, CopperHeat
from electrical.winding_stage import WindingInputs, WindingOutcome
from export.stage import Package
from figures.files import File, figure_file, picture_name, table_file
from figures.lamination import lamination
from figures.report import Picture, Section, Table
from figures.style import PHASE_NAMES
from figures.winding_diagram import winding_diagram
from geometry.connections import Connection
from losses.stage import LossInputs
from magnetostatics.case import FieldCase
from report.datasheet import DRAWING, TABLE, data_sheet, table_of

CONNECTIONS, COSTS, DIAGRAM = "winding_connections.csv", "mass_and_cost.csv", "winding_diagram"


def files(
    package: Package,
    case: FieldCase,
    steel: LossInputs,
    winding: WindingOutcome,
    inputs: WindingInputs,
    heat: CopperHeat,
    braking: BrakingOutcome,
    outcome: Outcome,
    output: Output,
) -> Iterator[File]:
    """Data sheet, winding and costs as tables, and their figures."""
    sheet = data_sheet(package, case, steel, winding, inputs, heat, braking, outcome, output)
    yield table_file(TABLE, table_of(tuple(row for group in sheet for row in group.rows)))
    yield table_file(CONNECTIONS, connections_table(package))
    yield table_file(COSTS, costs_table(package))
    yield figure_file(DRAWING, lamination(winding.wound.machine, package.layout))
    yield figure_file(DIAGRAM, winding_diagram(package.layout, package.connections, _diagram_title(winding)))


def section(package: Package) -> Section:
    """How the coils are connected, and what the material costs."""
    return Section(
        "Winding and parts to order",
        (
            Picture(
                picture_name(DIAGRAM),
                "The stator unrolled, seen with the leads at the top: slots along the axis, numbers of the teeth on "
                "them, of the coils below; arrows along a positive phase current.",
            ),
            Table(
                connections_table(package),
                "Connection of the coils, phase by phase from the terminal to the star point; leads at the end of the "
                "stack that the cross-section shows. All coils are wound alike, the reversed ones are connected the "
                f"other way round. In {CONNECTIONS} too.",
            ),
            Table(costs_table(package), _costs_caption(package)),
        ),
    )


def connections_table(package: Package) -> pd.DataFrame:
    """One coil a row, in the order of the current."""
    return pd.DataFrame([_connection_row(one) for one in package.connections])


def _connection_row(one: Connection) -> dict[str, object]:
    phase = PHASE_NAMES[one.phase]
    return {
        "coil": one.coil,
        "tooth": " ".join(str(tooth) for tooth in one.teeth),
        "phase": phase,
        "direction": "reversed" if one.reversed else "forward",
        "from slot": one.from_slot,
        "to slot": one.to_slot,
        "connected from": f"terminal {phase}" if one.previous is None else f"coil {one.previous}",
        "connected to": "star point" if one.following is None else f"coil {one.following}",
    }


def costs_table(package: Package) -> pd.DataFrame:
    """One part a row, with costs where the study states prices."""
    names = {"part": "part", "mass": "mass_kg", "inertia": "inertia_kg_m2", "cost": "cost"}
    table = pd.DataFrame([asdict(one) for one in package.costs]).rename(columns=names)
    if not package.currency:
        return table.drop(columns="cost")
    return table.rename(columns={"cost": f"cost {package.currency}"})


def _costs_caption(package: Package) -> str:
    if not package.currency:
        return "Masses by part. Costs would stand here if the study stated prices ([prices])."
    return "Mass and cost of the material in each part, without waste, tools and work; a dash where no price is stated."


def _diagram_title(winding: WindingOutcome) -> str:
    wound = winding.wound
    return f"{wound.coils_in_series} coils in series a phase, {wound.turns} turns of {wound.strands} wires each"
