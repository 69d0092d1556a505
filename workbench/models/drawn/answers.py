"""What the terminals and the torque cell of a drawn machine see, from its expanded field samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from math import pi

import numpy as np

from effects.base import Columns
from effects.drawn_design import DrawnAsBuilt
from losses.iron import FrequencyTerms
from magnetostatics.flux_linkage import park
from materials.conductor import COPPER
from workbench.errors import WorkbenchError
from workbench.models.drawn.expansion import Expansion
from workbench.models.drawn.field import State

_ORDERS = 36  # angles of an electrical period that a voltage is made of, where the grid has as many
_POINTS = 6  # of the grid of angles that a value between them is made of
_SAME = 1e-3  # relative, of currents that are those of an anchor
_NEAR = 0.3  # relative, of currents that are read off an anchor
_SCALES = (0.9, 1.0, 1.1)  # of an anchor, that what its size does is taken from
_SMALL = 1.0  # A, that inductances without saturation are read at
_APART = 4  # steps of the grid between angles at which changes of the drawing are taken: they are small and smooth


Triple = tuple[float, float, float]


class Anchors:
    """Ampere-turns that the field is solved at: those that were asked first, for all that are nearly in proportion."""

    def __init__(self) -> None:
        self._known: list[np.ndarray] = []

    def of(self, ampere_turns: np.ndarray) -> tuple[Triple, float]:
        """The anchor of some ampere-turns (3,) [A], and how many times it they are [1]."""
        for anchor in self._known:
            scale = float(ampere_turns @ anchor / (anchor @ anchor))
            beside = np.linalg.norm(ampere_turns - scale * anchor)
            if abs(scale - 1) < _NEAR and beside < _SAME * np.linalg.norm(anchor):
                return _triple(anchor), scale
        anchor = np.array([float(f"{value:.6g}") for value in ampere_turns])
        self._known.append(anchor)
        return _triple(anchor), 1.0


def _triple(values: np.ndarray) -> Triple:
    a, b, c = values.tolist()
    return a, b, c


@dataclass(frozen=True, eq=False)
class Answers:
    """Torque and flux linkages of one design at one temperature of its magnets."""

    expansion: Expansion
    anchors: Anchors
    design: DrawnAsBuilt

    @property
    def kept(self) -> float:
        """Share of the magnets' flux that goes through the winding."""
        return 1.0 - self.design.end_leakage

    # ---- at rotor angles and constant currents ------------------------------------------------------------------

    def torque(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """At angles [rad] (n,) and line currents [A] (n, 3) [Nm]."""
        return self._without_leakage(self._samples(angle, self._in_coils(currents))[:, 0], angle, currents)

    def _without_leakage(self, both: np.ndarray, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """Torque [Nm] (n,) from that per length of the plane field [Nm/m] (n,) at angles (n,) and line currents (n, 3).

        What leaks at the ends is missing from the magnets' linkages and so from i . d psi/d angle, and squared from
        cogging; what currents do to each other, the reluctance torque, stays.
        """
        whole, share = self.design.length * both, self.design.end_leakage
        if not share:
            return whole
        cogging = self.design.length * self._samples(angle, 0 * currents)[:, 0]
        of_magnets = (self.linkage_slopes(angle) * currents).sum(axis=1) / self.kept
        return whole - share * of_magnets - (1 - self.kept**2) * cogging

    def linkage_change(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """Flux linkages of the phases of the star against those without current [Wb] (n, 3); the end winding adds
        L_end i. Round a delta no current goes: it has died away at the constant currents of a line [A] (n, 3)."""
        change = self._coil_change(angle, self._in_coils(currents)) @ self.design.drawing.coil_currents
        return change + self.design.end_winding_inductance * currents

    def alternating_change(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """The same for line currents that alternate so fast that no resistance counts: what goes round a delta leaves
        no flux common to its three phases [Wb] (n, 3)."""
        coils = self._in_coils(currents)
        if self.design.drawing.is_delta:
            size = np.abs(coils).max(axis=1, keepdims=True)
            common = self._coil_change(angle, size * np.ones(3)).sum(axis=1, keepdims=True)
            coils = coils - size * self._coil_change(angle, coils).sum(axis=1, keepdims=True) / common
        change = self._coil_change(angle, coils) @ self.design.drawing.coil_currents
        return change + self.design.end_winding_inductance * currents

    def magnet_linkage(self, angle: np.ndarray) -> np.ndarray:
        """Flux linkages of the phases of the star without current [Wb] (n, 3)."""
        alone = self._samples(angle, np.zeros((len(angle), 3)))[:, 1:] @ self.design.drawing.coil_currents
        return self.design.turns * self.design.length * self.kept * alone

    def _in_coils(self, currents: np.ndarray) -> np.ndarray:
        """Of lines in those of the coils of the phases [A] (n, 3)."""
        return currents @ self.design.drawing.coil_currents.T

    def _coil_change(self, angle: np.ndarray, coil_currents: np.ndarray) -> np.ndarray:
        """Flux linkages of all coils of a phase in series against those without current [Wb] (n, 3)."""
        change = (self._samples(angle, coil_currents) - self._samples(angle, 0 * coil_currents))[:, 1:]
        return self.design.turns * self.design.length * change

    def _samples(self, angle: np.ndarray, coil_currents: np.ndarray) -> np.ndarray:
        """(n, 4): between angles of the grid by a polynomial, between sizes of the current by a parabola."""
        ampere_turns = self.design.turns * coil_currents
        kinds, group = np.unique(ampere_turns, axis=0, return_inverse=True)
        found = np.empty((len(angle), 4))
        for k, kind in enumerate(kinds):
            rows = np.flatnonzero(group.ravel() == k)
            found[rows] = self._at_currents(angle[rows], kind)
        return found

    def _at_currents(self, angle: np.ndarray, ampere_turns: np.ndarray) -> np.ndarray:
        anchor, scale = self.anchors.of(ampere_turns) if ampere_turns.any() else ((0.0, 0.0, 0.0), 1.0)
        at = partial(_state, anchor)
        exact = self._between(angle, at, 1, lambda states: self._in_size(states, scale))
        change = self._between(angle, at, _APART, lambda states: self.expansion.change(self.design, states))
        return exact + scale * change

    def _between(
        self, angle: np.ndarray, at: Callable[[int], State], apart: int, values: Callable[[list[State]], np.ndarray]
    ) -> np.ndarray:
        """Values (states, 4) at every ``apart``th angle of the grid made into those at angles (n, 4); at: the state of
        a step"""
        samples = self.expansion.samples
        places, weights = _around(angle / (apart * samples.step))
        steps, inverse = np.unique(apart * places % samples.period, return_inverse=True)
        found = values([at(int(step)) for step in steps])
        return np.einsum("nk,nkq->nq", weights, found[inverse.reshape(places.shape)])

    def _in_size(self, states: list[State], scale: float) -> np.ndarray:
        """Samples at the centre with ``scale`` times the currents of the states (states, 4)."""
        if abs(scale - 1) < 1e-12:
            return self.expansion.at_centre(states)
        weights = [
            np.prod([(scale - other) / (node - other) for other in _SCALES if other != node]) for node in _SCALES
        ]
        return sum(w * self.expansion.at_centre([_scaled(s, node) for s in states])
                   for w, node in zip(weights, _SCALES, strict=True))  # type: ignore[return-value]  # fmt: skip

    # ---- turning without current --------------------------------------------------------------------------------

    @cached_property
    def waves(self) -> np.ndarray:
        """Complex amplitudes of the flux linkage of phase A of the star over the electrical angle [Wb] (orders,)."""
        lag = np.exp(-2j * pi / 3 * np.outer(np.arange(3), np.arange(len(self.coil_waves))))
        return self.coil_waves * (self.design.drawing.coil_currents[:, 0] @ lag)

    @cached_property
    def coil_waves(self) -> np.ndarray:
        """The same of all coils of A in series [Wb] (orders,).

        A sixth of a period of all phases makes a whole one of A: B and C lag by a third each, half a period turns the
        sign; a third where north and south poles are not alike.
        """
        samples = self.expansion.samples
        period, parts = samples.period, samples.parts
        strides = (d for d in range(2, period // parts + 1) if period % (parts * d) == 0 and period // d >= _ORDERS)
        stride = max(strides, default=1)
        states = [State(k * stride, (0.0, 0.0, 0.0)) for k in range(period // stride // parts)]
        part = (self.expansion.at_centre(states) + self.expansion.change(self.design, states))[:, 1:]
        whole = _unfolded(part, parts)
        found = 2 * np.fft.rfft(whole) / len(whole)
        found[0] /= 2
        return self.design.turns * self.design.length * self.kept * found

    def linkage_slopes(self, angle: np.ndarray) -> np.ndarray:
        """d psi/d angle of the phases at rotor angles [rad] (n,): [Wb] (n, 3)."""
        pairs, orders = self.design.machine.pole_pairs, np.arange(len(self.waves))
        lag = pairs * angle[:, None] - 2 * pi / 3 * np.arange(3)
        turning = np.exp(1j * lag[:, :, None] * orders)
        return pairs * (1j * orders * self.waves * turning).real.sum(axis=2)

    @cached_property
    def iron_loss(self) -> FrequencyTerms:
        """Of stator and rotor at no load over the electrical frequency [W, ...]: of the drawing, in proportion to
        the square of the fundamental."""
        law = self.design.iron_loss
        if law is None:
            return FrequencyTerms(0.0, 0.0, 0.0)
        drawn, total = self.expansion.drawn, self.expansion.samples.iron_loss(law)
        as_drawn = Answers(self.expansion.about(drawn), self.anchors, drawn)
        flux = abs(self.waves[1] / self.design.turns / self.design.length / as_drawn.waves[1]) ** 2
        size = float(self.design.length * self.design.stacking_factor * self.design.iron_loss_factor * flux)
        return FrequencyTerms(*(size * float(term) for term in (total.hysteresis, total.eddy, total.excess)))

    def circulating_loss(self, speed: np.ndarray) -> np.ndarray:
        """Of the current round a delta at open terminals [W] (n,), at speeds [rad/s] (n,); none in a star."""
        if not (self.design.drawing.is_delta and speed.any()):
            return np.zeros(len(speed))
        orders = np.arange(3, len(self.coil_waves), 3)
        squares = np.abs(self.coil_waves[orders] / self._paths) ** 2
        return self.loss_round_delta(speed, orders, squares)

    def loss_round_delta(self, speed: np.ndarray, orders: np.ndarray, squares: np.ndarray) -> np.ndarray:
        """P = 3/2 R sum over n = 3, 9, 15 ... of (n w psi_0n)^2 / (R^2 + (n w L_0)^2) [W] (n,), w electrical, of the
        phases of the delta; L_0 is that without current.

        speed: [rad/s] (n,); orders: [1] (m,); squares: of the amplitudes psi_0n [Wb^2] (m,) or (n, m)
        Raises WorkbenchError without a resistance. Source: ``electrical.circulating``.
        """
        if not self.design.phase_resistance:
            raise WorkbenchError("a delta brakes by the current that goes round it: give phase_resistance in [device]")
        rate = np.abs(speed)[:, None] * self.design.machine.pole_pairs * orders
        resistance, inductance = 3 * self.design.phase_resistance, self._common_inductance
        terms = rate**2 * squares / (resistance**2 + (rate * inductance) ** 2)
        return np.asarray(1.5 * resistance * terms.sum(axis=1))

    @cached_property
    def _common_inductance(self) -> float:
        """L_0 of a phase of a delta [H]: its flux linkage by one small current in all three, mean over a part."""
        samples = self.expansion.samples
        angle = samples.step * np.round(np.arange(3) * samples.period / samples.parts / 3)
        change = self._coil_change(angle, np.full((3, 3), _SMALL / self._paths)) / self._paths
        return float(change.mean() / _SMALL)

    @property
    def _paths(self) -> float:
        """Parallel ones of a phase of a delta."""
        return 1 / (3 * float(np.abs(self.design.drawing.coil_currents).max()))

    # ---- windings -----------------------------------------------------------------------------------------------

    def resistance(self, at: Columns) -> np.ndarray:
        """Of a phase in the mean of all (n,) [ohm]: R_20 (1 + alpha (T - 20 degC)) at winding_T."""
        rows = len(next(iter(at.values())))
        winding = at.get("winding_T", np.full(rows, COPPER.reference_temperature))
        warm = 1.0 + COPPER.temperature_coefficient * (winding - COPPER.reference_temperature)
        return warm * at.get("resistance_factor", 1.0) * self.design.phase_resistance

    def resistances(self, at: Columns) -> np.ndarray:
        """Of A, B and C (n, 3) [ohm]."""
        return np.outer(self.resistance(at), self.design.resistance_shares)

    # ---- currents that turn with the rotor ----------------------------------------------------------------------

    def mean_dq(self, i_d: np.ndarray, i_q: np.ndarray) -> np.ndarray:
        """psi_d, psi_q (n, 2) [Wb] at currents along both axes [A] (n,): means over a part of an electrical period, of
        three positions in a sixth without sixth and twelfth orders."""
        theta, coils = self._turning_linkages(i_d, i_q)
        phases = coils @ self.design.drawing.coil_currents
        return np.mean([[park(one, at, self._star_axis) for one in rows] for at, rows in zip(theta, phases)], axis=0)

    def common_waves(self, i_d: np.ndarray, i_q: np.ndarray) -> np.ndarray:
        """Complex amplitudes of what the phases of a delta have in common at ``common_orders``, per path (n,
        orders) [Wb], at line currents along both axes [A] (n,); the others that a part of a period has left out."""
        theta, coils = self._turning_linkages(i_d, i_q)
        turning = np.exp(1j * np.outer(theta, self.common_orders))
        columns = np.concatenate([turning.real, -turning.imag], axis=1)
        both = np.linalg.lstsq(columns, coils.mean(axis=2) / self._paths, rcond=None)[0]
        real, imaginary = both.reshape(2, len(self.common_orders), -1)
        return (real + 1j * imaginary).T

    @property
    def common_orders(self) -> np.ndarray:
        """Lowest orders of what all phases have in common (orders,) [1]: 3 and 9, and 6 where poles are not alike."""
        return np.array([3, 9] if self.expansion.samples.parts == 6 else [3, 6, 9])

    def _turning_linkages(self, i_d: np.ndarray, i_q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Electrical angles (positions,) [rad] over a part of a period, and flux linkages there of all coils of each
        phase in series (positions, n, 3) [Wb] at line currents along both axes [A] (n,).

        Of the magnets' part the share that leaks at the ends is missing, whatever the current. Twice as many positions
        for a delta, of which the orders that go round it are asked.
        """
        samples = self.expansion.samples
        positions = (36 if self.design.drawing.is_delta else 18) // samples.parts
        step = samples.period / samples.parts / positions
        places = [round((k + 0.5) * step) for k in range(positions)]
        coils = np.stack([self._turning_coils(np.append(i_d, 0.0), np.append(i_q, 0.0), place) for place in places])
        coils = coils[:, :-1] - self.design.end_leakage * coils[:, -1:]
        theta = self.design.machine.pole_pairs * samples.step * np.array(places)
        return theta, self.design.turns * self.design.length * coils

    def _turning_coils(self, i_d: np.ndarray, i_q: np.ndarray, place: int) -> np.ndarray:
        """Flux linkages of coils per turn and metre at one step of the grid (n, 3) [Wb/m]."""
        states = [self._turning_state(d, q, place) for d, q in zip(i_d, i_q, strict=True)]
        return (self.expansion.at_centre(states) + self.expansion.change(self.design, states))[:, 1:]

    def turning_torque(self, angle: np.ndarray, i_q: float) -> np.ndarray:
        """At rotor angles [rad] (n,) with a current along the q axis that turns with the rotor [A] [Nm] (n,)."""
        at = partial(self._turning_state, 0.0, i_q)
        both = self._between(angle, at, 1, self.expansion.at_centre)
        change = self._between(angle, at, _APART, lambda states: self.expansion.change(self.design, states))
        lines = self._turning_lines(0.0, i_q, self.design.machine.pole_pairs * angle[:, None])
        return self._without_leakage((both + change)[:, 0], angle, lines)

    def _turning_lines(self, i_d: float, i_q: float, theta: np.ndarray | float) -> np.ndarray:
        """Line currents [A] (..., 3) of such along both axes at electrical angles (..., 1) [rad]."""
        turned = theta - self._star_axis - 2 * pi / 3 * np.arange(3)
        return i_d * np.cos(turned) - i_q * np.sin(turned)

    def _turning_state(self, i_d: float, i_q: float, step: int) -> State:
        """With line currents [A] along both axes at a step of the grid."""
        theta = self.design.machine.pole_pairs * step * self.expansion.samples.step
        lines = self._turning_lines(i_d, i_q, theta)
        return State(step, _triple(np.round(self.design.turns * self._in_coils(lines), 6)))

    @property
    def _star_axis(self) -> float:
        """Electrical angle of the axis of phase A of the star [rad]."""
        return self.design.drawing.layout.phase_axis + self.design.drawing.star_lag


def _scaled(state: State, factor: float) -> State:
    a, b, c = (float(f"{factor * value:.9g}") for value in state.ampere_turns)
    return State(state.step, (a, b, c))


def _around(place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Whole numbers about places between them (n, points) and their weights, of the polynomial through all."""
    first = np.floor(place).astype(int) - _POINTS // 2 + 1
    places = first[:, None] + np.arange(_POINTS)
    weights = np.ones(places.shape)
    for k in range(_POINTS):
        for j in range(_POINTS):
            if j != k:
                weights[:, k] *= (place - places[:, j]) / (k - j)
    return places, weights


def _state(ampere_turns: Triple, step: int) -> State:
    return State(step, ampere_turns)


def _unfolded(part: np.ndarray, parts: int) -> np.ndarray:
    """A period of phase A from a third or a sixth of all three (m, 3): psi_A(x - 120 deg k) = psi_k(x).

    In the order of A's own angle 0, 120, 240: A, C (-240), B (-120). With a sixth psi(x + 180 deg) = -psi too, so that
    0 is A, 60 is -B (180 - 120), 120 is C, then the same negative.
    """
    a, b, c = part.T
    if parts == 3:
        return np.concatenate([a, c, b])
    half = np.concatenate([a, -b, c])
    return np.concatenate([half, -half])
