"""Unknown functions against the Gaussian processes they stand for."""

from math import log

import numpy as np
import pytest
from scipy.special import logsumexp
from scipy.stats import multivariate_normal

from tests.workbench.likelihood.tables import table, whitened
from workbench.likelihood.unknown import SIZES, TURNS, Beside, expected, seen, shapes_of, smooth

RANDOM = np.random.default_rng(8)
SPEED = np.linspace(0.5, 9.0, 24)


def drag(extra, u=0.01, seed=0):
    """A force of rms near one over a speed, whitened residual of what a model leaves out."""
    noise = u * np.random.default_rng(seed).standard_normal(len(SPEED))
    stack, white = whitened(table({"force": 0.2 * SPEED + extra + noise}, u, speed=SPEED))
    return shapes_of(stack, white, stack.y), white(extra + noise)


def dense(covariance, residual):
    return multivariate_normal(np.zeros(len(residual)), covariance).logpdf(residual)


@pytest.fixture(scope="module")
def case():
    shapes, residual = drag(0.03 * np.sqrt(SPEED))
    return shapes, RANDOM.standard_normal((len(SPEED), 2)), residual


def test_the_gain_of_every_shape_and_size_is_that_of_its_covariance(case):
    shapes, background, residual = case
    inside = np.eye(len(residual)) + background @ background.T
    for found in seen(shapes, background, residual):
        for size, gain in zip(SIZES, found.gains):
            process = size**2 * found.shape.columns @ found.shape.columns.T
            exact = dense(inside + process, residual) - dense(inside, residual)
            assert gain == pytest.approx(exact, abs=1e-6)


def test_many_residuals_at_once_have_the_evidence_of_each(case):
    shapes, background, residual = case
    other = RANDOM.standard_normal(len(residual))
    both = Beside(shapes, background).log_evidences(np.column_stack([residual, other]))
    for k, r in enumerate((residual, other)):
        assert both[k] == pytest.approx(logsumexp([s.log_evidence for s in seen(shapes, background, r)]), abs=1e-6)


def test_prior_shares_add_up_to_one(case):
    assert logsumexp([shape.log_prior for shape in case[0]]) == pytest.approx(0.0, abs=1e-12)


def test_the_expected_function_is_kriging(case):
    shapes, background, residual = case
    found = max(seen(shapes, background, residual), key=lambda s: s.log_evidence)
    process = found.size**2 * found.shape.columns @ found.shape.columns.T
    whole = np.eye(len(residual)) + background @ background.T + process
    exact = 0.01 * process @ np.linalg.solve(whole, residual)  # u = 0.01 N turns whitened rows into newtons
    assert np.allclose(expected(found, background, residual), exact, atol=1e-8)


@pytest.mark.parametrize("power", [0.0, 0.5, 2.0, 3.0])
def test_a_plain_law_is_recognised_by_its_power(power):
    shapes, residual = drag(0.1 * (SPEED / 9) ** power)
    found = max(seen(shapes, np.zeros((len(residual), 0)), residual), key=lambda s: s.log_evidence)
    assert (found.shape.law, found.shape.of, found.shape.detail) == ("power", "speed", power)
    assert f"to the power {power:g}" in found.shape.words()


def test_a_wave_is_no_plain_law():
    shapes, residual = drag(0.05 * np.sin(3 * SPEED))
    found = max(seen(shapes, np.zeros((len(residual), 0)), residual), key=lambda s: s.log_evidence)
    assert found.shape.law == "smooth" and found.log_evidence > 20


@pytest.mark.parametrize("turns, law", [(np.ones(120), "order"), (np.repeat([1.0, -1.0], 60), "opposite order")])
def test_what_rings_is_an_order_of_the_angle(turns, law):
    """Of one direction or of both; 23 waves in 60 places are too many for a smooth function."""
    angle = np.tile(np.arange(60) * np.pi / 30, 2)
    rings = 0.03 * turns * np.sin(23 * angle)
    torque = np.cos(2 * angle) + rings + 0.01 * np.random.default_rng(3).standard_normal(120)
    both = np.repeat([1.0, -1.0], 60)
    stack, white = whitened(table({"torque": torque}, 0.01, angle_mech=angle, direction=both))
    residual = white(stack.y - np.cos(2 * angle))
    found = max(seen(shapes_of(stack, white, stack.y), np.zeros((120, 0)), residual), key=lambda s: s.log_evidence)
    assert (found.shape.law, found.shape.of, found.shape.detail) == (law, "angle_mech", 23)
    assert found.shape.words().startswith("order 23 of angle_mech in ")
    assert found.log_evidence > 100


def two_tables_of_one_cell(step, seed=0, u=0.01, times=1):
    """A force over a speed and one over a shunt, so many times each; the cell reads more by a step above 1 N."""
    random = np.random.default_rng(seed)
    speed, shunt = np.tile(SPEED, times), np.tile(np.linspace(1.0, 5.0, 30), times)
    truths = [0.2 * speed, 2.0 / shunt]
    read = [f * (1 + step * (f > 1.0)) + u * random.standard_normal(len(f)) for f in truths]
    tables = (table({"force": read[0]}, u, speed=speed), table({"force": read[1]}, u, file="s.csv", shunt=shunt))
    stack, white = whitened(*tables)
    answers = np.concatenate(truths)
    return shapes_of(stack, white, answers), white(stack.y - answers)


def test_what_an_instrument_does_is_one_function_of_its_reading_in_all_tables():
    shapes, residual = two_tables_of_one_cell(0.05)
    found = max(seen(shapes, np.zeros((len(residual), 0)), residual), key=lambda s: s.log_evidence)
    assert found.shape.law == "reading" and found.shape.channels == ("t.force", "s.force")
    assert found.log_evidence > 20


def test_noise_is_no_function_of_the_reading():
    """The reading is that of the model: its own noise would show it."""
    gains = []
    for seed in range(20):
        shapes, residual = two_tables_of_one_cell(0.0, seed, u=0.3, times=4)
        found = seen(shapes, np.zeros((len(residual), 0)), residual)
        gains.append(max(s.log_evidence for s in found if s.shape.law == "reading"))
    assert max(gains) < 3 and np.mean(gains) < 0


def test_a_better_sensor_does_not_shrink_what_is_believed_possible():
    """The prior is in the unit of the channel: whitened columns grow by as much as the noise shrinks."""
    rough, fine = (drag(0 * SPEED, u)[0] for u in (0.01, 0.001))
    for a, b in zip(rough, fine):
        assert np.allclose(a.raw, b.raw, rtol=0.02, atol=0.02 * np.abs(a.raw).max())
        assert np.linalg.norm(b.columns) == pytest.approx(10 * np.linalg.norm(a.columns), rel=0.02)


def test_a_size_is_a_share_of_the_rms_reading():
    shapes, residual = drag(0.03 * np.ones_like(SPEED), u=1e-4)
    constant = next(s for s in seen(shapes, np.zeros((len(SPEED), 0)), residual) if s.shape.detail == 0.0)
    rms = np.sqrt(np.mean((0.2 * SPEED + 0.03) ** 2))
    assert constant.size == pytest.approx(0.03 / rms, rel=0.5), "the nearest of six sizes, half a decade apart"


def test_an_angle_closes_on_itself():
    """The process at a distance of 350 degrees is that at 10 degrees, and depends on the chord alone."""
    turn = np.radians(np.arange(0, 360, 10))
    one = table({"torque": np.ones(36)}, 0.1, angle_mech=turn)
    kernel = smooth(one, 1) @ smooth(one, 1).T
    assert kernel[0, 35] == pytest.approx(kernel[0, 1], abs=1e-4)
    chord = 2 * np.sin(np.subtract.outer(turn, turn) / 2) / TURNS[1]
    assert np.allclose(kernel, np.exp(-(chord**2) / 2), atol=2e-3)


def test_the_phases_of_one_voltage_share_size_and_length():
    turn = np.linspace(0, 6, 20)
    emf = table({f"v_{x}": np.cos(turn - k) for k, x in enumerate("abc")}, 0.1, angle_mech=turn)
    stack, white = whitened(emf)
    shapes = shapes_of(stack, white, stack.y)
    assert {shape.channels for shape in shapes} == {("t.v_a", "t.v_b", "t.v_c")}
    crossing = shapes[0].raw[:20].T @ shapes[0].raw[:20]
    third = shapes[0].columns.shape[1] // 3
    assert np.abs(crossing[:third]).sum() > 0 and not crossing[third:].any(), "functions of their own"
    assert log(len(shapes)) == pytest.approx(-shapes[0].log_prior)
