"""The graph of a machine of any kind that is stated whole: from its map to its sheet."""

from __future__ import annotations

from electrical.flux_map_machine import FluxMapMachineError
from electrical.kind_search import (
    NoDesignError,
    driven_as_found,
    driven_as_stated,
    kind_search_stage,
)
from electrical.performance import performance_stage
from electrical.turning_stage import turning_stage
from geometry.errors import GeometryError
from losses.stage import LossError, current_losses_stage, losses_stage
from magnetostatics.flux_map import FluxMapError
from magnetostatics.flux_map_stage import flux_map_stage
from magnetostatics.newton import FieldSolutionError
from materials.errors import MaterialError
from pipeline.graph import Graph, Node, Source, Stage, View
from report import stated_machine as report
from study.inputs_stated_machine import (
    copper_temperature,
    field_case,
    flux_map_grid,
    kind_search,
    loss_inputs,
    solving,
    stated_design,
    stated_machine,
)
from study.machine_file import MachineFile

REFUSALS = (
    FieldSolutionError, FluxMapError, FluxMapMachineError, GeometryError, LossError, MaterialError, NoDesignError,
)  # fmt: skip
_STATED: tuple[Node, ...] = (
    Source(copper_temperature),
    Source(solving),
    Source(stated_design),
    View(stated_machine),
    View(field_case),
    View(flux_map_grid),
)
_SOLVED: tuple[Node, ...] = (
    Stage("flux_map", flux_map_stage, "over currents and angle", report.flux_map_files),
    Stage("performance", performance_stage, "torque over speed"),
    Stage("turning", turning_stage, "without and at full current", report.turning_files),
    Stage("sheet", report.machine_sheet, "the machine on a page", report.sheet_files),
)
_SEARCHED: tuple[Node, ...] = (
    Source(kind_search),
    Stage("search", kind_search_stage, "best dimensions within their bounds", report.search_files),
    View(driven_as_found),
)
_LOSSES: tuple[Node, ...] = (
    Source(loss_inputs),
    Stage("current_losses", current_losses_stage, "per metre, over the currents"),
    Stage("losses", losses_stage, "loss and efficiency map", report.losses_files),
)


def graph_of_machine(read: MachineFile) -> Graph:
    """Of a machine's file; a search only where it has variables, losses only where it names whose data stand for its
    steel."""
    begun = (View(driven_as_stated),) if read.search is None else _SEARCHED
    nodes = (*_STATED, *begun, *_SOLVED, *(_LOSSES if read.loss_grade is not None else ()))
    sections = (
        report.section, report.search_section, report.map_section, report.turning_section, report.losses_section,
    )  # fmt: skip
    return Graph(nodes, sections, REFUSALS)
