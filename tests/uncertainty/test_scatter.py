"""Magnets that differ: waveforms of one magnet against machines that are solved with it, and lots against symmetry."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from numpy.testing import assert_allclose

from magnetostatics.arc import solved_over
from magnetostatics.torque import arkkio_torque
from tasks import InThisProcess
from tests.uncertainty.test_field_slopes import CASE as COARSE_CASE
from tests.uncertainty.test_field_slopes import COARSE, MACHINE
from uncertainty.deviations import MagnetRemanence, MagnetScatter
from uncertainty.field_slopes import Cogging, StateTask, solve_slopes
from uncertainty.scatter import ScatterArc, cogging_scatter, mirrored, peak_to_peak

PLACE = 0.004  # rad
# Every angle of the scan stands on nodes of the sliding circle, between which so coarse a mesh cogs by itself.
CASE = replace(COARSE_CASE, density=replace(COARSE, gap_edges=240, longest_gap_edge=1.0))


@pytest.fixture(scope="module")
def found():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("uncertainty.scatter.STEPS", 4)
        return cogging_scatter(CASE, MACHINE, 0.1 * MACHINE.airgap, InThisProcess())


def test_a_machine_with_two_odd_magnets_is_drawn_plus_both(found):
    """Solved as a whole machine, at 3 degrees; the second magnet sees the angle a pole further on."""
    step, turn = 2, 2 * pi / 60 / 4 * 2
    model = ScatterArc(CASE, MACHINE, (turn,)).model()
    strong, weak = (with_two_odd_magnets(model, way * 0.02, turn) for way in (1, -1))
    waves = found.remanence[step] + found.remanence[(step + found.pole_steps) % len(found.remanence)]
    assert strong - weak == pytest.approx(0.04 * waves, rel=0.02) and abs(strong - weak) > 0.05
    assert 0.5 * (strong + weak) == pytest.approx(found.drawn[step], abs=0.005)


def with_two_odd_magnets(model, change, angle):
    """Torque [Nm/m] with the remanence of magnets 0 and 1 changed [T]."""
    magnet = replace(model.materials.magnet, remanence=model.materials.magnet.remanence + change)
    odd = model.like(materials=model.materials.with_magnet(0, magnet).with_magnet(1, magnet))
    return arkkio_torque(solved_over(odd, (angle,), 0.0, CASE.packing)[0])


def test_all_magnets_alike_are_the_remanence_of_the_machine(found):
    """The waveforms of all ten add up to what the remanence of all does to the drawn cogging."""
    together = found._of_magnets(found.remanence).sum(0)
    alike = solve_slopes(StateTask(CASE, MACHINE, Cogging(), (MagnetRemanence(0.1),)))
    ratio = peak_to_peak(together) / peak_to_peak(found.drawn)
    assert ratio == pytest.approx(float(alike.relative[0, 0]), rel=0.05)
    turned = found._of_magnets(found.position).sum(0)
    slope = np.gradient(np.tile(found.drawn, 3), 2 * pi / 60 / 4)[len(turned) : 2 * len(turned)]
    assert_allclose(turned, turned[: len(turned) // 5].tolist() * 5, atol=1e-3 * np.abs(turned).max())
    assert np.sign(turned[0]) == np.sign(slope[0]), "all magnets further on: the rotor has turned"


def test_lots_are_the_drawn_machine_without_scatter_and_spread_with_it(found):
    drawn = peak_to_peak(found.drawn)
    assert_allclose(found.machines(MagnetScatter(0.0, 0.0)), drawn)
    near, far = (found.machines(MagnetScatter(0.0, share * PLACE)) for share in (0.01, 1.0))
    assert near.std() < 0.02 * far.std() and far.mean() > 1.05 * drawn


def test_new_orders_are_those_of_the_symmetry(found):
    """Rotor defects: multiples of 12 that are none of 60; stator defects of 10. Sizes of the lots by their spectra."""
    scatter = MagnetScatter(0.02, PLACE)
    for orders, first in (
        (found.orders_of_magnets(scatter), 12),
        (found.orders_of_static, 10),
        (found.orders_of_dynamic, 12),
    ):
        assert orders and all(order % first == 0 and order % 60 for order in orders)
    rng = np.random.default_rng(3)
    lots = rng.uniform(-PLACE, PLACE, (4000, 10)) @ found._of_magnets(found.position)
    spectrum = 2 * np.abs(np.fft.rfft(lots, axis=1)) / lots.shape[1]
    expected = float(np.sqrt((spectrum[:, 1] ** 2).mean()))
    assert found.orders_of_magnets(MagnetScatter(0.0, PLACE))[12] == pytest.approx(expected, rel=0.05)


def test_half_a_period_is_enough():
    angle = 2 * pi * np.arange(8) / 8
    assert_allclose(mirrored(np.sin(angle[:5]), -1), np.sin(angle), atol=1e-15)
    assert_allclose(mirrored(np.cos(angle[:5]), 1), np.cos(angle), atol=1e-15)
