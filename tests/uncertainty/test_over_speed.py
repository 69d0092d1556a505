"""What a machine gives over speed, as powers of its constants: against machines with other constants, solved again."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from electrical.braking import strongest_braking
from electrical.dq import DriveLimits, maximum_power, torque_speed_envelope
from electrical.flux_map_machine import FluxMapMachine
from electrical.synchronous_machine import SynchronousMachine
from tests.electrical.analytic_map import Saturating
from uncertainty.over_speed import OverSpeed

PLAIN = SynchronousMachine(5, 9.3e-3, 9.2e-5, 1.0e-4, 0.02)
LIMITS, FASTEST = DriveLimits(120.0, 27.7), 1500.0
LOADED = SimpleNamespace(loaded_flux=PLAIN.psi_m, loaded_inductance_d=PLAIN.inductance_d, loaded_inductance_q=1e-4)
OF_PLAIN = {"loaded_flux": "psi_m", "loaded_inductance_d": "inductance_d", "loaded_inductance_q": "inductance_q"}
LITTLE = 1e-3  # relative


def mapped(machine, resistance, points=15):
    i_d, i_q = np.linspace(-140.0, 40.0, points), np.linspace(-140.0, 140.0, 2 * points - 1)
    psi_d, psi_q = machine.flux_linkage(*np.meshgrid(i_d, i_q, indexing="ij"))
    return FluxMapMachine(5, i_d, i_q, psi_d, psi_q, resistance)


READ = {
    "largest_power": lambda machine: float(maximum_power(machine, LIMITS, FASTEST).power),
    "torque": lambda machine: float(torque_speed_envelope(machine, LIMITS, np.array(900.0)).torque),
    "braking": lambda machine: float(strongest_braking(machine, LIMITS, 900.0).torque),
}


@pytest.mark.parametrize("name", READ)
def test_powers_are_those_of_machines_with_other_constants(name):
    found = OverSpeed(mapped(PLAIN, PLAIN.resistance), LIMITS, FASTEST, LOADED)
    powers = found.largest_power() if name == "largest_power" else getattr(found, name)(900.0)
    for constant, value in powers.items():
        own = OF_PLAIN.get(constant, constant)
        more, less = (
            READ[name](replace(PLAIN, **{own: (1 + way * LITTLE) * getattr(PLAIN, own)})) for way in (1, -1)
        )
        assert value == pytest.approx(np.log(more / less) / (2 * LITTLE), abs=0.02)
    helps = name == "braking"  # what the resistance takes, the bus need not
    assert abs(powers["loaded_flux"]) > 0.05 and (powers["resistance"] > 0) == helps


def test_a_longer_saturating_machine_is_one_at_less_voltage():
    """All flux linkages and the resistance by s: P(s, V) = s P(1, V/s), whatever the map."""
    machine = mapped(SimpleNamespace(flux_linkage=_wound), 0.02)
    psi_d, psi_q = (float(psi) for psi in machine.flux_linkage(0.0, 120.0))
    weakened = float(machine.flux_linkage(-30.0, 120.0)[0])
    loaded = SimpleNamespace(
        loaded_flux=psi_d, loaded_inductance_d=(psi_d - weakened) / 30, loaded_inductance_q=psi_q / 120
    )
    powers = OverSpeed(machine, LIMITS, FASTEST, loaded).largest_power()
    more, less = (
        float(maximum_power(machine, replace(LIMITS, voltage_peak=27.7 * (1 + way * 0.01)), FASTEST).power)
        for way in (1, -1)
    )
    assert sum(powers.values()) == pytest.approx(1 - np.log(more / less) / np.log(1.01 / 0.99), abs=0.05)


def _wound(i_d, i_q):
    """Eight turns of a saturating machine of 53 mm."""
    return tuple(0.42 * psi for psi in Saturating().flux_linkage(8 * i_d, 8 * i_q))


def test_below_the_base_speed_the_voltage_does_not_matter():
    powers = OverSpeed(mapped(PLAIN, PLAIN.resistance), LIMITS, FASTEST, LOADED).torque(50.0)
    assert powers["resistance"] == pytest.approx(0.0, abs=1e-6)
    assert powers["loaded_flux"] == pytest.approx(1.0, abs=0.05)
