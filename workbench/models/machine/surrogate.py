"""A machine bench that answers in a millisecond: samples expanded in everything that may be different in the machine.

    S(p) = S_0 + sum_j J_j p_j + sum_j C_j p_j^2 / 2 + mixed terms of the two components of an eccentricity

and a cubic term for the arc of touching magnets, a tenth less of which turns cogging round. The coordinates p are those
of ``machine_coordinates``. Without current S are Fourier coefficients over the revolution; with current S belongs to
one state, and is expanded in its rotor angle and currents as well. S_0 is of a fine mesh, the rest of coarser ones.
About another design, with S_0 from field solutions there, the rest is the difference of the expansion between the two.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from effects.machine_design import MachineAsBuilt
from geometry.winding import WindingLayout, star_of_slots
from units import DEGREE
from workbench.errors import WorkbenchError
from workbench.models.machine.coordinates import ARC, LESS_ARC, SHIFTS, Coordinate, smooth_coordinates
from workbench.models.machine.expansion import Changes, arc_name, mixed_name

_TABLE = 4096  # angles of a revolution that are interpolated between by cubics; 68 to a period of order 60
_REMEMBERED = 16  # designs
_FARTHEST_ANGLE = 3 * DEGREE  # from a solved state that its expansion is used for
_FARTHEST_CURRENT = 0.12  # relative


@dataclass(frozen=True, eq=False)
class LoadedSamples:
    """Samples of loaded states and how they change; s states, c coils.

    states: angles and currents (s, 4);  base (s, 1 + c)
    angle, scale: first and second derivative by rotor angle [rad] and by a common factor of the currents (2, s, 1 + c)
    coils: per ampere-turn in every coil (s, c, 1 + c)
    """

    states: np.ndarray
    base: np.ndarray
    angle: np.ndarray
    scale: np.ndarray
    coils: np.ndarray


@dataclass(frozen=True, eq=False)
class Surrogate:
    """nominal: the machine as drawn;  no_load: Fourier coefficients of the fine base (1 + coils, orders)

    idle, loaded: changes without and with current, of coarser meshes; idle as Fourier coefficients (1 + coils, orders)
    states: the loaded states, None where a campaign has none
    origin: the design that the base values belong to, None for the nominal one
    """

    nominal: MachineAsBuilt
    no_load: np.ndarray
    idle: Changes
    loaded: Changes | None
    states: LoadedSamples | None
    origin: MachineAsBuilt | None = None

    @cached_property
    def layout(self) -> WindingLayout:
        return star_of_slots(self.nominal.machine.slots, self.nominal.machine.pole_pairs)

    @cached_property
    def coordinates(self) -> tuple[Coordinate, ...]:
        arc = (ARC,) if self.nominal.machine.magnet_arc_fraction >= 1 else ()
        return smooth_coordinates(self.nominal) + arc

    @cached_property
    def _idle_terms(self) -> Terms:
        return _terms(self.coordinates, self.idle, self._projection(self.nominal.turns), self.no_load.shape[1])

    @cached_property
    def _loaded_terms(self) -> Terms:
        swapped = Changes(*(_swap(part) for part in (self.loaded.base, self.loaded.linear, self.loaded.secant)))
        return _terms(self.coordinates, swapped, self._projection(self.nominal.turns), len(self.states.base))

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
        """Fourier coefficients over the revolution of torque and phase flux linkages per metre (4, orders)."""
        base = self._projection(design.turns) @ self.no_load
        return base + self._idle_added(design)

    @cached_property
    def _idle_added(self) -> Callable[[MachineAsBuilt], np.ndarray]:
        return self._from_origin(self._idle_terms)

    @cached_property
    def _loaded_added(self) -> Callable[[MachineAsBuilt], np.ndarray]:
        return self._from_origin(self._loaded_terms)

    def _from_origin(self, terms: Terms) -> Callable[[MachineAsBuilt], np.ndarray]:
        """What is added for a design to the values at the origin; tables ask for one design in turn."""
        at_origin = self._added(terms, self._centre)
        return lru_cache(maxsize=_REMEMBERED)(lambda design: self._added(terms, design) - at_origin)

    def _added(self, terms: Terms, design: MachineAsBuilt) -> np.ndarray:
        p = self.position(design)
        moved = np.flatnonzero(p)
        value = sum(np.tensordot(p[moved] ** k, form[moved], 1) for k, form in enumerate(terms.powers, 1))
        for (x, y), form in zip(self._shift_places, terms.mixed):
            if p[x] and p[y]:
                value = value + p[x] * p[y] * form
        return value

    @cached_property
    def _shift_places(self) -> list[tuple[int, int]]:
        names = [c.name for c in self.coordinates]
        return [(names.index(x.name), names.index(y.name)) for x, y in SHIFTS]

    # ---- with current --------------------------------------------------------------------------------------------

    def with_current(self, design: MachineAsBuilt, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """Torque and phase flux linkages per metre (n, 4) at angles [rad] (n,) and phase currents [A] (n, 3).

        Raises WorkbenchError where no solved state is near.
        """
        states, which = self.states, self._nearest(angle, currents)
        apart = _wrapped(angle - states.states[which, 0])
        centre = states.states[which, 1:]
        power = (centre**2).sum(1)
        scale = np.where(power > 0, (currents * centre).sum(1) / np.where(power > 0, power, 1.0) - 1.0, 0.0)
        sample = states.base[which]
        for derivatives, x in ((states.angle, apart), (states.scale, scale)):
            sample = sample + derivatives[0][which] * x[:, None] + derivatives[1][which] * x[:, None] ** 2 / 2
        sample = sample + states.angle[1][which] * design.skew**2 / 24  # mean of a parabola over the skew
        solved = self._ampere_turns(self._centre.turns, centre * (1 + scale)[:, None])
        rest = self._ampere_turns(design.turns, currents) - solved
        sample = sample + np.einsum("nc,ncq->nq", rest, states.coils[which])
        added = self._loaded_added(design)
        return sample @ self._projection(design.turns).T + added[:, which].T

    def _ampere_turns(self, turns: tuple[float, ...], currents: np.ndarray) -> np.ndarray:
        """Of every coil (n, coils) for phase currents (n, 3)."""
        return currents @ self._projection(turns)[1:, 1:]

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


def _swap(part):
    """States last, as the orders of a spectrum are."""
    if isinstance(part, Mapping):
        return {name: rows.T for name, rows in part.items()}
    return part.T


@dataclass(frozen=True, eq=False)
class Terms:
    """powers: coefficients of the first, second and third power of every coordinate (3, j, 4, n)

    mixed: second derivatives by the two components of both shifts (2, 4, n)
    """

    powers: np.ndarray
    mixed: np.ndarray


def _terms(coordinates: Sequence[Coordinate], changes: Changes, projection: np.ndarray, length: int) -> Terms:
    powers = [[_cut(projection @ form, length) for form in _of_coordinate(c, changes)] for c in coordinates]
    mixed = [_cut(projection @ _mixed(x, y, changes), length) for x, y in SHIFTS]
    return Terms(np.array(powers).swapaxes(0, 1), np.array(mixed))


def _of_coordinate(c: Coordinate, changes: Changes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Coefficients of the first three powers."""
    if c.name not in changes.linear:  # less arc of touching magnets: a cubic through three secants
        inverse = np.linalg.inv(np.array(LESS_ARC)[:, None] ** np.arange(1, 4))
        first, second, third = np.tensordot(inverse, [changes.secant[arc_name(change)] for change in LESS_ARC], 1)
        return first, second, third
    first = changes.linear[c.name]
    none = np.zeros_like(first)
    if c.name not in changes.secant:
        return first, none, none
    return first, (changes.secant[c.name] - first * c.size) / c.size**2, none


def _mixed(x: Coordinate, y: Coordinate, changes: Changes) -> np.ndarray:
    """d2/dxdy from the secant between the two directions."""
    if mixed_name(x) not in changes.secant:
        return np.zeros_like(changes.linear[x.name])
    (first_x, square_x, _), (first_y, square_y, _) = _of_coordinate(x, changes), _of_coordinate(y, changes)
    h = x.size / np.sqrt(2)
    return (changes.secant[mixed_name(x)] - h * (first_x + first_y)) / h**2 - square_x - square_y


def _cut(rows: np.ndarray, length: int) -> np.ndarray:
    """Columns up to a length, missing ones zero."""
    out = np.zeros((len(rows), length), dtype=rows.dtype)
    out[:, : min(length, rows.shape[1])] = rows[:, :length]
    return out


# ---- functions over the revolution ----------------------------------------------------------------------------------


def coefficients(samples: np.ndarray, most: int) -> np.ndarray:
    """Coefficients (columns, orders) of samples over a revolution (n, columns): f = Re sum c_m exp(i m angle)."""
    found = np.fft.rfft(samples, axis=0).T * 2 / len(samples)
    found[:, 0] /= 2
    return found[:, : min(most, (len(samples) - 1) // 2) + 1]


def evaluated(spectrum: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Values (rows, n) at angles [rad] (n,) of functions over the revolution, by cubics between _TABLE angles."""
    full = spectrum * (_TABLE / 2)
    full[:, 0] *= 2
    table = np.fft.irfft(full, _TABLE, axis=1)
    place = np.mod(angle, 2 * np.pi) * _TABLE / (2 * np.pi)
    first = np.floor(place).astype(int)
    t = place - first
    weights = (-t * (t - 1) * (t - 2) / 6, (t * t - 1) * (t - 2) / 2, -t * (t + 1) * (t - 2) / 2, t * (t * t - 1) / 6)
    return sum(w * table[:, (first + k) % _TABLE] for k, w in zip((-1, 0, 1, 2), weights))


def slope(spectrum: np.ndarray) -> np.ndarray:
    """Coefficients of the derivative by angle."""
    return spectrum * (1j * np.arange(spectrum.shape[1]))


def averaged(spectrum: np.ndarray, width: float) -> np.ndarray:
    """Coefficients of the mean over a window of angles, as a skew by ``width`` [rad] takes it: sinc(m width / 2)."""
    return spectrum * np.sinc(np.arange(spectrum.shape[1]) * width / (2 * np.pi))
