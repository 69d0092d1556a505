"""Magnets let into a rotor of iron, and the same rotor without magnets (a reluctance machine), against matched modes.

The stator is a drawing that the field does not see, with the real winding in it: air and currents out to A = 0.
"""

from math import pi

import numpy as np
import pytest

from geometry.half_cell import MeshDensity
from magnetostatics.model import FieldModel, MachineMaterials
from magnetostatics.newton import NewtonSettings
from magnetostatics.torque import arkkio_torque, maxwell_torque
from materials.magnet import Magnet
from materials.reluctivity import LinearReluctivity
from tests.magnetostatics.other_machines import INSET, currents, section_of
from tests.physics.salient_series import SalientRotor, solve_salient
from tests.physics.slotless_ring import radial_harmonic
from units import MU_0

pytestmark = pytest.mark.physics

FINE = MeshDensity(gap_edges=1440, longest_gap_edge=1.0, gap_layers=3, across_iron=2.0)
IRON, RECOIL, REMANENCE = 1e6, 1.05, 1.2
ORDERS, MODES = 1500, 120  # as many a length in the gap as in an opening
OF_COILS = 150  # orders of the currents: beyond, (R_o/s)^k is below 1e-3 of what it is at the first tooth harmonics
ANGLE, GAMMA = 0.0137, 0.7  # rad


def model_with(remanence, density=FINE):
    materials = MachineMaterials(LinearReluctivity(1.0), LinearReluctivity(IRON), Magnet(remanence, RECOIL))
    return FieldModel(section_of(INSET, density), materials, NewtonSettings(1e-9))


def of_currents(model, point):
    """s_k R_o^k [Wb/m] (ORDERS,) of the currents in the coil sides of the whole machine."""
    k, total, section = np.arange(1, OF_COILS + 1), 0.0, model.section
    for slot, side in section.coil_sides:
        coil, way = section.layout.coil_at(slot, side)
        sheet = model.elements.take(section.mesh.subdomains[f"slot_{slot}_{side}"])
        amperes = way * coil.sign * point.ampere_turns(section)[coil.phase] / section.half_slots_per_coil_side
        total = total + amperes * _moments(sheet, k) / sheet.weights.sum()
    copies = np.arange(section.sectors)
    repeated = (section.sign ** copies[:, None] * np.exp(-2j * pi / section.sectors * np.outer(copies, k))).sum(0)
    return np.pad(MU_0 / (2 * pi * k) * total * repeated, (0, ORDERS - OF_COILS))


def _moments(sheet, k):
    """Integral of [(R_o/s)^k - (R_o s/R_a^2)^k] exp(-j k phi) over the elements of a coil side (K,) [m^2]."""
    x, y = (values.ravel() for values in sheet.points)
    s, rim, outer = np.hypot(x, y), INSET.rotor.outer_radius, INSET.stator.outer_radius
    shape = (rim / s) ** k[:, None] - (rim * s / outer**2) ** k[:, None]
    return (shape * np.exp(-1j * k[:, None] * np.arctan2(y, x))) @ sheet.weights.ravel()


def exact(model, point, remanence):
    r = INSET.rotor
    half = r.arc_fraction * pi / r.poles
    rotor = SalientRotor(r.poles, r.core_radius, r.outer_radius, half, remanence, RECOIL)
    return solve_salient(rotor, INSET.stator.outer_radius, point.angle, of_currents(model, point), MODES)


def harmonic(field, order):
    """B_r,k [T], mean over the area of the stator half of the gap."""
    place, weight = np.polynomial.legendre.leggauss(12)
    low, high = INSET.mid_gap_radius, INSET.stator.rim_radius
    radii = (low + high) / 2 + (high - low) / 2 * place
    values = [1j * order * field.potential(r)[0][order - 1] for r in radii]
    return np.dot(weight, values) * (high - low) / (high**2 - low**2)


@pytest.mark.parametrize("remanence", (REMANENCE, 0.0), ids=("inset magnets", "reluctance"))
def test_torque_and_flux_density_under_current(remanence):
    """At the corners of the iron the field is singular, which both the mesh and the cosines meet slowly."""
    model = model_with(remanence)
    point = currents(model, ANGLE, 2000.0, GAMMA, 1.0)
    solution, series = model.solve(point), exact(model, point, remanence)
    torque = series.torque(INSET.mid_gap_radius)
    assert [arkkio_torque(solution), maxwell_torque(solution)] == pytest.approx([torque, torque], rel=1e-3)
    first = harmonic(series, 5)
    assert radial_harmonic(solution, 5) == pytest.approx(first, abs=5e-4 * abs(first))


def test_magnets_alone():
    """Their fundamental; between mesh and cosines are 1 % of the third order, a ninth of it, that corners make."""
    model = model_with(REMANENCE)
    point = currents(model, ANGLE, 0.0, 0.0, 1.0)
    solution, first = model.solve(point), harmonic(exact(model, point, REMANENCE), 5)
    assert radial_harmonic(solution, 5) == pytest.approx(first, abs=5e-4 * abs(first))
