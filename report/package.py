"""Everything that parts are ordered by: data sheet, winding, drawing, and the files for workshop and other tools."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from functools import partial

import pandas as pd

from drivetrain.output import in_unit
from electrical.winding_connection import Delta, Star
from electrical.winding_stage import WindingOutcome
from export.dxf import laminations, write_dxf
from export.motulator import parameter_text
from export.stage import Package
from export.step import active_parts, write_step
from figures.files import File, drawing_file, figure_file, picture_name, table_file, text_file
from figures.lamination import lamination
from figures.report import Picture, Section, Table
from figures.style import PHASE_NAMES
from figures.winding_diagram import winding_diagram
from geometry.connections import Connection
from geometry.outline import outline_of
from report.datasheet import DRAWING_PICTURE, TABLE, DataSheet

CONNECTIONS, COSTS, DIAGRAM = "winding_connections.csv", "mass_and_cost.csv", "winding_diagram"
DRAWING, SOLIDS, PARAMETERS = "drawing.pdf", "active_parts.step", "motulator_parameters.json"
_FILES = {
    TABLE: "the data sheet",
    DRAWING: "the lamination with its dimensions",
    "lamination_stator.dxf": "outline of the stator lamination, mm, arcs and lines as closed polylines",
    "lamination_rotor.dxf": "outline of the rotor lamination with the bore of the shaft",
    "magnets.dxf": "every magnet in its place",
    SOLIDS: "stator stack, rotor core, shaft and magnets as solids over the active length, mm",
    CONNECTIONS: "connection of the coils",
    COSTS: "masses and costs by part",
    PARAMETERS: "the machine for drive simulation by the names of motulator's SynchronousMachinePars, SI",
}


def files(package: Package, winding: WindingOutcome, sheet: DataSheet) -> Iterator[File]:
    """Data sheet, winding, costs, drawing, and what the workshop and other tools read."""
    yield table_file(TABLE, sheet.table)
    yield table_file(CONNECTIONS, connections_table(package, winding))
    yield table_file(COSTS, costs_table(package))
    drawing = lamination(winding.wound.dimensions, package.layout)
    yield figure_file(DRAWING_PICTURE, drawing)
    yield drawing_file(DRAWING, drawing)
    yield figure_file(
        DIAGRAM, winding_diagram(package.layout, package.connections, _closing(winding), _diagram_title(winding))
    )
    yield from _for_the_workshop(winding)
    connection = str(winding.chosen.design.connection)
    yield text_file(PARAMETERS, parameter_text(winding.constant, package.unsaturated, connection))


def _for_the_workshop(winding: WindingOutcome) -> Iterator[File]:
    """Outlines to cut by, and the solids."""
    outline, length = outline_of(winding.wound.dimensions), winding.wound.active_length
    for name, layers in laminations(outline).items():
        yield File(name, partial(write_dxf, layers=layers))
    yield File(SOLIDS, partial(write_step, parts=active_parts(outline), length=length))


def section(package: Package, winding: WindingOutcome) -> Section:
    """How the coils are connected, and what the material costs."""
    return Section(
        "Winding and parts to order",
        (
            Picture(
                picture_name(DIAGRAM),
                "The stator unrolled, seen from outside with the leads at the top: slots along x, numbers of the teeth "
                "on them, of the coils below; arrows along a positive phase current. Leads at the same "
                "letter are joined.",
            ),
            Table(
                connections_table(package, winding),
                "Connection of the coils, path by path from the terminal where a phase begins; leads at the end of the "
                "stack that the cross-section shows. All coils are wound alike, the reversed ones are connected the "
                f"other way round. In {CONNECTIONS} too.",
            ),
            Table(costs_table(package), _costs_caption(package)),
            Table(pd.DataFrame(_FILES.items(), columns=["file", "what is in it"]), "Files beside this report."),
        ),
    )


def connections_table(package: Package, winding: WindingOutcome) -> pd.DataFrame:
    """One coil a row, in the order of the current."""
    return pd.DataFrame([_connection_row(one, _closing(winding)) for one in package.connections])


def _closing(winding: WindingOutcome) -> Star | Delta:
    return winding.chosen.design.connection.closing


def _connection_row(one: Connection, closing: Star | Delta) -> dict[str, object]:
    phase, terminal = PHASE_NAMES[one.phase], closing.terminal_at_end(one.phase)
    end = "star point" if terminal is None else f"terminal {PHASE_NAMES[terminal]}"
    return {
        "coil": one.coil,
        "tooth": " ".join(str(tooth) for tooth in one.teeth),
        "phase": phase,
        "path": one.path + 1,
        "direction": "reversed" if one.reversed else "forward",
        "from slot": one.from_slot,
        "to slot": one.to_slot,
        "connected from": f"terminal {phase}" if one.previous is None else f"coil {one.previous}",
        "connected to": end if one.following is None else f"coil {one.following}",
    }


def costs_table(package: Package) -> pd.DataFrame:
    """One part a row, with costs where the study states prices."""
    names = {"part": "part", "mass": "mass_kg", "inertia": "inertia_kg_mm2", "cost": "cost"}
    table = pd.DataFrame([asdict(one) for one in package.costs]).rename(columns=names)
    table["inertia_kg_mm2"] = in_unit(table["inertia_kg_mm2"], "kg_mm2")
    if not package.currency:
        return table.drop(columns="cost")
    return table.rename(columns={"cost": f"cost {package.currency}"})


def _costs_caption(package: Package) -> str:
    if not package.currency:
        return "Masses by part. Costs would stand here if the study stated prices ([prices])."
    return "Mass and cost of the material in each part, without waste, tools and work; a dash where no price is stated."


def _diagram_title(winding: WindingOutcome) -> str:
    design = winding.chosen.design
    series = winding.wound.coils_in_series // design.connection.paths
    return f"{series} in series in each path, coils of {design}"
