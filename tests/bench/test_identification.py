"""The eight parameters of thesis table 4.2 from loops of another integrator, and what the intervals are worth."""

import numpy as np
import pytest

from bench.errors import RecordError
from bench.force_loops import NOMINAL, PLAY, ForceLoop, identify_loops
from bench.identification import Unknown, identify
from bench.impedance import ImpedancePoint
from bench.lumped_fit import fit_lumped
from bench.memory import mean_and_error, memory_of
from benchmarks.virtual_benches.actuator_loops import TRANSMISSION, Drive, Truth, loop_of
from electrical.shunted_machine import LinearStar, Star
from electrical.synchronous_machine import SynchronousMachine
from vehicle.impedance import LumpedActuator

TRUTH = Truth()
SOUGHT = TRUTH.sought
NOISE = 1.0  # N
DRIVES = (Drive(15, 3e-3, 4000, 0.4), Drive(8, 6e-3, 3000, 0.4), Drive(30, 1e-3, 0, 0.3))


@pytest.fixture(scope="module")
def identified():
    rng = np.random.default_rng(1)
    loops = [loop_of(TRUTH, drive, NOISE, rng) for drive in DRIVES]
    records = [ForceLoop(f"{k}", o.time, o.stroke, o.velocity, o.current, o.force) for k, o in enumerate(loops)]
    return identify_loops(records, NOMINAL, TRANSMISSION, NOISE)


def test_all_eight_parameters_are_found_within_five_percent(identified):
    found, _ = identified
    assert {name: value / SOUGHT[name] for name, value in found.values.items()} == pytest.approx(
        dict.fromkeys(SOUGHT, 1.0), abs=0.05
    )
    assert all(one.is_identified for one in found.found)


def test_the_errors_are_as_large_as_the_intervals_say(identified):
    """All within 3.5 deviations, and their rms of the order of one: 8 values do not say more."""
    found, _ = identified
    pulls = np.array([np.log(one.value / SOUGHT[one.unknown.name]) / one.deviation for one in found.found])
    assert np.abs(pulls).max() < 3.5 and 0.3 < np.sqrt(np.mean(pulls**2)) < 1.9


def test_the_model_leaves_the_noise_and_nothing_else(identified):
    """Table 4.3, with the model right: the mismatch is the noise, the energy that of the loop."""
    found, matches = identified
    assert all(match.rms_mismatch == pytest.approx(NOISE, rel=0.06) for match in matches)
    assert all(abs(match.energy_error) < 2e-3 for match in matches) and found.memory < 1.3


def test_the_play_is_what_the_records_say_least_about(identified):
    deviation, parts = identified[0].weakest
    assert max(parts, key=lambda name: abs(parts[name])) == PLAY
    assert deviation > 5 * sorted(one.deviation for one in identified[0].found)[-2]


# ---- the fit itself, where the answer is known in closed form ------------------------------------------------------


def a_line(noise, rng):
    x = np.linspace(1, 2, 200)
    return (lambda v: [v["a"] * np.ones(200), v["b"] * x]), [
        3.0 + noise * rng.standard_normal(200),
        5.0 * x + noise * rng.standard_normal(200),
    ]


def test_two_known_parameters_with_their_textbook_deviation():
    model, readings = a_line(0.1, np.random.default_rng(2))
    found = identify(model, (Unknown("a", 1.0), Unknown("b", 1.0)), readings, [0.1, 0.1]).found
    x = np.linspace(1, 2, 200)
    expected = [0.1 / 200**0.5 / 3.0, 0.1 / np.linalg.norm(x) / 5.0]
    assert [one.deviation for one in found] == pytest.approx(expected, rel=0.15)
    assert [one.value for one in found] == pytest.approx([3.0, 5.0], rel=0.01)


def test_ninety_percent_intervals_hold_nine_times_in_ten():
    rng, inside = np.random.default_rng(3), []
    for _ in range(150):
        model, readings = a_line(0.1, rng)
        one, other = identify(model, (Unknown("a", 2.0), Unknown("b", 4.0)), readings, [0.1, 0.1]).found
        inside += [one.interval[0] < 3.0 < one.interval[1], other.interval[0] < 5.0 < other.interval[1]]
    assert 0.85 < np.mean(inside) < 0.95


def test_residuals_with_a_memory_widen_the_intervals():
    rng = np.random.default_rng(4)
    white = rng.standard_normal(20000)
    slow = np.zeros_like(white)
    for k in range(1, len(white)):
        slow[k] = 0.8 * slow[k - 1] + white[k]
    assert memory_of(white) == pytest.approx(1.0, abs=0.15)
    assert memory_of(slow) == pytest.approx((1 + 0.8) / (1 - 0.8), rel=0.25)  # of a first-order process
    assert mean_and_error(slow)[1] == pytest.approx(np.std(slow) * 3 / 20000**0.5, rel=0.15)


def test_what_two_parameters_do_alike_is_not_identified():
    """Only the product is seen: each deviation is endless, the weakest direction holds them with opposite signs."""
    x = np.linspace(1, 2, 50)
    rng = np.random.default_rng(5)
    readings = [6.0 * x + 0.01 * rng.standard_normal(50)]
    found = identify(
        lambda v: [v["a"] * v["b"] * x + 1e-6 * v["a"]], (Unknown("a", 1.0), Unknown("b", 1.0)), readings, [0.01]
    )
    assert not any(one.is_identified for one in found.found)
    parts = found.weakest[1]
    assert parts["a"] == pytest.approx(-parts["b"], abs=1e-3)


def test_a_parameter_at_its_bound_is_not_identified():
    x = np.linspace(1, 2, 50)
    found = identify(lambda v: [v["a"] * x], (Unknown("a", 1.0, largest=2.0),), [3.0 * x], [0.1]).found[0]
    assert found.at_bound and not found.is_identified


def test_wrong_input_is_one_sentence():
    with pytest.raises(RecordError, match="no reading depends on b; state it or record what shows it"):
        identify(lambda v: [v["a"] * np.ones(5)], (Unknown("a", 1.0), Unknown("b", 1.0)), [np.ones(5) * 2], [1.0])
    with pytest.raises(RecordError, match="more readings than the 1 unknowns, found 1"):
        identify(lambda v: [v["a"] * np.ones(1)], (Unknown("a", 1.0),), [np.ones(1)], [1.0])
    with pytest.raises(RecordError, match="a nominal value above zero"):
        Unknown("a", 0.0)
    with pytest.raises(RecordError, match="longer than the 9 s in which it settles"):
        ForceLoop("r", *(np.linspace(0, 1, 20) for _ in range(5)), settled=9.0)


# ---- table B.1 -----------------------------------------------------------------------------------------------------

STROKE = 3e-3  # m
MACHINE = SynchronousMachine(5, 49.3e-3 / 7.5, 348.7e-6, 348.7e-6, 68.3e-3)


def points_of(device, rng):
    """Sizes with 1 % of scatter, at a stroke that swings the rotor by two electrical turns."""
    places = [(f, shunt) for shunt in (np.inf, 0.055) for f in np.geomspace(1, 80, 8)]
    z = [complex(device.impedance(f, min(shunt, 1e6), 2 * np.pi * f * STROKE)) for f, shunt in places]
    scatter = np.exp(0.01 * rng.standard_normal(len(z)))
    return [ImpedancePoint("", f, STROKE, shunt, a * b, 0.0, 0.0) for (f, shunt), a, b in zip(places, z, scatter)]


TRUE_B1 = {"equivalent_mass": 5.6, "viscous_friction": 250.0, "mount_stiffness": 2e5, "mount_damping": 50.0}
FAR_OFF = {"equivalent_mass": 3.0, "viscous_friction": 100.0, "mount_stiffness": 6e5, "mount_damping": 150.0}


def lumped(circuit, values):
    return LumpedActuator(MACHINE, circuit, TRANSMISSION, **values)


def test_table_b1_from_the_impedance():
    points = points_of(lumped(Star(0.07), TRUE_B1), np.random.default_rng(6))
    device, found = fit_lumped(lumped(Star(0.07), FAR_OFF), points)
    for (name, true), one in zip(TRUE_B1.items(), found.found):
        assert abs(np.log(getattr(device, name) / true)) < 3.5 * one.deviation and one.deviation < 0.3
    assert np.std(found.residuals[0]) == pytest.approx(0.01, rel=0.35)  # 4 of 16 freedoms are gone


def test_b4_as_printed_does_not_fit_a_synchronous_machine_that_swings_far():
    points = points_of(lumped(Star(0.07), TRUE_B1), np.random.default_rng(6))
    _, found = fit_lumped(lumped(LinearStar(0.07), TRUE_B1), points)
    assert np.std(found.residuals[0]) > 0.1
