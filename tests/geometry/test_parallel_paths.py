"""Parallel paths by the star of slots: EMFs added coil by coil, without the directions that the paths are made of."""

from cmath import exp
from math import pi

import pytest

from geometry.connections import connections
from geometry.errors import GeometryError
from geometry.winding import star_of_slots


def emf(layout, coils, order=1):
    """Of coils in series, over that of one conductor: by the slots of their sides."""
    step = 2j * pi * layout.pole_pairs * order / layout.slots
    return sum(coil.sign * (exp(step * coil.go[0]) - exp(step * coil.back[0])) for coil in coils)


# Published numbers: 12 slots and 8 poles repeat four times, 12 slots and 10 poles twice, 9 slots and 10 poles never;
# 36 slots and 6 poles have as many paths as poles.
@pytest.mark.parametrize(
    "slots, poles, numbers",
    [(12, 10, (1, 2)), (12, 8, (1, 2, 4)), (9, 10, (1,)), (24, 20, (1, 2, 4)), (36, 6, (1, 2, 3, 6)), (18, 16, (1, 2))],
)
def test_numbers_of_paths(slots, poles, numbers):
    assert star_of_slots(slots, poles // 2).path_numbers == numbers


@pytest.mark.parametrize("slots, pole_pairs", [(12, 5), (12, 4), (24, 10), (18, 8), (36, 3), (24, 11), (18, 2)])
def test_paths_have_equal_emfs_and_every_coil_once(slots, pole_pairs):
    layout = star_of_slots(slots, pole_pairs)
    for number in layout.path_numbers:
        for phase in range(3):
            paths = layout.paths_of(phase, number)
            assert len(paths) == number
            assert sorted(c.index for path in paths for c in path) == [c.index for c in layout.coils_of(phase)]
            for order in (1, 3, 5, 7):
                first, *others = (emf(layout, path, order) for path in paths)
                assert others == pytest.approx([first] * len(others), abs=1e-12)


def test_the_coils_of_12_slots_and_10_poles_are_not_all_in_phase():
    """Four coils, two directions 30 degrees apart: four paths would not be equal, and are refused in one sentence."""
    layout = star_of_slots(12, 5)
    alone = {complex(round(emf(layout, [coil]).real, 9), round(emf(layout, [coil]).imag, 9))
             for coil in layout.coils_of(0)}  # fmt: skip
    assert len(alone) == 2
    with pytest.raises(GeometryError, match="4 coils of a phase lie in 2 directions .* take 1 or 2"):
        layout.paths_of(0, 4)


def test_each_path_is_connected_from_terminal_to_end():
    rows = connections(star_of_slots(12, 5), 2)
    for phase in range(3):
        for path in (0, 1):
            begin, end = (one for one in rows if (one.phase, one.path) == (phase, path))
            assert begin.previous is None and end.following is None
            assert begin.following == end.coil and end.previous == begin.coil
