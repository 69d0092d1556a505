"""The page of thesis chapters 4 and 5 for the actuator of a study: every table and figure beside the printed one."""

from __future__ import annotations

import pandas as pd

from bench.chapters import Chapters
from figures.files import File, table_file
from figures.report import Section, Table, render_report

PAGE, TABLE = "chapters.html", "chapters.csv"
# Where each of the thesis's tables and figures is, or why it is not.
PLACES = (
    ("Figs 4.1-4.4, 4.6-4.9, 4.11, 4.12, 4.14", "drawings of the model; the equations stand in the code's docstrings"),
    ("Fig. 4.5", "drive and losses in report.html: torque over speed, loss map"),
    ("Fig. 4.10, Table 4.5", "“Energy on the road” in report.html: the force loop, its margins, the loop for 60 Hz"),
    ("Figs 4.13, 4.15-4.18, Tables 4.1, 4.4", "“Control laws over their settings”"),
    ("Figs 4.19, 4.20, Tables 4.2, 4.3", "“On the benches of the thesis”, identified parameters"),
    ("Figs 4.21-4.55, Tables 4.6-4.14", "“In the thesis's quarter car”; of the own vehicle in report.html"),
    ("Figs 5.1, 5.2, 5.11, 5.14, 5.15", "photographs and drawings of the benches"),
    ("Fig. 5.3", "the open circuit in Fig. 5.4; gears and bearings apart are no parts of the model"),
    ("Figs 5.5, 5.7", "records over time of tests at constant speed; their steady values stand in Figs 5.6 and 5.8"),
    ("Figs 5.4, 5.6, 5.8-5.10, 5.12, 5.13, B.1, B.2, Tables 5.1, B.1", "“On the benches of the thesis”"),
    ("Table 5.2", "printed in “On the benches of the thesis”; not computed, nothing here knows how a casing radiates"),
    ("Figs 5.16, 5.17", "“On the benches of the thesis”, in the loop; “airgap hil” by the clock"),
)  # fmt: skip


def section(found: Chapters) -> Section:
    """The headline numbers, and where the rest is."""
    names = {"place": "thesis", "quantity": "quantity", "here": "here", "printed": "printed"}
    rows = [{words: getattr(one, name) for name, words in names.items()} for one in found.rows]
    return Section(
        "Beside the thesis",
        (
            "What the thesis's chapters 4 and 5 find of its automotive prototype, found of the actuator of this study. "
            "Where the study states no mount, lag or force loop of its own, the prototype's stand in (Tables 4.2 and "
            "4.5): what depends on them says little about this actuator until it is measured.",
            Table(pd.DataFrame(rows), "Headline numbers."),
            Table(pd.DataFrame(PLACES, columns=["thesis", "here"]), "Where every table and figure is."),
        ),
    )


def page(sections: tuple[Section, ...]) -> File:
    """The page with these sections; their pictures lie beside it."""
    title, subtitle = "Chapters 4 and 5 of the thesis with this actuator", "Tables and figures beside the printed ones"
    return File(
        PAGE,
        lambda path: path.write_text(
            render_report(sections, path.parent, title=title, subtitle=subtitle), encoding="utf-8"
        ),
    )


def table(found: Chapters) -> File:
    """The headline numbers."""
    return table_file(TABLE, pd.DataFrame([vars(one) for one in found.rows]))
