"""Sensitivities by one back-substitution against central differences of solutions."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from geometry.morph import Morpher
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import FieldModel, MachineMaterials, OperatingPoint
from magnetostatics.newton import NewtonSettings
from magnetostatics.probes import probe_reader
from magnetostatics.sensitivity import sensitivities
from magnetostatics.torque import arkkio_torque, maxwell_torque
from magnetostatics.variations import (
    CurrentAngle,
    CurrentDensity,
    Dimension,
    RecoilPermeability,
    Remanence,
    SaturationPolarisation,
    StackingFactor,
    SteelStrength,
)
from materials.library import load_steel
from materials.magnet import Magnet
from tests.geometry.thesis_machine import machine, section

POINT = OperatingPoint(-24 * pi / 180, sqrt(2) * 6e6, 15 * pi / 180)
PROBES = ("tooth_4", "tooth_2", "back_iron_2")


@pytest.fixture(scope="module")
def solution():
    steel = load_steel("35PN270")
    model = FieldModel(section(), MachineMaterials(steel, steel, Magnet(1.3, 1.0)), NewtonSettings(tolerance=1e-10))
    return model.solve(POINT)


@pytest.fixture(scope="module")
def read(solution):
    reader = probe_reader(solution.model)

    def results(found):
        flux = reader.moved(found.model).read(found)
        torques = arkkio_torque(found), maxwell_torque(found)
        return np.array([*torques, *phase_flux_linkage(found), *(flux[name] for name in PROBES)])

    return results


def solved_again(solution, variation, read):
    """Central difference over a thousand steps of the variation."""
    ends, change = [], 1000 * variation.step
    for signed in (change, -change):
        model, point = variation.at(solution.model, solution.point, signed)
        ends.append(read(model.solve(point, start=solution)))
    return (ends[0] - ends[1]) / (2 * change)


def scale(values):
    """Torques, linkages and flux densities each against the largest of their kind."""
    kinds = np.split(np.abs(values), (2, 5))
    return np.concatenate([np.full(len(kind), kind.max()) for kind in kinds])


PHYSICAL = {
    "remanence": Remanence(1e-7),
    "recoil permeability": RecoilPermeability(),
    "current density": CurrentDensity(),
    "current angle": CurrentAngle(1e-7),
    "steel": SteelStrength(),
    "saturation": SaturationPolarisation(1e-7),
    "stacking factor": StackingFactor(1e-7),
}


@pytest.mark.parametrize("name", PHYSICAL)
def test_material_magnet_and_source(solution, read, name):
    variation = PHYSICAL[name]
    found, expected = sensitivities(solution, {name: variation}, read)[name], solved_again(solution, variation, read)
    assert (np.abs(found - expected) / scale(expected)).max() < 1e-5


DIMENSIONS = {
    "back iron": lambda d: machine(back_iron_width=3.3e-3 + d),
    "rotor radius": lambda d: machine(rotor_outer_radius=15.7e-3 + d),
    "air gap": lambda d: replace(machine(), airgap=0.5e-3 + d),
    "slot opening": lambda d: replace(machine(), slot_opening=2e-3 + d),
    "magnet length": lambda d: replace(machine(), magnet_length=2.5e-3 + d),
}


@pytest.mark.parametrize("name", DIMENSIONS)
def test_dimensions_that_move_nodes(solution, read, name):
    variation = Dimension(Morpher(solution.model.section), DIMENSIONS[name])
    found, expected = sensitivities(solution, {name: variation}, read)[name], solved_again(solution, variation, read)
    assert (np.abs(found - expected) / scale(expected)).max() < 1e-3


def test_torque_falls_with_a_wider_gap_and_rises_with_remanence(solution, read):
    gap = Dimension(Morpher(solution.model.section), DIMENSIONS["air gap"])
    found = sensitivities(solution, {"gap": gap, "remanence": Remanence()}, read)
    assert found["gap"][0] < 0 < found["remanence"][0]
