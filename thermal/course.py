"""A body that warms up over time: implicit integration, and with it the balance of its energy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy

from thermal.errors import ThermalError
from thermal.network import Body, Temperatures

_RELATIVE, _ABSOLUTE = 1e-5, 1e-4  # of temperatures [K] and energies [J]; time constants span five decades: stiff


@dataclass(frozen=True, eq=False)
class Course:
    """Temperatures over time.

    names: of the nodes; time [s] (t,), as the integration stepped; temperature [degC] (n, t)
    produced, delivered: heat that has arisen and that has left into the surroundings since the start [J], (t,)
    stored: heat that the nodes have taken up [J], (t,)
    stopped: whether the condition was met at the last time
    """

    names: tuple[str, ...]
    time: np.ndarray
    temperature: np.ndarray
    produced: np.ndarray
    delivered: np.ndarray
    stored: np.ndarray
    stopped: bool

    def of(self, name: str) -> np.ndarray:
        """Temperature of a node over time [degC], (t,)."""
        return self.temperature[self.names.index(name)]

    @property
    def end(self) -> dict[str, float]:
        """Temperatures at the last time, by name [degC]."""
        return dict(zip(self.names, self.temperature[:, -1].tolist(), strict=True))


def course(
    body: Body, start: Temperatures, duration: float, until: Callable[[Temperatures], float] | None = None
) -> Course:
    """Follow a body from temperatures [degC] for a duration [s], or until ``until`` rises through zero.

    until: of the temperatures by name [degC], negative as long as it goes on; None: to the end
    Implicit, of variable order and step (LSODA). Raises ThermalError where it does not get to the end.
    """
    first = body.network(start)

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        temperature = first.named(state[:-2])
        network, heat = body.network(temperature), body.heat(temperature)
        matrix, inflow = network.equations()
        warming = (network.vector(heat) + inflow - matrix @ state[:-2]) / network.capacities
        return np.array([*warming, sum(heat.values()), network.delivered(temperature)])

    found = scipy.integrate.solve_ivp(
        rates,
        (0.0, duration),
        np.array([*first.vector(start), 0.0, 0.0]),
        method="LSODA",
        events=_event(until, first.named),
        rtol=_RELATIVE,
        atol=_ABSOLUTE,
    )
    if not found.success:
        raise ThermalError(f"the temperatures could not be followed beyond {found.t[-1]:.4g} s: {found.message}")
    temperature = found.y[:-2]
    stored = first.capacities @ (temperature - temperature[:, :1])
    return Course(first.names, found.t, temperature, found.y[-2], found.y[-1], stored, found.status == 1)


def _event(
    until: Callable[[Temperatures], float] | None, named: Callable[[np.ndarray], dict[str, float]]
) -> Callable[[float, np.ndarray], float] | None:
    if until is None:
        return None

    def reached(_: float, state: np.ndarray) -> float:
        return until(named(state[:-2]))

    reached.terminal, reached.direction = True, 1.0  # type: ignore[attr-defined]
    return reached
