"""The search over everything for people: designs solved by the field, what the stages leave on the table, the front."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd
from matplotlib.figure import Figure

from drivetrain.whole_design import RatedDesign
from drivetrain.whole_search import Bettered, SolvedDesign, WholeSearch
from figures.files import File, figure_file, table_file, text_file
from figures.report import Picture, Section, Table, render_report
from figures.whole_design import whole_designs
from units import FACTORS, MILLIMETRE

TABLE, PAGE, FIGURE = "optimise.csv", "optimise.html", "whole_designs"
_UNITS = (("mass_kg", "kg"), ("equivalent_mass_kg", "kg"), ("damping_kNs_per_m", "kNs_per_m"), ("road_loss_W", "W"))
_TEXT = (
    "Slot count, radius, active length, ratio and linkage are varied together against the design that match and "
    "linkage arrived at one after the other. The model is that of the match: fits of the cross-section, masses of the "
    "drawn parts, scaling laws of the gears. The loss on the road is copper loss of the RMS force and idle loss of "
    "iron and magnets at the RMS velocity. Copper loss alone would be the inverse of the damping; the idle loss is "
    "smaller with a larger transmission ratio, which turns the rotor more slowly, and sets the two against each other."
)


def files(found: WholeSearch) -> Iterator[File]:
    """Designs solved by the field, the figure of the front, and the page that shows both."""
    table, figure = solved_table(found), front_figure(found)
    yield table_file(TABLE, table)
    yield figure_file(FIGURE, figure)
    title, subtitle = "All stages optimised together", "Against the design found stage by stage"
    yield text_file(PAGE, render_report(sections(found, figure), title=title, subtitle=subtitle))


def sections(found: WholeSearch, figure: Figure) -> tuple[Section, ...]:
    """What the stages leave on the table, and the front; figure: as ``front_figure`` draws it."""
    caption = "Mass and inertia in kg, damping in kNs/m, loss in W; by the model."
    solved = "Designs solved by the field. Constraint excess above 0: the fits promised too much."
    return (
        Section("What the stages leave on the table", (_TEXT, Table(gains(found), caption))),
        Section(
            "The front",
            (
                f"{len(found.front)} designs, {len(found.solved)} solved by the field. {_fit_error(found)} "
                f"{idle_share(found)}",
                Picture(figure, "Every pair of objectives."),
                Table(solved_table(found), solved),
            ),
        ),
    )


def solved_table(found: WholeSearch) -> pd.DataFrame:
    """Designs solved by the field, in drawing units."""
    return pd.DataFrame([_row(one) for one in found.solved])


def gains(found: WholeSearch) -> pd.DataFrame:
    """What the stages leave on the table, one row a question."""
    return pd.DataFrame([_gain(found.staged, one) for one in found.bettered])


def idle_share(found: WholeSearch) -> str:
    """How much of the loss on the road is not F^2 over the damping, in words."""
    shares = [
        100 * (1 - found.force_rms**2 / damping / loss)
        for *_, damping, loss in (one.values.objectives for one in found.front)
    ]
    return f"Idle loss is {min(shares):.0f} to {max(shares):.0f} % of the loss on the road over the front."


def front_figure(found: WholeSearch) -> Figure:
    """Every pair of objectives: front by the model, points solved by the field, the design found stage by stage."""
    front = pd.DataFrame([_objectives(one) for one in found.front])
    staged, *others = ([_objectives(one.field) for one in found.solved])
    return whole_designs(front, pd.DataFrame(others), pd.Series(staged))


def _objectives(one: RatedDesign) -> dict[str, float]:
    """Objectives in drawing units."""
    return {name: value / FACTORS[unit] for (name, unit), value in zip(_UNITS, one.values.objectives, strict=True)}


def _row(one: SolvedDesign) -> dict[str, object]:
    design, by_fits = one.model.design, _objectives(one.model)
    return {
        "design": one.name,
        "slots": design.slots,
        "stator_diameter_mm": 2 * design.stator_outer_radius / MILLIMETRE,
        "active_length_mm": design.active_length / MILLIMETRE,
        "transmission_ratio_mm_per_rad": design.transmission_ratio / FACTORS["mm_per_rad"],
        "linkage_ratio_mm_per_rad": design.linkage_ratio / FACTORS["mm_per_rad"],
        **_objectives(one.field),
        "damping_of_the_fits_kNs_per_m": by_fits["damping_kNs_per_m"],
        "road_loss_of_the_fits_W": by_fits["road_loss_W"],
        "constraint_excess_percent": 100 * max(one.field.values.constraints),
    }


def _gain(staged: RatedDesign, one: Bettered) -> dict[str, object]:
    name, _ = _UNITS[one.question.objective]
    old, new = (_objectives(rated)[name] for rated in (staged, one.found))
    return {
        "what is bettered": one.question.words,
        "stage by stage": old,
        "together": new,
        "change_percent": 100 * (new / old - 1),
        "slots": one.found.design.slots,
        "stator_diameter_mm": 2 * one.found.design.stator_outer_radius / MILLIMETRE,
    }


def _fit_error(found: WholeSearch) -> str:
    """How far the fits are from the field in the damping."""
    apart = max(abs(one.field.values.objectives[2] / one.model.values.objectives[2] - 1) for one in found.solved)
    return f"The damping of the fits is off by up to {apart:.1%}."
