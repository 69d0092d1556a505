"""The winding diagram and the drawing with dimensions: nothing cut off, wires apart, true dimensions."""

from dataclasses import replace

import pytest

from electrical.winding_connection import Delta, Star
from figures.lamination import lamination
from figures.winding_diagram import _tracks, _wires, winding_diagram
from geometry.connections import connections
from geometry.winding import star_of_slots
from tests.figures.conftest import machine
from units import MILLIMETRE

WINDINGS = [(12, 5), (9, 4), (18, 2), (12, 5, 1), (48, 4)]


@pytest.mark.parametrize("winding", WINDINGS, ids=str)
def test_the_diagram_is_readable(winding, assert_readable):
    layout = star_of_slots(*winding)
    figure = winding_diagram(layout, connections(layout, 1), Star(), "4 coils in series a phase")
    assert_readable(figure)
    texts = [text.get_text() for text in figure.axes[0].texts]
    assert texts.count("star point") == 1 and {"A", "B", "C"} <= set(texts)


def test_a_delta_of_two_paths_has_terminals_in_the_place_of_a_star_point(assert_readable):
    """Each phase begins twice at its own letter and ends twice at the next one's."""
    layout = star_of_slots(12, 5)
    figure = winding_diagram(layout, connections(layout, 2), Delta(), "2 coils in series a path")
    assert_readable(figure)
    texts = [text.get_text() for text in figure.axes[0].texts]
    assert "star point" not in texts and [texts.count(name) for name in "ABC"] == [4, 4, 4]


@pytest.mark.parametrize("winding", WINDINGS, ids=str)
def test_no_two_wires_lie_on_each_other(winding):
    layout = star_of_slots(*winding)
    for phase in range(3):
        wires = _wires(layout, tuple(one for one in connections(layout, 1) if one.phase == phase))
        for track in set(tracks := _tracks(wires)):
            spans = sorted(sorted(wire) for wire, of in zip(wires, tracks) if of == track)
            assert all(one[1] < other[0] for one, other in zip(spans, spans[1:]))


@pytest.mark.parametrize("slots", [9, 12])
def test_the_drawing_says_the_dimensions_of_the_machine(slots, assert_readable):
    drawn = replace(machine(slots), magnet_arc_fraction=0.85)
    figure = lamination(drawn, star_of_slots(slots, 5))
    assert_readable(figure)
    said = " ".join(text.get_text() for axes in figure.axes for text in axes.texts)
    lengths = {"Ø": 2 * drawn.stator_outer_radius, "tooth": drawn.tooth_width, "yoke": drawn.back_iron_width,
               "opening": drawn.opening_width, "magnet": drawn.magnet_length, "air gap": drawn.airgap,
               "shoe $d_1$": drawn.shoe_d1, "shoe $d_2$": drawn.shoe_d2}  # fmt: skip
    for name, length in lengths.items():
        assert f"{name} {length / MILLIMETRE:.2f}" in said, name
    assert f"Ø {2 * drawn.stator_inner_radius / MILLIMETRE:.2f}  bore" in said
