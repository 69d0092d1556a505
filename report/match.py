"""The match for people: the table over the stator radius, its two figures, and the report's section with the masses."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from drivetrain.masses import PartMasses
from drivetrain.match import Match
from drivetrain.matching import MatchOutcome, NamedMatch
from drivetrain.output import Output, in_unit
from figures.files import File, figure_file, picture_name, table_file
from figures.match import best_row, match_curves, match_over_radius, radius_table
from figures.report import Picture, Remark, Section, Table
from geometry.family import Combination
from units import FACTORS, MILLIMETRE

TABLE, PARTS = "match.csv", "part_masses.csv"


def files(found: MatchOutcome, output: Output) -> Iterator[File]:
    """Matches over the stator radius, masses of the parts, and the figures."""
    chosen, machine, table = found.chosen, found.machine, over_radius(found, output)
    yield table_file(TABLE, table)
    yield table_file(PARTS, parts_table(found.parts))
    title = f"{Combination.of(machine).words}, Ø {2 * machine.stator_outer_radius / MILLIMETRE:.4g} mm"
    curves = match_curves(found.curves, chosen, output=output, title=title, length_limit=found.length_limit)
    yield figure_file("match_curves", curves)
    best = best_row(Combination.of(machine), found.overload.name, machine.stator_outer_radius, chosen, output)
    yield figure_file("match_over_radius", match_over_radius(table, output, best=best))


def section(found: MatchOutcome, output: Output) -> Section:
    """Gearbox and motor, what the motor weighs, and what stands beside the choice."""
    beside = [one for one in (found.reference, found.reference_cylinder, found.printed) if one is not None]
    caption = "The chosen machine beside the machine of the study file, which is matched as stated."
    return Section(
        "Gearbox and motor matched",
        (
            Picture(
                picture_name("match_curves"),
                "Active length asked for by each constraint, and the cost, over the transmission ratio.",
            ),
            Picture(
                picture_name("match_over_radius"),
                "Best match over the stator radius; solid with solved, dashed with scaled overload torque.",
            ),
            f"Decision: {found.reason}.",
            *(Remark(f"{_sentence(note.words(output))}.") for note in found.notes),
            *_refusals(found, output),
            *_stated(found, output),
            Table(_machines(found.chosen, beside, output), caption),
            *(Remark(f"{one.name}: {note}.") for one in beside for note in _notes(one, output)),
            *_assumption(found),
            _cylinder(found),
            Table(parts_table(found.parts), "Active parts at the matched length; inertias about the rotor's axis."),
        ),
    )


def remarks(found: MatchOutcome, output: Output) -> Iterator[str]:
    """What the run says at once: the decision, and what must not be overlooked."""
    yield found.reason
    yield from (note.words(output) for note in found.notes)


def over_radius(found: MatchOutcome, output: Output) -> pd.DataFrame:
    """One row per slot-pole combination, overload law and stator radius; NaN where there is no match."""
    tables = [
        radius_table(one.combination, one.overload.name, one.over_radius, output)
        for one in found.over_radius
        if one.over_radius is not None
    ]
    return pd.concat(tables, ignore_index=True)


def parts_table(parts: PartMasses) -> pd.DataFrame:
    """Masses of the parts, and inertias of those that turn."""
    rows = [(name, mass, inertia / FACTORS["kg_mm2"]) for name, mass, inertia in parts.rows]
    return pd.DataFrame(rows, columns=["part", "mass_kg", "inertia_kg_mm2"])


def _row(name: str, one: Match, output: Output) -> dict[str, object]:
    section = one.section
    return {
        "machine": name,
        "stator_outer_radius_mm": section.machine.stator_outer_radius / MILLIMETRE,
        "torque_nominal_Nm_per_m": section.torque_per_length_nominal,
        "torque_overload_Nm_per_m": section.torque_per_length_overload,
        output.column("transmission_ratio", output.ratio_unit): in_unit(one.transmission_ratio, output.ratio_unit),
        "active_length_mm": one.active_length / MILLIMETRE,
        "cost": one.total_cost,
        "mass_kg": one.cost.mass,
        output.inertia_column: one.cost.equivalent_mass,
        "binding": one.binding.name(output),
    }


def _machines(chosen: Match, beside: list[NamedMatch], output: Output) -> pd.DataFrame:
    rows = [_row("chosen machine", chosen, output)]
    return pd.DataFrame(rows + [_row(one.name, one.match, output) for one in beside if one.match is not None])


def _notes(one: NamedMatch, output: Output) -> tuple[str, ...]:
    """What a match violates, or why there is none."""
    if one.refusal is not None:
        return (f"no match, {one.refusal.words(output)}",)
    return () if one.match is None else tuple(note.words(output) for note in one.match.notes)


def _refusals(found: MatchOutcome, output: Output) -> tuple[Remark, ...]:
    """Slot-pole combinations without a match."""
    said = [(one, one.refusal.words(output)) for one in found.over_radius if one.refusal is not None]
    return tuple(Remark(f"{one.combination.words}, overload torque {one.overload.name}: {why}.") for one, why in said)


def _stated(found: MatchOutcome, output: Output) -> tuple[Table | Remark, ...]:
    """The chosen cross-section under either feed."""
    other = found.stated
    if other is None:
        return ()
    if other.refusal is not None:
        why = other.refusal.words(output)
        return (Remark(f"With the stated requirements and linkage there is no match: {why}."),)
    if other.match is None:
        return ()
    rows = [_row("vehicle and front", found.chosen, output), _row(other.name, other.match, output)]
    fed = pd.DataFrame(rows).rename(columns={"machine": "fed by"})
    shown = fed.drop(columns=["stator_outer_radius_mm", "torque_nominal_Nm_per_m", "torque_overload_Nm_per_m"])
    notes = (Remark(f"With the stated values: {note.words(output)}.") for note in other.match.notes)
    return (Table(shown, "The chosen cross-section, matched with either feed."), *notes)


def _assumption(found: MatchOutcome) -> tuple[str, ...]:
    """What the linear overload torque would save, both as a cylinder of steel."""
    both = (found.reference_cylinder, found.printed)
    lengths = [one.match.active_length / MILLIMETRE for one in both if one is not None and one.match is not None]
    if len(lengths) < len(both):
        return ()
    return (
        f"With the torque solved at the overload, the reference machine as a cylinder of steel needs {lengths[0]:.1f} "
        f"mm; with the stated torque scaled linearly {lengths[1]:.1f} mm seem to be enough.",
    )


def _cylinder(found: MatchOutcome) -> str:
    """What the drawn parts weigh against the thesis's cylinder."""
    return (
        f"The active parts weigh {found.parts.total:.2f} kg as they are drawn; the solid cylinder of steel that the "
        f"thesis takes for the motor (eq. 3.101) would weigh {found.cylinder_mass:.2f} kg. The cost counts "
        "the parts."
    )


def _sentence(note: str) -> str:
    return note[:1].upper() + note[1:]
