"""What flows between stages comes back as it was, and nothing else is built from a file."""

import json
from dataclasses import dataclass, replace

import numpy as np
import pytest
import xarray as xr
from toy_graph import Largest, Squares

from geometry.magnetisation import ParallelMagnetisation, RadialMagnetisation
from materials.library import load_steel
from pipeline.codec import CodecError, decoded, digest, encoded


@dataclass(frozen=True)
class Record:
    number: float
    name: str | None
    pattern: object
    parts: tuple
    by_key: dict
    point: complex = 1 + 2j


RECORD = Record(
    float("nan"), None, RadialMagnetisation(), (1, 2.5, (True,), Largest(3)), {("a", 1): [1.0], "b": float("inf")}
)


def back(value):
    datasets = []
    return decoded(json.loads(json.dumps(encoded(value, datasets), allow_nan=False)), datasets)


def test_a_record_comes_back_with_its_types():
    found = back(RECORD)
    assert np.isnan(found.number) and replace(found, number=0.0) == replace(RECORD, number=0.0)
    assert isinstance(found.pattern, RadialMagnetisation) and isinstance(found.parts[3], Largest)


@pytest.mark.parametrize("kind", [float, int, bool, "U3"])
def test_an_array_comes_back_to_the_last_bit_with_its_type(kind):
    values = (np.arange(6).reshape(2, 3) / 7).astype(kind)
    found = back(values)
    assert found.dtype == values.dtype and found.shape == values.shape and (found == values).all()


def test_datasets_stand_beside_the_text():
    squares = Squares((0, 1), xr.Dataset({"square": ("k", [0.0, 1.0])}))
    datasets = []
    assert encoded(squares, datasets)["fields"]["data"] == {"dataset": 0} and len(datasets) == 1
    assert decoded(encoded(squares, []), datasets).data.identical(squares.data)


def test_a_dataset_stands_in_the_text_where_nothing_can_stand_beside():
    """As in the lines of a checkpoint: coordinates, names and the last bit."""
    data = xr.Dataset({"a": (("state", "k"), np.arange(6).reshape(2, 3) / 7)}, {"state": ["idle", "full"]}, {"n": 1})
    text = json.dumps(encoded(Squares((), data)))
    assert decoded(json.loads(text)).data.identical(data)


def test_the_law_of_a_steel_comes_back():
    steel = load_steel("35PN270")
    assert (back(steel).nu(np.linspace(0, 5, 50)) == steel.nu(np.linspace(0, 5, 50))).all()


@pytest.mark.parametrize("value", [object(), lambda: 0, {1, 2}, Record])
def test_what_cannot_be_written_is_refused(value):
    with pytest.raises(CodecError, match="cannot be written"):
        encoded(value)


@pytest.mark.parametrize(
    "content",
    [
        {"dataclass": "os:system", "fields": {}},
        {"dataclass": "pathlib:Path", "fields": {}},
        {"dataclass": "pipeline.codec:decoded", "fields": {}},
        {"dataclass": "geometry.machine:Nothing", "fields": {}},
        {"dataclass": "geometry.machine:Machine", "fields": {"slots": 3}},
        {"dataclass": 7},
        {"float": "no"},
        {"array": [1], "dtype": "no"},
        {"dataset": 0},
        {"unknown": 1},
        {},
    ],
)
def test_a_text_that_was_not_written_by_us_is_refused(content):
    with pytest.raises(CodecError):
        decoded(content)


def test_a_digest_tells_values_apart_and_equal_ones_not():
    assert digest(RECORD) == digest(replace(RECORD))
    assert digest(ParallelMagnetisation()) != digest(RadialMagnetisation())
    data = xr.Dataset({"square": ("k", [0.0, 1.0])})
    assert digest(Squares((), data)) != digest(Squares((), data + 1e-15))
