"""Losses over currents, torque and speed."""

from math import pi

import numpy as np
import pytest
import xarray as xr

from electrical.dq import DriveLimits, operating_map
from electrical.synchronous_machine import SynchronousMachine
from electrical.winding_connection import Delta, WindingConnection
from electrical.wound_machine import WoundMachine
from losses.iron import FrequencyTerms, iron_loss
from losses.loci import HALF_WAVE, rotor_loci, stator_loci
from losses.map import FieldLosses, LossGrid, current_point, field_losses, power_losses
from magnetostatics.torque import arkkio_torque
from materials.iron_loss import iron_loss_law
from tests.electrical.wires import series_star
from tests.losses.conftest import NOMINAL, PACKING, machine
from units import MILLIMETRE, RPM

LAW = iron_loss_law("M235-35A")
FREQUENCY = 5 * 4000 * RPM / (2 * pi)  # 333 Hz
LENGTH = 41 * MILLIMETRE
WOUND = WoundMachine(machine(), 4, 1, series_star(7, 22), LENGTH)
MOTOR = SynchronousMachine(5, 6.5e-3, 84e-6, 84e-6, 12.5e-3)
LARGEST = 7 * 125.0


def planar(direct, quadrature):
    """Losses that a linear interpolation keeps exactly on the side of positive quadrature currents."""
    return FieldLosses(
        FrequencyTerms(1.0 + 1e-3 * direct, 2e-3 + 1e-6 * quadrature, 1e-2),
        FrequencyTerms(1e-3, 1e-6, 0.0),
        FrequencyTerms(0.0, 1e-4 + 1e-7 * quadrature, 0.0),
    )


GRID = LossGrid.of(WOUND.machine.rotor, LARGEST)
TABLE = GRID.table([planar(d, q) for d, q in GRID.points])


@pytest.mark.physics
@pytest.mark.reference
def test_reference_machine_at_4000_rpm(idle, loaded):
    """No load and 6 A/mm2: the numbers of the first solution of this machine, to see changes; rotor against stator."""
    stator, rotor = (iron_loss(loci(idle), LAW).total.at(FREQUENCY) * LENGTH for loci in (stator_loci, rotor_loci))
    assert stator == pytest.approx(18.9, rel=0.01)
    assert rotor < 2e-3 * stator
    stator, rotor = (iron_loss(loci(loaded), LAW).total.at(FREQUENCY) * LENGTH for loci in (stator_loci, rotor_loci))
    assert stator == pytest.approx(22.3, rel=0.01)
    assert rotor < 2e-3 * stator


@pytest.mark.physics
def test_energy_is_plausible(loaded):
    """Losses are a few per cent of the power, and per kilogram between the law at 0.7 and at 1.8 T."""
    loss = iron_loss(stator_loci(loaded), LAW)
    power = np.mean([arkkio_torque(solution) for solution in loaded.solutions]) * 4000 * RPM
    assert 0.01 * power < loss.total.at(FREQUENCY) < 0.05 * power
    per_kilogram = loss.total.at(FREQUENCY) / (LAW.density * 2 * loss.loci.area.sum())
    assert LAW.specific_loss(FREQUENCY, 0.7) < per_kilogram < LAW.specific_loss(FREQUENCY, 1.8)
    assert loss.share_beyond_data(FREQUENCY) < 0.02


@pytest.mark.physics
def test_field_weakening_lowers_the_stator_loss(reference):
    none, weakened = (
        field_losses(reference, current_point(reference.section, d, 0.0, PACKING), LAW, steps=24).stator.at(FREQUENCY)
        for d in (0.0, -400.0)
    )
    assert weakened < 0.85 * none


@pytest.mark.physics
def test_sign_of_the_quadrature_current_does_not_matter(reference):
    """The machine is its own mirror image, so a table needs one side only."""
    points = (current_point(reference.section, -200.0, q, PACKING) for q in (300.0, -300.0))
    motor, generator = (field_losses(reference, p, LAW, steps=24, repetition=HALF_WAVE) for p in points)
    assert motor.stator.at(FREQUENCY) == pytest.approx(generator.stator.at(FREQUENCY), rel=1e-4)
    assert motor.rotor.at(FREQUENCY) == pytest.approx(generator.rotor.at(FREQUENCY), rel=0.01)
    assert motor.magnet.at(FREQUENCY) == pytest.approx(generator.magnet.at(FREQUENCY), rel=1e-3)


def test_current_point(reference):
    """Ampere-turns become a current density of that amount, and a negative direct current weakens the field."""
    section = reference.section
    here = current_point(section, -30.0, 40.0, PACKING)
    assert here.current_density * PACKING * section.half_slot_area == pytest.approx(50.0)
    assert -np.sin(here.current_angle) == pytest.approx(-0.6) and np.cos(here.current_angle) == pytest.approx(0.8)
    nominal = current_point(section, 0.0, NOMINAL * PACKING * section.half_slot_area, PACKING)
    assert nominal.current_density == pytest.approx(NOMINAL)


def test_table_interpolates():
    found, expected = TABLE.at(-123.0, 456.0), planar(-123.0, 456.0)
    assert found.at(FREQUENCY) == pytest.approx(expected.at(FREQUENCY), rel=1e-12)
    assert TABLE.at(-123.0, -456.0).at(FREQUENCY) == pytest.approx(expected.at(FREQUENCY), rel=1e-12)
    both = TABLE.at(np.array([[-100.0, np.nan]]), np.array([[50.0, np.nan]]))
    assert both.stator.hysteresis.shape == (1, 2) and np.isnan(both.stator.hysteresis[0, 1])


@pytest.mark.parametrize("direct, quadrature", [(-1.1 * LARGEST, 0.0), (0.8 * LARGEST, 0.0), (0.0, 1.1 * LARGEST)])
def test_table_does_not_extrapolate(direct, quadrature):
    with pytest.raises(ValueError, match="build it for a larger current"):
        TABLE.at(direct, quadrature)


def plane(torque, rpm):
    return operating_map(MOTOR, DriveLimits(122.0, 27.7), torque, np.asarray(rpm) * RPM)


def test_parts_of_the_map():
    """Copper by 3/2 R I^2, iron by length and frequency, at a point that is worked out here by hand."""
    found = power_losses(plane(3.0, 2000.0), WOUND, TABLE, xr.Dataset())
    current, frequency = 3.0 / (1.5 * 5 * 6.5e-3), 5 * 2000 / 60
    assert found.copper == pytest.approx(1.5 * 12.4807e-3 * current**2, rel=1e-4)
    stator, rotor, magnet = planar(0.0, 7 * current).at(frequency)
    assert (found.stator_iron, found.rotor_iron) == (pytest.approx(LENGTH * stator), pytest.approx(LENGTH * rotor))
    assert found.magnet == pytest.approx(LENGTH * magnet)
    mechanical = 3.0 * 2000 * RPM
    assert found.efficiency == pytest.approx(mechanical / (mechanical + found.total))


def test_field_weakening_costs_copper():
    low, high = (power_losses(plane(1.0, rpm), WOUND, TABLE, xr.Dataset()) for rpm in (4000.0, 9000.0))
    weakening = plane(1.0, 9000.0).i_d
    more = 1.5 * WOUND.phase_resistance * weakening**2
    assert weakening < -10 and high.copper - low.copper == pytest.approx(more, rel=1e-6)
    unreachable = power_losses(plane(6.0, 9000.0), WOUND, TABLE, xr.Dataset())
    assert np.isnan(unreachable.total) and np.isnan(unreachable.efficiency)


def test_efficiency_in_all_quadrants():
    found = power_losses(plane(np.array([2.0, -2.0, 0.0, -1e-3]), 3000.0), WOUND, TABLE, xr.Dataset())
    motor, generator, idle, starved = found.efficiency
    assert 0.5 < generator < motor < 1  # the same loss out of the smaller of two powers
    assert np.isnan(idle) and np.isnan(starved)  # nothing comes out
    assert found.total[0] == pytest.approx(found.total[1])


def test_what_circulates_in_a_delta_is_a_part_of_the_loss():
    """A third harmonic of 0.1 mWb/m, the same at every current; none in the star that the other tests have."""
    axis = np.linspace(-LARGEST, LARGEST, 3)
    data = xr.Dataset(
        {"psi_0": (("order", "id", "iq"), np.full((1, 3, 3), 1e-4)), "l_0": 0.0},
        {"order": [3], "id": axis, "iq": axis},
    )
    design = series_star(7, 22, connection=WindingConnection(1, Delta()))
    delta = WoundMachine(machine(), 4, 1, design, LENGTH)
    point = operating_map(MOTOR, DriveLimits(122.0, 27.7), 3.0, np.asarray(2000 * RPM))
    found, star = power_losses(point, delta, TABLE, data), power_losses(point, WOUND, TABLE, data)
    emf = 3 * 5 * 2000 * RPM * 7 * LENGTH * 1e-4
    assert found.circulating == pytest.approx(1.5 * emf**2 / WOUND.phase_resistance)
    assert star.circulating == 0.0 and found.total - found.circulating == pytest.approx(
        found.copper + found.stator_iron + found.rotor_iron + found.magnet
    )
