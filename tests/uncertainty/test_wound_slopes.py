"""Closed formulas of the wound machine against the machine built again, on a flux map in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from drivetrain.masses import PartMaterials
from drivetrain.outcome import active_masses
from electrical.dq import corner_speed, mtpa_currents
from electrical.winding_stage import winding_stage
from losses.copper import copper_loss
from tests.electrical.analytic_map import DEMAND, GOOD, INPUTS, MATCHED, Saturating, flux_map
from uncertainty.deviations import MagnetRemanence, Stacking, StackLength, ToothWidth, WireDiameter
from uncertainty.wound_slopes import (
    COGGING,
    FULL,
    NO_LOAD,
    NOMINAL,
    PARTS,
    QUADRATURE,
    operated_machine,
    relative_slopes,
    values_of,
)

MAP = flux_map(Saturating())
MATERIALS = PartMaterials(7650.0, 7500.0, 8890.0, 7800.0, 0.95)
WINDING = winding_stage(MAP, MATCHED, DEMAND, INPUTS, GOOD)
OPERATED = operated_machine(MAP, WINDING, INPUTS)
NOTHING = {NO_LOAD: np.zeros(3), NOMINAL: np.zeros(5), FULL: np.zeros(4), QUADRATURE: np.zeros(3), COGGING: np.zeros(1)}
LITTLE = 1e-3  # relative


def slopes(deviation, **field):
    return relative_slopes(deviation, NOTHING | field, OPERATED, MATERIALS)


def built_again(deviation, change):
    """Resistance [ohm], torque at full current [Nm], base speed [rad/s] and masses [kg] of the machine with it."""
    wound = deviation.wound(OPERATED.wound, change)
    machine, masses = wound.on_map(MAP.data), active_masses(wound, deviation.parts(MATERIALS, change))
    return np.array(
        [
            wound.phase_resistance,
            float(machine.torque(*OPERATED.full)),
            float(corner_speed(machine, OPERATED.limits, *OPERATED.full)),
            *(getattr(masses, part) for part in PARTS.values()),
        ]
    )


@pytest.mark.parametrize(
    "deviation, change", ((StackLength(1.0), 1e-5), (WireDiameter(1.0), 1e-4), (Stacking(1.0), 1e-4))
)
def test_length_wire_and_stacking_are_those_of_the_machine_built_again(deviation, change):
    more, less = built_again(deviation, change), built_again(deviation, -change)
    expected = np.log(more / less) / (2 * change)
    found = slopes(deviation)
    got = [found.resistance, found.peak_torque, found.base_speed, *(getattr(found, name) for name in PARTS)]
    assert got == pytest.approx(expected.tolist(), rel=1e-3, abs=1e-9) and np.any(expected)


def test_a_wider_tooth_has_a_longer_end_turn():
    found = slopes(ToothWidth(1.0))
    wound = OPERATED.wound
    longer = replace(wound, machine=replace(wound.machine, tooth_width=wound.machine.tooth_width + 1e-5))
    assert found.resistance == pytest.approx((longer.phase_resistance / wound.phase_resistance - 1) / 1e-5, rel=1e-2)
    assert found.resistance > 0


def test_the_copper_loss_is_that_of_the_same_torque():
    """A machine whose torque is a per mille less at every current takes the current that makes up for it."""
    machine, torque = OPERATED.machine, float(OPERATED.machine.torque(*OPERATED.nominal))
    weak = dict(NOTHING, **{NOMINAL: np.array([-1.0, 0.0, 0.0, 0.0, 0.0])})
    found = relative_slopes(MagnetRemanence(1.0), weak, OPERATED, MATERIALS)

    def missing(current):
        return (1 - LITTLE) * float(machine.torque(*mtpa_currents(machine, current))) - torque

    now = float(np.hypot(*OPERATED.nominal))
    current = brentq(missing, now, 1.1 * now)
    resistance = OPERATED.wound.phase_resistance
    loss = copper_loss(resistance, *mtpa_currents(machine, current)) / copper_loss(resistance, *OPERATED.nominal)
    assert found.copper_loss * LITTLE == pytest.approx(float(loss) - 1, rel=0.01)


def test_the_base_speed_falls_with_flux_and_its_error_adds_up():
    both = OPERATED.base_speed_slope(1.0, 1.0, 0.0)
    assert -1.2 < both < -0.8, "without the resistance it would be minus one"
    assert OPERATED.base_speed_slope(0.0, 0.0, 0.0) == 0.0
    assert OPERATED.base_speed_error(0.01, 0.02) >= 0.01 * abs(both)
    assert OPERATED.base_speed_error(-0.01, 0.02) == pytest.approx(OPERATED.base_speed_error(0.01, 0.02))


def test_values_are_those_of_the_stage():
    values = values_of(OPERATED, WINDING, 20.0, 0.06, None, MATERIALS)
    assert values.peak_torque == pytest.approx(WINDING.peak_torque)
    assert values.base_speed == pytest.approx(WINDING.chosen.base_speed, rel=1e-6)
    assert values.magnet_flux * 1.5 * 5 == pytest.approx(WINDING.chosen.no_load_torque_constant, rel=1e-6)
    assert 0.5 < OPERATED.elasticity < 1.0, "saturation"


def test_without_loss_data_the_iron_loss_is_not_known():
    found = slopes(StackLength(1.0), **{NOMINAL: np.zeros(4)})
    assert np.isnan(found.iron_loss) and found.copper_loss != 0
    assert slopes(StackLength(1.0)).iron_loss == pytest.approx(1 / OPERATED.wound.active_length)
