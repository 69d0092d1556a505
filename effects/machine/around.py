"""Small differences between like parts round a machine, as a few waves: what scatter mostly consists of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def waves(parts: int, amplitudes: Sequence[float]) -> tuple[float, ...]:
    """sum over m of c_m cos(2 pi m k/parts) + s_m sin(2 pi m k/parts) for part k (parts,).

    amplitudes: c_1, s_1, c_2, s_2, ..., in the unit of the answer
    """
    place = 2 * np.pi * np.arange(parts) / parts
    cosines, sines = amplitudes[::2], amplitudes[1::2]
    total = sum(c * np.cos(m * place) + s * np.sin(m * place) for m, (c, s) in enumerate(zip(cosines, sines), 1))
    return tuple(np.asarray(total).tolist())
