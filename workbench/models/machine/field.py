"""Field solutions of a machine as built, coil by coil: torque and flux linkages at any angle and current.

A sample is [torque, psi of coil 0, psi of coil 1, ...], per metre of length and per turn, the flux of a coil positive
outwards through its tooth. Without current a revolution is put together from the smallest window of angles, and with
current all states from few of them, as the symmetries of the machine allow (``symmetry.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import lcm, pi

import numpy as np

from effects.machine_design import MachineAsBuilt
from geometry.cross_section import CrossSection, mesh_cross_section
from geometry.defects import DynamicEccentricity, MagnetPosition, SlotOpening, StaticEccentricity
from geometry.half_cell import MeshDensity
from geometry.machine import Machine
from geometry.magnetisation import Magnetisation, TurnedToRadial
from geometry.morph import Defect, Morpher
from geometry.winding import WindingLayout, star_of_slots
from magnetostatics.currents import CoilCurrents, PhaseCurrents
from magnetostatics.cut_edge import CutEdge
from magnetostatics.elements import QUADRATIC
from magnetostatics.model import FieldModel, FieldSolution, MachineMaterials, OperatingState, blended
from magnetostatics.newton import NewtonSettings
from magnetostatics.topology import MOST_PATTERNS, Topology
from magnetostatics.torque import maxwell_torque
from materials.altered_steel import ScaledSaturation, hardened, stacked
from materials.library import load_steel
from materials.reluctivity import Reluctivity
from workbench.models.machine.symmetry import Alike, alike, complete, is_symmetric, symmetries_of, window_of

_TIGHT = NewtonSettings(tolerance=1e-8)  # differences of solutions are wanted


@dataclass(frozen=True)
class LoadedState:
    """Rotor angle [rad] and constant phase currents A, B, C [A]."""

    angle: float
    currents: tuple[float, float, float]

    def turned(self, turn: float) -> LoadedState:
        """The same currents with the rotor turned on [rad]."""
        return LoadedState(self.angle + turn, self.currents)


class MachineField:
    """One machine at one mesh density; designs with the same poles, slots and kind of magnet share the mesh.

    steel: from the grade's name to its law;  patterns: that a mesh keeps, see ``Topology``
    """

    def __init__(
        self,
        nominal: MachineAsBuilt,
        density: MeshDensity,
        steel: Callable[[str], Reluctivity] = load_steel,
        patterns: int = MOST_PATTERNS,
    ):
        self.nominal, self.density, self.steel, self.patterns = nominal, density, steel, patterns
        self._meshes: dict[tuple, tuple[CrossSection, Morpher, FieldModel]] = {}  # the nominal ones and the last other
        self._starts: dict[tuple, list[FieldSolution]] = {}  # of the nominal machine at the states asked last
        self._drawn: np.ndarray | None = None  # samples of the nominal machine without current

    @property
    def layout(self) -> WindingLayout:
        return star_of_slots(self.nominal.machine.slots, self.nominal.machine.pole_pairs)

    @property
    def edges(self) -> int:
        """Edges around the sliding circle."""
        return self.density.edges_around(self.nominal.machine)

    @property
    def window(self) -> int:
        """Edges in the period of cogging, 2 pi / lcm(slots, poles)."""
        m = self.nominal.machine
        return self.edges // lcm(m.slots, m.poles)

    # ---- models -------------------------------------------------------------------------------------------------

    def model(self, design: MachineAsBuilt, whole: bool) -> FieldModel:
        """The field problem of a design, on moved nodes of the nominal mesh where that can be."""
        section, morpher, first = self._mesh(design.machine, whole)
        machine = replace(design.cross_section, magnetisation=_magnetisation(design))
        moved = morpher.to(machine, defects_of(design)) if machine != section.machine or whole else section
        return first.like(moved, materials_of(design, self.steel(design.steel)))

    def _mesh(self, machine: Machine, whole: bool) -> tuple[CrossSection, Morpher, FieldModel]:
        base = self.nominal.machine
        drawn = base if self._shares_mesh(machine) else replace(base, magnet_arc_fraction=machine.magnet_arc_fraction)
        key = drawn, whole
        if key not in self._meshes:
            self._meshes = {known: mesh for known, mesh in self._meshes.items() if known[0] in (base, drawn)}
            section = mesh_cross_section(drawn, self.layout, self.density, whole)
            materials = materials_of(self.nominal, self.steel(self.nominal.steel))
            topology = Topology(section, QUADRATIC, self.patterns)
            first = FieldModel(section, _all_alike(materials), _TIGHT, topology=topology)
            self._meshes[key] = section, Morpher(section), first
        return self._meshes[key]

    def _shares_mesh(self, machine: Machine) -> bool:
        """Magnets touch in both machines or in none."""
        return (machine.magnet_arc_fraction < 1) == (self.nominal.machine.magnet_arc_fraction < 1)

    def forget(self) -> None:
        """Give the memory of all meshes and factorisations back, and the samples that are kept."""
        self.forget_meshes()
        self._drawn = None

    def forget_meshes(self) -> None:
        """Give the memory of all meshes and factorisations back."""
        self._meshes.clear()
        self._starts.clear()

    # ---- samples ------------------------------------------------------------------------------------------------

    def no_load(self, design: MachineAsBuilt) -> np.ndarray:
        """Samples without current at equal angles over a revolution from angle zero on (edges, 1 + coils); those of
        the nominal machine, which every node asks for, are kept."""
        if design != self.nominal:
            return self._no_load(design)
        if self._drawn is None:
            self._drawn = self._no_load(design)
        return self._drawn

    def _no_load(self, design: MachineAsBuilt) -> np.ndarray:
        return self.over_revolution(design, [read(s) for s in self.no_load_window(design)])

    def no_load_window(self, design: MachineAsBuilt) -> list[FieldSolution]:
        """Solutions without current over the angles that the symmetry of the design leaves."""
        model = self.model(design, not is_symmetric(design))
        return solve_idle(model, window_of(design, self.edges), self.edges)

    def over_revolution(self, design: MachineAsBuilt, window: Sequence[np.ndarray]) -> np.ndarray:
        """Samples of a revolution (edges, 1 + coils) from those of the window, or their derivatives by something that
        leaves the symmetry of the design."""
        steps = window_of(design, self.edges)
        known = {(n % self.edges, 0): row for n, row in zip(steps, window, strict=True)}
        moves = [(symmetry, 0) for symmetry in symmetries_of(design, self.edges)]
        known = complete(known, self.edges, 1, moves)
        return np.array([known[n, 0] for n in range(self.edges)])

    def loaded(self, design: MachineAsBuilt, states: Sequence[LoadedState], turn: float = 0.0) -> np.ndarray:
        """Samples with current (states, 1 + coils), the rotor turned beyond the states [rad]; of states that are one
        but for the symmetries of the design the first is solved."""
        alike = self.alike(design, states, turn)
        solutions = self.loaded_solutions(design, alike.of(states), turn)
        return alike.rows(np.array([read(solution) for solution in solutions]))

    def alike(self, design: MachineAsBuilt, states: Sequence[LoadedState], turn: float = 0.0) -> Alike:
        """Which of some states have to be solved, the rotor turned beyond them [rad]."""
        angles = np.array([state.angle + turn for state in states])
        coils = [coil_ampere_turns(design, self.layout, np.array(state.currents)) for state in states]
        return alike(angles, np.array(coils), symmetries_of(design, self.edges), self.edges)

    def loaded_solutions(
        self, design: MachineAsBuilt, states: Sequence[LoadedState], turn: float = 0.0
    ) -> list[FieldSolution]:
        """Solutions with current, the rotor turned beyond the states [rad], each from that of the nominal machine at
        the state, which saves a third of the work.

        Where magnets, slots and coils are alike a sector is solved.
        """
        whole = not (is_symmetric(design) and len(set(design.turns)) == 1)
        if design == self.nominal and not turn:
            return self.nominal_solutions(tuple(states), whole)
        model, points = self.model(design, whole), [self.point(design, s.turned(turn), whole) for s in states]
        if not self._shares_mesh(design.machine):
            return solve_in_turn(model, points)
        starts = self.nominal_solutions(tuple(states), whole)
        return [model.solve(point, start) for point, start in zip(points, starts)]

    def nominal_solutions(self, states: tuple[LoadedState, ...], whole: bool) -> list[FieldSolution]:
        """Solutions of the nominal machine at loaded states, kept."""
        if (states, whole) not in self._starts:
            points = [self.point(self.nominal, state, whole) for state in states]
            self._starts[states, whole] = solve_in_turn(self.model(self.nominal, whole), points)
        return self._starts[states, whole]

    def point(self, design: MachineAsBuilt, state: LoadedState, whole: bool) -> OperatingState:
        """A loaded state as the field model takes it."""
        if not whole:
            return PhaseCurrents(state.angle, state.currents, design.turns[0])
        return CoilCurrents(state.angle, tuple(coil_ampere_turns(design, self.layout, np.array(state.currents))))


def solve_in_turn(model: FieldModel, points: Sequence[OperatingState]) -> list[FieldSolution]:
    """Solutions of neighbouring states, each started from the one before."""
    solutions: list[FieldSolution] = []
    for point in points:
        solutions.append(model.solve(point, solutions[-1] if solutions else None))
    return solutions


def solve_idle(model: FieldModel, steps: range, edges: int) -> list[FieldSolution]:
    """Solutions without current at some steps in a row, ``edges`` to a revolution, each started from the line through
    the two before it."""
    solutions: list[FieldSolution] = []
    for n in steps:
        solutions.append(model.solve(idle(2 * pi * n / edges), _continued(solutions)))
    return solutions


def _continued(solutions: Sequence[FieldSolution]) -> FieldSolution | None:
    """What comes after solutions at equal steps, on a line through the last two; the only one; or nothing."""
    if len(solutions) > 1:
        return blended(solutions[-2:], np.array([-1.0, 2.0]))
    return solutions[0] if solutions else None


def coil_ampere_turns(design: MachineAsBuilt, layout: WindingLayout, currents: np.ndarray) -> np.ndarray:
    """sign * turns * phase current of every coil (coils,) [A]."""
    return np.array([coil.sign * design.turns[k] * currents[coil.phase] for k, coil in enumerate(layout.coils)])


def idle(angle: float) -> PhaseCurrents:
    """No current at a rotor angle [rad]."""
    return PhaseCurrents(angle, (0.0, 0.0, 0.0))


def read(solution: FieldSolution) -> np.ndarray:
    """The sample of a solution (1 + coils,), of a symmetric machine from its sector, where a coil is with its tooth.

    The torque is that of the consistent fluxes: of an eccentric machine of 12 slots and 10 poles the orders that it
    alone makes, 3 and 3.5 mNm, are those of another code within 0.08 on 720 edges and 0.13 on 480, where the ring
    average is off by 0.5 and 0.6. Between two nodes of the sliding circle it scatters by 0.04 mNm on 480 edges.
    """
    section = solution.model.section
    first = (solution.model.coil_loads @ solution.a)[: section.teeth]
    sectors = [section.sign**k * first for k in range(section.sectors)]
    return np.concatenate([[maxwell_torque(solution)], *sectors])


# ---- what a design means in the field --------------------------------------------------------------------------------


def defects_of(design: MachineAsBuilt) -> tuple[Defect, ...]:
    """What moves nodes of the whole machine; nothing for a regular one."""
    found: list[Defect] = [MagnetPosition(k, turn) for k, turn in enumerate(design.magnet_turns) if turn]
    found += [SlotOpening(k, change) for k, change in enumerate(design.opening_changes) if change]
    for kind, shift in ((StaticEccentricity, design.stator_shift), (DynamicEccentricity, design.rotor_shift)):
        if any(shift):
            found.append(kind(float(np.hypot(*shift)), float(np.arctan2(shift[1], shift[0]))))
    return tuple(found)


def materials_of(design: MachineAsBuilt, grade: Reluctivity) -> MachineMaterials:
    """Steel and magnets of a design."""
    law = grade.rising(max(design.rise_beyond_table, 0.0))  # no steel is flatter than vacuum
    if design.field_scale != 1.0:
        law = hardened(law, design.field_scale)
    if design.saturation_scale != 1.0:
        law = ScaledSaturation(law, design.saturation_scale)
    law = stacked(law, design.stacking_factor)
    stator = CutEdge(law, design.edge_depth, design.edge_damage) if design.edge_damage else law
    materials = MachineMaterials(stator, law, design.magnet)
    for number, strength in enumerate(design.magnet_strengths):
        if strength != 1.0:
            weaker = replace(design.magnet, remanence=design.magnet.remanence * strength)
            materials = materials.with_magnet(number, weaker)
    return materials


def _all_alike(materials: MachineMaterials) -> MachineMaterials:
    return replace(materials, other_magnets=())


def _magnetisation(design: MachineAsBuilt) -> Magnetisation:
    drawn, share = design.machine.magnetisation, design.radial_share
    return TurnedToRadial(drawn, share) if share else drawn
