"""The energy of a ride from the stage to people: cases, loop and traces, tables, section and figures."""

import json
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from actuator.drive import MappedLoss, TorqueLimit
from actuator.errors import ActuatorError
from figures.energy import force_loop, powers_over_time, where_the_power_goes, working_points
from figures.quarter_car import beside_the_thesis, car_inputs, comfort_setting, lent_powers, vehicle_over_time
from pipeline.codec import decoded, encoded
from report import quarter_car as quarter_car_report
from report.energy import duty_table, files, loop_table, power_table, remarks, section
from tasks import InThisProcess
from tests.actuator.thesis import FORCE_LOOP, prototype
from tests.vehicle.thesis import CRUISE_SPEED, quarter_car, quarter_car_damping
from vehicle.demands import RideCase
from vehicle.designed import DesignedActuator
from vehicle.energy_stage import OPEN, QUASI_IDEAL, REAL, energy_stage
from vehicle.indices import rms
from vehicle.printed_car import printed_road
from vehicle.printed_energy import printed_energy
from vehicle.quarter_car_stage import WITHOUT_LOOP, QuarterCarRides, without_loop
from vehicle.ride import Scenario
from vehicle.road import IsoRoad, roughness_of_class
from vehicle.shaken import AS_STATED, MORE_FRICTION, PRINTED, shaken


@pytest.fixture(scope="module")
def case():
    roads = [
        Scenario("road", CRUISE_SPEED, 8.5, IsoRoad(roughness_of_class("B"), seed, sample_time=1e-2)) for seed in (0, 1)
    ]
    return RideCase(quarter_car(), quarter_car_damping(), tuple(roads), (), 0.0)


@pytest.fixture(scope="module")
def found(case):
    return energy_stage(case, DesignedActuator(prototype(), FORCE_LOOP), None, InThisProcess())


def test_every_command_with_every_actuator(found):
    names = [(one.command, one.actuator) for one in found.cases]
    curves = [(name, kind) for name in ("maximum", "minimum") for kind in (QUASI_IDEAL, REAL, OPEN)]
    laws = [(name, kind) for name in ("LQR trade-off", "LQR handling") for kind in (QUASI_IDEAL, REAL)]
    assert names == curves + laws and all(len(one.energies) == 2 for one in found.cases)


@pytest.mark.physics
def test_every_balance_closes_to_a_per_cent(found):
    assert max(abs(one.closure) for case in found.cases for one in case.energies) < 0.01


@pytest.mark.reference
def test_maximum_damping_swings_without_its_force_loop(found):
    """Text to Fig. 4.53: with the maximum damping or the LQR settings the vehicle tends to be unstable."""
    assert [one.command for one in found.cases if one.swings] == ["maximum"]
    assert any("swings by itself with: maximum (real, no force loop)" in line for line in remarks(found))


def test_what_is_kept_is_what_was_found(found):
    datasets = []
    again = decoded(json.loads(json.dumps(encoded(found, datasets))), datasets)
    assert again.cases == found.cases and again.loop == found.loop and again.traces.equals(found.traces)


def test_tables_and_section(found, case):
    assert power_table(found).shape[0] == duty_table(found).shape[0] == len(found.cases)
    assert "no PID has them" in loop_table(found).iloc[-1].to_list()
    titles = [getattr(part, "caption", "") for part in section(found, case).content]
    assert any("prototype of the thesis" in title for title in titles)
    bike = replace(case, vehicle=object())
    assert len(section(found, bike).content) == len(section(found, case).content) - 1
    assert {one.name for one in files(found)} >= {"energy.csv", "figures/energy_powers.png"}


def test_figures_are_readable(found, assert_readable):
    for draw in (powers_over_time, working_points, where_the_power_goes, force_loop):
        assert_readable(draw(found))


@pytest.fixture(scope="module")
def rides(found):
    time = np.linspace(0.0, 15.0, 50)
    data = {name: ("time", np.sin(time)) for name in ("felt", "tyre_load", "force")}
    own = DesignedActuator(prototype(), FORCE_LOOP)
    return QuarterCarRides(found, xr.Dataset(data, {"time": time}), without_loop(own), shaken(own))


def test_every_printed_number_stands_beside_ours(rides):
    """19 rows of nine printed columns; where nothing is printed there is nothing behind the bar."""
    every = quarter_car_report.every_table(rides)
    assert len(every) == 9 * 19 and set(every.table) == {f"4.{k}" for k in range(6, 15)}
    real = quarter_car_report.beside(rides, REAL).set_index("quantity")
    assert real.loc["electrical power / W", "LQR handling"].endswith("| 9.8")
    quasi = quarter_car_report.beside(rides, QUASI_IDEAL).set_index("quantity")
    assert "|" not in quasi.loc["power factor, machine shaft", "maximum"]
    captions = [getattr(part, "caption", "") for part in quarter_car_report.section(rides).content]
    assert any("lifts from" in one for one in captions)
    table = quarter_car_report.shaken_table(rides.shaken).set_index("quantity")
    assert table.loc["electrical power / W", MORE_FRICTION].endswith("| -9")


@pytest.mark.reference
def test_a_harmonic_force_on_the_body_as_in_the_text_to_figures_4_35_to_4_39(rides):
    """The amplified friction must be overcome by the machine: its power changes its sign, that of the suspension not.

    The damper curve of Fig. 4.21 bends, the straight line here does not, so that the amplified case moves less.
    """
    stated, more = ({case.command: case.energies[0] for case in rides.shaken.cases}[k] for k in PRINTED)
    for one, printed in zip((stated, more), PRINTED.values(), strict=True):
        assert one.shaft.active == pytest.approx(printed.mechanical, abs=0.5)
        assert 1 - one.shaft_duty.active == pytest.approx(printed.shaft_passive, abs=0.01)
        assert abs(one.closure) < 0.01
    assert stated.battery.active == pytest.approx(PRINTED[AS_STATED].electrical, abs=0.5)
    assert 1 - stated.machine_duty.active == pytest.approx(PRINTED[AS_STATED].machine_passive, abs=0.03)
    assert (stated.shaft.factor, stated.machine.factor) == pytest.approx((1.0, 0.96), abs=0.05)
    assert more.battery.active < -4.0 and more.machine_duty.active > 0.75


def test_figures_beside_the_thesis_are_readable(rides, assert_readable):
    for draw in (vehicle_over_time, lambda one: beside_the_thesis(one, printed_energy())):
        assert_readable(draw(rides.energy))
    assert_readable(comfort_setting(rides))
    for draw in (powers_over_time, working_points, lent_powers):
        assert_readable(draw(rides.shaken))
    assert_readable(powers_over_time(rides.energy, QUASI_IDEAL))
    assert_readable(car_inputs(quarter_car_damping(), printed_road(0)))


@pytest.mark.reference
def test_without_its_loop_the_force_misses_what_is_wanted(rides):
    """Fig. 4.52: tracking is poor; with the loop the error is a fraction of it."""
    alone, real = rides.alone.traces.sel(actuator=REAL), rides.energy.traces.sel(actuator=REAL)
    errors = [rms((one.force - one.wanted).values) / rms(one.wanted.values) for one in (
        alone.sel(command=WITHOUT_LOOP), real.sel(command="minimum"))]  # fmt: skip
    assert errors[0] > 0.3 and errors[1] < errors[0] / 3


@pytest.mark.physics
def test_spring_and_mass_only_lend_power(found):
    """Their mean is what they keep at the end, nothing beside what goes through them."""
    real = found.traces.sel(actuator=REAL)
    for name in ("elastic", "inertial"):
        assert (np.abs(real[name].mean("time")) < 0.1 * np.abs(real[name]).mean("time")).all()
    assert not np.abs(found.traces.elastic.sel(actuator=QUASI_IDEAL)).max()


def test_printed_numbers_balance_as_the_thesis_says():
    """Within the rounding, 0.1 W each: P_mech - losses = P_el."""
    for one in printed_energy():
        lost = one.machine_loss + (one.mechanical_loss or 0.0)
        assert one.mechanical - lost == pytest.approx(one.electrical, abs=0.21)


@pytest.mark.physics
def test_loss_map_is_read_in_both_senses_and_held_beyond_its_reach():
    torque, speed = np.linspace(-2.0, 2.0, 41), np.linspace(0.0, 100.0, 11)
    power = 3 * torque[:, None] ** 2 + 0.5 * torque[:, None] + 1e-3 * speed**2
    power[np.abs(torque) > 1.5, 5:] = np.nan
    law = MappedLoss(torque, speed, power)
    found = law.at(np.array([1.0, -1.0, 1.0, -1.0]), np.array([30.0, 30.0, -30.0, -30.0]))
    motoring, generating = 3 + 0.5 + 0.9, 3 - 0.5 + 0.9
    assert found == pytest.approx([generating, motoring, motoring, generating])  # T omega > 0 generates
    assert law.at(np.array([1.9]), np.array([80.0])) == pytest.approx(law.at(np.array([1.5]), np.array([80.0])))
    with pytest.raises(ActuatorError, match="turns with up to 120 rad/s, the map ends at 100 rad/s"):
        law.at(np.array([0.0]), np.array([120.0]))
    with pytest.raises(ActuatorError, match="expected losses over torque and speed"):
        MappedLoss(torque, speed[1:], power)


def test_limit_is_a_table():
    limit = TorqueLimit((0.0, 10.0), (2.0, 1.0), (3.0, 2.0))
    assert limit.driving_at(5.0) == 1.5 and limit.braking_at(-5.0) == 2.5 and limit.braking_at(11.0) == 0.0
