"""What no effect of the library explains: a smooth unknown function of the conditions in one channel, or in all.

Its prior is a Gaussian process of amplitude a (in units of the uncertainty of the reading) and length l (in standard
deviations of the conditions, which are spread evenly first). Amplitudes, lengths and channels are averaged over.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from scipy.special import logsumexp
from scipy.stats import rankdata

from workbench.data.stack import Stack
from workbench.data.table import Table
from workbench.likelihood.linear import Nuisances
from workbench.likelihood.noise import Whitener

AMPLITUDES = (0.7, 1.7, 4.2, 10.0, 25.0)  # of the uncertainty of a reading
LENGTHS = (0.25, 0.6, 1.4, 3.5)  # of the standard deviation of a condition
ANGLE_LENGTHS = (0.06, 0.2, 0.7, 2.0)  # where an angle is scanned, waves are short
LANDMARKS = 100  # smooth shapes a channel


@dataclass(frozen=True, eq=False)
class Shapes:
    """Smooth shapes of one channel at one length, whitened and made orthogonal.

    rows: of the channel;  values: (n_c, q);  energy: squared length of each shape at amplitude 1 (q,)
    raw: the shapes before whitening (n_c, q), in units of the uncertainty
    """

    rows: slice
    values: np.ndarray
    energy: np.ndarray
    raw: np.ndarray


@dataclass(frozen=True)
class Choice:
    """One prior of the unknown function: (channel number, length number) that it acts in, and its amplitude."""

    parts: tuple[tuple[int, int], ...]
    amplitude: float
    log_prior: float


@dataclass(frozen=True, eq=False)
class Unknown:
    """The unknown smooth function of all channels. shapes: (channels, lengths)."""

    shapes: tuple[tuple[Shapes, ...], ...]

    @cached_property
    def choices(self) -> tuple[Choice, ...]:
        """One channel alone takes half of the prior, all channels alike the other half."""
        lengths, channels = range(len(LENGTHS)), range(len(self.shapes))
        single = -np.log(2.0 * len(channels) * len(LENGTHS) * len(AMPLITUDES))
        common = -np.log(2.0 * len(LENGTHS) * len(AMPLITUDES))
        alone = [Choice((place,), a, single) for place in product(channels, lengths) for a in AMPLITUDES]
        everywhere = [Choice(tuple((c, k) for c in channels), a, common) for k in lengths for a in AMPLITUDES]
        return tuple(alone + everywhere)

    def log_evidences(self, nuisances: Nuisances, residuals: np.ndarray) -> np.ndarray:
        """ln evidence of each choice over the null, prior of the choice included (choices, R); residuals (n, R)."""
        return _evidences(self, nuisances.jacobian, residuals)

    def log_evidence(self, nuisances: Nuisances, residuals: np.ndarray) -> np.ndarray:
        """ln evidence of the unknown function over the null (R,)."""
        return logsumexp(self.log_evidences(nuisances, residuals), axis=0)

    def expected_gain(self, choice: Choice) -> float:
        """ln evidence over the null [nats] that a choice is expected to gain where it is true, tolerances known.

        1/2 sum over the shapes of (a^2 e - ln(1 + a^2 e))
        """
        sizes = [choice.amplitude**2 * self.shapes[c][length].energy for c, length in choice.parts]
        return 0.5 * float(sum(np.sum(e - np.log1p(e)) for e in sizes))

    def mean(
        self, nuisances: Nuisances, residual: np.ndarray, choice: Choice
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Expected unknown function under a choice, whitened and in units of the uncertainty, (n,) each; nuisances
        (m,)."""
        whitened, raw = np.zeros(len(residual)), np.zeros(len(residual))
        shift = _nuisance_mean(self, nuisances.jacobian, residual, choice)
        left = residual - nuisances.jacobian @ shift
        for c, length in choice.parts:
            shapes = self.shapes[c][length]
            gain = choice.amplitude**2 / (1 + choice.amplitude**2 * shapes.energy)
            weights = gain * (shapes.values.T @ left[shapes.rows])
            whitened[shapes.rows] = shapes.values @ weights
            raw[shapes.rows] = shapes.raw @ weights
        return whitened, raw, shift

    def draw(self, choice: Choice, random: np.random.Generator, size: int, count: int) -> np.ndarray:
        """Whitened draws of the unknown function (n, count)."""
        out = np.zeros((size, count))
        for c, length in choice.parts:
            shapes = self.shapes[c][length]
            out[shapes.rows] = choice.amplitude * shapes.values @ random.standard_normal((len(shapes.energy), count))
        return out


def unknown_function(stack: Stack, white: Whitener) -> Unknown:
    """The smooth unknown of a stack."""
    sizes = [len(lengths_of(stack.tables[c.table])) for c in stack.channels]
    return Unknown(tuple(tuple(_shapes(stack, white, c, k) for k in range(size)) for c, size in enumerate(sizes)))


def lengths_of(table: Table) -> tuple[float, ...]:
    angle = table.conditions.get("angle_mech")
    return ANGLE_LENGTHS if angle is not None and np.ptp(angle) > 0 else LENGTHS


def spread_conditions(table: Table) -> np.ndarray:
    """Conditions that vary, by their ranks, with standard deviation 1 (n, d); ties share a place."""
    columns = [rankdata(np.round(v, 12)) for v in table.conditions.values() if np.ptp(v) > 0]
    if not columns:
        return np.zeros((table.rows, 1))
    places = np.array(columns).T
    return (places - places.mean(axis=0)) / places.std(axis=0)


def _shapes(stack: Stack, white: Whitener, number: int, length: int) -> Shapes:
    channel = stack.channels[number]
    table = stack.tables[channel.table]
    raw = smooth_shapes(spread_conditions(table), lengths_of(table)[length])
    spread = np.zeros((stack.size, raw.shape[1]))
    spread[channel.rows] = raw * stack.u[channel.rows, None]
    values = white(spread)[channel.rows]
    energy, turn = np.linalg.eigh(values.T @ values)
    keep = energy > 1e-6 * energy.max(initial=1.0)
    return Shapes(channel.rows, values @ turn[:, keep], energy[keep], raw @ turn[:, keep])


def smooth_shapes(places: np.ndarray, length: float, landmarks: int = LANDMARKS) -> np.ndarray:
    """Phi (n, q) with Phi Phi^T = exp(-|x - x'|^2 / (2 l^2)) as far as q landmarks reach (Nystroem)."""
    unique = np.unique(np.round(places, 6), axis=0)
    step = max(1, -(-len(unique) // landmarks))
    marks = unique[::step]
    between = _kernel(marks, marks, length) + 1e-6 * np.eye(len(marks))
    return np.linalg.solve(np.linalg.cholesky(between), _kernel(marks, places, length)).T


def _kernel(a: np.ndarray, b: np.ndarray, length: float) -> np.ndarray:
    square = np.sum(a**2, axis=1)[:, None] + np.sum(b**2, axis=1) - 2 * a @ b.T
    return np.exp(-np.maximum(square, 0.0) / (2 * length**2))


def _evidences(unknown: Unknown, jacobian: np.ndarray, residuals: np.ndarray) -> np.ndarray:
    """1/2 (r^T P r - r^T P_g r) - 1/2 ln det of the change, for each choice.

    With S = 1 + a^2 Phi Phi^T a channel:  A = 1 + J^T S^-1 J,  b = J^T S^-1 r,  r^T P_g r = r^T S^-1 r - b^T A^-1 b
    """
    m = jacobian.shape[1]
    plain_a, plain_b = np.eye(m) + jacobian.T @ jacobian, jacobian.T @ residuals
    null = _solved(plain_a, plain_b)
    null_det = 0.5 * np.linalg.slogdet(plain_a)[1]
    parts = {
        (c, k): (s.values.T @ jacobian[s.rows], s.values.T @ residuals[s.rows], s.energy)
        for c, lengths in enumerate(unknown.shapes)
        for k, s in enumerate(lengths)
    }
    out = []
    for choice in unknown.choices:
        a, b, square, log_det = plain_a.copy(), plain_b.copy(), 0.0, 0.0
        for part in choice.parts:
            on_j, on_r, energy = parts[part]
            gain = choice.amplitude**2 / (1 + choice.amplitude**2 * energy)
            a -= on_j.T @ (gain[:, None] * on_j)
            b -= on_j.T @ (gain[:, None] * on_r)
            square = square + gain @ on_r**2
            log_det += 0.5 * np.log1p(choice.amplitude**2 * energy).sum()
        change = 0.5 * (square + _solved(a, b) - null)
        out.append(change - log_det - 0.5 * np.linalg.slogdet(a)[1] + null_det + choice.log_prior)
    return np.array(out)


def _solved(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """b^T a^-1 b for each column."""
    return np.sum((np.linalg.solve(np.linalg.cholesky(a), b)) ** 2, axis=0)


def _nuisance_mean(unknown: Unknown, jacobian: np.ndarray, residual: np.ndarray, choice: Choice) -> np.ndarray:
    a, b = np.eye(jacobian.shape[1]) + jacobian.T @ jacobian, jacobian.T @ residual
    for c, length in choice.parts:
        shapes = unknown.shapes[c][length]
        gain = choice.amplitude**2 / (1 + choice.amplitude**2 * shapes.energy)
        on_j = shapes.values.T @ jacobian[shapes.rows]
        a -= on_j.T @ (gain[:, None] * on_j)
        b -= on_j.T @ (gain * (shapes.values.T @ residual[shapes.rows]))
    return np.linalg.solve(a, b)
