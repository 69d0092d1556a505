"""Every kind of rotor and stator: a sector against the whole machine, two routes to the torque, mirror symmetry, and
what cannot be built. Another assembly on the same mesh: ``test_weak_form``."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.checks import check_machine
from geometry.errors import GeometryError
from geometry.half_cell import MeshDensity
from geometry.magnetisation import HalbachMagnetisation, RadialMagnetisation
from geometry.parts import ComposedMachine
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.newton import NewtonSettings
from magnetostatics.torque import arkkio_torque, maxwell_torque
from tests.magnetostatics.other_machines import (
    INSET,
    NAMED,
    OUTRUNNER,
    RELUCTANCE,
    SPOKE,
    STATOR,
    V_SHAPE,
    currents,
    model_of,
)

COARSE = MeshDensity(gap_edges=120, longest_gap_edge=2.5, gap_layers=2, across_iron=1.0)
FINE = MeshDensity(gap_edges=720, longest_gap_edge=1.0, gap_layers=3, across_iron=2.0)
AMPERE_TURNS = {"outrunner": 40.0, "V shape": 337.5, "inset": 300.0, "spoke": 300.0, "reluctance": 300.0}
ANGLE = 0.07  # rad


def solved(name, density, **options):
    model = model_of(NAMED[name], density, settings=NewtonSettings(tolerance=3e-11), **options)
    return model.solve(currents(model, ANGLE, AMPERE_TURNS[name], 0.5, 1.0))


@pytest.mark.parametrize("name", ["outrunner", "inset", "spoke", "reluctance"])
def test_a_sector_is_the_whole_machine(name):
    part, whole = solved(name, COARSE), solved(name, COARSE, whole=True)
    assert part.model.section.sectors > 1 == whole.model.section.sectors
    assert arkkio_torque(whole) == pytest.approx(arkkio_torque(part), rel=1e-9)
    assert_allclose(phase_flux_linkage(whole), phase_flux_linkage(part), rtol=1e-9)


@pytest.mark.parametrize("name", NAMED)
def test_two_routes_to_the_torque(name):
    found = solved(name, FINE)
    assert maxwell_torque(found) == pytest.approx(arkkio_torque(found), rel=2e-3)


def test_reluctance_turns_its_torque_with_one_current_and_keeps_it_with_both():
    """T(i_d, -i_q) = -T(i_d, i_q) with the rotor mirrored at the axis of phase A, T(-i_d, -i_q) = T(i_d, i_q)."""
    model = model_of(RELUCTANCE, COARSE, settings=NewtonSettings(tolerance=3e-11))
    beyond = 2 * model.section.layout.phase_axis / RELUCTANCE.pole_pairs - ANGLE
    states = ((ANGLE, 300.0, -0.8), (beyond, 300.0, 0.8 + np.pi), (ANGLE, -300.0, -0.8), (ANGLE, 0.0, 0.0))
    motor, mirrored, both, none = (arkkio_torque(model.solve(currents(model, *state, 1.0))) for state in states)
    assert motor > 10.0
    assert mirrored == pytest.approx(-motor, rel=1e-6)
    assert both == pytest.approx(motor, rel=1e-9)
    assert none == 0.0


@pytest.mark.parametrize("name", [name for name in NAMED if name != "reluctance"])
def test_cogging_turns_its_sign_with_the_angle(name):
    """Magnet and tooth face each other at zero, and the mesh is as symmetric as the machine."""
    model = model_of(NAMED[name], COARSE, settings=NewtonSettings(tolerance=3e-11))
    one, other = (arkkio_torque(model.solve(currents(model, angle, 0.0, 0.0, 1.0))) for angle in (ANGLE, -ANGLE))
    assert abs(one) > 1e-3
    assert other == pytest.approx(-one, rel=1e-6)


CANNOT_BE_BUILT = {
    "slot bottom": (OUTRUNNER, "stator", {"slot_bottom_radius": 2.0e-3}, "must rise from each to the next"),
    "wide teeth": (OUTRUNNER, "stator", {"tooth_width": 2.9e-3}, "reduce tooth_width"),
    "wide opening": (OUTRUNNER, "stator", {"slot_opening": 3.5e-3}, "reduce slot_opening"),
    "touching": (OUTRUNNER, "rotor", {"arc_fraction": 1.0}, "arc_fraction"),
    "little air": (OUTRUNNER, "rotor", {"air_radius": 9e-3}, "air_radius"),
    "deep slots": (V_SHAPE, "stator", {"side_depth": 60e-3}, "reduce side_depth"),
    "no teeth": (V_SHAPE, "stator", {"top_width": 11e-3}, "nothing of the teeth"),
    "no shoulder": (V_SHAPE, "stator", {"slot_opening": 5.5e-3}, "no shoulder"),
    "long magnets": (V_SHAPE, "rotor", {"magnet_width": 25e-3}, "into the bridge"),
    "bridge": (V_SHAPE, "rotor", {"bridge_end": 0.2}, "bridge_start and bridge_end"),
    "hole": (V_SHAPE, "rotor", {"hole_depth": 50e-3}, "hole_depth"),
    "all magnet": (INSET, "rotor", {"arc_fraction": 1.0}, "iron must stand between"),
    "big shaft": (INSET, "rotor", {"shaft_radius": 14e-3}, "shaft_radius"),
    "thick spokes": (SPOKE, "rotor", {"magnet_length": 6e-3}, "no iron is left"),
    "short spokes": (SPOKE, "rotor", {"magnet_radius": 15.69e-3}, "reduce magnet_radius"),
    "many layers": (RELUCTANCE, "rotor", {"layers": 5}, "into the shaft"),
    "no end": (RELUCTANCE, "rotor", {"first_radius": 3e-3}, "does not reach the bridge"),
    "meeting": (RELUCTANCE, "rotor", {"shaft_radius": 5e-3, "first_radius": 24e-3}, "neighbouring poles meet"),
    "nothing": (SPOKE, "rotor", {"magnet_length": -1e-3}, "must be a positive"),
}


@pytest.mark.parametrize("machine, part, change, words", CANNOT_BE_BUILT.values(), ids=CANNOT_BE_BUILT)
def test_what_cannot_be_built_is_said(machine, part, change, words):
    with pytest.raises(GeometryError, match=words):
        check_machine(replace(machine, **{part: replace(getattr(machine, part), **change)}))


def test_no_gap_is_said():
    with pytest.raises(GeometryError, match="no air gap"):
        check_machine(ComposedMachine(STATOR, replace(INSET.rotor, outer_radius=STATOR.bore_radius)))


def test_a_halbach_pattern_gathers_the_flux_on_the_side_of_the_gap():
    """Inside of a cup as outside of a core: more linkage than of radial magnets."""

    def linkage(magnetisation):
        rotor = replace(OUTRUNNER.rotor, magnetisation=magnetisation, arc_fraction=0.95)
        model = model_of(replace(OUTRUNNER, rotor=rotor), replace(COARSE, gap_edges=144))
        return np.abs(phase_flux_linkage(model.solve(currents(model, 0.0, 0.0, 0.0, 1.0)))).max()

    assert linkage(HalbachMagnetisation()) > 1.08 * linkage(RadialMagnetisation())
