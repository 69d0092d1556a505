"""Cross-section and field map."""

import matplotlib
import numpy as np
import pytest
from matplotlib.collections import PolyCollection, TriMesh

from figures.cross_section import cross_section, dimension_list, region_colour
from figures.field_map import colour_limit, field_map, outlines
from figures.style import PHASE_COLOURS, PHASE_LIGHT
from figures.whole_field import Region, whole_field


@pytest.fixture(scope="module")
def field(half_machine):
    return whole_field(half_machine)


def test_field_map_is_complete(field, assert_readable):
    figure = field_map(field)
    axes, bar = figure.axes
    assert axes.get_xlabel() == "x / mm" and axes.get_ylabel() == "y / mm"
    assert bar.get_ylabel() == "flux density |B| / T"
    assert "8.485 A/mm²" in axes.get_title(loc="left")
    assert_readable(figure)


def test_colours_end_at_the_limit_that_is_asked_for(field):
    mesh = field_map(field, largest_b=2.0).axes[0].findobj(TriMesh)[0]
    assert mesh.get_clim() == (0.0, 2.0)
    assert 1.5 <= colour_limit(field) <= 1.8


def test_outlines_follow_the_borders(field):
    pieces = outlines(field.points, field.cells, field.region)
    radius = np.hypot(pieces[..., 0], pieces[..., 1])
    assert radius.max() == pytest.approx(42.5)
    assert (np.abs(radius - 15.95).min(axis=1) > 0.05).all(), "the sliding circle is not a border"
    bore = pieces[(np.abs(radius - 16.2) < 1e-6).all(axis=1)]
    openings = 12 * 2 * 16.2 * np.arcsin(1.0 / 16.2)
    assert _length(bore) == pytest.approx(2 * np.pi * 16.2 - openings, rel=0.002), "gap and opening are both air"
    outer = pieces[(np.abs(radius - 42.5) < 1e-6).all(axis=1)]
    assert _length(outer) == pytest.approx(2 * np.pi * 42.5, rel=0.002)


def _length(pieces):
    return np.hypot(*(pieces[:, 1] - pieces[:, 0]).T).sum()


@pytest.mark.parametrize("name, teeth", [("half_machine", 6), ("full_machine", 9)])
def test_cross_section_is_complete(name, teeth, request, assert_readable):
    section = request.getfixturevalue(name).model.section
    figure = cross_section(section)
    axes = figure.axes[0]
    texts = [text.get_text() for text in axes.texts]
    slots = section.machine.slots
    assert sum(text[:1] in "+−" and text[1:] in "ABC" for text in texts if text) == 2 * slots
    assert texts.count("+A") == texts.count("−A")
    assert texts.count(str(teeth - 1)) == 2, "the last tooth and the last back-iron probe carry their number"
    assert sum(1 for text in axes.texts if not text.get_text()) == 3 * section.machine.poles, "three arrows a magnet"
    assert len(axes.findobj(PolyCollection)[0].get_paths()) == section.sectors * section.mesh.nelements
    assert_readable(figure)


def test_colours_are_phases(half_machine):
    """12/10: A +0R, so red and full; -z in slot 1R, so red and light; C fills slot 4."""
    section = half_machine.model.section
    assert region_colour("slot_0_R", section) == PHASE_COLOURS[0]
    assert region_colour("slot_1_R", section) == PHASE_LIGHT[0]
    assert region_colour("slot_8_R", section) == PHASE_COLOURS[1]
    assert region_colour("slot_4_R", section) == PHASE_COLOURS[2]


def test_dimensions_are_written_in_millimetres(half_machine):
    text = dimension_list(half_machine.model.section.machine)
    for part in ("stator outer radius: 42.50 mm", "tooth width: 5.50 mm", "air gap: 0.50 mm", "1.43, 1.43 mm"):
        assert part in text


def test_settings_of_the_caller_are_left_alone(field):
    with matplotlib.rc_context({"font.size": 7.0, "axes.spines.top": True}):
        before = matplotlib.rcParams.copy()
        field_map(field)
        assert matplotlib.rcParams == before


def test_outlines_of_a_large_mesh():
    """Two triangles at the end of more nodes than the root of the largest 32-bit number."""
    count = 70_000
    points = np.zeros((2, count))
    points[:, -4:] = [[0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 1.0, 1.0]]
    cells = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32).T + np.int32(count - 4)
    found = outlines(points, cells, Region(np.zeros(2, dtype=int), ("stator_iron",)))
    assert len(found) == 4 and np.ptp(found, axis=1).sum() == pytest.approx(4000.0)
