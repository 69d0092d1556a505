"""An outer rotor and a V of buried magnets against another code: elements of order two and three on its own meshes,
checked there by mesh, order, virtual work and an exact case."""

from pathlib import Path

import numpy as np
import pytest

from geometry.half_cell import MeshDensity
from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.torque import arkkio_torque, maxwell_torque
from materials.library import load_steel
from materials.magnet import Magnet
from tests.magnetostatics.other_machines import OUTRUNNER, V_SHAPE, currents, model_of
from units import DEGREE

STEEL = load_steel(str(Path(__file__).with_name("M400-50A_bh.csv")))
TOLERANCE = 3e-3


def no_load_fundamental(model, positions=15):
    """Amplitude of the fundamental of phase A over an electrical period [Wb/m], one turn in every coil.

    Fifteen positions take the orders 14, 16, 29 and 31 for the first; the first two do not exist.
    """
    period, found, last = 2 * np.pi / model.section.machine.pole_pairs, [], None
    for angle in np.arange(positions) / positions * period:
        last = model.solve(PhaseCurrents(angle, (0.0, 0.0, 0.0)), last)
        found.append(phase_flux_linkage(last)[0])
    return 2 / positions * abs(np.fft.rfft(found)[1])


def torques(model, angles, state):
    """By the ring and by consistent fluxes [Nm/m], (angles, 2)."""
    found, last = [], None
    for angle in angles:
        last = model.solve(state(angle), last)
        found.append((arkkio_torque(last), maxwell_torque(last)))
    return np.array(found)


@pytest.fixture(scope="module")
def outrunner():
    return model_of(OUTRUNNER, MeshDensity(gap_edges=720, gap_layers=2, across_iron=2.0), STEEL, Magnet(1.2, 1.05))


@pytest.fixture(scope="module")
def v_shape():
    return model_of(V_SHAPE, MeshDensity(gap_edges=1440, gap_layers=2, across_iron=2.0), STEEL, Magnet(1.24, 1.05))


def test_outrunner_without_current(outrunner):
    assert no_load_fundamental(outrunner) == pytest.approx(4.9337e-3, rel=TOLERANCE)


def test_cogging_of_the_outrunner(outrunner):
    angles = np.arange(20) / 20 * 10 * DEGREE
    ring, fluxes = torques(outrunner, angles, lambda angle: PhaseCurrents(angle, (0.0, 0.0, 0.0))).T
    assert np.ptp(ring) == pytest.approx(0.3402, rel=0.01)
    assert np.ptp(fluxes) == pytest.approx(0.3402, rel=0.01)


def test_torque_of_the_outrunner(outrunner):
    angles = np.arange(8) / 8 * 20 * DEGREE
    found = torques(outrunner, angles, lambda angle: currents(outrunner, angle, 5.0, 0.0, 8.0)).mean(axis=0)
    assert found == pytest.approx(1.7757, rel=TOLERANCE)
    assert found[1] == pytest.approx(found[0], rel=2e-3)


def test_v_shape_without_current(v_shape):
    """48 coils of 4.5 turns carry what 24 coils of 9 turns do in a single layer of full pitch."""
    assert 4.5 * no_load_fundamental(v_shape) == pytest.approx(2.4815, rel=TOLERANCE)


@pytest.mark.parametrize("gamma, torque", [(0.0, 87.92), (30.0, 111.69), (60.0, 87.50)])
def test_torque_of_the_v_shape(v_shape, gamma, torque):
    """Mean over 15 degrees at 75 A, of a stack of 83.82 mm."""
    angles = np.arange(8) / 8 * 15 * DEGREE
    found = torques(v_shape, angles, lambda angle: currents(v_shape, angle, 75.0, gamma * DEGREE, 4.5)).mean(axis=0)
    assert 0.08382 * found == pytest.approx(torque, rel=TOLERANCE)
    assert found[1] == pytest.approx(found[0], rel=2e-3)
