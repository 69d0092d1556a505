"""The search over everything for people: designs solved by the field, what the stages leave on the table, the front."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd
from matplotlib.figure import Figure

from drivetrain.output import Output, in_unit, labelled
from drivetrain.whole_design import Aims, RatedDesign
from drivetrain.whole_search import Bettered, SolvedDesign, WholeSearch, objective_words
from figures.files import File, figure_file, table_file, text_file
from figures.report import Picture, Remark, Section, Table, render_report
from figures.whole_design import whole_designs
from units import MILLIMETRE, percent, written

TABLE, PAGE, FIGURE = "optimise.csv", "optimise.html", "whole_designs"


def files(found: WholeSearch, aims: Aims, output: Output) -> Iterator[File]:
    """Designs solved by the field, the figure of the front, and the page that shows both."""
    table, figure = solved_table(found, output), front_figure(found, output)
    yield table_file(TABLE, table)
    yield figure_file(FIGURE, figure)
    title, subtitle = "All stages optimised together", "Against the design found stage by stage"
    yield text_file(PAGE, render_report(sections(found, figure, aims, output), title=title, subtitle=subtitle))


def sections(found: WholeSearch, figure: Figure, aims: Aims, output: Output) -> tuple[Section, ...]:
    """What the stages leave on the table, and the front; figure: as ``front_figure`` draws it."""
    inertia, damping = written(output.inertia_unit), written(output.damping_unit)
    caption = f"Mass in kg, {output.inertia} in {inertia}, damping in {damping}, loss in W; by the model."
    solved = "Designs solved by the field. Constraint excess above 0: the fits promised too much."
    return (
        Section("What the stages leave on the table", (_text(output), Table(gains(found, output), caption))),
        Section(
            "The front",
            (
                f"Searched for {aims.words}. {len(found.front)} designs, {len(found.solved)} solved by the field. "
                f"{_fit_error(found)} "
                f"{idle_share(found, output)}",
                Picture(figure, "Every pair of objectives."),
                Table(solved_table(found, output), solved),
                *(Remark(f"{said[:1].upper()}{said[1:]}.") for said in bound_hits(found, output)),
            ),
        ),
    )


def remarks(found: WholeSearch, output: Output) -> Iterator[str]:
    """What the run says at once: designs on an end of what could be chosen, and how one is taken over."""
    yield from bound_hits(found, output)
    yield "`airgap take-over STUDY --design NUMBER` makes a study of a design of optimise.csv"


def bound_hits(found: WholeSearch, output: Output) -> Iterator[str]:
    """Solved designs on an end of the search, each end with all its designs."""
    ends: dict[str, list[str]] = {}
    for number, one in enumerate(found.solved, start=1):
        for words in found.choices.hits(one.model.design):
            ends.setdefault(words, []).append(str(number))
    for words, numbers in ends.items():
        yield f"design{'s' * (len(numbers) > 1)} {', '.join(numbers)} {_LIE[len(numbers) > 1]} on {words}"


_LIE = ("lies", "lie")


def _text(output: Output) -> str:
    return (
        f"Slots, poles, radius, active length, {output.transmission} are varied together against the design that was "
        "found stage by stage. The model is that of the match: fits of the cross-section, masses of the drawn parts, "
        f"scaling laws of the gears. The loss {output.duty} is copper loss of the RMS {output.effort} and idle loss of "
        f"iron and magnets at a {output.speed} that is normally distributed with the RMS value. Copper loss alone "
        "would be the inverse of the damping; the idle loss is smaller where the rotor turns more slowly for the same "
        f"{output.speed}, and sets the two against each other."
    )


def solved_table(found: WholeSearch, output: Output) -> pd.DataFrame:
    """Designs solved by the field, in drawing units."""
    rows = enumerate(zip(_names(found, output), found.solved, strict=True), start=1)
    return pd.DataFrame([{"number": number} | _row(name, one, output) for number, (name, one) in rows])


def _names(found: WholeSearch, output: Output) -> list[str]:
    """Of the designs that the field solved: staged, bettered and some of the front."""
    questions = [one.question.words(output) for one in found.bettered]
    points = len(found.solved) - len(questions) - 1
    return ["stage by stage", *questions, *(f"front {k}" for k in range(1, points + 1))]


def gains(found: WholeSearch, output: Output) -> pd.DataFrame:
    """What the stages leave on the table, one row a question."""
    return pd.DataFrame([_gain(found.staged, one, output) for one in found.bettered])


def idle_share(found: WholeSearch, output: Output) -> str:
    """How much of the loss on the road is not F^2 over the damping, in words."""
    shares = [
        100 * (1 - found.force_rms**2 / damping / loss)
        for *_, damping, loss in (one.values.objectives for one in found.front)
    ]
    return f"Idle loss is {min(shares):.0f} to {max(shares):.0f} % of the loss {output.duty} over the front."


def front_figure(found: WholeSearch, output: Output) -> Figure:
    """Every pair of objectives: front by the model, points solved by the field, the design found stage by stage."""
    front = pd.DataFrame([_objectives(one, output) for one in found.front])
    staged, *others = [_objectives(one.field, output) for one in found.solved]
    words = zip(objective_words(output), (unit for _, unit in _columns(output)), strict=True)
    labels = {name: labelled(*label) for (name, _), label in zip(_columns(output), words, strict=True)}
    return whole_designs(front, pd.DataFrame(others), pd.Series(staged), labels)


def _columns(output: Output) -> tuple[tuple[str, str], ...]:
    """(name of the column, unit) of the objectives."""
    damping = output.column("damping", output.damping_unit)
    return (
        ("mass_kg", "kg"),
        (output.inertia_column, output.inertia_unit),
        (damping, output.damping_unit),
        (f"{output.duty_name}_loss_W", "W"),
    )


def _objectives(one: RatedDesign, output: Output) -> dict[str, float]:
    """Objectives in drawing units."""
    columns = zip(_columns(output), one.values.objectives, strict=True)
    return {name: float(in_unit(value, unit)) for (name, unit), value in columns}


def _row(name: str, one: SolvedDesign, output: Output) -> dict[str, object]:
    design, fitted = one.model.design, list(_objectives(one.model, output).values())
    damping, loss = (column for column, _ in _columns(output)[2:])
    return {
        "design": name,
        "slots": design.combination.slots,
        "poles": design.combination.poles,
        "stator_diameter_mm": 2 * design.stator_outer_radius / MILLIMETRE,
        "active_length_mm": design.active_length / MILLIMETRE,
        **output.ratio_columns(design.transmission_ratio, design.linkage_ratio),
        **_objectives(one.field, output),
        damping.replace("damping", "damping_of_the_fits"): fitted[2],
        loss.replace("loss", "loss_of_the_fits"): fitted[3],
        "constraint_excess_percent": 100 * max(one.field.values.constraints),
    }


def _gain(staged: RatedDesign, one: Bettered, output: Output) -> dict[str, object]:
    name, _ = _columns(output)[one.question.objective]
    old, new = (_objectives(rated, output)[name] for rated in (staged, one.found))
    return {
        "what is bettered": one.question.words(output),
        "stage by stage": old,
        "together": new,
        "change_percent": 100 * (new / old - 1),
        "slots": one.found.design.combination.slots,
        "poles": one.found.design.combination.poles,
        "stator_diameter_mm": 2 * one.found.design.stator_outer_radius / MILLIMETRE,
    }


def _fit_error(found: WholeSearch) -> str:
    """How far the fits are from the field in the damping."""
    apart = max(abs(one.field.values.objectives[2] / one.model.values.objectives[2] - 1) for one in found.solved)
    return f"The damping of the fits is off by up to {percent(apart, 1)}."
