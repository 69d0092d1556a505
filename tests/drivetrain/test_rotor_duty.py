"""The rotor of a wound machine as the checks of its strength see it."""

from math import pi

import numpy as np
import pytest

from drivetrain.masses import PartMaterials
from drivetrain.outcome import OutcomeInputs, active_masses, machine_envelope
from drivetrain.requirements import Requirements, Transmission
from drivetrain.rotor_duty import rotor_duty
from electrical.winding_stage import WindingOutcome
from electrical.wound_machine import WoundMachine
from gearbox.layout import Housing
from tests.electrical.wires import series_star, wire_of
from tests.magnetostatics.reference_machine import reference_machine
from thermal.stage import Duty

WOUND = WoundMachine(reference_machine(), 4, 1, series_star(12, 13, wire_of(0.2e-6)), 45e-3)
MATERIALS = PartMaterials(7650.0, 7500.0, 8890.0, 7800.0, 0.95)
ASKED = Requirements(40e3, 300.0, 0.1, 30.0, 3.4, 2600.0, 1.6, 4250.0, 1340.0, 3.2)


def test_the_duty_of_a_rotor():
    rest = {name: None for name in WindingOutcome.__dataclass_fields__} | {"wound": WOUND, "peak_torque": 6.3}
    blank = {name: 0.0 for name in OutcomeInputs.__dataclass_fields__}
    inputs = OutcomeInputs(**blank | {"materials": MATERIALS, "housing": Housing(0.0, 0.0, 14e-3, 0.0)})
    asked = Duty(np.array([100.0, -300.0]), np.array([0.1, 0.2]), 0.01)
    duty = rotor_duty(WindingOutcome(**rest), ASKED, Transmission(2.0e-3, 2.1e-3), asked, inputs)
    assert duty.torque == pytest.approx([0.21, -0.63]) and duty.speed == pytest.approx([50.0, 100.0])
    assert duty.is_recorded and duty.step == 0.01
    assert duty.speed_max == pytest.approx(1700.0) and duty.speed_rms == pytest.approx(50.0)
    assert duty.bearing_span == pytest.approx(45e-3 + 2 * machine_envelope(WOUND).end_winding_length + 14e-3)
    m = WOUND.machine
    magnets = 7500 * pi * (m.rotor_outer_radius**2 - m.rotor_core_radius**2)
    sheets = 0.95 * 7650 * pi * (m.rotor_core_radius**2 - m.shaft_radius**2)
    shaft = 7800 * pi * m.shaft_radius**2
    assert duty.mass == pytest.approx((magnets + sheets + shaft) * 45e-3)
    assert (duty.peak_torque, duty.stacking, duty.active_length) == (6.3, 0.95, 45e-3)
    assert duty.mass < active_masses(WOUND, MATERIALS).total, "the stator does not bend the shaft"
