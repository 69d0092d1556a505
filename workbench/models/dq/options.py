"""What could be measured next on the bench of a dq machine, at speeds, torques and voltages like those measured."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from workbench.data.table import Table
from workbench.models.base import Option
from workbench.models.proposals import proposal

_SHARES = np.array([0.1, 0.25, 0.5, 0.75, 1.0])  # of the largest that was measured
_METERS = ("current", "power")


def options(tables: Sequence[Table]) -> list[Option]:
    """Measurements besides those of the tables."""
    speed, torque = _largest("speed", tables), _largest("torque", tables)
    speeds = {"speed": speed * _SHARES}
    found = [
        proposal("back_emf", "back-EMF over speed, open terminals", speeds, ("v_ll",), tables),
        proposal("drag", "drag over speed, open terminals", speeds, ("torque",), tables),
        proposal("short_circuit", "short circuit over speed", speeds, ("torque", "current"), tables),
        proposal(
            "phase_resistance", "resistance of a phase, cold", {"winding_T": np.full(5, 20.0)}, ("resistance",), tables
        ),
    ]
    if torque:
        across, along = (axis.ravel() for axis in np.meshgrid(speed * _SHARES, torque * _SHARES))
        grid = {"speed": across, "torque": along}
        found.append(
            proposal("dyno_map", "dynamometer map, least current over speed and torque", grid, _METERS, tables)
        )
    return [option for option in found if option is not None and speed]


def _largest(name: str, tables: Sequence[Table]) -> float:
    """Largest size of a condition or reading in the tables, zero where none has it."""
    sizes = [np.abs(table.conditions[name]).max() for table in tables if name in table.conditions]
    sizes += [np.abs(table.responses[name].values).max() for table in tables if name in table.responses]
    return float(max(sizes, default=0.0))
