"""What the electrical stages hand on can be written and read again without a change."""

import json

import pytest

from electrical.drive_stage import drive_stage
from electrical.driven_machine import driven_machine
from electrical.winding_stage import winding_stage
from pipeline.codec import decoded, encoded
from tests.electrical.analytic_map import DEMAND, GOOD, INPUTS, MATCHED, Saturating, flux_map

MAP = flux_map(Saturating())


def again(value):
    datasets = []
    text = json.dumps(encoded(value, datasets))
    return decoded(json.loads(text), datasets), text


@pytest.fixture(scope="module")
def winding():
    return winding_stage(MAP, MATCHED, DEMAND, INPUTS, GOOD)


def test_the_winding(winding):
    found, _ = again(winding)
    assert found == winding
    assert found.wound.phase_resistance == winding.wound.phase_resistance


def test_the_map_and_what_is_read_from_it(winding):
    found, _ = again(MAP)
    machine = winding.wound.on_map(found.data)
    currents = winding.direct_current, winding.quadrature_current
    assert float(machine.torque(*currents)) == pytest.approx(winding.peak_torque, rel=1e-12)
    assert found.torque_ripple(-100.0, 300.0) == MAP.torque_ripple(-100.0, 300.0)


def test_the_drive_is_small(winding):
    drive = drive_stage(MAP, winding, driven_machine(winding, INPUTS), INPUTS)
    found, text = again(drive)
    assert found.field.plane.current_peak == pytest.approx(drive.field.plane.current_peak, nan_ok=True)
    assert found.field.envelope.torque == pytest.approx(drive.field.envelope.torque, nan_ok=True)
    assert len(text) < 500_000
