"""Every kind of rotor and stator: a sector against the whole machine, two routes to the torque, mirror symmetry, and
what cannot be built. Another assembly on the same mesh: ``test_weak_form``."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.checks import check_machine
from geometry.errors import GeometryError
from geometry.half_cell import MeshDensity
from geometry.kinds import ROTORS
from geometry.magnetisation import HalbachMagnetisation, RadialMagnetisation
from geometry.morph import Morpher
from geometry.parts import ComposedMachine
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.mesh_error import refined_model, refined_solution
from magnetostatics.newton import NewtonSettings
from magnetostatics.positions import torque_period
from magnetostatics.probes import probe_reader
from magnetostatics.sensitivity import sensitivities
from magnetostatics.torque import arkkio_torque, maxwell_torque
from magnetostatics.variations import Dimension
from tests.magnetostatics.other_machines import (
    CONSEQUENT,
    INSET,
    LOAVES,
    NAMED,
    OUTRUNNER,
    RELUCTANCE,
    RIBBED,
    SPOKE,
    STATOR,
    TWO_LAYERS,
    V_SHAPE,
    currents,
    model_of,
)

COARSE = MeshDensity(gap_edges=120, longest_gap_edge=2.5, gap_layers=2, across_iron=1.0)
FINE = MeshDensity(gap_edges=720, longest_gap_edge=1.0, gap_layers=3, across_iron=2.0)
AMPERE_TURNS = {
    "outrunner": 40.0, "V shape": 337.5, "inset": 300.0, "spoke": 300.0, "reluctance": 300.0, "two layers": 337.5,
    "loaves": 300.0, "consequent": 300.0, "ribbed V": 337.5, "Halbach": 40.0,
    "cut out": 300.0, "cut out, magnets": 337.5, "own": 300.0, "surface": 300.0,
}  # fmt: skip
ANGLE = 0.07  # rad


@lru_cache(maxsize=2)
def solved(name, density, **options):
    model = model_of(NAMED[name], density, settings=NewtonSettings(tolerance=3e-11), **options)
    return model.solve(currents(model, ANGLE, AMPERE_TURNS[name], 0.5, 1.0))


def test_every_kind_is_here():
    """And a rotor that is no kind of the package."""
    here = {type(machine.rotor) for machine in NAMED.values()}
    assert here == {*ROTORS.known.values(), type(NAMED["own"].rotor)}


@pytest.mark.parametrize("name", NAMED)
def test_a_sector_is_the_whole_machine(name):
    part, whole = solved(name, COARSE), solved(name, COARSE, whole=True)
    assert part.model.section.sectors > 1 == whole.model.section.sectors
    assert arkkio_torque(whole) == pytest.approx(arkkio_torque(part), rel=1e-10)
    assert_allclose(phase_flux_linkage(whole), phase_flux_linkage(part), rtol=1e-10)


@pytest.mark.parametrize("name", NAMED)
def test_two_routes_to_the_torque(name):
    found = solved(name, FINE)
    assert maxwell_torque(found) == pytest.approx(arkkio_torque(found), rel=2e-3)


ROUGH = MeshDensity(gap_edges=192, longest_gap_edge=10.0, gap_layers=2, across_iron=0.5)
ROUGHER = dict.fromkeys(("outrunner", "Halbach", "consequent", "surface", "inset"), replace(ROUGH, gap_edges=144))
ROUGHER |= dict.fromkeys(("spoke", "reluctance"), replace(ROUGH, gap_edges=96))
# Of the others each of three places of the rotor shows the order alone.
TWO_PLACES = ("V shape", "ribbed V", "cut out", "cut out, magnets", "surface")


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in NAMED if name != "own"])  # whose finest mesh takes half a minute
def test_order_of_convergence(name):
    """Torque by both routes and flux linkages at full current, the worst of them, against triangles of an eighth.

    At a corner of the iron the field is that of a wedge of air of an angle omega, and what is quadratic in it converges
    with h^(2 pi/omega): h^(4/3) at right angles, h at a thin tip, until the corner saturates; the chords of circles
    leave h^2. In two halvings, seen from the third, an error falls sevenfold with h, tenfold with h^(4/3), 21-fold
    with h^2.
    """
    rough = ROUGHER.get(name, ROUGH)
    model = model_of(NAMED[name], rough, settings=NewtonSettings(tolerance=3e-4))  # errors to two digits
    edge = 2 * np.pi / rough.edges_around(NAMED[name])  # the rotor stands on nodes of every mesh
    places = (1, 3) if name in TWO_PLACES else (2,)
    points = [currents(model, k * edge, AMPERE_TURNS[name], 0.5, 1.0) for k in places]
    found = [[torques_and_linkages(one) for one in level] for level in on_halved_triangles(model, points, 3)]
    *rough, fine = np.array(found)
    scale = np.abs(fine).mean(axis=0)
    scale[2:] = scale[2:].mean()
    errors = [np.sqrt((((one - fine) / scale) ** 2).mean(axis=0)).max() for one in rough]
    assert errors[0] > 7 * errors[2]
    assert errors[2] < 6e-3


def on_halved_triangles(model, points, times):
    """Solutions of the points on ever smaller triangles, each started from the one before."""
    found = [[model.solve(point) for point in points]]
    for _ in range(times):
        model = refined_model(model)
        found.append([refined_solution(one, model) for one in found[-1]])
    return found


def torques_and_linkages(solution):
    return arkkio_torque(solution), maxwell_torque(solution), *phase_flux_linkage(solution)


def test_consequent_poles_have_even_harmonics_that_alternating_ones_have_not():
    """Each coil of 12 slots and 8 poles sees magnets only; half a period later it sees iron."""
    for name, least, most in (("consequent", 0.01, 1.0), ("loaves", 0.0, 1e-9)):
        model = model_of(NAMED[name], COARSE, settings=NewtonSettings(tolerance=3e-11))
        pairs = model.section.machine.pole_pairs
        turn = [currents(model, 2 * np.pi / pairs * k / 6, 0.0, 0.0, 1.0) for k in range(6)]
        waves = np.abs(np.fft.rfft([phase_flux_linkage(model.solve(point))[0] for point in turn]))
        assert least <= waves[2] / waves[1] <= most


@pytest.mark.parametrize("name", ("consequent", "loaves"))
def test_what_the_rotor_sees_repeats_after_the_period_of_the_torque(name):
    """A sixth of an electrical period where north and south are alike, a third where they are not."""
    model = model_of(NAMED[name], COARSE, settings=NewtonSettings(tolerance=3e-11))
    pairs, period = model.section.machine.pole_pairs, torque_period(model.section.machine)
    assert period == pytest.approx(np.pi / 3 if name == "loaves" else 2 * np.pi / 3)
    angles = ANGLE + np.array([0.0, period / 2, period]) / pairs
    torques = [arkkio_torque(model.solve(currents(model, angle, 300.0, 0.5, 1.0))) for angle in angles]
    assert torques[2] == pytest.approx(torques[0], rel=1e-6)
    assert abs(torques[1] - torques[0]) > 1e-3 * abs(torques[0])


CHANGES = np.array([30.0, -30.0])  # steps of the derivative
DIMENSIONS = {
    "outrunner": ("arc_fraction", "magnet_length", "back_iron_width"),
    "Halbach": ("arc_fraction", "magnet_length"),
    "V shape": ("magnet_width", "tilt", "bridge"),
    "inset": ("arc_fraction", "magnet_length"),
    "spoke": ("magnet_length", "magnet_radius"),
    "reluctance": ("first_radius", "barrier_width", "bridge"),
    "two layers": ("outer_magnet_width", "inner_tip_depth", "outer_bridge"),
    "consequent": ("arc_fraction", "magnet_length"),
    "loaves": ("magnet_width", "base_distance"),
    "ribbed V": ("rib", "magnet_width", "bridge"),
    "cut out": ("slot_opening", "opening_depth"),  # of the stator: an outline has no dimensions
    "cut out, magnets": ("slot_opening", "opening_depth"),
    "surface": ("arc_fraction", "magnet_length"),
    "own": ("magnet_width", "iron_width", "bridge"),
}


@pytest.mark.parametrize(("name", "dimension"), [(name, one) for name, many in DIMENSIONS.items() for one in many])
def test_derivatives_of_moved_meshes_are_the_differences_of_solutions(name, dimension):
    """Torque, and flux linkages of all phases, at full current."""
    machine, found = NAMED[name], solved(name, COARSE)
    part = "rotor" if dimension in vars(machine.rotor) else "stator"
    value = getattr(getattr(machine, part), dimension)
    step = 3e-7 * value  # between the torque's bend, 1e-3 of the smallest slope over 1e-6, and rounding, 1e-3 over 1e-7

    def read(solution):
        return np.array([arkkio_torque(solution), *phase_flux_linkage(solution)])

    def drawn(change):
        return replace(machine, **{part: replace(getattr(machine, part), **{dimension: value + change})})

    variation = Dimension(Morpher(found.model.section), drawn, step)
    derivative = sensitivities(found, {"it": variation}, read)["it"]
    ends = [variation.at(found.model, found.point, change)[0].solve(found.point, found) for change in CHANGES * step]
    expected = (read(ends[0]) - read(ends[1])) / (60 * step)
    scale = np.array([abs(expected[0]), *[np.abs(expected[1:]).max()] * 3])
    assert (np.abs(derivative - expected) / scale).max() < 1e-3


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


@pytest.mark.parametrize("name", [name for name in NAMED if NAMED[name].rotor.magnets_per_pitch])
def test_cogging_turns_its_sign_with_the_angle(name):
    """Magnet and tooth face each other at zero, and the mesh is as symmetric as the machine."""
    model = model_of(NAMED[name], COARSE, settings=NewtonSettings(tolerance=3e-11))
    one, other = (arkkio_torque(model.solve(currents(model, angle, 0.0, 0.0, 1.0))) for angle in (ANGLE, -ANGLE))
    assert abs(one) > 1e-3
    assert other == pytest.approx(-one, rel=1e-6)


BRIDGES = MeshDensity(gap_edges=480, longest_gap_edge=2.5, gap_layers=2, across_iron=1.0)


def test_a_rib_shorts_some_of_the_magnets_flux():
    """Without current it carries B w, of which the phase lacks most in its 16 coils, for shorted magnets give more
    flux; the torque falls with it, and of half the rib by half as much."""
    found = [solved_v(rotor) for rotor in (V_SHAPE.rotor, *(replace(RIBBED.rotor, rib=w) for w in RIBS))]
    (linkage, torque, _), *ribbed = found
    lost = [(linkage - less, torque - weaker) for less, weaker, _ in ribbed]
    for width, (flux, fewer), (*_, probes) in zip(RIBS, lost, ribbed, strict=True):
        assert 2.0 < probes["rib_0"] < 2.4
        assert 0.5 < flux / (16 * probes["rib_0"] * width) < 1.0
        assert fewer > 0
    for one, other in zip(*lost, strict=True):
        assert one / other == pytest.approx(0.5, abs=0.1)


RIBS = 0.6e-3, 1.2e-3  # m


def solved_v(rotor):
    """Largest linkage without current, torque at full current in the mean of two angles, and the probes without."""
    model = model_of(replace(V_SHAPE, rotor=rotor), BRIDGES)
    idle = model.solve(currents(model, 0.0, 0.0, 0.0, 1.0))
    angles = np.radians(7.5) / 2 * np.arange(2)
    torques = [maxwell_torque(model.solve(currents(model, angle, 337.5, 0.5, 1.0))) for angle in angles]
    return np.abs(phase_flux_linkage(idle)).max(), np.mean(torques), probe_reader(model).read(idle)


NARROW = {
    "V shape": {"bridge": 2}, "ribbed V": {"bridge": 2, "rib": 1}, "two layers": {"inner_bridge": 2, "outer_bridge": 2},
    "reluctance": {f"layer_{k}_bridge": 2 for k in range(3)}, "outrunner": {}, "inset": {},
}  # fmt: skip


@pytest.mark.parametrize("name", NARROW)
def test_narrow_iron_of_the_rotor_is_probed_in_every_pole(name):
    """As many of each name as a pole has; saturated, without current by magnets and then alike on both sides."""
    model = model_of(NAMED[name], BRIDGES)
    read = probe_reader(model).read(model.solve(currents(model, 0.0, 900.0 if name == "reluctance" else 0.0, 0.8, 1.0)))
    rotor = {key: value for key, value in read.items() if not key.startswith(("tooth", "back_iron"))}
    poles = model.section.poles
    assert list(rotor) == [f"{key}_{k}" for key, count in NARROW[name].items() for k in range(poles * count)]
    for key, count in NARROW[name].items():
        values = [rotor[f"{key}_{k}"] for k in range(poles * count)]
        assert max(values) > 1.3
        assert name == "reluctance" or values == pytest.approx(values[:1] * len(values), rel=0.02)


TIGHT = {"inner_tip_depth": 69e-3, "outer_tilt": 1.2, "inner_magnet_width": 11e-3}
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
    "wide rib": (RIBBED, "rotor", {"rib": 13e-3}, "reduce magnet_width, or tip_depth or rib"),
    "no rib": (RIBBED, "rotor", {"rib": 0.0}, "rib must be a positive"),
    "bridge": (V_SHAPE, "rotor", {"bridge_end": 0.2}, "bridge_start and bridge_end"),
    "hole": (V_SHAPE, "rotor", {"hole_depth": 50e-3}, "hole_depth"),
    "all magnet": (INSET, "rotor", {"arc_fraction": 1.0}, "iron must stand between"),
    "big shaft": (INSET, "rotor", {"shaft_radius": 14e-3}, "shaft_radius"),
    "layers meet": (TWO_LAYERS, "rotor", {"outer_bridge_end": 0.3}, "holes of both layers meet"),
    "outer layer": (TWO_LAYERS, "rotor", {"outer_tip_depth": 67e-3}, "inner_tip_depth, outer_hole_depth"),
    "outer magnets": (TWO_LAYERS, "rotor", TIGHT, "into the hole of the"),
    "long inner": (TWO_LAYERS, "rotor", {"inner_magnet_width": 25e-3}, "reduce inner_magnet_width"),
    "wide loaves": (LOAVES, "rotor", {"magnet_width": 8.5e-3}, "wider than the flats"),
    "no loaf": (LOAVES, "rotor", {"base_distance": 15.2e-3}, "reduce base_distance"),
    "shaft in loaf": (LOAVES, "rotor", {"shaft_radius": 13e-3}, "cuts the flats"),
    "no iron pole": (CONSEQUENT, "rotor", {"arc_fraction": 1.9}, "nothing of the iron poles"),
    "thick magnets": (CONSEQUENT, "rotor", {"magnet_length": 11e-3}, "inside the shaft"),
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
