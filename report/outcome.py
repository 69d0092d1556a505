"""The outcome for people: key numbers, requirements with their margins, remedies, masses and the axial section."""

from __future__ import annotations

from collections.abc import Iterator
from math import floor

import pandas as pd

from drivetrain.asked import (
    Check,
    ContinuousEffort,
    ControlledDamping,
    EquivalentMass,
    LostMagnets,
    LowSpeedDamping,
    PeakEffort,
    PeakEffortAtRest,
    PeakPower,
    Requirement,
)
from drivetrain.nearest import Move, NearestDesign
from drivetrain.outcome import Features, Outcome
from drivetrain.output import Output, in_unit, labelled
from drivetrain.proof import Impossibility
from drivetrain.remedies import Remedy
from figures.files import File, figure_file, picture_name, table_file
from figures.gearbox import axial_section
from figures.report import KeyNumber, KeyNumbers, Picture, Remark, Section, Table, capped, number_text
from gearbox.stage import SafetyCheck
from mechanics.checks import LoadCheck
from report.datasheet import plus_minus
from report.mechanics import LARGEST_FACTOR, LARGEST_MARGIN
from uncertainty.budget import Budget, Uncertain
from uncertainty.stage import Uncertainty
from units import FACTORS, MILLIMETRE, written

DECIDES = 1e-3  # relative margin, up to which a requirement decides about the nearest design
_NEAREST = (
    "All of these inputs moved together, as little as will do: least sum of squares of the logarithms, each between a "
    "third of its value and three times it."
)
_REMEDIES = (
    "Which input would make a failing requirement hold, moved alone; a dash: not within a third to three times its "
    "value. Fewer turns at the same copper mean more current in the same proportion."
)


def files(found: Outcome, output: Output) -> Iterator[File]:
    """Requirements, remedies and masses as tables, and the axial section."""
    yield table_file("outcome_requirements.csv", checks_table(found, output))
    yield table_file("outcome_remedies.csv", remedies_table(found, output))
    if found.nearest is not None:
        yield table_file("outcome_nearest.csv", moves_table(found.nearest, output))
    yield table_file("outcome_features.csv", features_table(found, output))
    yield table_file("outcome_masses.csv", masses_table(found))
    title = f"{found.active_length / MILLIMETRE:.1f} mm of active length, {found.features.mass:.1f} kg"
    yield figure_file("axial_section", axial_section(found.layout, title=title, end=output.end))


def section(found: Outcome, output: Output, uncertainty: Uncertainty | None) -> Section:
    """The actuator on one screen, and which requirements hold; uncertainty: None where it was not looked at."""
    checks: list[Check | SafetyCheck | LoadCheck] = [*found.checks, *found.gear_checks, *found.strength_checks]
    held = sum(one.holds for one in checks)
    return Section(
        "Outcome",
        (
            KeyNumbers(_key_numbers(found.features, output)),
            f"{held} of {len(checks)} requirements hold.",
            *_failures(found, output),
            _asked_and_reached(found, output, uncertainty),
            *_remedy_table(found, output),
            *_nearest(found, output),
            Table(features_table(found, output), "Features of the actuator.", headings=_stated_heading(found)),
            *_load(found),
            Table(masses_table(found), "What it weighs, and the inertias that the rotor feels."),
            Picture(picture_name("axial_section"), "Axial section with the envelope."),
        ),
    )


def _asked_and_reached(found: Outcome, output: Output, uncertainty: Uncertainty | None) -> Table:
    """Every requirement, with the expanded uncertainty of what is reached where it is known."""
    words, table = f"What is asked and what is reached, {output.place}.", checks_table(found, output)
    asked, factors = table.reached[: len(found.checks)], table.reached[len(found.checks) :]
    reached, margins = [*asked, *capped(factors, LARGEST_FACTOR)], capped(table.margin_percent, LARGEST_MARGIN)
    table = table.assign(reached=reached, margin_percent=margins)
    if uncertainty is None:
        return Table(table, words)
    known = _known(uncertainty.budget)
    shown = [_give_or_take(one, known.get(type(one.requirement)), output) for one in found.checks]
    shown += [""] * (len(table) - len(shown))
    table.insert(table.columns.get_loc("reached") + 1, "plus_minus", shown)
    return Table(table, f"{words} Behind ± stands U of the uncertainty.", {"plus_minus": "±"})


def _give_or_take(one: Check, known: Uncertain | None, output: Output) -> str:
    """U of what is reached; a share of the magnets is known by the rest of them."""
    if known is None:
        return ""
    size = known.plus_minus if isinstance(one.requirement, LostMagnets) else known.expanded * one.reached
    return plus_minus(in_unit(size, one.requirement.unit(output)))


def _known(budget: Budget) -> dict[type[Requirement], Uncertain]:
    """How well what is reached is known, where it is."""
    known = {
        PeakEffortAtRest: budget.output.peak_effort,
        PeakEffort: budget.output.fast_effort,
        PeakPower: budget.output.peak_power,
        ContinuousEffort: budget.output.continuous_effort,
        LowSpeedDamping: budget.output.low_speed_damping,
        ControlledDamping: budget.output.controlled_damping,
        EquivalentMass: budget.output.equivalent_mass,
        LostMagnets: budget.magnets.kept,
    }
    return {kind: one for kind, one in known.items() if one is not None}


def remarks(found: Outcome, output: Output) -> Iterator[str]:
    """What the run says at once: every requirement, and whether it holds."""
    for row in checks_table(found, output).itertuples():
        reached, needed = (_shown(value, row.unit) for value in (row.reached, row.needed))
        yield f"{row.requirement}: {reached}, {row.sense} {needed} needed: " + (
            "holds" if row.holds == "yes" else "DOES NOT HOLD"
        )
    if found.nearest is not None:
        yield nearest_in_words(found.nearest, output)


def _shown(value: float, unit: str) -> str:
    return f"{number_text(value)} {unit}".rstrip()


# ---- tables ---------------------------------------------------------------------------------------------------------


def checks_table(found: Outcome, output: Output) -> pd.DataFrame:
    """Requirements and safety factors of gears, rotor, shafts and bearings, one a row, in drawing units."""
    rows = [_check_row(one, output) for one in found.checks]
    rows += [_factor_row(f"gears, safety {one.kind.replace('_', ' ')}", one) for one in found.gear_checks]
    rows += [_factor_row(f"{one.part}, safety factor", one) for one in found.strength_checks]
    return pd.DataFrame(rows)


def _check_row(one: Check, output: Output) -> dict[str, object]:
    asked = one.requirement
    unit = asked.unit(output)
    sense = "at most" if asked.at_most else "at least"
    needed, reached = asked.needed / FACTORS[unit], one.reached / FACTORS[unit]
    return _row(asked.name(output), needed, reached, written(unit), sense, one)


def _factor_row(name: str, one: SafetyCheck | LoadCheck) -> dict[str, object]:
    return _row(name, one.wanted, one.reached, "", "at least", one)


def _row(
    name: str, needed: float, reached: float, unit: str, sense: str, check: Check | SafetyCheck | LoadCheck
) -> dict[str, object]:
    return {
        "requirement": name,
        "needed": needed,
        "reached": reached,
        "unit": unit,
        "sense": sense,
        "margin_percent": 100 * check.margin,
        "holds": "yes" if check.holds else "NO",
    }


def remedies_table(found: Outcome, output: Output) -> pd.DataFrame:
    """What would make the failing requirements hold, one lever a row, in drawing units."""
    columns = ["requirement", "input", "unit", "now", "needed", "change_percent", "then fails"]
    return pd.DataFrame([_remedy_row(one, output) for one in found.remedies], columns=columns)


def _remedy_row(one: Remedy, output: Output) -> dict[str, object]:
    unit = one.lever.unit(output)
    row = {"requirement": one.requirement.name(output), "input": one.lever.name(), "unit": written(unit),
           "now": in_unit(one.now, unit)}  # fmt: skip
    if one.value is None:
        return {**row, "needed": None, "change_percent": None, "then fails": ""}
    fails = ", ".join(other.name(output) for other in one.fails_then) or "nothing else"
    change = 100 * (one.value / one.now - 1)
    return {**row, "needed": in_unit(one.value, unit), "change_percent": change, "then fails": fails}


def moves_table(nearest: NearestDesign, output: Output) -> pd.DataFrame:
    """The inputs of the nearest design, one a row, in drawing units."""
    return pd.DataFrame([_move_row(move, output) for move in nearest.moves])


def _move_row(move: Move, output: Output) -> dict[str, object]:
    unit = move.lever.unit(output)
    return {
        "input": move.lever.name(),
        "unit": written(unit),
        "now": in_unit(move.now, unit),
        "there": in_unit(move.value, unit),
        "change_percent": 100 * (move.value / move.now - 1),
    }


def features_table(found: Outcome, output: Output) -> pd.DataFrame:
    """Rows of thesis Table 3.12: ours and, where there is one, the stated actuator's."""
    stated = None if found.stated is None else found.stated.features
    rows = []
    for attribute, words, unit in output.features:
        row: dict[str, object] = {"feature": labelled(words, unit), "ours": _drawn(found.features, attribute, unit)}
        rows.append(row if stated is None else {**row, "stated": _drawn(stated, attribute, unit)})
    return pd.DataFrame(rows)


def _drawn(features: Features, attribute: str, unit: str) -> float:
    return float(in_unit(getattr(features, attribute), unit))


def masses_table(found: Outcome) -> pd.DataFrame:
    """Masses of all parts, and inertias of those that turn, as the rotor feels them."""
    rows = [*found.masses.rows]
    if found.gearbox_mass:
        rows.append(("gears", found.gearbox_mass, found.gearbox_inertia))
    rows.append(("casing, bearings, shafts", found.casing_mass, 0.0))
    rows.append(("whole", found.features.mass, found.masses.rotor_inertia + found.gearbox_inertia))
    table = pd.DataFrame(rows, columns=["part", "mass_kg", "inertia_kg_mm2"])
    return table.assign(inertia_kg_mm2=in_unit(table.inertia_kg_mm2, "kg_mm2"))


# ---- parts of the section -------------------------------------------------------------------------------------------


def _key_numbers(features: Features, output: Output) -> tuple[KeyNumber, ...]:
    return tuple(
        KeyNumber(words, float(f"{_drawn(features, attribute, unit):.4g}"), written(unit))
        for attribute, words, unit in output.features
    )


def _failures(found: Outcome, output: Output) -> tuple[Remark, ...]:
    table = checks_table(found, output)
    return tuple(
        Remark(
            f"{row.requirement} does not hold: {_shown(row.reached, row.unit)} reached, {row.sense} "
            f"{_shown(row.needed, row.unit)} asked ({row.margin_percent:.0f} %)."
        )
        for row in table[table.holds == "NO"].itertuples()
    )


def _remedy_table(found: Outcome, output: Output) -> tuple[Table, ...]:
    return (Table(remedies_table(found, output), _REMEDIES),) if found.remedies else ()


def _nearest(found: Outcome, output: Output) -> tuple[str | Table, ...]:
    """All levers together, and how the requirements stand then."""
    if found.nearest is None:
        return ()
    there = pd.DataFrame([_check_row(one, output) for one in found.nearest.checks])
    return (
        nearest_in_words(found.nearest, output),
        *_unmoved(found, found.nearest, output),
        Table(moves_table(found.nearest, output), _NEAREST),
        Table(there, "The requirements with these inputs."),
    )


def _unmoved(found: Outcome, nearest: NearestDesign, output: Output) -> Iterator[str]:
    """What does not hold and is not looked at again with the inputs moved: gears, strength and the like."""
    table = checks_table(found, output)
    moved = [one.requirement.name(output) for one in nearest.checks]
    short = table[(table.holds == "NO") & ~table.requirement.isin(moved)]
    if len(short):
        names = "; ".join(short.requirement)
        yield f"With the inputs moved these are not looked at again, and as it stands they do not hold: {names}."


def nearest_in_words(nearest: NearestDesign, output: Output) -> str:
    """Whether the same cross-section can meet all requirements, and which decide."""
    if nearest.holds:
        decide = [one.requirement.name(output) for one in nearest.checks if abs(one.margin) < DECIDES]
        moves = ", ".join(_move_in_words(move, output) for move in nearest.moves)
        asked = f"What decides: {', '.join(decide)}."
        return f"Nearest design of this cross-section that meets all requirements that move with it: {moves}. {asked}"
    short = [one for one in nearest.checks if not one.holds]
    fails = ", ".join(f"{one.requirement.name(output)} ({100 * one.margin:.0f} %)" for one in short)
    return (
        "No design of this cross-section was found that meets all requirements that move with these inputs, between a "
        f"third of their values and three times them. The one that comes nearest falls short in {fails}: try another "
        "radius. "
        f"{_proof_in_words(nearest.impossible, output)}"
    )


def _proof_in_words(proof: Impossibility | None, output: Output) -> str:
    """What is proved, and what was only searched."""
    if proof is None:
        return "That there is none was searched for and is not proved."
    names = ", ".join(one.name(output) for one in proof.requirements)
    if len(proof.requirements) == 1:
        what = f"{names} alone stays short by {_percent(proof)} % at least"
    else:
        what = f"{names} contradict each other, one of them stays short by {_percent(proof)} % at least"
    return (
        f"There is none, by bounds that hold wherever these inputs stand in that range: {what}, whatever field, "
        "winding and the control make of it. A bound counts the torque of the overload current without a limit on the "
        "voltage, and the power of bus and current without loss."
    )


def _percent(proof: Impossibility) -> str:
    """Rounded down, so that what is said stays true."""
    return f"{floor(1000 * proof.shortfall) / 10:g}"


def _move_in_words(move: Move, output: Output) -> str:
    unit = move.lever.unit(output)
    now, there = (f"{in_unit(value, unit):.4g}" for value in (move.now, move.value))
    return f"{move.lever.name()} {now} to {there} {written(unit)}".rstrip()


def _stated_heading(found: Outcome) -> dict[str, str]:
    return {} if found.stated is None else {"stated": found.stated.source}


def _load(found: Outcome) -> tuple[str, ...]:
    ratio = found.load_inertia_ratio
    if ratio is None:
        return ()
    return (f"The inertia of the load is {ratio:.3g} times that of the drive, both at the shaft.",)
