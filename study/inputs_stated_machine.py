"""What the stages read of a machine that is stated whole, in a file of its own, in SI."""

from __future__ import annotations

from dataclasses import dataclass

from electrical.dq import DriveLimits
from electrical.driven_machine import CopperTemperature, DrivenMachine
from electrical.kind_search import KindSearch, StatedDesign
from electrical.winding_design import WindingDesign
from electrical.wire import Wire
from electrical.wound_machine import WoundMachine
from geometry.areas import part_areas
from geometry.family import MatchedMachine
from geometry.half_cell import MeshDensity
from losses.stage import LossInputs
from magnetostatics.case import FieldCase
from magnetostatics.flux_map_stage import FluxMapGrid
from magnetostatics.model import MachineMaterials
from materials.conductor import COPPER
from materials.enamelled_wire import any_gauge
from study.machine_file import MachineFile

_GRADE = 1  # of the enamel


def copper_temperature(read: MachineFile) -> CopperTemperature:
    """That the resistance is stated at."""
    return CopperTemperature(read.number("drive", "winding_temperature_degC"))


def stated_design(read: MachineFile) -> StatedDesign:
    """The machine with the winding and within the limits that its file states.

    Raises StudyError for what is left out, MaterialError for a wire that is not sold.
    """
    limits = DriveLimits.from_dc_bus(
        read.number("drive", "line_current_peak_A"), read.number("drive", "dc_bus_voltage_V")
    )
    strands = int(read.number("winding", "wires_in_hand"))
    design = WindingDesign(read.turns, strands, wire(read), read.connection)
    layout = read.layout
    wound = WoundMachine(
        read.machine, layout.coils_in_series, layout.coil_pitch, design, read.active_length, read.end_turn
    )
    driven = DrivenMachine(wound, limits, read.number("drive", "speed_max_rpm"))
    return StatedDesign(field_case(solving(read), driven), driven)


def kind_search(read: MachineFile) -> KindSearch:
    """What [[variables]] and [search] ask for; without variables nothing is looked for."""
    assert read.search is not None  # the graph asks only then
    return read.search


def wire(read: MachineFile) -> Wire:
    """Of the winding, its copper at the temperature that the file states."""
    size = any_gauge(read.number("winding", "wire_diameter_mm"), _GRADE)
    resistivity = float(COPPER.resistivity(read.number("drive", "winding_temperature_degC")))
    return Wire(size.copper_diameter, size.outer_diameter, resistivity)


def stated_machine(driven: DrivenMachine) -> MatchedMachine:
    """The cross-section."""
    return MatchedMachine(driven.wound.machine)


@dataclass(frozen=True, eq=False)
class Solving:
    """What the field of a stated machine is solved with beside its drive.

    layers, coil_pitch [slots]: of the winding; map_points: angles and currents of the flux map
    """

    layers: int
    coil_pitch: int
    map_points: tuple[int, int]
    materials: MachineMaterials
    density: MeshDensity


def solving(read: MachineFile) -> Solving:
    """Of a file."""
    return Solving(read.layout.layers, read.layout.coil_pitch, read.map_points, read.materials, read.density)


def field_case(read: Solving, driven: DrivenMachine) -> FieldCase:
    """Materials, winding and mesh; the nominal current density is half of that at full current."""
    packing, density = copper_share(driven), overload_density(driven)
    return FieldCase(
        read.materials, read.layers, read.coil_pitch, packing, read.density, read.density,
        nominal_density=density / 2, overload_density=density,
    )  # fmt: skip


def flux_map_grid(read: Solving, driven: DrivenMachine) -> FluxMapGrid:
    """Up to the full current."""
    return FluxMapGrid(copper_share(driven), overload_density(driven), *read.map_points)


def copper_share(driven: DrivenMachine) -> float:
    """Copper over the area of a coil side, dimensionless."""
    wound, machine = driven.wound, driven.wound.machine
    sides = 6 * wound.coils_in_series
    return wound.copper_area * sides / (2 * machine.slots * part_areas(machine).half_slot)


def overload_density(driven: DrivenMachine) -> float:
    """Amplitude of the current density in the copper at full current [A/m^2]."""
    wound = driven.wound
    return float(driven.limits.current_peak * wound.equivalent_turns / wound.copper_area)


def loss_inputs(read: MachineFile) -> LossInputs:
    """Whose loss data stand for the steel."""
    return LossInputs(read.steel, read.loss_grade, read.number("drive", "winding_temperature_degC"))
