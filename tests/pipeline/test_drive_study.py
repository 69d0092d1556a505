"""A load on a shaft from the study file to the report: its own words and units, and no damping asked for."""

import html
import re

import pandas as pd
import pytest
from small_studies import fitted, here, small

# What a shaft does not have; flux linkages and loads of bearings and magnets it has.
FOREIGN = re.compile(
    r"wheel|vehicle|motorcycle|suspension|\broad|\bride\b|\bforce|equivalent.mass|(?<!flux )\blinkage|"
    r"kNs|Ns/m|mm/rad|mm_per_rad|m/s\b|m_per_s\b|\d N\b|(?<!load )(?<!magnet )/ N\b|(?<!load)_N\b",
    re.IGNORECASE,
)


def read_text(path):
    """What a person reads of a file, without its pictures."""
    text = re.sub(r"<(style|script).*?</\1>", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
    return html.unescape(re.sub(r"<[^>]*>", " ", text))


def foreign(text):
    return [text[max(0, one.start() - 40) : one.end() + 20] for one in FOREIGN.finditer(text)]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The robot joint, coarse, with a damping of zero that is stated."""
    folder = tmp_path_factory.mktemp("joint")
    changes = {"gearbox__ratio_tolerance": "0.008", "drive__damping_Nms_per_rad": "0.0"}
    study = small("robot_joint", folder, **changes)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("drivetrain.matching.RADII", 8)
        patch.setattr("losses.map.STEPS", 6)
        patch.setattr("magnetostatics.rotation.COGGING_STEPS", 3)
        patch.setattr("losses.map.DIRECT", (-1.0, -0.5, 0.0, 0.75))
        patch.setattr("uncertainty.match_spread.DRAWS", 4)
        patch.setattr("uncertainty.match_spread.FREE_DRAWS", 2)
        patch.setattr("uncertainty.scatter.STEPS", 2)
        patch.setattr("uncertainty.field_slopes._STEPS", 12)
        patch.setattr("uncertainty.field_slopes._OF_THE_FINER_MESH", 1)
        patch.setattr("losses.map.QUADRATURE", (0.0, 0.25, 0.5, 1.0))
        return here(study, folder / "results", fitted(study, without=("fields",)))


def test_it_ends_well(run):
    assert run.failures == []


def test_the_report_speaks_of_a_shaft_and_of_nothing_else(run):
    text = read_text(run.results.folder / "report.html")
    assert not foreign(text)
    for words in ("peak torque at the shaft", "overload torque", "speed peak / rpm", "Nms/rad", "kg m²"):
        assert words in text, words


def test_no_table_speaks_of_anything_else(run):
    tables = sorted(run.results.folder.glob("*.csv"))
    assert len(tables) > 8
    assert {path.name: foreign(path.read_text(encoding="utf-8")) for path in tables} == {p.name: [] for p in tables}


def test_a_damping_of_zero_holds_by_itself(run):
    table = pd.read_csv(run.results.folder / "outcome_requirements.csv").set_index("requirement")
    row = table.loc["short-circuit damping at low speed"]
    assert (row.needed, row.unit, row.holds) == (0.0, "Nms/rad", "yes")


def test_the_foreign_words_would_be_found():
    for text in ("at the wheel", "27.4 kNs/m", "2.3 mm/rad", "2614 N", "force_rms_N", "overload force", "the linkage"):
        assert foreign(text), text
    assert not foreign("Flux linkages in Nm, 12 Nm/m and kg m²")
