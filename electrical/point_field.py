"""The chosen winding at its operating points, solved in the field: what the splines of the map are off by there.

The map is exact at its currents and cubic between them, and a bound of the mesh error says nothing of that. So every
point is solved at its least current, over the rotor angles of the map.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, hypot

from electrical.dq import DriveLimits, torque_of, torque_speed_envelope, voltage_of
from electrical.driven_machine import BegunMachine
from electrical.point_winding_stage import Candidates, PointWinding, valuer_of
from electrical.point_windings import OperatingPoint, PointValuer
from geometry.parts import DrawnMachine
from magnetostatics.case import FieldCase
from magnetostatics.flux_map import map_angles
from magnetostatics.flux_map_stage import FluxMap, kept_model
from magnetostatics.turn import Supply, turned
from tasks import Workers


@dataclass(frozen=True)
class FieldPoint:
    """An operating point at the least line current that surely gives its torque.

    direct, quadrature: i_d, i_q, peak [A]
    torque: by the flux linkages of the field [Nm]; ring_torque: by its ring average [Nm]; both mean over the angles
    map_voltage, voltage: of a phase, peak, by map and field [V]
    """

    asked: OperatingPoint
    direct: float
    quadrature: float
    torque: float
    ring_torque: float
    map_voltage: float
    voltage: float

    @property
    def current(self) -> float:
        """Of a line, peak [A]."""
        return hypot(self.direct, self.quadrature)


@dataclass(frozen=True)
class FieldPoints:
    """Every operating point; voltage_limit: of a phase, peak, by the bus [V]"""

    points: tuple[FieldPoint, ...]
    voltage_limit: float


@dataclass(frozen=True, eq=False)
class FieldPointTask:
    """A machine with its supply at some rotor angles over the period of the map; active_length [m]."""

    case: FieldCase
    machine: DrawnMachine
    supply: Supply
    active_length: float
    angles: int


def points_stage(
    case: FieldCase,
    flux_map: FluxMap,
    begun: BegunMachine,
    candidates: Candidates,
    found: PointWinding,
    workers: Workers,
) -> FieldPoints:
    """Solve every point; a task is one of them. Raises FieldSolutionError."""
    valuer, wound = valuer_of(flux_map, begun, candidates.inputs), found.driven.wound
    states = [_least_current(valuer, flux_map, found, point) for point in valuer.points]
    angles = flux_map.data.sizes["angle"]
    tasks = {
        f"point {k}": FieldPointTask(case, wound.machine, _supply(found, *state), wound.active_length, angles)
        for k, state in enumerate(states)
    }
    solved = workers.map("operating points", solve_point, tasks).values()
    rows = zip(valuer.points, states, solved, strict=True)
    return FieldPoints(tuple(_field_point(found, *row) for row in rows), found.driven.limits.voltage_peak)


def _least_current(
    valuer: PointValuer, flux_map: FluxMap, found: PointWinding, point: OperatingPoint
) -> tuple[float, float, float]:
    """i_d, i_q [A] and the voltage [V] that the map gives with them."""
    share = float(valuer.needed_shares((found.chosen.winding,), point)[0])
    limits = DriveLimits(share * found.driven.limits.current_peak, found.driven.limits.voltage_peak)
    least = torque_speed_envelope(found.driven.wound.on_map(flux_map.data), limits, point.speed)
    return float(least.i_d), float(least.i_q), float(least.voltage_peak)


def _supply(found: PointWinding, direct: float, quadrature: float, _: float) -> Supply:
    return Supply(hypot(direct, quadrature), atan2(-direct, quadrature), found.driven.wound.equivalent_turns)


def solve_point(task: FieldPointTask) -> tuple[float, float, float]:
    """psi_d, psi_q [Wb] of the stack and its torque by the ring average [Nm], mean over the angles."""
    model = kept_model(task.case, task.machine)
    solved = turned(model, task.supply, task.active_length, map_angles(model, task.angles))
    psi_d, psi_q = solved.dq_linkage.mean(axis=0).tolist()
    return psi_d, psi_q, solved.mean_torque


def _field_point(
    found: PointWinding,
    asked: OperatingPoint,
    by_map: tuple[float, float, float],
    solved: tuple[float, float, float],
) -> FieldPoint:
    (d, q, map_voltage), (psi_d, psi_q, ring), wound = by_map, solved, found.driven.wound
    pole_pairs, psi = wound.machine.pole_pairs, (psi_d, psi_q)
    voltage = voltage_of(wound.phase_resistance, psi, d, q, pole_pairs * asked.speed)
    torque = float(torque_of(pole_pairs, psi, d, q))
    return FieldPoint(asked, d, q, torque, ring, map_voltage, float(hypot(*voltage)))
