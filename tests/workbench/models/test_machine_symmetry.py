"""Which states of a machine are one but for its symmetries, against solutions at each of them (12 slots, 10 poles)."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.workbench.models.machine_case import COARSE, PLAN, drawn, field
from units import DEGREE
from workbench.models.machine.expansion import regular_nodes
from workbench.models.machine.field import LoadedState, read
from workbench.models.machine.pieces import Fields, LoadedBeside, LoadedNode, Machinery
from workbench.models.machine.symmetry import Symmetry, alike, mirror_axes, symmetries_of

HERE = LoadedState(8.2 * DEGREE, (40.0, -20.0, -20.0))
MIRRORED = LoadedState(-14.2 * DEGREE, HERE.currents)  # through the slot between coils 0 and 1, one pole on
ON = LoadedState(44.2 * DEGREE, (-40.0, 20.0, 20.0))  # a pole pitch on
NEXT = LoadedState(68.2 * DEGREE, (20.0, -40.0, 20.0))  # two slot pitches on, coil 2 with the current of coil 0
OTHER = LoadedState(8.2 * DEGREE, (0.0, 34.6, -34.6))
SEEN = (HERE, MIRRORED, ON, NEXT, OTHER)


def test_mirrors_are_found_where_there_are_some():
    assert mirror_axes(drawn()) == (0, 0)
    assert mirror_axes(drawn().with_one("opening_changes", 2, 1e-4).with_one("magnet_strengths", 3, 0.9)) == (5, 6)
    assert mirror_axes(drawn().with_one("magnet_turns", 1, 1e-3).with_one("magnet_turns", 4, -1e-3)) == (0, 5)
    for broken in ({"stator_shift": (0.0, 1e-5)}, {"rotor_shift": (1e-5, 1e-5)}):
        assert mirror_axes(replace(drawn(), **broken)) is None
    assert mirror_axes(drawn().with_one("magnet_turns", 1, 1e-3)) is None


DESIGNS = {
    "regular": (drawn(), (0, 4)),
    "weak magnet": (drawn().with_one("magnet_strengths", 4, 0.8), (0, 1, 2, 4)),  # slots are alike still
    "wide slot": (drawn().with_one("opening_changes", 0, 0.4e-3), (0, 3, 4)),  # seen in the mirror at itself
    "both": (drawn().with_one("magnet_strengths", 4, 0.8).with_one("opening_changes", 5, 0.4e-3), (0, 1, 2, 3, 4)),
    "fewer turns": (drawn().with_one("turns", 1, 6.0), (0, 1, 3, 4)),
}


@pytest.mark.parametrize("name", DESIGNS)
def test_states_follow_from_those_that_are_solved(name):
    design, solved = DESIGNS[name]
    assert field().alike(design, SEEN).solved == solved
    each = np.array([read(solution) for solution in field().loaded_solutions(design, SEEN)])
    assert_allclose(field().loaded(design, SEEN), each, rtol=1e-5, atol=1e-6 * np.abs(each).max())


def test_a_rotor_turned_beyond_its_states_loses_their_mirror():
    assert field().alike(drawn(), SEEN, turn=0.01).solved == (0, 1, 4)


def test_two_symmetries_one_after_the_other():
    first = Symmetry(2, np.array([0, 2, 1]), np.array([1.0, -1.0, 1.0]))
    then = Symmetry(5, np.array([0, 2, 1]), np.array([-1.0, 1.0, 1.0]), way=-1)
    sample = np.array([3.0, 4.0, 5.0])
    assert then.after(first)(7) == then(first(7)) == -4
    assert (then.after(first).change(sample) == then.change(first.change(sample))).all()


def test_nothing_follows_without_a_symmetry():
    found = alike(np.array([0.1, 0.2]), np.ones((2, 12)), (), 120)
    assert found.solved == (0, 1)
    assert (found.rows(np.arange(26.0).reshape(2, 13)) == np.arange(26.0).reshape(2, 13)).all()


def test_all_symmetries_of_the_drawing_leave_one_state_of_each_kind():
    """A slot pitch on, a pole pitch on, a mirror: of a revolution without current half a period of cogging is left."""
    group = symmetries_of(drawn(), COARSE.edges_around(drawn().machine))
    assert len(group) == 3
    turned = [LoadedState(angle, (0.0, 0.0, 0.0)) for angle in np.arange(0.0, 360.0, 1.5) * DEGREE]
    assert len(field().alike(drawn(), turned).solved) == 3  # 0, 1.5 and 3 degrees of the six of cogging


@pytest.mark.parametrize("piece", (LoadedBeside(), LoadedNode(regular_nodes(drawn())[0])), ids=("beside", "node"))
def test_what_is_solved_beside_states_follows_as_well(piece):
    """Two states of a pair at once, and each by itself."""
    fields = Fields(Machinery(drawn(), PLAN))
    both = piece.solve(fields, (HERE, MIRRORED))
    for k, state in enumerate((HERE, MIRRORED)):
        alone = piece.solve(Fields(Machinery(drawn(), PLAN)), (state,))
        for key, rows in alone.items():
            assert_allclose(both[key][k], rows[0], rtol=1e-3, atol=1e-4 * np.abs(rows).max(), err_msg=key)
