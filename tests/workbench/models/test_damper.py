"""The lumped damper against closed forms, integration in time and the measured values of the thesis."""

from dataclasses import dataclass, replace
from math import inf, pi, sqrt
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from effects.damper_design import Damper
from effects.electrical.contact_resistance import ContactResistance
from effects.electrical.diode_drop import DiodeDrop
from effects.electrical.force_constant_saturation import ForceConstantSaturation
from effects.electrical.hysteresis_drag import HysteresisDrag
from effects.mechanical.backlash import Backlash
from effects.mechanical.coulomb_friction import CoulombFriction
from effects.mechanical.quadratic_drag import QuadraticDrag
from effects.mechanical.rig_loss import RigLoss
from workbench.data.campaign import read_campaign
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError
from workbench.models.damper import play as marching
from workbench.models.damper.harmonic_balance import Drive, fundamental
from workbench.models.damper.model import BASE, impedance, linear_impedance, steady_force
from workbench.models.damper.play import change_by_play

MEASUREMENTS = Path(__file__).resolve().parents[3] / "measurements"
PLAIN = Damper(60.0, 1.2, 2.0, 20.0)
# Thesis table B.1 at the suspension, K^2 = 2/3 K_t^2 / tau^2 with tau = 0.115 / 87.3 m/rad.
TAU = 0.115 / 87.3
THESIS = Damper(sqrt(2 / 3) * 0.0493 / TAU, 0.0683, 5.6, 250.0, 348.7e-6 / 1.0, 2e5, 50.0)
FREQUENCY = np.array([1.0, 4.0, 12.0, 40.0])
AMPLITUDE = np.full(4, 2e-3)
SHUNT = np.full(4, 1.0)
SWEEP = Drive(FREQUENCY, AMPLITUDE, SHUNT)


def one(frequency: float, amplitude: float = 2e-3, shunt: float = 1.0) -> Drive:
    return Drive(*(np.array([value]) for value in (frequency, amplitude, shunt)))


def as_printed(d: Damper, frequency, shunt):
    """Thesis eq. B.4 letter by letter, with c_e of eq. B.2 and omega_e of eq. B.5."""
    s = 2j * pi * frequency
    c_e = d.force_constant**2 / (d.internal_resistance + shunt)
    omega_e = (d.internal_resistance + shunt) / d.inductance
    omega_m = sqrt(d.mount_stiffness / d.moving_mass)
    electric = c_e / (s / omega_e + 1)
    above = s + (d.viscous_damping + electric) / d.moving_mass
    below = s**2 + s / d.moving_mass * (d.viscous_damping + d.mount_damping + electric) + omega_m**2
    return above / below * (s * d.mount_damping + d.mount_stiffness)


@pytest.mark.parametrize("shunt", [0.0, 0.055, 0.465, 1e6])
def test_linear_impedance_is_the_printed_equation(shunt):
    ours = linear_impedance(THESIS, Drive(FREQUENCY, AMPLITUDE, np.full(4, shunt)))
    assert ours == pytest.approx(as_printed(THESIS, FREQUENCY, shunt), rel=1e-12)


@pytest.mark.parametrize("inductance", [0.0, 5e-3])
@pytest.mark.parametrize("stiffness", [2e5, inf])
def test_harmonic_balance_of_a_linear_damper_is_the_closed_form(stiffness, inductance):
    loss = 0.0 if stiffness == inf else 50.0
    d = replace(PLAIN, mount_stiffness=stiffness, mount_damping=loss, inductance=inductance)
    ours = fundamental(d, SWEEP)
    assert ours == pytest.approx(linear_impedance(d, SWEEP), rel=1e-11)


def integrated(d: Damper, frequency: float, amplitude: float, shunt: float, law=lambda v: 0.0, play=0.0, contact=None):
    """Force over velocity by an adaptive implicit integration of x, v, i over six periods; the last is read."""
    omega, resistance = 2 * pi * frequency, d.internal_resistance + shunt
    stiffness, loss = contact or (d.mount_stiffness, d.mount_damping)

    def mount(t, x, v):
        stretch = amplitude * np.sin(omega * t) - x
        taut = np.sign(stretch) * max(abs(stretch) - play / 2, 0.0)
        force = stiffness * taut + loss * (omega * amplitude * np.cos(omega * t) - v) * bool(taut)
        return force if force * taut > 0 or not play else 0.0

    def rate(t, y):
        x, v, i = y
        current = i if d.inductance else d.force_constant * v / resistance
        force = mount(t, x, v) - d.viscous_damping * v - law(v) - d.force_constant * current
        di = (d.force_constant * v - resistance * i) / d.inductance if d.inductance else 0.0
        return [v, force / d.moving_mass, di]

    period, n = 1 / frequency, 2000
    times = 5 * period + period * np.arange(n) / n
    start = [0.0, omega * amplitude, d.force_constant * omega * amplitude / resistance]
    y = solve_ivp(rate, (0, 6 * period), start, "Radau", times, rtol=1e-7, atol=1e-9, max_step=period / 150).y
    force = np.array([mount(*row) for row in zip(times, y[0], y[1])])
    return 2 / n * (force @ np.exp(-1j * omega * times)) / (omega * amplitude)


def test_mount_and_inductance_against_integration_in_time():
    d = replace(PLAIN, mount_stiffness=2e5, mount_damping=50.0, inductance=5e-3)
    ours = linear_impedance(d, one(20.0))[0]
    assert ours == pytest.approx(integrated(d, 20.0, 2e-3, 1.0), rel=2e-4)


def test_a_law_behind_a_mount_with_inductance_against_integration_in_time():
    d = replace(PLAIN, mount_stiffness=2e5, mount_damping=50.0, inductance=5e-3).with_force(QuadraticDrag(3000.0))
    ours = impedance(d, one(20.0))[0]
    right = integrated(d, 20.0, 2e-3, 1.0, law=lambda v: 3000.0 * v * abs(v))
    assert abs(ours - linear_impedance(d, one(20.0))[0]) > 100.0  # the law matters
    assert ours == pytest.approx(right, rel=1e-3)


@pytest.mark.parametrize(("frequency", "shunt"), [(10.0, 1.0), (20.0, 5.0)])
def test_play_against_integration_of_a_hard_contact(frequency, shunt):
    play = 2e-4
    d = Backlash(play).on_design(PLAIN)
    ours = impedance(d, one(frequency, shunt=shunt))[0]
    contact = (5e7, 2 * sqrt(5e7 * PLAIN.moving_mass))  # N/m, critically damped, so that nothing rebounds
    right = integrated(PLAIN, frequency, 2e-3, shunt, play=play, contact=contact)
    tight = linear_impedance(PLAIN, one(frequency, shunt=shunt))[0]
    assert abs(ours - right) < 0.12 * abs(right - tight)


def test_coulomb_friction_has_the_describing_function_of_a_square_wave():
    d = PLAIN.with_force(CoulombFriction(10.0, reversal=1e-5))
    ours = impedance(d, SWEEP) - linear_impedance(PLAIN, SWEEP)
    assert ours.real == pytest.approx(4 * 10.0 / (pi * 2 * pi * FREQUENCY * AMPLITUDE), rel=5e-4)
    assert np.abs(ours.imag).max() < 1e-9


def test_quadratic_drag_has_its_describing_function():
    d = PLAIN.with_force(QuadraticDrag(100.0))
    ours = impedance(d, SWEEP) - linear_impedance(PLAIN, SWEEP)
    assert ours.real == pytest.approx(8 / (3 * pi) * 100.0 * 2 * pi * FREQUENCY * AMPLITUDE, rel=2e-6)


@pytest.mark.parametrize("distance", [1e-4, 1e-2, 5e-2])
def test_hysteresis_drag_loses_the_area_of_its_loop(distance):
    """4 level (A - d tanh(A / d)), the integral of the two branches."""
    level, amplitude = 7.0, 0.05
    d = PLAIN.with_force(HysteresisDrag(level, distance))
    z = impedance(d, one(1.0, amplitude)) - linear_impedance(PLAIN, one(1.0))
    omega = 2 * pi
    loss = pi * z.real[0] * omega * amplitude**2  # energy of a period from the fundamental
    assert loss == pytest.approx(4 * level * (amplitude - distance * np.tanh(amplitude / distance)), rel=0.01)


def test_short_circuit_and_open_circuit_force_are_the_closed_forms():
    velocity = np.linspace(-0.4, 0.4, 9)
    assert steady_force(PLAIN, velocity, 0 * velocity) == pytest.approx((20 + 60**2 / 1.2) * velocity)
    assert steady_force(PLAIN, velocity, 0 * velocity + 1e6) == pytest.approx(20 * velocity, rel=2e-4)


def test_a_sharp_diode_is_a_dead_band():
    d = PLAIN.with_circuit(DiodeDrop(0.7, knee=1e-3))
    velocity, shunt = np.array([-0.3, 0.005, 0.3]), np.full(3, 1.0)
    current = (steady_force(d, velocity, shunt) - 20 * velocity) / 60
    assert current == pytest.approx([-(18 - 0.7) / 2.2, 0.0, (18 - 0.7) / 2.2], abs=1e-4)


def test_saturation_keeps_the_balance_of_power():
    """Mechanical power of the electromagnetic force is the heat in both resistances, whatever K(i) is."""
    d = PLAIN.with_coupling(ForceConstantSaturation(1e-3))
    velocity, shunt = np.linspace(0.05, 0.5, 7), np.full(7, 1.0)
    force = steady_force(d, velocity, shunt) - 20 * velocity
    current = np.sqrt(force * velocity / 2.2)
    assert 60 / (1 + 1e-3 * current**2) * current == pytest.approx(force, rel=1e-9)
    assert force[-1] < 0.9 * 3600 / 2.2 * velocity[-1]


def test_rig_loss_of_an_impedance_is_that_of_its_motion():
    z = np.array([300.0 * np.exp(0.6j), 300.0 * np.exp(1.5j)])
    response = {"re": z.real, "im": z.imag}
    lost = RigLoss(0.1).on_response(response, {}, "impedance", PLAIN)
    theta = 2 * pi * (np.arange(20000) + 0.5) / 20000
    force = np.real(z[:, None] * np.exp(1j * theta))
    right = 2 / 20000 * ((force + 0.1 * abs(force) * np.sign(np.cos(theta))) @ np.exp(-1j * theta))
    assert lost["re"] + 1j * lost["im"] == pytest.approx(right, rel=1e-3)


def test_force_loop_encloses_the_power_of_the_impedance():
    d = PLAIN.with_force(CoulombFriction(10.0))
    phase = np.linspace(0, 2 * pi, 2000, endpoint=False)
    same = np.ones(2000)
    loop = BASE.respond(
        d, "force_loop", {"phase": phase, "frequency": 5 * same, "amplitude": 2e-3 * same, "shunt": same}
    )["force"]
    top = 2 * pi * 5 * 2e-3
    re = impedance(d, one(5.0)).real[0]
    assert np.mean(loop * top * np.cos(phase)) == pytest.approx(0.5 * re * top**2, rel=2e-4)


def test_the_phase_of_a_loop_is_that_of_displacement_and_velocity():
    phase, same = np.linspace(0, 2 * pi, 50, endpoint=False), np.ones(50)
    sine = {"frequency": 5 * same, "amplitude": 2e-3 * same, "shunt": same}
    moved = {"displacement": 2e-3 * np.sin(phase), "velocity": 2e-3 * 2 * pi * 5 * np.cos(phase)}
    told, found = (BASE.respond(PLAIN, "force_loop", sine | more)["force"] for more in ({"phase": phase}, moved))
    assert found == pytest.approx(told, abs=1e-9)


@dataclass(frozen=True)
class Row:
    """A model of table 5.1 and its values [N s/m] at 465, 135, 55, 0 mohm in an independent computation."""

    damper: Damper
    printed: tuple[float, ...]


def thesis(torque_constant: float, viscous: float, resistance=0.0683) -> Damper:
    return replace(PLAIN, force_constant=sqrt(2 / 3) * torque_constant / TAU, internal_resistance=resistance,
                   viscous_damping=viscous)  # fmt: skip


@pytest.mark.parametrize(
    "row",
    [
        Row(thesis(0.0493, 0.0), (1751, 4593, 7573, 13671)),
        Row(ContactResistance(0.07).on_design(thesis(0.0493, 0.0)), (1548, 3417, 4831, 6752)),
        Row(thesis(0.866 * 0.0493, 70.0), (1383, 3515, 5749, 10323)),
    ],
    ids=["M0", "M1", "H1"],
)
def test_table_5_1_predictions(row):
    shunt = np.array([0.465, 0.135, 0.055, 0.0])
    assert BASE.respond(row.damper, "damping_shunt", {"shunt": shunt})["damping"] == pytest.approx(row.printed, abs=1.0)


def test_three_shunted_values_fit_within_five_percent_and_the_short_circuit_does_not():
    campaign = read_campaign(MEASUREMENTS / "thesis-table-5-1")
    table = campaign.tables[0]
    predicted = BASE.respond(thesis(0.866 * 0.0493, 70.0), table.kind, table.conditions)["damping"]
    measured = table.responses["damping"].values
    error = predicted / measured - 1
    assert np.abs(error[:3]).max() < 0.05
    assert error[3] == pytest.approx(-0.47, abs=0.01)
    assert BASE.design(campaign.device).force_constant == pytest.approx(THESIS.force_constant, rel=1e-4)


def test_slope_of_a_curved_line_needs_its_velocities():
    curved = PLAIN.with_force(QuadraticDrag(100.0))
    shunt = np.array([1.0])
    with pytest.raises(WorkbenchError, match="test_velocity"):
        BASE.respond(curved, "damping_shunt", {"shunt": shunt})
    velocity = np.linspace(0.03, 0.3, 10)
    force = steady_force(curved, velocity, np.full(10, 1.0))
    slope = np.polyfit(velocity, force, 1)[0]
    ours = BASE.respond(replace(curved, test_velocity=0.3), "damping_shunt", {"shunt": shunt})["damping"]
    assert ours == pytest.approx([slope])


DEVICE = {"kind": "electromagnetic damper", "force_constant_N_per_A": 60.0, "internal_resistance_mohm": 1200.0,
          "moving_mass_kg": 2, "viscous_damping_Ns_per_m": 20.0}  # fmt: skip


def test_device_table_is_read_in_its_units():
    assert BASE.accepts(DEVICE) and BASE.design(DEVICE) == PLAIN


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"force_constant_N_per_A": -1.0}, "positive number or zero"),
        ({"force_constant_N_per_A": "60"}, "number"),
        ({"stroke_mm": 40.0}, "does not use"),
    ],
)
def test_a_wrong_device_table_gets_a_sentence(change, words):
    with pytest.raises(WorkbenchError, match=words):
        BASE.design({**DEVICE, **change})


def test_a_missing_key_an_unknown_kind_and_tolerance_get_a_sentence():
    with pytest.raises(WorkbenchError, match="lacks moving_mass"):
        BASE.design({key: value for key, value in DEVICE.items() if key != "moving_mass_kg"})
    with pytest.raises(WorkbenchError, match="cannot answer"):
        BASE.respond(PLAIN, "cogging", {"velocity": np.ones(1)})
    with pytest.raises(WorkbenchError, match="no input"):
        BASE.with_tolerance(PLAIN, Tolerance("airgap", 0.1, True), 1.0)


def test_a_tolerance_moves_its_input():
    moved = BASE.with_tolerance(PLAIN, Tolerance("force_constant_N_per_A", 0.01, True), 2.0)
    assert moved == replace(PLAIN, force_constant=60.0 * 1.02)


LAWS = {
    "linear": PLAIN,
    "with a law": PLAIN.with_force(CoulombFriction(5.0)),
    "on a mount": replace(PLAIN, mount_stiffness=2e5, mount_damping=50.0, inductance=2e-3).with_force(
        QuadraticDrag(30.0)
    ),
    "with play": replace(PLAIN, mount_clearance=1e-4),
}
TABLES = {
    "damping_velocity": {"velocity": np.array([-0.3, 0.1, 0.2]), "shunt": np.full(3, 2.0)},
    "damping_shunt": {"shunt": np.array([0.5, 2.0, 5.0]), "velocity": np.full(3, 0.3)},
    "impedance": {"frequency": np.array([1.0, 5.0, 20.0]), "amplitude": np.full(3, 2e-3), "shunt": np.full(3, 2.0)},
}


@pytest.mark.parametrize("design", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("kind", TABLES)
def test_states_of_a_row_are_another_device(design, kind):
    """A winding and an oil as warm in every row as in another design answer as that design."""
    states = {"resistance_factor": np.full(3, 1.2), "viscous_factor": np.full(3, 0.7)}
    found = BASE.respond(design, kind, TABLES[kind] | states)
    warm = replace(design, internal_resistance=1.2 * 1.2, viscous_damping=0.7 * 20.0)
    for column, values in BASE.respond(warm, kind, TABLES[kind]).items():
        assert found[column] == pytest.approx(values, rel=1e-9)


def test_states_belong_to_their_row():
    states = {"viscous_factor": np.array([1.0, 0.5, 2.0])}
    one_by_one = [replace(LAWS["on a mount"], viscous_damping=20.0 * factor) for factor in states["viscous_factor"]]
    expected = [BASE.respond(d, "impedance", TABLES["impedance"])["re"][k] for k, d in enumerate(one_by_one)]
    found = BASE.respond(LAWS["on a mount"], "impedance", TABLES["impedance"] | states)["re"]
    assert found == pytest.approx(np.array(expected), rel=1e-6)


def test_voltage_at_a_shunt_is_that_across_the_shunt_and_not_across_a_warm_winding():
    conditions = {"velocity": np.array([0.2]), "shunt": np.array([3.0]), "resistance_factor": np.array([1.5])}
    voltage = BASE.respond(PLAIN, "back_emf", conditions)["voltage"]
    assert voltage == pytest.approx([60 * 0.2 * 3.0 / (3.0 + 1.5 * 1.2)])


@pytest.mark.parametrize("play", [1e-6, 1e-4])
def test_flight_between_the_ends_of_a_play_is_the_march(play, monkeypatch):
    d, drive = replace(PLAIN, mount_clearance=play), Drive(np.array([1.0, 12.0, 40.0]), np.full(3, 2e-3), np.ones(3))
    exact = change_by_play(d, drive)
    monkeypatch.setattr(marching, "STEPS", 1280)
    marched = marching._change_marched(d, drive)
    assert np.abs(exact - marched).max() < 0.01 * np.abs(exact).max()
