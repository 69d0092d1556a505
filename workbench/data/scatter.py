"""How far single readings of a laboratory's file scatter, by what stands in it. Only drafts are written from this."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.optimize import nnls

from workbench.data.robust import size_of

_FEWEST_ROWS = 12  # whose third differences show a noise
_FEWEST_REPEATS = 6  # differences between repeated rows that do
_FEWEST_TO_GROW = 20  # of them that show whether it grows with the reading
_ROUNDS = 20
_SAME_PLACE = 1e-6  # of the range, by which places are told apart that are logged alike
_SAME_SETTING = 0.005  # relative: what is logged of one setting lies no further apart


def noise_of(
    values: np.ndarray, conditions: Mapping[str, np.ndarray], books: Sequence[np.ndarray] = ()
) -> tuple[str, str] | None:
    """Standard uncertainty of one reading, as a campaign file spells it, and what shows it; None for few rows.

    Differences between rows under the same conditions, or what neighbours along a condition are off a parabola through
    them: along the one and in the order, of scans or of all rows, in which that is least.

    books: what only tells repeats and scans from one another
    """
    good = np.isfinite(values)
    if not good.any():
        return None
    settings = [_settings(column[good], name) for name, column in conditions.items()]
    values, places = values[good], np.column_stack([np.zeros(good.sum()), *settings])
    again = _of_repeats(values, places)
    if again is not None or len(values) < _FEWEST_ROWS:
        return again
    kept = [book[good] for book in books]
    turned = [np.roll(places, -k, axis=1) for k in np.flatnonzero(np.isfinite(places).all(axis=0))]
    off = [_off_parabolas(p, values, by) for p in turned for by in (kept, [])]
    size = max(min(map(_robust, off)), _of_digits(values))
    return (f"{size:.2g}", "neighbours") if size else None


def _off_parabolas(places: np.ndarray, values: np.ndarray, books: Sequence[np.ndarray]) -> np.ndarray:
    """Third divided differences of neighbours along the first of the places, of the size of the noise of one value; of
    two that were taken at nearly the same place little but their own difference. Neighbours that other conditions tell
    apart are left out, where enough are left."""
    order = np.lexsort((*places.T, *books))
    x, values, others = places[order, 0], values[order], places[order, 1:]
    x = x / (np.abs(x).max() or 1.0)
    x = x / (np.ptp(x) or 1.0) + np.linspace(0.0, _SAME_PLACE, len(x))
    four = np.lib.stride_tricks.sliding_window_view(np.column_stack([x, values, others]), 4, axis=0)
    apart = four[:, 0, :, None] - four[:, 0, None, :] + np.eye(4)
    weights = 1.0 / apart.prod(axis=2)
    off = (weights * (four[:, 1] - four[:, 1, :1])).sum(axis=1) / np.linalg.norm(weights, axis=1)
    alike = (four[:, 2:] == four[:, 2:, :1]).all(axis=(1, 2))
    return off[alike] if alike.sum() >= _FEWEST_REPEATS else off


def _settings(values: np.ndarray, name: str) -> np.ndarray:
    """A condition as it was set (n,): of what is logged with a scatter about few settings the least of each, angles and
    sweeps as they are."""
    order = np.argsort(values)
    below, above = values[order][:-1], values[order][1:]
    near = above <= below + _SAME_SETTING * np.abs(below)
    which = np.cumsum(np.append(True, ~near)) - 1
    least, most = values[order][np.searchsorted(which, which)], values[order]
    if name == "angle_mech" or (most > least + 2 * _SAME_SETTING * np.abs(least)).any():
        return values
    settings = np.empty(len(values))
    settings[order] = least
    return settings


def _of_repeats(values: np.ndarray, places: np.ndarray) -> tuple[str, str] | None:
    """From rows under the same conditions, None where there are few or all readings are alike."""
    order = np.lexsort(places.T)
    again = (places[order][1:] == places[order][:-1]).all(1)  # open circuits, which are infinite, are alike
    if again.sum() < _FEWEST_REPEATS:
        return None
    apart, level = np.diff(values[order])[again] / np.sqrt(2.0), np.abs(values[order])[1:][again]
    size, least = size_of(apart), _of_digits(values)
    floor, share = _growing(np.abs(apart), level) if again.sum() >= _FEWEST_TO_GROW else (size, 0.0)
    if size > least and share * level.max() > floor:
        return f'"{max(floor, least):.2g} + {share:.2g}*abs(y)"', "repeated rows"
    return (f"{max(size, least):.2g}", "repeated rows") if max(size, least) else None


def _growing(sizes: np.ndarray, level: np.ndarray) -> tuple[float, float]:
    """a and b of a standard deviation a + b level, from absolute deviations; wild ones count as three of them."""
    shapes = np.column_stack([np.ones(len(level)), level])
    deviation = np.full(len(level), _robust(sizes))
    for _ in range(_ROUNDS):
        weight = 1.0 / np.maximum(deviation, 1e-3 * deviation.max() + 1e-300)
        seen = np.minimum(sizes, 3.0 * deviation) * np.sqrt(np.pi / 2.0)
        found = nnls(shapes * weight[:, None], seen * weight)[0]
        deviation = shapes @ found
    return float(found[0]), float(found[1])


def _robust(differences: np.ndarray) -> float:
    """Standard deviation of normal numbers with this median of sizes."""
    return 1.4826 * float(np.median(np.abs(differences)))


def _of_digits(values: np.ndarray) -> float:
    """Standard deviation by the steps that values are read in: those of a converter, where some recur, else those of
    their last digit."""
    steps = np.diff(np.unique(values))
    if not steps.size:
        return 0.0
    step = float(steps.min()) if len(steps) + 1 < len(values) else _last_digit(values)
    return step / float(np.sqrt(12.0))


def _last_digit(values: np.ndarray) -> float:
    """The largest power of ten of which all values are multiples."""
    places = 10.0 ** np.arange(3, -10, -1)
    return next((float(p) for p in places if np.allclose(values, p * np.round(values / p), rtol=1e-9, atol=0.0)), 0.0)
