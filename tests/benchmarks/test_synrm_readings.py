"""Which winding the reluctance machine's torque asks for (``python -m benchmarks.synrm_readings``)."""

import csv

import numpy as np
import pytest

from benchmarks.synrm_readings import ANGLES, READINGS, TABLE, held, measured, torques, with_gap
from geometry.areas import part_areas
from study.machine_file import read_machine
from units import DEGREE, MILLIMETRE


def table():
    with open(TABLE, encoding="utf-8", newline="") as file:
        return {row["reading"]: row for row in csv.DictReader(file)}


@pytest.fixture(scope="module")
def found():
    return read_machine("szesynrm_outline")


def test_every_reading_is_in_the_table():
    assert list(table()) == [reading.words for reading in READINGS]


@pytest.mark.parametrize("reading", [READINGS[0], READINGS[3]], ids=["coil pitch 10", "full pitch"])
def test_error_factor_and_shape_at_the_largest_current(found, reading):
    currents, rows = list(measured())[-1]
    here = held(torques(reading.model(found), currents, found), rows)
    row = table()[reading.words]
    assert here.rms == pytest.approx(float(row["rms_31"]), abs=0.1)
    assert here.factor == pytest.approx(float(row["factor_31"]), abs=0.002)
    assert here.shape == pytest.approx(float(row["shape_31"]), abs=0.1)


def test_full_pitch_leaves_less_of_the_shape_at_every_current():
    """By a fifth and more, over all three by more than a third."""
    full, short = (
        np.array([float(table()[reading][f"shape_{current}"]) for current in (15, 21, 31)])
        for reading in ("full pitch, as in the machine's file", "coil pitch 10")
    )
    assert (full < 0.8 * short).all()
    assert np.hypot.reduce(full) < 0.65 * np.hypot.reduce(short)


def test_the_machine_file_has_that_winding(found):
    assert (found.layout.coil_pitch, found.equivalent_turns) == (12, 4)


def test_factor_and_zero_are_found_again():
    """Of a made curve that is 1.1 times the model's and 0.7 degrees off."""
    _, rows = next(measured())
    model = np.sin(4 * ANGLES)
    made = rows.assign(torque_Nm=1.1 * np.interp(rows.angle_mech_deg * DEGREE - 0.7 * DEGREE, ANGLES, model))
    here = held(model, made)
    assert (here.factor, here.zero / DEGREE, here.shape) == pytest.approx((1.1, 0.7, 0.0), abs=1e-9)


def test_a_gap_scales_the_rotor(found):
    wider = with_gap(found.machine, 1.1 * MILLIMETRE)
    wider.rotor.check()
    assert wider.airgap == pytest.approx(1.1 * MILLIMETRE)
    areas = [part_areas(machine).rotor_laminations for machine in (wider, found.machine)]
    assert areas[0] / areas[1] == pytest.approx((83.9 / 84.0) ** 2, rel=1e-6)
