"""What is kept of field solutions: whole or absent, never a traceback."""

import numpy as np
import pytest

from workbench.models.machine.build import SurrogateBuilder

FOUND = {"base": np.arange(2000.0), "slopes": np.ones((3, 4))}


@pytest.fixture
def builder(tmp_path):
    made = SurrogateBuilder.__new__(SurrogateBuilder)
    made.folder = tmp_path / "machine-1"
    made._save("no load", FOUND)
    return made


def test_arrays_come_back(builder):
    assert {name: (values == FOUND[name]).all() for name, values in builder._load("no load").items()} == {
        "base": True, "slopes": True,
    }  # fmt: skip
    assert [path.name for path in builder.folder.iterdir()] == ["no load.npz"]
    assert builder._load("loaded") is None


@pytest.mark.parametrize(
    "spoil",
    [lambda data: b"", lambda data: b"not an archive", lambda data: data[:-30], lambda data: data[: len(data) // 2],
     lambda data: data[:500] + b"\0" * 200 + data[700:]],
    ids=("empty", "text", "end cut", "half", "zeros inside"),
)  # fmt: skip
def test_a_malformed_file_counts_as_absent_and_is_replaced(builder, spoil):
    path = builder.folder / "no load.npz"
    path.write_bytes(spoil(path.read_bytes()))
    assert builder._load("no load") is None
    builder._save("no load", FOUND)
    assert (builder._load("no load")["base"] == FOUND["base"]).all()
