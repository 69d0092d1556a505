"""The energy of the ride for people: powers, duties and efficiencies with their scatter, and the force loop."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from control.force_loop import ForceLoop
from figures.energy import (
    force_loop,
    powers_over_time,
    temperatures_under_the_ride,
    where_the_power_goes,
    working_points,
)
from figures.files import File, figure_file, picture_name, table_file
from figures.report import Picture, Remark, Section, Table
from units import FACTORS, GRAVITY
from vehicle.demands import RideCase
from vehicle.designed import PROTOTYPE_LAG, PROTOTYPE_LOOP, PROTOTYPE_MOUNT
from vehicle.energy import Scatter, scatter
from vehicle.energy_stage import (
    QUASI_IDEAL,
    REAL,
    WANTED_BANDWIDTH,
    WANTED_MARGIN,
    EnergyCase,
    EnergyOutcome,
)
from vehicle.models import QuarterCar
from vehicle.printed_energy import PrintedEnergy, printed_energy

TABLE = "energy.csv"
TIME, POINTS, POWERS, LOOP = "energy_over_time", "energy_points", "energy_powers", "energy_loop"
HEAT = "energy_temperatures"
_HOUR = 3600.0  # s
_GENEROUS = 0.05  # of the wanted bandwidth or margin
_LOST = 0.01  # of the mechanical power, which the balance may leave open


def files(found: EnergyOutcome) -> Iterator[File]:
    """Every number of every case with its scatter, and the figures."""
    yield table_file(TABLE, whole_table(found))
    yield figure_file(TIME, powers_over_time(found))
    yield figure_file(POINTS, working_points(found))
    yield figure_file(POWERS, where_the_power_goes(found))
    yield figure_file(LOOP, force_loop(found))
    if found.temperatures:
        yield figure_file(HEAT, temperatures_under_the_ride(found))


def section(found: EnergyOutcome, case: RideCase) -> Section:
    """Where the energy of the ride goes."""
    return Section(
        "Energy on the road",
        (
            _text(found),
            *stand_ins(found),
            *(Remark(line) for line in remarks(found)),
            Table(power_table(found), f"Mean powers over the random road; ± over the roads. All of it is in {TABLE}."),
            Picture(
                picture_name(POWERS),
                "Where the power goes, but for what swings by itself. To the left: power that the battery gives.",
            ),
            Table(duty_table(found), "Duty, power factors and what the ride becomes, means over the roads."),
            Picture(picture_name(TIME), "Some seconds of the first road, real actuator."),
            Picture(picture_name(POINTS), "Working points of the same time at suspension and rotor."),
            Table(loop_table(found), _loop_words(found.own.loop)),
            Picture(picture_name(LOOP), "The force loop with the output held, about three forces of the mount."),
            *_temperatures(found),
            *_printed(case),
        ),
    )


def stand_ins(found: EnergyOutcome) -> Iterator[str]:
    """Which parts of the actuator are another's, because the study states none of its own."""
    own = found.own
    taken = {"mount": own.actuator.mount == PROTOTYPE_MOUNT, "force loop": own.loop == PROTOTYPE_LOOP,
             "torque lag": own.actuator.drive.time_constant == PROTOTYPE_LAG}  # fmt: skip
    if names := [name for name, same in taken.items() if same]:
        yield (
            f"The numbers of {', '.join(names)} are those of the thesis's automotive prototype (Tables 4.2 and 4.5), "
            "stand-ins until this actuator is measured; [actuator] in the study states its own."
        )


def remarks(found: EnergyOutcome) -> Iterator[str]:
    """What must not be overlooked: a battery that is emptied, a loop that is slower or less damped than it should."""
    taking = [case for case in found.cases if case.actuator == REAL and _mean(case, "battery.active") < 0]
    if taking:
        names = ", ".join(f"{case.command} ({-_mean(case, 'battery.active'):.1f} W)" for case in taking)
        yield f"On the random road the real actuator takes power from the battery with: {names}."
    swinging = [f"{case.command} ({case.actuator})" for case in found.cases if case.swings]
    if swinging:
        yield f"The actuator swings by itself with: {', '.join(swinging)}."
    weak = [point for point in found.loop if point.phase_margin < (1 - _GENEROUS) * WANTED_MARGIN]
    if weak:
        forces = ", ".join(f"{np.degrees(point.phase_margin):.0f}° about {point.force:g} N" for point in weak)
        wanted = f"{np.degrees(WANTED_MARGIN):.0f}°"
        yield f"The force loop has less than {wanted} of phase margin: {forces} ([actuator] loop_...)."
    open_ = max(abs(one.closure) for case in found.cases for one in case.energies)
    if open_ > _LOST:
        yield f"The balance of energy leaves up to {100 * open_:.2g} % open: the history is sampled too coarsely."


def whole_table(found: EnergyOutcome) -> pd.DataFrame:
    """One case a row; mean and standard deviation of everything, in SI."""
    rows = []
    for case in found.cases:
        values = {
            f"{name.replace('.', '_')}{end}": getattr(value, kind)
            for name, value in scatter(case.energies).items()
            for end, kind in (("", "mean"), ("_deviation", "deviation"))
        }
        rows.append({"command": case.command, "actuator": case.actuator, "roads": len(case.energies), **values})
    return pd.DataFrame(rows)


def power_table(found: EnergyOutcome) -> pd.DataFrame:
    """Mean powers, one case a row."""
    return pd.DataFrame([_powers(case) for case in found.cases])


def _powers(case: EnergyCase) -> dict[str, object]:
    values = scatter(case.energies)
    return {
        "command": case.command,
        "actuator": case.actuator,
        "from suspension / W": _with_scatter(values["shaft.active"]),
        "mount / W": values["mount_loss"].mean,
        "gears / W": values["gear_loss"].mean,
        "friction / W": values["friction_loss"].mean,
        "machine / W": values["machine_loss"].mean,
        "to battery / W": _with_scatter(values["battery.active"]),
        "efficiency": _efficiency(case),
        "peak electrical / W": max((one.peak_electrical for one in case.energies), key=abs),
    }


def _with_scatter(value: Scatter) -> str:
    return f"{value.mean:.1f}" if np.isnan(value.deviation) else f"{value.mean:.1f} ± {value.deviation:.1f}"


def _efficiency(case: EnergyCase) -> str:
    share = _mean(case, "battery.active") / _mean(case, "shaft.active")
    return f"{100 * share:.0f} %" if share >= 0 else "< 0"


def duty_table(found: EnergyOutcome) -> pd.DataFrame:
    """Shares of the time, power factors, reactive powers, comfort and road holding, one case a row."""
    return pd.DataFrame([_duties(case) for case in found.cases])


def _duties(case: EnergyCase) -> dict[str, object]:
    mean = {name: value.mean for name, value in scatter(case.energies).items()}
    return {
        "command": case.command,
        "actuator": case.actuator,
        "active, suspension / %": 100 * mean["shaft_duty.active"],
        "active, machine / %": 100 * mean["machine_duty.active"],
        "regenerating / %": 100 * mean["regenerating"],
        "power factor, suspension": mean["shaft.factor"],
        "power factor, machine": mean["machine.factor"],
        "apparent, battery / W": mean["battery.apparent"],
        "elastic / W": mean["elastic"],
        "inertial / W": mean["inertial"],
        "comfort / g": mean["comfort"] / GRAVITY,
        "road holding": mean["road_holding"],
    }


def loop_table(found: EnergyOutcome) -> pd.DataFrame:
    """The loop about the working forces, and the one that would have what is wanted."""
    return pd.DataFrame(
        [
            {
                "force / N": point.force,
                "mount / (kN/m)": point.stiffness / FACTORS["kN_per_m"],
                "bandwidth / Hz": point.bandwidth,
                "phase margin / °": np.degrees(point.phase_margin),
                f"loop for {WANTED_BANDWIDTH:g} Hz and {np.degrees(WANTED_MARGIN):.0f}°": _gains(point.designed),
            }
            for point in found.loop
        ]
    )


def _gains(loop: ForceLoop | None) -> str:
    if loop is None:
        return "no PID has them"
    ms = loop.derivative / FACTORS["ms"]
    return f"P {loop.proportional:.2g}, I {loop.integral:.4g} 1/s, D {ms:.2g} ms, N {loop.filter:.4g} rad/s"


def _loop_words(loop: ForceLoop) -> str:
    return (
        f"The force loop ({_gains(loop)}) with the output held; bandwidth: where the closed loop first falls by 3 dB."
    )


def _temperatures(found: EnergyOutcome) -> Iterator[Table | Picture]:
    """How warm the machine becomes, where that is known."""
    if found.temperatures:
        rows = [
            {
                "command": one.command,
                "copper after an hour / °C": float(np.interp(_HOUR, one.time, one.copper)),
                "magnets after an hour / °C": float(np.interp(_HOUR, one.time, one.magnets)),
                "hottest copper in the end / °C": one.hottest_copper,
            }
            for one in found.temperatures
        ]
        yield Table(pd.DataFrame(rows), "Temperatures with the losses of the first road, real actuator.")
        yield Picture(picture_name(HEAT), "Warming up under the mean losses of the first road.")


def _printed(case: RideCase) -> Iterator[Table]:
    """The thesis's own tables beside those of a quarter car."""
    if isinstance(case.vehicle, QuarterCar):
        rows = pd.DataFrame([_printed_row(one) for one in printed_energy()])
        yield Table(rows, "The prototype of the thesis in its quarter car (Tables 4.6-4.14), one road of 15 s.")


def _printed_row(one: PrintedEnergy) -> dict[str, object]:
    return {
        "command": one.command,
        "actuator": one.actuator,
        "from suspension / W": one.mechanical,
        "mechanics / W": np.nan if one.mechanical_loss is None else one.mechanical_loss,
        "machine / W": one.machine_loss,
        "to battery / W": one.electrical,
        "active, machine / %": 100 * one.machine_active,
        "regenerating / %": 100 * one.regenerating,
        "power factor, machine": np.nan if one.machine_power_factor is None else one.machine_power_factor,
        "comfort / g": one.comfort / GRAVITY,
        "road holding": one.road_holding,
    }


def _mean(case: EnergyCase, name: str) -> float:
    return scatter(case.energies)[name].mean


def _text(found: EnergyOutcome) -> str:
    actuator = found.own.actuator
    driven, driving = actuator.gears.driven, actuator.gears.driving
    ratios = actuator.ratio.value
    span = f"{min(ratios) * 1e3:.2f} to {max(ratios) * 1e3:.2f}" if len(ratios) > 1 else f"{ratios[0] * 1e3:.2f}"
    return (
        f"The random road with the designed actuator: motor and drive on flux map and loss map, {span} mm/rad of "
        f"transmission, meshes of {100 * driven:.1f} % driven and {100 * driving:.1f} % driving, "
        f"{actuator.equivalent_mass:.1f} kg behind the compliant mount, and a force loop. Beside it the {QUASI_IDEAL} "
        "one: the same motor and ratio without mass, friction and mount. Power is positive from the suspension to the "
        "battery; what a mount or a mass returns is reactive. Means of several roads that differ by their seed."
    )
