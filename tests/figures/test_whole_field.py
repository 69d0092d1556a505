"""The whole machine put together from one sector."""

from math import pi

import numpy as np
import pytest

from figures.whole_field import describe, whole_field, whole_geometry
from magnetostatics.currents import CoilCurrents, PhaseCurrents
from magnetostatics.model import OperatingPoint
from units import DEGREE, MILLIMETRE

RADIUS = 42.5 * MILLIMETRE


@pytest.fixture(scope="module")
def half(half_machine):
    return whole_field(half_machine)


@pytest.mark.parametrize("name", ["half_machine", "full_machine"])
def test_the_copies_cover_the_whole_machine(name, request):
    field = whole_field(request.getfixturevalue(name))
    assert field.areas.sum() == pytest.approx(pi * RADIUS**2, rel=0.005)
    assert field.areas.min() > 0


def test_geometry_without_a_field_covers_it_too(full_machine):
    field = whole_geometry(full_machine.model.section, 0.3)
    assert field.areas.sum() == pytest.approx(pi * RADIUS**2, rel=0.005)
    assert not field.a.any()


def test_no_gap_and_no_overlap(half):
    """Every side belongs to two cells, but for those on the outer circle: stator and rotor meet at this angle too."""
    sides = np.sort(np.hstack([half.cells[[0, 1]], half.cells[[1, 2]], half.cells[[2, 0]]]), axis=0)
    pairs, count = np.unique(sides, axis=1, return_counts=True)
    assert set(count) == {1, 2}
    alone = pairs[:, count == 1]
    assert np.hypot(*half.points[:, alone]) == pytest.approx(RADIUS, rel=1e-9)


def test_slots_and_magnets_are_counted_round_the_machine(half):
    names = set(half.region.names)
    assert {f"slot_{k}_{side}" for k in range(12) for side in "RL"} <= names
    assert {f"magnet_{m}" for m in range(10)} <= names
    areas = [half.areas[half.region.cells_of(f"slot_{k}_R")].sum() for k in range(12)]
    assert areas == pytest.approx([areas[0]] * 12, rel=1e-9)


def test_slot_lies_between_its_teeth(half):
    centre = half.points[:, half.cells[:3]].mean(axis=1)
    for slot in (0, 7, 11):
        cells = half.region.cells_of(f"slot_{slot}_R")
        angle = np.angle(np.exp(1j * np.arctan2(centre[1, cells], centre[0, cells])).sum(), deg=True) % 360
        assert 30 * slot < angle < 30 * slot + 15


def test_magnet_turns_with_the_rotor(half):
    centre = half.points[:, half.cells[:3]].mean(axis=1)
    for magnet in (0, 6):
        cells = half.region.cells_of(f"magnet_{magnet}")
        angle = np.angle(np.exp(1j * np.arctan2(centre[1, cells], centre[0, cells])).sum(), deg=True)
        assert angle % 360 == pytest.approx((36 * magnet - 20.6) % 360, abs=0.01)


def test_potential_changes_sign_half_way_round(half):
    """12 slots, 10 poles: A at a point is minus A at the opposite point."""
    opposite = np.lexsort(np.round(-half.points / 1e-8)), np.lexsort(np.round(half.points / 1e-8))
    pairs = half.points[:, opposite[0]] + half.points[:, opposite[1]]
    met = np.hypot(*pairs) < 1e-7
    assert met.mean() > 0.9
    assert half.a[opposite[0]][met] == pytest.approx(-half.a[opposite[1]][met], abs=1e-12)


def test_same_field_as_the_machine_solved_as_a_whole(half, half_machine_as_a_whole):
    """Within what two triangulations of the same drawing differ by: gmsh need not repeat itself to the triangle."""
    whole = whole_field(half_machine_as_a_whole)
    for name in ("stator_iron", "slot_7_L", "magnet_8", "gap"):
        energy = [_square(field, name) for field in (half, whole)]
        assert energy[0] == pytest.approx(energy[1], rel=5e-3), name
    assert np.abs(half.a).max() == pytest.approx(np.abs(whole.a).max(), rel=1e-4)


def _square(field, name):
    cells = field.region.cells_of(name)
    return (field.areas[cells] * (field.cell_flux_density[:, cells] ** 2).sum(axis=0)).sum()


def test_flux_density_is_that_of_the_solver(half, half_machine):
    elements = half_machine.model.elements
    dx, dy = elements.gradient(half_machine.a)
    weight = elements.weights / elements.weights.sum(axis=0)
    stator = half_machine.model.section.mesh.subdomains["stator_iron"]
    mine = half.cell_flux_density[:, stator]
    assert mine[0] == pytest.approx((dy * weight).sum(axis=0)[stator], abs=1e-9)
    assert mine[1] == pytest.approx(-(dx * weight).sum(axis=0)[stator], abs=1e-9)


def test_averaging_stays_within_a_region(half):
    """Hot teeth beside cold copper: the nodes they share carry both values."""
    smooth, names = half.smooth, half.region.names
    copper = np.isin(smooth.region, [i for i, name in enumerate(names) if name.startswith("slot")])
    iron = smooth.region == names.index("stator_iron")
    in_copper, in_iron = np.unique(smooth.triangles[:, copper]), np.unique(smooth.triangles[:, iron])
    assert not np.intersect1d(in_copper, in_iron).size
    assert np.quantile(smooth.b[in_copper], 0.99) < 0.3
    assert smooth.b[in_iron].max() > 1.5


def test_operating_point_in_words():
    assert describe(OperatingPoint(-21 * DEGREE, 8.485e6)) == ("rotor at −21°, 8.485 A/mm² (peak), current angle 0°")
    assert describe(OperatingPoint(0.0)) == "rotor at 0°, no current"


def test_phase_and_coil_currents_in_words():
    found = describe(PhaseCurrents(0.0, (10.0, -5.0, -5.0), 7))
    assert found == "rotor at 0°, 70, −35, −35 ampere-turns in phases A, B, C"
    assert describe(PhaseCurrents(0.0, (0.0, 0.0, 0.0))) == "rotor at 0°, no current"
    assert describe(CoilCurrents(0.0, (3.0, -8.0))) == "rotor at 0°, coils with up to 8 ampere-turns"


def test_linear_elements_and_phase_currents_can_be_drawn(half_machine, half):
    """The same triangles with linear elements: the potential is refined, the fluxes are close to those of the finer."""
    model = half_machine.model.coarse_model
    turns = tuple(half_machine.point.ampere_turns(model.section))
    field = whole_field(model.solve(PhaseCurrents(half_machine.point.angle, turns)))
    assert field.a.shape == half.a.shape
    assert field.a.max() == pytest.approx(half.a.max(), rel=0.02)
