"""The reference machine (12 slots, 10 poles, 85 mm) solved over part of a period, and loci made by hand."""

import numpy as np
import pytest

from geometry.cross_section import mesh_cross_section
from geometry.machine import hanselman_machine
from geometry.winding import star_of_slots
from losses.loci import Loci, solve_part
from magnetostatics.model import FieldModel, MachineMaterials, OperatingPoint
from magnetostatics.newton import NewtonSettings
from materials.library import load_steel
from materials.magnet import Magnet
from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE

NOMINAL = 2**0.5 * 6 * AMPERE_PER_SQUARE_MILLIMETRE
PACKING = 0.3


def machine(slots=12, **changes):
    lengths = {"stator_outer_radius": 42.5, "rotor_outer_radius": 15.7, "back_iron_width": 3.3, "magnet_length": 2.5}
    lengths |= {"airgap": 0.5, "slot_opening": 2.0, "shaft_radius": 5.0} | changes
    in_metres = {name: value * MILLIMETRE for name, value in lengths.items()}
    return hanselman_machine(slots=slots, pole_pairs=5, shoe_depth_fraction=0.52, shoe_aspect_ratio=1.0, **in_metres)


def model(slots=12, whole=False, **changes):
    section = mesh_cross_section(machine(slots, **changes), star_of_slots(slots, 5), whole=whole)
    steel = load_steel("35PN270")
    return FieldModel(section, MachineMaterials(steel, steel, Magnet(1.3, 1.0)), NewtonSettings(tolerance=1e-11))


def point(amplitude=NOMINAL, gamma=0.0):
    return OperatingPoint(0.0, amplitude, gamma, PACKING)


def made(values, periods=1.0, area=1e-4):
    """Loci of one element from values (steps, components) or (steps,)."""
    values = np.asarray(values, dtype=float).reshape(len(values), 1, -1)
    return Loci(np.array([0]), np.array([area]), values, periods, 1)


def phase(steps=96):
    return 2 * np.pi * np.arange(steps) / steps


@pytest.fixture(scope="session")
def reference():
    return model()


@pytest.fixture(scope="session")
def idle(reference):
    """One sixth of a period without current."""
    return solve_part(reference, point(0.0))


@pytest.fixture(scope="session")
def loaded(reference):
    """One sixth of a period at 6 A/mm2 RMS on the q axis."""
    return solve_part(reference, point())
