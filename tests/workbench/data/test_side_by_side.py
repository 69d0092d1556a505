"""Repeats that stand beside one another are the same campaign as those that a column counts."""

import numpy as np
import pytest

from workbench.data.campaign import read_campaign
from workbench.data.draft import draft_of
from workbench.errors import WorkbenchError

RANDOM = np.random.default_rng(5)
VELOCITY = np.linspace(-0.3, 0.3, 12)
FORCE = 900 * VELOCITY + 0.5 * RANDOM.standard_normal((3, 12))
HEAD = '[campaign]\nid = "c"\nrepeats = 3\nholdout = "none"\n[[table]]\nfile = "f.csv"\nkind = "damping_velocity"\n'
SPEED = '[table.columns]\n"v [m/s]" = { name = "velocity", unit = "m_per_s", role = "condition" }\n'
ROLE = 'role = "response", u_random = 0.5'
FORCES = f'"F1 [N]" = {{ name = "force", unit = "N", {ROLE}, repeats = ["F2 [N]", "F3 [N]"] }}\n'


def campaign(folder, heading, rows, columns):
    folder.mkdir()
    lines = [",".join(map(repr, map(float, row))) for row in rows]
    (folder / "f.csv").write_text("\n".join([heading, *lines]) + "\n")
    (folder / "campaign.toml").write_text(HEAD + SPEED + columns)
    return folder


def beside(folder, columns=FORCES, more=()):
    heading = ",".join(["v [m/s]", "F1 [N]", "F2 [N]", "F3 [N]", *(name for name, _ in more)])
    return campaign(folder, heading, np.column_stack([VELOCITY, *FORCE, *(values for _, values in more)]), columns)


def test_it_is_the_campaign_whose_repeats_are_counted(tmp_path):
    rows = np.column_stack([np.tile(VELOCITY, 3), FORCE.ravel(), np.repeat([0, 1, 2], 12)])
    counted = f'"F1 [N]" = {{ name = "force", unit = "N", {ROLE} }}\nrun = {{ role = "repeat" }}\n'
    below = campaign(tmp_path / "below", "v [m/s],F1 [N],run", rows, counted)
    (one,), (other,) = (read_campaign(folder).tables for folder in (beside(tmp_path / "beside"), below))
    assert np.array_equal(one.responses["force"].values, other.responses["force"].values)
    assert np.array_equal(one.conditions["velocity"], other.conditions["velocity"])
    assert np.array_equal(one.repeat, other.repeat) and np.array_equal(one.scan, other.scan)


def in_files(folder, change=lambda lines: lines, more='repeats = ["f 2.csv", "f 3.csv"]\n'):
    """One repeat a file; the change is to the last."""
    folder.mkdir()
    for k, force in enumerate(FORCE):
        lines = ["v [m/s],F1 [N]", *(f"{v!r},{f!r}" for v, f in zip(VELOCITY.tolist(), force.tolist()))]
        lines = change(lines) if k == 2 else lines
        (folder / ("f.csv" if k == 0 else f"f {k + 1}.csv")).write_text("\n".join(lines) + "\n")
    columns = f'"F1 [N]" = {{ name = "force", unit = "N", {ROLE} }}\n'
    (folder / "campaign.toml").write_text(HEAD + more + SPEED + columns)
    return folder


def test_files_that_repeat_one_another_are_one_table(tmp_path):
    one, other = read_campaign(beside(tmp_path / "beside")), read_campaign(in_files(tmp_path / "files"))
    (first,), (second,) = one.tables, other.tables
    assert np.array_equal(first.responses["force"].values, second.responses["force"].values)
    assert np.array_equal(first.repeat, second.repeat) and set(other.file_hashes) == {"f.csv", "f 2.csv", "f 3.csv"}


@pytest.mark.parametrize(
    "change, more, words",
    [
        (lambda lines: [x + ",1" for x in lines], 'repeats = "f 3.csv"\n', "f 3.csv: has other columns than f.csv"),
        (lambda lines: lines, 'repeats = ["f.csv"]\n', "file and repeats name a file twice"),
        (lambda lines: lines, 'repeats = ["f 4.csv"]\n', "the data file 'f 4.csv' of campaign.toml does not exist"),
    ],
)
def test_files_that_cannot_repeat_one_another_are_said(tmp_path, change, more, words):
    with pytest.raises(WorkbenchError) as said:
        read_campaign(in_files(tmp_path / "c", change, more))
    assert words in str(said.value)


def test_a_draft_takes_files_for_repeats_where_they_are_alike(tmp_path):
    """Of other velocities, of forces of another size or under another name they are tables of their own."""
    files = ["f.csv", "f 2.csv", "f 3.csv"]
    same = in_files(tmp_path / "same")
    assert 'repeats = ["f 2.csv", "f 3.csv"]' in draft_of([same / file for file in files])
    harder = [f"{v!r},{2 * f!r}" for v, f in zip(VELOCITY.tolist(), FORCE[2].tolist())]
    other = in_files(tmp_path / "other", lambda lines: [lines[0], *harder])
    assert draft_of([other / file for file in files]).count("[[table]]") == 2


def test_a_gap_is_said_with_its_line(tmp_path):
    folder = beside(tmp_path / "c")
    lines = (folder / "f.csv").read_text().splitlines()
    lines[4] = lines[4].rpartition(",")[0] + ",---"
    (folder / "f.csv").write_text("\n".join(lines) + "\n")
    found = read_campaign(folder)
    assert "1 of 36 rows have a gap or no number (first in line 5)" in " ".join(found.complaints)
    assert found.tables[0].rows == 35


VOLTAGE = ('"U [V]" = { name = "voltage", unit = "V", role = "response", u_random = 0.1 }\n', [("U [V]", VELOCITY)])


@pytest.mark.parametrize(
    "columns, more, words",
    [
        (FORCES.replace("F3", "F4"), [], "the column 'F4 [N]' of campaign.toml (columns) is not there"),
        (FORCES + VOLTAGE[0], VOLTAGE[1], "must be as many for every response; found 'F1 [N]' 3, 'U [V]' 1"),
        (FORCES + 'run = { role = "repeat" }\n', [("run", VELOCITY)], "and are counted by a column; keep one"),
    ],
)
def test_what_cannot_be_meant_is_one_sentence(tmp_path, columns, more, words):
    with pytest.raises(WorkbenchError) as said:
        read_campaign(beside(tmp_path / "c", columns, more))
    assert words in str(said.value)


def test_a_condition_has_no_repeats(tmp_path):
    with pytest.raises(WorkbenchError, match="repeats are of a response, and the role is condition"):
        read_campaign(beside(tmp_path / "c", FORCES.replace(ROLE, 'role = "condition"')))


@pytest.mark.parametrize("names", [("F1", "F2", "F3"), ("Kraft", "Kraft 2", "Kraft 3")])
def test_a_draft_takes_numbered_columns_for_repeats(tmp_path, names):
    """Their scatter is that of repeats."""
    draft = drafted(tmp_path, [f"{name} [N]" for name in names])
    assert f'repeats = ["{names[1]} [N]", "{names[2]} [N]"]' in draft
    assert "repeats = 3 " in draft and "scatter of repeated rows" in draft


@pytest.mark.parametrize("headings", [("F [N]", "F_links [N]", "F_rechts [N]"), ("F1 [N]", "F3 [N]", "F4 [N]")])
def test_other_columns_stay_unread(tmp_path, headings):
    draft = drafted(tmp_path, headings)
    assert "repeats = [" not in draft and draft.count("# not read") == 2


def drafted(folder, headings):
    rows = np.column_stack([VELOCITY, *FORCE])
    return draft_of([campaign(folder / "c", ",".join(["v [m/s]", *headings]), rows, "") / "f.csv"])
