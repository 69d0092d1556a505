"""Designs of the search on the road: their actuators, the loss of their fits, what is best, what is refused."""

from dataclasses import replace
from math import pi
from types import SimpleNamespace

import numpy as np
import pytest

from control.force_loop import ForceLoop
from drivetrain.whole_design import RatedDesign, RoadMachine, Values, WholeDesign
from geometry.family import Combination
from losses.iron import FrequencyTerms
from report.judged import remarks, section, table
from tasks import InThisProcess
from tests.actuator.thesis import FORCE_LOOP, PEAK_TORQUE, prototype
from tests.vehicle.conftest import small_case
from vehicle.designed import DesignedActuator
from vehicle.energy import ride_energy
from vehicle.errors import VehicleError
from vehicle.judged_designs import DesignLoss, actuator_of_design, judged_stage
from vehicle.ride import Run, simulate

OWN = DesignedActuator(prototype(), FORCE_LOOP)
IDLE = FrequencyTerms(0.02, 1e-4, 1e-3)
MACHINE = RoadMachine(PEAK_TORQUE, 24.7, 5, IDLE)


def design(mass, inertia, ratio=OWN.actuator.ratio.nominal):
    values = Values((mass, inertia, 2e4, 3.0), (0.0,) * 6)
    return RatedDesign(WholeDesign(Combination(12, 10), 40e-3, 30e-3, ratio, 0.115), values)


@pytest.fixture(scope="module")
def found():
    solved = [SimpleNamespace(model=design(3.0, 6.16)), SimpleNamespace(model=design(2.5, 12.0))]
    search = SimpleNamespace(solved=solved, front=(design(3.5, 6.16), design(2.0, 6.16, ratio=1e-3)),
                             machines=(MACHINE, MACHINE, MACHINE, replace(MACHINE, copper=50.0)))  # fmt: skip
    return judged_stage(search, small_case(bumps=()), OWN, InThisProcess())


def test_a_design_like_the_own_rides_like_it(found):
    """Same ratio, mass and loss law: what the simulation of the own actuator gives."""
    one, case = found.designs[0], small_case(bumps=())
    own = replace(OWN.actuator, drive=replace(OWN.actuator.drive, loss=DesignLoss(MACHINE)))
    road = replace(case.road[0], time_step=5e-4)
    energies = [ride_energy(h) for h in simulate([Run(case.vehicle, c, road, own, FORCE_LOOP) for c in case.damping])]
    assert one.recovered == pytest.approx(max(e.battery.active for e in energies), rel=1e-9)
    assert one.comfort == pytest.approx(min(e.comfort for e in energies), rel=1e-9)


def test_more_inertia_costs_power_and_not_comfort(found):
    """Fig. 4.54: the force loop hides the mechanics from the vehicle."""
    light, heavy = found.designs[:2]
    assert heavy.recovered < light.recovered - 0.3
    assert heavy.comfort == pytest.approx(light.comfort, rel=0.03)


def test_best_are_those_that_none_betters(found):
    """The third is the first with more mass."""
    assert found.designs[2] not in found.best and found.designs[0] in found.best
    assert [one.number for one in found.designs] == [1, 2, None, None]


def test_a_machine_of_the_fits_loses_what_they_say():
    loss = DesignLoss(MACHINE).at(np.array([0.5]), np.array([-200.0]))
    f = 5 * 200.0 / (2 * pi)
    assert loss == pytest.approx(24.7 * 0.25 + 0.02 * f + 1e-4 * f**2 + 1e-3 * f**1.5)
    made = actuator_of_design(OWN.actuator, design(2.0, 7.0, ratio=2e-3), MACHINE)
    assert made.ratio.nominal == 2e-3 and made.equivalent_mass == 7.0
    assert float(made.drive.limit.braking_at(10.0)) == PEAK_TORQUE


def test_what_people_read(found):
    assert list(table(found.designs).number) == ["1", "2", "front", "front"]
    assert any("recovered power by" in line for line in remarks(found))
    assert "4 designs" in section(found, b"").content[0]


def test_where_no_design_can_be_driven_the_reason_is_said():
    loop = ForceLoop(200.0, 1e3, 0.0, 0.0)
    search = SimpleNamespace(solved=[], front=(design(3.0, 6.16),), machines=(MACHINE,))
    with pytest.raises(VehicleError, match="no design of the search can be driven: force loop: unstable"):
        judged_stage(search, small_case(bumps=()), DesignedActuator(prototype(), loop), InThisProcess())
