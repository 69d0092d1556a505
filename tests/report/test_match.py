"""The match for people: names and columns of the files, and what the section says."""

import re
from dataclasses import replace

import pytest

from drivetrain.finding import Sentence
from drivetrain.matching import NamedMatch
from drivetrain.output import Shaft, Wheel
from figures.report import Remark, Table
from report.match import PARTS, TABLE, files, over_radius, parts_table, remarks, section
from tests.drivetrain.test_matching import STATED, no_field, stage


@pytest.fixture(scope="module")
def found():
    with no_field():
        return stage(stated=STATED)


def texts(page):
    return " ".join(getattr(part, "text", part) for part in page.content if isinstance(part, (str, Remark)))


def test_files(found):
    names = {file.name for file in files(found, Wheel())}
    assert names == {TABLE, PARTS, "figures/match_curves.png", "figures/match_over_radius.png"}


def test_table_over_the_radius(found):
    table = over_radius(found, Wheel())
    assert list(table.columns) == [
        "slots", "poles", "overload", "stator_outer_radius_mm", "transmission_ratio_mm_per_rad", "active_length_mm",
        "cost",
    ]  # fmt: skip
    assert set(table.slots) == {9, 12} and set(table.overload) == {"field", "linear"}


def test_parts_in_drawing_units(found):
    table = parts_table(found.parts).set_index("part")
    assert table.mass_kg["active parts"] == pytest.approx(found.parts.total)
    assert table.inertia_kg_mm2["active parts"] == pytest.approx(found.parts.rotor_inertia * 1e6)
    assert table.inertia_kg_mm2["stator laminations"] == 0


def test_the_section_says_what_must_not_be_overlooked(found):
    page = section(found, Wheel())
    said = texts(page)
    assert "Decision: chosen in the study file" in said and "sweep.stator_diameters_mm" in said
    assert f"{found.parts.total:.2f} kg" in said and f"{found.cylinder_mass:.2f} kg" in said
    assert "40.3 mm" in said and "35.5 mm seem to be enough" in said
    machines = next(part for part in page.content if isinstance(part, Table) and "beside the machine" in part.caption)
    assert list(machines.frame.machine) == [
        "chosen machine", "reference machine, field torque", "reference machine, field torque, cylinder of steel",
        "reference machine, torque stated by thesis",
    ]  # fmt: skip


def test_what_the_run_says_at_once(found):
    said = list(remarks(found, Wheel()))
    assert said[0].startswith("chosen in the study file")
    assert "the true minimum is outside: add smaller diameters to sweep.stator_diameters_mm" in said[1]


def test_on_a_shaft_nothing_of_a_wheel_is_said(found):
    page = section(found, Shaft())
    tables = [part.frame for part in page.content if isinstance(part, Table)]
    said = " ".join([texts(page), *remarks(found, Shaft()), *(frame.to_csv() for frame in tables)])
    assert "Nms/rad below the requirement" in said and "overload torque" in said and "inertia_kg_m2" in said
    assert not re.search("wheel|kNs|mm_per_rad|mm/rad|force|equivalent", said)


def test_the_section_without_matches_beside(found):

    none = NamedMatch("reference machine, field torque", "", None, Sentence("the force is too large"))
    stated = NamedMatch("stated values", "", None, Sentence("too far"))
    said = texts(section(replace(found, reference=none, reference_cylinder=None, printed=None, stated=stated), Wheel()))
    assert "no match, the force is too large" in said and "there is no match: too far" in said
