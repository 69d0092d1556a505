"""The turning reference machine, and its fields and those of the matched one in the null position.

The fields without current, at the nominal and at the overload current density are those of the finer mesh, ready to be
drawn; how the matched machine turns stands in ``magnetostatics.gap_stress_stage``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem import MeshTri

from geometry.cross_section import CrossSection
from geometry.family import MatchedMachine, StatedMachine
from geometry.parts import DrawnMachine
from labelled import xr
from magnetostatics.case import FieldCase
from magnetostatics.mesh_error import torque_errors
from magnetostatics.model import OperatingPoint
from magnetostatics.positions import null_point
from magnetostatics.rotation import STATES, Rotation, solve_rotation
from tasks import Workers


@dataclass(frozen=True, eq=False)
class NullFields:
    """Fields of the meshed sector of a machine in the null position.

    torque_error: bound of the mesh error of the torque at the nominal current, on the mesh of the sweep [Nm/m]
    points: the operating points of ``STATES``; rest: what is left of the rotor's angle between two nodes of the sliding
    circle [rad]; residuals: relative, of Newton's method, of each state
    data: ``node`` (2, n) [m], ``triangle`` (3, E), ``region`` (E,) as an index into region_names, ``a`` (state, dof) of
        the quadratic elements [Wb/m]
    """

    machine: DrawnMachine
    torque_error: float
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

    def point(self, state: str) -> OperatingPoint:
        """Where one of ``STATES`` was solved."""
        return self.points[STATES.index(state)]

    def potential(self, state: str) -> np.ndarray:
        """A (n,) [Wb/m] at the nodes of the quadratic elements in one of ``STATES``."""
        return self.data.a.values[STATES.index(state)]


@dataclass(frozen=True, eq=False)
class SolvedFields:
    """The turning reference machine, and the fields of both; matched is None where nothing was matched."""

    rotation: Rotation
    reference: NullFields
    matched: NullFields | None


@dataclass(frozen=True)
class NullStates:
    """A machine whose fields in the null position are wanted."""

    case: FieldCase
    machine: DrawnMachine


def fields_stage(
    case: FieldCase, stated: StatedMachine, matched: MatchedMachine | None, workers: Workers
) -> SolvedFields:
    """Rotation the reference machine, and solve the fields of both in the null position."""
    machines = {"reference": stated.machine} | ({"matched": matched.machine} if matched is not None else {})
    rotation = solve_rotation("rotation", case, stated.machine, workers)
    states = {f"{name}, null position": NullStates(case, machine) for name, machine in machines.items()}
    solved = workers.map("fields", solve_null_states, states)
    reference, *others = (_fields_of(wanted, solved[name]) for name, wanted in states.items())
    return SolvedFields(rotation, reference, others[0] if others else None)


def null_points(case: FieldCase, machine: DrawnMachine) -> tuple[OperatingPoint, ...]:
    """The operating points of ``STATES``."""
    amplitudes = (0.0, case.nominal_density, case.overload_density)
    return tuple(null_point(machine, case.layout(machine), amplitude, case.packing) for amplitude in amplitudes)


@dataclass(frozen=True, eq=False)
class NullSolutions:
    """What a worker finds of ``NullFields``, whose data is made where the tables are.

    torque_error: [Nm/m]; rest: [rad]; residuals: relative, dimensionless
    node, triangle, region, a: the variables of the data [m], indices (3, E), indices (E,), and [Wb/m]
    """

    torque_error: float
    sectors: int
    antiperiodic: bool
    rest: float
    region_names: tuple[str, ...]
    residuals: tuple[tuple[float, ...], ...]
    node: np.ndarray
    triangle: np.ndarray
    region: np.ndarray
    a: np.ndarray


def solve_null_states(wanted: NullStates) -> NullSolutions:
    """The fields of a machine in the null position on the finer mesh, and the mesh error on that of the sweep."""
    case, machine = wanted.case, wanted.machine
    points, model = null_points(case, machine), case.detailed_model(machine)
    solutions = [model.solve(point) for point in points]
    section = model.section
    return NullSolutions(
        torque_error=torque_errors([case.model(machine).solve(points[STATES.index("nominal")])])[0],
        sectors=section.sectors,
        antiperiodic=section.antiperiodic,
        rest=float(model.unknowns.turn(points[0].angle).rest),
        region_names=tuple(section.mesh.subdomains),
        residuals=tuple(solution.newton.residuals for solution in solutions),
        node=section.mesh.p,
        triangle=section.mesh.t.astype(np.int32),
        region=_regions(section),
        a=np.stack([solution.a for solution in solutions]),
    )


def _regions(section: CrossSection) -> np.ndarray:
    """Number of the region of every triangle (E,)."""
    region = np.empty(section.mesh.nelements, dtype=np.int32)
    for number, elements in enumerate(section.mesh.subdomains.values()):
        region[elements] = number
    return region


def _fields_of(wanted: NullStates, solved: NullSolutions) -> NullFields:
    return NullFields(
        machine=wanted.machine,
        torque_error=solved.torque_error,
        sectors=solved.sectors,
        antiperiodic=solved.antiperiodic,
        rest=solved.rest,
        region_names=solved.region_names,
        points=null_points(wanted.case, wanted.machine),
        residuals=solved.residuals,
        data=xr.Dataset(
            {
                "node": (("xy", "corner_node"), solved.node),
                "triangle": (("corner", "element"), solved.triangle),
                "region": ("element", solved.region),
                "a": (("state", "dof"), solved.a),
            }
        ),
    )
