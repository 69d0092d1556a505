"""Torque of warm magnets against a field solution, losses of a map and without one, and a duty as mean squares."""

from dataclasses import replace

import numpy as np
import pytest

from electrical.dq import DriveLimits, mtpa_currents
from electrical.flux_map_machine import FluxMapMachine
from geometry.cross_section import mesh_cross_section
from geometry.winding import star_of_slots
from losses.map import PowerLosses
from magnetostatics.flux_linkage import flux_linkage_torque
from magnetostatics.model import FieldModel, MachineMaterials, OperatingPoint
from materials.conductor import COPPER
from materials.library import load_steel
from materials.magnet import Magnet
from tests.drivetrain.linear_machine import POLES, closed_form, flux_map
from tests.thermal.built import MACHINE, WEIGHTS, cooled
from thermal.field_loss import MappedLoss, NoLossData
from thermal.load import HotCopper, Operation, TorqueHistory, copper_ripple, operation
from thermal.machine import MAGNETS, SLOT

HOT = Magnet(1.3, 1.0)
LIMITS = DriveLimits.from_dc_bus(60.0, 48.0)


@pytest.fixture(scope="module")
def machine():
    found = FluxMapMachine.from_per_turn(flux_map(), turns=8, active_length=0.04, resistance=0.0)
    return replace(found, resistance=closed_form().resistance)


@pytest.fixture(scope="module")
def slow(machine):
    return operation(machine, LIMITS, 0.0, HOT)


def test_a_linear_machine_loses_torque_as_its_magnets_do(slow):
    assert slow.torque_of(40.0, 20.0) == pytest.approx(1.5 * POLES * closed_form().psi_m * 40.0, rel=1e-4)
    assert slow.torque_of(40.0, 120.0) == pytest.approx(0.89 * slow.torque_of(40.0, 20.0), rel=1e-3)
    assert slow.current_of(np.array([-0.5, 0.5]), 120.0) == pytest.approx(
        slow.current_of(np.array([0.5, 0.5]) / 0.89, 20.0), rel=1e-3
    )


@pytest.mark.parametrize("density", (6e6, 20e6), ids=("nominal", "overload"))
def test_a_field_solution_with_weaker_magnets_agrees(density):
    """11 % less remanence, 100 K: iron that is less saturated gives some of it back, as the docstring says."""
    section, steel = mesh_cross_section(MACHINE, star_of_slots(12, 5)), load_steel("35PN270")
    point = OperatingPoint(0.0, 2**0.5 * density, 0.0, 0.3)

    def torque(remanence, at):
        model = FieldModel(section, MachineMaterials(steel, steel, Magnet(remanence, 1.0)))
        return flux_linkage_torque(model.solve(at))

    cold, weak = torque(1.3, point), torque(1.3 * 0.89, point)
    assert 0.978 * weak < cold * HOT.remanence_share(120.0) < weak < 0.92 * cold


def test_beyond_base_speed_the_voltage_takes_torque(machine, slow):
    fast = operation(machine, LIMITS, 4000.0, HOT)
    assert fast.torque_of(60.0, 20.0) < 0.9 * slow.torque_of(60.0, 20.0)
    assert np.all(np.diff(fast.torque(20.0)) >= 0)


def test_at_a_speed_that_no_voltage_reaches_there_is_no_torque(machine):
    assert not operation(machine, DriveLimits(5.0, 1.0), 5000.0, HOT).torque(20.0).any()


def test_torque_over_current_is_that_of_the_least_current(machine, slow):
    i_d, i_q = mtpa_currents(machine, 33.3)
    assert slow.torque_of(33.3, 20.0) == pytest.approx(float(machine.torque(i_d, i_q)), rel=1e-3)


def test_a_duty_counts_by_its_mean_squares(slow):
    torque, speed = np.array([0.0, 0.3, -0.6, 0.3]), np.array([0.0, 10.0, -20.0, 10.0])
    square, fast = TorqueHistory(torque, speed, slow).squares(20.0)
    per_torque = slow.current_of(np.array(0.3), 20.0)
    assert square == pytest.approx(per_torque**2 * (0 + 1 + 4 + 1) / 4, rel=1e-3)
    assert fast == pytest.approx((POLES * per_torque) ** 2 * (0 + 100 + 1600 + 100) / 4, rel=1e-3)


def test_the_copper_moves_with_a_slow_duty_by_the_heat_it_keeps(slow):
    """Half a minute on, half a minute off: it gains the mean of the loss for half a minute."""
    history = TorqueHistory(np.repeat([0.5, 0.0], 30), np.zeros(60), slow)
    temperature = {SLOT: 20.0, MAGNETS: 20.0}
    found = copper_ripple(cooled(), HotCopper(COPPER, 20.0), history, 1.0, temperature)
    loss = 1.5 * cooled().wound.phase_resistance * slow.current_of(np.array(0.5), 20.0) ** 2
    assert found == pytest.approx(loss / 2 * 30.0 / (WEIGHTS.copper * 397.0), rel=0.05)


# ---- iron and magnets -----------------------------------------------------------------------------------------------


def plane():
    """Loss of a f + b T, known everywhere; the fastest column ends at half the torque."""
    torque, speed = np.meshgrid(np.linspace(-4.0, 4.0, 9), np.linspace(0.0, 400.0, 5), indexing="ij")
    stator = 0.1 * speed + np.abs(torque)
    stator[np.abs(torque) > 2.0] = np.where(speed == 400.0, np.nan, stator)[np.abs(torque) > 2.0]
    return PowerLosses(torque, speed, 0 * torque, stator, 0.1 * stator, 0.01 * stator, 0.2 * stator)


def test_a_loss_map_is_read_between_its_points_and_for_both_senses():
    found = MappedLoss(plane()).at(np.array([1.5, -1.5, 9.0]), np.array([50.0, -50.0, 100.0]))
    assert found.stator == pytest.approx([6.5, 6.5, 14.0])
    assert found.rotor == pytest.approx([0.65, 0.65, 1.4]) and found.magnets == pytest.approx([0.065, 0.065, 0.14])
    assert found.mean.stator == pytest.approx(9.0)


def test_beyond_the_largest_torque_of_a_speed_its_loss_goes_on():
    assert MappedLoss(plane()).at(np.array(3.5), np.array(400.0)).stator == pytest.approx(42.0)


def test_beyond_the_largest_speed_its_loss_counts():
    found = MappedLoss(plane())
    assert found.at(np.array(1.0), np.array(500.0)).stator == found.at(np.array(1.0), np.array(400.0)).stator


def test_without_loss_data_iron_and_magnets_lose_nothing_and_say_so():
    found = NoLossData().at(np.ones((3, 1)), np.ones(2))
    assert found.stator.shape == (3, 2) and not found.stator.any() and not found.magnets.any()
    assert MappedLoss.known and not NoLossData.known


def test_the_torque_curve_is_an_operation_of_its_own(slow):
    assert isinstance(slow, Operation) and slow.current[0] == 0.0 and slow.cold_torque[0] == 0.0
