"""Histories of runs as plain arrays: what is kept of them for figures, for the gears and for a second look."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from labelled import xr
from vehicle.ride import RideHistory


@dataclass(frozen=True, eq=False)
class Trace:
    """One run over time; road and tyre loads (wheels, t), front first, all else (t,).

    time [s], (t,); road: heights under the wheels [m], (wheels, t); stroke [m], (t,), and velocity [m/s], (t,), of the
    actuated axle, positive in rebound
    actuator_force: of the machine [N], (t,); tyre_loads: on the road [N], (wheels, t)
    """

    time: np.ndarray
    road: np.ndarray
    stroke: np.ndarray
    velocity: np.ndarray
    actuator_force: np.ndarray
    tyre_loads: np.ndarray


@dataclass(frozen=True, eq=False)
class Traces:
    """Runs on the same road beside each other.

    names: one a run; data: the variables of ``Trace`` over run, wheel and time, road without the runs
    """

    names: tuple[str, ...]
    data: xr.Dataset

    @property
    def by_name(self) -> dict[str, Trace]:
        """Every run alone."""
        return {name: self._trace(number) for number, name in enumerate(self.names)}

    def _trace(self, number: int) -> Trace:
        one = self.data.isel(run=number)
        return Trace(
            time=one.time.values,
            road=one.road.values,
            stroke=one.stroke.values,
            velocity=one.velocity.values,
            actuator_force=one.actuator_force.values,
            tyre_loads=one.tyre_loads.values,
        )


def traces(names: Sequence[str], histories: Sequence[RideHistory | Trace], until: float | None = None) -> Traces:
    """Histories of runs on one road; until: last time that is kept [s], None for all of it."""
    time, road = histories[0].time, histories[0].road
    kept = slice(None) if until is None else slice(0, int(np.searchsorted(time, until, side="right")))
    names_of_one = ("stroke", "velocity", "actuator_force")
    single = {name: [getattr(one, name)[kept] for one in histories] for name in names_of_one}
    loads = np.array([one.tyre_loads[:, kept] for one in histories])
    data = xr.Dataset({name: (("run", "time"), np.array(rows)) for name, rows in single.items()})
    data = data.assign(tyre_loads=(("run", "wheel", "time"), loads), road=(("wheel", "time"), road[:, kept]))
    return Traces(tuple(names), data.assign_coords(time=time[kept]))


def road_histories(histories: Sequence[RideHistory]) -> xr.Dataset:
    """Actuator on random roads of several seeds: force [N], velocity [m/s] and stroke [m] over (seed, time)."""
    names = {"force": "actuator_force", "velocity": "velocity", "stroke": "stroke"}
    rows = {key: np.array([getattr(one, name) for one in histories]) for key, name in names.items()}
    seeds = [one.run.scenario.road.random_seed for one in histories]
    data = {key: (("seed", "time"), values) for key, values in rows.items()}
    return xr.Dataset(data, {"seed": seeds, "time": histories[0].time})
