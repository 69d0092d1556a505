"""The flux map of the matched machine, solved before its winding is chosen: per turn and metre it serves every winding.

How far the currents reach follows from the copper that the slot may hold, not from the winding:

    reach = margin * k_cp (1 + tolerance) * J * A_s         peak ampere-turns of one coil [A]
"""

from __future__ import annotations

import pickle
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from geometry.family import MatchedMachine
from geometry.parts import DrawnMachine
from labelled import xr
from magnetostatics.case import FieldCase
from magnetostatics.flux_map import (
    CurrentGrid,
    flux_torque_and_zero_sequence,
    map_angles,
    mirrored,
    operating_point,
    solve_angle,
    to_dataset,
)
from magnetostatics.mesh_error import torque_with_error
from magnetostatics.model import FieldModel
from magnetostatics.zero_sequence import with_zero_sequence, zero_sequence_inductance
from tasks import Workers

MARGIN = 1.05  # reach of the map over the largest ampere-turns of a winding: keeps them off the edge of the spline
ANGLES = 10  # over 60 electrical degrees; the mean over them is free of harmonics below the 60th
CURRENTS = 11  # along i_d and along i_q >= 0
_BEST_ANGLES = 181  # of the current over both senses of the d axis, from which the best one is taken


@dataclass(frozen=True)
class FluxMapGrid:
    """Which currents and rotor angles are solved.

    largest_packing: copper over the area of a coil side that a winding may fill, k_cp (1 + tolerance)
    overload_density: amplitude of the overload current density in the copper [A/m^2]
    angles: over 60 electrical degrees; currents: along i_d and along i_q >= 0
    margin: reach of the map relative to the largest ampere-turns
    """

    largest_packing: float
    overload_density: float
    angles: int = ANGLES
    currents: int = CURRENTS
    margin: float = MARGIN

    def ampere_turns(self, coil_side_area: float) -> float:
        """Peak ampere-turns of one coil at the overload current in the fullest coil side [A]; area A_s [m^2]."""
        return self.largest_packing * self.overload_density * coil_side_area


@dataclass(frozen=True, eq=False)
class FluxMap:
    """Flux linkages and torque of a cross-section over currents and rotor angle, per turn and metre.

    data: psi_d, psi_q [Wb/m], torque [Nm/m] (ring average) over angle [rad], id, iq [A peak ampere-turns of one coil],
        angles evenly over 60 electrical degrees, negative i_q by symmetry; see ``magnetostatics.flux_map``.
        psi_0 [Wb/m] over order, id, iq and l_0 [H/m per turn^2]: see ``magnetostatics.zero_sequence``
    pole_pairs; coils_in_series: of one phase; coil_pitch [slots]; coil_side_area: A_s [m^2]
    overload_ampere_turns: peak of one coil at which the error of the mesh is bounded [A]
    torque_error: that bound relative to the torque there; in the first rotor position, at the best current angle
    """

    data: xr.Dataset
    pole_pairs: int
    coils_in_series: int
    coil_pitch: int
    coil_side_area: float
    overload_ampere_turns: float
    torque_error: float

    def torque_ripple(self, i_d: float, i_q: float) -> float:
        """Largest less smallest torque over the rotor angles of the map [Nm/m], at one current (i_d, i_q) [A of one
        coil, peak]; cubic between the currents of the map. Harmonics above half the number of angles are not seen."""
        torque = self.data["torque"].transpose("id", "iq", "angle").values
        axes = (self.data["id"].values, self.data["iq"].values)
        over_angle = RegularGridInterpolator(axes, torque, method="cubic")((i_d, i_q))
        return float(np.ptp(over_angle))


@dataclass(frozen=True, eq=False)
class AngleTask:
    """All currents of a grid at one rotor angle [rad]."""

    case: FieldCase
    machine: DrawnMachine
    angle: float
    grid: CurrentGrid


@dataclass(frozen=True)
class PointTask:
    """One rotor angle [rad] and current [A of one coil, peak]."""

    case: FieldCase
    machine: DrawnMachine
    angle: float
    i_d: float
    i_q: float


def flux_map_stage(case: FieldCase, matched: MatchedMachine, grid: FluxMapGrid, workers: Workers) -> FluxMap:
    """Solve the map of a machine; a task is one rotor angle with all currents.

    Raises FieldSolutionError when a current does not converge, GeometryError when the machine cannot be built.
    """
    machine = matched.machine
    model = kept_model(case, machine)
    area = model.section.half_slot_area * model.section.half_slots_per_coil_side
    overload = grid.ampere_turns(area)
    quadrant = CurrentGrid.motoring if machine.rotor.magnets_per_pitch else CurrentGrid.magnetising
    currents = quadrant(grid.margin * overload, grid.currents)
    angles = map_angles(model, grid.angles)
    tasks = {f"angle {k}": AngleTask(case, machine, float(angle), currents) for k, angle in enumerate(angles)}
    rows = workers.map("flux map", solve_angle_task, tasks)
    solved = to_dataset(model, currents, angles.tolist(), list(rows.values()))
    idle = PointTask(case, machine, float(angles[0]), 0.0, 0.0)
    inductance = workers.map("zero sequence", zero_sequence_task, {"no current": idle})["no current"]
    data = mirrored(with_zero_sequence(with_end_leakage(solved, case.end_leakage), inductance))
    error = PointTask(case, machine, float(angles[0]), *best_current(data, overload))
    torque, off = workers.map("torque error", torque_error_task, {"overload": error})["overload"]
    layout = model.section.layout
    return FluxMap(
        data, machine.pole_pairs, layout.coils_in_series, layout.coil_pitch, area, overload, off / abs(torque)
    )


def with_end_leakage(data: xr.Dataset, share: float) -> xr.Dataset:
    """A map whose magnets keep a share of their flux beyond the ends; without any, the map itself.

    psi -> psi - share psi_0,   T -> (1 - share) (T - T_0) + (1 - share)^2 T_0      (psi_0, T_0: without current)

    What the currents make is left as it is. The bench model of a machine has the same law.
    data: with i_q = 0 on its grid and i_d = 0 inside it; share: dimensionless
    """
    if share == 0.0:
        return data
    idle = data.sel(iq=0.0).interp(id=0.0, method="cubic")
    kept = 1.0 - share
    torque = kept * (data.torque - idle.torque) + kept**2 * idle.torque
    linkages = [name for name in ("psi_d", "psi_q", "psi_0") if name in data]
    changed = {name: data[name] - share * idle[name] for name in linkages} | {"torque": torque}
    return data.assign({name: one.transpose(*data[name].dims) for name, one in changed.items()})


def solve_angle_task(task: AngleTask) -> dict[str, list[list[float]]]:
    """psi_d, psi_q, psi_0 [Wb/m], torque [Nm/m] and iterations by name, (i_d, i_q), at one rotor angle."""
    return solve_angle(kept_model(task.case, task.machine), task.angle, task.grid, flux_torque_and_zero_sequence)


def zero_sequence_task(task: PointTask) -> float:
    """L_0 [H/m per turn^2]."""
    model = kept_model(task.case, task.machine)
    return zero_sequence_inductance(model.solve(operating_point(model, task.angle, task.i_d, task.i_q)))


def torque_error_task(task: PointTask) -> tuple[float, float]:
    """Torque and its bound [Nm/m]."""
    model = kept_model(task.case, task.machine)
    return torque_with_error(model, operating_point(model, task.angle, task.i_d, task.i_q))


def best_current(data: xr.Dataset, current: float) -> tuple[float, float]:
    """(i_d, i_q) [A] of the largest mean torque on the circle of a current [A], to a degree of the current angle."""
    gamma = np.linspace(-np.pi / 2, np.pi / 2, _BEST_ANGLES)
    i_d, i_q = -current * np.sin(gamma), current * np.cos(gamma)
    inside = (data["id"].values[0] <= i_d) & (i_d <= data["id"].values[-1])
    i_d, i_q = i_d[inside], i_q[inside]
    mean = data["torque"].mean("angle").transpose("id", "iq")
    table = RegularGridInterpolator((data["id"].values, data["iq"].values), mean.values, method="cubic")
    best = int(np.argmax(table(np.stack([i_d, i_q], axis=-1))))
    return float(i_d[best]), float(i_q[best])


def kept_model(case: FieldCase, machine: DrawnMachine) -> FieldModel:
    """Field model of a machine on the mesh of the sweep; the last one is kept in this process.

    A case holds arrays and travels by pickling, so that it is known again by its pickled bytes.
    """
    return _model(pickle.dumps((case, machine)))


@lru_cache(maxsize=1)
def _model(pickled: bytes) -> FieldModel:
    case, machine = pickle.loads(pickled)
    return case.model(machine)
