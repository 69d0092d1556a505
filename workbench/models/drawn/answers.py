"""What the terminals and the torque cell of a drawn machine see, from its expanded field samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np

from effects.base import Columns
from effects.drawn_design import DrawnAsBuilt
from losses.iron import FrequencyTerms
from magnetostatics.flux_linkage import park
from materials.conductor import COPPER
from workbench.models.drawn.expansion import Expansion
from workbench.models.drawn.field import State

_ORDERS = 36  # angles of an electrical period that a voltage is made of, where the grid has as many
_POINTS = 6  # of the grid of angles that a value between them is made of
_SAME = 1e-3  # relative, of currents that are those of an anchor
_NEAR = 0.3  # relative, of currents that are read off an anchor
_SCALES = (0.9, 1.0, 1.1)  # of an anchor, that what its size does is taken from
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
        """At angles [rad] (n,) and phase currents [A] (n, 3) [Nm]; see ``MachineAsBuilt`` for the leakage."""
        both = self._samples(angle, currents)[:, 0]
        if not self.design.end_leakage:
            return self.design.length * both
        alone = self._samples(angle, 0 * currents)[:, 0]
        return self.design.length * (self.kept * (both - alone) + self.kept**2 * alone)

    def linkage_change(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """Flux linkages of the phases against those without current [Wb] (n, 3); the end winding adds L_end i."""
        change = (self._samples(angle, currents) - self._samples(angle, 0 * currents))[:, 1:]
        return self.design.turns * self.design.length * change + self.design.end_winding_inductance * currents

    def magnet_linkage(self, angle: np.ndarray) -> np.ndarray:
        """Flux linkages of the phases without current [Wb] (n, 3)."""
        alone = self._samples(angle, np.zeros((len(angle), 3)))[:, 1:]
        return self.design.turns * self.design.length * self.kept * alone

    def _samples(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """(n, 4): between angles of the grid by a polynomial, between sizes of the current by a parabola."""
        ampere_turns = self.design.turns * currents
        kinds, group = np.unique(ampere_turns, axis=0, return_inverse=True)
        found = np.empty((len(angle), 4))
        for k, kind in enumerate(kinds):
            rows = np.flatnonzero(group.ravel() == k)
            found[rows] = self._at_currents(angle[rows], kind)
        return found

    def _at_currents(self, angle: np.ndarray, ampere_turns: np.ndarray) -> np.ndarray:
        anchor, scale = self.anchors.of(ampere_turns) if ampere_turns.any() else ((0.0, 0.0, 0.0), 1.0)
        exact = self._between(angle, anchor, 1, lambda states: self._in_size(states, scale))
        change = self._between(angle, anchor, _APART, lambda states: self.expansion.change(self.design, states))
        return exact + scale * change

    def _between(self, angle: np.ndarray, anchor: Triple, apart: int, values: Callable[[list[State]], np.ndarray]):
        """Values (states, 4) at every ``apart``th angle of the grid made into those at angles (n, 4)."""
        samples = self.expansion.samples
        places, weights = _around(angle / (apart * samples.step))
        steps, inverse = np.unique(apart * places % samples.period, return_inverse=True)
        found = values([State(int(step), anchor) for step in steps])
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
        """Complex amplitudes of phase A's flux linkage over the electrical angle [Wb] (orders,).

        A sixth of a period of all phases makes a whole one of A: B and C lag by a third each, half a period turns the
        sign.
        """
        samples, pairs = self.expansion.samples, self.design.machine.pole_pairs
        period = samples.steps // pairs
        strides = (d for d in range(2, period // 6 + 1) if period % (6 * d) == 0 and period // d >= _ORDERS)
        stride = max(strides, default=1)
        states = [State(k * stride, (0.0, 0.0, 0.0)) for k in range(period // stride // 6)]
        sixth = (self.expansion.at_centre(states) + self.expansion.change(self.design, states))[:, 1:]
        whole = _unfolded(sixth)
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

    # ---- windings -----------------------------------------------------------------------------------------------

    def resistance(self, at: Columns) -> np.ndarray:
        """Of a phase (n,) [ohm]: R_20 (1 + alpha (T - 20 degC)) at winding_T."""
        rows = len(next(iter(at.values())))
        winding = at.get("winding_T", np.full(rows, COPPER.reference_temperature))
        warm = 1.0 + COPPER.temperature_coefficient * (winding - COPPER.reference_temperature)
        return warm * at.get("resistance_factor", 1.0) * self.design.phase_resistance

    # ---- currents that turn with the rotor ----------------------------------------------------------------------

    def mean_dq(self, i_d: np.ndarray, i_q: np.ndarray, positions: int = 3) -> np.ndarray:
        """psi_d, psi_q (n, 2) [Wb] at currents along both axes [A] (n,): means over a sixth of an electrical period,
        of three positions without sixth and twelfth orders."""
        layout, pairs = self.design.drawing.layout, self.design.machine.pole_pairs
        step = self.expansion.samples.steps // pairs / 6 / positions
        found = np.zeros((len(i_d), 2))
        for k in range(positions):
            place = round((k + 0.5) * step)
            theta = pairs * place * self.expansion.samples.step
            turned = theta - layout.phase_axis - 2 * pi / 3 * np.arange(3)
            phases = self.design.turns * (i_d[:, None] * np.cos(turned) - i_q[:, None] * np.sin(turned))
            states = [State(place, _triple(np.round(row, 6))) for row in phases]
            samples = self.expansion.at_centre(states) + self.expansion.change(self.design, states)
            found += np.array([park(one, theta, layout.phase_axis) for one in samples[:, 1:]]) / positions
        return self.design.turns * self.design.length * found


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


def _unfolded(sixth: np.ndarray) -> np.ndarray:
    """A period of phase A from a sixth of all three (m, 3): psi_A(x - 120 deg k) = psi_k(x), psi(x + 180 deg) = -psi.

    In the order of A's own angle 0, 60, ...: 0 is A, 60 is -B (180 - 120), 120 is C (-240), then the same negative.
    """
    a, b, c = sixth.T
    half = np.concatenate([a, -b, c])
    return np.concatenate([half, -half])
