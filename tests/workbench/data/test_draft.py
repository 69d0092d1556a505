"""From a laboratory's own file to an answer: ``airgap import``, at most five lines filled in, no file rewritten."""

import re

import numpy as np
import pytest

from pipeline.cli import main
from tests.workbench.toy_bench import written
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.data.draft import write_draft
from workbench.data.guess import guesses, likely_kind
from workbench.data.raw_table import table_of_text
from workbench.errors import WorkbenchError
from workbench.models.bases import nominal_model

KNOWN = {
    "force_constant_N_per_A": 60,
    "internal_resistance_ohm": 1.2,
    "moving_mass_kg": 2,
    "viscous_damping_Ns_per_m": 20,
}


def german_file(folder):
    """A damper, F = K^2 v / (R + R_s) + c v, as a German spreadsheet exports it; one reading is missing."""
    random, rows = np.random.default_rng(1), ["Prüfstand 3;;;;", "Datum;22.11.2026;;;"]
    rows += ["Zeit;Geschwindigkeit;Lastwiderstand;Kraft;Bemerkung", "hh:mm:ss;m/s;Ω;kN;"]
    for shunt in ("0.5", "3", "open"):
        for k, v in enumerate(np.linspace(0.02, 0.4, 14)):
            circuit = 1.2 + (1e6 if shunt == "open" else float(shunt))
            force = (3600 * v / circuit + 20 * v + 0.3 * random.standard_normal()) / 1e3
            rows.append(f"12:00:{k:02d},5;{v:.3f};{shunt};{force:.5f};".replace(".", ","))
    rows[20] = rows[20].rsplit(";", 2)[0] + ";---;"
    path = folder / "Fahrt 12.csv"
    path.write_bytes("\r\n".join(rows).encode("utf-16"))
    return path


def test_five_lines_lead_from_a_raw_file_to_a_comparison(tmp_path, capsys):
    path = german_file(tmp_path)
    before = path.read_bytes()
    main(["import", str(path)])
    said, text = capsys.readouterr().out, (tmp_path / "campaign.toml").read_text(encoding="utf-8")
    places = [int(n) for n in re.search(r"of line ([\d, ]+),", said)[1].split(", ")]
    lines = text.splitlines()
    assert len(places) <= 5 and all('"?"' in lines[n - 1] for n in places)
    for n in places:
        key = lines[n - 1].split(" =")[0]
        lines[n - 1] = f"{key} = {KNOWN[key]}"
    (tmp_path / "campaign.toml").write_text("\n".join(lines), encoding="utf-8")
    campaign = read_campaign(tmp_path)
    (table,) = campaign.tables
    assert table.kind == "damping_velocity" and table.rows == 41 and table.conditions["shunt"].max() == 1e6
    (score,) = compare(nominal_model(campaign), campaign, {}).scoreboard
    assert score.chi2_per_n == pytest.approx(1.0, abs=1.0)  # the scatter of the neighbours is that of the sensor
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    "text, quantities, kind",
    [
        ("Winkel [°],U_U [V],U_V [V],U_W [V],n [1/min]", ["angle_mech", "v_a", "v_b", "v_c", "speed"], "back_emf"),
        ("angle (deg),torque (mNm),direction,run", ["angle_mech", "torque", "direction", "repeat"], "cogging"),
        ("phi/deg,Ia/A,Ib/A,Ic/A,M/Nm", ["angle_mech", "i_a", "i_b", "i_c", "torque"], "locked_rotor"),
        ("Wicklung [°C],R1 [mOhm]", ["winding_T", "resistance"], "phase_resistance"),
        ("f [Hz],Re [Ns/m],Im [Ns/m],Amplitude [mm]", ["frequency", "re", "im", "amplitude"], "impedance"),
        (
            "i_d_A,i_q_A,speed_rpm,v_d_V,v_q_V,torque_Nm",
            ["i_d", "i_q", "speed", "v_d", "v_q", "torque"],
            "dq_operation",
        ),
        ("Kraft [kN],zweite Kraft [N],v [m/s]", ["force", "", "velocity"], "damping_velocity"),
    ],
)
def test_columns_are_guessed_by_words_and_units(text, quantities, kind):
    row = ",".join(["1"] * len(quantities))
    found = guesses(table_of_text(f"{text}\n{row}\n", "f.csv"))
    assert [guess.quantity for guess in found] == quantities
    assert likely_kind(quantities) == kind


def test_a_device_is_taken_over_from_another_campaign(tmp_path):
    old = written(tmp_path / "old")
    new = tmp_path / "new"
    new.mkdir()
    (new / "pull.csv").write_bytes((old / "pull.csv").read_bytes())
    target, todo = write_draft([new / "pull.csv"], like=old)
    campaign, source = read_campaign(new), read_campaign(old)
    assert todo == [] and target == new / "campaign.toml"
    assert (campaign.device, campaign.tolerances, campaign.systematics) == (
        source.device, source.tolerances, source.systematics
    )  # fmt: skip


def test_a_draft_never_overwrites_and_needs_one_folder(tmp_path):
    path = german_file(tmp_path)
    write_draft([path])
    with pytest.raises(WorkbenchError, match="exists already"):
        write_draft([path])
    (tmp_path / "x").mkdir()
    with pytest.raises(WorkbenchError, match="lie in one folder"):
        write_draft([path, german_file(tmp_path / "x")])


def test_headings_full_of_quotes_stay_data(tmp_path):
    (tmp_path / "a.csv").write_text('"x"" ] = 1 # [N]",\'v [m/s]\n1,2\n', encoding="utf-8")
    write_draft([tmp_path / "a.csv"])
    with pytest.raises(WorkbenchError, match="u_random"):
        read_campaign(tmp_path)
