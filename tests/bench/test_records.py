"""Records as laboratories write them, and what is wrong with one in one sentence each."""

import numpy as np
import pandas as pd
import pytest

from bench.errors import RecordError
from bench.record import read_record
from workbench.errors import WorkbenchError

TIME = np.arange(40) * 1e-3


def written(folder, columns, name="run.csv", **how):
    path = folder / name
    pd.DataFrame(columns).to_csv(path, index=False, **how)
    return path


def test_units_and_dialects_are_read(tmp_path):
    german = written(
        tmp_path, {"Zeit [ms]": 1e3 * TIME, "Kraft [kN]": TIME, "stroke [mm]": 2e3 * TIME}, sep=";", decimal=","
    )
    record = read_record(german, {"time": "Zeit", "force": "Kraft [kN]"}, {"shunt": 0.135})
    assert record.step == pytest.approx(1e-3) and record.samples == 40
    assert record.channel("force") == pytest.approx(1e3 * TIME) and record.channel("stroke") == pytest.approx(2 * TIME)
    assert record.constant("shunt") == 0.135 and record.velocity() == pytest.approx(np.full(40, 2.0))


def test_an_open_circuit_is_infinite(tmp_path):
    record = read_record(written(tmp_path, {"time_s": TIME, "shunt_mohm": np.full(40, np.inf)}), {}, {})
    assert record.constant("shunt") == np.inf


def test_a_rounded_clock_is_no_gap(tmp_path):
    record = read_record(written(tmp_path, {"time_s": np.round(np.arange(40) / 3000, 4), "force_N": TIME}), {}, {})
    assert record.step == pytest.approx(1 / 3000, rel=2e-3)


WRONG = {
    "no time": ({"force_N": TIME}, {}, "expected a column 'time'"),
    "a gap in time": ({"time_s": np.r_[TIME[:20], TIME[20:] + 0.01], "force_N": TIME}, {}, "times, found sample"),
    "time that turns back": ({"time_s": -TIME, "force_N": TIME}, {}, "equally spaced times"),
    "too short": ({"time_s": TIME[:5], "force_N": TIME[:5]}, {}, "16 samples or more, found 5"),
    "a heading that is not there": ({"time_s": TIME, "force_N": TIME}, {"force": "Kraft"}, "names no column"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_what_is_wrong_is_said_in_a_sentence(case, tmp_path):
    columns, names, words = WRONG[case]
    with pytest.raises(WorkbenchError, match=words) as error:
        read_record(written(tmp_path, columns), names, {})
    assert "run.csv" in str(error.value) and "\n" not in str(error.value)


def test_what_a_tool_misses_is_said_when_it_asks(tmp_path):
    columns = {"time_s": TIME, "force_N": np.where(TIME == TIME[7], np.nan, TIME), "shunt_mohm": TIME}
    record = read_record(written(tmp_path, columns), {}, {})
    with pytest.raises(
        RecordError, match="expected a column 'stroke' with its unit, such as stroke_mm, found force, shunt"
    ):
        record.channel("stroke")
    with pytest.raises(RecordError, match="found a gap in sample 8"):
        record.channel("force")
    with pytest.raises(RecordError, match="expected one shunt in the whole record"):
        record.constant("shunt")


def test_a_column_without_a_known_unit_is_not_taken_for_si(tmp_path):
    columns = {"time_s": TIME, "force": TIME, "load [ozf]": TIME, "who": ["A"] * 40}
    with pytest.raises(
        RecordError, match=r"with a known unit beside time, such as force_N, found force, load \[ozf\], who"
    ):
        read_record(written(tmp_path, columns), {}, {})
    record = read_record(written(tmp_path, {**columns, "stroke_mm": TIME}), {}, {})
    with pytest.raises(RecordError, match=r"found stroke and, without a known unit, force, load \[ozf\], who; rename"):
        record.channel("force")


def test_what_is_stated_and_recorded_is_refused(tmp_path):
    with pytest.raises(RecordError, match="shunt is stated and stands in a column as well"):
        read_record(written(tmp_path, {"time_s": TIME, "shunt_mohm": TIME}), {}, {"shunt": 0.1})


def test_times_of_day_are_seconds(tmp_path):
    times = [f"12:00:{k:02d}" for k in range(40)]
    record = read_record(written(tmp_path, {"time": times, "force_N": TIME}), {}, {})
    assert record.step == pytest.approx(1.0)
