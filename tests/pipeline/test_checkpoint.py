"""Finished points survive anything that can happen to the process that writes them."""

import numpy as np
import pytest

from pipeline.checkpoint import Checkpoint
from pipeline.codec import CodecError


@pytest.fixture
def path(tmp_path):
    return tmp_path / "results" / "sweep.checkpoint.jsonl"


@pytest.fixture
def filled(path):
    checkpoint = Checkpoint(path, "inputs")
    for number in range(5):
        checkpoint.add(f"point {number}", {"torque": 0.1 * number, "probes": [1.0, number]})
    return path


def test_points_come_back_exactly(filled):
    again = Checkpoint(filled, "inputs")
    assert len(again) == 5 and "point 3" in again and "point 5" not in again
    assert again["point 3"] == {"torque": 0.1 * 3, "probes": [1.0, 3]}


@pytest.mark.parametrize("cut", [1, 10, 40])
def test_a_last_line_cut_by_a_killed_process_is_dropped_and_the_file_goes_on(filled, cut):
    filled.write_bytes(filled.read_bytes()[:-cut])
    again = Checkpoint(filled, "inputs")
    assert len(again) == 4
    again.add("point 4", "anew")
    again.add("point 5", "more")
    whole = Checkpoint(filled, "inputs")
    assert len(whole) == 6 and whole["point 4"] == "anew"


def test_a_cut_header_leaves_no_points(filled):
    filled.write_bytes(filled.read_bytes()[:8])
    again = Checkpoint(filled, "inputs")
    assert len(again) == 0
    again.add("point 0", 1)
    assert len(Checkpoint(filled, "inputs")) == 1


def test_points_of_other_inputs_are_never_used(filled):
    other = Checkpoint(filled, "other inputs")
    assert len(other) == 0
    other.add("point 9", 1)
    assert len(Checkpoint(filled, "other inputs")) == 1
    assert len(Checkpoint(filled, "inputs")) == 0


def test_each_point_is_on_disk_when_add_returns(path):
    checkpoint = Checkpoint(path, "inputs")
    assert not path.exists()
    checkpoint.add("point", 1)
    assert path.read_text().count("\n") == 2


def test_a_result_is_the_same_before_and_after_reading(path):
    checkpoint = Checkpoint(path, "inputs")
    checkpoint.add("point", {"map": np.arange(3) / 3, "nan": float("nan")})
    maps = [one["point"]["map"].tolist() for one in (checkpoint, Checkpoint(path, "inputs"))]
    assert maps == [[0.0, 1 / 3, 2 / 3]] * 2


def test_what_cannot_be_written_is_refused_in_a_sentence(path):
    with pytest.raises(CodecError, match="cannot be written"):
        Checkpoint(path, "inputs").add("point", object())


@pytest.mark.parametrize(
    "line",
    ["7", "[]", "null", "{}", '{"point": 3, "result": 1}', '{"point": "a"}', '{"point": "a", "result": {"float": "x"}}',
     '{"point": "a", "result": {"dataclass": "os:system", "fields": {}}}', "\x00\x00", "[" * 20000],
)  # fmt: skip
def test_a_line_that_is_none_of_ours_counts_as_absent(filled, line):
    lines = filled.read_text().splitlines()
    filled.write_text("\n".join([*lines[:3], line, *lines[3:]]) + "\n")
    again = Checkpoint(filled, "inputs")
    assert len(again) == 2
    again.add("point 2", "anew")
    assert len(Checkpoint(filled, "inputs")) == 3
