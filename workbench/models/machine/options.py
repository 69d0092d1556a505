"""What could be measured next on the bench of a machine: measurements that it can make with the instruments it has."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from units import DEGREE, RPM
from workbench.data.table import Table
from workbench.models.base import Option
from workbench.models.proposals import proposal

SPEEDS = np.array([50.0, 100.0, 200.0, 400.0, 700.0, 1000.0, 1500.0, 2000.0]) * RPM
COGGING_STEP, EMF_STEP = 1.5 * DEGREE, 3.0 * DEGREE
WINDING = np.array([20.0, 40.0, 60.0, 80.0, 100.0, 120.0])  # degC
FAST = 2000.0 * RPM
_PHASES = "abc"

Columns = Mapping[str, np.ndarray]


def options(tables: Sequence[Table]) -> list[Option]:
    """Measurements besides those of the tables; with current only at angles and currents that tables have."""
    found = [
        proposal("drag", "drag from 50 to 2000 rpm, both directions", _both(SPEEDS), ("torque",), tables),
        proposal("cogging", "cogging every 1.5 deg, both directions", _turn(COGGING_STEP), ("torque",), tables),
        proposal("back_emf", "back-EMF at 2000 rpm, both directions", _fast_turn(), _phases("v"), tables),
        proposal("short_circuit", "short circuit from 50 to 2000 rpm", {"speed": SPEEDS}, ("torque",), tables),
        proposal("no_load", "power of the drive from 50 to 2000 rpm", {"speed": SPEEDS}, ("power",), tables),
        proposal("phase_resistance", "resistance at 20 to 120 degC", {"winding_T": WINDING}, _phases("r"), tables),
    ]
    points = _loaded(tables)
    if points:
        words = "locked-rotor torque at every angle and current that was measured"
        found.append(proposal("locked_rotor", words, points, ("torque",), tables))
    return [option for option in found if option is not None]


def _phases(quantity: str) -> tuple[str, ...]:
    return tuple(f"{quantity}_{x}" for x in _PHASES)


def _both(speeds: np.ndarray) -> dict[str, np.ndarray]:
    return {"speed": np.concatenate([speeds, -speeds])}


def _turn(step: float) -> dict[str, np.ndarray]:
    """A revolution there and back."""
    angle = np.arange(0.0, 2 * np.pi - step / 2, step)
    direction = np.repeat([1.0, -1.0], len(angle))
    return {"angle_mech": np.concatenate([angle, angle[::-1]]), "direction": direction}


def _fast_turn() -> dict[str, np.ndarray]:
    turn = _turn(EMF_STEP)
    return turn | {"speed": FAST * turn["direction"]}


def _loaded(tables: Sequence[Table]) -> dict[str, np.ndarray]:
    """Angles and currents of all rows with current, each once."""
    names = ("angle_mech", *_phases("i"))
    rows = [np.stack([t.conditions[n] for n in names], axis=1) for t in tables if set(names) <= set(t.conditions)]
    if not rows:
        return {}
    points = np.unique(np.concatenate(rows), axis=0)
    points = points[np.any(points[:, 1:] != 0.0, axis=1)]
    return dict(zip(names, points.T)) if len(points) else {}
