"""What is kept of field solutions: whole or absent, never a traceback; with new states only those are solved."""

import multiprocessing
import os

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.workbench.models.machine_case import STATES, drawn
from workbench.models.machine.build import Store, SurrogateBuilder
from workbench.models.machine.field import LoadedState
from workbench.models.machine.pieces import LoadedCoils, NoLoadValues, Piece, loaded_pieces, no_load_pieces
from workbench.models.machine.solver import in_kinds

FOUND = {"base": np.arange(2000.0), "slopes": np.ones((3, 4))}


@pytest.fixture
def store(tmp_path):
    made = Store(tmp_path / "machine-1")
    made.write("no load", FOUND)
    return made


def test_arrays_come_back(store):
    found = store.load(NoLoadValues(), ())
    assert found.missing is None
    assert {name: (values == FOUND[name]).all() for name, values in found.rows(()).items()} == {
        "base": True, "slopes": True,
    }  # fmt: skip
    assert [path.name for path in store.folder.iterdir()] == ["no load.npz"]
    assert store.read("loaded") is None


@pytest.mark.parametrize(
    "spoil",
    [lambda data: b"", lambda data: b"not an archive", lambda data: data[:-30], lambda data: data[: len(data) // 2],
     lambda data: data[:500] + b"\0" * 200 + data[700:]],
    ids=("empty", "text", "end cut", "half", "zeros inside"),
)  # fmt: skip
def test_a_malformed_file_counts_as_absent_and_is_replaced(store, spoil):
    path = store.folder / "no load.npz"
    path.write_bytes(spoil(path.read_bytes()))
    assert store.load(NoLoadValues(), ()).missing == ()
    store.save(store.load(NoLoadValues(), ()), FOUND)
    assert (store.read("no load")["base"] == FOUND["base"]).all()


def test_states_are_kept_one_by_one(tmp_path):
    """A second campaign with one more state solves that one; the rows come in the order that is asked for."""
    store, more = Store(tmp_path), LoadedState(0.4, (1.0, 2.0, -3.0))
    first = store.load(LoadedCoils(), STATES[:2])
    assert first.missing == STATES[:2]
    store.save(first, {"slope coil[0]": np.array([[1.0], [2.0]])})
    second = store.load(LoadedCoils(), (more, STATES[1]))
    assert second.missing == (more,)
    rows = store.save(second, {"slope coil[0]": np.array([[3.0]])}).rows((more, STATES[1]))
    assert_allclose(rows["slope coil[0]"], [[3.0], [2.0]])


class Numbered(Piece):
    """Stands for a piece that takes long."""

    name = "numbered"

    def solve(self, fields, states):
        return {"angle": np.array([state.angle for state in states])}


class Stopped(Numbered):
    """Ctrl-C while it is solved."""

    name = "stopped"

    def solve(self, fields, states):
        raise KeyboardInterrupt


def test_after_an_interruption_what_was_solved_is_on_disk(tmp_path):
    builder = SurrogateBuilder(drawn(), cache=tmp_path)
    with pytest.raises(KeyboardInterrupt):
        builder._found([Numbered(), Stopped()], STATES, None)
    assert builder.store.load(Numbered(), STATES).missing is None
    assert builder.store.load(Stopped(), STATES).missing == STATES


def test_pieces_of_two_processes_and_one_that_is_lost():
    """The same as in this process, also where a worker ends on the way; progress counts all."""
    words, pieces = [], [Numbered(), OnlyHere()]
    for workers in (1, 2):
        found = SurrogateBuilder(drawn(), cache=None, workers=workers)._found(pieces, STATES, words.append)
        assert all(found[piece.name]["angle"].tolist() == [state.angle for state in STATES] for piece in pieces)
    assert [text.split(",")[0][-6:] for text in words] == ["1 of 2", "2 of 2"] * 2


class OnlyHere(Numbered):
    name = "only here"

    def solve(self, fields, states):
        if multiprocessing.parent_process() is not None:
            os._exit(1)
        return super().solve(fields, states)


def test_pieces_of_one_kind_come_after_each_other():
    """All of them, each kind once; a sector and the whole machine, with current and without."""
    pieces = (*loaded_pieces(drawn()), *no_load_pieces(drawn()))
    ordered = in_kinds(pieces)
    kinds = [piece.kind for piece in ordered]
    changes = sum(one != other for one, other in zip(kinds, kinds[1:]))
    assert sorted(piece.name for piece in ordered) == sorted(piece.name for piece in pieces)
    assert changes + 1 == len(set(kinds)) == 4
