"""Flux map: flux linkages and torque over the currents in the rotor frame and over the rotor angle.

Per turn and per metre, so that one map serves every winding and length of a cross-section: a current is the peak
ampere-turns of one coil, NI = J k_cp A_s [A], a flux linkage belongs to one turn of every coil of a phase in series
[Wb/m], torque is [Nm/m]. The rotor frame is amplitude-invariant, the d axis lies on magnet 0:

    i_d = -NI sin(gamma),  i_q = NI cos(gamma),  T = 1.5 p (psi_d i_q - psi_q i_d) in the mean over the angle

All currents at one angle share one joined system, so an angle is the task to hand to a worker (``solve_angle``).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from math import atan2, cos, hypot, pi, sin
from typing import Any

import numpy as np

from labelled import xr
from magnetostatics.flux_linkage import park, phase_flux_linkage
from magnetostatics.model import FieldModel, FieldSolution, OperatingPoint, blended
from magnetostatics.positions import torque_period
from magnetostatics.torque import arkkio_torque

_SOURCES = 3  # solved currents that a start is interpolated from; the steel's curve is not smooth enough for more

_ATTRIBUTES = {
    "psi_d": {"units": "Wb/m", "long_name": "d-axis flux linkage per turn and metre"},
    "psi_q": {"units": "Wb/m", "long_name": "q-axis flux linkage per turn and metre"},
    "psi_0": {"units": "Wb/m", "long_name": "zero-sequence flux linkage per turn and metre"},
    "torque": {"units": "N m/m", "long_name": "torque per metre, ring average"},
    "l_dd": {"units": "H/m", "long_name": "incremental inductance d psi_d / d i_d per turn^2 and metre"},
    "l_dq": {"units": "H/m", "long_name": "incremental inductance d psi_d / d i_q per turn^2 and metre"},
    "l_qd": {"units": "H/m", "long_name": "incremental inductance d psi_q / d i_d per turn^2 and metre"},
    "l_qq": {"units": "H/m", "long_name": "incremental inductance d psi_q / d i_q per turn^2 and metre"},
    "iterations": {"units": "1", "long_name": "Newton iterations"},
}
_COORDINATES = {
    "id": {"units": "A", "long_name": "d-axis ampere-turns of one coil, peak"},
    "iq": {"units": "A", "long_name": "q-axis ampere-turns of one coil, peak"},
    "angle": {"units": "rad", "long_name": "mechanical rotor angle"},
}


class FluxMapError(ValueError):
    """A flux map that cannot be used as asked; the message says why and what to do."""


@dataclass(frozen=True, eq=False)
class CurrentGrid:
    """Currents of a map: i_d (n,) and i_q (m,), peak ampere-turns of one coil [A], each increasing."""

    i_d: np.ndarray
    i_q: np.ndarray

    @classmethod
    def motoring(cls, reach: float, steps: int = 11) -> CurrentGrid:
        """``steps`` x ``steps`` currents: -reach <= i_d <= reach / 4 and 0 <= i_q <= reach.

        Negative i_q follows by ``mirrored``. The strip of positive i_d keeps the q axis off the edge of the map.
        reach: largest peak ampere-turns of one coil [A]
        """
        return cls(np.linspace(-reach, reach / 4, steps), np.linspace(0.0, reach, steps))

    @classmethod
    def magnetising(cls, reach: float, steps: int = 11) -> CurrentGrid:
        """``steps`` x ``steps`` currents of a motor without magnets: 0 <= i_d <= reach and 0 <= i_q <= reach.

        Its d axis is that of high permeance: without a current on it there is no torque.
        reach: largest peak ampere-turns of one coil [A]
        """
        return cls(np.linspace(0.0, reach, steps), np.linspace(0.0, reach, steps))


# ---- currents in the rotor frame and operating points ---------------------------------------------------------------


def operating_point(model: FieldModel, angle: float, i_d: float, i_q: float, packing: float = 1.0) -> OperatingPoint:
    """The operating point of a current in the rotor frame.

    J = hypot(i_d, i_q) / (k_cp A_s),  gamma = atan2(-i_d, i_q)

    angle: mechanical rotor angle [rad]; i_d, i_q: peak ampere-turns of one coil [A]
    packing: copper share k_cp by which J is stated; only k_cp J counts in the field, and 1 makes J that of the slot
    """
    return OperatingPoint(angle, hypot(i_d, i_q) / (packing * _coil_side_area(model)), atan2(-i_d, i_q), packing)


def dq_current(model: FieldModel, point: OperatingPoint) -> tuple[float, float]:
    """(i_d, i_q) of an operating point, peak ampere-turns of one coil [A]: -NI sin(gamma), NI cos(gamma)."""
    ampere_turns = point.current_density * point.packing_factor * _coil_side_area(model)
    return -ampere_turns * sin(point.current_angle), ampere_turns * cos(point.current_angle)


def _coil_side_area(model: FieldModel) -> float:
    return model.section.half_slot_area * model.section.half_slots_per_coil_side


def map_angles(model: FieldModel, count: int) -> np.ndarray:
    """``count`` mechanical rotor angles [rad] over one period, the first with the d axis on the axis of phase A.

    The set is its own mirror image about that axis, which ``mirrored`` relies on.
    """
    section = model.section
    period = torque_period(section.machine)
    return (section.layout.phase_axis + period * np.arange(count) / count) / section.machine.pole_pairs


# ---- what is read from a solution -----------------------------------------------------------------------------------


def flux_and_torque(solution: FieldSolution) -> dict[str, float]:
    """psi_d, psi_q [Wb/m per turn], torque [Nm/m] and Newton iterations of a solution."""
    psi_d, psi_q = park(phase_flux_linkage(solution), *_electrical(solution))
    iterations = solution.newton.iterations
    return {"psi_d": float(psi_d), "psi_q": float(psi_q), "torque": arkkio_torque(solution), "iterations": iterations}


def flux_torque_and_zero_sequence(solution: FieldSolution) -> dict[str, float]:
    """What ``flux_and_torque`` reads, and psi_0 = (psi_A + psi_B + psi_C) / 3 [Wb/m per turn]."""
    return flux_and_torque(solution) | {"psi_0": float(np.mean(phase_flux_linkage(solution)))}


def flux_torque_and_inductances(solution: FieldSolution) -> dict[str, float]:
    """What ``flux_and_torque`` reads, and the incremental inductances l_dd, l_dq, l_qd, l_qq [H/m per turn^2]."""
    inductances = incremental_inductances(solution).ravel().tolist()
    return flux_and_torque(solution) | dict(zip(("l_dd", "l_dq", "l_qd", "l_qq"), inductances, strict=True))


def incremental_inductances(solution: FieldSolution) -> np.ndarray:
    """d(psi_d, psi_q) / d(i_d, i_q) at the rotor angle of a solution (2, 2) [H/m per turn^2].

    L_ij = (2/3) n w_i . K^-1 w_j with the tangent K of the converged field, the load w of a unit current on axis d or
    q, and n sectors: one factorisation and two back-substitutions, no difference quotient. Symmetric, because K is.
    """
    model = solution.model
    loads = _axis_loads(solution)
    tangent = model.tangent(solution)
    responses = np.stack([tangent.response(load) for load in loads])
    return 2 / 3 * model.section.sectors * loads @ responses.T


def _axis_loads(solution: FieldSolution) -> np.ndarray:
    """Load of one ampere-turn on the d and on the q axis (2, n): inverse Park transform of the phase loads."""
    electrical, axis = _electrical(solution)
    lag = electrical - axis - 2 * pi / 3 * np.arange(3)
    return np.stack([np.cos(lag), -np.sin(lag)]) @ solution.model.phase_loads


def _electrical(solution: FieldSolution) -> tuple[float, float]:
    section = solution.model.section
    return section.machine.pole_pairs * solution.point.angle, section.layout.phase_axis


Reader = Callable[[FieldSolution], Mapping[str, float]]

# ---- solving the map ------------------------------------------------------------------------------------------------


def flux_map(
    model: FieldModel, grid: CurrentGrid, angles: Sequence[float], read: Reader = flux_and_torque
) -> xr.Dataset:
    """The whole map in this process, angles: mechanical [rad]; see ``solve_angle`` for one angle at a time."""
    return to_dataset(model, grid, angles, [solve_angle(model, angle, grid, read) for angle in angles])


def solve_angle(
    model: FieldModel, angle: float, grid: CurrentGrid, read: Reader = flux_and_torque
) -> dict[str, list[list[float]]]:
    """All currents of a grid at one rotor angle [rad]: what ``read`` returns, each as nested lists [i_d][i_q].

    The currents are solved from the corners inwards, halving the distance, so that nearly every solve starts from a
    parabola through solved neighbours on both sides: a fifth fewer Newton iterations than going through the grid in a
    serpentine and starting from the last solution.
    Raises FieldSolutionError when a current does not converge.
    """
    solutions: dict[tuple[int, int], FieldSolution] = {}
    for at, sources, weights in _order(grid.i_d, grid.i_q):
        point = operating_point(model, angle, grid.i_d[at[0]], grid.i_q[at[1]])
        solutions[at] = model.solve(point, _blend([solutions[s] for s in sources], weights))
    rows = {at: read(solution) for at, solution in solutions.items()}
    names, shape = rows[0, 0].keys(), (len(grid.i_d), len(grid.i_q))
    return {name: [[rows[k, j][name] for j in range(shape[1])] for k in range(shape[0])] for name in names}


def to_dataset(
    model: FieldModel, grid: CurrentGrid, angles: Sequence[float], rows: Sequence[Mapping[str, Any]]
) -> xr.Dataset:
    """The labelled map from the results of ``solve_angle`` in the order of the angles [rad], with units."""
    data = {name: (("angle", "id", "iq"), np.array([row[name] for row in rows]), _ATTRIBUTES[name]) for name in rows[0]}
    values = {"id": grid.i_d, "iq": grid.i_q, "angle": np.asarray(angles, dtype=float)}
    coordinates = {name: (name, values[name], attributes) for name, attributes in _COORDINATES.items()}
    machine, layout = model.section.machine, model.section.layout
    note = "flux linkages and torque per turn and metre in the amplitude-invariant rotor frame, d axis on magnet 0"
    winding = {"coils_in_series": layout.coils_in_series, "phase_axis": layout.phase_axis,
               "period": torque_period(machine)}  # fmt: skip
    return xr.Dataset(data, coordinates, {"description": note, "pole_pairs": machine.pole_pairs, **winding})


def _blend(solutions: list[FieldSolution], weights: np.ndarray) -> FieldSolution | None:
    """A start between solutions; None (a start from linear elements) where fewer than two are known."""
    return blended(solutions, weights) if len(solutions) > 1 else None


def _order(i_d: np.ndarray, i_q: np.ndarray) -> Iterator[tuple[tuple[int, int], list[tuple[int, int]], np.ndarray]]:
    """Every grid index once, with the indices solved before that its start comes from and their weights."""
    rows: list[int] = []
    columns: list[int] = []
    for new_rows, new_columns in zip_longest(_halving(len(i_d)), _halving(len(i_q)), fillvalue=()):
        for j in sorted(columns):
            for k in new_rows:
                near = _nearest(k, rows)
                yield (k, j), [(n, j) for n in near], _lagrange(i_d[k], i_d[near])
        rows += new_rows
        for j in new_columns:
            near = _nearest(j, columns)
            for k in sorted(rows):
                yield (k, j), [(k, n) for n in near], _lagrange(i_q[j], i_q[near])
        columns += new_columns


def _halving(count: int) -> list[list[int]]:
    """Indices 0 .. count - 1 in levels: the ends, then the middles of the gaps that are left."""
    levels = [sorted({0, count - 1})]
    while sum(map(len, levels)) < count:
        known = sorted(index for level in levels for index in level)
        levels.append([(a + b) // 2 for a, b in zip(known, known[1:]) if b - a > 1])
    return levels


def _nearest(index: int, known: list[int]) -> list[int]:
    return sorted(known, key=lambda other: abs(other - index))[:_SOURCES]


def _lagrange(x: float, nodes: np.ndarray) -> np.ndarray:
    """Weights of the values at the nodes in their interpolant at x."""
    others = [np.delete(nodes, k) for k in range(len(nodes))]
    return np.array([np.prod((x - rest) / (node - rest)) for node, rest in zip(nodes, others)])


# ---- what follows by symmetry ---------------------------------------------------------------------------------------


def mirrored(data: xr.Dataset) -> xr.Dataset:
    """A map of i_q >= 0 completed by i_q < 0.

    The winding is symmetric about the axis of phase A, the rotor about its d axis. With e = p theta - axis of phase A:
        psi_d(e, i_d, -i_q) = psi_d(-e, i_d, i_q),  psi_q and torque the same with the opposite sign
    What has no angle (amplitudes of harmonics) is even in i_q.
    Raises FluxMapError when i_q does not start at zero or the angles are not their own mirror image (``map_angles``).
    """
    if data.iq.values[0] != 0.0:
        raise FluxMapError(f"a map to be mirrored starts at i_q = 0; this one starts at {data.iq.values[0]:g} A")
    image = data.isel(angle=_mirror_images(data), iq=slice(None, 0, -1))
    image = image.assign_coords(angle=data.angle, iq=("iq", -image.iq.values, data.iq.attrs))
    odd = [name for name in ("psi_q", "torque", "l_dq", "l_qd") if name in data]
    image = image.assign({name: -image[name] for name in odd})
    return xr.concat([image, data], dim="iq", data_vars="minimal", combine_attrs="override")


def _mirror_images(data: xr.Dataset) -> np.ndarray:
    """For every angle the index of the angle at -e, modulo the period."""
    electrical = data.attrs["pole_pairs"] * data.angle.values - data.attrs["phase_axis"]
    period = data.attrs["period"]
    distance = np.abs((electrical[:, None] + electrical + period / 2) % period - period / 2)
    if distance.min(axis=1).max() > 1e-6:
        raise FluxMapError("the rotor angles are not their own mirror image about the axis of phase A: take map_angles")
    return distance.argmin(axis=1)
