"""Solved machines, tables in the form the stages hand over, and a check that no text is cut off."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from figures.style import png_bytes
from geometry.cross_section import mesh_cross_section
from geometry.machine import hanselman_machine
from geometry.winding import star_of_slots
from magnetostatics.model import FieldModel, MachineMaterials, OperatingPoint
from magnetostatics.newton import NewtonSettings
from materials.library import load_steel
from materials.magnet import Magnet
from units import AMPERE_PER_SQUARE_MILLIMETRE, DEGREE, MILLIMETRE

READING, LIMIT = "aligned_tooth", 1.2
SLACK = 0.03  # inch, beyond the edge of a picture


def machine(slots):
    """The reference machine with this number of slots."""
    lengths = {"stator_outer_radius": 42.5, "rotor_outer_radius": 15.7, "back_iron_width": 3.3, "magnet_length": 2.5}
    lengths |= {"airgap": 0.5, "slot_opening": 2.0, "shaft_radius": 5.0}
    in_metres = {name: value * MILLIMETRE for name, value in lengths.items()}
    return hanselman_machine(slots=slots, pole_pairs=5, shoe_depth_fraction=0.52, shoe_aspect_ratio=1.0, **in_metres)


def solved(slots, angle_deg, whole=False):
    """The reference machine at 6 A/mm2 RMS."""
    section = mesh_cross_section(machine(slots), star_of_slots(slots, 5), whole=whole)
    steel = load_steel("35PN270")
    exact = NewtonSettings(tolerance=1e-10)
    model = FieldModel(section, MachineMaterials(steel, steel, Magnet(1.3, 1.0)), exact)
    return model.solve(OperatingPoint(angle_deg * DEGREE, 8.485281 * AMPERE_PER_SQUARE_MILLIMETRE))


@pytest.fixture(scope="session")
def half_machine():
    """12 slots: half the machine is solved, antiperiodic; the rotor stands between two nodes of the sliding circle."""
    return solved(12, -20.6)


@pytest.fixture(scope="session")
def full_machine():
    """9 slots: the whole machine is solved."""
    return solved(9, -10.3)


@pytest.fixture(scope="session")
def half_machine_as_a_whole():
    """The first machine solved without using its symmetry."""
    return solved(12, -20.6, whole=True)


@pytest.fixture
def design_space():
    """One combination, three diameters; the flux density is 0.8 w_bi/R_ro-like and a corner cannot be built."""
    diameters = [70.0, 85.0, 100.0]
    widths, radii = np.linspace(0.05, 0.11, 7), np.linspace(0.28, 0.47, 6)
    diameter, width, radius = np.meshgrid(diameters, widths, radii, indexing="ij")
    torque = diameter**2 * radius * (0.6 - radius - width) / 10
    flux = 0.25 * radius / width
    torque = np.where(width > 0.105, np.nan, torque)
    flux = np.where(np.isnan(torque), np.nan, flux)
    dims = ("stator_diameter_mm", "back_iron", "rotor_radius")
    both = {"torque_Nm_per_m": torque, "tooth_aligned_T": flux}
    both |= {"tooth_worst_T": 1.1 * flux, "back_iron_worst_T": 1.2 * flux}
    data = {name: (dims, values) for name, values in both.items()}
    data["back_iron_width_mm"] = (dims[:2], np.outer(diameters, widths) / 2)
    data["rotor_outer_radius_mm"] = ((dims[0], dims[2]), np.outer(diameters, radii) / 2)
    shares = {"back_iron_fraction": ("back_iron", widths), "rotor_radius_fraction": ("rotor_radius", radii)}
    return xr.Dataset(data, {"stator_diameter_mm": diameters, **shares})


@pytest.fixture
def optima():
    """One optimum for each slot count and diameter; none for 9 slots at 100 mm."""
    rows = []
    for slots in (9, 12):
        for diameter in (70.0, 85.0, 100.0):
            torque = np.nan if (slots, diameter) == (9, 100.0) else diameter**2 / 130
            row = {"slots": slots, "poles": 10, "stator_diameter_mm": diameter, "reading": READING, "limit_T": LIMIT}
            row |= {"back_iron_width_mm": 0.03 * diameter, "rotor_outer_radius_mm": 0.17 * diameter}
            row |= {"torque_nominal_Nm_per_m": torque, "torque_overload_Nm_per_m": 2.6 * torque}
            row |= {"torque_overload_linear_Nm_per_m": 3.33 * torque, "half_slot_area_mm2": diameter**2 / 70}
            rows.append(row)
    return pd.DataFrame(rows)


@pytest.fixture
def assert_readable():
    """Nothing is cut off at the edge of the picture, no axes is empty."""

    def check(figure):
        assert png_bytes(figure)[:4] == b"\x89PNG"
        drawn, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
        assert min(drawn.x0, drawn.y0) > -SLACK and drawn.x1 < width + SLACK and drawn.y1 < height + SLACK, drawn
        for axes in figure.axes:
            assert not axes.axison or axes.has_data() or axes.collections, "an empty axes"

    return check
