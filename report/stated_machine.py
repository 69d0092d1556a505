"""The sheet of a machine of any kind that is stated whole: drawing, data sheet, map, losses, and one turn."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import partial
from math import sqrt

import numpy as np
import pandas as pd

from drivetrain.masses import CopperBars, PartMasses, PartMaterials, part_masses
from electrical.driven_machine import CopperTemperature, DrivenMachine
from electrical.kind_search import KindDesign, KindOutcome
from electrical.performance import Performance
from electrical.point_field import FieldPoints
from electrical.point_winding_stage import Candidates, PointWinding
from electrical.point_windings import needed_density
from electrical.turning_stage import TurningMachine, full_supply
from electrical.wound_machine import WoundMachine
from export.dxf import laminations, write_dxf
from figures.field_map import field_map
from figures.files import File, figure_file, picture_name, table_file
from figures.flux_map import FLUX_MAP_CAPTION, envelope_over_speed, flux_maps
from figures.lamination import outline_picture
from figures.losses import loss_maps
from figures.report import Picture, Section, Table
from figures.rotation import rotation
from figures.whole_field import whole_field
from geometry.moves import Move
from geometry.outline import outline_of
from geometry.parts import Part, Rotor, part_units
from losses.stage import LossMap
from magnetostatics.case import FieldCase
from magnetostatics.flux_map_stage import FluxMap, kept_model
from report.datasheet import DataSheet, Group, Row, group_tables, row
from units import DEGREE, FACTORS, RPM, percent

SHEET, TURN, ENVELOPE, DESIGNS = "sheet.csv", "turn.csv", "envelope.csv", "designs.csv"
DRAWING, FIELD, MAP, OVER_SPEED, LOSSES, TURNING = (
    "drawing", "field_full_current", "flux_map", "envelope", "losses", "turn",
)  # fmt: skip
_THOUSAND_RPM = 1000 * RPM
_OFF_LIMIT = 0.9  # of full torque and base speed: the map is read inside its limits
# Usual values where the file of a machine states none: sheet EN 10106, NdFeB 7400 to 7600 in data sheets, copper
# IEC 60028, shaft of plain steel; stacking of sheet of 0.35 mm. Estimates for a machine that was not weighed.
_PARTS = PartMaterials(7650.0, 7500.0, 8890.0, 7800.0, 0.95)
_LARGE = 1e-3  # H, from which on an inductance is written in mH
_CAPITAL = re.compile(r"(?<!^)(?=[A-Z])")  # begins the next word of a kind, OuterMagnets


@dataclass(frozen=True)
class MachineSheet:
    """The data sheet and the masses that stand in it."""

    sheet: DataSheet
    masses: PartMasses


def machine_sheet(
    case: FieldCase,
    copper: CopperTemperature,
    driven: DrivenMachine,
    flux_map: FluxMap,
    performance: Performance,
    turning: TurningMachine,
    losses: LossMap | None,
    winding: PointWinding | None,
    points: FieldPoints | None,
) -> MachineSheet:
    """Every group of rows. losses: None where the file names no loss grade; winding, points: None where the file
    states the winding"""
    wound = driven.wound
    bars = CopperBars(wound.copper_area, 6 * wound.coils_in_series, wound.end_turn_length)
    masses = part_masses(wound.machine, wound.active_length, bars, _PARTS)
    groups = (
        Group("Stator", tuple(_drawn(wound.machine.stator))),
        Group("Rotor", tuple(_drawn(wound.machine.rotor))),
        Group("Winding", tuple(_winding(case, copper, driven))),
        Group("Operating points", tuple(_points(winding, points))),
        Group("Torque, speed and supply", tuple(_torques(driven, flux_map, performance, turning))),
        Group("Constants", tuple(_constants(copper, driven, flux_map, performance))),
        Group("Iron at full current", tuple(_iron(wound.machine.rotor, turning))),
        Group("Losses", tuple(_losses(wound.machine.rotor, performance, losses))),
        Group("Masses and inertia", tuple(_masses(masses))),
    )
    return MachineSheet(DataSheet(tuple(group for group in groups if group.rows)), masses)


def search_files(found: KindOutcome) -> Iterator[File]:
    """Every design that was sampled, and the best."""
    yield table_file(DESIGNS, designs_table(found))


def search_section(found: KindOutcome | None, candidates: Candidates | None) -> Section | None:
    """What the dimensions became; none where nothing may vary. candidates: None where the file states the winding"""
    if found is None:
        return None
    best, drawn = found.best, found.drawn
    text = (
        f"{found.search.samples} designs between the bounds, {found.unbuildable} of them not buildable; the best two "
        f"bettered further. At the same full ampere-turns the motor constant rises from {drawn.motor_constant:.4g} "
        f"(as drawn) to {best.motor_constant:.4g} Nm/√W, the torque goes from {drawn.torque:.4g} to {best.torque:.4g} "
        f"Nm; {best.tooth:.3g} T in the teeth and {best.back_iron:.3g} T in the back iron, where "
        f"{found.search.limit:g} T is allowed (as drawn {drawn.tooth:.3g} and {drawn.back_iron:.3g} T), at a current "
        f"angle of {best.current_angle / DEGREE:.0f}°; at the angle of the largest torque, which the sheet is for, the "
        "iron may be further saturated. "
        + ("Wire fills the slots as far as it did, of a diameter that need not be sold." if candidates is None else
           "Copper was to fill the slots as far as it may; what is wound into them is chosen below.")
    )  # fmt: skip
    rows = [
        {"variable": move.name, "moves": ", ".join(".".join(one) for one in move.dimensions),
         "change": move.amount(amount), "from": move.amount(move.low), "to": move.amount(move.high),
         "on its bound": "yes" if _on_bound(move, amount) else ""}
        for move, amount in zip(found.search.moves, best.amounts, strict=True)
    ]  # fmt: skip
    return Section("Best dimensions", (text, Table(pd.DataFrame(rows), f"What moved; all designs are in {DESIGNS}.")))


def designs_table(found: KindOutcome) -> pd.DataFrame:
    """A design a row, the best first."""
    return pd.DataFrame([_design_row(found, one) for one in (found.best, *found.samples)])


def _design_row(found: KindOutcome, one: KindDesign) -> dict[str, object]:
    moved: dict[str, object] = {
        f"{move.name} ({move.unit})" if move.unit else move.name: amount / FACTORS[move.unit] if move.unit else amount
        for move, amount in zip(found.search.moves, one.amounts, strict=True)
    }
    return moved | {
        "current_angle_deg": one.current_angle / DEGREE, "torque_Nm": one.torque,
        "motor_constant_Nm_per_sqrtW": one.motor_constant, "tooth_T": one.tooth, "back_iron_T": one.back_iron,
    }  # fmt: skip


def _on_bound(move: Move, amount: float) -> bool:
    return min(amount - move.low, move.high - amount) < 1e-3 * (move.high - move.low)


def flux_map_files(
    flux_map: FluxMap, driven: DrivenMachine, performance: Performance, case: FieldCase
) -> Iterator[File]:
    """The map with the best currents, torque over speed, and the field at full current."""
    machine = driven.wound.on_map(flux_map.data)
    yield figure_file(MAP, flux_maps(machine, performance, driven.limits.current_peak))
    yield figure_file(OVER_SPEED, envelope_over_speed(performance.envelope))
    yield table_file(ENVELOPE, envelope_table(performance))
    model = kept_model(case, driven.wound.machine)
    angle = model.section.layout.phase_axis / model.section.machine.pole_pairs
    yield figure_file(FIELD, field_map(whole_field(model.solve(full_supply(driven, performance).at(angle, model)))))


def turning_files(turning: TurningMachine, driven: DrivenMachine) -> Iterator[File]:
    """Torque and probes over the angle."""
    yield table_file(TURN, turn_table(turning, driven))
    yield figure_file(TURNING, rotation(turn_table(turning, driven), current="full"))


def losses_files(losses: LossMap) -> Iterator[File]:
    """The maps of loss and efficiency."""
    yield figure_file(LOSSES, loss_maps(losses.losses, "Losses over torque and speed"))


def sheet_files(driven: DrivenMachine, case: FieldCase, found: MachineSheet) -> Iterator[File]:
    """Data sheet, drawing, and outlines to cut by."""
    yield table_file(SHEET, found.sheet.table)
    machine = driven.wound.machine
    yield figure_file(DRAWING, outline_picture(machine, case.layout(machine)))
    for name, layers in laminations(outline_of(machine)).items():
        if any(layers.values()):
            yield File(name, partial(write_dxf, layers=layers))


def section(driven: DrivenMachine, found: MachineSheet) -> Section:
    """The machine on one page."""
    has_magnets = driven.wound.machine.rotor.magnets_per_pitch > 0
    text = (
        "Phase values are of the equivalent star; peak means amplitude. The d axis is "
        + ("the axis of a magnet pole. " if has_magnets else "that of high permeance. ")
        + f"{SHEET} holds the same rows."
    )
    return Section(
        "Data sheet",
        (
            text,
            Picture(picture_name(DRAWING), "Cross-section; coil sides in the colours of phases A, B and C."),
            *group_tables(found.sheet),
        ),
    )


def map_section(flux_map: FluxMap, performance: Performance) -> Section:
    """What was solved, and what the machine gives over speed."""
    data = flux_map.data
    text = (
        f"Flux linkages at {data.sizes['angle']} rotor angles over 60 electrical degrees; at full current the mesh "
        f"may put the torque off by {100 * flux_map.torque_error:.2f} %. The current angle is searched over the whole "
        f"quadrant: at full current i_d = {performance.full.direct:.4g} A, i_q = {performance.full.quadrature:.4g} A."
    )
    return Section(
        "Flux map and torque over speed",
        (
            text,
            Picture(picture_name(FIELD), "Flux density and flux lines at full current, d axis on the axis of phase A."),
            Picture(picture_name(MAP), FLUX_MAP_CAPTION),
            Picture(picture_name(OVER_SPEED), "Largest torque, power and the current on the d axis over speed."),
        ),
    )


def turning_section(turning: TurningMachine) -> Section:
    """What the angle does."""
    cogs = turning.idle.ripple > 0
    idle = f"; without current {turning.idle.ripple:.3g} Nm" if cogs else ""
    text = (
        f"Full current: {turning.full.mean_torque:.4g} Nm in the mean, {turning.full.ripple:.3g} Nm from peak to peak"
        f"{idle}. The two torque routes differ by at most {percent(turning.full.routes_apart, 2)}."
    )
    shown = f"Torque per length by both routes{', without current' if cogs else ''}, and the probes."
    return Section("One turn", (text, Picture(picture_name(TURNING), shown)))


def losses_section(losses: LossMap | None, driven: DrivenMachine) -> Section | None:
    """Loss and efficiency; none without loss data."""
    if losses is None:
        return None
    machine = driven.wound.machine
    magnets = "; eddy currents in the magnets" if machine.rotor.magnets_per_pitch else ""
    cup = " A cup of solid steel loses more than this." if machine.rotor.rim_radius > machine.stator.rim_radius else ""
    stands_in = f", which stand in for {losses.steel}" if losses.law_is_of_another_grade else ""
    text = (
        f"Copper at {losses.winding_temperature:g} °C, iron of stator and rotor as laminated, by the loss data of "
        f"{losses.law.grade}{stands_in}{magnets}.{cup} "
        "Without bearings, windage and the inverter."
    )
    return Section("Losses and efficiency", (text, Picture(picture_name(LOSSES), "Electrical loss and efficiency.")))


def turn_table(turning: TurningMachine, driven: DrivenMachine) -> pd.DataFrame:
    """Torques per length and probes over the rotor angle in drawing units."""
    length = driven.wound.active_length
    columns = {
        "angle_mech_deg": turning.full.angle / DEGREE,
        "torque_arkkio_Nm_per_m": turning.full.torque[:, 0] / length,
        "torque_maxwell_Nm_per_m": turning.full.torque[:, 1] / length,
        "torque_no_current_Nm_per_m": turning.idle.torque[:, 0] / length,
    }
    return pd.DataFrame(columns | {f"{name}_T": turning.flux_density[:, k] for k, name in enumerate(turning.probes)})


def envelope_table(found: Performance) -> pd.DataFrame:
    """Largest torque and power over speed with its currents."""
    one = found.envelope
    return pd.DataFrame(
        {"speed_rpm": one.speed / RPM, "torque_Nm": one.torque, "power_W": one.power, "i_d_A": one.i_d,
         "i_q_A": one.i_q, "phase_voltage_peak_V": one.voltage_peak}
    )  # fmt: skip


# ---- groups ---------------------------------------------------------------------------------------------------------


def _drawn(part: Part) -> Iterator[Row]:
    """Every dimension that the kind of the part has."""
    yield Row("kind", _CAPITAL.sub(" ", type(part).__name__).lower(), "")
    units = part_units(type(part))
    for one in fields(part):  # type: ignore[arg-type]  # every part is a dataclass
        value = getattr(part, one.name)
        if isinstance(value, int | float) and one.name not in part.of_the_model:
            yield row(one.name.replace("_", " "), value, units[one.name])


def _winding(case: FieldCase, copper: CopperTemperature, driven: DrivenMachine) -> Iterator[Row]:
    wound, layout = driven.wound, case.layout(driven.wound.machine)
    yield Row("connection", str(wound.design.connection), "")
    yield Row("coil pitch", layout.coil_pitch, "slots")
    yield row("layers", layout.layers, "")
    yield row("winding factor", layout.winding_factor(), "", "fundamental")
    yield row("turns", wound.design.turns, "", "of one coil")
    yield row("wires in hand", wound.design.strands, "")
    yield row("wire diameter", wound.design.wire.copper_diameter, "mm", "bare copper")
    yield row("active length", wound.active_length, "mm")
    yield row("end turn", wound.end_turn_length, "mm", f"{wound.end_turn.name.replace('_', ' ')}, estimate")
    yield _end_winding_inductance(wound)
    at = f"{copper.value:g} °C, direct current"
    yield row("resistance between terminals", 2 * wound.phase_resistance, "mOhm", at)


def _end_winding_inductance(wound: WoundMachine) -> Row:
    name = "end-winding inductance"
    try:
        return row(name, wound.end_turn_inductance, "uH", "of a phase, estimate; not in the flux map")
    except ValueError as unknown:
        return Row(name, "not known", "", str(unknown))


def _points(winding: PointWinding | None, points: FieldPoints | None) -> Iterator[Row]:
    """What the winding was chosen for."""
    if winding is None or points is None:
        return
    chosen = winding.chosen
    for point, torque in zip(points.points, chosen.torques, strict=True):
        asked = point.asked
        yield row(f"largest torque at {asked.speed / RPM:g} rpm", torque, "Nm", f"asked are {asked.torque:g} Nm")
        yield row(f"line current at {asked.speed / RPM:g} rpm", point.current, "A", f"peak, {asked.torque:g} Nm")
        yield row(f"phase voltage at {asked.speed / RPM:g} rpm", point.voltage, "V", f"peak, {asked.torque:g} Nm")
    yield row("largest of these line currents", chosen.needed_current, "A", "peak")
    yield row("current density", needed_density(chosen), "A_per_mm2", "RMS, at that current")
    yield row("copper loss", chosen.copper_loss, "W", "at that current")


def _torques(
    driven: DrivenMachine, flux_map: FluxMap, found: Performance, turning: TurningMachine
) -> Iterator[Row]:
    full, current = found.full, f"at {driven.limits.current_peak:.4g} A peak"
    error = f"{current}; the mesh may put it off by {100 * flux_map.torque_error:.2f} %"
    yield row("peak torque", full.torque, "Nm", error)
    yield row("torque ripple", turning.full.ripple, "Nm", f"peak to peak, {current}")
    if driven.wound.machine.rotor.magnets_per_pitch:
        yield row("cogging torque", turning.idle.ripple, "Nm", "peak to peak, without current")
    beyond = ", beyond the largest of the file" if full.base_speed > driven.fastest else ""
    yield row("base speed", full.base_speed, "rpm", f"up to which the peak torque is given{beyond}")
    if not beyond:
        yield row("power at base speed", full.torque * full.base_speed, "W")
    best = int(np.nanargmax(found.envelope.power))
    weakened = "ideal field weakening, " if found.envelope.speed[best] > full.base_speed else ""
    speed = f"{weakened}at {found.envelope.speed[best] / RPM:.0f} rpm"
    yield row("largest power", float(found.envelope.power[best]), "W", speed)
    yield row("largest phase voltage", driven.limits.voltage_peak, "V", "peak, by the bus")


def _constants(
    copper: CopperTemperature, driven: DrivenMachine, flux_map: FluxMap, found: Performance
) -> Iterator[Row]:
    machine, full = driven.wound.on_map(flux_map.data), found.full
    psi = float(machine.flux_linkage(0.0, 0.0)[0])
    if driven.wound.machine.rotor.magnets_per_pitch:
        emf = sqrt(3) * machine.pole_pairs * psi * _THOUSAND_RPM
        yield row("magnet flux linkage", psi, "mWb", "of a phase, peak, no load")
        yield row("back-EMF", emf / sqrt(2), "V", "line to line, RMS of the fundamental, at 1000 rpm")
    current, resistance = driven.limits.current_peak, driven.wound.phase_resistance
    at = f"at {current:.4g} A peak"
    yield row("torque constant", full.torque / current, "Nm_per_A", f"per peak ampere, {at}")
    constant = full.torque / (sqrt(1.5 * resistance) * current)
    by_loss = f"torque over the root of the copper loss, {at}, {copper.value:g} °C"
    yield Row("motor constant", constant, "Nm/√W", by_loss)
    places = {"no load": (0.0, 0.0), "full current": (full.direct, full.quadrature)}
    for name, currents in places.items():
        (l_dd, _), (_, l_qq) = machine.incremental_inductances(*currents)
        unit = "mH" if max(l_dd, l_qq) >= _LARGE else "uH"
        yield row("L_d", float(l_dd), unit, f"phase, incremental, {name}")
        yield row("L_q", float(l_qq), unit, f"phase, incremental, {name}")


def _iron(rotor: Rotor, turning: TurningMachine) -> Iterator[Row]:
    across = {"tooth": "across a tooth", "back_iron": "across the back iron"}
    across |= {name: "across it, in the rotor" for name in rotor.probes}
    for probe, where in across.items():
        yield row(f"largest flux density, {probe.replace('_', ' ')}", turning.largest(probe), "T", f"mean {where}")


def _losses(rotor: Rotor, found: Performance, losses: LossMap | None) -> Iterator[Row]:
    if losses is None:
        return
    map_, full = losses.losses, found.full
    one = map_.at(_OFF_LIMIT * full.torque, min(_OFF_LIMIT * full.base_speed, float(map_.speed[0, -1])))
    at = f"{float(one.torque):.4g} Nm at {float(one.speed) / RPM:.0f} rpm"
    yield row("power", one.mechanical, "W", f"mechanical, {at}")
    yield row("copper loss", one.copper, "W", f"{losses.winding_temperature:g} °C")
    yield row("stator iron loss", one.stator_iron, "W", f"by the loss data of {losses.law.grade}")
    yield row("rotor iron loss", one.rotor_iron, "W", "as if laminated")
    if rotor.magnets_per_pitch:
        yield row("magnet loss", one.magnet, "W", "eddy currents, estimate")
    yield row("efficiency", one.efficiency, "percent", at)
    yield row("best efficiency", losses.motor.efficiency, "percent",
              f"{losses.motor.torque:.4g} Nm at {losses.motor.speed / RPM:.0f} rpm")  # fmt: skip


def _masses(masses: PartMasses) -> Iterator[Row]:
    for part, mass, _ in masses.rows:
        if mass > 0:
            yield row(part, mass, "kg", "usual densities")
    yield row("rotor inertia", masses.rotor_inertia, "kg_mm2", "over the active length")
