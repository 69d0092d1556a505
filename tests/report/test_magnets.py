"""What people read of the magnets: that they hold or fail, loudly, and where."""

import json
from dataclasses import replace
from math import inf

import numpy as np
import pytest

from electrical.magnets_stage import FAULT, NO_LOAD, MagnetInputs, MagnetsOutcome, MagnetState
from figures.magnets import magnets_at_worst
from figures.report import render_report
from magnetostatics.demagnetisation import MagnetFlux, MagnetMap
from materials.magnet_grade import load_grade
from pipeline.codec import decoded, encoded
from report import magnets
from tests.magnetostatics.reference_machine import reference_machine, section_of

CORNERS = 0.015 * np.array([[[0.9], [1.0], [0.9]], [[-0.2], [0.0], [0.2]]])  # one triangle
FLUX = MagnetFlux(np.array([[[0.2], [0.3], [0.5]]]), np.ones((3, 1)))
SEEN = MagnetMap(CORNERS, np.array([[0.1], [0.4], [0.6]]))


@pytest.fixture
def weak():
    """1 % may be lost and 4 % are, at a fault."""
    inputs = MagnetInputs(load_grade("N42SH"), -15.0, 120.0, 0.01, 10)
    states = (
        MagnetState(NO_LOAD, 0.0, 0.0, 0.5, 0.6, 0.0, 0.0, 0.1),
        MagnetState(FAULT, -90.0, 0.0, 0.0, 0.2, 0.04, 0.01, 0.1),
    )
    return MagnetsOutcome(inputs, 120.0, 0.278, states, 70.0, 720.0, True, FLUX, SEEN, SEEN)


@pytest.fixture
def strong(weak):
    return replace(weak, states=weak.states[:1], demagnetising_current=inf)


def test_magnets_that_fail_are_said_first_and_loudly(weak):
    first, current = magnets.remarks(weak)
    assert first.startswith("THE MAGNETS FAIL") and "N42SH at 120 °C" in first and f"4 % ({FAULT})" in first
    assert "materials.magnet_grade" in first and "70 A (peak), at which 1 %" in current


def test_magnets_that_hold_say_so(strong):
    first, current = magnets.remarks(strong)
    assert "hold: 0 %" in first and "FAIL" not in first and "none up to 720 A" in current


def test_what_the_numbers_rest_on_is_said(weak):
    """A peak beyond the map, a temperature beyond the grade, magnets that are lost without current."""
    hot = replace(weak, inputs=replace(weak.inputs, hot=180.0), peak_in_map=False, demagnetising_current=0.0)
    said = " ".join(magnets.remarks(hot))
    assert "more than the 150 °C" in said and "leaves the flux map" in said and "without current" in said


def test_the_table_marks_what_fails(weak):
    (table,) = [part for part in magnets.section(weak).content if type(part).__name__ == "Table"]
    assert table.marked == (1,)
    rows = magnets.states_table(weak)
    assert rows.margin_T.tolist() == pytest.approx([0.322, -0.078])
    assert rows.lost_in_a_turn_percent.tolist() == [0.0, 4.0]


def test_the_section_can_be_printed_and_the_picture_has_its_scale(weak, tmp_path):
    (tmp_path / "figures").mkdir()
    figure = magnets_at_worst(weak, section_of(reference_machine()))
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == ["y / mm", "y / mm", "flux density along the magnetisation / T"]
    figure.savefig(tmp_path / "figures" / "magnets.png")
    page = render_report((magnets.section(weak),), tmp_path, title="", subtitle="")
    assert "i_d = \N{MINUS SIGN}(ψ_m + |ψ_0|)/L_d" in page and "H_cJ at least 20 kOe" in page


def test_it_can_be_written_and_read_again(weak):
    text = json.dumps(encoded(replace(weak, demagnetising_current=inf)))
    found = decoded(json.loads(text), [])
    assert found.states == weak.states and found.inputs == weak.inputs and found.demagnetising_current == inf
    assert np.array_equal(found.turn.flux, SEEN.flux)
