"""What every code reports about a case."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.processes import Cost


@dataclass(frozen=True, eq=False)
class CodeResult:
    """One solution of a case by one code.

    torque: Arkkio's ring average over the stator half of the air gap, by the code's own integral [Nm/m]
    flux_linkage: of phases A, B, C per turn of each coil (3,) [Wb/m]
    residuals: relative to the load, after every Newton iteration
    cost: CPU and wall time of what the code's module says
    potential: at the corners of the case's mesh (n,) [Wb/m], None when not asked for
    others: further numbers by name
    """

    code: str
    torque: float
    flux_linkage: np.ndarray
    residuals: tuple[float, ...]
    cost: Cost
    potential: np.ndarray | None
    others: dict[str, float]

    @property
    def iterations(self) -> int:
        return len(self.residuals)
