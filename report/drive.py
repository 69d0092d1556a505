"""The wound machine over speed for people: envelope, neighbouring windings by both models, the plane at the output."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd

from drivetrain.output import Output
from drivetrain.requirements import Requirements, Transmission, shaft_demand
from electrical.dq import Envelope
from electrical.drive_stage import DriveOutcome, Neighbour
from electrical.winding_design import WindingDesign
from electrical.winding_stage import WindingOutcome
from figures.files import File, figure_file, picture_name, table_file
from figures.flux_map import FLUX_MAP_CAPTION, field_envelope, flux_maps
from figures.report import Picture, Section, Table
from figures.winding import RequiredPoint, WheelPoint, force_velocity, torque_speed
from magnetostatics.flux_map_stage import FluxMap
from units import RPM, drawn, split_unit

ENVELOPE, WINDINGS = "flux_map_envelope.csv", "windings_field.csv"
_SHOWN = 1  # turns either side of the chosen winding in the figure of envelopes
_BOTH = ("base_speed_rpm", "power_at_base_speed_W", "maximum_power_W", "peak_torque_Nm")
_OF_ENVELOPE = ("torque_Nm", "power_W", "i_d_A", "i_q_A")


def files(
    found: DriveOutcome,
    winding: WindingOutcome,
    flux_map: FluxMap,
    transmission: Transmission,
    required: Requirements,
    output: Output,
) -> Iterator[File]:
    """Torque over speed, windings by both models, and the figures."""
    yield table_file(ENVELOPE, envelope_table(found))
    yield table_file(WINDINGS, windings_table(found, winding))
    machine, limits = winding.wound.on_map(flux_map.data), winding.limits
    yield figure_file("flux_map", flux_maps(machine, found.field, limits.current_peak))
    title = _name(found.neighbour(winding.chosen.design))
    yield figure_file("field_envelope", field_envelope(found.field.envelope, found.constant.envelope, title=title))
    demand = _demand(required, transmission, output)
    yield figure_file("torque_speed", torque_speed(*_envelopes(found, winding), demand))
    shown: dict[str, Any] = {"output": output, "title": title, "required": demands(required, output), "limits": limits}
    planes = {"force_velocity": found.constant.plane, "force_velocity_field": found.field.plane}
    for name, plane in planes.items():
        yield figure_file(name, force_velocity(plane, transmission.nominal, **shown))


def section(found: DriveOutcome, winding: WindingOutcome, output: Output) -> Section:
    """What the wound machine does over speed, and what constant parameters would have said."""
    table = windings_table(found, winding)
    return Section(
        "The wound machine on its flux map",
        (
            _text(found, winding),
            Picture(picture_name("flux_map"), FLUX_MAP_CAPTION),
            Picture(
                picture_name("field_envelope"), "Torque and power over speed: flux map against constant parameters."
            ),
            Picture(
                picture_name("torque_speed"), "Largest torque and power of neighbouring windings over the speed, on "
                "the flux map."
            ),
            Table(
                table.drop(columns=["chosen"]),
                "Neighbouring windings by both models.",
                marked=tuple(table.index[table.chosen]),
            ),
            Picture(
                picture_name("force_velocity_field"),
                f"Peak phase voltage and current {output.place}, from the flux map.",
            ),
            Picture(picture_name("force_velocity"), "The same by constant parameters."),
        ),
    )  # fmt: skip


def envelope_table(found: DriveOutcome) -> pd.DataFrame:
    """Torque over speed of the flux map and of the constant parameters, and the MTPV current of the flux map."""
    field, constant = found.field, found.constant
    columns: dict[str, object] = {"speed_rpm": field.envelope.speed / RPM}
    columns |= _envelope_columns("field", field.envelope) | _envelope_columns("constant", constant.envelope)
    return pd.DataFrame({**columns, "i_d_mtpv_A": field.mtpv_direct, "i_q_mtpv_A": field.mtpv_quadrature})


def windings_table(found: DriveOutcome, winding: WindingOutcome) -> pd.DataFrame:
    """Neighbouring windings, values of the flux map beside those of constant parameters."""
    return pd.DataFrame([_row(one, winding.chosen.design) for one in found.neighbours])


def demands(required: Requirements, output: Output) -> tuple[WheelPoint, ...]:
    """What is asked at the output."""
    return (
        WheelPoint(f"peak {output.effort}", required.velocity_at_force_peak, required.force_peak),
        WheelPoint("peak power", required.velocity_at_power_peak, required.force_at_power_peak),
        WheelPoint("nominal (RMS)", required.velocity_rms, required.force_rms),
    )


def _text(found: DriveOutcome, winding: WindingOutcome) -> str:
    pair = found.neighbour(winding.chosen.design)
    field, constant = pair.field, pair.constant
    by_constant = found.by_constant
    same = by_constant.design == field.design
    comparison = "constant parameters would choose the same winding" if same else (
        f"constant parameters would choose {by_constant.design}"
    )  # fmt: skip
    return (
        f"At full current the flux map gives {winding.peak_torque:.3f} ± {winding.peak_torque_error:.3f} Nm, the mean "
        f"over one electrical period (± bounds the error of the mesh), with {winding.peak_torque_ripple:.2f} Nm "
        "between its largest and its smallest value. With saturation in every number the chosen winding has a base "
        f"speed of {field.base_speed / RPM:.0f} rpm and {field.power_at_base_speed:.0f} W there; constant parameters "
        f"say {_difference(constant.base_speed, field.base_speed)} in base speed, "
        f"{_difference(constant.peak_torque, field.peak_torque)} in peak torque and "
        f"{_difference(constant.maximum_power, field.maximum_power)} in largest power; {comparison}."
    )


def _difference(value: float | None, reference: float | None) -> str:
    if value is None or not reference:
        return "nothing to compare"
    return f"{100 * (value / reference - 1):+.1f} %"


def _envelope_columns(name: str, envelope: Envelope) -> dict[str, object]:
    columns = {_named(column, name): value for column, value in drawn(envelope, _OF_ENVELOPE).items()}
    return columns | {f"voltage_{name}_V": envelope.voltage_peak}


def _named(column: str, model: str) -> str:
    """``torque_field_Nm`` of ``torque_Nm``."""
    quantity, unit = split_unit(column)
    return f"{quantity}_{model}_{unit}"


def _envelopes(found: DriveOutcome, winding: WindingOutcome) -> tuple[dict[str, Envelope], str]:
    """Envelopes of the chosen winding, its nearest and the one without current limit by name, and the chosen name."""
    chosen, free = winding.chosen.design, winding.unrestricted
    wanted = {chosen} | ({free.design} if free is not None else set())
    shown = [one for one in found.neighbours if one.field.design in wanted or _beside(one.field.design, chosen)]
    return {_name(one): one.envelope for one in shown}, _name(found.neighbour(chosen))


def _beside(design: WindingDesign, chosen: WindingDesign) -> bool:
    """Of the same gauge and connection, with about as many turns."""
    return design.is_like(chosen) and abs(design.turns - chosen.turns) <= _SHOWN


def _demand(required: Requirements, transmission: Transmission, output: Output) -> tuple[RequiredPoint, ...]:
    demand = shaft_demand(required, transmission)
    return (RequiredPoint(f"peak {output.effort}", demand.base_speed, demand.torque_peak),)


def _name(pair: Neighbour) -> str:
    design = pair.field.design
    return f"{design.wound}, {design.connection}"


def _row(pair: Neighbour, chosen: WindingDesign) -> dict[str, object]:
    row = {"connection": str(pair.field.design.connection), **drawn(pair.field, ("turns", "strands", "current_rms_A"))}
    for name in _BOTH:
        row[_named(name, "field")] = drawn(pair.field, (name,))[name]
        row[_named(name, "constant")] = drawn(pair.constant, (name,))[name]
    return {**row, "chosen": pair.field.design == chosen}
