"""Finished points survive anything that can happen to the process that writes them."""

from dataclasses import dataclass

import numpy as np
import pytest

from pipeline.checkpoint import Checkpoint, digest


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
    assert checkpoint["point"]["map"] == Checkpoint(path, "inputs")["point"]["map"] == [0.0, 1 / 3, 2 / 3]


def test_what_cannot_be_written_is_refused_in_a_sentence(path):
    with pytest.raises(TypeError, match="cannot be written as JSON"):
        Checkpoint(path, "inputs").add("point", object())


@dataclass(frozen=True)
class Design:
    radius: float
    pattern: object


@dataclass(frozen=True)
class Parallel:
    pass


@dataclass(frozen=True)
class Radial:
    pass


def test_the_digest_sees_values_and_types_but_not_the_order_of_keys():
    assert digest({"a": 1, "b": 2}) == digest({"b": 2, "a": 1})
    assert digest(Design(0.1, Parallel())) == digest(Design(0.1, Parallel()))
    assert digest(Design(0.1, Parallel())) != digest(Design(0.1, Radial()))
    assert digest(Design(0.1, Parallel())) != digest(Design(0.1 + 1e-16, Parallel()))
