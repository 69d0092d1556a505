"""Field solutions of a drawn machine: torque and flux linkages at states, solved when first asked and kept on disk.

A sample is [torque, psi_a, psi_b, psi_c] per metre of length, the flux linkages per turn of every coil. Rotor angles
are whole steps of a grid on the sliding circle, so that every position has triangles of the same shape there.
"""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import lcm, pi
from pathlib import Path

import numpy as np

from effects.drawn_design import DrawnAsBuilt
from geometry.cross_section import CrossSection, mesh_cross_section
from geometry.half_cell import MeshDensity
from geometry.morph import Morpher
from losses.iron import FrequencyTerms, iron_loss
from losses.loci import rotor_loci, solve_part, stator_loci
from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import FieldModel, FieldSolution, MachineMaterials, OperatingPoint
from magnetostatics.newton import NewtonSettings
from magnetostatics.torque import arkkio_torque
from materials.altered_steel import ScaledSaturation, hardened, stacked
from materials.iron_loss import IronLossLaw
from materials.reluctivity import Reluctivity
from workbench.models.kept import KeptArrays, key_of

_TIGHT = NewtonSettings(tolerance=1e-8)  # differences of solutions are wanted
_WRITTEN_EVERY = 50  # solutions
_LOSS_STEPS = 48  # of an electrical period, for iron loss

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Plan:
    """positions: least number of angles of an electrical period
    density: of the mesh, None for one half as fine as the drawing's own, which costs a few parts in a thousand
    """

    positions: int = 120
    density: MeshDensity | None = None


ROUGH = Plan(36, MeshDensity(gap_edges=240, gap_layers=1, across_iron=1.5))


@dataclass(frozen=True)
class State:
    """step: of the grid of rotor angles;  ampere_turns: of a coil of A, B, C [A]"""

    step: int
    ampere_turns: tuple[float, float, float]


@dataclass(frozen=True)
class Alike:
    """A state whose field is that of another one but for the names of the phases.

    sixths: of an electrical period that it is before the other;  sign: of its currents and flux linkages over those
    """

    state: State
    sixths: int
    sign: int

    def sample(self, solved: np.ndarray) -> np.ndarray:
        """Of the other state from that of this one (4,)."""
        return np.append(solved[:1], self.sign * np.roll(solved[1:], -self.sixths))


class FieldSamples:
    """Samples of one drawing and of designs that differ from it in dimensions and materials; cache: folder or None."""

    def __init__(self, nominal: DrawnAsBuilt, plan: Plan, cache: Path | None):
        self.nominal, self.plan = nominal, plan
        self._kept = KeptArrays(cache / f"drawn-{self._key}" if cache else None)
        self._known: dict[str, dict[State, np.ndarray]] = {}
        self._losses: dict[IronLossLaw, FrequencyTerms] = {}
        self.progress: Progress | None = None

    @property
    def _key(self) -> str:
        drawing = self.nominal.drawing
        what = (drawing.machine, drawing.layout, drawing.stator_steel, drawing.rotor_steel, self._density)
        return key_of(hashlib.sha256(pickle.dumps(what)).hexdigest(), [Path(__file__)])

    @property
    def _density(self) -> MeshDensity:
        own = self.nominal.drawing.density
        return self.plan.density or replace(own, gap_edges=own.gap_edges // 2, gap_layers=1, across_iron=1.5)

    # ---- the grid of angles -------------------------------------------------------------------------------------

    @cached_property
    def steps(self) -> int:
        """Of a revolution: edges of the sliding circle, several at once where that leaves enough positions."""
        m = self.nominal.drawing.machine
        edges = self._density.edges_around(m)
        apart = edges // lcm(m.slots, m.repeats)
        most = max(1, edges // (m.pole_pairs * self.plan.positions))
        return edges // max(d for d in range(1, apart + 1) if apart % d == 0 and d <= most)

    @property
    def step(self) -> float:
        """Between two angles of the grid [rad]."""
        return 2 * pi / self.steps

    @property
    def period(self) -> int:
        """Steps of two poles, after which a sample is the same at the same currents."""
        return self.steps // self.nominal.drawing.machine.pole_pairs

    @property
    def parts(self) -> int:
        """Into which an electrical period divides, of which each has all that the three phases see."""
        return 6 if self.nominal.drawing.machine.half_wave else 3

    def alike(self, state: State) -> Alike:
        """In the first part of an electrical period, to which a turn of the stator by some slots brings any state.

        A sixth later i_a, i_b, i_c are what -i_c, -i_a, -i_b were, and so are the linkages: B lags A by a third, and a
        pole further on all signs are turned. Without magnets a field has no sign but that of its currents.
        """
        part, step = divmod(state.step % self.period, self.period // self.parts)
        sixths = part * 6 // self.parts
        sign = (-1) ** sixths
        turned = sign * np.roll(state.ampere_turns, sixths)
        if not self.nominal.drawing.machine.rotor.magnets_per_pitch and turned.tolist() < (-turned).tolist():
            sign, turned = -sign, -turned
        a, b, c = turned.tolist()
        return Alike(State(step, (a, b, c)), sixths, sign)

    # ---- samples ------------------------------------------------------------------------------------------------

    def at(self, design: DrawnAsBuilt, states: Sequence[State]) -> np.ndarray:
        """Samples of a design (states, 4)."""
        known = self._of(design)
        missing = {state: self.alike(state) for state in states if state not in known}
        unsolved = {one.state for one in missing.values()} - known.keys()
        if unsolved:
            self._solve(design, sorted(unsolved, key=lambda s: (s.ampere_turns, s.step)))
        known.update({state: one.sample(known[one.state]) for state, one in missing.items()})
        return np.array([known[state] for state in states]).reshape(-1, 4)

    def _of(self, design: DrawnAsBuilt) -> dict[State, np.ndarray]:
        name = design.field_name
        if name not in self._known:
            rows = self._kept.read(name)
            found = {} if rows is None else {_state(row): row[4:] for row in rows["samples"]}
            self._known[name] = found
        return self._known[name]

    def _solve(self, design: DrawnAsBuilt, states: Sequence[State]) -> None:
        model, known, last = self.model(design), self._of(design), None
        for done, state in enumerate(states, 1):
            point = PhaseCurrents(state.step * self.step, state.ampere_turns)
            last = model.solve(point, last)
            known[state] = _read(last)
            if done % _WRITTEN_EVERY == 0 or done == len(states):
                self._kept.write(design.field_name, {"samples": np.array([_row(*one) for one in known.items()])})
            if self.progress is not None:
                self.progress(f"field solutions of this machine: {done} of {len(states)}, kept for the next time")

    def iron_loss(self, law: IronLossLaw) -> FrequencyTerms:
        """Of stator and rotor of the drawing at no load by a law [W/m over Hz], from the loci of every element."""
        if law not in self._losses:
            part = solve_part(self.model(self.nominal), OperatingPoint(0.0), _LOSS_STEPS)
            self._losses[law] = iron_loss(stator_loci(part), law).total + iron_loss(rotor_loci(part), law).total
        return self._losses[law]

    # ---- models -------------------------------------------------------------------------------------------------

    def model(self, design: DrawnAsBuilt) -> FieldModel:
        """The field problem of a design, on the moved mesh of the drawing."""
        section, first = self._drawn
        moved = section if design.machine == section.machine else self._morpher.to(design.machine)
        return first.like(moved, materials_of(design))

    @cached_property
    def _drawn(self) -> tuple[CrossSection, FieldModel]:
        drawing = self.nominal.drawing
        section = mesh_cross_section(drawing.machine, drawing.layout, self._density)
        return section, FieldModel(section, materials_of(self.nominal), _TIGHT)

    @cached_property
    def _morpher(self) -> Morpher:
        return Morpher(self._drawn[0])


def materials_of(design: DrawnAsBuilt) -> MachineMaterials:
    """Steel and magnets of a design."""
    drawing = design.drawing
    return MachineMaterials(
        _altered(drawing.stator_steel, design), _altered(drawing.rotor_steel, design), design.magnet
    )


def _altered(law: Reluctivity, design: DrawnAsBuilt) -> Reluctivity:
    if design.field_scale != 1.0:
        law = hardened(law, design.field_scale)
    if design.saturation_scale != 1.0:
        law = ScaledSaturation(law, design.saturation_scale)
    return stacked(law, design.stacking_factor)


def _read(solution: FieldSolution) -> np.ndarray:
    return np.append(arkkio_torque(solution), phase_flux_linkage(solution))


def _row(state: State, sample: np.ndarray) -> np.ndarray:
    return np.concatenate([[state.step], state.ampere_turns, sample])


def _state(row: np.ndarray) -> State:
    step, a, b, c = row[:4].tolist()
    return State(int(step), (a, b, c))
