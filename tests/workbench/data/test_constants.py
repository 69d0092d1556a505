"""A condition that was the same in all rows is said once, in campaign.toml, and is what a column of it would be."""

import numpy as np
import pytest

from workbench.data.campaign import read_campaign
from workbench.data.draft import draft_of
from workbench.data.table import OPEN_CIRCUIT
from workbench.errors import WorkbenchError

VELOCITY = (-0.2, -0.1, 0.1, 0.2)
HEAD = '[campaign]\nid = "c"\nholdout = "none"\n[[table]]\nfile = "f.csv"\nkind = "damping_velocity"\n'
BY_NAMES = "u_random = { force_N = 0.5 }\n"
DECLARED = (
    '[table.columns]\nvelocity = { from = "v", unit = "m/s", role = "condition" }\n'
    'force = { from = "F", unit = "N", role = "response", u = 0.5 }\n'
)


def table(folder, said, headings="velocity_m_per_s,force_N", more=""):
    folder.mkdir(exist_ok=True)
    rows = [f"{v},{900 * v}{more}" for v in VELOCITY]
    (folder / "f.csv").write_text("\n".join([headings, *rows]) + "\n")
    (folder / "campaign.toml").write_text(HEAD + said)
    (found,) = read_campaign(folder).tables
    return found


@pytest.mark.parametrize("headings, columns", [("velocity_m_per_s,force_N", BY_NAMES), ("v,F", DECLARED)])
def test_it_is_what_a_column_would_be(tmp_path, headings, columns):
    found = table(tmp_path, "constants = { shunt_mohm = 1500, winding_T_degC = 40 }\n" + columns, headings)
    held = table(tmp_path / "held", BY_NAMES, "velocity_m_per_s,force_N,shunt_mohm,winding_T_degC", ",1500,40")
    assert set(found.conditions) == set(held.conditions) == {"velocity", "shunt", "winding_T"}
    for name, values in held.conditions.items():
        assert np.array_equal(found.conditions[name], values) and len(values) == len(VELOCITY)
    assert found.conditions["shunt"][0] == 1.5 and found.rows == len(VELOCITY)


def test_terminals_may_be_open_in_all_rows(tmp_path):
    assert (table(tmp_path, "constants = { shunt_ohm = inf }\n" + BY_NAMES).conditions["shunt"] == OPEN_CIRCUIT).all()


@pytest.mark.parametrize(
    "said, sentence",
    [
        (
            "{ velocity_m_per_s = 0.1 }",
            "'velocity_m_per_s' is a constant in campaign.toml, and the file has the column",
        ),
        ("{ shunt = 1.5 }", "column 'shunt' has no unit"),
        ("{ shunt_N = 1.5 }", "shunt"),
        ("{ shunt_ohm = true }", "table 1, constants 'shunt_ohm': must be a number, the same for all rows"),
        ("{ shunt_ohm = -1.0 }", "shunt must not be negative"),
    ],
)
def test_what_cannot_be_is_said(tmp_path, said, sentence):
    with pytest.raises(WorkbenchError, match=sentence):
        table(tmp_path, f"constants = {said}\n{BY_NAMES}")


def test_a_draft_asks_for_what_no_column_holds(tmp_path):
    (tmp_path / "f.csv").write_text("velocity [m/s];force [N]\n" + "\n".join(f"{v};{900 * v}" for v in VELOCITY))
    assert "# constants = { shunt_ohm = ? }" in draft_of([tmp_path / "f.csv"])
    (tmp_path / "f.csv").write_text("velocity [m/s];shunt [Ohm];force [N]\n0.1;1;90\n0.2;1;180\n0.3;2;200\n")
    assert "constants" not in draft_of([tmp_path / "f.csv"])
