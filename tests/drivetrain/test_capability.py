"""What an actuator can do: a linear flux map against closed forms, and remedies that remedy."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
import xarray as xr

from drivetrain.capability import ActuatorDesign, Requirement, levers_of, remedies
from electrical.dq import DriveLimits, torque_speed_envelope
from electrical.resistance import phase_resistance
from electrical.synchronous_machine import SynchronousMachine

PSI, L_D, L_Q, POLES = 5e-3, 4e-6, 4e-6, 5  # per turn and metre: Wb, H, H; without saliency
TURNS, STRANDS, AREA, LENGTH, END, RHO = 8, 20, 0.2e-6, 0.04, 0.016, 1.7e-8


def flux_map(reach=1500.0):
    i = np.linspace(-reach, reach, 9)
    d, q = np.meshgrid(i, i, indexing="ij")
    tables = {"psi_d": (("id", "iq"), PSI + L_D * d), "psi_q": (("id", "iq"), L_Q * q)}
    data = xr.Dataset(tables, {"id": i, "iq": i}, {"pole_pairs": POLES})
    return data.expand_dims(angle=[0.0])


@pytest.fixture(scope="module")
def design():
    return ActuatorDesign(
        flux_map=flux_map(), turns=TURNS, strands=STRANDS, wire_area=AREA, resistivity=RHO, coils_in_series=4,
        active_length=LENGTH, end_turn_length=END, nominal_density=6e6, overload_density=20e6, dc_voltage=48.0,
        transmission_ratio=2e-3, stator_outer_radius=0.04, rotor_outer_radius=0.016, density=7800.0, gearbox_mass=0.7,
        other_mass=2.0, gearbox_inertia=2e-6,
    )  # fmt: skip


@pytest.fixture(scope="module")
def plain():
    scale = TURNS * LENGTH
    resistance = phase_resistance(
        turns=TURNS, strands=STRANDS, wire_area=AREA, active_length=LENGTH, end_turn_length=END, coils_in_series=4,
        resistivity=RHO,
    )  # fmt: skip
    return SynchronousMachine(POLES, scale * PSI, TURNS * scale * L_D, TURNS * scale * L_Q, resistance)


def test_forces_are_those_of_the_constant_parameters(design, plain):
    current = sqrt(2) * 20e6 * AREA * STRANDS
    assert design.force_peak == pytest.approx(1.5 * POLES * plain.psi_m * current / 2e-3, rel=1e-6)
    assert design.force_continuous == pytest.approx(design.force_peak * 6 / 20, rel=1e-6)
    speed = np.array([0.5, 2.0, 4.0])
    limits = DriveLimits.from_dc_bus(current, 48.0)
    expected = torque_speed_envelope(plain, limits, speed / 2e-3).torque / 2e-3
    assert design.force_at(speed) == pytest.approx(np.nan_to_num(expected), rel=1e-4)


def test_damping_mass_and_inertia_are_their_formulas(design, plain):
    constant = 1.5 * POLES * plain.psi_m
    assert design.regenerative_damping == pytest.approx(2 * constant**2 / (3 * plain.resistance * 4e-6), rel=1e-6)
    assert design.mass == pytest.approx(7800 * pi * 0.04**2 * LENGTH + 2.7)
    rotor = 7800 * pi * 0.016**2 * LENGTH * 0.016**2 / 2  # m R^2 / 2
    assert design.equivalent_mass == pytest.approx((rotor + 2e-6) / 4e-6)


def test_a_remedy_is_the_least_that_helps(design):
    needed = 1.2 * design.force_peak
    wanted = Requirement("peak force", needed, lambda d: d.force_peak)
    short = Requirement("active length", 1.1 * LENGTH, lambda d: d.active_length, at_most=True)
    found = {one.lever.name: one for one in remedies(design, (wanted, short))}
    assert found["active length"].value == pytest.approx(1.2 * LENGTH, rel=5e-3)
    assert found["active length"].fails_then == ("active length",)
    assert found["transmission ratio"].value == pytest.approx(2e-3 / 1.2, rel=5e-3)
    assert found["bus voltage"].value is None  # voltage does nothing at rest
    moved = levers_of(design)[0].moved(design, found["active length"].value)
    assert wanted.check(moved).holds and not wanted.check(design).holds


def test_rewinding_keeps_the_copper_and_trades_voltage_for_current(design):
    half = levers_of(design)[3].moved(design, TURNS / 2)
    assert half.turns * half.strands == pytest.approx(TURNS * STRANDS)
    assert half.force_peak == pytest.approx(design.force_peak, rel=1e-6)
    assert half.limits.current_peak == pytest.approx(2 * design.limits.current_peak)
    assert half.force_at(3.0)[0] == pytest.approx(replace(design, dc_voltage=96.0).force_at(3.0)[0], rel=1e-4)


def test_what_holds_needs_no_remedy(design):
    assert remedies(design, (Requirement("peak force", 0.5 * design.force_peak, lambda d: d.force_peak),)) == ()
