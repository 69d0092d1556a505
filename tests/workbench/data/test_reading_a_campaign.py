"""Both spellings of a campaign, and one clear sentence for each thing that can be wrong with one."""

import hashlib
from math import pi

import numpy as np
import pytest

from tests.workbench.toy_bench import LIBRARY, SpringModel, written
from workbench.data.campaign import columns_of_systematics, read_campaign
from workbench.data.stack import rows_of
from workbench.errors import WorkbenchError
from workbench.likelihood.bench import bench_of
from workbench.models.model import Model

DECLARED = """
[campaign]
id = "declared"
repeats = 2
holdout = "column:holdout"
[device]
stiffness_N_per_m = 1000.0
[systematic]
cell = { sigma = 0.01, kind = "gain", instrument = "cell 1" }
[tolerance]
"gap" = { sigma = 0.02, unit = "mm", source = "drawing" }
[[table]]
file = "a.csv"
kind = "cogging"
[table.columns]
angle = { unit = "deg", role = "condition", u = 0.05 }
load = { unit = "mNm", role = "response", u_random = "1 + 0.01*abs(y)", u_sys = ["cell"] }
sweep = { role = "scan" }
again = { role = "repeat" }
holdout = { role = "holdout" }
direction = { role = "group" }
spare_T = { unit = "degC", role = "condition", optional = true }
"""
ROWS = "angle,load,sweep,again,holdout,direction\n90,-200,0,0,0,1\n45,100,0,0,1,1\n90,-210,1,1,0,-1\n45,110,1,1,1,-1\n"


def declared(folder, toml=DECLARED, rows=ROWS):
    (folder / "campaign.toml").write_text(toml, encoding="utf-8")
    (folder / "a.csv").write_text(rows, encoding="utf-8")
    return folder


def test_declared_columns_arrive_in_si_with_their_roles(tmp_path):
    campaign = read_campaign(declared(tmp_path))
    (table,) = campaign.tables
    assert np.allclose(table.conditions["angle"], [pi / 2, pi / 4] * 2)
    assert np.allclose(table.responses["load"].values, [-0.2, 0.1, -0.21, 0.11])
    assert np.allclose(table.responses["load"].random, [3e-3, 2e-3, 3.1e-3, 2.1e-3])  # 1 mNm + 1 %
    assert np.allclose(table.condition_random["angle"], 0.05 * pi / 180)
    assert list(table.scan) == [0, 0, 1, 1] and list(table.repeat) == [0, 0, 1, 1]
    assert list(table.held_out) == [False, True, False, True]
    assert campaign.tolerances[0].sigma == pytest.approx(2e-5)
    assert campaign.file_hashes["a.csv"] == hashlib.sha256((tmp_path / "a.csv").read_bytes()).hexdigest()


def test_units_in_column_names_say_the_same(tmp_path):
    head, columns = DECLARED.split("[table.columns]")
    toml = head + 'u_random = { torque_mNm = "1 + 0.01*abs(y)" }\n'
    rows = ROWS.replace("angle,load,sweep,again", "angle_deg,torque_mNm,scan,repeat")
    (table,) = read_campaign(declared(tmp_path, toml, rows)).tables
    assert np.allclose(table.responses["torque"].random, [3e-3, 2e-3, 3.1e-3, 2.1e-3])
    assert np.allclose(table.conditions["angle"], [pi / 2, pi / 4] * 2)


def test_the_last_repeat_is_held_out(tmp_path):
    (table,) = read_campaign(written(tmp_path, repeats=3)).tables
    assert np.array_equal(table.held_out, table.repeat == 2)


@pytest.mark.parametrize("rows, is_left_out", [(12, True), (11, False)])
def test_a_repeat_that_is_a_copy_is_left_out_and_not_held_out(tmp_path, rows, is_left_out):
    """To the last digit, the order of the rows included; few readings in coarse digits may be alike by chance."""
    one = [f"{k},{10 * k % 7}," for k in range(rows)]
    other = [f"{k},{10 * k % 7 + 1}," for k in range(rows)]
    lines = [line + str(repeat) for repeat, part in enumerate((one, other, one)) for line in part]
    toml = DECLARED[: DECLARED.index("sweep =")] + 'again = { role = "repeat" }\n'
    toml = toml.replace('"column:holdout"', '{ rule = "last repeat of every table" }')
    found = read_campaign(declared(tmp_path, toml, "\n".join(["angle,load,again", *lines, ""])))
    said = any("repeat 2 is an exact copy of repeat 0" in words for words in found.complaints)
    assert said is is_left_out and found.repeats == (2 if is_left_out else 3)
    assert set(found.tables[0].repeat[found.tables[0].held_out]) == {1 if is_left_out else 2}


def test_rows_that_were_pasted_twice_are_said_unless_a_column_that_is_not_read_tells_them_apart(tmp_path):
    lines = [f"{k},{10 * k % 7},{0.1 * n:.1f}" for n, k in enumerate([*range(8), *range(3)])]
    toml = DECLARED[: DECLARED.index("sweep =")].replace("column:holdout", "none")
    for clock, is_said in ((slice(None), False), (slice(0, -4), True)):
        rows = "\n".join(["angle,load,clock"[: -6 if is_said else None], *(line[clock] for line in lines), ""])
        said = " ".join(read_campaign(declared(tmp_path, toml, rows)).complaints)
        assert ("3 of 11 rows are exact copies of an earlier row (first in line 10)" in said) is is_said


def test_a_complex_response_shares_the_size_of_both_parts(tmp_path):
    toml = DECLARED.split("[[table]]")[0].replace('"column:holdout"', '"none"')
    toml += (
        '[[table]]\nfile = "a.csv"\nkind = "impedance"\nu_random = { re_Ns_per_m = "0.1*abs(z)", im_Ns_per_m = 1 }\n'
    )
    (table,) = read_campaign(declared(tmp_path, toml, "frequency_Hz,re_Ns_per_m,im_Ns_per_m\n1,3,4\n2,6,8\n")).tables
    assert np.allclose(table.responses["re"].random, [0.5, 1.0])


@pytest.mark.parametrize(
    "old, new, says",
    [
        ('unit = "deg", role', "role", "has no unit"),
        ('unit = "deg"', 'unit = "degr"', "angle: the unit 'degr' is not known; the nearest are deg"),
        ("angle = {", "angle_rad = {", "is not there; found angle"),
        ('role = "condition", u', 'role = "input", u', "use condition, response"),
        (', u_random = "1 + 0.01*abs(y)"', "", "has no u_random"),
        ('"1 + 0.01*abs(y)"', '"0*abs(y)"', "must be positive"),
        ('"1 + 0.01*abs(y)"', "\"__import__('os').system('true')\"", "not a formula"),
        ('"a.csv"', '"b.csv"', "does not exist"),
        ('"a.csv"', '"../a.csv"', "must lie in the folder"),
        ('"cogging"', '"coging"', "use one of back_emf"),
        ('"column:holdout"', '"column:later"', "is not in the file"),
        ('"column:holdout"', '"some"', "is not understood"),
        ("[campaign]", "[campain]", "the section [campain] is unknown; the nearest known one is [campaign]"),
        ("[tolerance]", "[tolerances]", "the nearest known one is [tolerance]"),
        (
            'holdout = "column',
            'hold_out = "column',
            "the key 'hold_out' is unknown; the nearest known one is 'holdout'",
        ),
        ("u = 0.05", "sigma = 0.05", "table 1, column 'angle': the key 'sigma' is unknown"),
        ("u = 0.05", "u = true", "must be a number or a formula"),
        ('kind = "cogging"', 'kind = "cogging"\nfiel = "x"', "the nearest known one is 'file'"),
        ('source = "drawing"', 'sourc = "drawing"', "[tolerance] gap: the key 'sourc' is unknown"),
        ("sigma = 0.02", "sigma = 1e300", "from 1e-30 to 1e+30"),
        ('sigma = 0.02, unit = "mm"', "sigma = 0.02, sigma_rel = 0.1", "either sigma"),
        ('id = "declared"', 'id = "../../home"', "names the folder of the results"),
        ('id = "declared"', 'id = ".hidden"', "names the folder of the results"),
        ('id = "declared"', 'id = "a/b"', "names the folder of the results"),
        ('"column:holdout"', "{ rule = 3 }", "is not understood"),
        ('u_sys = ["cell"]', "u_sys = 3", "or a list of names"),
        ("optional = true", 'optional = "yes"', "optional = 'yes' is not accepted"),
        ("sigma = 0.02", "sigma = -1", "must be a positive number"),
        ('kind = "gain"', 'kind = "scale"', 'kind = "gain" or "offset"'),
        ("repeats = 2", "repeats = ", "is not valid TOML"),
        ("stiffness_N_per_m", "internal_resistance_mH", "internal_resistance is measured in ohm, found 'mH'"),
        ("stiffness_N_per_m", "force_constant_mm", "[device] force_constant_mm: force_constant is measured in N_per_A"),
        ('"gap" = { sigma = 0.02, unit = "mm"', '"airgap" = { sigma = 0.02, unit = "N"', "airgap is measured in mm"),
        (
            'cell = { sigma = 0.01, kind = "gain"',
            'force_offset = { sigma = 1, kind = "offset", unit = "V"',
            "measured in N",
        ),
        ('angle = { unit = "deg"', 'angle = { unit = "kg"', "column 'angle': angle is measured in deg, found 'kg'"),
    ],
)
def test_what_is_wrong_is_said_in_one_sentence(tmp_path, old, new, says):
    assert old in DECLARED
    with pytest.raises(WorkbenchError) as caught:
        read_campaign(declared(tmp_path, DECLARED.replace(old, new)))
    assert says in str(caught.value) and "\n" not in str(caught.value)


def test_what_else_is_wrong_is_said_and_then_counted(tmp_path):
    wrong = DECLARED.replace("sigma = 0.02", "sigma = -1").replace("repeats = 2", "repeats = 0")
    with pytest.raises(WorkbenchError, match=r"repeats = 0 is not .*Also, .*\[tolerance\] gap: sigma = -1.*\.$"):
        read_campaign(declared(tmp_path, wrong))
    wrong = wrong.replace("repeats = 0", "repeats = 0\ncolour = 1\nsize = 2")
    with pytest.raises(WorkbenchError, match=r"colour.*size.*repeats = 0.*\(And 1 more thing is wrong\.\)"):
        read_campaign(declared(tmp_path, wrong))


def test_no_campaign_file_and_no_rows(tmp_path):
    with pytest.raises(WorkbenchError, match="there is no campaign.toml"):
        read_campaign(tmp_path)
    with pytest.raises(WorkbenchError, match="has no rows"):
        read_campaign(declared(tmp_path, rows=ROWS.splitlines()[0] + "\n"))
    with pytest.raises(WorkbenchError, match="no row has a number"):
        read_campaign(declared(tmp_path, rows=ROWS.splitlines()[0] + "\n90,x,0,0,0,1\n"))


def test_a_unit_said_twice_must_be_the_same(tmp_path):
    toml = DECLARED.replace("load = {", "load_Nm = {")
    with pytest.raises(WorkbenchError, match="says Nm in its heading and mNm"):
        read_campaign(declared(tmp_path, toml, ROWS.replace("load", "load_Nm")))


def test_a_column_without_unit_in_its_name(tmp_path):
    folder = written(tmp_path)
    text = (folder / "pull.csv").read_text().replace("displacement_mm", "displacement")
    (folder / "pull.csv").write_text(text)
    with pytest.raises(WorkbenchError, match="'displacement' has no unit"):
        read_campaign(folder)


def test_gaps_are_left_out_and_said(tmp_path):
    rows = ROWS.replace("45,100", "45,")
    campaign = read_campaign(declared(tmp_path, rows=rows))
    assert campaign.tables[0].rows == 3
    assert any("1 of 4 rows have a gap" in words and "line 3" in words for words in campaign.complaints)


def test_a_stuck_column_few_rows_and_falling_angles_are_no_error(tmp_path):
    rows = ROWS.replace("-200", "5").replace("100", "5").replace("-210", "5").replace("110", "5")
    campaign = read_campaign(declared(tmp_path, rows=rows))
    assert any("is it stuck" in words for words in campaign.complaints)
    assert any("only 4 rows" in words for words in campaign.complaints)
    assert np.all(np.diff(campaign.tables[0].conditions["angle"][:2]) < 0)


def test_one_repeat_means_nothing_is_held_out_and_the_noise_is_as_declared(tmp_path):
    campaign = read_campaign(written(tmp_path, repeats=1))
    assert not campaign.tables[0].held_out.any()
    assert any("one repeat only" in words for words in campaign.complaints)
    bench = bench_of(Model(SpringModel(), SpringModel().design(campaign.device)), campaign, LIBRARY)
    assert bench.held_out is None and bench.noise.channels[0].scale == 1.0


def test_everything_held_out_leaves_nothing_to_fit(tmp_path):
    folder = written(tmp_path, holdout='"column:holdout"')
    lines = (folder / "pull.csv").read_text().splitlines()
    (folder / "pull.csv").write_text("\n".join([lines[0] + ",holdout"] + [line + ",1" for line in lines[1:]]))
    campaign = read_campaign(folder)
    with pytest.raises(WorkbenchError, match="every row is held out"):
        bench_of(Model(SpringModel(), SpringModel().design(campaign.device)), campaign, LIBRARY)


def test_no_file_of_a_campaign_is_written(tmp_path):
    folder = written(tmp_path / "c")
    before = {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in folder.iterdir()}
    campaign = read_campaign(folder)
    bench_of(Model(SpringModel(), SpringModel().design(campaign.device)), campaign, LIBRARY)
    assert before == {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in folder.iterdir()}


SECOND = """
[[table]]
file = "b.csv"
kind = "generic"
u_random = { torque_Nm = 0.01, force_N = 0.1 }
"""
WIDE = "angle_deg,torque_Nm,force_N\n" + "\n".join(f"{k},{0.1 * k:.2f},{k}" for k in range(40)) + "\n"


def wide(folder, rows=WIDE, second=SECOND):
    (folder / "b.csv").write_text(rows, encoding="utf-8")
    tables = read_campaign(declared(folder, DECLARED.replace("column:holdout", "none") + second)).tables
    return tables[1:]


def test_one_gap_costs_a_row_and_many_gaps_only_the_response_that_has_them(tmp_path):
    (table,) = wide(tmp_path, WIDE.replace("7,0.70,7", "7,,7"))
    assert table.rows == 39 and 7.0 not in table.responses["force"].values
    lines = WIDE.splitlines()
    holes = [line.rsplit(",", 2)[0] + ",---," + line.rsplit(",", 1)[1] for line in lines[1::2]]
    gaps = "\n".join([lines[0], *(x for pair in zip(holes, lines[2::2]) for x in pair)])
    torque, force = wide(tmp_path, gaps)
    assert (list(torque.responses), torque.rows) == (["torque"], 20) and torque.file == force.file
    assert (list(force.responses), force.rows) == (["force"], 40)
    assert any(
        "torque has no reading in 20 of 40 rows (first in line 2)" in w for w in read_campaign(tmp_path).complaints
    )


def test_without_a_rule_operating_regions_are_held_out_later_and_no_row_is_marked(tmp_path):
    campaign = read_campaign(declared(tmp_path, DECLARED.replace('holdout = "column:holdout"\n', "")))
    assert campaign.holdout == "by region" and not campaign.tables[0].held_out.any()
    assert any("'holdout' is not used" in words for words in campaign.complaints)
    campaign = read_campaign(declared(tmp_path, DECLARED.replace('"column:holdout"', '{ rule = "by region" }')))
    assert campaign.holdout == "by region" and not any("held out" in words for words in campaign.complaints)
    assert read_campaign(declared(tmp_path)).holdout == "column:holdout"


def test_headings_of_a_laboratory_get_names_without_a_file_being_written(tmp_path):
    rows = ROWS.replace("load", "Drehmoment [mNm]").replace("angle", "Winkel (°)")
    toml = DECLARED.replace("load = {", '"Drehmoment [mNm]" = { name = "load",').replace('unit = "mNm", ', "")
    toml = toml.replace("angle = {", '"Winkel (°)" = { name = "angle",')
    (table,) = read_campaign(declared(tmp_path, toml, rows)).tables
    assert table.responses["load"].unit == "mNm" and table.responses["load"].values[0] == pytest.approx(-0.2)
    other = toml.replace('"Drehmoment [mNm]" = { name = "load",', 'load = { from = "Drehmoment [mNm]",')
    (again,) = read_campaign(declared(tmp_path, other, rows)).tables
    assert np.array_equal(again.responses["load"].values, table.responses["load"].values)
    assert dict(columns_of_systematics(tmp_path)) == {"cell": (("a.csv", "load"),)}
    aliases = 'alias = { "x (kN)" = "force", Mz = "torque_mNm" }\nu_random = { force = 0.1, torque = 2 }\n'
    renamed = WIDE.replace("force_N", "x (kN)").replace("torque_Nm", "Mz")
    (table,) = wide(tmp_path, renamed, SECOND.split("u_random")[0] + aliases)
    assert table.responses["force"].values[3] == 3000.0 and table.responses["torque"].random[0] == 2e-3


def test_a_bandwidth_is_kept_for_the_model(tmp_path):
    toml = DECLARED.replace("u_sys", "bandwidth = 1e3, u_sys").replace(
        'kind = "cogging"', 'kind = "cogging"\nbandwidth_Hz = 5'
    )
    (table,) = read_campaign(declared(tmp_path, toml)).tables
    assert table.responses["load"].bandwidth == 1e3 and table.bandwidth == 5.0
    (table,) = read_campaign(declared(tmp_path, toml.replace("bandwidth = 1e3, ", ""))).tables
    assert table.responses["load"].bandwidth == 5.0
    assert rows_of(table, np.array([0, 2])).responses["load"].bandwidth == 5.0


def test_conventions_are_handed_through(tmp_path):
    campaign = read_campaign(declared(tmp_path, DECLARED + '[conventions]\n"a.csv" = { invert = ["load"] }\n'))
    assert campaign.conventions == {"a.csv": {"invert": ["load"]}}


@pytest.mark.parametrize(
    "rows, second, says",
    [
        (WIDE.replace("force_N", "torque_mNm"), SECOND.replace("force_N", "torque_mNm"), "are both torque"),
        (WIDE.replace("force_N", "torque_Nm"), SECOND, "2 columns are called 'torque_Nm'"),
        (WIDE, SECOND + SECOND, "names 'b.csv' twice"),
        (WIDE, SECOND.replace("torque_Nm =", "torqe_Nm ="), "the nearest heading is 'torque_Nm'"),
        (WIDE.replace("angle_deg", "my angle_deg"), SECOND, "'my angle' is no name of a quantity"),
        (WIDE.replace("angle_deg", "repeat").replace("3,0.30", "3.5,0.30"), SECOND, "must hold whole numbers"),
        (WIDE.replace("angle_deg", "frequency_Hz"), SECOND, "frequency must be positive"),
        (WIDE, SECOND.replace("0.01", '"1e-20"'), "not less than 1e-12"),
        (WIDE, SECOND.replace("0.01", '"y - 1"'), "is negative somewhere"),
    ],
)
def test_columns_that_cannot_be_meant(tmp_path, rows, second, says):
    with pytest.raises(WorkbenchError) as caught:
        wide(tmp_path, rows, second)
    assert says in str(caught.value) and "\n" not in str(caught.value)


def test_an_open_shunt_is_an_open_circuit(tmp_path):
    rows = WIDE.replace("angle_deg", "shunt_mohm").replace("\n3,", "\nopen,").replace("\n4,", "\ninf,")
    (table,) = wide(tmp_path, rows)
    assert table.rows == 40 and list(table.conditions["shunt"][3:6]) == [1e6, 1e6, 5e-3]


def test_temperatures_in_kelvin_and_fahrenheit_arrive_in_degrees_celsius(tmp_path):
    (table,) = wide(tmp_path, WIDE.replace("angle_deg", "winding_T_K").replace("\n3,", "\n293.15,"))
    assert table.conditions["winding_T"][3] == pytest.approx(20.0)
    (table,) = wide(tmp_path, WIDE.replace("angle_deg", "winding_T_degF").replace("\n3,", "\n212,"))
    assert table.conditions["winding_T"][3] == pytest.approx(100.0)
