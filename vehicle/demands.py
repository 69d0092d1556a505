"""Requirements on the actuator from runs of the vehicle over speed, amplitude and damping (thesis Table 3.7)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from drivetrain.requirements import Requirements
from labelled import xr
from tasks import Workers
from vehicle.damping import DamperCurve, capped
from vehicle.errors import VehicleError, require_not_negative
from vehicle.indices import RideSummary
from vehicle.models import Vehicle
from vehicle.most_demanding import Demands, SetBy, most_demanding
from vehicle.ride import Run, Scenario, simulate
from vehicle.ride_means import RideMeans, ride_means
from vehicle.scenarios import runs_of, summaries
from vehicle.traces import Traces, road_histories, traces

# Runs of a task: what is integrated together costs little more than one run, but every task must find a worker.
_ROAD_TOGETHER, _OVERLOAD_TOGETHER = 9, 48
ROAD_SHOWN = 6.0  # s of a random road that a figure shows


@dataclass(frozen=True)
class RideCase:
    """A vehicle, the dampers that its actuator stands in for, and what it is driven over.

    curves: damping strategies of the actuator, each driven over everything
    road: a random road, once a seed; overload: obstacles and manoeuvres, may be empty
    maximum_damping: regenerative damping that is asked of the actuator and bounds every curve [Ns/m]; 0: none is
        asked for, and the curves stay as they are
    Raises VehicleError without a curve, for two of one name, without a road, or for a negative damping.
    """

    vehicle: Vehicle
    curves: tuple[DamperCurve, ...]
    road: tuple[Scenario, ...]
    overload: tuple[Scenario, ...]
    maximum_damping: float

    def __post_init__(self) -> None:
        require_not_negative("ride", maximum_damping=self.maximum_damping)
        if not (self.curves and self.road):
            raise VehicleError(
                f"ride: expected at least one damping and one random road, found {len(self.curves)} and "
                f"{len(self.road)}; add what is missing"
            )
        names = [curve.name for curve in self.curves]
        if len(set(names)) < len(names):
            raise VehicleError(f"ride: every damping needs a name of its own, found {', '.join(names)}; rename one")

    @property
    def damping(self) -> tuple[DamperCurve, ...]:
        """The curves as they are driven, with |F| <= c_max |v|."""
        limit = self.maximum_damping
        return tuple(capped(curve, limit) for curve in self.curves) if limit > 0 else self.curves

    @property
    def road_runs(self) -> list[Run]:
        """Every seed of the random road with every damping."""
        return runs_of(self.vehicle, self.damping, self.road)

    @property
    def overload_runs(self) -> list[Run]:
        """Every obstacle and manoeuvre with every damping."""
        return runs_of(self.vehicle, self.damping, self.overload)

    def runs_on(self, set_by: SetBy) -> list[Run]:
        """The runs over what set a value, one a damping."""
        every = (*self.road_runs, *self.overload_runs)
        place = (set_by.scenario, set_by.seed)
        return [run for run in every if (run.scenario.name, run.scenario.road.random_seed) == place]

    def run(self, set_by: SetBy) -> Run:
        """The one run that set a value."""
        return next(run for run in self.runs_on(set_by) if run.command.name == set_by.damping)


@dataclass(frozen=True, eq=False)
class RideRequirements:
    """What runs of a vehicle ask of its actuator, and the runs themselves.

    maximum_damping: regenerative damping that was asked for [Ns/m]; demands: all other values with what set them
    road, overload: every run summed up, in the order of ``RideCase.road_runs`` and ``RideCase.overload_runs``
    ride: means over the seeds, one a damping; energy_error: largest of all runs, relative
    natural_frequencies: undamped, of the vehicle, rising [Hz], (modes,)
    nominal: force [N], velocity [m/s] and stroke [m] over (seed, time) on the random road with the damping that sets
        the RMS force, for the fatigue of the gears
    road_traces: the beginning of the first random road with each damping; worst_traces: what sets the peak force, too
    """

    maximum_damping: float
    demands: Demands
    road: tuple[RideSummary, ...]
    overload: tuple[RideSummary, ...]
    ride: tuple[RideMeans, ...]
    energy_error: float
    natural_frequencies: np.ndarray
    nominal: xr.Dataset
    road_traces: Traces
    worst_traces: Traces


@dataclass(frozen=True)
class RunsTask:
    """Runs that are integrated together."""

    runs: tuple[Run, ...]


def summed_up(task: RunsTask) -> tuple[RideSummary, ...]:
    """Summaries of the runs of a task, in their order."""
    return tuple(summaries(task.runs))


def requirements_stage(case: RideCase, workers: Workers) -> RideRequirements:
    """All runs of a case, the most demanding values and the histories that are looked at again.

    Raises VehicleError for a motion without bounds, a damper curve that ends too early, or an energy balance that
    does not close.
    """
    road = _summaries("road", case.road_runs, _ROAD_TOGETHER, workers)
    overload = _summaries("overload", case.overload_runs, _OVERLOAD_TOGETHER, workers)
    demands = most_demanding(road, overload)
    nominal, road_traces, worst_traces = _kept(case, demands)
    return RideRequirements(
        maximum_damping=case.maximum_damping,
        demands=demands,
        road=road,
        overload=overload,
        ride=ride_means(road),
        energy_error=max(run.energy_error for run in (*road, *overload)),
        natural_frequencies=np.asarray(case.vehicle.natural_frequencies),
        nominal=nominal,
        road_traces=road_traces,
        worst_traces=worst_traces,
    )


def required(found: RideRequirements) -> Requirements:
    """What the stages behind the vehicle read: magnitudes, without what set them."""
    demands = {f.name: abs(getattr(found.demands, f.name).value) for f in fields(Demands)}
    return Requirements(maximum_damping=found.maximum_damping, **demands)


def _summaries(part: str, runs: Sequence[Run], together: int, workers: Workers) -> tuple[RideSummary, ...]:
    starts = range(0, len(runs), together)
    tasks = {f"{part}, from run {first}": RunsTask(tuple(runs[first : first + together])) for first in starts}
    found = workers.map(part, summed_up, tasks)
    return tuple(one for name in tasks for one in found[name])


def _kept(case: RideCase, demands: Demands) -> tuple[xr.Dataset, Traces, Traces]:
    """The nominal working point over all seeds, the first road and the worst case, simulated in one go."""
    nominal = [run for run in case.road_runs if run.command.name == demands.force_rms.set_by.damping]
    road = case.road_runs[: len(case.curves)]
    worst = case.runs_on(demands.force_peak.set_by)
    found = iter(simulate([*nominal, *road, *worst]))
    histories = [[next(found) for _ in runs] for runs in (nominal, road, worst)]
    names = [curve.name for curve in case.curves]
    return road_histories(histories[0]), traces(names, histories[1], ROAD_SHOWN), traces(names, histories[2])
