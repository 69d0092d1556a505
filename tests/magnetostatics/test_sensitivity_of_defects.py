"""Sensitivities of a whole machine to its defects, each about a size of its own, against central differences."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from geometry.defects import (
    DynamicEccentricity,
    MagnetArc,
    MagnetPosition,
    SlotOpening,
    StaticEccentricity,
    ToothWidth,
)
from geometry.morph import Morpher
from magnetostatics.currents import PhaseCurrents
from magnetostatics.cut_edge import CutEdge
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import FieldModel, OperatingPoint
from magnetostatics.newton import NewtonSettings
from magnetostatics.sensitivity import sensitivities
from magnetostatics.torque import arkkio_torque, magnetic_pull, maxwell_torque
from magnetostatics.variations import CoilTurns, Materials, OneMagnet, PhaseCurrent, Remanence, Shape
from tests.magnetostatics.reference_machine import MATERIALS, STEEL, reference_machine
from tests.magnetostatics.whole_machine import whole_model

SUPPLIED, HELD = OperatingPoint(-0.353, 6e6 * sqrt(2), 0.2), PhaseCurrents(-0.353, (250.0, -100.0, -140.0))
WEAK = MATERIALS.with_magnet(3, replace(MATERIALS.magnet, remanence=1.1, axis_error=0.01))
ECCENTRIC = StaticEccentricity(0.05e-3, 1.0)


@pytest.fixture(scope="module")
def base():
    """Eccentric and with a weak magnet, so that nothing vanishes by symmetry."""
    section = Morpher(whole_model().section).to(reference_machine(), [ECCENTRIC])
    return FieldModel(section, WEAK, NewtonSettings(tolerance=1e-12), topology=whole_model().topology)


@pytest.fixture(scope="module")
def morpher():
    return Morpher(whole_model().section)


def read(solution):
    """Torques, flux linkages, pull."""
    torques = arkkio_torque(solution), maxwell_torque(solution)
    return np.array([*torques, *phase_flux_linkage(solution), *magnetic_pull(solution)])


def worst_difference(solution, variation) -> float:
    """Of the sensitivities from a central difference, each against the largest of its kind."""
    model, point = variation.at(solution.model, solution.point, 0.0)
    here = model.solve(point, start=solution)
    found = sensitivities(here, {"it": variation}, read)["it"]
    change, ends = 300 * variation.step, []
    for signed in (change, -change):
        other, there = variation.at(model, point, signed)
        ends.append(read(other.solve(there, start=here)))
    expected = (ends[0] - ends[1]) / (2 * change)
    scale = np.concatenate([np.full(len(kind), np.abs(kind).max()) for kind in np.split(expected, (2, 5))])
    return float((np.abs(found - expected) / np.maximum(scale, 1e-9 * np.abs(read(here)).max())).max())


def damaged(depth, severity):
    return replace(WEAK, stator_steel=CutEdge(STEEL, depth, severity))


MATERIAL = {
    "remanence of one magnet": OneMagnet(3, step=1e-7),
    "axis of one magnet": OneMagnet(3, "axis_error", 1e-7),
    "recoil permeability of one magnet": OneMagnet(5, "recoil_permeability"),
    "turns of a coil": CoilTurns(4),
    "severity of a cut edge": Materials(lambda _, d: damaged(0.5e-3, 0.3 + d), 1e-5),
    "depth of a cut edge": Materials(lambda _, d: damaged(0.5e-3 + d, 0.3), 3e-9),
}


@pytest.mark.parametrize("name", MATERIAL)
def test_materials_and_winding(base, name):
    assert worst_difference(base.solve(SUPPLIED), MATERIAL[name]) < 1e-5


@pytest.mark.parametrize("phase", range(3))
def test_phase_currents(base, phase):
    assert worst_difference(base.solve(HELD), PhaseCurrent(phase)) < 1e-5


# defects of a change, and the step of the difference [m or rad]: some nanometres of movement
SHAPES = {
    "static eccentricity": (lambda d: [StaticEccentricity(0.05e-3 + d, 1.0)], 1e-9),
    "its direction": (lambda d: [StaticEccentricity(0.05e-3, 1.0 + d)], 1e-5),
    "dynamic eccentricity": (lambda d: [ECCENTRIC, DynamicEccentricity(0.05e-3 + d, 2.0)], 1e-9),
    "magnet position": (lambda d: [ECCENTRIC, MagnetPosition(3, 0.01 + d)], 1e-7),
    "magnet arc": (lambda d: [ECCENTRIC, MagnetArc(3, 0.01 + d)], 1e-7),
    "slot opening": (lambda d: [ECCENTRIC, SlotOpening(2, 0.2e-3 + d)], 1e-9),
    "tooth width": (lambda d: [ECCENTRIC, ToothWidth(2, 0.2e-3 + d)], 1e-9),
}


@pytest.mark.parametrize("name", SHAPES)
def test_defects_that_move_nodes(base, morpher, name):
    defects, step = SHAPES[name]
    variation = Shape(lambda d: morpher.to(reference_machine(), defects(d)), step)
    assert worst_difference(base.solve(SUPPLIED), variation) < 1e-3


def test_gap_and_eccentricity_in_one_variation(base, morpher):
    """A wider gap of an eccentric machine: dimensions and defects move the same mesh."""
    machine = reference_machine()
    variation = Shape(lambda d: morpher.to(replace(machine, airgap=machine.airgap + d), [ECCENTRIC]), step=1e-9)
    assert worst_difference(base.solve(SUPPLIED), variation) < 1e-3


def test_eccentricity_of_a_symmetric_machine_is_felt_in_the_pull_alone(morpher):
    """At zero amplitude torque and phase flux linkage are even in it; the pull is not."""
    model = whole_model()
    slope = sensitivities(
        model.solve(SUPPLIED),
        {"static": Shape(lambda d: morpher.to(reference_machine(), [StaticEccentricity(d, 0.3)]), step=1e-9)},
        read,
    )["static"]
    assert np.abs(slope[:2]).max() < 1e-3 * 55 / 0.5e-3
    assert np.abs(slope[2:5]).max() < 1e-3 * 0.03 / 0.5e-3
    assert np.hypot(*slope[5:]) == pytest.approx(1.6e7, rel=0.15)


def test_one_magnet_and_another_sum_to_all(morpher):
    """Sensitivities to the remanence of single magnets add up to that of all."""
    solution = whole_model().solve(SUPPLIED)
    single = sensitivities(solution, {str(m): OneMagnet(m) for m in range(10)}, read)
    together = sensitivities(solution, {"all": Remanence()}, read)["all"]
    largest = np.abs(list(single.values())).max(axis=0)
    assert (np.abs(sum(single.values()) - together) / largest).max() < 2e-6
