"""Iron loss of loci whose loss is known in closed form."""

import numpy as np
import pytest

from losses.iron import FrequencyTerms, iron_loss, loop_sum, principal_components
from losses.loci import Loci
from materials.iron_loss import IronLossLaw, classical_eddy, iron_loss_law
from tests.losses.conftest import made, phase

LAW = iron_loss_law("M235-35A")
MASS = LAW.density * 1e-4  # of the one element, kg/m
FREQUENCY = 333.0


def line(values, tilt=0.0):
    """A locus along a straight line."""
    return np.stack([np.cos(tilt) * values, np.sin(tilt) * values], axis=-1)


def loss(values, periods=1.0, law=LAW):
    return iron_loss(made(values, periods), law).total


@pytest.mark.physics
@pytest.mark.parametrize("tilt", [0.0, 0.7, np.pi / 2, 2.5])
def test_sine_along_a_line_is_the_law(tilt):
    total = loss(line(1.2 * np.cos(phase() + 0.3), tilt))
    assert total.at(FREQUENCY) == pytest.approx(MASS * LAW.specific_loss(FREQUENCY, 1.2), rel=2e-3)


@pytest.mark.physics
def test_sine_of_another_order_is_the_law_at_its_frequency():
    """Three cycles in one electrical period, and six in two."""
    expected = MASS * LAW.specific_loss(3 * FREQUENCY, 0.8)
    assert loss(line(0.8 * np.cos(3 * phase(192)))).at(FREQUENCY) == pytest.approx(expected, rel=3e-3)
    assert loss(line(0.8 * np.cos(6 * phase(384))), periods=2.0).at(FREQUENCY) == pytest.approx(expected, rel=3e-3)


@pytest.mark.physics
def test_classical_term_of_two_harmonics():
    """sigma d^2/24 times the squared peaks of dB/dt, harmonics add in power; no other term."""
    thickness, resistivity, density = 0.35e-3, 0.5e-6, 7650.0
    law = IronLossLaw("eddy only", 0, 2.0, classical_eddy(thickness, resistivity, density), 0, 0, density, "test")
    values = 1.0 * np.cos(phase()) + 0.2 * np.cos(7 * phase() + 1.0)
    peaks = 2 * np.pi * FREQUENCY * np.array([1.0, 7 * 0.2])
    expected = thickness**2 / resistivity / 24 * (peaks**2).sum() * 1e-4
    assert loss(line(values, 0.4), law=law).at(FREQUENCY) == pytest.approx(expected, rel=1e-12)


@pytest.mark.physics
def test_excess_of_a_triangle():
    """|dB/dt| = 4 B f all the time: k_e / 8.763 (4 B f)^1.5."""
    law = IronLossLaw("excess only", 0, 2.0, 0, 0, 1e-3, 7650.0, "test")
    triangle = 2 / np.pi * np.arcsin(np.cos(phase(3000)))
    expected = 7650.0 * 1e-4 * 1e-3 / 8.763363 * (4 * FREQUENCY) ** 1.5
    assert loss(line(triangle), law=law).at(FREQUENCY) == pytest.approx(expected, rel=2e-3)


@pytest.mark.physics
def test_constant_field_loses_nothing():
    total = loss(np.full((48, 2), 1.4))
    assert (total.hysteresis, total.eddy, total.excess) == (0.0, 0.0, 0.0)


@pytest.mark.physics
def test_constant_part_does_not_count():
    values = line(0.3 * np.cos(phase()), 0.4)
    assert loss(values + [1.1, -0.3]).at(FREQUENCY) == pytest.approx(loss(values).at(FREQUENCY), rel=1e-9)


@pytest.mark.physics
def test_rotating_field_is_two_alternating_ones():
    circle = np.stack([np.cos(phase()), np.sin(phase())], axis=-1)
    turning, along = loss(circle), loss(line(np.cos(phase())))
    assert turning.hysteresis == pytest.approx(2 * along.hysteresis, rel=2e-3)
    assert turning.eddy == pytest.approx(2 * along.eddy, rel=1e-9)
    assert turning.excess == pytest.approx(1.797 * along.excess, rel=1e-3)  # 1 / <|cos|^1.5>


def test_frequency_scaling():
    terms = FrequencyTerms(2.0, 0.5, 1.0)
    assert terms.at(4.0) == pytest.approx(2.0 * 4 + 0.5 * 16 + 1.0 * 8)
    assert terms.at(-4.0) == terms.at(4.0)
    only = [FrequencyTerms(*row).at(200.0) / FrequencyTerms(*row).at(100.0) for row in np.eye(3)]
    assert only == pytest.approx([2.0, 4.0, 2**1.5])


@pytest.mark.parametrize(
    "series, loops",
    [
        ([3, -3], [3.0]),
        ([3, 2, 1, -1, -3, -1, 2], [3.0]),  # points on the way are no loops
        ([3, -1, 1, -3], [3.0, 1.0]),  # one minor loop on the way down
        ([3, -1, 1, -3, 2, 0], [3.0, 1.0, 1.0]),  # and one on the way up
        ([3, -2, 2, 0, 1, -3], [3.0, 2.0, 0.5]),  # a loop in a loop
        ([1, -3, 3, -1], [3.0, 1.0]),  # the same as the third, begun elsewhere
    ],
)
def test_loops_are_counted(series, loops):
    components = np.zeros((len(series), 1, 2))
    components[:, 0, 0] = series
    for exponent in (1.0, 1.8):
        assert loop_sum(components, exponent)[0] == pytest.approx(sum(size**exponent for size in loops))


def test_minor_loops_add_to_the_major_one():
    """Five ripples of 0.2 T on a slow sine close minor loops whose cost adds."""
    smooth = np.cos(phase(960))
    rippled = smooth + 0.2 * np.cos(15 * phase(960))
    assert loss(line(rippled)).hysteresis > loss(line(smooth)).hysteresis * 1.2


def test_loops_of_many_elements_are_those_of_each():
    values = np.random.default_rng(0).normal(size=(40, 30, 2))
    each = [loop_sum(values[:, k : k + 1], 1.7)[0] for k in range(30)]
    assert loop_sum(values, 1.7) == pytest.approx(each, rel=1e-12)


def test_principal_axes_of_an_ellipse():
    turned = np.exp(0.8j) * (1.3 * np.cos(phase()) + 0.4j * np.sin(phase()))
    values = np.stack([turned.real, turned.imag], axis=-1)[:, None]
    assert np.ptp(principal_components(values), axis=0)[0] == pytest.approx([2.6, 0.8], rel=2e-3)


def test_extrapolated_share():
    values = np.stack([line(1.0 * np.cos(phase())), line(2.0 * np.cos(phase()))], axis=1)
    found = iron_loss(Loci(np.arange(2), np.array([1e-4, 1e-4]), values, 1.0, 1), LAW)
    inside, beyond = LAW.specific_loss(FREQUENCY, np.array([1.0, 2.0]))
    assert found.share_beyond_data(FREQUENCY) == pytest.approx(beyond / (inside + beyond), rel=2e-3)
