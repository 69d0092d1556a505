"""The winding of a machine of any kind whose length is stated, chosen on its flux map for operating points.

Two stages, so that what was valued is there to be read when nothing can be chosen. No field is solved for them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from electrical.circulating import ZeroSequence
from electrical.dq import DriveLimits
from electrical.driven_machine import BegunMachine, DrivenMachine
from electrical.final_length import FinalLength, LengthNeed
from electrical.point_windings import (
    Candidate,
    OperatingPoint,
    PointValuer,
    chosen_candidate,
    least_ampere_turns,
)
from electrical.winding_connection import Delta, Star, WindingConnection
from electrical.winding_design import WindingDesign
from electrical.winding_selection import (
    LimitsWithDrive,
    Winding,
    evaluate_windings,
    full_designs,
    with_circulation,
)
from electrical.winding_stage import layout_of, per_turn_machine, possible_connections
from electrical.wire import Wire
from electrical.wound_machine import WoundMachine
from geometry.family import MatchedMachine
from magnetostatics.flux_map_stage import FluxMap


@dataclass(frozen=True)
class PointWindingInputs:
    """What may be wound, and what for.

    wires: allowed gauges, their copper at the temperature of the winding; paths: allowed numbers of parallel paths;
    closings: whether star, delta or both are allowed; limits: of workshop, bus and drive
    """

    wires: tuple[Wire, ...]
    paths: tuple[int, ...]
    closings: tuple[Star | Delta, ...]
    limits: LimitsWithDrive
    points: tuple[OperatingPoint, ...]


@dataclass(frozen=True)
class Candidates:
    """Every full slot, valued.

    coil_side_area: A_s [m^2]; left_out: numbers of parallel paths that are allowed and the star of slots is against
    """

    inputs: PointWindingInputs
    coil_side_area: float
    valued: tuple[Candidate, ...]
    left_out: tuple[int, ...]


@dataclass(frozen=True)
class PointWinding:
    """What is wound: chosen, and the machine with it."""

    chosen: Candidate
    driven: DrivenMachine


def candidates_stage(flux_map: FluxMap, begun: BegunMachine, inputs: PointWindingInputs) -> Candidates:
    """Value every full slot at the operating points.

    Raises WindingError when no wire fits the slot or no number of paths is possible.
    """
    wound, limits, valuer = begun.driven.wound, inputs.limits, valuer_of(flux_map, begun, inputs)
    machine = valuer.machine
    layout = layout_of(flux_map, MatchedMachine(wound.machine))
    connections = possible_connections(layout, inputs.paths, inputs.closings)
    designs = full_designs(machine.coil_side_area, inputs.wires, connections, limits)
    windings = evaluate_windings(machine, limits, designs, as_stated(wound.active_length, len(designs)))
    valued = valuer.candidates(_with_circulation(valuer, flux_map, windings))
    left_out = tuple(one for one in inputs.paths if one not in layout.path_numbers)
    return Candidates(inputs, machine.coil_side_area, valued, left_out)


def valuer_of(flux_map: FluxMap, begun: BegunMachine, inputs: PointWindingInputs) -> PointValuer:
    """What windings of a mapped machine are held to."""
    machine = per_turn_machine(flux_map, begun.driven.wound.end_turn_length)
    return PointValuer(machine, inputs.limits, inputs.points, flux_map.torque_error)


def chosen_winding_stage(candidates: Candidates, begun: BegunMachine) -> PointWinding:
    """Choose. Raises WindingError when no winding reaches every operating point."""
    chosen = chosen_candidate(candidates.valued, candidates.inputs.points)
    limits = candidates.inputs.limits
    driven = DrivenMachine(
        wound_as(begun, chosen.winding.design),
        DriveLimits.from_dc_bus(chosen.winding.current_peak, limits.dc_voltage),
        limits.maximum_speed,
    )
    return PointWinding(chosen, driven)


def driven_as_wound(found: PointWinding) -> DrivenMachine:
    """The machine with the winding that was chosen."""
    return found.driven


def wound_as(begun: BegunMachine, design: WindingDesign) -> WoundMachine:
    """The machine whose field was mapped with another winding."""
    bar = begun.driven.wound
    return WoundMachine(
        bar.machine, bar.coils_in_series, bar.coil_pitch, design, bar.active_length, bar.stated_end_turn
    )


def as_stated(length: float, number: int) -> tuple[FinalLength, ...]:
    """The stated active length [m] as that of so many windings."""
    return (FinalLength(length, (LengthNeed("the drawing", length),), length),) * number


def _with_circulation(valuer: PointValuer, flux_map: FluxMap, windings: tuple[Winding, ...]) -> tuple[Winding, ...]:
    """At the point with the most torque, by the current that it takes, or the full one where that is not enough."""
    closed = tuple(one for one in windings if _circulates(one.design.connection))
    if not closed:
        return windings
    zero, hardest = ZeroSequence.from_per_turn(flux_map.data), max(valuer.points, key=lambda one: one.torque)
    full = np.array([one.current_rms * one.design.equivalent_turns for one in closed])
    least = least_ampere_turns(valuer.machine.dq, hardest.torque / closed[0].active_length, 2**0.5 * full.max())
    copper = np.array([one.design.copper_area for one in closed])
    density = np.minimum(full, least / 2**0.5) / copper
    valued = with_circulation(valuer.machine, zero, closed, density, hardest.speed)
    return tuple(one for one in windings if not _circulates(one.design.connection)) + valued


def _circulates(connection: WindingConnection) -> bool:
    return connection.closing.circulates
