"""Answers of a machine whose magnets are at another temperature in every row."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import TypeVar

import numpy as np
from scipy.ndimage import median_filter

from effects.base import Columns
from effects.machine_design import BuiltMachine

_MAGNET_MEMORY = 61  # rows; a magnet warms over minutes, what its reading does from row to row is noise
Machine = TypeVar("Machine", bound=BuiltMachine)


def at_magnet_temperatures(
    answer: Callable[[Machine], Mapping[str, np.ndarray]], design: Machine, at: Columns
) -> Mapping[str, np.ndarray]:
    """What a bench answers with the magnets of every row at their own temperature, where it was read.

    The field is taken with the remanence of the coldest, the mean and the warmest row, and a parabola between them.
    """
    if "magnet_T" not in at:
        return answer(design)
    temperature = _slow(np.ascontiguousarray(at["magnet_T"], dtype=float).tobytes())
    nodes = np.unique([temperature.min(), (temperature.min() + temperature.max()) / 2, temperature.max()])
    found = [answer(_warm(design, node)) for node in nodes.tolist()]
    weights = [_lagrange(nodes, k, temperature) for k in range(len(nodes))]
    return {name: sum(w * one[name] for w, one in zip(weights, found)) for name in found[0]}


def _warm(design: Machine, temperature: float) -> Machine:
    magnet = design.magnet
    factor = 1.0 + magnet.temperature_coefficient * (temperature - magnet.reference_temperature)
    return design.with_magnet(remanence=magnet.remanence * max(factor, 0.0))


def _lagrange(nodes: np.ndarray, k: int, x: np.ndarray) -> np.ndarray:
    others = np.delete(nodes, k)
    return np.prod([(x - other) / (nodes[k] - other) for other in others], axis=0) if len(others) else np.ones_like(x)


@lru_cache(maxsize=16)
def _slow(readings: bytes) -> np.ndarray:
    """Running median of readings, given as the bytes of their array."""
    return median_filter(np.frombuffer(readings), _MAGNET_MEMORY, mode="nearest")
