"""The graph of a machine of any kind that is stated whole: from its map to its sheet."""

from __future__ import annotations

from electrical.driven_machine import driven_as_begun
from electrical.flux_map_machine import FluxMapMachineError
from electrical.kind_search import (
    NoDesignError,
    begun_as_found,
    begun_as_found_to_be_wound,
    begun_as_stated,
    kind_search_stage,
)
from electrical.performance import performance_stage
from electrical.point_field import points_stage
from electrical.point_winding_stage import candidates_stage, chosen_winding_stage, driven_as_wound
from electrical.turning_stage import turning_stage
from electrical.winding_selection import WindingError
from geometry.errors import GeometryError
from losses.stage import LossError, current_losses_stage, losses_stage
from magnetostatics.flux_map import FluxMapError
from magnetostatics.flux_map_stage import flux_map_stage
from magnetostatics.newton import FieldSolutionError
from materials.errors import MaterialError
from pipeline.graph import Graph, Node, Source, Stage, View
from report import point_winding
from report import stated_machine as report
from study.inputs_stated_machine import (
    copper_temperature,
    design_to_be_wound,
    field_case,
    flux_map_grid,
    kind_search,
    loss_inputs,
    solving,
    stated_design,
    stated_machine,
    winding_inputs,
)
from study.machine_file import MachineFile

REFUSALS = (
    FieldSolutionError, FluxMapError, FluxMapMachineError, GeometryError, LossError, MaterialError, NoDesignError,
    WindingError,
)  # fmt: skip
_STATED: tuple[Node, ...] = (
    Source(copper_temperature),
    Source(solving),
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
)
_STATED_WINDING: tuple[Node, ...] = (Source(stated_design), View(driven_as_begun))
_CHOSEN_WINDING: tuple[Node, ...] = (
    Source(design_to_be_wound),
    Source(winding_inputs),
    Stage(
        "candidates", candidates_stage, "full slots at the operating points", point_winding.candidates_files,
        remarks=point_winding.candidates_remarks,
    ),
    Stage(
        "winding", chosen_winding_stage, "wires, turns, connection", point_winding.winding_files,
        remarks=point_winding.winding_remarks,
    ),
    View(driven_as_wound),
    Stage(
        "points", points_stage, "the operating points in the field", point_winding.points_files,
        remarks=point_winding.points_remarks,
    ),
)  # fmt: skip
_LOSSES: tuple[Node, ...] = (
    Source(loss_inputs),
    Stage("current_losses", current_losses_stage, "per metre, over the currents"),
    Stage("losses", losses_stage, "loss and efficiency map", report.losses_files),
)


def graph_of_machine(read: MachineFile) -> Graph:
    """Of a machine's file; a search only where it has variables, a choice of the winding only where it says of what,
    losses only where it names whose data stand for its steel."""
    winding = _STATED_WINDING if read.selection is None else _CHOSEN_WINDING
    losses = _LOSSES if read.loss_grade is not None else ()
    nodes = (*_STATED, *_begun(read), *winding, *_SOLVED, *losses)
    sections = (
        report.section, report.search_section, point_winding.section, report.map_section, report.turning_section,
        report.losses_section,
    )  # fmt: skip
    return Graph(nodes, sections, REFUSALS)


def _begun(read: MachineFile) -> tuple[Node, ...]:
    """What leads to the machine whose field is mapped."""
    if read.search is None:
        return (View(begun_as_stated),)
    return (*_SEARCHED, View(begun_as_found if read.selection is None else begun_as_found_to_be_wound))
