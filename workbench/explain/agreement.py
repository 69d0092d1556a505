"""Does what is left repeat itself in rows that no fit has seen? Noise and the drift of one scan do not, a wrong
model does.

    T = sqrt(stations) * correlation of r_fit and r_held over the stations of a channel

of whitened residuals at the same conditions is about N(0, 1) when only noise is left, whatever its size; what the
model misses makes it large, smooth over the conditions or not. Where an unknown function was found in the fitted rows,

    G = expected . r_held - |expected|^2 / 2

is the ln likelihood that the held-out rows gain by it: noise alone reaches G with a probability below exp(-G), whatever
was expected; what is really there gains about |expected|^2 / 2. This is the sharper test, for what is smooth.
"""

from __future__ import annotations

import numpy as np

from workbench.likelihood.bench import Bench
from workbench.likelihood.noise import matched_rows

NOTHING_LEFT = 3.5  # largest T of noise: one channel in 4000 when it is Gaussian; 3.0 in 110 virtual benches
LOUDEST = 3.0  # standard deviations that a station counts at most: 4.5 nats
PREDICTED = 6.0  # nats that held-out rows must gain by what is expected of them: noise does in less than one of 400


def agreement(bench: Bench, residual: np.ndarray, held_residual: np.ndarray) -> float:
    """Largest T over the channels, each without the station that speaks loudest; 0 where none was both fitted and held
    out.

    residual, held_residual: whitened, of the rows to fit and of those held out
    """
    if bench.held_out is None:
        return 0.0
    return max((_t(bench, number, residual, held_residual) for number in range(len(bench.stack.channels))), default=0.0)


def repeats_itself(bench: Bench, explained: np.ndarray, held_residual: np.ndarray) -> bool:
    """Whether what was found in the fitted rows is in the held-out rows, too; True where there are none to ask.

    Either counts up to LOUDEST, so that no station alone can confirm anything: wild readings of two repeats may meet.
    explained: whitened, expected in the rows to fit (n,);  held_residual: whitened, of the rows held out
    """
    asked = _asked(bench, explained, held_residual)
    if asked is None:
        return True
    expected, held = (np.clip(side, -LOUDEST, LOUDEST) for side in asked)
    return float(expected @ held - 0.5 * expected @ expected) >= PREDICTED


def left_over(bench: Bench, explained: np.ndarray, held_residual: np.ndarray) -> float:
    """Size, in standard deviations, of what the held-out rows confirm of an explanation; 0 where they do not."""
    asked = _asked(bench, explained, held_residual)
    if asked is None or not repeats_itself(bench, explained, held_residual):
        return 0.0
    return float(np.linalg.norm(asked[0]))


def _asked(bench: Bench, explained: np.ndarray, held_residual: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """What is expected and what was held out, at the stations that were both fitted and held out; None without any."""
    if bench.held_out is None:
        return None
    pairs = [_both(bench, number, explained, held_residual) for number in range(len(bench.stack.channels))]
    pairs = [pair for pair in pairs if pair is not None]
    return tuple(np.concatenate(side) for side in zip(*pairs)) if pairs else None


def _without_loudest(seen: np.ndarray, held: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    loudest = int(np.argmax(seen * held))
    return np.delete(seen, loudest), np.delete(held, loudest)


def _t(bench: Bench, number: int, residual: np.ndarray, held_residual: np.ndarray) -> float:
    both = _both(bench, number, residual, held_residual)
    if both is None:
        return 0.0
    seen, held = _without_loudest(*both)
    size = np.sqrt(float(seen @ seen) * float(held @ held))
    return float(np.sqrt(len(seen)) * (seen @ held) / size) if size > 0 else 0.0


def _both(bench: Bench, number: int, fitted: np.ndarray, held_out: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Values of a channel at the stations that were both fitted and held out, means over their repeats (s,), (s,)."""
    channel = bench.stack.channels[number]
    table = bench.stack.tables[channel.table]
    stations = matched_rows(table)
    if stations is None:
        return None
    whole = np.empty(table.rows)
    whole[~table.held_out] = fitted[bench.fit.stack.channels[number].rows]
    whole[table.held_out] = held_out[bench.held_out.stack.channels[number].rows]
    held = table.held_out[stations]
    both = held.any(axis=1) & ~held.all(axis=1)
    if not both.any():
        return None
    values, held = whole[stations[both]], held[both]
    return _mean(values, ~held), _mean(values, held)


def _mean(values: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    return np.sum(values * chosen, axis=1) / chosen.sum(axis=1)
