"""Eddy currents in the magnets."""

from dataclasses import replace

import numpy as np
import pytest

from losses.loci import Loci
from losses.magnet import MagnetLoss, _piece_losses, magnet_loss, skin_depth
from tests.losses.conftest import phase
from units import MILLIMETRE


@pytest.mark.physics
def test_synchronous_field_loses_nothing(loaded):
    """A field that stands still in the rotor, the same under every magnet but for its sign."""
    mesh, p = loaded.model.section.mesh, 5
    x, y = mesh.p
    nodes = np.hypot(x, y) ** 2 * np.cos(p * np.arctan2(y, x))
    a = np.concatenate([nodes, nodes[mesh.facets].mean(axis=0)])
    still = replace(loaded, solutions=tuple(replace(solution, a=a) for solution in loaded.solutions))
    assert magnet_loss(still).eddy < 1e-12 * magnet_loss(loaded).eddy


@pytest.mark.physics
@pytest.mark.parametrize("segments", [1, 2, 4])
def test_uniform_pulsating_field(segments):
    """B cos(omega t) through pieces of width w: sigma w^2/12 <(dB/dt)^2> per volume, so n pieces lose 1/n^2."""
    width, b, n = 9e-3, 0.05, 4000
    y = (np.arange(n) + 0.5) / n * width
    loci = Loci(np.arange(n), np.full(n, 1e-6), (b * np.cos(phase(48)))[:, None, None] * y[None, :, None], 1.0, 1)
    pieces = (y / width * segments).astype(int)[:, None]
    total, power, orders = _piece_losses(loci, np.full((n, 1), 1e-6), pieces, segments)
    expected = (width / segments) ** 2 / 12 * (2 * np.pi * b) ** 2 / 2 * n * 1e-6
    assert total == pytest.approx(expected, rel=1e-4)
    assert power.sum() == pytest.approx(total, rel=1e-9) and orders[np.argmax(power)] == 1


@pytest.mark.physics
def test_net_current_of_a_magnet_is_zero():
    """A potential that is the same all over a piece drives no current."""
    n = 50
    loci = Loci(np.arange(n), np.full(n, 1e-6), np.repeat(np.cos(phase(24))[:, None, None], n, axis=1), 1.0, 1)
    total, *_ = _piece_losses(loci, np.full((n, 1), 1e-6), np.zeros((n, 1), dtype=int), 1)
    assert total < 1e-25


@pytest.mark.physics
def test_loss_of_the_reference_machine(idle, loaded):
    """Load adds the harmonics of the winding to the slot ripple; pieces lose less; resistivity divides."""
    without, with_current = magnet_loss(idle), magnet_loss(loaded)
    assert without.eddy < with_current.eddy < 10 * without.eddy
    assert without.order == with_current.order == pytest.approx(2.4)
    assert magnet_loss(loaded, segments=2).eddy < 0.7 * with_current.eddy
    assert magnet_loss(loaded, resistivity=2.8e-6).eddy == pytest.approx(with_current.eddy / 2, rel=1e-12)


def test_limit_is_where_the_skin_depth_is_the_width():
    loss = MagnetLoss(eddy=1.0, order=2.4, width=9 * MILLIMETRE, resistivity=1.4e-6, permeability=1.05)
    assert skin_depth(2.4 * loss.frequency_limit) == pytest.approx(loss.width, rel=1e-12)
    assert loss.at(200.0) == 4e4
