"""Both spellings of a campaign, and one clear sentence for each thing that can be wrong with one."""

import hashlib
from math import pi

import numpy as np
import pytest

from tests.workbench.toy_bench import LIBRARY, SpringModel, written
from workbench.data.campaign import read_campaign
from workbench.data.expression import evaluate
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
        ('unit = "deg"', 'unit = "degree"', "'degree' is not known"),
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
        ("[campaign]", "[campain]", "[campaign] is missing"),
        ("sigma = 0.02", "sigma = -1", "must be a positive number"),
        ('kind = "gain"', 'kind = "scale"', 'kind = "gain" or "offset"'),
        ("repeats = 2", "repeats = ", "is not valid TOML"),
    ],
)
def test_what_is_wrong_is_said_in_one_sentence(tmp_path, old, new, says):
    assert old in DECLARED
    with pytest.raises(WorkbenchError) as caught:
        read_campaign(declared(tmp_path, DECLARED.replace(old, new)))
    assert says in str(caught.value) and "\n" not in str(caught.value)


def test_no_campaign_file_and_no_rows(tmp_path):
    with pytest.raises(WorkbenchError, match="there is no campaign.toml"):
        read_campaign(tmp_path)
    with pytest.raises(WorkbenchError, match="has no rows"):
        read_campaign(declared(tmp_path, rows=ROWS.splitlines()[0] + "\n"))
    with pytest.raises(WorkbenchError, match="no row has a number"):
        read_campaign(declared(tmp_path, rows=ROWS.splitlines()[0] + "\n90,x,0,0,0,1\n"))


def test_a_unit_said_twice_must_be_the_same(tmp_path):
    toml = DECLARED.replace("load = {", "load_Nm = {")
    with pytest.raises(WorkbenchError, match="says Nm in its name and mNm"):
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


def test_formulas_are_arithmetic_only():
    assert evaluate("max(2, 3*y**2) - -1", {"y": 2.0}, "here") == 13.0
    for text in ("y.real", "open('x')", "[1]", "y if y else 0", "lambda: 0", "abs(x=1)", "True"):
        with pytest.raises(WorkbenchError, match="not a formula"):
            evaluate(text, {"y": 1.0}, "here")


def test_no_file_of_a_campaign_is_written(tmp_path):
    folder = written(tmp_path / "c")
    before = {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in folder.iterdir()}
    campaign = read_campaign(folder)
    bench_of(Model(SpringModel(), SpringModel().design(campaign.device)), campaign, LIBRARY)
    assert before == {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in folder.iterdir()}
