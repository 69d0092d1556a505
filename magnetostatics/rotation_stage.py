"""The reference machine and the matched one over one electrical period, and their fields in the null position.

Torque by both routes, torque without current and every probe over the rotor angle, on the mesh of the sweep; the fields
without current, at the nominal and at the overload current density on the finer mesh, ready to be drawn.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
import xarray as xr
from skfem import MeshTri

from geometry.cross_section import CrossSection
from geometry.family import MatchedMachine, StatedMachine
from geometry.parts import DrawnMachine
from magnetostatics.arc import Arc, angles_from_null, arcs, solved_over
from magnetostatics.case import FieldCase
from magnetostatics.mesh_error import torque_errors
from magnetostatics.model import OperatingPoint
from magnetostatics.positions import null_angle, null_point, q_axis_angle
from magnetostatics.probes import probe_reader
from magnetostatics.torque import arkkio_torque, maxwell_torque
from tasks import Workers

STATES = ("no_current", "nominal", "overload")  # that fields are kept of
_STEPS = 144  # over one electrical period: twelve in a period of the cogging of 12 slots and 10 poles
_TORQUES = ("torque_ring", "torque_circle", "torque_no_current")


@dataclass(frozen=True, eq=False)
class NullFields:
    """Fields of the meshed sector of a machine in the null position.

    points: the operating points of ``STATES``; rest: what is left of the rotor's angle between two nodes of the sliding
    circle [rad]; residuals: relative, of Newton's method, of each state
    data: ``node`` (2, n) [m], ``triangle`` (3, E), ``region`` (E,) as an index into region_names, ``a`` (state, dof) of
        the quadratic elements [Wb/m]
    """

    machine: DrawnMachine
    sectors: int
    antiperiodic: bool
    rest: float
    region_names: tuple[str, ...]
    points: tuple[OperatingPoint, ...]
    residuals: tuple[tuple[float, ...], ...]
    data: xr.Dataset

    def section(self, case: FieldCase) -> CrossSection:
        """The meshed cross-section that the fields were solved on."""
        index = self.data.region.values
        regions = {name: np.flatnonzero(index == number) for number, name in enumerate(self.region_names)}
        mesh = MeshTri(self.data.node.values, self.data.triangle.values).with_subdomains(regions)
        return CrossSection(self.machine, case.layout(self.machine), mesh, self.sectors, self.antiperiodic, ())

    def potential(self, state: str) -> np.ndarray:
        """A (n,) [Wb/m] at the nodes of the quadratic elements in one of ``STATES``."""
        return self.data.a.values[STATES.index(state)]


@dataclass(frozen=True, eq=False)
class Rotation:
    """One machine over one electrical period with the nominal current density on the q axis.

    null_angle, q_axis_angle: rotor angles of a magnet on a tooth, and of the q-axis current's peak in phase A [rad]
    torque_error: bound of the mesh error in the null position [Nm/m]
    data: over ``angle`` [rad], the last one an electrical period after the first: ``torque_ring`` (``arkkio_torque``),
        ``torque_circle`` (``maxwell_torque``), ``torque_no_current`` [Nm/m]; ``flux_density`` (probe, angle) [T]
    """

    machine: DrawnMachine
    null_angle: float
    q_axis_angle: float
    torque_error: float
    data: xr.Dataset
    fields: NullFields

    @property
    def one_period(self) -> xr.Dataset:
        """The data without the last angle, which repeats the first."""
        return self.data.isel(angle=slice(None, -1))

    @property
    def mean_torque(self) -> float:
        """Mean over one electrical period, ring average [Nm/m]."""
        return float(self.one_period.torque_ring.mean())

    @property
    def ripple(self) -> float:
        """Peak to peak, ring average [Nm/m]."""
        return float(np.ptp(self.one_period.torque_ring.values))

    @property
    def cogging(self) -> float:
        """Torque without current from peak to peak [Nm/m], see ``GapStress.cogging`` for that of the finer mesh."""
        return float(np.ptp(self.one_period.torque_no_current.values))

    @property
    def routes_apart(self) -> float:
        """Largest relative difference of the two torque routes."""
        return float(np.abs(self.one_period.torque_circle / self.one_period.torque_ring - 1).max())


@dataclass(frozen=True, eq=False)
class Rotations:
    """Both machines; matched is None where nothing was matched."""

    reference: Rotation
    matched: Rotation | None


@dataclass(frozen=True, eq=False)
class SolvedArc:
    """torques (angles, 3) [Nm/m] as ``_TORQUES`` and flux_densities (angles, probes) [T] of an arc."""

    torques: np.ndarray
    flux_densities: np.ndarray
    probes: tuple[str, ...]


@dataclass(frozen=True)
class NullStates:
    """A machine whose fields in the null position are wanted."""

    case: FieldCase
    machine: DrawnMachine


@dataclass(frozen=True, eq=False)
class SolvedNullStates:
    """What ``Rotation`` and ``NullFields`` take over: the mesh error, and the fields as plain arrays.

    torque_error: [Nm/m]; rest: of the rotor's angle [rad]; residuals: relative, of each state
    nodes (2, n) [m]; triangles: node indices (3, E); region: index of a name (E,); potentials: [Wb/m], (state, dof)
    """

    torque_error: float
    sectors: int
    antiperiodic: bool
    rest: float
    region_names: tuple[str, ...]
    residuals: tuple[tuple[float, ...], ...]
    nodes: np.ndarray
    triangles: np.ndarray
    region: np.ndarray
    potentials: np.ndarray


def rotations_stage(
    case: FieldCase, stated: StatedMachine, matched: MatchedMachine | None, workers: Workers
) -> Rotations:
    """Turn both machines over one electrical period, and solve their fields in the null position."""
    machines = {"reference": stated.machine} | ({"matched": matched.machine} if matched is not None else {})
    states = {f"{name}, null position": NullStates(case, machine) for name, machine in machines.items()}
    turns = {name: arcs(case, machine, _angles(case, machine)) for name, machine in machines.items()}
    named = {f"{name}, {which}": arc for name, turn in turns.items() for which, arc in turn.items()}
    solved = workers.map("rotation", solve_arc, named)
    null = workers.map("fields", solve_null_states, states)
    found = {
        name: _rotation(
            case,
            machine,
            np.concatenate([arc.angles for arc in turns[name].values()]),
            [solved[f"{name}, {which}"] for which in turns[name]],
            null[f"{name}, null position"],
        )
        for name, machine in machines.items()
    }
    return Rotations(found["reference"], found.get("matched"))


def _angles(case: FieldCase, machine: DrawnMachine) -> list[float]:
    """One electrical period from the null position on, both ends included [rad]."""
    period = 2 * pi / machine.pole_pairs
    angles = angles_from_null(case, machine, period, _STEPS)
    return [*angles, angles[0] + period]


def solve_arc(arc: Arc) -> SolvedArc:
    """Solve the angles of an arc without current and with the nominal current density on the q axis."""
    model, case = arc.model(), arc.case
    reader = probe_reader(model)
    idle = solved_over(model, arc.angles, 0.0, case.packing)
    loaded = solved_over(model, arc.angles, case.nominal_density, case.packing, start=idle[0])
    torques = [[arkkio_torque(one), maxwell_torque(one), arkkio_torque(free)] for one, free in zip(loaded, idle)]
    return SolvedArc(np.array(torques), np.array([list(reader.read(one).values()) for one in loaded]), reader.names)


def null_points(case: FieldCase, machine: DrawnMachine) -> tuple[OperatingPoint, ...]:
    """The operating points of ``STATES``."""
    amplitudes = (0.0, case.nominal_density, case.overload_density)
    return tuple(null_point(machine, case.layout(machine), amplitude, case.packing) for amplitude in amplitudes)


def solve_null_states(wanted: NullStates) -> SolvedNullStates:
    """The fields of a machine in the null position on the finer mesh, and the mesh error on that of the sweep."""
    case, machine = wanted.case, wanted.machine
    points, model = null_points(case, machine), case.detailed_model(machine)
    solutions = [model.solve(point) for point in points]
    region = np.empty(model.section.mesh.nelements, dtype=np.int32)
    for number, elements in enumerate(model.section.mesh.subdomains.values()):
        region[elements] = number
    return SolvedNullStates(
        torque_error=torque_errors([case.model(machine).solve(points[STATES.index("nominal")])])[0],
        sectors=model.section.sectors,
        antiperiodic=model.section.antiperiodic,
        rest=float(model.unknowns.turn(points[0].angle).rest),
        region_names=tuple(model.section.mesh.subdomains),
        residuals=tuple(solution.newton.residuals for solution in solutions),
        nodes=model.section.mesh.p,
        triangles=model.section.mesh.t.astype(np.int32),
        region=region,
        potentials=np.stack([solution.a for solution in solutions]),
    )


def _rotation(
    case: FieldCase, machine: DrawnMachine, angles: np.ndarray, arcs: list[SolvedArc], null: SolvedNullStates
) -> Rotation:
    layout = case.layout(machine)
    return Rotation(
        machine=machine,
        null_angle=null_angle(machine, layout),
        q_axis_angle=q_axis_angle(machine, layout),
        torque_error=null.torque_error,
        data=_turning(angles, arcs),
        fields=_fields(case, machine, null),
    )


def _turning(angles: np.ndarray, arcs: list[SolvedArc]) -> xr.Dataset:
    torques = np.concatenate([arc.torques for arc in arcs])
    flux = np.concatenate([arc.flux_densities for arc in arcs])
    data: dict[str, tuple[str | tuple[str, ...], np.ndarray]]
    data = {name: ("angle", torques[:, k]) for k, name in enumerate(_TORQUES)}
    data["flux_density"] = (("probe", "angle"), flux.T)
    return xr.Dataset(data, {"angle": angles, "probe": list(arcs[0].probes)})


def _fields(case: FieldCase, machine: DrawnMachine, null: SolvedNullStates) -> NullFields:
    data = {
        "node": (("xy", "corner_node"), null.nodes),
        "triangle": (("corner", "element"), null.triangles),
        "region": ("element", null.region),
        "a": (("state", "dof"), null.potentials),
    }
    return NullFields(
        machine,
        null.sectors,
        null.antiperiodic,
        null.rest,
        null.region_names,
        null_points(case, machine),
        null.residuals,
        xr.Dataset(data),
    )
