"""Magnets and copper over temperature."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from materials.conductor import COPPER, Conductor
from materials.errors import MaterialError
from materials.magnet import Magnet
from units import MU_0


def test_remanence_falls_with_temperature():
    """-0.11 %/K: 1.3 T at 20 degC is 1.3 (1 - 0.088) at 100 degC."""
    assert Magnet(1.3).at(100.0).remanence == pytest.approx(1.3 * (1 - 0.0011 * 80))
    assert Magnet(1.3).at(20.0) == Magnet(1.3)


def test_warming_in_two_steps_is_warming_in_one():
    two, one = Magnet(1.3).at(60.0).at(120.0), Magnet(1.3).at(120.0)
    assert two.remanence == pytest.approx(one.remanence, rel=1e-14)
    assert Magnet(1.3).at(120.0).at(20.0).remanence == pytest.approx(1.3, rel=1e-14)


def test_coercive_field_closes_the_recoil_line():
    magnet = Magnet(1.3, recoil_permeability=1.05)
    assert magnet.remanence - MU_0 * magnet.recoil_permeability * magnet.coercive_field == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("remanence", "recoil_permeability"), [(-1.3, 1.05), (float("nan"), 1.05), (1.3, 0.9)])
def test_impossible_magnets_are_refused(remanence, recoil_permeability):
    with pytest.raises(MaterialError):
        Magnet(remanence, recoil_permeability)


def test_a_magnet_may_have_lost_its_remanence():
    assert Magnet(0.0).at(100.0).coercive_field == 0.0


def test_no_magnet_beyond_the_linear_law():
    with pytest.raises(MaterialError, match="no remanence left at 1000 degC"):
        Magnet(1.3).at(1000.0)


def test_copper_resistivity():
    assert COPPER.resistivity(20.0) == 1.68e-8
    assert_allclose(COPPER.resistivity(np.array([20.0, 120.0])), [1.68e-8, 1.68e-8 * 1.393])


def test_conductor_needs_a_resistivity():
    with pytest.raises(MaterialError):
        Conductor(0.0, 0.00393, 20.0)
