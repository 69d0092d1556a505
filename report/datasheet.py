"""The data sheet: everything that one asks of a machine before ordering it, one quantity a row.

A group of rows is a function of what it reads. Another stage's numbers join as a row in a group, or as a function of
their own in ``data_sheet``; a row says its condition, since a torque or a resistance is nothing without one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import astuple, dataclass, replace
from math import isfinite, isnan, sqrt

import pandas as pd

from drivetrain.masses import PartMasses
from drivetrain.outcome import Outcome, machine_envelope
from drivetrain.output import Output, in_unit
from electrical.braking_stage import BrakingOutcome, CopperHeat
from electrical.magnets_stage import MagnetsOutcome
from electrical.winding_connection import WindingConnection
from electrical.winding_stage import WindingInputs, WindingOutcome
from electrical.wound_machine import WoundMachine
from export.stage import Package
from figures.files import picture_name
from figures.report import Picture, Section, Table, number_text
from geometry.machine import Machine
from losses.stage import LossInputs, LossMap
from magnetostatics.case import FieldCase
from report.heat import binding
from report.losses import CAPTION as EFFICIENCY_CAPTION
from report.losses import FIGURE as EFFICIENCY
from thermal.machine import MAGNETS
from thermal.stage import HeatOutcome
from uncertainty.budget import Budget, Uncertain
from uncertainty.stage import Uncertainty
from units import AMPERE_PER_SQUARE_MILLIMETRE, DEGREE, RPM, written

DRAWING_PICTURE = "lamination"
TABLE = "datasheet.csv"
PLUS_MINUS = "plus_minus"  # column of the expanded uncertainty
_TEXT = (
    "The machine that was chosen, by the results of the stages below. Phase values are of one phase of the star, or of "
    "the equivalent star of a delta or of parallel paths: what a drive sees at the terminals; peak means amplitude. "
    "The rated point is the torque at the nominal current density, at the speed up to which the full current gives its "
    "torque. Behind ± stands the expanded uncertainty by mesh, fit and tolerances, which holds the number with about "
    f"95 % (see Uncertainty). {TABLE} holds the same rows."
)
_THOUSAND_RPM = 1000 * RPM  # rad/s, at which data sheets state a back-EMF


@dataclass(frozen=True)
class Row:
    """One line of the data sheet; value: in the unit that is written behind it.

    expanded: U of ``uncertainty.budget`` in that unit, None where it is not known
    """

    quantity: str
    value: object
    unit: str
    condition: str = ""
    expanded: float | None = None


@dataclass(frozen=True)
class Group:
    """Rows under one heading."""

    title: str
    rows: tuple[Row, ...]

    @property
    def table(self) -> pd.DataFrame:
        """See ``table_of``."""
        return table_of(self.rows)


@dataclass(frozen=True)
class DataSheet:
    """The whole sheet, group by group."""

    groups: tuple[Group, ...]

    @property
    def table(self) -> pd.DataFrame:
        """See ``table_of``."""
        return table_of(tuple(one for group in self.groups for one in group.rows))


def row(quantity: str, value: float, unit: str, condition: str = "", known: Uncertain | None = None) -> Row:
    """A row of a value in SI, shown in a unit of ``units.FACTORS``; empty for a pure number.

    known: how well a number is known that the value is proportional to
    """
    shown = in_unit(value, unit) if unit else value
    return Row(quantity, shown, written(unit), condition, None if known is None else shown * known.expanded)


def give_or_take(one: Row, known: Uncertain | None, unit: str) -> Row:
    """The row with the U of a number that differs from its own by a constant or in sign; unit: as in ``row``."""
    return one if known is None else replace(one, expanded=in_unit(known.plus_minus, unit))


def table_of(rows: tuple[Row, ...]) -> pd.DataFrame:
    """Columns quantity, value, plus_minus (U, 95 %), unit, condition."""
    table = pd.DataFrame([astuple(one) for one in rows], columns=["quantity", "value", "unit", "condition", PLUS_MINUS])
    return table.astype({PLUS_MINUS: float})[["quantity", "value", PLUS_MINUS, "unit", "condition"]]


def data_sheet(
    package: Package,
    case: FieldCase,
    steel: LossInputs,
    winding: WindingOutcome,
    inputs: WindingInputs,
    heat: CopperHeat,
    braking: BrakingOutcome,
    warm: HeatOutcome,
    magnets: MagnetsOutcome | None,
    outcome: Outcome,
    uncertainty: Uncertainty,
    output: Output,
) -> DataSheet:
    """Every group of rows; a group without rows is left out. magnets: None where the study names no grade"""
    budget = uncertainty.budget
    groups = (
        Group("Dimensions and materials", tuple(dimensions(winding.wound, case, steel))),
        Group("Winding", tuple(winding_rows(package, winding, inputs, heat, budget))),
        Group("Torque, speed and supply", tuple(performance(package, winding, inputs, budget))),
        Group("What the temperatures allow", tuple(warm_rows(warm, budget))),
        Group("Magnets", tuple(magnet_rows(magnets, budget))),
        Group("Losses at the rated point", tuple(loss_rows(package, steel, inputs, heat, budget))),
        Group("Constants", tuple(constants(package, winding, budget))),
        Group("Braking with shorted phases", tuple(braking_rows(package, braking, output, budget))),
        Group("Masses and inertia", tuple(mass_rows(outcome.masses, budget))),
    )
    return DataSheet(tuple(group for group in groups if group.rows))


def section(sheet: DataSheet, losses: LossMap | None) -> Section:
    """The machine on one page; losses: None without loss data."""
    return Section(
        "Data sheet",
        (
            _TEXT,
            Picture(
                picture_name(DRAWING_PICTURE),
                "Cross-section with its dimensions in mm; coil sides in the colours of phases A, B and C, light where "
                "a positive phase current flows away from the viewer.",
            ),
            *group_tables(sheet),
            *(() if losses is None else (Picture(picture_name(EFFICIENCY), EFFICIENCY_CAPTION),)),
        ),
    )


def group_tables(sheet: DataSheet) -> Iterator[Table]:
    """A table a group, for a report."""
    return (Table(_shown(group), f"{group.title}.", {PLUS_MINUS: "±"}) for group in sheet.groups)


# ---- groups ---------------------------------------------------------------------------------------------------------


def dimensions(wound: WoundMachine, case: FieldCase, steel: LossInputs) -> Iterator[Row]:
    """What is bought and cut."""
    machine, envelope, magnet = wound.dimensions, machine_envelope(wound), case.materials.magnet
    yield row("slots", machine.slots, "")
    yield row("poles", machine.poles, "")
    yield row("stator outer diameter", 2 * machine.stator_outer_radius, "mm")
    yield row("bore diameter", 2 * machine.stator_inner_radius, "mm")
    yield row("rotor diameter over the magnets", 2 * machine.rotor_outer_radius, "mm")
    yield row("air gap", machine.airgap, "mm", "radial, to the magnets")
    yield row("shaft diameter", 2 * machine.shaft_radius, "mm")
    yield row("active length", wound.active_length, "mm", "stack")
    length = wound.active_length + 2 * envelope.end_winding_length
    yield row("length over the end windings", length, "mm", "half circles over the pitch of a coil")
    yield Row("electrical steel", steel.steel, "", "stator and rotor laminations")
    yield row("magnet thickness", machine.magnet_length, "mm", f"{machine.poles} pieces on the rotor core")
    yield row("magnet arc", machine.magnet_arc_fraction, "", "of the pole pitch")
    yield Row("magnetisation", _pattern(machine), "", "of each magnet, outwards and inwards in turn")
    yield row("remanence", magnet.remanence, "T", "in the field solutions; hot magnets have less")


def winding_rows(
    package: Package, winding: WindingOutcome, inputs: WindingInputs, heat: CopperHeat, budget: Budget
) -> Iterator[Row]:
    """What is wound, how warm it may become, and its resistance."""
    wound, layout, limits = winding.wound, package.layout, inputs.limits
    connection = wound.design.connection
    series = layout.coils_in_series // connection.paths
    yield Row("connection", connection.closing.name, "", _closing_note(connection))
    yield row(
        "parallel paths", connection.paths, "", f"of a phase, {series} of its {layout.coils_in_series} coils each"
    )
    yield Row("coil pitch", layout.coil_pitch, "slots")
    yield row("layers", layout.layers, "")
    yield row("winding factor", layout.winding_factor(), "", "fundamental")
    yield row("turns", wound.design.turns, "", "of one coil")
    yield row("wires in hand", wound.design.strands, "")
    yield row("wire diameter", wound.design.wire.copper_diameter, "mm", "bare copper")
    yield row("wire diameter", wound.design.wire.outer_diameter, "mm", "largest, with enamel (IEC 60317-0-1)")
    yield row("packing factor", winding.chosen.packing, "", "copper over the area of a coil side")
    yield row(
        "insulated fill", winding.chosen.insulated_fill, "", f"wires with enamel; limit {limits.insulated_fill:g}"
    )
    if connection.closing.circulates:
        share = winding.chosen.circulating_share
        yield row("loss round the delta", share, "percent", "of the copper loss, nominal current, base speed asked for")
    yield Row("insulation class", inputs.insulation.letter, "", "IEC 60085")
    yield row("hottest place of the winding", inputs.insulation.hottest, "degC", "permitted by that class")
    for temperature, factor in ((heat.cold, heat.cold_resistance), (heat.hot, heat.hot_resistance)):
        resistance, at = wound.phase_resistance * factor, f"{temperature:g} °C, direct current"
        yield row("phase resistance", resistance, "mOhm", at, budget.constants.resistance)
        yield row("resistance between terminals", 2 * resistance, "mOhm", at, budget.constants.resistance)


def constants(package: Package, winding: WindingOutcome, budget: Budget) -> Iterator[Row]:
    """What a drive is set up with."""
    chosen, idle, known = winding.chosen, package.unsaturated, budget.constants
    full = f"at {chosen.current_peak:.4g} A"
    yield row("magnet flux linkage", idle.psi_m, "mWb", "of a phase, peak, no load", known.torque_constant)
    yield row("L_d", idle.inductance_d, "uH", "phase, incremental, no load", known.inductance_d)
    yield row("L_q", idle.inductance_q, "uH", "phase, incremental, no load", known.inductance_q)
    weakened = f"phase, apparent, {full} on the q axis and a quarter of it against d"
    yield row("L_d", chosen.inductance_d, "uH", weakened, known.loaded_inductance_d)
    yield row("L_q", chosen.inductance_q, "uH", f"phase, apparent, {full} on the q axis", known.loaded_inductance_q)
    no_load = chosen.no_load_torque_constant, "mNm_per_A", "per peak ampere, no load"
    yield row("torque constant", *no_load, known.torque_constant)
    loaded = f"per peak ampere, {full} on the q axis"
    yield row("torque constant", chosen.torque_constant, "mNm_per_A", loaded, known.loaded_constant)
    emf = sqrt(3) * idle.pole_pairs * idle.psi_m * _THOUSAND_RPM
    yield row("back-EMF", emf, "V", "line to line, peak, at 1000 rpm", known.torque_constant)
    rms = "line to line, RMS of the fundamental, at 1000 rpm"
    yield row("back-EMF", emf / sqrt(2), "V", rms, known.torque_constant)


def performance(package: Package, winding: WindingOutcome, inputs: WindingInputs, budget: Budget) -> Iterator[Row]:
    """Torques, speeds, currents and the supply."""
    chosen, bus, known = winding.chosen, inputs.limits.dc_voltage, budget.performance
    rated, full = package.continuous, package.overload
    nominal, overload = (_density(one) for one in (inputs.nominal_density, inputs.limits.overload_current_density))
    yield row("peak torque", winding.peak_torque, "Nm", overload, known.peak_torque)
    yield row("torque ripple", winding.peak_torque_ripple, "Nm", "peak to peak, at the peak torque", known.ripple)
    yield row("cogging torque", package.cogging, "Nm", "peak to peak, without current, magnets alike", known.cogging)
    yield row("continuous torque", rated.torque, "Nm", nominal, known.continuous_torque)
    yield row("base speed", chosen.base_speed, "rpm", "up to which the peak torque is given", known.base_speed)
    yield row("power at base speed", chosen.power_at_base_speed, "W", "at the peak torque", known.power_at_base_speed)
    if chosen.maximum_power is not None and chosen.speed_at_maximum_power is not None:
        fastest = f"ideal field weakening, at {chosen.speed_at_maximum_power / RPM:.0f} rpm"
        yield row("largest power", chosen.maximum_power, "W", fastest, known.largest_power)
    lower = "base speed, or the largest of the study where that is lower"
    yield row("rated speed", rated.speed, "rpm", lower, known.rated_speed)
    yield row("bus voltage", bus, "V", "direct")
    connection = chosen.design.connection
    yield row("peak line current", chosen.current_peak, "A", f"amplitude, {overload}")
    yield row("peak line current", chosen.current_rms, "A", f"RMS, {overload}")
    yield row("peak coil current", float(connection.coil_current(chosen.current_rms)), "A", f"RMS, {overload}")
    yield row("continuous line current", rated.current_peak / sqrt(2), "A", f"RMS, {nominal}")
    limit = float(connection.phase_voltage(winding.limits.voltage_peak))
    yield row("largest voltage across a phase", limit, "V", "peak, of the winding, by the bus voltage")
    at = f"peak torque at {full.speed / RPM:.0f} rpm, with copper loss"
    yield row("bus current", full.power_in / bus, "A", at, known.overload_input)


def warm_rows(warm: HeatOutcome, budget: Budget) -> Iterator[Row]:
    """Torque and current without end, by the thermal network."""
    slow, limits = warm.slow, warm.inputs.limits
    at = f"slowly turning, surroundings of {warm.inputs.cooling.ambient:g} °C; {binding(slow)}"
    yield row("continuous torque", slow.torque, "Nm", at, budget.output.continuous_effort)
    yield row("continuous line current", slow.current / sqrt(2), "A", f"RMS, {at}", budget.heat.continuous_current)
    copper, magnets = (f"then; limit {limit:g} °C; ± at the same torque" for limit in (limits.copper, limits.magnets))
    known = budget.heat
    yield give_or_take(row("hottest copper", slow.state.hottest_copper, "degC", copper), known.copper_rise, "degC")
    yield give_or_take(row("magnets", slow.state.temperature[MAGNETS], "degC", magnets), known.magnet_rise, "degC")


def magnet_rows(magnets: MagnetsOutcome | None, budget: Budget) -> Iterator[Row]:
    """What the magnets stand; none without a grade."""
    if magnets is None:
        return
    known = budget.magnets
    yield Row("grade", magnets.inputs.grade.name, "", magnets.inputs.grade.material)
    yield row("knee", magnets.knee, "T", f"flux density along the magnetisation at {magnets.temperature:g} °C")
    worst = max(magnets.states, key=lambda state: state.lost)
    where = f"in the worst state: {worst.name}" if worst.lost else "in every state that was looked at"
    yield give_or_take(row("volume beyond the knee", worst.lost, "percent", where), known.kept, "percent")
    if isfinite(magnets.demagnetising_current):
        allowed = f"{in_unit(magnets.inputs.lost_max, 'percent'):g} % of the volume beyond the knee"
        against = f"peak, against the magnets, {allowed}"
        yield row("demagnetising current", magnets.demagnetising_current, "A", against, known.demagnetising_current)


def loss_rows(
    package: Package, steel: LossInputs, inputs: WindingInputs, heat: CopperHeat, budget: Budget
) -> Iterator[Row]:
    """Losses and efficiency, efficiency with hot copper too; none where the study has no loss data."""
    losses, rated, known = package.losses, package.continuous, budget.losses
    if losses is None:
        return
    at = f"{rated.torque:.4g} Nm at {rated.speed / RPM:.0f} rpm"
    hot = replace(losses, copper=losses.copper * heat.hot_resistance)
    yield row("power", losses.mechanical, "W", f"mechanical, {at}", budget.performance.rated_power)
    cold = f"{steel.winding_temperature:g} °C, direct current"
    yield row("copper loss", losses.copper, "W", cold, known.copper_loss)
    if losses.circulating:
        yield row("loss round the delta", losses.circulating, "W", f"{steel.winding_temperature:g} °C, third harmonic")
    grade = f"by the loss data of {steel.loss_grade}"
    yield row("stator iron loss", losses.stator_iron, "W", grade, known.iron_loss)
    yield row("rotor iron loss", losses.rotor_iron, "W", grade)
    yield row("magnet loss", losses.magnet, "W", "eddy currents, estimate")
    yield row("losses", losses.total, "W", "without bearings, windage and inverter", known.losses)
    cold = f"{at}, copper at {steel.winding_temperature:g} °C"
    yield row("efficiency", losses.efficiency, "percent", cold, known.efficiency)
    yield row("efficiency", hot.efficiency, "percent", f"{at}, copper at {heat.hot:g} °C", known.efficiency)
    yield row("bus current", losses.electrical / inputs.limits.dc_voltage, "A", at, known.rated_input)


def braking_rows(package: Package, braking: BrakingOutcome, output: Output, budget: Budget) -> Iterator[Row]:
    """The machine as a brake."""
    found, (cold, hot) = package.short_circuit, braking.poles
    asked = output.at_speed(braking.demand.speed_peak)
    largest, shorted = f"peak, largest up to {asked} {output.place}", "shorted, without iron loss and friction"
    yield row("short-circuit current", found.current_peak, "A", largest, budget.braking.short_circuit_current)
    yield row("largest braking torque", found.torque, "Nm", shorted, budget.braking.braking_torque)
    for speed, at, degrees in (
        (found.best_speed_cold, cold, braking.heat.cold),
        (found.best_speed_hot, hot, braking.heat.hot),
    ):
        where = f"{degrees:g} °C, {output.at_speed(at)} {output.place}"
        yield row("speed of the largest braking torque", speed, "rpm", where, budget.braking.braking_speed)
    line = f"line to line, peak, at {asked} {output.place}"
    yield row("back-EMF at the largest speed", braking.back_emf, "V", line, budget.constants.torque_constant)


def mass_rows(masses: PartMasses, budget: Budget) -> Iterator[Row]:
    """By part, and what turns."""
    known = budget.masses
    by_row = (known.stator_laminations, known.copper, known.rotor_laminations, known.magnets, known.shaft, known.mass)
    for (part, mass, _), uncertain in zip(masses.rows, by_row, strict=True):
        yield row(part, mass, "kg", known=uncertain)
    turning = "laminations, magnets and shaft over the active length"
    yield row("rotor inertia", masses.rotor_inertia, "kg_mm2", turning, known.rotor_inertia)


def plus_minus(expanded: float) -> str:
    """An expanded uncertainty to two digits, as the GUM (7.2.6) asks for; nothing where it is not known (NaN).

    expanded: in the unit of its value
    """
    return "" if isnan(expanded) else number_text(expanded, 2)


def _shown(group: Group) -> pd.DataFrame:
    """The table of a group, without the column of the uncertainties where none is known."""
    table = group.table
    if table[PLUS_MINUS].isna().all():
        return table.drop(columns=PLUS_MINUS)
    return table.assign(**{PLUS_MINUS: [plus_minus(one) for one in table[PLUS_MINUS]]})


def _closing_note(connection: WindingConnection) -> str:
    if connection.closing.circulates:
        degrees = connection.closing.lag / DEGREE
        return (
            f"A ends where B begins; its equivalent star lags the phases of the winding by {degrees:.0f} ° electrical"
        )
    return "the star point is not led out"


def _pattern(machine: Machine) -> str:
    return type(machine.magnetisation).__name__.removesuffix("Magnetisation").lower()


def _density(density: float) -> str:
    return f"{density / AMPERE_PER_SQUARE_MILLIMETRE:g} A/mm² RMS in the copper"
