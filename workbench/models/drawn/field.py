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
        """Steps after which a sample is the same at the same currents: two poles, or one where there is no magnet and
        all poles are alike."""
        m = self.nominal.drawing.machine
        return self.steps // (m.pole_pairs if m.rotor.magnets_per_pitch else m.repeats)

    @property
    def idle_period(self) -> int:
        """Steps after which the torque without current is the same."""
        m = self.nominal.drawing.machine
        return self.steps // lcm(m.slots, m.repeats)

    # ---- samples ------------------------------------------------------------------------------------------------

    def at(self, design: DrawnAsBuilt, states: Sequence[State]) -> np.ndarray:
        """Samples of a design (states, 4)."""
        known = self._of(design)
        missing = [state for state in dict.fromkeys(states) if state not in known]
        if missing:
            self._solve(design, sorted(missing, key=lambda s: (s.ampere_turns, s.step)))
        return np.array([known[state] for state in states]).reshape(-1, 4)

    def _of(self, design: DrawnAsBuilt) -> dict[State, np.ndarray]:
        name = _name(design)
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
                self._kept.write(_name(design), {"samples": np.array([_row(*one) for one in known.items()])})
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


def in_field(design: DrawnAsBuilt) -> DrawnAsBuilt:
    """The design with what its field does not know left out, so that alike fields are found again."""
    magnet = replace(design.magnet, temperature_coefficient=0.0, reference_temperature=0.0)
    return DrawnAsBuilt(
        design.drawing,
        design.machine,
        turns=1.0,
        magnet=magnet,
        length=1.0,
        field_scale=design.field_scale,
        saturation_scale=design.saturation_scale,
        stacking_factor=design.stacking_factor,
    )


def _name(design: DrawnAsBuilt) -> str:
    d = in_field(design)
    words = repr((d.machine, d.magnet, d.field_scale, d.saturation_scale, d.stacking_factor))
    return hashlib.sha256(words.encode()).hexdigest()[:16]


def _read(solution: FieldSolution) -> np.ndarray:
    return np.append(arkkio_torque(solution), phase_flux_linkage(solution))


def _row(state: State, sample: np.ndarray) -> np.ndarray:
    return np.concatenate([[state.step], state.ampere_turns, sample])


def _state(row: np.ndarray) -> State:
    step, a, b, c = row[:4].tolist()
    return State(int(step), (a, b, c))
