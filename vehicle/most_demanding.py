"""Which runs of a vehicle ask most of its actuator (thesis Table 3.7), each value with the runs that set it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.errors import VehicleError
from vehicle.indices import RideSummary


@dataclass(frozen=True)
class SetBy:
    """The run that set a value, or the runs on one road with other seeds whose mean it is.

    scenario, damping: their names; seed: of a random road, None where the scenario has none or all seeds count;
    runs: how many the value is the mean of
    """

    scenario: str
    damping: str
    seed: int | None = None
    runs: int = 1

    @property
    def words(self) -> str:
        """The same for people: ``random road, mixed damping, mean of 6``."""
        seed = "" if self.seed is None else f", seed {self.seed}"
        mean = f", mean of {self.runs}" if self.runs > 1 else ""
        return f"{self.scenario}{seed}, {self.damping} damping{mean}"


@dataclass(frozen=True)
class Demand:
    """A value [of the demand, SI], signed, and what set it."""

    value: float
    set_by: SetBy


@dataclass(frozen=True)
class Demands:
    """Rows of Table 3.7 that runs of the vehicle set. Velocities and forces are positive in rebound.

    nominal: force_rms [N], velocity_rms [m/s], power_rms [W]; peaks: velocity_peak [m/s], force_peak [N] at
    velocity_at_force_peak [m/s], power_peak [W] = force_at_power_peak [N] times velocity_at_power_peak [m/s]
    """

    force_rms: Demand
    velocity_rms: Demand
    power_rms: Demand
    velocity_peak: Demand
    force_peak: Demand
    velocity_at_force_peak: Demand
    power_peak: Demand
    force_at_power_peak: Demand
    velocity_at_power_peak: Demand


def most_demanding(road: Sequence[RideSummary], overload: Sequence[RideSummary]) -> Demands:
    """The most demanding values of the runs.

    road: random road; the mean over the seeds of the damping with the largest RMS force is the nominal working point,
        so that force, velocity and power belong together, as in Table 3.7
    overload: obstacles and manoeuvres, whose peaks count; where there are none, those on the random road count
    Raises VehicleError without a run on a random road.
    """
    if not road:
        raise VehicleError("requirements: expected at least one run on a random road, found none; add a road scenario")
    return Demands(**_nominal_point(road), **_peaks(overload or road))


def _nominal_point(runs: Sequence[RideSummary]) -> dict[str, Demand]:
    groups: dict[SetBy, list[RideSummary]] = {}
    for run in runs:
        groups.setdefault(SetBy(run.scenario, run.damping), []).append(run)
    of_all_seeds, worst = max(groups.items(), key=lambda group: np.mean([run.force_rms for run in group[1]]))
    set_by = SetBy(of_all_seeds.scenario, of_all_seeds.damping, runs=len(worst))
    names = ("force_rms", "velocity_rms", "power_rms")
    return {name: Demand(float(np.mean([getattr(run, name) for run in worst])), set_by) for name in names}


def _peaks(runs: Sequence[RideSummary]) -> dict[str, Demand]:
    fastest = max(runs, key=lambda run: abs(run.velocity_peak))
    strongest = max(runs, key=lambda run: abs(run.at_force_peak.force))
    mightiest = max(runs, key=lambda run: abs(run.at_power_peak.power))
    strong, mighty = strongest.at_force_peak, mightiest.at_power_peak
    return {
        "velocity_peak": Demand(fastest.velocity_peak, _this_run(fastest)),
        "force_peak": Demand(strong.force, _this_run(strongest)),
        "velocity_at_force_peak": Demand(strong.velocity, _this_run(strongest)),
        "power_peak": Demand(mighty.power, _this_run(mightiest)),
        "force_at_power_peak": Demand(mighty.force, _this_run(mightiest)),
        "velocity_at_power_peak": Demand(mighty.velocity, _this_run(mightiest)),
    }


def _this_run(run: RideSummary) -> SetBy:
    return SetBy(run.scenario, run.damping, run.seed)
