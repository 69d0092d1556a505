"""The dq machine against closed forms, an independent solution and measured data."""

from dataclasses import replace
from math import pi, sqrt
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from effects.damper_design import Damper
from effects.dq_design import DqMachine
from effects.electrical.copper_drift import CopperDrift
from effects.electrical.cross_saturation import CrossSaturation
from effects.electrical.drive_delay import DriveDelay
from effects.electrical.iron_loss_resistance import IronLossResistance
from effects.electrical.quadrature_saturation import QuadratureSaturation
from effects.electrical.remanence_drift import RemanenceDrift
from effects.mechanical.friction_torque import FrictionTorque
from electrical.dq import DriveLimits, operating_map
from electrical.synchronous_machine import SynchronousMachine
from tests.workbench.likelihood import tables
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.models.damper.model import BASE as DAMPER
from workbench.models.dq.control import least_current
from workbench.models.dq.model import BASE
from workbench.models.dq.operation import Operation, newton
from workbench.models.model import Model

MEASUREMENTS = Path(__file__).resolve().parents[3] / "measurements"
PLAIN = DqMachine(4, 0.1, 3e-3, 4e-3, 0.5)
SPEED = np.array([20.0, 60.0, 150.0, 400.0])


def one_row(**conditions):
    return {name: np.array([value]) for name, value in conditions.items()}


def test_short_circuit_is_the_closed_form():
    """T = 1.5 p psi^2 R w (R^2 + X_q^2) / (R^2 + X_d X_q)^2, braking."""
    w = 4 * SPEED
    x_d, x_q = w * 3e-3, w * 4e-3
    torque = 1.5 * 4 * 0.1**2 * 0.5 * w * (0.25 + x_q**2) / (0.25 + x_d * x_q) ** 2
    current = w * 0.1 * np.hypot(x_q, 0.5) / (0.25 + x_d * x_q) / sqrt(2)
    ours = BASE.respond(PLAIN, "short_circuit", {"speed": SPEED})
    assert ours["torque"] == pytest.approx(torque, rel=1e-9)
    assert ours["current"] == pytest.approx(current, rel=1e-9)


def test_operation_is_the_machine_of_the_electrical_package():
    other = SynchronousMachine(4, 0.1, 3e-3, 4e-3, 0.5)
    i_d, i_q = np.array([-8.0, 0, 5, 3]), np.array([16.0, -8, 24, 2])
    ours = BASE.respond(PLAIN, "dq_operation", {"i_d": i_d, "i_q": i_q, "speed": SPEED})
    psi_d, psi_q = other.flux_linkage(i_d, i_q)
    assert ours["v_d"] == pytest.approx(0.5 * i_d - 4 * SPEED * psi_q)
    assert ours["v_q"] == pytest.approx(0.5 * i_q + 4 * SPEED * psi_d)
    assert ours["torque"] == pytest.approx(1.5 * 4 * (psi_d * i_q - psi_q * i_d))


@pytest.mark.parametrize("torque", [0.5, 3.0, 6.0])
def test_supply_is_the_load_angle_of_the_two_reaction_theory(torque):
    """Without resistance: T = 1.5 p / w (V E sin(a) / X_d + V^2 / 2 (1 / X_q - 1 / X_d) sin(2 a))."""
    machine = replace(PLAIN, resistance=1e-9)
    w, voltage = 4 * 150.0, 70.0 * sqrt(2 / 3)
    e, x_d, x_q = w * 0.1, w * 3e-3, w * 4e-3

    def missing(a):
        reaction = voltage**2 / 2 * (1 / x_q - 1 / x_d) * np.sin(2 * a)
        return 1.5 * 4 / w * (voltage * e * np.sin(a) / x_d + reaction) - torque

    angle = brentq(missing, 0.0, 1.3)
    i_d, i_q = (voltage * np.cos(angle) - e) / x_d, voltage * np.sin(angle) / x_q
    ours = BASE.respond(machine, "dq_supply", one_row(v_ll=70.0, torque=torque, speed=150.0))
    assert ours["current"][0] == pytest.approx(np.hypot(i_d, i_q) / sqrt(2), rel=1e-7)
    assert ours["power"][0] == pytest.approx(torque * 150.0, rel=1e-6)


def test_power_that_goes_in_comes_out():
    """Electrical power = shaft power + friction + copper + iron, with saturation of both kinds in the machine."""
    machine = replace(PLAIN, iron_conductance=4e-3)
    for effect in (QuadratureSaturation(5e-3), CrossSaturation(1e-5), FrictionTorque(0.2)):
        machine = effect.on_design(machine)
    conditions = {"v_ll": np.array([72.0, 75, 85]), "torque": np.array([1.0, 3, 5]), "speed": np.full(3, 150.0)}
    ours = BASE.respond(machine, "dq_supply", conditions)
    copper = 3 * 0.5 * ours["current"] ** 2
    iron = 1.5 * 4e-3 * _induced_squared(machine, conditions, ours["current"], ours["power"])
    shaft = (conditions["torque"] + 0.2) * 150.0
    assert ours["power"] == pytest.approx(shaft + copper + iron, rel=1e-6)


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_iron_loss_has_a_part_that_goes_with_the_frequency(share):
    """P = 1.5 psi_m^2 g (omega^2 (1 - h) + h omega omega_0) of a machine that is driven with open terminals."""
    machine = IronLossResistance(1e-4, share).on_design(PLAIN)
    speed = np.array([20.0, 100.0, 300.0])
    omega = PLAIN.pole_pairs * speed
    ours = BASE.respond(machine, "no_load", {"speed": speed})["power"]
    loss = 1.5 * PLAIN.psi_m**2 * 1e-4 * (omega**2 * (1 - share) + share * omega * 2 * np.pi * 100)
    assert ours == pytest.approx(loss, rel=2e-3), "the field that the loss itself weakens is left out"


def _induced_squared(machine, conditions, current, power):
    """|v - R i|^2 from voltage, current and power alone."""
    v, i = conditions["v_ll"] * sqrt(2 / 3), current * sqrt(2)
    cos = power / (1.5 * v * i)
    return v**2 + (0.5 * i) ** 2 - 2 * v * 0.5 * i * cos


def test_cross_saturation_is_reciprocal():
    operation = Operation(CrossSaturation(1e-5).on_design(PLAIN), {"speed": np.zeros(1)})
    i_d, i_q, h = np.array([-5.0]), np.array([12.0]), 1e-3
    d_over_q = (operation.flux_linkage(i_d, i_q + h)[0] - operation.flux_linkage(i_d, i_q - h)[0]) / (2 * h)
    q_over_d = (operation.flux_linkage(i_d + h, i_q)[1] - operation.flux_linkage(i_d - h, i_q)[1]) / (2 * h)
    assert d_over_q == pytest.approx(q_over_d, rel=1e-6) and abs(d_over_q[0]) > 1e-5


def test_temperatures_act_where_they_are_measured():
    warm = replace(PLAIN, copper_coefficient=0.00393, remanence_coefficient=-0.0011)
    speed = np.array([100.0, 100.0])
    emf = BASE.respond(warm, "back_emf", {"speed": speed, "magnet_T": np.array([20.0, 120.0])})["v_ll"]
    assert emf[1] / emf[0] == pytest.approx(1 - 0.11)
    resistance = BASE.respond(warm, "phase_resistance", {"winding_T": np.array([20.0, 120.0])})["resistance"]
    assert resistance == pytest.approx([0.5, 0.5 * 1.393])


def test_a_speed_that_is_not_measured_is_asked_for():
    """By the machine itself, and by an effect that turns its voltages; a resistance needs none."""
    read = {"v_d": np.zeros(1), "v_q": np.zeros(1), "torque": np.zeros(1)}
    at = tables.table(read, 0.1, kind="dq_operation", i_d=np.zeros(1), i_q=np.ones(1))
    for model in (Model(BASE, PLAIN), Model(BASE, PLAIN) + DriveDelay(1e-4)):
        with pytest.raises(WorkbenchError, match="needs the condition 'speed', the table has i_d, i_q; add it"):
            model.answers(at)
    cold = tables.table({"resistance": np.zeros(1)}, 0.1, kind="phase_resistance", winding_T=np.full(1, 20.0))
    assert Model(BASE, PLAIN).answers(cold)["resistance"] == 0.5


def test_no_steady_state_is_said():
    with pytest.raises(WorkbenchError, match="voltage is too low"):
        BASE.respond(PLAIN, "dq_supply", one_row(v_ll=20.0, torque=60.0, speed=150.0))


def test_prius_conventions_keep_the_energy_balance():
    campaign = read_campaign(MEASUREMENTS / "prius-2004")
    for table in campaign.tables[1:]:
        c, power = table.conditions, table.responses["power"].values
        apparent = sqrt(3) * c["v_ll"] * table.responses["current"].values
        loaded = c["torque"] > 0
        assert np.all(power[loaded] < apparent[loaded])
        assert np.all(power - c["torque"] * c["speed"] > 50.0)  # losses
        assert c["speed"] * 4 / (2 * pi) == pytest.approx(60.0)  # Hz, synchronous


def test_prius_needs_more_than_constant_parameters():
    """Four effects bring the held-out error of the current below 0.5 A and take nine tenths of the power's away."""
    campaign = read_campaign(MEASUREMENTS / "prius-2004")
    nominal = replace(BASE.design(campaign.device), psi_m=0.178, inductance_d=2.23e-3, inductance_q=6.7e-3)
    effects = (RemanenceDrift(3e-4), QuadratureSaturation(5.85e-3), CopperDrift(0.0034), FrictionTorque(1.35))
    full = nominal
    for effect in effects:
        full = effect.on_design(full)
    plain = replace(nominal, psi_m=0.1752, inductance_d=2.51e-3, inductance_q=5.22e-3)
    errors = {}
    for name, design in {"plain": plain, "full": full}.items():
        misses = [_held_out_miss(design, table) for table in campaign.tables[1:]]
        errors[name] = np.sqrt(np.mean(np.concatenate(misses, axis=1) ** 2, axis=1))
    assert 0.7 < errors["plain"][0] < 1.2  # A, what an independent analysis of the same rows found
    assert errors["full"][0] < 0.5
    assert errors["full"][1] < 0.1 * errors["plain"][1]


def _held_out_miss(design, table):
    ours = BASE.respond(design, table.kind, table.conditions)
    return np.array([(ours[name] - table.responses[name].values)[table.held_out] for name in ("current", "power")])


MAP_TORQUE, MAP_SPEED = (axis.ravel() for axis in np.meshgrid([-12.0, -3.0, 1.0, 6.0, 15.0], [60.0, 150.0, 260.0]))


@pytest.mark.parametrize("v_dc", [None, 110.0])
def test_a_dynamometer_map_has_the_currents_of_the_electrical_package(v_dc):
    """Least current, and field weakening at 110 V of the d.c. link, searched there along lines of torque."""
    other = SynchronousMachine(4, 0.1, 3e-3, 4e-3, 0.5)
    limits = DriveLimits.from_dc_bus(1e3, v_dc or 1e6)
    expected = operating_map(other, limits, MAP_TORQUE, MAP_SPEED)
    at = {"speed": MAP_SPEED, "torque": MAP_TORQUE} | ({"v_dc": np.full(15, v_dc)} if v_dc else {})
    ours = BASE.respond(PLAIN, "dyno_map", at)
    reached = np.isfinite(expected.i_d)
    assert reached.sum() >= 10
    assert ours["current"][reached] == pytest.approx(np.hypot(expected.i_d, expected.i_q)[reached] / sqrt(2), rel=1e-6)
    assert ours["torque"] == pytest.approx(MAP_TORQUE, abs=1e-9)


def test_beyond_its_voltage_a_map_takes_the_lowest_that_gives_the_torque():
    """Against a search over i_d on the line of torque."""
    speed, torque, limit = 400.0, 15.0, 20.0
    ours = BASE.respond(PLAIN, "dyno_map", one_row(speed=speed, torque=torque, v_dc=limit * sqrt(3)))
    i_d = np.linspace(-80.0, 10.0, 20001)
    i_q = torque / (1.5 * 4 * (0.1 + (3e-3 - 4e-3) * i_d))
    w = 4 * speed
    voltage = np.hypot(0.5 * i_d - w * 4e-3 * i_q, 0.5 * i_q + w * (0.1 + 3e-3 * i_d))
    assert voltage.min() > limit
    assert ours["v_ll"][0] == pytest.approx(voltage.min() * sqrt(1.5), rel=1e-6)


def test_a_map_balances_its_energy_as_motor_and_as_generator():
    """Electrical power less copper and friction is at the shaft, efficiency the ratio the energy flows."""
    machine = FrictionTorque(0.2).on_design(QuadratureSaturation(5e-3).on_design(PLAIN))
    ours = BASE.respond(machine, "dyno_map", {"speed": MAP_SPEED, "torque": MAP_TORQUE})
    shaft = MAP_TORQUE * MAP_SPEED
    assert ours["loss"] == pytest.approx(3 * 0.5 * ours["current"] ** 2 + 0.2 * MAP_SPEED, rel=1e-6)
    assert ours["power"] == pytest.approx(shaft + ours["loss"], rel=1e-9)
    motor = shaft > 0
    assert ours["efficiency"][motor] == pytest.approx((shaft / ours["power"])[motor])
    assert ours["efficiency"][~motor] == pytest.approx((ours["power"] / shaft)[~motor])
    assert ours["power"] == pytest.approx(sqrt(3) * ours["v_ll"] * ours["current"] * ours["power_factor"])


def test_least_current_is_least_with_saturation_of_both_kinds():
    """Currents a little aside on the line of torque are larger."""
    machine = CrossSaturation(1e-5).on_design(QuadratureSaturation(5e-3).on_design(PLAIN))
    operation = Operation(machine, {"speed": np.zeros(3)})
    torque = np.array([-6.0, 3.0, 12.0])
    i_d, i_q = least_current(operation, torque)
    for aside in (-0.3, 0.3):
        other = np.array([brentq(_off(machine, t, d + aside), 0.2 * q, 3 * q) for t, d, q in zip(torque, i_d, i_q)])
        assert np.all(np.hypot(i_d + aside, other) > np.hypot(i_d, i_q))


def _off(machine, torque, i_d):
    one = Operation(machine, {"speed": np.zeros(1)})
    return lambda i_q: one.shaft_torque(np.array([i_d]), np.array([i_q]))[0] - torque


def test_no_load_fed_and_driven():
    machine = FrictionTorque(0.2).on_design(PLAIN)
    speed = np.array([100.0, 150.0])
    driven = BASE.respond(machine, "no_load", {"speed": speed})
    assert driven["power"] == pytest.approx(0.2 * speed)
    assert driven["v_ll"] == pytest.approx(4 * speed * 0.1 * sqrt(1.5))
    fed = BASE.respond(machine, "no_load", {"speed": speed, "v_ll": 1.1 * driven["v_ll"]})
    assert fed["power"] == pytest.approx(0.2 * speed + 3 * 0.5 * fed["current"] ** 2, rel=1e-6)
    magnetising = 0.1 * 4 * speed * 0.1 / (4 * speed * 3e-3) / sqrt(2)  # a tenth too much voltage over X_d, no load
    assert fed["current"] == pytest.approx(magnetising, rel=0.05)


def test_a_map_at_given_currents():
    """The currents of the smallest size give the torque they were chosen for; one or the other, not both."""
    i_d, i_q = least_current(Operation(PLAIN, {"speed": MAP_SPEED}), MAP_TORQUE)
    ours = BASE.respond(PLAIN, "dyno_map", {"speed": MAP_SPEED, "i_d": i_d, "i_q": i_q})
    expected = BASE.respond(PLAIN, "dyno_map", {"speed": MAP_SPEED, "torque": MAP_TORQUE})
    assert all(ours[name] == pytest.approx(expected[name], rel=1e-9) for name in expected)
    with pytest.raises(WorkbenchError, match="or in i_d and i_q"):
        BASE.respond(PLAIN, "dyno_map", {"speed": SPEED, "torque": SPEED, "i_d": SPEED, "i_q": SPEED})


def test_the_bench_answers_every_option():
    """The speeds, torques and instruments of the Prius campaign; a dynamometer map among what is proposed."""
    campaign = read_campaign(MEASUREMENTS / "prius-2004")
    design = BASE.design(campaign.device)
    found = {option.kind: option for option in BASE.options(design, campaign)}
    assert set(found) == {"back_emf", "dyno_map"}  # nobody read torque or resistance there
    for option in found.values():
        answer = BASE.respond(design, option.kind, option.conditions)
        assert all(
            np.all(np.isfinite(answer[name])) and answer[name].shape == u.shape for name, u in option.random.items()
        )
    assert found["dyno_map"].conditions["torque"].max() == max(
        t.conditions["torque"].max() for t in campaign.tables[1:]
    )


def test_a_dynamometer_map_is_read_from_a_file(tmp_path):
    """Units in the names, any of the meters, torque and voltage as conditions; the model answers what was measured."""
    (tmp_path / "map.csv").write_text(
        "speed_rpm,torque_Nm,v_dc_V,winding_T_degC,current_A,power_kW,efficiency_percent\n"
        "1000,10,110,40,12.0,1.3,80\n2000,5,110,42,8.0,1.2,85\n"
    )
    (tmp_path / "campaign.toml").write_text(
        '[campaign]\nid = "map"\n[device]\npole_pairs = 4\npsi_m_Vs = 0.1\ninductance_d_mH = 3\ninductance_q_mH = 4\n'
        'resistance_mohm = 500\n[[table]]\nfile = "map.csv"\nkind = "dyno_map"\n'
        "u_random = { current_A = 0.1, power_kW = 0.01, efficiency_percent = 0.5 }\n"
    )
    campaign = read_campaign(tmp_path)
    table = campaign.tables[0]
    assert set(table.responses) == {"current", "power", "efficiency"}
    assert table.responses["efficiency"].values == pytest.approx([0.8, 0.85])
    ours = BASE.respond(BASE.design(campaign.device), table.kind, table.conditions)
    assert set(table.responses) <= set(ours)


def test_newton_halves_a_step_that_makes_a_row_worse():
    """From 2, the whole steps of arctan x = 0 go -3.5, 14, -279, ... and never come back."""
    start = np.array([2.0, 0.5])
    x, y = newton(lambda x, y: (np.arctan(x), y - 1.0), start, np.zeros(2), np.ones(2), np.ones(2))
    np.testing.assert_allclose(x, 0.0, atol=1e-9)
    np.testing.assert_allclose(y, 1.0)
    with pytest.raises(WorkbenchError, match=r"row \d: no such"):
        newton(lambda x, y: (x**2 + 1.0, y), start, np.zeros(2), np.ones(2), np.ones(2), "no such")


@pytest.mark.parametrize("factor, says", [(1.0, ""), (1e-3, "8 s"), (1e5, "8e-08 s"), (0.0, "")])
def test_a_winding_that_no_machine_has_is_said(factor, says):
    """Milliohms for ohms; of a resistance of none nothing is known."""
    found = BASE.doubts(replace(PLAIN, resistance=factor * PLAIN.resistance))
    assert bool(found) == bool(says) and says in " ".join(found)
    damper = Damper(60.0, 1.2 * factor, 2.0, 20.0, 4e-3 / 0.5 * 1.2)
    assert bool(DAMPER.doubts(damper)) == bool(says)
