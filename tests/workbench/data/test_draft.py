"""From a laboratory's own file to an answer: ``airgap import``, at most five lines filled in, no file rewritten."""

import re

import numpy as np
import pytest

from effects.library import library
from pipeline.cli import main
from tests.workbench.toy_bench import written
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.data.checks import checks_of
from workbench.data.draft import draft_of, write_draft
from workbench.data.guess import guesses, likely_kind
from workbench.data.raw_table import Layout, read_raw, table_of_text
from workbench.data.scatter import noise_of
from workbench.errors import WorkbenchError
from workbench.explain.diagnosis import diagnose
from workbench.explain.verdict import NOTHING_MISSING
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
    (score,) = compare(nominal_model(campaign), campaign, library()).scoreboard
    # the scatter of neighbours says the size of the noise to within a quarter, 32 fitted readings its square to a half
    assert 0.3 < score.chi2_per_n < 1.25**2 * 1.5
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
        (
            "Drehzahl [1/min],Moment [Nm],i_a [Arms],P_mech [W],P_el [kW],cos phi [-],Wirkungsgrad,t_winding_C",
            ["speed", "torque", "current", "", "power", "power_factor", "efficiency", "winding_T"],
            "dyno_map",
        ),
        ("T_Wicklung,R [Ohm]", ["winding_T", "resistance"], "phase_resistance"),
        ("Wicklungstemperatur,T_rotor,R [Ohm]", ["winding_T", "", "resistance"], "phase_resistance"),
        ("rotor temp,n [rpm],U_mes [V]", ["magnet_T", "speed", "voltage"], "back_emf"),
        ("Wdh [-],v [m/s],Kraft [N]", ["repeat", "velocity", "force"], "damping_velocity"),
        ("Messung,v [m/s],Kraft [N]", ["repeat", "velocity", "force"], "damping_velocity"),
        ("x [°mech.],T [Nm],iU_mes [A],iV_mes [A],ia [A]", ["angle_mech", "torque", "i_a", "i_b", ""], "locked_rotor"),
        ("U_mes [V],Drehzahl", ["voltage", "speed"], "back_emf"),
        ("n (rpm),M_Nm,I1 [A],P_el [W],T_Cu [°C]", ["speed", "torque", "current", "power", "winding_T"], "dyno_map"),
        ("n_soll [1/min],n_ist [1/min],M_Nm,P_el [W]", ["", "speed", "torque", "power"], "dyno_map"),
        ("speed set (rpm),U12 [V]", ["speed", "v_ll"], "back_emf"),
        ("n (rpm),U12 [V],P_mech [W]", ["speed", "v_ll", "power"], "no_load"),
        ("v [mm/s],U1 [V]", ["velocity", "voltage"], "back_emf"),
        ("phi [°],L_uv [mH],Lvw [mH],L_wu [mH]", ["angle_mech", "l_ab", "l_?", "l_ca"], "inductance"),
        ("phi [°],Induktivität cb [µH],L_d [mH]", ["angle_mech", "l_bc", ""], "inductance"),
        ("U_uv [V],Uv [V],R_wv [mOhm],n [rpm]", ["v_ab", "v_b", "r_bc", "speed"], "back_emf"),
        ("Kraft [kN],zweite Kraft [N],v [m/s]", ["force", "", "velocity"], "damping_velocity"),
        ("Antriebsdrehzahl,Reibmoment [Ncm]", ["speed", "torque"], "drag"),
        ("f [Hz],Phase [deg],Weg [mm],Kraft [N]", ["frequency", "phase", "displacement", "force"], "force_loop"),
        ("n (rpm),M_Nm,η [%],P_el [W]", ["speed", "torque", "efficiency", "power"], "dyno_map"),
        ("f [Hz],A [mm],Weg [mm],Kraft [N]", ["frequency", "amplitude", "displacement", "force"], "force_loop"),
    ],
)
def test_columns_are_guessed_by_words_and_units(text, quantities, kind):
    row = ",".join(["1"] * len(quantities))
    found = guesses(table_of_text(f"{text}\n{row}\n", "f.csv"))
    assert [guess.quantity for guess in found] == quantities
    assert likely_kind(quantities) == kind


@pytest.mark.parametrize(
    "file, kind",
    [("Kurzschluss 2", "short_circuit"), ("short-circuit_1", "short_circuit"), ("short run", "dyno_map")],
)
def test_the_name_of_a_file_tells_a_short_circuit_from_a_map(file, kind):
    assert likely_kind(["speed", "torque", "current"], file) == kind


@pytest.mark.parametrize("power, role", [("P_mech", "response"), ("P_el", "condition")])
def test_the_voltage_of_a_machine_that_is_driven_open_is_an_answer(tmp_path, power, role):
    path = tmp_path / "no load.csv"
    path.write_text(f"n [rpm],U12 [V],{power} [W]\n" + "".join(f"{k}00,{k}.1,{k}\n" for k in range(1, 9)))
    said = next(line for line in draft_of([path]).splitlines() if line.startswith('"U12'))
    assert f'name = "v_ll", unit = "V", role = "{role}"' in said


@pytest.mark.parametrize("heading", ["inductance [mH]", "Induktivität / mH", "L in mH"])
def test_an_inductance_is_asked_about_where_its_heading_names_no_phase(tmp_path, capsys, heading):
    """A phase's is about half of that between two lines: neither is taken for granted."""
    path = tmp_path / "meter.csv"
    path.write_text(f"angle [deg],{heading}\n0,1.2\n10,1.3\n20,1.5\n30,1.3\n", encoding="utf-8")
    main(["import", str(path)])
    lines = (tmp_path / "campaign.toml").read_text(encoding="utf-8").splitlines()
    (number,) = [number for number, line in enumerate(lines, 1) if line.startswith(f'"{heading}"')]
    assert 'name = "?", unit = "mH", role = "response"' in lines[number - 1]
    assert lines[number - 1].endswith("l_a of a phase fed alone, l_bc (l_ab, l_ca) between two lines, l_m of B by A")
    assert str(number) in re.findall(r"\d+", capsys.readouterr().out) and 'kind = "inductance"' in "\n".join(lines)


def test_units_that_headings_leave_out_are_the_usual_ones():
    found = guesses(table_of_text("eta,pf,t_winding_C,Strom [Aeff],angle\n0.9,0.8,30,2,5\n", "f.csv"))
    assert [guess.unit for guess in found] == ["1", "1", "degC", "A", ""]


def test_few_repeats_tell_the_noise_nearly_as_well_as_an_rms():
    """Three repeats of eight readings: 16 differences, whose rms is off by 20 %, their median by 30 %."""
    random, place = np.random.default_rng(8), np.tile(np.arange(8.0), 3)
    draws = (20 * place + random.standard_normal(24) for _ in range(300))
    found = np.array([float(noise_of(values, {"speed": place})[0]) for values in draws])
    assert np.mean(found) == pytest.approx(1.0, abs=0.05) and np.std(found) < 0.24


@pytest.mark.parametrize("floor, share", [(0.3, 0.008), (1.0, 0.0)])
@pytest.mark.parametrize("wild", [0.0, 30.0])
def test_repeated_rows_show_the_noise_and_whether_it_grows(floor, share, wild):
    random, places = np.random.default_rng(3), np.tile(np.linspace(-300, 300, 200), 2)
    readings = places + (floor + share * np.abs(places)) * random.standard_normal(400)
    readings[::40] += wild  # one in forty
    said, shown_by = noise_of(readings, {"velocity": places}, [np.repeat([0.0, 1.0], 200)])
    numbers = [float(n) for n in re.findall(r"[\d.]+", said)]
    truth = [floor, share] if share else [floor]
    assert shown_by == "repeated rows" and numbers == pytest.approx(truth, rel=0.35)  # two standard deviations of one
    assert ("abs(y)" in said) == bool(share)


def test_without_repeats_neighbours_show_the_noise_and_few_rows_none():
    random, places = np.random.default_rng(4), np.linspace(0, 1, 400)
    said, shown_by = noise_of(np.sin(places) + 0.01 * random.standard_normal(400), {"velocity": places})
    assert shown_by == "neighbours" and float(said) == pytest.approx(0.01, rel=0.2)
    line = np.round(0.0277 * places * 4000 + 0.06 * random.standard_normal(400), 2)[::33]
    said, _ = noise_of(line, {"speed": places[::33]})
    assert 0.02 < float(said) < 0.2, "a straight line steps by much more than its noise"
    assert noise_of(np.arange(5.0), {"velocity": np.arange(5.0)}) is None and noise_of(np.ones(20), {}) is None


def test_a_column_without_numbers_is_not_read_and_headings_are_not_used_twice(tmp_path):
    (tmp_path / "a.csv").write_text("speed [rpm],torque [Nm],power [W]\n" + "".join(f"{k},1,nan\n" for k in range(9)))
    assert '# "power [W]" = { ... }  # not read: it holds no number' in draft_of([tmp_path / "a.csv"])
    (tmp_path / "b.csv").write_text("speed [rpm],torque [Nm],torque [Nm]\n1,2,3\n")
    with pytest.raises(WorkbenchError, match="2 columns are called 'torque \\[Nm\\]'; rename all but one"):
        draft_of([tmp_path / "b.csv"])


def test_a_broken_row_is_no_repeat(tmp_path):
    rows = [f"{run},{v},{60 * v}" for run in (1, 2, 3) for v in (0.1, 0.2, 0.3)]
    (tmp_path / "a.csv").write_text("\n".join(["run,v [m/s],F [N]", *rows, "aborted,,"]) + "\n")
    assert "repeats = 3 " in draft_of([tmp_path / "a.csv"])


def test_settings_that_are_met_by_and_by_only_show_the_noise_and_not_the_slope():
    """A force of 900 N s/m at three shunts, run three times, the velocity within 0.1 mm/s of what was meant."""
    random = np.random.default_rng(6)
    meant = np.tile(np.outer([10.0, 25.0, 50.0, 100.0, 150.0, 300.0], [1.0, -1.0]).ravel(), 9)
    velocity = meant + 0.1 * random.standard_normal(len(meant))
    shunt, run = np.tile(np.repeat([0.5, 5.0, np.inf], 12), 3), np.repeat([1.0, 2.0, 3.0], 36)
    force = 0.9 * velocity + 2.0 * np.sign(velocity) + 0.15 * random.standard_normal(len(meant))
    said, shown_by = noise_of(force, {"velocity": velocity, "shunt": shunt}, [run])
    assert shown_by == "neighbours" and float(said) == pytest.approx(0.15, rel=0.35)


def test_what_is_logged_about_a_setting_is_one_condition():
    """Two scans at 30 A, whose current and speed are logged with a scatter."""
    random, angle = np.random.default_rng(5), np.tile(np.arange(0.0, 360.0, 6.0), 2)
    logged = {
        "angle_mech": angle,
        "i_a": 30 + 0.03 * random.standard_normal(120),
        "speed": np.repeat([999.6, 1000.3], 60),
    }
    readings = 20 * np.sin(5 * np.radians(angle)) + 0.02 * random.standard_normal(120)
    said, shown_by = noise_of(readings, logged, [np.repeat([0.0, 1.0], 60)])
    assert shown_by == "repeated rows" and float(said) == pytest.approx(0.02, rel=0.35)


def test_what_a_device_is_usually_off_by_is_no_effect(tmp_path):
    """The damper of the file pulls 1.7 % less and drags 30 % more than drawn."""
    path = german_file(tmp_path)
    write_draft([path])
    draft = (tmp_path / "campaign.toml").read_text(encoding="utf-8")
    for key, value in {**KNOWN, "force_constant_N_per_A": 61, "viscous_damping_Ns_per_m": 15}.items():
        draft = draft.replace(f'{key} = "?"', f"{key} = {value}")
    (tmp_path / "campaign.toml").write_text(draft, encoding="utf-8")
    usual = read_campaign(tmp_path)
    assert checks_of(usual) == () and diagnose(nominal_model(usual), usual, library()).verdict == NOTHING_MISSING
    exactly = draft[: draft.index("[tolerance]")] + draft[draft.index("[[table]]") :]
    (tmp_path / "campaign.toml").write_text(exactly, encoding="utf-8")
    exact = read_campaign(tmp_path)
    said = diagnose(nominal_model(exact), exact, library())
    assert said.verdict != NOTHING_MISSING and "[tolerance] is empty" in said.checks[0]


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


def test_headings_that_another_campaign_knows_are_read_as_there(tmp_path):
    """No word of a file tells that Nr counts repeats and P is a force in kN."""
    for name in ("old", "new"):
        (tmp_path / name).mkdir()
        rows = "".join(f"{n};{0.1 * k};{n + k}\n" for n in (1, 2) for k in range(8))
        (tmp_path / name / "p.csv").write_text("Nr;v [m/s];P\n" + rows, encoding="utf-8")
    columns = (
        '"Nr" = { role = "repeat" }\n"v [m/s]" = { name = "velocity", unit = "m_per_s", role = "condition" }\n'
        '"P" = { name = "force", unit = "kN", role = "response", u_random = "0.1 + 0.01*abs(y)" }\n'
    )
    table = f'[[table]]\nfile = "p.csv"\nkind = "force_loop"\n[table.columns]\n{columns}'
    (tmp_path / "old" / "campaign.toml").write_text(f'[campaign]\nid = "old"\nrepeats = 2\n{table}', encoding="utf-8")
    write_draft([tmp_path / "new" / "p.csv"], like=tmp_path / "old")
    old, new = (read_campaign(tmp_path / name) for name in ("old", "new"))
    for one, other in zip(old.tables, new.tables):
        assert one.kind == other.kind and list(one.responses) == list(other.responses) == ["force"]
        np.testing.assert_array_equal(one.responses["force"].random, other.responses["force"].random)
        np.testing.assert_array_equal(one.repeat, other.repeat)


def of_two_tables(folder, name):
    """Load points and a drag run of one machine, in German."""
    (folder / name).mkdir()
    loads = "".join(f"{500 * k};0;{10 * k};{0.3 * k:.4f}\n".replace(".", ",") for k in range(1, 9))
    headings = "Drehzahl [1/min];Strom Id [A];Strom Iq [A];Drehmoment [Nm]\n"
    (folder / name / "last.csv").write_text(headings + loads, encoding="utf-8")
    drag = "".join(f"{500 * k};{1.234 + k:.3f}\n".replace(".", ",") for k in range(1, 9))
    (folder / name / "drag.csv").write_text("Drehzahl [1/min];Drehmoment [Nm]\n" + drag, encoding="utf-8")
    return [folder / name / file for file in ("last.csv", "drag.csv")]


def test_a_file_is_like_the_table_that_has_its_headings_and_no_more(tmp_path):
    """Both headings of the drag run are in the table of load points, too; its commas may be those of thousands, which
    only the other file tells."""
    write_draft(of_two_tables(tmp_path, "old"))
    text = write_draft(of_two_tables(tmp_path, "new"), like=tmp_path / "old")[0].read_text(encoding="utf-8")
    assert re.findall(r'kind = "(\w+)"  # what was measured, (as before|a guess)', text) == [
        ("dq_operation", "as before"), ("drag", "as before"),
    ]  # fmt: skip
    torque = read_raw(tmp_path / "new" / "drag.csv", Layout(decimal=",")).values(1)
    assert text.count('decimal = ","') == 1 and torque[0] == 2.234
    alone = write_draft(of_two_tables(tmp_path, "third")[1:], like=tmp_path / "old")[0].read_text(encoding="utf-8")
    assert 'decimal = ","' in alone, "as before"


def test_what_was_the_same_in_all_rows_is_asked_for_and_taken_over(tmp_path):
    """A damper's shunt, which counts as an open circuit where nobody says it."""
    for name in ("old", "new"):
        (tmp_path / name).mkdir()
        rows = "".join(f"{k},{k % 3},{k % 5},1,1\n" for k in range(20))
        (tmp_path / name / "f.csv").write_text("x_mm,v_m_per_s,force_N,A_mm,f_Hz\n" + rows, encoding="utf-8")
    path = write_draft([tmp_path / "old" / "f.csv"])[0]
    text = path.read_text(encoding="utf-8")
    asked = next(line for line in text.splitlines() if line.startswith("# constants"))
    assert "shunt_ohm = ?" in asked
    path.write_text(text.replace(asked, "constants = { shunt_ohm = 2.0 }"), encoding="utf-8")
    again = write_draft([tmp_path / "new" / "f.csv"], like=tmp_path / "old")[0].read_text(encoding="utf-8")
    assert "constants = { shunt_ohm = 2.0 }" in again
    (tmp_path / "new" / "g.csv").write_text("x_mm,v_m_per_s,force_N,A_mm,f_Hz,shunt_ohm\n" + rows.replace("\n", ",3\n"))
    measured = draft_of([tmp_path / "new" / "g.csv"], like=tmp_path / "old")
    assert "shunt_ohm = 2.0" not in measured, "now a column holds it"


@pytest.mark.parametrize(
    "heading, line", [("T_Wicklung [°C]", "copper_coefficient_per_K = 0.00393"), ("x", "# copper")]
)
def test_the_resistance_of_a_winding_whose_temperature_was_read_rises_as_copper(tmp_path, heading, line):
    """Where nobody says so it would stay the same, and the readings of a hot winding would be a riddle."""
    rows = "".join(f"{k},{k},{k % 3},{k % 5},{20 + k}\n" for k in range(20))
    (tmp_path / "f.csv").write_text(f"n [rpm],i_d [A],i_q [A],M [Nm],{heading}\n" + rows, encoding="utf-8")
    text = write_draft([tmp_path / "f.csv"])[0].read_text(encoding="utf-8")
    assert any(written.startswith(line) for written in text.splitlines())


def test_a_kind_is_not_taken_over_for_a_few_of_its_headings(tmp_path):
    loads, _ = of_two_tables(tmp_path, "old")
    rows = loads.read_text(encoding="utf-8").replace("Strom Iq [A]", "Strom Iq [A];Spannung Ud [V];Spannung Uq [V]")
    loads.write_text(re.sub(r"(?m)^(\d+;\d+;\d+);", r"\1;1,5;2,5;", rows), encoding="utf-8")
    write_draft([loads])
    _, drag = of_two_tables(tmp_path, "new")
    text = write_draft([drag], like=tmp_path / "old", decimal=",")[0].read_text(encoding="utf-8")
    assert 'kind = "drag"  # what was measured, a guess' in text


@pytest.mark.parametrize(
    "rows, book", [([1] * 6 + [2] * 6, True), (list(range(1, 13)), False), ([1] * 12, False), ([1, 1, 2, 2] * 3, True)]
)
def test_a_number_that_few_rows_share_counts_repeats(tmp_path, rows, book):
    text = "Nr;v [m/s];F [N]\n" + "".join(f"{n};{0.1 * k};{k}\n" for k, n in enumerate(rows))
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    target, _ = write_draft([tmp_path / "a.csv"])
    assert ('"Nr" = { role = "repeat" }' in target.read_text(encoding="utf-8")) == book


def test_sizes_and_angles_of_an_impedance_are_not_read_as_something_else(tmp_path):
    rows = "".join(f"{f};100;10;0.5\n" for f in range(1, 15))
    (tmp_path / "z.txt").write_text("Frequenz [Hz];|Z| [Ns/m];Phase [°];Shunt [Ohm]\n" + rows, encoding="utf-8")
    target, _ = write_draft([tmp_path / "z.txt"])
    text = target.read_text(encoding="utf-8")
    columns = text[text.index("[table.columns]") :]
    assert "not read: an impedance is read as re and im" in columns
    assert "angle_mech" not in columns and "damping" not in columns


def test_a_direction_in_words_is_said_to_be_a_sign(tmp_path):
    rows = "".join(f"{k};{k};{way}\n" for way in ("CW", "CCW") for k in range(8))
    (tmp_path / "c.csv").write_text("Winkel [°];M [mNm];Richtung\n" + rows, encoding="utf-8")
    target, _ = write_draft([tmp_path / "c.csv"])
    assert "not read: a direction is +1 or -1" in target.read_text(encoding="utf-8")


def test_rms_values_of_the_axes_are_read_and_said_to_be(tmp_path):
    rows = "".join(f"0;{k};500;1;{k};2\n" for k in range(14))
    heads = "Id_rms [A];Iq_eff [A];n [1/min];Ud_rms [V];Uq_rms [V];M [Nm]\n"
    (tmp_path / "p.txt").write_text(heads + rows, encoding="utf-8")
    target, _ = write_draft([tmp_path / "p.txt"])
    text = target.read_text(encoding="utf-8")
    assert all(f'name = "{name}"' in text for name in ("i_d", "i_q", "v_d", "v_q")) and text.count("RMS: peak") == 4


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
