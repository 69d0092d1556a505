"""What is wrong in the tables and curves that came with built machines is said without a model."""

from dataclasses import replace
from pathlib import Path

import pytest

from materials.errors import MaterialError
from materials.library import load_steel
from workbench.data.campaign import read_campaign
from workbench.data.checks import checks_of

MEASUREMENTS = Path(__file__).resolve().parents[2] / "measurements"
CAMPAIGN = """
[campaign]
holdout = "none"
[device]
machine_file = "szesynrm"
poles = 4
phase_resistance_mohm = 139
[[table]]
file = "{file}"
kind = "{kind}"
u_random = {u}
"""


def campaign(folder, kind, u, text):
    (folder / "table.csv").write_text(text, encoding="utf-8")
    (folder / "campaign.toml").write_text(CAMPAIGN.format(file="table.csv", kind=kind, u=u), encoding="utf-8")
    return read_campaign(folder)


def test_two_tables_of_one_measurement_at_other_angles_are_seen(tmp_path):
    """The source has its readings at 30 A twice, the positive angles of one table up to 2 degrees smaller."""
    entry = '[[table]]\nfile = "{}.csv"\nkind = "locked_rotor"\nu_random = {{ torque_Nm = 0.1 }}\n'
    for name in ("torque_angle", "other_table_30A"):
        (tmp_path / f"{name}.csv").write_bytes((MEASUREMENTS / "synrm-48-4" / f"{name}.csv").read_bytes())
    both = "".join(entry.format(name) for name in ("torque_angle", "other_table_30A"))
    (tmp_path / "campaign.toml").write_text('[campaign]\nholdout = "none"\n' + both, encoding="utf-8")
    found = read_campaign(tmp_path)
    (said,) = checks_of(found)
    assert "the same" in said and "angle_mech differ by up to 4.6 %" in said
    assert checks_of(replace(found, tables=found.tables[:1])) == ()


def test_tables_with_readings_of_their_own_are_not_compared():
    found = read_campaign(MEASUREMENTS / "prius-2004")
    assert not [s for s in checks_of(found) if "the same" in s]


@pytest.mark.parametrize(("poles", "said"), [(4, 0), (8, 1)])
def test_positions_that_the_source_calls_electrical_are_mechanical(poles, said):
    """The inductance between lines repeats after 90 degrees; electrical ones would repeat after 180."""
    found = read_campaign(MEASUREMENTS / "synrm-48-4")
    device = {**found.device, "poles": poles}
    assert len([s for s in checks_of(replace(found, device=device)) if "exchanged" in s]) == said


def test_electrical_positions_are_said(tmp_path):
    lines = (MEASUREMENTS / "synrm-48-4" / "inductance.csv").read_text(encoding="utf-8").splitlines()[1:]
    halved = "\n".join(f"{float(a) / 2},{value}" for a, value in (line.split(",") for line in lines))
    found = campaign(tmp_path, "inductance", "{ l_bc_mH = 0.1 }", "angle_mech_deg,l_bc_mH\n" + halved)
    (said,) = [s for s in checks_of(found) if "exchanged" in s]
    assert "repeats after 45 deg" in said and "after 90 deg" in said


@pytest.mark.parametrize(("between", "said"), [(138.8, 1), (277.6, 0)])
def test_a_resistance_between_lines_is_none_of_a_phase(tmp_path, between, said):
    """The outrunner's source says that it halves 142.4, 140.2 and 133.8 mohm, and prints 139."""
    text = f"winding_T_degC,r_ab_mohm\n20,{between}\n"
    found = checks_of(campaign(tmp_path, "phase_resistance", "{ r_ab_mohm = 0.5 }", text))
    assert len([s for s in found if "is that between lines" in s]) == said


def test_a_curve_with_two_values_at_one_field_is_refused():
    with pytest.raises(MaterialError, match="H = 195 A/m.*does not increase"):
        load_steel(str(MEASUREMENTS / "synrm-48-4" / "S235_as_given_bh.csv"))


def test_the_same_curve_falls_below_vacuum(tmp_path):
    """Beyond 42 kA/m B rises by less than mu_0 H: the polarisation would fall."""
    lines = (MEASUREMENTS / "synrm-48-4" / "S235_as_given_bh.csv").read_text(encoding="utf-8").splitlines()
    once = [line for line in lines if not line.startswith("195,1.0440")]
    assert len(once) == len(lines) - 1
    (tmp_path / "once.csv").write_text("\n".join(once), encoding="utf-8")
    with pytest.raises(MaterialError, match="vacuum|mu_0|flatter"):
        load_steel(str(tmp_path / "once.csv"))
