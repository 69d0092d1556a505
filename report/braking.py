"""The machine as a brake for people: up to which speed the damping holds that is asked for, and what the voltage is."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from drivetrain.output import Output, in_unit, labelled
from electrical.braking import Braking
from electrical.braking_stage import BrakingOutcome
from figures.braking import braking_over_speed
from figures.files import File, figure_file, picture_name, table_file
from figures.report import Picture, Remark, Section, Table
from units import written

TABLE, FIGURE = "braking.csv", "braking"


def files(found: BrakingOutcome, output: Output) -> Iterator[File]:
    """Damping, effort and currents over the speed of the output, and their figure."""
    yield table_file(TABLE, braking_table(found, output))
    yield figure_file(FIGURE, braking_over_speed(found, output))


def section(found: BrakingOutcome, output: Output) -> Section:
    """How the machine brakes over speed, and up to where it does what is asked."""
    return Section(
        "Braking over speed",
        (
            _text(found, output),
            *(Remark(line) for line in remarks(found, output)),
            Table(summary_table(found, output), f"The brake {output.place}; the whole curves are in {TABLE}."),
            Picture(
                picture_name(FIGURE),
                f"Damping, {output.effort} and phase current over the {output.speed}{_lines(found)}.",
            ),
        ),
    )


def braking_table(found: BrakingOutcome, output: Output) -> pd.DataFrame:
    """One speed a row, in drawing units."""
    columns: dict[str, object] = {f"{output.speed}_{output.speed_unit}": in_unit(found.speed, output.speed_unit)}
    for name, one in _named(found).items():
        columns[f"damping_{name}_{output.damping_unit}"] = in_unit(found.damping(one), output.damping_unit)
        columns[f"{output.effort}_{name}_{output.effort_unit}"] = in_unit(
            one.torque / found.demand.ratio, output.effort_unit
        )
        columns[f"i_d_{name}_A"], columns[f"i_q_{name}_A"] = one.i_d, one.i_q
    return pd.DataFrame(columns)


def summary_table(found: BrakingOutcome, output: Output) -> pd.DataFrame:
    """At the slowest speed, at the RMS speed and where it brakes most, one way of braking a row."""
    return pd.DataFrame([_row(name, one, found, output) for name, one in _named(found).items()])


def _named(found: BrakingOutcome) -> dict[str, Braking]:
    return {"shorted_cold": found.cold, "shorted_hot": found.hot, "controlled_hot": found.controlled}


def _row(name: str, one: Braking, found: BrakingOutcome, output: Output) -> dict[str, object]:
    damping, unit = found.damping(one), output.damping_unit
    at_rms = np.interp(found.demand.speed_rms, found.speed, damping)
    row = {
        "brake": name.replace("_", ", "),
        labelled(f"damping at {output.at_speed(found.speed[0])}", unit): in_unit(damping[0], unit),
        labelled(f"damping at {output.at_speed(found.demand.speed_rms)}", unit): in_unit(at_rms, unit),
        labelled(f"largest {output.effort}", output.effort_unit): in_unit(
            np.nanmax(one.torque) / found.demand.ratio, output.effort_unit
        ),
        "largest d-axis current against the magnets / A": -np.nanmin(one.i_d),
    }
    if found.demand.damping:
        row["holds up to"] = _held(found, one, output)
    return row


def _held(found: BrakingOutcome, one: Braking, output: Output) -> str:
    """Up to which speed, in words."""
    speed = found.held_up_to(one)
    return output.at_speed(speed) if speed else "no speed"


def _text(found: BrakingOutcome, output: Output) -> str:
    cold, hot = (output.at_speed(pole) for pole in found.poles)
    return (
        f"With shorted phases the machine brakes in proportion to the {output.speed} only well below its electrical "
        f"pole, where it brakes most: {cold} at {found.heat.cold:g} °C of the copper, {hot} at {found.heat.hot:g} °C. "
        "Beyond, the current weakens the magnets and the braking falls. Controlled, it brakes with the largest "
        f"{output.effort} that current and voltage allow. All from the flux map, without iron loss and friction."
    )


def _lines(found: BrakingOutcome) -> str:
    """What is drawn where a damping is asked for."""
    return "; dotted what is asked for, grey the RMS value" if found.demand.damping else ""


def remarks(found: BrakingOutcome, output: Output) -> Iterator[str]:
    """What the run says at once: up to where the damping holds, and a back-EMF beyond the bus."""
    demand, unit = found.demand, output.damping_unit
    if demand.damping:
        asked = f"{in_unit(demand.damping, unit):.4g} {written(unit)}"
        cold, hot, controlled = (_held(found, one, output) for one in (found.cold, found.hot, found.controlled))
        yield (
            f"The {asked} asked for hold up to: {cold} with shorted phases at {found.heat.cold:g} °C, {hot} at "
            f"{found.heat.hot:g} °C, {controlled} controlled."
        )
    if found.back_emf > found.bus_voltage:
        yield (
            f"At {output.at_speed(demand.speed_peak)} the back-EMF is {found.back_emf:.0f} V peak from line to line on "
            f"a bus of {found.bus_voltage:.0f} V: switches, capacitor and diodes must stand it when the control stops."
        )
