"""Chapter 4 with its scatter: ``python -m benchmarks.actuator_ride [ROADS]``.

Writes results/reference/benchmarks/actuator_*.csv:

``actuator_energy.csv``: Tables 4.6-4.14 over many roads, with the road's noise held for 1 and for 10 ms, beside what is
printed. ``actuator_steps.csv``: one ride with ever finer steps. ``actuator_carpets.csv``: time and best settings of the
carpets, and how far sampled rides are from the covariances. ``actuator_speed.csv``: CPU time of single runs.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from time import process_time

import numpy as np
import pandas as pd

from pipeline.modules import PROJECT
from tests.actuator.thesis import FORCE_LOOP, prototype, quasi_ideal
from tests.vehicle.thesis import (
    CRUISE_SPEED,
    HANDLING,
    TRADE_OFF,
    digressive_minimum,
    motorcycle,
    motorcycle_damping,
    quarter_car,
    quarter_car_damping,
)
from units import GRAVITY
from vehicle.commands import Feedback
from vehicle.energy import Scatter, ride_energy, scatter
from vehicle.energy_stage import OPEN, QUASI_IDEAL, REAL
from vehicle.indices import rms
from vehicle.printed_energy import PrintedEnergy, printed_energy
from vehicle.quarter_car import LqrWeights, groundhook, lqr, skyhook, spring_negation
from vehicle.ride import Run, Scenario, simulate, simulate_and_keep
from vehicle.road import IsoRoad, roughness_of_class
from vehicle.spectral import carpet, ensemble_indices, indices_from_rest, ride_of

FOLDER = PROJECT / "results" / "reference" / "benchmarks"
CAR, DURATION = quarter_car(), 15.0  # s
MAXIMUM, MINIMUM = quarter_car_damping()
COMMANDS = {"maximum": MAXIMUM, "minimum": MINIMUM, "LQR trade-off": lqr(CAR, TRADE_OFF),
            "LQR handling": lqr(CAR, HANDLING)}  # fmt: skip
SEEDS = range(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
HELD = (1e-3, 1e-2)  # s
SHOWN = ("battery.active", "shaft.active", "machine_loss", "mechanical_loss", "mount_loss", "friction_loss",
         "machine.apparent", "machine.factor", "shaft.factor", "shaft_duty.active", "machine_duty.active",
         "regenerating", "elastic", "inertial", "comfort", "road_holding", "closure")  # fmt: skip
PRINTED = {"battery.active": "electrical", "shaft.active": "mechanical", "machine_loss": "machine_loss",
           "mechanical_loss": "mechanical_loss", "machine.factor": "machine_power_factor",
           "shaft_duty.active": "shaft_active", "machine_duty.active": "machine_active",
           "regenerating": "regenerating", "elastic": "elastic", "inertial": "inertial", "comfort": "comfort",
           "road_holding": "road_holding"}  # fmt: skip


def scenario(seed: int, held: float, duration: float = DURATION, step: float = 5e-4) -> Scenario:
    """An ISO-B road at 70 km/h; held, duration, step [s]."""
    return Scenario("road", CRUISE_SPEED, duration, IsoRoad(roughness_of_class("B"), seed, held), time_step=step)


def run_of(command: str, actuator: str, road: Scenario) -> Run:
    """One of the nine cases; without force loop the minimum damping is the digressive guess."""
    if actuator == QUASI_IDEAL:
        return Run(CAR, COMMANDS[command], road, quasi_ideal())
    if actuator == REAL:
        return Run(CAR, COMMANDS[command], road, prototype(), FORCE_LOOP)
    return Run(CAR, digressive_minimum(), road, prototype())


def energy_table() -> pd.DataFrame:
    """One number of one case a row."""
    return pd.DataFrame([row for one in printed_energy() for held in HELD for row in _energies(one, held)])


def _energies(printed: PrintedEnergy, held: float) -> Iterator[dict[str, object]]:
    runs = [run_of(printed.command, printed.actuator, scenario(seed, held)) for seed in SEEDS]
    found: dict[str, Scatter] = scatter(simulate_and_keep(ride_energy, runs))
    print(f"{printed.command}, {printed.actuator}, {held:g} s", flush=True)
    for name in SHOWN:
        stated = getattr(printed, PRINTED[name], None) if name in PRINTED else None
        yield {
            "command": printed.command,
            "actuator": printed.actuator,
            "noise_held_s": held,
            "roads": len(SEEDS),
            "quantity": name,
            "mean": found[name].mean,
            "deviation": found[name].deviation,
            "printed": stated,
        }


def step_table() -> pd.DataFrame:
    """Works and force of 5 s with the step of the history, which bounds that of the integration."""
    cases = (("minimum", REAL), ("maximum", REAL), ("minimum", OPEN))
    return pd.DataFrame([row for case in cases for row in _steps(*case)])


def _steps(command: str, actuator: str) -> Iterator[dict[str, object]]:
    steps = (1e-3, 2.5e-4, 1.25e-4, 6.25e-5, 3.125e-5, 1.5625e-5)
    found = simulate([run_of(command, actuator, scenario(2, 1e-3, 5.0, step)) for step in steps])
    best = found[-1]
    for step, one in zip(steps, found, strict=True):
        force = best.suspension_force[:: round(step / steps[-1])]
        works = {
            f"{name}_work_error": getattr(one.inside, name)[-1] / getattr(best.inside, name)[-1] - 1
            for name in ("motor", "mount", "friction")
        }
        error = rms(one.suspension_force - force) / rms(force)
        yield {"command": command, "actuator": actuator, "step_s": step, "force_error_rms": error, **works}


@dataclass(frozen=True)
class CarpetCase:
    """A law over its settings."""

    name: str
    law: Callable[[float, float], Feedback]
    first: np.ndarray
    second: np.ndarray


def carpet_cases() -> Sequence[CarpetCase]:
    """The carpets of section 4.2.2 on the grids that follow from its printed settings."""
    c = 10 * 1000 ** (np.arange(50) / 49)
    hook, weight = 10 * 2000 ** (np.arange(50) / 49), 10 ** (8 * np.arange(50) / 49)
    return (
        CarpetCase("skyhook", skyhook, c, hook),
        CarpetCase("groundhook", groundhook, c, hook[:30]),
        CarpetCase(
            "spring negation", spring_negation, 10 * 1000 ** (np.arange(100) / 99), 23e3 ** (np.arange(100) / 99)
        ),
        CarpetCase("LQR", lambda stroke, wheel: lqr(CAR, LqrWeights(stroke, wheel)), weight, weight),
        CarpetCase("LQR, 10,000", lambda stroke, wheel: lqr(CAR, LqrWeights(stroke, wheel)), *2 * (weight_of(100),)),
    )


def weight_of(count: int) -> np.ndarray:
    """Weights over eight decades [kg/s^4], (count,)."""
    return 10 ** (8 * np.arange(count) / (count - 1))


def carpet_table() -> pd.DataFrame:
    """One carpet a row."""
    road = IsoRoad(roughness_of_class("B"), 0)
    return pd.DataFrame([_carpet(case, road) for case in carpet_cases()])


def _carpet(case: CarpetCase, road: IsoRoad) -> dict[str, object]:
    start = process_time()
    found = carpet(CAR, road, CRUISE_SPEED, case.law, case.first, case.second)
    seconds = process_time() - start
    comfort, holding = found.best(found.comfort), found.best(found.road_holding)
    row = {"carpet": case.name, "settings": found.comfort.size, "cpu_s": seconds}
    row |= dict(zip(("comfort_first", "comfort_second", "comfort_g"), comfort, strict=True))
    row |= dict(zip(("holding_first", "holding_second", "holding"), holding, strict=True))
    row["comfort_g"] = comfort[2] / GRAVITY
    print(f"{case.name}: {seconds:.1f} s", flush=True)
    return row | _sampled(case, road, holding)


def _sampled(case: CarpetCase, road: IsoRoad, best: tuple[float, float, float]) -> dict[str, object]:
    """How far 200 sampled rides of 40 s are from the covariance over the same time, at the best road holding."""
    ride = ride_of(CAR, case.law(*best[:2]), road, CRUISE_SPEED)
    expected, drawn = indices_from_rest(ride, 40.0), ensemble_indices(ride, 40.0, range(200), 1e-3)
    mean = np.sqrt(np.mean(drawn.road_holding**2)), np.sqrt(np.mean(drawn.comfort**2))
    return {
        "sampled_holding_error": mean[0] / expected.road_holding - 1,
        "sampled_comfort_error": mean[1] / expected.comfort - 1,
    }


def speed_table() -> pd.DataFrame:
    """CPU seconds of single runs, the second of each."""
    road = scenario(0, 1e-3, step=1e-3)
    bike = replace(road, duration=30.0)
    runs = {
        "15 s, quarter car, quasi-ideal": Run(CAR, MINIMUM, road, quasi_ideal()),
        "15 s, quarter car, real with force loop": Run(CAR, MINIMUM, road, prototype(), FORCE_LOOP),
        "30 s, motorcycle, ideal": Run(motorcycle(), motorcycle_damping()[0], bike),
    }
    return pd.DataFrame([{"run": name, "cpu_s": _seconds(run)} for name, run in runs.items()])


def _seconds(run: Run) -> float:
    simulate([run])
    start = process_time()
    simulate([run])
    return process_time() - start


def main() -> None:
    """All tables."""
    tables = {"speed": speed_table, "steps": step_table, "carpets": carpet_table, "energy": energy_table}
    for name, make in tables.items():
        make().to_csv(FOLDER / f"actuator_{name}.csv", index=False, float_format="%.6g")


if __name__ == "__main__":
    main()
