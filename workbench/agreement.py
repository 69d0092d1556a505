"""Does what is left repeat itself in rows that no fit has seen? Noise and the drift of one scan do not, a wrong
model does.

    T = sqrt(stations) * correlation of r_fit and r_held over the stations of a channel

of whitened residuals at the same conditions is about N(0, 1) when only noise is left, whatever its size; what the
model misses
makes it large, smooth over the conditions or not.
"""

from __future__ import annotations

import numpy as np

from workbench.bench import Bench
from workbench.noise import matched_rows

NOTHING_LEFT = 4.0  # largest T of noise: one channel in 30 000 when it is Gaussian, more with heavy tails
SOMETHING_LEFT = 3.5  # T from which an unknown function beside an effect is believed
REPEATS = 0.5  # share of an explanation of the fitted rows that the held-out rows must show, too


def agreement(bench: Bench, residual: np.ndarray, held_residual: np.ndarray) -> float:
    """Largest T over the channels; 0 where no station was both fitted and held out.

    residual, held_residual: whitened, of the rows to fit and of those held out
    """
    if bench.held_out is None:
        return 0.0
    return max((_t(bench, number, residual, held_residual) for number in range(len(bench.stack.channels))), default=0.0)


def repeats_itself(bench: Bench, explained: np.ndarray, held_residual: np.ndarray) -> bool:
    """Whether what was found in the fitted rows is in the held-out rows, too; True where there are none to ask.

    explained: whitened, expected in the rows to fit (n,);  held_residual: whitened, of the rows held out
    """
    if bench.held_out is None:
        return True
    pairs = [_both(bench, number, explained, held_residual) for number in range(len(bench.stack.channels))]
    pairs = [pair for pair in pairs if pair is not None]
    expected = sum(float(seen @ seen) for seen, _ in pairs)
    return not pairs or sum(float(seen @ held) for seen, held in pairs) >= REPEATS * expected


def _t(bench: Bench, number: int, residual: np.ndarray, held_residual: np.ndarray) -> float:
    both = _both(bench, number, residual, held_residual)
    if both is None:
        return 0.0
    seen, held = both
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
