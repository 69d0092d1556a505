"""The machine as scikit-fem solves it from the forms, against the hand-written assembly, to rounding."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.cross_section import CrossSection
from geometry.defects import DynamicEccentricity, MagnetPosition, StaticEccentricity
from geometry.half_cell import MeshDensity
from geometry.magnetisation import RadialMagnetisation
from geometry.morph import Morpher
from geometry.parts import ComposedMachine
from magnetostatics.currents import PhaseCurrents
from magnetostatics.cut_edge import CutEdge
from magnetostatics.elements import LINEAR, QUADRATIC, TriangleOrder
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import FieldModel, MachineMaterials, OperatingPoint
from magnetostatics.newton import FieldSolutionError, NewtonSettings
from magnetostatics.torque import arkkio_torque
from magnetostatics.weak_form import WeakForm
from materials.magnet import Magnet
from tests.magnetostatics.other_machines import (
    CONSEQUENT,
    HALBACH,
    INSET,
    LOAVES,
    OUTRUNNER,
    RELUCTANCE,
    RIBBED,
    SPOKE,
    TWO_LAYERS,
    V_SHAPE,
)
from tests.magnetostatics.other_machines import section_of as other_section
from tests.magnetostatics.reference_machine import MATERIALS, STEEL, reference_machine, section_of
from units import DEGREE

COARSE = MeshDensity(gap_edges=120, longest_gap_edge=2.0, gap_layers=2, across_iron=1.0)
RATED = 8.485e6  # A/m^2
TOLERANCE = 1e-12  # of the residual; the tangent is a hundred times softer than the load in places
THIN_IRON = 3e-11  # the same where bridges carry all of the rotor's field: rounding leaves 1e-11
SAME_POTENTIAL, SAME = 1e-9, 1e-11  # relative; flux linkage and torque are means


@dataclass(frozen=True, eq=False)
class Case:
    """One state of one machine."""

    section: CrossSection
    point: OperatingPoint | PhaseCurrents
    materials: MachineMaterials = MATERIALS
    tolerance: float = TOLERANCE


def sector(**changes) -> CrossSection:
    return section_of(reference_machine(**changes), COARSE)


def with_defects() -> CrossSection:
    whole = section_of(reference_machine(), COARSE, whole=True)
    defects = StaticEccentricity(60e-6, 0.7), DynamicEccentricity(40e-6), MagnetPosition(3, 0.01)
    return Morpher(whole).to(whole.machine, defects)


def other_kind(machine: ComposedMachine) -> CrossSection:
    return other_section(machine, COARSE)


def other_materials() -> MachineMaterials:
    """Damaged stator edges, another rotor, magnets with a recoil permeability and an axis that is off."""
    magnet = Magnet(1.2, recoil_permeability=1.08, axis_error=0.03)
    return MachineMaterials(CutEdge(STEEL, 0.8e-3, 0.5), STEEL, magnet)


CASES = {
    "no current": lambda: Case(sector(), OperatingPoint(-22.5 * DEGREE)),
    "rated, whole edges": lambda: Case(sector(), OperatingPoint(-21 * DEGREE, RATED)),
    "more than a sector further": lambda: Case(sector(), OperatingPoint(219 * DEGREE, RATED)),
    "between two nodes": lambda: Case(sector(), OperatingPoint(-20.37 * DEGREE, RATED, 15 * DEGREE)),
    "overload": lambda: Case(sector(), OperatingPoint(-20.37 * DEGREE, 3.3 * RATED)),
    "one phase": lambda: Case(sector(), PhaseCurrents(-0.31, (120.0, -120.0, 0.0))),
    "radial magnets": lambda: Case(sector(magnetisation=RadialMagnetisation()), OperatingPoint(-0.36, RATED)),
    "single layer": lambda: Case(section_of(reference_machine(), COARSE, layers=1), OperatingPoint(-0.36, RATED)),
    "nine slots": lambda: Case(sector(slots=9, pole_pairs=4), OperatingPoint(0.2, RATED)),
    "other materials": lambda: Case(sector(), OperatingPoint(-0.36, RATED), other_materials()),
    "outer rotor": lambda: Case(other_kind(OUTRUNNER), PhaseCurrents(0.07, (30.0, -40.0, 10.0))),
    "V shape": lambda: Case(other_kind(V_SHAPE), PhaseCurrents(0.07, (300.0, -340.0, 40.0))),
    "two layers": lambda: Case(other_kind(TWO_LAYERS), PhaseCurrents(0.07, (300.0, -340.0, 40.0))),
    "consequent poles": lambda: Case(other_kind(CONSEQUENT), PhaseCurrents(0.07, (300.0, -340.0, 40.0))),
    "inset magnets": lambda: Case(other_kind(INSET), PhaseCurrents(0.07, (300.0, -340.0, 40.0))),
    "loaves": lambda: Case(other_kind(LOAVES), PhaseCurrents(0.07, (300.0, -340.0, 40.0))),
    "ribbed V": lambda: Case(other_kind(RIBBED), PhaseCurrents(0.07, (300.0, -340.0, 40.0))),
    "Halbach": lambda: Case(other_kind(HALBACH), PhaseCurrents(0.07, (30.0, -40.0, 10.0))),
    "spokes": lambda: Case(other_kind(SPOKE), PhaseCurrents(0.07, (300.0, -340.0, 40.0))),
    "reluctance": lambda: Case(other_kind(RELUCTANCE), PhaseCurrents(0.07, (300.0, -340.0, 40.0)), tolerance=THIN_IRON),
    "whole, with defects": lambda: Case(with_defects(), OperatingPoint(-0.36, RATED)),
}
ORDERS = {"P1": LINEAR, "P2": QUADRATIC}


@cache
def both(name: str, order: TriangleOrder) -> tuple:
    """Weak and fast solution of a case."""
    case = CASES[name]()
    fast = FieldModel(case.section, case.materials, NewtonSettings(case.tolerance), order).solve(case.point)
    weak = WeakForm(case.section, case.materials, case.point.angle, order)
    return weak.solve(case.point.ampere_turns(case.section), case.tolerance), fast


each = pytest.mark.parametrize(("name", "order"), [
    pytest.param(name, order, id=f"{name}, {label}") for name in CASES for label, order in ORDERS.items()
])  # fmt: skip


@each
def test_the_same_potential(name, order):
    weak, fast = both(name, order)
    assert_allclose(weak.a, fast.a, atol=SAME_POTENTIAL * np.abs(fast.a).max(), rtol=0)


@each
def test_the_same_flux_linkage(name, order):
    weak, fast = both(name, order)
    linkage = phase_flux_linkage(fast)
    assert_allclose(weak.flux_linkage, linkage, atol=SAME * np.abs(linkage).max(), rtol=0)


@each
def test_the_same_torque(name, order):
    """Relative to the rated torque where there is less: cogging is zero at some of these angles."""
    weak, fast = both(name, order)
    assert weak.torque == pytest.approx(arkkio_torque(fast), abs=SAME * max(55.5, abs(weak.torque)))


def test_the_states_are_not_trivial():
    """Iron far above the knee, torque and flux there: what the comparison says is about a loaded machine."""
    weak, _ = both("overload", QUADRATIC)
    assert weak.torque > 100 and np.abs(weak.flux_linkage).max() > 0.02


def test_an_iteration_that_does_not_end_says_so():
    section = sector()
    with pytest.raises(FieldSolutionError, match="asked for 1e-40"):
        WeakForm(section, MATERIALS, 0.0, LINEAR).solve(np.zeros(3), 1e-40)


def test_nothing_gives_nothing():
    demagnetised = replace(MATERIALS, magnet=Magnet(0.0))
    solution = WeakForm(sector(), demagnetised, 0.0, LINEAR).solve(np.zeros(3))
    assert not solution.a.any() and solution.torque == 0.0
