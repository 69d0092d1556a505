"""The stage of the flux map: reach without a winding, ripple and error of the torque, on a coarse map."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest
import xarray as xr

from geometry.family import MachineFamily, MatchedMachine
from geometry.half_cell import MeshDensity
from geometry.magnetisation import ParallelMagnetisation
from magnetostatics.case import FamilyCase
from magnetostatics.flux_map import flux_and_torque, operating_point
from magnetostatics.flux_map_stage import FluxMap, FluxMapGrid, best_current, flux_map_stage, kept_model
from magnetostatics.model import FieldModel, MachineMaterials
from magnetostatics.newton import NewtonSettings
from materials.library import load_steel
from materials.magnet import Magnet
from tasks import InThisProcess
from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE

DENSITY = sqrt(2) * 20 * AMPERE_PER_SQUARE_MILLIMETRE
STEEL = load_steel("35PN270")
CASE = FamilyCase(
    family=MachineFamily(
        slots=12, pole_pairs=5, stator_outer_radius=42.5 * MILLIMETRE, rotor_outer_radius=15.7 * MILLIMETRE,
        back_iron_width=3.3 * MILLIMETRE, magnet_length=2.5 * MILLIMETRE, airgap=0.5 * MILLIMETRE,
        slot_opening=2.0 * MILLIMETRE, shoe_depth_fraction=0.52, shoe_aspect_ratio=1.0,
        shaft_radius=5.0 * MILLIMETRE, magnet_arc_fraction=1.0, magnetisation=ParallelMagnetisation(),
    ),
    materials=MachineMaterials(STEEL, STEEL, Magnet(1.3, 1.0)),
    layers=2, coil_pitch=None, packing=0.3, density=MeshDensity(), detail=MeshDensity(),
    nominal_density=0.3 * DENSITY, overload_density=DENSITY,
)  # fmt: skip
GRID = FluxMapGrid(largest_packing=0.312, overload_density=DENSITY, angles=2, currents=5)


@pytest.fixture(scope="module")
def found() -> FluxMap:
    return flux_map_stage(CASE, MatchedMachine(CASE.family.reference), GRID, InThisProcess())


def test_the_reach_follows_from_the_copper_that_the_slot_holds(found):
    expected = 0.312 * DENSITY * found.coil_side_area
    assert found.overload_ampere_turns == pytest.approx(expected)
    assert float(found.data["iq"].max()) == pytest.approx(1.05 * expected)
    assert float(found.data["id"].min()) == pytest.approx(-1.05 * expected)
    assert found.coil_side_area == pytest.approx(100.45e-6, rel=5e-3)


def test_facts_of_the_winding_travel_with_the_map(found):
    assert (found.pole_pairs, found.coils_in_series, found.coil_pitch) == (5, 4, 1)


def test_points_of_the_map_are_field_solutions(found):
    """As solved alone to the last digit, as near as the tolerance of the map's solutions leaves."""
    kept = kept_model(CASE, CASE.family.reference)
    model = FieldModel(kept.section, kept.materials, NewtonSettings(tolerance=1e-10), topology=kept.topology)
    angle, i_d, i_q = (float(found.data[name][k]) for name, k in (("angle", 1), ("id", 1), ("iq", -2)))
    alone = flux_and_torque(model.solve(operating_point(model, angle, i_d, i_q)))
    here = found.data.isel(angle=1, id=1, iq=-2)
    for name in ("psi_d", "psi_q", "torque"):
        assert float(here[name]) == pytest.approx(alone[name], rel=1e-4)


def test_the_error_of_the_torque_is_small_and_not_nothing(found):
    assert 1e-5 < found.torque_error < 0.01


def test_a_model_is_kept():
    again = replace(CASE)
    assert kept_model(CASE, CASE.family.reference) is kept_model(again, again.family.reference)


@pytest.fixture
def plain():
    """Torque 40 Nm/m times the share of i_q, with 3 Nm/m times its square from peak to peak over four angles."""
    i = np.linspace(-100.0, 100.0, 9)
    wave = np.array([1.0, 0.0, -1.0, 0.0])[:, None, None]
    q = i[None, None, :] / 100 + 0 * i[None, :, None]
    torque = 40 * q * (1 - i[None, :, None] / 400) + 1.5 * q**2 * wave
    data = xr.Dataset({"torque": (("angle", "id", "iq"), torque)}, {"angle": np.arange(4.0), "id": i, "iq": i})
    return FluxMap(data, 5, 4, 1, 1e-4, 100.0, 1e-3)


def test_ripple_is_largest_less_smallest_torque(plain):
    assert plain.torque_ripple(-30.0, 60.0) == pytest.approx(3 * 0.6**2, rel=1e-3)  # the spline is solved iteratively


def test_best_current_against_its_closed_form(plain):
    """T ~ cos g (1 + sin g / 4) at 100 A: sin g = s with 2 s^2 + 4 s - 1 = 0."""
    i_d, i_q = best_current(plain.data, 100.0)
    share = (sqrt(6) - 2) / 2
    assert np.hypot(i_d, i_q) == pytest.approx(100.0)
    assert np.degrees(np.arcsin(-i_d / 100)) == pytest.approx(np.degrees(np.arcsin(share)), abs=0.5)
