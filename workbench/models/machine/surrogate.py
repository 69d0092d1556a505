"""A machine bench that answers in a millisecond: samples expanded in everything that may be different in the machine.

    S(p) = S_0 + sum of the terms of ``terms.py`` at the coordinates p of ``coordinates.py``

Without current S are Fourier coefficients over the revolution; with current S belongs to one state, and what its
currents add is expanded in its rotor angle and currents as well. S_0 is of a fine mesh, the rest of coarser ones. About
another design, with S_0 from field solutions there, the rest is the difference of the expansion between the two.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from effects.machine_design import MachineAsBuilt
from geometry.winding import WindingLayout, star_of_slots
from units import DEGREE
from workbench.errors import WorkbenchError
from workbench.models.machine.coordinates import Coordinate, all_coordinates
from workbench.models.machine.field import LoadedState
from workbench.models.machine.pieces import ANGLE_STEPS
from workbench.models.machine.spectra import averaged, evaluated
from workbench.models.machine.terms import Changes, Terms, loaded_terms_of, terms_of

_REMEMBERED = 16  # designs
_FARTHEST_ANGLE = 3 * DEGREE  # from a solved state that its expansion is used for
_FARTHEST_CURRENT = 0.12  # relative
_POWERS = np.arange(1, len(ANGLE_STEPS) + 1)
_POLYNOMIALS = np.linalg.inv(np.power.outer(ANGLE_STEPS, _POWERS))  # through changes at ANGLE_STEPS and through zero


@dataclass(frozen=True, eq=False)
class LoadedSamples:
    """Samples of loaded states and how they change; s states, c coils.

    states: angles and currents (s, 4);  base: on the fine mesh, coarse: on that of the changes (s, 1 + c)
    angle: change at ``ANGLE_STEPS`` of what the currents add to the machine without (4, s, 1 + c)
    scale: first and second derivative by a common factor of the currents (2, s, 1 + c)
    coils: per ampere-turn in every coil (s, c, 1 + c)
    turn: of the rotor beyond the states that the changes belong to [rad]
    """

    states: np.ndarray
    base: np.ndarray
    coarse: np.ndarray
    angle: np.ndarray
    scale: np.ndarray
    coils: np.ndarray
    turn: float = 0.0

    def turned(self, turn: float, base: np.ndarray) -> LoadedSamples:
        """The same of a rotor turned beyond the states [rad], with the samples there."""
        states = self.states + np.array([turn, 0.0, 0.0, 0.0])
        return replace(self, states=states, base=base, turn=turn)

    @property
    def list(self) -> tuple[LoadedState, ...]:
        """The states as the field takes them."""
        return tuple(LoadedState(angle, (a, b, c)) for angle, a, b, c in self.states.tolist())


@dataclass(frozen=True, eq=False)
class Surrogate:
    """nominal: the machine as drawn
    no_load, coarse: Fourier coefficients on the fine mesh and on that of the changes (1 + coils, orders)
    idle, loaded: changes without and with current, of coarser meshes; idle of Fourier coefficients
    states: the loaded states, None where a campaign has none
    origin: the design that the base values belong to, None for the nominal one
    """

    nominal: MachineAsBuilt
    no_load: np.ndarray
    coarse: np.ndarray
    idle: Terms
    loaded: Terms | None
    states: LoadedSamples | None
    origin: MachineAsBuilt | None = None

    def about(
        self, design: MachineAsBuilt, turn: float, idle: np.ndarray, loaded: np.ndarray | None = None
    ) -> Surrogate:
        """That of the drawing made one about another design, from its samples on the meshes of the changes:
        coefficients without current (1 + coils, orders), and with current, the rotor turned beyond the states [rad]
        (states, 1 + coils)."""
        no_load, states = self.no_load.copy(), self.states
        no_load[:, : idle.shape[1]] += idle - self.coarse
        if states is not None:
            angles, finer = states.states[:, 0], self.no_load - _cut(self.coarse, self.no_load.shape[1])
            beyond = evaluated(finer, angles + turn) - evaluated(finer, angles)
            states = states.turned(turn, states.base + loaded - states.coarse + beyond.T)
        return replace(self, origin=design, no_load=no_load, states=states)

    @cached_property
    def on_coarse_mesh(self) -> Surrogate:
        """The drawing on the meshes of the changes; orders that those cannot resolve as on the fine one."""
        no_load = self.no_load.copy()
        no_load[:, : self.coarse.shape[1]] = self.coarse
        states = None if self.states is None else replace(self.states, base=self.states.coarse)
        return replace(self, no_load=no_load, states=states)

    def in_orders(self, weights: np.ndarray) -> Surrogate:
        """The drawing without current alone, every order over the revolution times a complex number (orders,)."""
        return replace(self, no_load=self.no_load * weights, idle=self.idle.none())

    @cached_property
    def remembered(self) -> dict:
        """What was worked out of it, by what was asked; for whoever asks the same of every fit."""
        return {}

    @cached_property
    def layout(self) -> WindingLayout:
        return star_of_slots(self.nominal.machine.slots, self.nominal.machine.pole_pairs)

    @cached_property
    def coordinates(self) -> tuple[Coordinate, ...]:
        return all_coordinates(self.nominal)

    def position(self, design: MachineAsBuilt) -> np.ndarray:
        """Coordinates of a design, from the drawing on."""
        return self._positions(design)

    @cached_property
    def _positions(self) -> Callable[[MachineAsBuilt], np.ndarray]:
        """Asked without and with current in turn."""
        read = lambda design: np.array([c.read(design) for c in self.coordinates]) - self._drawn  # noqa: E731
        return lru_cache(maxsize=_REMEMBERED)(read)

    @cached_property
    def _drawn(self) -> np.ndarray:
        return np.array([c.read(self.nominal) for c in self.coordinates])

    @property
    def _centre(self) -> MachineAsBuilt:
        return self.origin or self.nominal

    def _projection(self, turns: tuple[float, ...]) -> np.ndarray:
        """From a sample to torque and the flux linkages of the phases per metre (4, 1 + coils)."""
        return self._projections(turns)

    @cached_property
    def _projections(self) -> Callable[[tuple[float, ...]], np.ndarray]:
        return lru_cache(maxsize=_REMEMBERED)(lambda turns: _projection(self.layout, turns))

    # ---- without current -----------------------------------------------------------------------------------------

    def spectrum(self, design: MachineAsBuilt) -> np.ndarray:
        """Fourier coefficients over the revolution of torque and phase flux linkages per metre (4, orders), kept."""
        return self._spectra(design)

    @cached_property
    def _spectra(self) -> Callable[[MachineAsBuilt], np.ndarray]:
        """Tables ask for one design in turn, at the same temperatures of its magnets; what all share is read only."""

        def found(design: MachineAsBuilt) -> np.ndarray:
            spectrum = self._projection(design.turns) @ self.no_load
            spectrum = spectrum + _cut(self._idle_added(design), self.no_load.shape[1])
            spectrum.flags.writeable = False
            return spectrum

        return lru_cache(maxsize=_REMEMBERED)(found)

    @cached_property
    def _idle_added(self) -> Callable[[MachineAsBuilt], np.ndarray]:
        return self._from_origin(self.idle)

    @cached_property
    def _loaded_added(self) -> Callable[[MachineAsBuilt], np.ndarray]:
        return self._from_origin(self.loaded)

    def _from_origin(self, coils: Terms) -> Callable[[MachineAsBuilt], np.ndarray]:
        """What is added for a design to torque and phases at the origin; tables ask for one design in turn. Phases of
        coils as drawn are added up once for all designs, others for each: what a shifted rotor does to single coils is
        nothing in their sum, and shows where one of them lacks turns."""
        phases = coils.projected(self._projection(self.nominal.turns))
        of_phases, of_coils = self._beyond_origin(phases), self._beyond_origin(coils)

        def added(design: MachineAsBuilt) -> np.ndarray:
            if design.turns == self.nominal.turns:
                return of_phases(design)
            return self._projection(design.turns) @ of_coils(design)

        return lru_cache(maxsize=_REMEMBERED)(added)

    def _beyond_origin(self, terms: Terms) -> Callable[[MachineAsBuilt], np.ndarray]:
        """What terms add for a design, less what they add at the origin."""
        at_origin = terms(self.position(self._centre))
        return lambda design: terms(self.position(design)) - at_origin

    # ---- with current --------------------------------------------------------------------------------------------

    def with_current(self, design: MachineAsBuilt, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """Torque and phase flux linkages per metre (n, 4) at angles [rad] (n,) and phase currents [A] (n, 3).

        Raises WorkbenchError where no solved state is near.
        """
        at = np.asarray(angle, dtype=float).tobytes(), np.asarray(currents, dtype=float).tobytes()
        sample = self._as_at_origin(*at, design.skew, design.turns)
        added = self._loaded_added(design)
        return sample @ self._projection(design.turns).T + added[:, self._places(*at)].T

    @cached_property
    def _as_at_origin(self) -> Callable[[bytes, bytes, float, tuple[float, ...]], np.ndarray]:
        """Samples (n, 1 + coils) with the field as at the origin, for angles, currents, a skew and turns: many designs
        ask for the same in turn."""
        return lru_cache(maxsize=_REMEMBERED)(self._sampled)

    def _sampled(self, angle_bytes: bytes, current_bytes: bytes, skew: float, turns: tuple[float, ...]) -> np.ndarray:
        angle, currents = np.frombuffer(angle_bytes), np.frombuffer(current_bytes).reshape(-1, 3)
        states, which = self.states, self._places(angle_bytes, current_bytes)
        apart = _wrapped(angle - states.states[which, 0])
        centre = states.states[which, 1:]
        power = (centre**2).sum(1)
        scale = np.where(power > 0, (currents * centre).sum(1) / np.where(power > 0, power, 1.0) - 1.0, 0.0)
        sample = states.base[which]
        sample = sample + states.scale[0][which] * scale[:, None] + states.scale[1][which] * scale[:, None] ** 2 / 2
        turned = turned_by(apart + states.turn, skew) - turned_by(np.full(1, states.turn), 0.0)
        sample = sample + np.einsum("nk,knq->nq", turned, states.angle[:, which])
        without = evaluated(averaged(self.no_load, skew), angle)
        sample = sample + without.T - self._without_current[which]
        solved = self._ampere_turns(self._centre.turns, centre * (1 + scale)[:, None])
        rest = self._ampere_turns(turns, currents) - solved
        return sample + np.einsum("nc,ncq->nq", rest, states.coils[which])

    @cached_property
    def _without_current(self) -> np.ndarray:
        """Samples at the angles of the loaded states without current (s, 1 + coils)."""
        return evaluated(self.no_load, self.states.states[:, 0]).T

    def _ampere_turns(self, turns: tuple[float, ...], currents: np.ndarray) -> np.ndarray:
        """Of every coil (n, coils) for phase currents (n, 3)."""
        return currents @ self._projection(turns)[1:, 1:]

    def beyond_states(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """How far angles lie beyond the states that they are answered from (n,) [rad]."""
        return _wrapped(angle - self.states.states[self._nearest(angle, currents), 0])

    @cached_property
    def _places(self) -> Callable[[bytes, bytes], np.ndarray]:
        """Of the nearest states, of angles and currents given as the bytes of their arrays."""

        def found(angle: bytes, currents: bytes) -> np.ndarray:
            return self._nearest(np.frombuffer(angle), np.frombuffer(currents).reshape(-1, 3))

        return lru_cache(maxsize=_REMEMBERED)(found)

    def _nearest(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        if self.states is None:
            raise WorkbenchError("no loaded state has been solved: prepare the machine with a table that has currents")
        known = self.states.states
        size = np.abs(known[:, 1:]).max(1) + 1e-9
        apart = np.abs(_wrapped(angle[:, None] - known[:, 0])) / _FARTHEST_ANGLE
        off = np.abs(currents[:, None] - known[:, 1:]).max(2)
        off = off / np.where(size > 1e-6, _FARTHEST_CURRENT * size, 1e-3)
        distance = np.maximum(apart, off)
        found = distance.argmin(1)
        if distance.min(1).max(initial=0.0) > 1.0:
            raise WorkbenchError("a row lies far from every solved state: prepare the machine with the table it is in")
        return found


def _projection(layout: WindingLayout, turns: tuple[float, ...]) -> np.ndarray:
    matrix = np.zeros((4, 1 + len(turns)))
    matrix[0, 0] = 1.0
    for k, coil in enumerate(layout.coils):
        matrix[1 + coil.phase, 1 + k] = coil.sign * turns[k]
    return matrix


def _wrapped(angle: np.ndarray) -> np.ndarray:
    return np.mod(angle + np.pi, 2 * np.pi) - np.pi


def surrogate_of(
    nominal: MachineAsBuilt, found: Mapping[str, Mapping[str, np.ndarray]], states: tuple[LoadedState, ...]
) -> Surrogate:
    """From the results of all pieces of ``pieces.py`` by their names."""
    drawn, changes = found["no load"], _changes(found, "no load ")
    idle = terms_of(nominal, drawn["base"], changes)
    if not states:
        return Surrogate(nominal, drawn["fine"], drawn["base"], idle, None, None)
    with_current = _states_last(_changes(found, "loaded "))
    there = _at_angles(np.array([state.angle for state in states]), drawn["base"].shape[1])
    slopes = Changes({name: there(row) for name, row in changes.slopes.items()}, {})
    loaded = loaded_terms_of(nominal, found["loaded"]["base"].T, with_current, idle.each(there), slopes)
    return Surrogate(nominal, drawn["fine"], drawn["base"], idle, loaded, _samples(found, states))


def _changes(found: Mapping, prefix: str) -> Changes:
    """Slopes and nodes of the pieces with a prefix."""
    pieces = {name.removeprefix(prefix): arrays for name, arrays in found.items() if name.startswith(prefix)}
    all_rows = {name: rows for arrays in pieces.values() for name, rows in arrays.items()}
    slopes = {name.removeprefix("slope "): rows for name, rows in all_rows.items() if name.startswith("slope ")}
    return Changes(slopes, {name: arrays for name, arrays in pieces.items() if "change" in arrays})


def _states_last(changes: Changes) -> Changes:
    """As without current: states where orders are, and an axis of members, of which a regular node has one."""
    slopes = {name: rows.T for name, rows in changes.slopes.items()}
    nodes = {name: {key: rows.T[None] for key, rows in node.items()} for name, node in changes.nodes.items()}
    return Changes(slopes, nodes)


def _samples(found: Mapping, states: tuple[LoadedState, ...]) -> LoadedSamples:
    here, coils = found["loaded"], found["loaded coils"]
    places = np.array([(state.angle, *state.currents) for state in states])
    per_coil = np.stack([coils[f"slope coil[{k}]"] for k in range(len(coils))], axis=1)
    angle = here["angle"].swapaxes(0, 1) - _turned(found["no load"]["base"], places[:, 0])
    scale = here["scale"].swapaxes(0, 1)
    return LoadedSamples(places, found["loaded fine"]["fine"], here["base"], angle, scale, per_coil)


def _turned(no_load: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Change at ``ANGLE_STEPS`` without current (4, n, rows)."""
    return np.stack([(evaluated(no_load, angles + step) - evaluated(no_load, angles)).T for step in ANGLE_STEPS])


def turned_by(x: np.ndarray, skew: float) -> np.ndarray:
    """Weights (n, 4) of the changes at ``ANGLE_STEPS`` in that at angles x [rad] (n,): of the polynomial through them
    and through zero; over a skew [rad] the mean of its parabola."""
    return np.power.outer(x, _POWERS) @ _POLYNOMIALS + _POLYNOMIALS[1] * skew**2 / 12


def _at_angles(angles: np.ndarray, orders: int) -> Callable[[np.ndarray], np.ndarray]:
    """From coefficients (rows, orders) to values at angles (rows, n)."""
    turning = np.exp(1j * np.outer(np.arange(orders), angles))
    return lambda spectrum: (spectrum @ turning).real


def _cut(rows: np.ndarray, length: int) -> np.ndarray:
    """Columns up to a length, missing ones zero."""
    out = np.zeros((len(rows), length), dtype=rows.dtype)
    out[:, : min(length, rows.shape[1])] = rows[:, :length]
    return out
