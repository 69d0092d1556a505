"""Tables of a machine on the bench, whoever answers for the machine: what is turned how, and the layout of a file."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from benchmarks.virtual_benches.hiding import Layout

SPEED = 1000.0  # rpm, of the back-EMF
WINDING = np.array([20.0, 40.0, 60.0, 80.0, 100.0])  # degC
COPPER = 0.00393  # 1/K at 20 degC, IEC 60028


def table_layout(kind: str, conditions: Mapping[str, np.ndarray], u: Mapping[str, float]) -> Layout:
    """The table of a kind; conditions: (n,) by column; u: declared uncertainty by response [its unit]."""

    def declared(responses: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        return {name: np.full(len(values), u[name]) for name, values in responses.items()}

    return Layout(f"{kind}.csv", kind, conditions, {name: f"{size:g}" for name, size in u.items()}, declared)


def there_and_back(angles: np.ndarray, speed: bool = False) -> dict[str, np.ndarray]:
    """Conditions of a turn each way over angles [deg], (n,): (2 n,) by column; speed: of them too."""
    direction = np.repeat([1.0, -1.0], len(angles))
    conditions = {"direction": direction, "angle_mech_deg": np.concatenate([angles, angles[::-1]])}
    return conditions | ({"speed_rpm": direction * SPEED} if speed else {})
