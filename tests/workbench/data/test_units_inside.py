"""Units of what a fit moves."""

import pytest

from workbench.data.column_units import unit_inside


@pytest.mark.parametrize(
    "name, unit",
    [
        ("end_winding_inductance", "H"), ("inductance_d", "H"), ("stacking_factor", "1"), ("phase_resistance_a", "ohm"),
        ("remanence", "T"), ("recoil_permeability", "1"), ("magnet_arc_fraction", "1"), ("magnet_temperature", "K"),
        ("airgap", "m"), ("active_length", "m"), ("encoder_zero", "rad"), ("current_offset", "A"),
    ],
)  # fmt: skip
def test_inputs_that_are_no_lengths_are_not_said_in_metres(name, unit):
    assert unit_inside(name) == unit
