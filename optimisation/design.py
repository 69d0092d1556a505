"""One design of the cross-section, judged: torque per metre and the flux densities that a saturation limit looks at."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from math import inf, nan
from operator import attrgetter

import numpy as np

from geometry.checks import check_machine
from geometry.errors import GeometryError
from geometry.machine import Machine, dimensions_of
from geometry.morph import Morpher
from magnetostatics.case import FamilyCase
from magnetostatics.model import FieldModel, FieldSolution, OperatingPoint, blended
from magnetostatics.newton import NewtonSettings
from magnetostatics.positions import aligned_teeth
from magnetostatics.probes import ProbeReader, probe_reader
from magnetostatics.sensitivity import Variation, sensitivities
from magnetostatics.torque import arkkio_torque, maxwell_torque
from magnetostatics.variations import Dimension
from optimisation.starts import weights_at_origin
from optimisation.states import SaturationReading
from optimisation.torque import MeanTorque, TorqueObjective, TorqueOfReading, is_null_state


@dataclass(frozen=True)
class Judge:
    """Solves a machine and reads what the optimisation needs.

    reading: of the saturation limit; amplitude: of the current density in the copper [A/m^2]
    objective: the torque that designs are compared by; settings: of Newton's method
    """

    case: FamilyCase
    reading: SaturationReading
    amplitude: float
    objective: TorqueObjective = MeanTorque()
    settings: NewtonSettings = NewtonSettings()

    def at_amplitude(self, amplitude: float) -> Judge:
        """The same judge with another current density amplitude [A/m^2]."""
        return replace(self, amplitude=amplitude)

    def states(self, machine: Machine) -> list[OperatingPoint]:
        """The states in which the flux densities of a machine are read."""
        return self.reading.states(machine, self.case.layout(machine), self.amplitude, self.case.packing)

    @property
    def torque(self) -> TorqueObjective:
        """The objective, without further states where those of the reading cover the period."""
        return TorqueOfReading() if self.objective.is_mean and self.reading.covers_period else self.objective

    def judge(self, machine: Machine) -> Design:
        """Mesh and solve a machine.

        Raises GeometryError when it cannot be built, FieldSolutionError when the field does not converge.
        """
        return DesignSolver(self).design(machine)


@dataclass(frozen=True, eq=False)
class _Solved:
    """A machine with its fields: those that the reading looks at, and those that only the torque needs."""

    machine: Machine
    states: list[FieldSolution]
    further: list[FieldSolution]

    @classmethod
    def blended(cls, some: Sequence[_Solved], weights: np.ndarray) -> _Solved:
        """The sum of fields times their weights, dimensionless (k,)."""
        parts = [zip(*fields) for fields in ([one.states for one in some], [one.further for one in some])]
        return cls(some[0].machine, *([blended(state, weights) for state in part] for part in parts))

    @property
    def iterations(self) -> int:
        """Newton iterations with the elements of the model."""
        order = self.states[0].model.order
        return sum(s.newton.iterations for s in (*self.states, *self.further) if s.model.order is order)


# A mesh is moved onto machines whose dimensions differ by up to this share, beyond it a new one is made. Within these
# the torque on the moved mesh agrees with that on a new one to 0.2 %, and to 0.05 % at a third of them.
_FARTHEST = {"back_iron_width": 0.4, "rotor_outer_radius": 0.1, "stator_outer_radius": 0.1}


_SOURCES = 8  # most similar designs whose fields a start is made of
_TINY = 1e-9  # step along the slopes of the flux densities, per unit of a change


class DesignSolver:
    """Solves designs one after another. A design close to the last mesh moves that mesh and starts from the fields of
    the most similar design on it."""

    def __init__(self, judge: Judge) -> None:
        self.judge = judge
        self._morpher: Morpher | None = None
        self._solved: list[_Solved] = []  # designs on the mesh of the morpher
        self._probes: ProbeReader | None = None  # of the last of them

    def design(self, machine: Machine) -> Design:
        """The judged machine. Raises as ``Judge.judge``."""
        check_machine(machine)
        return self._judged(machine, self._moved(machine) or self._meshed(machine))

    def designs(self, machines: Sequence[Machine]) -> list[Design | None]:
        """Many judged machines in the order given, on as few meshes as reach them all; None where none can be built.

        Each mesh is that of the machine with the most others in its reach, and these are solved from it outwards.
        """
        left, apart = list(range(len(machines))), _distances(machines, machines)
        found: dict[int, Design | None] = dict.fromkeys(left)
        while left:
            base = left[_most_central(apart[np.ix_(left, left)])]
            with suppress(GeometryError):
                order = sorted(left, key=lambda number: float(apart[number, base]))
                found |= self._around(machines[base], {number: machines[number] for number in order})
            left = [number for number in left if machines[number] != machines[base] and found[number] is None]
        return list(found.values())

    def _around(self, base: Machine, machines: dict[int, Machine]) -> dict[int, Design]:
        """Those of the machines that the mesh of one of them can be moved onto."""
        check_machine(base)
        found, model = {}, self._meshed(base)
        for number, machine in machines.items():
            moved = model if machine == base else self._moved(machine)
            if moved is not None:
                found[number] = self._judged(machine, moved)
        return found

    def _judged(self, machine: Machine, model: FieldModel) -> Design:
        starts = self._starts(machine)
        states: list[FieldSolution] = []
        for number, point in enumerate(self.judge.states(machine)):
            start = starts.states[number] if starts else (states[-1] if states else None)
            states.append(model.solve(point, start=start))
        further = self.judge.torque.further(states, starts.further if starts else ())
        self._solved.append(_Solved(machine, states, further))
        self._probes = probe_reader(model, self._probes)
        return self._summary(self._solved[-1], self._probes)

    def _summary(self, solved: _Solved, probes: ProbeReader) -> Design:
        seen = np.array([_flux_densities(state, probes) for state in solved.states])
        aligned, tooth, back_iron = (_worst(column) for column in seen.T)
        section, torque = solved.states[0].model.section, self.judge.torque
        return Design(
            solved.machine,
            torque=torque.torque(solved.states, solved.further),
            torque_null=_null_torque(solved.states),
            torque_ring=_ring_torque(torque, solved),
            tooth_aligned=aligned,
            tooth_worst=tooth,
            back_iron_worst=back_iron,
            limited=self.judge.reading.limited(aligned, tooth, back_iron),
            coil_side_area=section.half_slot_area * section.half_slots_per_coil_side,
            newton_iterations=solved.iterations,
        )

    @property
    def last_machine(self) -> Machine | None:
        """Whose derivatives can be asked for; None before the first design on a mesh."""
        return self._solved[-1].machine if self._solved else None

    def gradient(self, machine_of: Callable[[np.ndarray], Machine], steps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of torque [Nm/m] and limited flux density [T] of the last design per change, each (k,).

        machine_of: changes [any units], (k,) -> machine, zero for the last design
        steps: small size of each change [as the change], (k,)
        """
        if self._morpher is None or self._probes is None:
            raise ValueError("no design has been judged yet, so there is none to take derivatives of")
        variations: dict[str, Variation] = {
            str(number): Dimension(self._morpher, partial(_one_change, machine_of, number, len(steps)), step)
            for number, step in enumerate(steps)
        }
        solved, torque = self._solved[-1], self.judge.torque
        read = partial(_state_results, torque, self._probes)
        states = _values_and_slopes(solved.states, variations, read)
        further = _values_and_slopes(solved.further, variations, lambda solution: np.array([torque.read(solution)]))
        return _torque_slope(torque, states, further), self._limited_slope(states)

    def _limited_slope(self, states: _ValuesAndSlopes) -> np.ndarray:
        """Derivative of the limited flux density (k,) along every change."""
        values, slopes = states.values[:, 1:], states.slopes[:, :, 1:]
        worst = [int(np.nanargmax(column)) if np.isfinite(column).any() else 0 for column in values.T]
        here = np.array([values[state, kind] for kind, state in enumerate(worst)])
        along = np.stack([slopes[state, :, kind] for kind, state in enumerate(worst)], axis=1)  # (k, 3)
        return np.array([_directional(lambda x: self.judge.reading.limited(*x), here, slope) for slope in along])

    def mesh_anew(self) -> None:
        """Forget the mesh: the next design gets its own."""
        self._morpher, self._solved, self._probes = None, [], None

    def _starts(self, machine: Machine) -> _Solved | None:
        """Fields to start from, by those of the most similar designs on this mesh."""
        if not self._solved:
            return None
        places = _places([known.machine for known in self._solved], machine)
        nearest = np.argsort(np.abs(places).max(axis=1), kind="stable")[:_SOURCES]
        weights = weights_at_origin(places[nearest])
        used = np.flatnonzero(weights)
        return _Solved.blended([self._solved[number] for number in nearest[used]], weights[used])

    def _meshed(self, machine: Machine) -> FieldModel:
        self.mesh_anew()
        model = self.judge.case.model(machine, self.judge.settings)
        self._morpher = Morpher(model.section)
        return model

    def _moved(self, machine: Machine) -> FieldModel | None:
        if self._morpher is None:
            return None
        if _distances([machine], [dimensions_of(self._morpher.section.machine)]).item() > 1:
            return None
        try:
            section = self._morpher.to(machine)
        except GeometryError:  # the machine is sound, its distance from the mesh is not
            return None
        return self._solved[0].states[0].model.like(section)


def _one_change(machine_of: Callable[[np.ndarray], Machine], number: int, count: int, change: float) -> Machine:
    changes = np.zeros(count)
    changes[number] = change
    return machine_of(changes)


@dataclass(frozen=True, eq=False)
class _ValuesAndSlopes:
    """Results of some states (states, results) and their derivatives along k changes (states, k, results)."""

    values: np.ndarray
    slopes: np.ndarray


def _values_and_slopes(
    solutions: list[FieldSolution], variations: dict[str, Variation], read: Callable[[FieldSolution], np.ndarray]
) -> _ValuesAndSlopes:
    values = np.array([read(solution) for solution in solutions])
    found = [sensitivities(solution, variations, read, here) for solution, here in zip(solutions, values)]
    slopes = [[state[name] for name in variations] for state in found]
    return _ValuesAndSlopes(values, np.array(slopes))


def _state_results(torque: TorqueObjective, reader: ProbeReader, solution: FieldSolution) -> np.ndarray:
    """(torque, aligned teeth, worst tooth, worst back iron) of one state, probes moved with the mesh."""
    return np.array([torque.read(solution), *_flux_densities(solution, reader.moved(solution.model))])


def _torque_slope(torque: TorqueObjective, states: _ValuesAndSlopes, further: _ValuesAndSlopes) -> np.ndarray:
    """Derivative of the torque (k,) along every change."""
    known, count = states.values[:, 0], len(states.values)
    others = further.values[:, 0] if len(further.values) else np.empty(0)
    slopes = [*states.slopes[:, :, 0], *(further.slopes[:, :, 0] if len(others) else ())]  # of each state (k,)

    def combined(x: np.ndarray) -> float:
        return torque.combined(x[:count], x[count:])

    return np.array([_directional(combined, np.concatenate([known, others]), slope) for slope in np.transpose(slopes)])


def _directional(function: Callable[[np.ndarray], float], here: np.ndarray, slope: np.ndarray) -> float:
    """Derivative of a function along a direction, by a central difference of the formula."""
    return (function(here + _TINY * slope) - function(here - _TINY * slope)) / (2 * _TINY)


def _distances(machines: Sequence[Machine], bases: Sequence[Machine]) -> np.ndarray:
    """Largest relative difference of a dimension of every machine from every base, (n, m).

    As a share of what a mesh may be moved, dimensionless; infinite between other numbers of slots or poles.
    """
    sizes, of_bases = (_numbers(some, *_FARTHEST) for some in (machines, bases))
    kinds, of_base_kinds = (_numbers(some, "slots", "poles") for some in (machines, bases))
    apart = np.abs(sizes[:, None] / of_bases - 1) / np.array(list(_FARTHEST.values()))
    return np.where((kinds[:, None] == of_base_kinds).all(axis=2), apart.max(axis=2), inf)


def _places(machines: Sequence[Machine], origin: Machine) -> np.ndarray:
    """Relative differences of the dimensions of machines from those of another one, dimensionless (n, 3).

    As shares of what a mesh may be moved.
    """
    differences = _numbers(machines, *_FARTHEST) / _numbers([origin], *_FARTHEST) - 1
    return differences / np.array(list(_FARTHEST.values()))


def _numbers(machines: Sequence[Machine], *names: str) -> np.ndarray:
    """Named values of machines, (machines, names)."""
    return np.array(list(map(attrgetter(*names), machines)), dtype=float).reshape(-1, len(names))


def _most_central(apart: np.ndarray) -> int:
    """Index of the machine with the most others in the reach of its mesh; of equals the one closest to them.

    apart: distances of every machine from every base, dimensionless (n, n)
    """
    is_near = apart <= 1
    return int(np.lexsort((np.where(is_near, apart, 0.0).sum(axis=0), -is_near.sum(axis=0)))[0])


@dataclass(frozen=True)
class Design:
    """What the optimisation knows of one design.

    torque: what designs are compared by, the mean over one electrical period with the current on the q axis unless the
        judge's objective is another one. By the consistent fluxes on the mid-gap circle, or by flux linkages, which
        agree to 0.1 %: on the meshes of a sweep both are within 0.13 % of a mesh of three times as many edges, the ring
        average within 0.4 % (40 designs of 9 and 12 slots)
    torque_null: in the thesis's null state, by the consistent fluxes; NaN where the reading does not look at it
    torque_ring: as ``torque`` by the ring average (``arkkio_torque``); NaN where the torque is by flux linkages
    torque, torque_null, torque_ring: [Nm/m]
    tooth_aligned, tooth_worst, back_iron_worst, limited: flux densities [T], worst of the reading's states
    """

    machine: Machine
    torque: float
    torque_null: float
    torque_ring: float
    tooth_aligned: float
    tooth_worst: float
    back_iron_worst: float
    limited: float
    coil_side_area: float  # m^2
    newton_iterations: int


def _flux_densities(solution: FieldSolution, probes: ProbeReader) -> tuple[float, float, float]:
    """Worst of the aligned teeth (NaN where there is none), of all teeth and of the back iron in one state [T]."""
    section, flux = solution.model.section, probes.read(solution)
    teeth = {k % section.teeth for k in aligned_teeth(section.machine, solution.point.angle)}
    return (
        max((flux[f"tooth_{k}"] for k in teeth), default=nan),
        max(value for name, value in flux.items() if name.startswith("tooth")),
        max(value for name, value in flux.items() if name.startswith("back_iron")),
    )


def _worst(values: np.ndarray) -> float:
    """The largest of those that are known."""
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else nan


def _null_torque(states: list[FieldSolution]) -> float:
    layout = states[0].model.section.layout
    return next((maxwell_torque(state) for state in states if is_null_state(state, layout)), nan)


def _ring_torque(torque: TorqueObjective, solved: _Solved) -> float:
    """The objective by the ring average, where it is a mean of torques and not of flux linkages."""
    if torque.given(solved.states):
        return nan
    states, further = (np.array([arkkio_torque(s) for s in some]) for some in (solved.states, solved.further))
    return torque.combined(states, further)
