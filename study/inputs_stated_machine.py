"""What the stages read of a machine that is stated whole, in a file of its own, in SI."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

from electrical.dq import DriveLimits
from electrical.driven_machine import BegunMachine, CopperTemperature, DrivenMachine
from electrical.kind_search import KindSearch, StatedDesign
from electrical.point_winding_stage import PointWindingInputs
from electrical.point_windings import OperatingPoint
from electrical.winding_connection import SERIES_STAR
from electrical.winding_design import WindingDesign
from electrical.winding_selection import LimitsWithDrive
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
from study.errors import StudyError
from study.inputs_electrical import (
    allowed_closings,
    allowed_paths,
    allowed_wires,
    circulating_share,
    insulated_fill,
)
from study.machine_file import MachineFile
from study.machine_winding import POINTS
from units import RPM

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
    return StatedDesign(field_case(solving(read), BegunMachine(driven)), driven)


def kind_search(read: MachineFile) -> KindSearch:
    """What [[variables]] and [search] ask for; without variables nothing is looked for."""
    assert read.search is not None  # the graph asks only then
    return read.search


def wire(read: MachineFile) -> Wire:
    """Of the winding, its copper at the temperature that the file states."""
    size = any_gauge(read.number("winding", "wire_diameter_mm"), _GRADE)
    return Wire(size.copper_diameter, size.outer_diameter, resistivity(read))


def resistivity(read: MachineFile) -> float:
    """Of the copper at the temperature that the file states [ohm m]."""
    return float(COPPER.resistivity(read.number("drive", "winding_temperature_degC")))


def design_to_be_wound(read: MachineFile) -> StatedDesign:
    """The machine with one bar a coil, which fills the slot as far as copper may and carries what it may.

    Raises StudyError for what is left out, MaterialError for a wire that is not sold.
    """
    limits, layout = winding_inputs(read).limits, read.layout
    area = limits.largest_packing * 2 * read.machine.slots * part_areas(read.machine).half_slot
    bar = _bar(area / (6 * layout.coils_in_series), resistivity(read))
    wound = WoundMachine(
        read.machine, layout.coils_in_series, layout.coil_pitch, bar, read.active_length, read.end_turn
    )
    full = DriveLimits.from_dc_bus(limits.density_ampere_turns(bar.copper_area), limits.dc_voltage)
    driven = DrivenMachine(wound, full, limits.maximum_speed)
    return StatedDesign(field_case(solving(read), BegunMachine(driven)), driven)


def _bar(area: float, resistivity: float) -> WindingDesign:
    """One turn; area: of its copper [m^2], resistivity [ohm m]."""
    diameter = sqrt(4 * area / pi)
    return WindingDesign(1, 1, Wire(diameter, diameter, resistivity), SERIES_STAR)


def winding_inputs(read: MachineFile) -> PointWindingInputs:
    """What may be wound into a machine and what for. Raises StudyError and MaterialError as ``design_to_be_wound``."""
    selection = read.selection
    assert selection is not None  # the graph asks only then
    return PointWindingInputs(
        wires=allowed_wires(selection, resistivity(read)),
        paths=allowed_paths(selection),
        closings=allowed_closings(selection),
        limits=LimitsWithDrive(
            packing_limit=selection.packing_factor,
            packing_tolerance=selection.packing_tolerance,
            overload_current_density=selection.si.j_overload_rms,
            dc_voltage=read.number("drive", "dc_bus_voltage_V"),
            maximum_speed=read.number("drive", "speed_max_rpm"),
            insulated_fill=insulated_fill(selection),
            circulating_share=circulating_share(selection),
            phase_current_rms=read.number("drive", "line_current_peak_A") / sqrt(2),
        ),
        points=_points(read),
    )


def _points(read: MachineFile) -> tuple[OperatingPoint, ...]:
    fastest = read.number("drive", "speed_max_rpm")
    for one in read.points:
        if one.si.speed > fastest:
            raise StudyError(
                f"{read.path}: [[{POINTS}]] speed_rpm = {one.speed_rpm:g} is beyond speed_max_rpm = "
                f"{fastest / RPM:g} of [drive]; raise that or lower the point."
            )
    return tuple(OperatingPoint(one.si.torque, one.si.speed) for one in read.points)


def stated_machine(begun: BegunMachine) -> MatchedMachine:
    """The cross-section."""
    return MatchedMachine(begun.driven.wound.machine)


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


def field_case(read: Solving, begun: BegunMachine) -> FieldCase:
    """Materials, winding and mesh; the nominal current density is half of that at full current."""
    packing, density = copper_share(begun.driven), overload_density(begun.driven)
    return FieldCase(
        read.materials, read.layers, read.coil_pitch, packing, read.density, read.density,
        nominal_density=density / 2, overload_density=density,
    )  # fmt: skip


def flux_map_grid(read: Solving, begun: BegunMachine) -> FluxMapGrid:
    """Up to the full current."""
    return FluxMapGrid(copper_share(begun.driven), overload_density(begun.driven), *read.map_points)


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
