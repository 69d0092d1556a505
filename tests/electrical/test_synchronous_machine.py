"""The constant-parameter machine: textbook limits, brute force, and the thesis's two windings."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from electrical.dq import (
    DriveLimits,
    base_speed,
    corner_speed,
    maximum_power,
    mtpa_currents,
    operating_map,
    power_at_base_speed,
    torque_speed_envelope,
)
from electrical.synchronous_machine import SynchronousMachine
from units import RPM

CURRENT = sqrt(2) * 20e6 * pi * 0.25e-3**2 * 22  # A peak, 22 wires of 0.5 mm at 20 A/mm^2 RMS
TORQUE = 6.0  # Nm, peak torque of the thesis's winding
PRINTED_RESISTANCE = 27.4e-3 / 2  # ohm per phase
MAXIMUM_SPEED = 15000 * RPM  # of the thesis's mapping
LIMITS = DriveLimits.from_dc_bus(CURRENT, 48.0)
SEVEN_TURNS = SynchronousMachine(5, TORQUE / CURRENT / 7.5, 84e-6, 84e-6, PRINTED_RESISTANCE)
FOUR_TURNS = SynchronousMachine(
    5, SEVEN_TURNS.psi_m * 4 / 7, 84e-6 * (4 / 7) ** 2, 84e-6 * (4 / 7) ** 2, PRINTED_RESISTANCE * 4 / 39 * 22 / 7
)
FOUR_TURN_LIMITS = DriveLimits.from_dc_bus(CURRENT * 39 / 22, 48.0)
BURIED = SynchronousMachine(4, 0.05, 0.4e-3, 1.1e-3, 0.05)  # L_d < L_q, stays in reach at any speed
BURIED_LIMITS = DriveLimits(150.0, 60.0)
INVERSE = SynchronousMachine(4, 0.05, 0.9e-3, 0.5e-3, 0.05)  # L_d > L_q
WEAK = SynchronousMachine(4, 0.05, 0.3e-3, 0.6e-3, 0.02)  # psi_m / L_d above the current limit: a finite top speed
WEAK_LIMITS = DriveLimits(60.0, 40.0)
CASES = [(SEVEN_TURNS, LIMITS), (BURIED, BURIED_LIMITS), (INVERSE, BURIED_LIMITS), (WEAK, WEAK_LIMITS)]


def brute_force_torque(machine, limits, speed):
    """Largest torque over a fine polar grid of currents."""
    radius, angle = np.meshgrid(np.linspace(0, 1, 801) * limits.current_peak, np.linspace(0, pi, 1601))
    i_d, i_q = radius * np.cos(angle), radius * np.sin(angle)
    allowed = np.hypot(*machine.voltage(i_d, i_q, speed)) <= limits.voltage_peak
    return np.max(machine.torque(i_d, i_q), where=allowed, initial=-np.inf)


def test_voltage_limit_of_the_bus():
    assert LIMITS.voltage_peak == pytest.approx(27.71, abs=0.005)


def test_power_balance_has_no_loss_but_copper():
    i_d, i_q, speed = -40.0, 90.0, 300.0
    v_d, v_q = BURIED.voltage(i_d, i_q, speed)
    electrical = 1.5 * (v_d * i_d + v_q * i_q)
    copper = 1.5 * BURIED.resistance * (i_d**2 + i_q**2)
    assert electrical == pytest.approx(BURIED.torque(i_d, i_q) * speed + copper, rel=1e-12)


def test_torque_constant_of_the_printed_winding():
    assert SEVEN_TURNS.torque_constant == pytest.approx(49.1e-3, abs=0.05e-3)


@pytest.mark.parametrize("machine", [SEVEN_TURNS, BURIED, INVERSE])
def test_mtpa_is_the_best_angle(machine):
    angle = np.linspace(0, pi, 200001)
    torque = machine.torque(100 * np.cos(angle), 100 * np.sin(angle))
    i_d, i_q = mtpa_currents(machine, 100.0)
    assert np.hypot(i_d, i_q) == pytest.approx(100.0, rel=1e-14)
    assert machine.torque(i_d, i_q) == pytest.approx(torque.max(), rel=1e-9)
    assert np.degrees(np.arctan2(i_q, i_d)) == pytest.approx(np.degrees(angle[torque.argmax()]), abs=2e-3)


@pytest.mark.parametrize("last_digits", range(-6, 7))
def test_mtpa_is_the_q_axis_where_the_inductances_differ_by_rounding_alone(last_digits):
    """A chord then meets the root at once, from either side."""
    inductance = 9.85782e-5
    almost = SynchronousMachine(5, 6.87365e-3, inductance + last_digits * np.spacing(inductance), inductance, 0.0)
    for current in np.linspace(100.0, 140.0, 21):
        assert abs(mtpa_currents(almost, current)[0]) < 1e-10 * current


def test_mtpa_stays_exact_when_the_saliency_vanishes():
    """i_d -> (L_d - L_q) I^2 / psi_m, where the textbook root cancels to nothing."""
    almost = replace(BURIED, inductance_d=BURIED.inductance_q - 1e-10)
    assert mtpa_currents(almost, 100.0)[0] == pytest.approx(-1e-10 * 100**2 / BURIED.psi_m, rel=1e-5)


@pytest.mark.parametrize("machine, limits", CASES)
def test_base_speed_is_where_the_full_current_meets_the_voltage_limit(machine, limits):
    currents = mtpa_currents(machine, limits.current_peak)
    voltage = np.hypot(*machine.voltage(*currents, base_speed(machine, limits)))
    assert voltage == pytest.approx(limits.voltage_peak, rel=1e-12)


def test_q_axis_corner_of_a_salient_machine_is_another_speed():
    on_q_axis = corner_speed(BURIED, BURIED_LIMITS, 0.0, BURIED_LIMITS.current_peak)
    assert np.hypot(*BURIED.voltage(0.0, 150.0, on_q_axis)) == pytest.approx(60.0, rel=1e-12)
    assert on_q_axis < base_speed(BURIED, BURIED_LIMITS)


def test_base_speed_is_zero_when_the_resistance_uses_up_the_voltage():
    assert base_speed(replace(SEVEN_TURNS, resistance=1.0), LIMITS) == 0.0


@pytest.mark.parametrize(
    "machine, limits, rpm, printed_rpm",
    [(SEVEN_TURNS, LIMITS, 4201, 4311), (FOUR_TURNS, FOUR_TURN_LIMITS, 7397, 7624)],
)
def test_base_speed_of_the_thesis_windings(machine, limits, rpm, printed_rpm):
    assert base_speed(machine, limits) / RPM == pytest.approx(rpm, abs=1)
    assert base_speed(machine, limits) / RPM == pytest.approx(printed_rpm, rel=0.04)


def test_base_speed_without_resistance():
    assert base_speed(replace(SEVEN_TURNS, resistance=0.0), LIMITS) / RPM == pytest.approx(4348, abs=1)


@pytest.mark.parametrize(
    "machine, limits, watts, ideal, printed",
    [(SEVEN_TURNS, LIMITS, 2640, 3110, 2690), (FOUR_TURNS, FOUR_TURN_LIMITS, 4710, 5550, 4750)],
)
def test_powers_of_the_thesis_windings(machine, limits, watts, ideal, printed):
    power = power_at_base_speed(machine, limits)
    best = maximum_power(machine, limits, MAXIMUM_SPEED)
    assert power == pytest.approx(watts, abs=5)
    assert power == pytest.approx(printed, rel=0.03)
    assert best.power == pytest.approx(ideal, abs=6)
    assert 1.10 < best.power / printed < 1.20


def test_line_to_line_inductance_read_as_phase_value_would_halve_the_base_speed():
    assert base_speed(replace(SEVEN_TURNS, inductance_d=168e-6, inductance_q=168e-6), LIMITS) / RPM < 2700


@pytest.mark.parametrize("machine, limits", CASES)
@pytest.mark.parametrize("fraction", [0.0, 0.6, 1.0, 1.05, 1.4, 2.0, 3.5])
def test_envelope_against_brute_force(machine, limits, fraction):
    speed = fraction * base_speed(machine, limits)
    envelope = torque_speed_envelope(machine, limits, speed)
    expected = brute_force_torque(machine, limits, speed)
    if not np.isfinite(expected):
        assert np.isnan(envelope.torque)
        return
    assert envelope.torque == pytest.approx(expected, rel=6e-3)
    assert envelope.torque >= expected * (1 - 1e-12)
    assert envelope.current_peak <= limits.current_peak * (1 + 1e-9)
    assert envelope.voltage_peak <= limits.voltage_peak * (1 + 1e-9)


def test_random_salient_machines_respect_both_limits_and_never_fall_below_brute_force():
    random = np.random.default_rng(0)
    for _ in range(12):
        psi, l_d, resistance = 10 ** random.uniform([-3, -5, -3], [-1, -3, -1])
        l_q = l_d * 10 ** random.uniform(-1, 1)
        machine = SynchronousMachine(int(random.integers(1, 8)), psi, l_d, l_q, resistance)
        limits = DriveLimits(*10 ** random.uniform([0.5, 0.7], [2.5, 2.5]))
        speed = 10 ** random.uniform(-1, 0.7) * base_speed(machine, limits)
        envelope = torque_speed_envelope(machine, limits, speed)
        expected = brute_force_torque(machine, limits, speed)
        if np.isfinite(expected):
            assert envelope.torque >= expected * (1 - 1e-9)
            assert envelope.current_peak <= limits.current_peak * (1 + 1e-9)
            assert envelope.voltage_peak <= limits.voltage_peak * (1 + 1e-9)


def test_constant_torque_up_to_base_speed_then_falling():
    speed = np.linspace(0, 3, 301) * base_speed(BURIED, BURIED_LIMITS)
    torque = torque_speed_envelope(BURIED, BURIED_LIMITS, speed).torque
    full = BURIED.torque(*mtpa_currents(BURIED, BURIED_LIMITS.current_peak))
    assert torque[:100] == pytest.approx(np.full(100, full), rel=1e-9)
    assert np.all(np.diff(torque[101:]) < 0)


def test_mtpv_of_a_round_lossless_machine():
    machine = replace(SEVEN_TURNS, resistance=0.0)
    speed = 12000 * RPM
    envelope = torque_speed_envelope(machine, LIMITS, speed)
    expected = 1.5 * machine.psi_m * LIMITS.voltage_peak / (speed * machine.inductance_d)
    assert envelope.torque == pytest.approx(expected, rel=1e-9)
    assert envelope.current_peak < LIMITS.current_peak
    assert maximum_power(machine, LIMITS, MAXIMUM_SPEED).power == pytest.approx(expected * speed, rel=1e-9)


def test_top_speed_of_a_machine_that_cannot_weaken_its_field_away():
    """Without resistance the last speed is V / (p (psi_m - L_d I))."""
    machine = replace(WEAK, resistance=0.0)
    top = WEAK_LIMITS.voltage_peak / (4 * (0.05 - 0.3e-3 * 60.0))
    inside, outside = torque_speed_envelope(machine, WEAK_LIMITS, np.array([0.9999, 1.0001]) * top).torque
    assert inside > 0 and np.isnan(outside)


def test_family_of_machines_equals_its_members():
    family = SynchronousMachine(
        5,
        *(
            np.array([[getattr(m, name)] for m in (SEVEN_TURNS, FOUR_TURNS)])
            for name in ("psi_m", "inductance_d", "inductance_q", "resistance")
        ),
    )
    limits = DriveLimits.from_dc_bus(np.array([[LIMITS.current_peak], [FOUR_TURN_LIMITS.current_peak]]), 48.0)
    best = maximum_power(family, limits, MAXIMUM_SPEED)
    assert best.power.shape == (2,)
    assert best.power[0] == pytest.approx(maximum_power(SEVEN_TURNS, LIMITS, MAXIMUM_SPEED).power, rel=1e-12)
    assert best.power[1] == pytest.approx(maximum_power(FOUR_TURNS, FOUR_TURN_LIMITS, MAXIMUM_SPEED).power, rel=1e-12)


def test_power_peak_inside_the_speed_range_is_found():
    best = maximum_power(WEAK, WEAK_LIMITS, 1000.0)
    speed = np.linspace(1, 1000, 20000)
    power = torque_speed_envelope(WEAK, WEAK_LIMITS, speed).power
    assert best.power == pytest.approx(np.nanmax(power), rel=1e-5)
    assert best.speed == pytest.approx(speed[np.nanargmax(power)], rel=5e-3)


@pytest.mark.parametrize("machine, limits", CASES)
def test_map_meets_the_envelope(machine, limits):
    speed = np.linspace(0.05, 1.2, 24) * base_speed(machine, limits)
    torque = torque_speed_envelope(machine, limits, speed).torque
    assert not np.isnan(operating_map(machine, limits, 0.9999 * torque, speed).current_peak).any()
    assert np.isnan(operating_map(machine, limits, 1.0001 * torque, speed).current_peak).all()


@pytest.mark.parametrize("machine", [SEVEN_TURNS, BURIED, INVERSE])
def test_map_takes_the_smallest_current_while_the_voltage_allows(machine):
    currents = mtpa_currents(machine, 60.0)
    torque = machine.torque(*currents)
    point = operating_map(machine, BURIED_LIMITS, torque, 10.0)
    assert point.current_peak == pytest.approx(60.0, rel=1e-9)
    assert (point.i_d, point.i_q) == pytest.approx(currents, abs=1e-4)


def test_map_weakens_no_more_than_needed():
    speed = 1.8 * base_speed(SEVEN_TURNS, LIMITS)
    point = operating_map(SEVEN_TURNS, LIMITS, 3.0, speed)
    assert point.voltage_peak == pytest.approx(LIMITS.voltage_peak, rel=1e-9)
    assert point.i_d < 0
    assert SEVEN_TURNS.torque(point.i_d, point.i_q) == pytest.approx(3.0, rel=1e-12)


def test_map_is_symmetric_under_reversal_and_easier_when_braking():
    speed = base_speed(SEVEN_TURNS, LIMITS)
    drive, reverse, brake = operating_map(
        SEVEN_TURNS, LIMITS, np.array([4.0, -4.0, -4.0]), np.array([speed, -speed, speed])
    ).voltage_peak
    assert reverse == pytest.approx(drive, rel=1e-12)
    assert brake < drive


def test_map_at_the_printed_corner_shows_the_printed_maxima():
    """27.7 V and 121 A peak at the corner of the force-velocity plane."""
    point = operating_map(SEVEN_TURNS, LIMITS, TORQUE * (1 - 1e-9), base_speed(SEVEN_TURNS, LIMITS) * (1 - 1e-9))
    assert point.voltage_peak == pytest.approx(27.7, abs=0.05)
    assert point.current_peak == pytest.approx(121, rel=0.015)


@pytest.mark.parametrize(
    "field, value", [("psi_m", 0.0), ("inductance_d", -1e-6), ("inductance_q", 0.0), ("resistance", -1e-3)]
)
def test_impossible_parameters_are_refused(field, value):
    with pytest.raises(ValueError, match="must"):
        replace(SEVEN_TURNS, **{field: value})


def test_negative_speeds_and_limits_are_refused():
    with pytest.raises(ValueError, match="not negative"):
        torque_speed_envelope(SEVEN_TURNS, LIMITS, [-1.0, 1.0])
    with pytest.raises(ValueError, match="current limit"):
        DriveLimits(0.0, 10.0)
    with pytest.raises(ValueError, match="voltage limit"):
        DriveLimits(10.0, -1.0)
