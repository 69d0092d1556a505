"""The actuator of a study in the thesis's quarter car, for people: Tables 4.6 to 4.14 row by row beside the printed."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from figures.energy import powers_over_time, working_points
from figures.files import File, figure_file, picture_name, table_file
from figures.quarter_car import beside_the_thesis, car_inputs, comfort_setting, lent_powers, vehicle_over_time
from figures.report import Part, Picture, Section, Table
from report.energy import stand_ins
from units import GRAVITY
from vehicle.energy import Scatter, scatter
from vehicle.energy_stage import QUASI_IDEAL, REAL, EnergyCase, EnergyOutcome
from vehicle.printed_car import PRINTED_CAR, PRINTED_DAMPING, PRINTED_SPEED, printed_road
from vehicle.printed_energy import PrintedEnergy, printed_energy
from vehicle.quarter_car_stage import SEEDS, QuarterCarRides
from vehicle.shaken import PRINTED, SHAKING
from vehicle.spectral import mean_power_theorem

TABLE = "quarter_car.csv"
INPUTS, TIME, POINTS, CAR = "quarter_car_inputs", "quarter_car_over_time", "quarter_car_points", "quarter_car_vehicle"
QUASI_TIME, QUASI_POINTS = "quarter_car_quasi_over_time", "quarter_car_quasi_points"
ALONE, ALONE_POINTS = "quarter_car_without_loop", "quarter_car_without_loop_points"
COMFORT, BESIDE = "quarter_car_comfort_setting", "quarter_car_beside"
SHAKEN, SHAKEN_POINTS, LENT = "quarter_car_shaken", "quarter_car_shaken_points", "quarter_car_lent"
_PERCENT = 100.0


def files(found: QuarterCarRides) -> Iterator[File]:
    """Every row of the tables beside the printed one, and the figures."""
    yield table_file(TABLE, every_table(found))
    yield figure_file(INPUTS, car_inputs(PRINTED_DAMPING, printed_road(SEEDS[0])))
    yield figure_file(QUASI_TIME, powers_over_time(found.energy, QUASI_IDEAL))
    yield figure_file(QUASI_POINTS, working_points(found.energy, QUASI_IDEAL))
    yield figure_file(TIME, powers_over_time(found.energy))
    yield figure_file(POINTS, working_points(found.energy))
    yield figure_file(ALONE, powers_over_time(found.alone))
    yield figure_file(ALONE_POINTS, working_points(found.alone))
    yield figure_file(CAR, vehicle_over_time(found.energy))
    yield figure_file(COMFORT, comfort_setting(found))
    yield figure_file(SHAKEN, powers_over_time(found.shaken))
    yield figure_file(SHAKEN_POINTS, working_points(found.shaken))
    yield figure_file(LENT, lent_powers(found.shaken))
    yield figure_file(BESIDE, beside_the_thesis(found.energy, printed_energy()))


def section(found: QuarterCarRides) -> Section:
    """What the tables of chapter 4 become with the actuator of the study."""
    return Section(
        "In the thesis's quarter car",
        (_text(), *stand_ins(found.energy), *_energies(found), *_RIDES, *_car(found), *_under_a_force(found.shaken)),
    )


def _energies(found: QuarterCarRides) -> tuple[Part, ...]:
    """What is driven, and the tables of its powers beside the printed ones."""
    return (
        Picture(picture_name(INPUTS), "Dampings (a), straight lines in the place of Fig. 4.21; first road (b) "
                "(Fig. 4.22)."),
        *(Table(beside(found, kind), words) for kind, words in _KINDS),
        Picture(picture_name(BESIDE), "Means over six roads; marks: the thesis's prototype, one road "
                "(Figs 4.54, 4.55)."),
    )  # fmt: skip


_RIDES = (
    Picture(picture_name(QUASI_TIME), "Force and power with the quasi-ideal actuator (Figs 4.23, 4.26, 4.29, 4.32)."),
    Picture(picture_name(QUASI_POINTS), "Its working points at suspension and rotor (Figs 4.25, 4.31, 4.34)."),
    Picture(picture_name(TIME), "Force and power with the real actuator (Figs 4.40, 4.43, 4.46, 4.49)."),
    Picture(picture_name(POINTS), "Its working points at suspension and rotor (Figs 4.42, 4.45, 4.48, 4.51)."),
    Picture(picture_name(ALONE), "Minimum damping without the force loop (Fig. 4.52)."),
    Picture(picture_name(ALONE_POINTS), "Working points without the force loop (Fig. 4.53)."),
)


def _car(found: QuarterCarRides) -> tuple[Part, ...]:
    """What tyre, body, spring and mass do meanwhile."""
    return (
        Picture(picture_name(CAR), "Tyre load, acceleration as it is felt, and what spring and mass take and give "
                "back (Figs 4.24, 4.27, 4.30, 4.33, 4.40d, 4.41, 4.44, 4.47, 4.50)."),
        Picture(picture_name(COMFORT), _lifted(found)),
    )  # fmt: skip


def _under_a_force(shaken: EnergyOutcome) -> tuple[Part, ...]:
    return (
        Table(shaken_table(shaken), f"A force of {SHAKING.amplitude:g} N at {SHAKING.frequency:g} Hz on the body, "
              "maximum damping, printed numbers behind the bar (text to Figs 4.35 to 4.39)."),
        Picture(picture_name(SHAKEN), "Force and power under the harmonic force (Figs 4.35 and 4.37)."),
        Picture(picture_name(SHAKEN_POINTS), "Working points at suspension and rotor (Figs 4.36 and 4.38)."),
        Picture(picture_name(LENT), "What spring and mass take and give back (Fig. 4.39)."),
    )  # fmt: skip


_KINDS = (
    (QUASI_IDEAL, "Quasi-ideal actuator: Tables 4.6 to 4.9, printed numbers behind the bar."),
    (REAL, "Real actuator with its force loop: Tables 4.10 to 4.13, printed numbers behind the bar."),
    ("real, no force loop", "Without the force loop: Table 4.14, printed numbers behind the bar."),
)


def shaken_table(found: EnergyOutcome) -> pd.DataFrame:
    """Under the harmonic force, one quantity a row, one friction a column: here | printed."""
    columns = {case.command: _shaken_column(case) for case in found.cases}
    return pd.DataFrame(columns).rename_axis("quantity").reset_index()


def _shaken_column(case: EnergyCase) -> dict[str, str]:
    (one,), printed = case.energies, PRINTED[case.command]
    rows = (
        ("active, suspension / W", one.shaft.active, printed.mechanical),
        ("electrical power / W", one.battery.active, printed.electrical),
        ("passive duty, suspension / %", _PERCENT * (1 - one.shaft_duty.active), _PERCENT * printed.shaft_passive),
        ("passive duty, machine / %", _PERCENT * (1 - one.machine_duty.active), _PERCENT * printed.machine_passive),
        ("power factor, suspension", one.shaft.factor, printed.shaft_factor),
        ("power factor, machine shaft", one.machine.factor, printed.machine_factor),
    )
    return {words: _both({"here": here, "printed": stated}) for words, here, stated in rows}


def _text() -> str:
    road = printed_road(0)
    theorem = mean_power_theorem(PRINTED_CAR.tyre_stiffness, road.road, PRINTED_SPEED)  # type: ignore[arg-type]
    return (
        "The actuator of this study where the thesis drove its own: its quarter car (Table 4.4), the ISO B road at "
        f"70 km/h for 15 s, once with each of six seeds, and its commands. Any stabilising law takes {theorem:.2f} W "
        "from that road on the long run, whatever the actuator; what differs from the printed numbers is the machine, "
        "the gears, the mass, the mount and the loop, and a scatter of 1 to 2 W over roads. The thesis's damper curves "
        "are figures: their steepest part stands here."
    )


def _lifted(found: QuarterCarRides) -> str:
    off = np.asarray(found.comfort.time)[np.asarray(found.comfort.tyre_load) <= 0]
    words = f"the wheel lifts from {off[0]:.1f} s on" if off.size else "the wheel stays on this road"
    return f"The comfort-oriented LQR in the non-linear car, quasi-ideal actuator: {words} (Fig. 4.28: from 10 s)."


def every_table(found: QuarterCarRides) -> pd.DataFrame:
    """One row of one printed table a row: here, its scatter over the roads, printed."""
    return pd.DataFrame([row for printed, case in _pairs(found) for row in _rows(printed, case)])


def beside(found: QuarterCarRides, actuator: str) -> pd.DataFrame:
    """One quantity a row, one command a column: here | printed."""
    columns: dict[str, dict[str, str]] = {}
    for printed, case in _pairs(found):
        if printed.actuator == actuator:
            columns[printed.command] = {str(row["quantity"]): _both(row) for row in _rows(printed, case)}
    frame = pd.DataFrame(columns)
    return frame.rename_axis("quantity").reset_index()


def _both(row: dict[str, object]) -> str:
    printed = "" if row["printed"] is None else f"{row['printed']:.3g}"
    return f"{row['here']:.3g} | {printed}".rstrip(" |") if printed else f"{row['here']:.3g}"


def _pairs(found: QuarterCarRides) -> Iterator[tuple[PrintedEnergy, EnergyCase]]:
    cases = {(case.command, case.actuator): case for case in found.energy.cases}
    for printed in printed_energy():
        yield printed, cases[printed.command, printed.actuator]


def _rows(printed: PrintedEnergy, case: EnergyCase) -> Iterator[dict[str, object]]:
    values = scatter(case.energies)
    for name, (key, unit, stated) in _QUANTITIES.items():
        value, beside = _value(values, key, case), getattr(printed, stated)
        yield {
            "table": printed.table, "command": printed.command, "actuator": printed.actuator, "quantity": name,
            "here": value.mean / unit, "deviation": value.deviation / unit,
            "printed": None if beside is None else beside / unit,
        }  # fmt: skip


def _value(values: dict[str, Scatter], key: str, case: EnergyCase) -> Scatter:
    if key != "peak_electrical":
        return values[key]
    peaks = [one.peak_electrical for one in case.energies]
    return Scatter(max(peaks, key=abs), float(np.std(peaks, ddof=1)) if len(peaks) > 1 else float("nan"))


# Heading of a row -> number of ``vehicle.energy.scatter``, its unit, field of ``PrintedEnergy``. The mechanical element
# of the thesis is friction here, the gears apart.
_QUANTITIES = {
    "electrical power / W": ("battery.active", 1.0, "electrical"),
    "peak electrical power / W": ("peak_electrical", 1.0, "peak_electrical"),
    "apparent, machine shaft / W": ("machine.apparent", 1.0, "machine_apparent"),
    "active, machine shaft / W": ("machine.active", 1.0, "machine_power"),
    "power factor, machine shaft": ("machine.factor", 1.0, "machine_power_factor"),
    "apparent, suspension / W": ("shaft.apparent", 1.0, "shaft_apparent"),
    "active, suspension / W": ("shaft.active", 1.0, "mechanical"),
    "power factor, suspension": ("shaft.factor", 1.0, "shaft_power_factor"),
    "loss of the machine / W": ("machine_loss", 1.0, "machine_loss"),
    "loss of the mechanics / W": ("mechanical_loss", 1.0, "mechanical_loss"),
    "loss of the mount / W": ("mount_loss", 1.0, "mount_loss"),
    "loss of friction / W": ("friction_loss", 1.0, "element_loss"),
    "active duty, suspension / %": ("shaft_duty.active", 1 / _PERCENT, "shaft_active"),
    "active duty, machine / %": ("machine_duty.active", 1 / _PERCENT, "machine_active"),
    "regenerating / %": ("regenerating", 1 / _PERCENT, "regenerating"),
    "reactive, mount / W": ("elastic", 1.0, "elastic"),
    "reactive, mass / W": ("inertial", 1.0, "inertial"),
    "comfort / g": ("comfort", GRAVITY, "comfort"),
    "road holding": ("road_holding", 1.0, "road_holding"),
}
