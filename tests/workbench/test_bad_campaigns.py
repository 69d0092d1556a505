"""Campaigns that are bad, odd or huge: each ends in one clear sentence, or goes on and says what is lost.

A missing unit, a wrong column, gaps, one repeat, a stuck column and wrong formulas: see test_reading_a_campaign.
"""

import numpy as np
import pandas as pd
import pyarrow
import pytest
from pyarrow.csv import write_csv

from pipeline.cli import main
from tests.workbench.data.test_reading_a_campaign import DECLARED, ROWS, declared
from tests.workbench.toy_bench import LIBRARY, TOML, SpringModel, written
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.ledger.model_file import with_effects_of
from workbench.likelihood.bench import bench_of
from workbench.models.model import Model


def of(folder):
    campaign = read_campaign(folder)
    return Model(SpringModel(), SpringModel().design(campaign.device)), campaign


def test_a_million_rows_are_compared_and_the_fit_says_what_it_left_out(tmp_path):
    n, random = 500_000, np.random.default_rng(3)
    x = np.tile(np.linspace(-10.0, 10.0, n), 2)
    force = 1003.0 * 1e-3 * x + 0.01 + 0.05 * random.standard_normal(2 * n)
    frame = pd.DataFrame({"repeat": np.repeat([0, 1], n), "displacement_mm": x, "force_N": force})
    write_csv(pyarrow.Table.from_pandas(frame.round(4)), tmp_path / "pull.csv")  # in a sixth of the time of pandas
    (tmp_path / "campaign.toml").write_text(
        TOML.format(repeats=2, holdout='{ rule = "last repeat of every table" }'), encoding="utf-8"
    )
    found = compare(*of(tmp_path), LIBRARY)
    (score,) = found.scoreboard
    assert score.n == 2 * n and score.chi2_per_n == pytest.approx(1.0, abs=0.02)
    assert any("of 1000000 rows take part in the fits" in words for words in found.complaints)


def test_a_hold_out_column_may_hold_out_nothing(tmp_path):
    rows = "angle,load,sweep,again,holdout,direction\n90,-200,0,0,0,1\n45,100,0,0,0,1\n90,-210,1,1,0,-1\n"
    campaign = read_campaign(declared(tmp_path, rows=rows))
    assert not campaign.tables[0].held_out.any()


def test_tables_in_different_units_arrive_in_one(tmp_path):
    second = DECLARED[DECLARED.index("[[table]]") :].replace("a.csv", "b.csv").replace('"mNm"', '"Nm"')
    toml = DECLARED + second.replace("1 + 0.01*abs(y)", "0.001 + 0.01*abs(y)")
    rows = ROWS.replace("-200", "-0.2").replace("100", "0.1").replace("-210", "-0.21").replace("110", "0.11")
    (tmp_path / "b.csv").write_text(rows, encoding="utf-8")
    first, second = read_campaign(declared(tmp_path, toml)).tables
    assert np.allclose(first.responses["load"].values, second.responses["load"].values)
    assert np.allclose(first.responses["load"].random, second.responses["load"].random)


def test_a_unit_within_a_cell_is_no_number_and_said(tmp_path):
    campaign = read_campaign(declared(tmp_path, rows=ROWS.replace("45,100", "45,100 mNm")))
    assert campaign.tables[0].rows == 3
    assert any("have a gap or no number (first in line 3)" in words for words in campaign.complaints)


def test_the_order_of_the_angles_does_not_matter(tmp_path):
    lines = (written(tmp_path / "up") / "pull.csv").read_text().splitlines()
    down = written(tmp_path / "down")
    half = len(lines) // 2 + 1
    (down / "pull.csv").write_text("\n".join([lines[0], *lines[1:half][::-1], *lines[half:][::-1]]) + "\n")
    up, falling = (bench_of(*of(tmp_path / name), LIBRARY) for name in ("up", "down"))
    assert falling.null.objective == pytest.approx(up.null.objective, rel=0.05)
    assert falling.null.x == pytest.approx(up.null.x, abs=0.05)


def test_ten_points_are_compared_and_said_to_be_few(tmp_path):
    found = compare(*of(written(tmp_path, n=5)), LIBRARY)
    assert found.scoreboard[0].n == 10 and any("only 10 rows" in words for words in found.complaints)


def test_a_model_file_is_data(tmp_path):
    trap = tmp_path / "ran"
    text = f'[model]\nbase = "spring"\n[[effect]]\nname = "__import__(\'pathlib\').Path({str(trap)!r}).touch()"\n'
    (tmp_path / "model.toml").write_text(text, encoding="utf-8")
    model = Model(SpringModel(), SpringModel().design({"stiffness_N_per_m": 1.0}))
    with pytest.raises(WorkbenchError):
        with_effects_of(tmp_path / "model.toml", model, LIBRARY)
    assert not trap.exists()


@pytest.mark.parametrize(
    "text, says",
    [("x = (", "cannot be imported: SyntaxError"), ("1 / 0", "cannot be imported: ZeroDivisionError"),
     ("x = 1", "holds no effect")],
)  # fmt: skip
def test_a_file_of_effects_that_is_none_ends_in_a_sentence_after_it_was_announced(tmp_path, capsys, text, says):
    (tmp_path / "own.py").write_text(text, encoding="utf-8")
    with pytest.raises(SystemExit):
        main(["effects", "--effects-from", str(tmp_path / "own.py")])
    announced, sentence = capsys.readouterr().err.strip().splitlines()
    assert "this runs the file" in announced and says in sentence


def test_without_being_named_no_effect_file_is_imported(tmp_path, monkeypatch, capsys):
    trap = tmp_path / "ran"
    (tmp_path / "my_effect.py").write_text(f"open({str(trap)!r}, 'w')", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    main(["effects"])
    assert not trap.exists() and "this runs the file" not in capsys.readouterr().err
