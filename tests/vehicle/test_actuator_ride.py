"""The quarter car of chapter 4 with the prototype: Tables 4.6-4.14, step size, closure, controllers, refusals."""

from dataclasses import replace

import numpy as np
import pytest

from actuator.drive import DcLoad, DiodeBridge, MappedMotor
from actuator.model import IDEAL, Actuator
from actuator.parts import CompliantMount, GearEfficiency, MechanicalLoss, Ratio
from control.errors import ControlError
from control.force_loop import ForceLoop
from tests.actuator.thesis import FORCE_LOOP, RATIO, prototype, quasi_ideal
from tests.vehicle.thesis import (
    COMFORT,
    CRUISE_SPEED,
    HANDLING,
    QUARTER_CAR_ROAD_DURATION,
    TRADE_OFF,
    digressive_minimum,
    quarter_car,
    quarter_car_damping,
)
from vehicle.commands import Controller, Feedback
from vehicle.damping import linear_damper
from vehicle.energy import power_of, ride_energy, scatter
from vehicle.energy_stage import OPEN, QUASI_IDEAL, REAL
from vehicle.errors import VehicleError
from vehicle.indices import rms
from vehicle.printed_energy import printed_energy
from vehicle.quarter_car import lqr, spring_negation
from vehicle.ride import Run, Scenario, simulate, simulate_and_keep
from vehicle.road import IsoRoad, roughness_of_class
from vehicle.spectral import indices_from_rest, mean_power_theorem, ride_of

CAR, SEEDS = quarter_car(), range(6)
MAXIMUM, MINIMUM = quarter_car_damping()
COMMANDS = {
    "maximum": MAXIMUM,
    "minimum": MINIMUM,
    "LQR trade-off": lqr(CAR, TRADE_OFF),
    "LQR handling": lqr(CAR, HANDLING),
}
PRINTED = {(one.command, one.actuator): one for one in printed_energy()}
REALISTIC = {key: one for key, one in PRINTED.items() if key[1] != QUASI_IDEAL}
FINE, COARSE = 1e-3, 1e-2  # s, for which the road's noise is held; the thesis prints none, its numbers look like 10 ms


def road(seed, sample_time=COARSE, duration=QUARTER_CAR_ROAD_DURATION, step=1e-3):
    noise = IsoRoad(roughness_of_class("B"), seed, sample_time)
    return Scenario("road", CRUISE_SPEED, duration, noise, time_step=step)


def driven(command, actuator, loop, sample_time):
    """Means and deviations over the seeds."""
    runs = [Run(CAR, command, road(seed, sample_time), actuator, loop) for seed in SEEDS]
    return scatter(simulate_and_keep(ride_energy, runs))


@pytest.fixture(scope="module")
def quasi():
    return {name: driven(command, quasi_ideal(), None, FINE) for name, command in COMMANDS.items()}


@pytest.fixture(scope="module")
def real():
    found = {(name, REAL): driven(command, prototype(), FORCE_LOOP, COARSE) for name, command in COMMANDS.items()}
    return found | {("minimum", OPEN): driven(digressive_minimum(), prototype(), None, COARSE)}


# ---- tables ---------------------------------------------------------------------------------------------------------


@pytest.mark.reference
@pytest.mark.parametrize("name", COMMANDS)
def test_quasi_ideal_actuator_against_tables_4_6_to_4_9(quasi, name):
    """The loss law is fitted to these four losses; the powers are predictions."""
    printed, found = PRINTED[name, QUASI_IDEAL], quasi[name]
    tolerance = 8.0 if name == "LQR trade-off" else 1.5
    assert found["battery.active"].mean == pytest.approx(printed.electrical, abs=tolerance)
    assert found["machine_loss"].mean == pytest.approx(printed.machine_loss, rel=0.12)
    if name in ("maximum", "minimum"):  # its map has a loss where nothing turns, the law here has none
        assert printed.regenerating < found["regenerating"].mean < 1.0
    theorem = mean_power_theorem(CAR.tyre_stiffness, road(0).road, CRUISE_SPEED)
    assert found["shaft.active"].mean == pytest.approx(theorem, rel=0.08)


# P_el of the trade-off differs by 7 to 11 W from road to road, so that six of them cannot tell 2 W; what does is below.
ELECTRICAL = {"maximum": 6.0, "minimum": 2.0, "LQR trade-off": 8.0, "LQR handling": 2.0}


@pytest.mark.reference
@pytest.mark.parametrize("name", REALISTIC)
def test_realistic_actuator_against_tables_4_10_to_4_14(real, name):
    printed = PRINTED[name]
    found = {key: value.mean for key, value in real[name].items()}
    assert found["battery.active"] == pytest.approx(printed.electrical, abs=ELECTRICAL[name[0]])
    assert found["machine_loss"] == pytest.approx(printed.machine_loss, rel=0.25)
    assert found["mechanical_loss"] == pytest.approx(printed.mechanical_loss, rel=0.25)
    assert found["machine.factor"] == pytest.approx(printed.machine_power_factor, abs=0.1)
    assert found["shaft_duty.active"] == pytest.approx(printed.shaft_active, abs=0.04)
    assert found["machine_duty.active"] == pytest.approx(printed.machine_active, abs=0.05)
    assert found["regenerating"] == pytest.approx(printed.regenerating, abs=0.05)
    assert found["comfort"] == pytest.approx(printed.comfort, rel=0.10)
    assert found["road_holding"] == pytest.approx(printed.road_holding, rel=0.10)
    assert (found["elastic"], found["inertial"]) == pytest.approx((printed.elastic, printed.inertial), rel=0.4)


def expected_loss(ride):
    """Of the machine over 15 s from rest in the mean of all roads, the loss law on the covariance [W]."""
    found = indices_from_rest(ride, QUARTER_CAR_ROAD_DURATION)
    return found, 24.7 * (found.force * RATIO) ** 2 + 1.5e-4 * (found.velocity / RATIO) ** 2


@pytest.mark.reference
def test_trade_off_against_table_4_12_within_2_watts_of_its_expectation(real):
    """Real less quasi-ideal on one road scatters by 1.5 W only; the quasi-ideal expectation is known by covariance.

    Against Table 4.8 the expectation is 6 W off, half of the deviation from road to road: what one road can say.
    """
    name, ride = "LQR trade-off", ride_of(CAR, COMMANDS["LQR trade-off"], road(0).road, CRUISE_SPEED)
    found, loss = expected_loss(ride)
    quasi = found.mean_power - loss
    assert quasi == pytest.approx(PRINTED[name, QUASI_IDEAL].electrical, abs=8.0)
    ideal = driven(COMMANDS[name], quasi_ideal(), None, COARSE)["battery.active"].mean
    apart = real[name, REAL]["battery.active"].mean - ideal
    assert quasi + apart == pytest.approx(PRINTED[name, REAL].electrical, abs=2.0)


# Mean over six roads of P_el, loss of the machine, mechanical loss, S and power factor at its shaft, and the deviation
# of P_el from road to road, with the noise held for 10 ms, of an independent implementation with other contacts.
INDEPENDENT = {
    ("maximum", REAL): (1.4, 9.1, 4.0, 42.0, 0.25, 0.9),
    ("minimum", REAL): (9.1, 2.95, 3.0, 22.6, 0.53, 0.4),
    ("LQR trade-off", REAL): (-16.4, 22.0, 9.2, 172.0, 0.033, 4.0),
    ("LQR handling", REAL): (9.9, 2.7, 2.4, 21.5, 0.59, 0.5),
    ("minimum", OPEN): (7.3, 2.25, 5.4, 19.8, 0.48, 0.6),
}


@pytest.mark.reference
@pytest.mark.parametrize("name", INDEPENDENT)
def test_realistic_actuator_against_an_independent_implementation(real, name):
    """Losses to 12 %, apparent power to 10 %, power factor to 0.05, P_el to three deviations of a mean of six roads."""
    electrical, machine, mechanical, apparent, factor, deviation = INDEPENDENT[name]
    found = {key: value.mean for key, value in real[name].items()}
    assert found["battery.active"] == pytest.approx(electrical, abs=3 * deviation * (2 / 6) ** 0.5)
    assert (found["machine_loss"], found["mechanical_loss"]) == pytest.approx((machine, mechanical), rel=0.12)
    assert found["machine.apparent"] == pytest.approx(apparent, rel=0.10)
    assert found["machine.factor"] == pytest.approx(factor, abs=0.05)


@pytest.mark.physics
def test_balance_closes_in_every_table(quasi, real):
    for found in (*quasi.values(), *real.values()):
        assert abs(found["closure"].mean) < 0.01 and found["closure"].deviation < 0.01


@pytest.mark.reference
def test_force_loop_hides_the_mechanics_from_the_vehicle(quasi, real):
    """Fig. 4.54; without the loop the power factor at the suspension falls, 0.83 printed."""
    for name in COMMANDS:
        ideal = driven(COMMANDS[name], quasi_ideal(), None, COARSE) if name == "minimum" else quasi[name]
        assert real[name, REAL]["comfort"].mean == pytest.approx(ideal["comfort"].mean, rel=0.05)
    assert real["minimum", REAL]["shaft.factor"].mean > 0.98
    assert real["minimum", OPEN]["shaft.factor"].mean == pytest.approx(0.83, abs=0.05)


@pytest.mark.reference
def test_comfort_setting_lifts_the_wheel():
    """Section 4.3.2: the linear optimum leaves the road in the non-linear model, from 10 s on there; here in some runs.

    The slowest pole of the loop is -0.0064 /s: what a run of 15 s comes to is a matter of its seed.
    """
    found = simulate([Run(CAR, lqr(CAR, COMFORT), road(seed, FINE), quasi_ideal()) for seed in SEEDS])
    lifted = [one.time[one.tyre_loads[0] == 0] for one in found]
    assert 1 <= sum(times.size > 0 for times in lifted) <= 5
    assert min(times[0] for times in lifted if times.size) > 2.0
    assert all(0.25 < ride_energy(one).road_holding < 1.0 for one in found)


# ---- numbers that must hold whatever the tables say -----------------------------------------------------------------


@pytest.mark.physics
@pytest.mark.parametrize("name", ["maximum", "LQR handling"])
def test_a_finer_step_changes_nothing(name):
    """The step that the equations choose, up to 0.25 ms here, against a quarter of it."""
    runs = [Run(CAR, COMMANDS[name], road(2, FINE, 5.0, step), prototype(), FORCE_LOOP) for step in (1e-3, 6.25e-5)]
    coarse, fine = simulate(runs)
    missed = coarse.suspension_force - fine.suspension_force[::16]
    assert rms(missed) < 2e-3 * rms(fine.suspension_force)
    works = [[one.inside.motor[-1], one.inside.mount[-1], one.inside.friction[-1]] for one in (coarse, fine)]
    assert works[0] == pytest.approx(works[1], rel=2e-3)


@pytest.mark.physics
def test_a_stiff_mount_is_a_rigid_one():
    """With a hundred times the stiffness the actuator rides as one with its mass, friction and gears fixed to it."""
    gears, loss = GearEfficiency(0.9, 0.85), MechanicalLoss(viscous=100.0, coulomb=30.0, breakaway_speed=0.05)
    ratio = Ratio((-0.05, 0.05), (1.1e-3, 1.5e-3))
    stiff = Actuator(MappedMotor(), ratio, 6.0, CompliantMount(1e8, 4e4), loss, gears)
    runs = [Run(CAR, MINIMUM, road(1, COARSE, 2.0), one) for one in (stiff, replace(stiff, mount=IDEAL.mount))]
    soft, rigid = simulate(runs)
    assert soft.stroke == pytest.approx(rigid.stroke, abs=0.02 * np.abs(rigid.stroke).max())
    lost = [[one.inside.gears[-1], one.inside.friction[-1], one.inside.motor[-1]] for one in (soft, rigid)]
    assert lost[0] == pytest.approx(lost[1], rel=0.03)
    assert rigid.energy.error < 1e-3 and soft.energy.error < 1e-3


@pytest.mark.physics
def test_rms_of_harmonics_is_that_of_the_signal():
    """Equation 4.31 by the Fourier series of a force and a velocity that are not sines."""
    history = simulate([Run(CAR, MINIMUM, road(0, duration=4.0), prototype(), FORCE_LOOP)])[0]
    force, velocity = history.suspension_force[:-1], history.velocity[:-1]

    def distorted(signal):
        amplitude = 2 * np.abs(np.fft.rfft(signal)) / len(signal)
        amplitude[[0, -1]] /= np.sqrt(2), 2  # the mean has no crest, and of the last harmonic both halves are one
        return np.sqrt(np.sum(amplitude**2 / 2))

    assert power_of(force, velocity).apparent == pytest.approx(distorted(force) * distorted(velocity), rel=1e-3)


@pytest.mark.physics
def test_quadrants_and_powers_of_a_shifted_sine():
    """Force ahead of the velocity by 60 degrees: half of S is active, a third of the time is."""
    phase = np.linspace(0.0, 2 * np.pi, 3600, endpoint=False)
    found = power_of(10 * np.sin(phase + np.pi / 3), 2 * np.sin(phase))
    assert found.apparent == pytest.approx(10.0) and found.factor == pytest.approx(0.5)
    assert found.reactive == pytest.approx(10 * np.sin(np.pi / 3))


@pytest.mark.physics
def test_a_controller_of_ones_own_is_the_law_that_it_samples():
    law = COMMANDS["LQR handling"]

    def force(felt):
        return float(np.dot(law.row, (felt.stroke, felt.wheel_height, felt.body_velocity, felt.wheel_velocity)))

    scenario = road(3, COARSE, 2.0, step=5e-4)
    sampled, held = (Controller(force, sample_time) for sample_time in (5e-4, 4e-3))
    own, late, exact = simulate([Run(CAR, one, scenario, prototype(), FORCE_LOOP) for one in (sampled, held, law)])
    peak = np.abs(exact.stroke).max()
    assert np.abs(own.stroke - exact.stroke).max() < 0.02 * peak < np.abs(late.stroke - exact.stroke).max()


@pytest.mark.physics
def test_diode_bridge_damps_without_a_command():
    """A bridge into a resistance: the wheel gets T(omega) / tau, and the load what is not lost."""
    bridge = DiodeBridge(49.3e-3, 68.3e-3, 0.0, 5, DcLoad(0.1), diode_drop=0.4, fastest=2000.0)
    run = Run(CAR, linear_damper(1.0, "none"), road(0, COARSE, 5.0), Actuator(bridge, prototype().ratio))
    history = simulate([run])[0]
    expected = np.sign(history.velocity) * bridge.torque(history.velocity / RATIO) / RATIO
    assert history.suspension_force == pytest.approx(expected, abs=0.02 * np.abs(expected).max())
    energy = ride_energy(history)
    assert 0 < energy.battery.active < energy.shaft.active and energy.machine_duty.active == 0


# ---- refusals -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("run", "error", "sentence"),
    [
        (lambda: Run(CAR, MINIMUM, road(0), quasi_ideal(), FORCE_LOOP), VehicleError, "a force loop needs an actuator"),
        (
            lambda: Run(CAR, MINIMUM, road(0), prototype(), ForceLoop(200.0, 1e3, 0.0, 0.0)),
            ControlError,
            "force loop: unstable where the mount has .* it swings at",
        ),
        (
            lambda: Run(CAR, spring_negation(10.0, 1.2 * CAR.spring_stiffness), road(0)),
            VehicleError,
            "control law 'state feedback': unstable, the motion grows with",
        ),
        (
            lambda: Run(CAR, Feedback((0.0, 0.0, -500.0, 500.0), "mine"), road(0)),
            VehicleError,
            "control law 'mine': unstable",
        ),
        (
            lambda: Run(CAR, Controller(lambda felt: 0.0, 1.5e-3), road(0)),
            VehicleError,
            "must be a multiple of the scenario's step of 0.001 s, found 0.0015 s",
        ),
    ],
)
def test_what_cannot_be_driven_is_refused(run, error, sentence):
    with pytest.raises(error, match=sentence):
        simulate([run()])
