"""An obstacle seen ahead against the LQR: ``python -m benchmarks.preview_control``.

The thesis's quarter car with its prototype (mass, friction, mount with play, torque lag, torque limit) and force loop
over the pothole of 50 mm at 50 km/h, with stops at 80 mm, which the thesis does not print. The plan is made on the
linear car with a rigid actuator and driven in the whole model, a feedback of the LQR holding it to the plan.

Writes results/reference/benchmarks/preview_control.csv (and .png).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from time import process_time

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from figures.style import BLACK, GREY, SERIES, letter, new_figure, save_png, show_grid, styled
from pipeline.modules import PROJECT
from tests.actuator.thesis import FORCE_LOOP, PEAK_TORQUE, prototype
from units import GRAVITY, MILLIMETRE
from vehicle.energy import ride_energy
from vehicle.models import EndStops
from vehicle.preview import Plan, PreviewTask, PreviewWeights, force_limits, plan, with_preview
from vehicle.printed_car import HANDLING, PRINTED_CAR, TRADE_OFF
from vehicle.quarter_car import LqrWeights, lqr
from vehicle.ride import RideHistory, Run, Scenario, simulate
from vehicle.road import Obstacle, read_obstacle_shape
from vehicle.tables import DATA

FOLDER = PROJECT / "results" / "reference" / "benchmarks"
CAR = replace(PRINTED_CAR, stops=EndStops(-0.08, 0.08, 1e6))
SPEED, DEPTH, DURATION = 50 / 3.6, -0.05, 1.5  # m/s and m: Table 3.5; s
STEP, SAMPLE = 1e-4, 1e-3  # s, of the history and of the controller
SEEN = (0.0, 0.2, 0.5)  # s
SETTINGS = {"trade-off": TRADE_OFF, "handling": HANDLING}
DEVICE = prototype()
TORQUE_CONSTANT = 42.7e-3  # Nm/A, identified value of Table 4.2


@dataclass(frozen=True, eq=False)
class Driven:
    """A run; ahead: preview [s], None for the LQR alone; seconds: of the plan, CPU."""

    setting: str
    ahead: float | None
    history: RideHistory
    plan: Plan | None
    seconds: float


def driven(setting: str, weights: LqrWeights, ahead: float | None) -> Driven:
    """One run over the pothole."""
    feedback = lqr(CAR, weights)
    pothole = Scenario("pothole", SPEED, DURATION, Obstacle(read_obstacle_shape(DATA / "obstacle.csv"), DEPTH),
                       time_step=STEP)  # fmt: skip
    if ahead is None:
        return Driven(setting, None, simulate([Run(CAR, feedback, pothole, DEVICE, FORCE_LOOP)])[0], None, 0.0)
    scenario = with_preview(pothole, ahead)
    weighed = PreviewWeights(weights.wheel / CAR.sprung_mass, weights.stroke / CAR.sprung_mass)
    start = process_time()
    found = plan(PreviewTask(CAR, DEVICE, scenario.road, SPEED, scenario.duration, weighed))
    spent = process_time() - start
    run = Run(CAR, found.controller(feedback, SAMPLE), scenario, DEVICE, FORCE_LOOP)
    return Driven(setting, ahead, simulate([run])[0], found, spent)


def row(one: Driven) -> dict[str, object]:
    """Of the table; felt: the root of the time integral of the squared weighted acceleration."""
    history, inside = one.history, one.history.inside
    felt = float(np.sqrt(np.trapezoid(history.weighted_acceleration**2, history.time)))
    states = np.array([history.stroke, 0 * history.stroke, history.velocity, 0 * history.velocity])
    lowest, highest = force_limits(DEVICE, states)
    force = inside.torque / DEVICE.ratio.nominal
    return {
        "setting": one.setting,
        "preview_s": np.nan if one.ahead is None else one.ahead,
        "felt_m_per_s1p5": felt,
        "acceleration_peak_g": float(np.abs(history.body_acceleration).max()) / GRAVITY,
        "least_tyre_load_N": float(history.tyre_loads.min()),
        "stroke_bump_mm": float(history.stroke.min()) / MILLIMETRE,
        "stroke_rebound_mm": float(history.stroke.max()) / MILLIMETRE,
        "motor_torque_peak_Nm": float(np.abs(inside.torque).max()),
        "current_peak_A": float(np.abs(inside.torque).max()) / TORQUE_CONSTANT,
        "share_of_the_limit": float(np.max(np.abs(force) / np.where(force > 0, highest, -lowest).clip(1.0))),
        "to_battery_J": ride_energy(history).battery.active * float(history.time[-1]),
        "planned_overtravel_mm": np.nan if one.plan is None else one.plan.overtravel / MILLIMETRE,
        "plan_cpu_s": one.seconds,
    }


def runs() -> Iterator[Driven]:
    """LQR alone, then with every preview, for both settings."""
    for setting, weights in SETTINGS.items():
        for ahead in (None, *SEEN):
            yield driven(setting, weights, ahead)


@styled
def picture(found: list[Driven]) -> Figure:
    """Trade-off setting: acceleration, tyre load, stroke and motor force over the time from the edge of the pothole."""
    figure = new_figure(6.4)
    axes = figure.subplots(2, 2, sharex=True).flatten()
    for one, colour in zip([one for one in found if one.setting == "trade-off"], SERIES):
        history, begun = one.history, one.ahead or 0.0
        words = "LQR" if one.ahead is None else f"seen {one.ahead:g} s ahead"
        rows = (history.body_acceleration / GRAVITY, history.tyre_loads[0], history.stroke / MILLIMETRE,
                history.inside.torque / DEVICE.ratio.nominal)  # fmt: skip
        for axis, values in zip(axes, rows):
            axis.plot(history.time - begun, values, color=colour, label=words, linewidth=1.2)
    for axis, words in zip(axes, ("body acceleration / g", "tyre load / N", "stroke / mm", "motor force / N")):
        axis.set(ylabel=words, xlim=(-max(SEEN), 1.0))
        axis.axvline(0.0, color=GREY, linewidth=0.8)
    for axis, ends in ((axes[2], (-80.0, 80.0)), (axes[3], [s * PEAK_TORQUE / DEVICE.ratio.nominal for s in (-1, 1)])):
        for end in ends:
            axis.axhline(end, color=BLACK, linestyle="--", linewidth=0.8)
    for axis in axes[2:]:
        axis.set(xlabel="time from the edge / s")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    letter(axes)
    show_grid(*axes)
    return figure


def main() -> None:
    """Run, write, draw."""
    found = list(runs())
    table = pd.DataFrame([row(one) for one in found])
    table.to_csv(FOLDER / "preview_control.csv", index=False, float_format="%.4g")
    save_png(picture(found), FOLDER / "preview_control.png")
    print(table.to_string(index=False))


if __name__ == "__main__":
    main()
