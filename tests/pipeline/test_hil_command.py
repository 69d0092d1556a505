"""airgap hil: table and picture of the loop, and wrong numbers in one sentence each."""

import argparse

import pandas as pd
import pytest

import pipeline.hil_command as hil
from pipeline.results import Results
from study.errors import StudyError
from tests.actuator.thesis import prototype

OPTIONS = {"study": "automotive", "seconds": 0.2, "damping_kNs_per_m": 1.0, "sample_ms": 0.5, "bandwidth_Hz": 100.0,
           "margin_deg": 50.0}  # fmt: skip


@pytest.fixture
def run(tmp_path, monkeypatch):
    """The command with the prototype in the place of a designed actuator."""
    monkeypatch.setattr(hil, "designed_unit", lambda study, results: (prototype(), None))

    def call(**changes):
        hil.hil(argparse.Namespace(**{**OPTIONS, **changes, "results": str(tmp_path)}))
        return pd.read_csv(tmp_path / hil.TABLE)

    yield call


def test_three_loops_with_their_clock(run, tmp_path, capsys):
    table = run()
    assert list(table.low_level) == ["no force loop", "load cell", "observer"] and (table.steps == 400).all()
    assert {"missed_deadlines", "jitter_worst_s", "step_time_p99_s"} <= set(table.columns)
    assert (Results(tmp_path).folder / hil.FIGURE).is_file()
    assert "the actuator on the bench was simulated" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"seconds": 0.0}, "--seconds: expected a number above zero, found 0"),
        ({"sample_ms": float("nan")}, "--sample-ms: expected a number above zero, found nan"),
        ({"margin_deg": -3.0}, "--margin-deg: expected a number above zero, found -3"),
        ({"bandwidth_Hz": 5.0}, "automotive.toml: no loop has a bandwidth of 5 Hz"),
    ],
)
def test_wrong_numbers_are_one_sentence(run, changes, sentence):
    with pytest.raises(StudyError, match=sentence):
        run(**changes)
