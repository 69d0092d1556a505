"""The field solutions of a surrogate in pieces that can be solved anywhere, in any order, and kept one by one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from effects.machine_design import MachineAsBuilt
from geometry.half_cell import MeshDensity
from magnetostatics.topology import MOST_PATTERNS
from materials.library import load_steel
from materials.reluctivity import Reluctivity
from units import DEGREE
from workbench.models.machine.coordinates import BOTH, smooth_coordinates
from workbench.models.machine.expansion import (
    BATCH,
    NO_LOAD_FAMILIES,
    Node,
    coil_slopes,
    irregular_nodes,
    loaded_node,
    loaded_slopes,
    no_load_node,
    no_load_slopes,
    regular_nodes,
)
from workbench.models.machine.field import LoadedState, MachineField, read
from workbench.models.machine.spectra import coefficients

ANGLE_STEPS = 0.75 * DEGREE * np.array([-2, -1, 1, 2])  # from a loaded state, to follow what its currents add
_SCALE_STEP = 0.04  # of its currents
_FEW_PATTERNS = 4  # of the finer meshes: a piece goes round some thirty angles, at three megabytes each
_ONE_PATTERN = 1  # of the finest, which goes round once: eight megabytes each of a whole machine

Arrays = dict[str, np.ndarray]
States = tuple[LoadedState, ...]
Kind = tuple[bool, bool]  # with current, of the whole machine


@dataclass(frozen=True)
class MeshPlan:
    """idle_base, loaded_base: of the values themselves, without and with current
    idle, loaded: of what is added to them

    With the defaults the bases hold cogging to 0.4 mNm (of 49 mNm of 12 slots and 10 poles, and of 5 mNm of 9 slots and
    8 poles, in which larger torques of single teeth cancel; against 2,880 edges and NGSolve's 1,440 of third order),
    torque and flux linkage to 3e-4 of their largest values (against four times as many elements).
    """

    idle_base: MeshDensity = MeshDensity(gap_edges=1080, gap_layers=3, across_iron=3.0)
    loaded_base: MeshDensity = MeshDensity(gap_edges=720, gap_layers=3, across_iron=3.0)
    idle: MeshDensity = MeshDensity(gap_edges=480)
    loaded: MeshDensity = MeshDensity(gap_edges=240)


DEFAULT_PLAN = MeshPlan()


@dataclass(frozen=True)
class Machinery:
    """What all pieces of one machine share; steel: from the grade's name to its law, at the top level of a module."""

    nominal: MachineAsBuilt
    plan: MeshPlan = DEFAULT_PLAN
    steel: Callable[[str], Reluctivity] = load_steel


class Fields:
    """The field problems of a machine on its four meshes."""

    def __init__(self, machinery: Machinery):
        self.nominal, plan = machinery.nominal, machinery.plan
        self.idle_base = self._field(machinery, plan.idle_base, _ONE_PATTERN)
        self.loaded_base = self._field(machinery, plan.loaded_base, _FEW_PATTERNS)
        self.idle = self._field(machinery, plan.idle, _FEW_PATTERNS)
        self.loaded = self._field(machinery, plan.loaded, MOST_PATTERNS)

    @property
    def all(self) -> tuple[MachineField, ...]:
        return self.idle_base, self.loaded_base, self.idle, self.loaded

    @staticmethod
    def _field(machinery: Machinery, mesh: MeshDensity, patterns: int) -> MachineField:
        return MachineField(machinery.nominal, mesh, machinery.steel, patterns)

    def only(self, field: MachineField) -> MachineField:
        """One of them, the memory of the others given back: the pieces of one mesh are solved after each other."""
        for other in self.all:
            if other is not field:
                other.forget()
        return field


class Piece:
    """Some of the field solutions; ``name`` tells it from all others of the machine."""

    name: str

    def solve(self, fields: Fields, states: States) -> Arrays:
        """Its results by name; of a piece without current the states do not matter."""
        raise NotImplementedError

    @property
    def with_current(self) -> bool:
        """Whether all its results have one row for every state."""
        return True

    @property
    def is_whole(self) -> bool:
        """Whether the whole machine is solved rather than a sector of it."""
        return False

    @property
    def kind(self) -> Kind | None:
        """Pieces of one kind share meshes; None of another design, which may be asked for with current and without in
        turn."""
        return self.with_current, self.is_whole


class NoLoadPiece(Piece):
    """A piece without current; its results are Fourier coefficients over the revolution."""

    @property
    def with_current(self) -> bool:
        return False


@dataclass(frozen=True)
class NoLoadValues(NoLoadPiece):
    """The drawing on the fine mesh, and on that of the changes (1 + coils, orders)."""

    name: str = "no load"

    def solve(self, fields: Fields, states: States) -> Arrays:
        base = coefficients(fields.idle.no_load(fields.nominal))
        fine = coefficients(fields.only(fields.idle_base).no_load(fields.nominal))
        fields.idle_base.forget()
        return {"fine": fine, "base": base}


@dataclass(frozen=True)
class NoLoadSlopes(NoLoadPiece):
    """Derivatives at the drawing by the coordinates that break some symmetries."""

    family: tuple[str, ...]

    @property
    def name(self) -> str:
        return f"no load slopes {self.family[-1]}"

    @property
    def is_whole(self) -> bool:
        return True

    def solve(self, fields: Fields, states: States) -> Arrays:
        slopes = no_load_slopes(fields.only(fields.idle), self.family)
        return {f"slope {name}": coefficients(rows) for name, rows in slopes.items()}


@dataclass(frozen=True)
class NoLoadNode(NoLoadPiece):
    """Change and slopes at a node (members, 1 + coils, orders)."""

    node: Node

    @property
    def name(self) -> str:
        return f"no load {self.node.name}"

    @property
    def is_whole(self) -> bool:
        return self.node.moves[0][0].breaks != BOTH

    def solve(self, fields: Fields, states: States) -> Arrays:
        found = no_load_node(fields.only(fields.idle), self.node)
        return {name: np.array([coefficients(one) for one in rows]) for name, rows in found.items()}


@dataclass(frozen=True)
class NoLoadAt(NoLoadPiece):
    """Another design on the mesh of the changes; name: of the design."""

    design: MachineAsBuilt
    name: str

    @property
    def kind(self) -> None:
        return None

    def solve(self, fields: Fields, states: States) -> Arrays:
        return {"base": coefficients(fields.idle.no_load(self.design))}


@dataclass(frozen=True)
class LoadedFine(Piece):
    """Loaded states of the drawing on the fine mesh."""

    name: str = "loaded fine"

    def solve(self, fields: Fields, states: States) -> Arrays:
        fine = fields.only(fields.loaded_base).loaded(fields.nominal, states)
        fields.loaded_base.forget()
        return {"fine": fine}


@dataclass(frozen=True)
class LoadedBeside(Piece):
    """The drawing on the mesh of the changes, at loaded states and at angles and currents beside them."""

    name: str = "loaded"

    def solve(self, fields: Fields, states: States) -> Arrays:
        field = fields.only(fields.loaded)
        alike = field.alike(fields.nominal, states)
        solved = alike.of(states)
        here = field.loaded(fields.nominal, solved)
        turned = [self._at(field, solved, [s.turned(step) for s in solved]) - here for step in ANGLE_STEPS]
        sides = ([_scaled(s, sign * _SCALE_STEP) for s in solved] for sign in (1, -1))
        up, down = (self._at(field, solved, side) for side in sides)
        scale = [(up - down) / (2 * _SCALE_STEP), (up - 2 * here + down) / _SCALE_STEP**2]
        angle = alike.rows(np.stack(turned, axis=1))
        angle[alike.are_mirrored] = angle[alike.are_mirrored, ::-1]  # as many steps ahead as behind
        return {"base": alike.rows(here), "angle": angle, "scale": alike.rows(np.stack(scale, axis=1))}

    def _at(self, field: MachineField, states: States, beside: Sequence[LoadedState]) -> np.ndarray:
        """Samples at states beside others, each started from there."""
        model, starts = field.model(field.nominal, whole=False), field.nominal_solutions(states, whole=False)
        points = [field.point(field.nominal, state, whole=False) for state in beside]
        return np.array([read(model.solve(point, start)) for point, start in zip(points, starts)])


@dataclass(frozen=True)
class LoadedSlopes(Piece):
    """Derivatives at the drawing by a batch of the coordinates."""

    batch: int

    @property
    def name(self) -> str:
        return f"loaded slopes {self.batch}"

    @property
    def is_whole(self) -> bool:
        return True

    def solve(self, fields: Fields, states: States) -> Arrays:
        own = smooth_coordinates(fields.nominal)[self.batch * BATCH : (self.batch + 1) * BATCH]
        return {f"slope {name}": rows for name, rows in loaded_slopes(fields.only(fields.loaded), states, own).items()}


@dataclass(frozen=True)
class LoadedCoils(Piece):
    """Derivatives by the ampere-turns of every coil."""

    name: str = "loaded coils"

    @property
    def is_whole(self) -> bool:
        return True

    def solve(self, fields: Fields, states: States) -> Arrays:
        return {f"slope {name}": rows for name, rows in coil_slopes(fields.only(fields.loaded), states).items()}


@dataclass(frozen=True)
class LoadedNode(Piece):
    """Change and slopes at a node."""

    node: Node

    @property
    def name(self) -> str:
        return f"loaded {self.node.name}"

    def solve(self, fields: Fields, states: States) -> Arrays:
        return loaded_node(fields.only(fields.loaded), states, self.node)


@dataclass(frozen=True)
class LoadedAt(Piece):
    """Another design on the mesh of the changes. turn: of its rotor beyond the states [rad];  name: of both"""

    design: MachineAsBuilt
    turn: float
    name: str

    @property
    def kind(self) -> None:
        return None

    def solve(self, fields: Fields, states: States) -> Arrays:
        return {"base": fields.loaded.loaded(self.design, states, self.turn)}


def no_load_pieces(nominal: MachineAsBuilt) -> tuple[Piece, ...]:
    """All that a surrogate needs without current, the long ones first."""
    nodes = [NoLoadNode(node) for node in (*irregular_nodes(nominal), *regular_nodes(nominal))]
    return (*nodes, *(NoLoadSlopes(family) for family in NO_LOAD_FAMILIES), NoLoadValues())


def loaded_pieces(nominal: MachineAsBuilt) -> tuple[Piece, ...]:
    """All that a surrogate needs with current, the long ones first."""
    batches = -(-len(smooth_coordinates(nominal)) // BATCH)
    slopes = [LoadedSlopes(batch) for batch in range(batches)]
    return (LoadedFine(), *slopes, LoadedCoils(), LoadedBeside(), *(LoadedNode(n) for n in regular_nodes(nominal)))


@dataclass(frozen=True)
class Task:
    """A piece as it travels to another process."""

    machinery: Machinery
    piece: Piece
    states: States


def _scaled(state: LoadedState, change: float) -> LoadedState:
    a, b, c = (current * (1 + change) for current in state.currents)
    return LoadedState(state.angle, (a, b, c))
