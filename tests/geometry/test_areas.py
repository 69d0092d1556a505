"""Areas of the parts in closed form against the meshed regions."""

from dataclasses import replace

import numpy as np
import pytest

from geometry.areas import part_areas
from geometry.cross_section import mesh_cross_section
from geometry.half_cell import MeshDensity
from geometry.machine import hanselman_machine
from geometry.outline import Arc, Contour, Line
from geometry.winding import star_of_slots
from study.machine_file import read_machine
from units import MILLIMETRE

THESIS = hanselman_machine(
    slots=12, pole_pairs=5, stator_outer_radius=42.5 * MILLIMETRE, rotor_outer_radius=15.7 * MILLIMETRE,
    back_iron_width=3.3 * MILLIMETRE, magnet_length=2.5 * MILLIMETRE, airgap=0.5 * MILLIMETRE,
    slot_opening=2.0 * MILLIMETRE, shoe_depth_fraction=0.52, shoe_aspect_ratio=1.0, shaft_radius=5.0 * MILLIMETRE,
)  # fmt: skip


FINE = MeshDensity(gap_edges=720, longest_gap_edge=0.5, across_iron=6)  # so that chords stand for arcs


def meshed(machine):
    """Areas [m^2] of the whole machine by part, from the mesh; those of the shaft and of the rotor core."""
    section = mesh_cross_section(machine, star_of_slots(machine.slots, machine.pole_pairs, 2), FINE)
    p, t = section.mesh.p, section.mesh.t
    (ax, ay), (bx, by), (cx, cy) = (p[:, t[k]] for k in range(3))
    area = np.abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2
    names = section.mesh.subdomains

    def sum_of(start):
        return section.sectors * sum(area[where].sum() for name, where in names.items() if name.startswith(start))

    return (
        {
            "stator_laminations": sum_of("stator_iron"),
            "half_slot": sum_of("slot_") / (2 * machine.slots),
            "magnets": sum_of("magnet_"),
        },
        sum_of("shaft"),
        sum_of("rotor_iron"),
    )


@pytest.mark.parametrize(
    "machine",
    [
        THESIS,
        replace(THESIS, magnet_arc_fraction=0.8),
        replace(THESIS, slots=9, tooth_width=7 * MILLIMETRE, stator_outer_radius=30 * MILLIMETRE),
        replace(THESIS, slot_opening=6 * MILLIMETRE, tooth_width=3 * MILLIMETRE, shoe_d2=0.4 * MILLIMETRE),
        replace(THESIS, slots=3, tooth_width=8 * MILLIMETRE, shoe_d2=0.5 * MILLIMETRE),
    ],
    ids=["thesis", "short magnets", "nine slots", "open slots", "taper that touches the shoe"],
)
def test_areas_are_those_of_the_meshed_regions(machine):
    found, (areas, shaft, core) = part_areas(machine), meshed(machine)
    for name, area in areas.items():
        assert getattr(found, name) == pytest.approx(area, rel=2e-3), name
    assert found.shaft + found.rotor_laminations == pytest.approx(shaft + core, rel=2e-3)
    assert found.shaft == pytest.approx(shaft, rel=2e-2)  # its circle is few chords


def test_the_parts_and_what_is_between_them_fill_the_circle():
    """Shaft, core and magnets are the rotor; laminations and slots with their openings the stator ring."""
    found, machine = part_areas(THESIS), THESIS
    rotor = found.shaft + found.rotor_laminations + found.magnets
    assert rotor == pytest.approx(np.pi * machine.rotor_outer_radius**2, rel=1e-12)
    moments = found.shaft_moment + found.rotor_laminations_moment + found.magnets_moment
    assert moments == pytest.approx(np.pi / 2 * machine.rotor_outer_radius**4, rel=1e-12)


NAMES = ("outrunner_9_12", "prius_2004", "synrm_48_4", "inset_ferrite_6_4", "v2_48_8", "consequent_12_8")


@pytest.mark.parametrize("name", NAMES)
def test_areas_of_every_kind_are_those_of_the_meshed_regions(name):
    """Iron, copper and magnets; a shaft that is not drawn is a circle."""
    machine = read_machine(name).machine
    found, (areas, shaft, core) = part_areas(machine), meshed(machine)
    for part, area in areas.items():
        assert getattr(found, part) == pytest.approx(area, rel=3e-3), part
    drawn = found.shaft if machine.rotor.bore_radius == 0 else 0.0
    assert found.rotor_laminations + drawn == pytest.approx(core + shaft, rel=3e-3)


def test_moments_of_a_circle_and_of_a_square_off_the_axis():
    """Steiner: of a circle pi R^2 (c^2 + R^2/2), of a square of side a a^2 (c^2 + a^2/6)."""
    radius, centre, side = 2.0, complex(5.0, -3.0), 1.4
    circle = Contour((Arc(radius, 0.3, 2.0, centre), Arc(radius, 2.3, 2 * np.pi - 2.0, centre)))
    assert circle.area == pytest.approx(np.pi * radius**2)
    assert circle.moment == pytest.approx(np.pi * radius**2 * (abs(centre) ** 2 + radius**2 / 2))
    corners = [centre + side / 2 * complex(x, y) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    square = Contour(tuple(Line(a, b) for a, b in zip(corners, corners[1:] + corners[:1])))
    assert square.area == pytest.approx(side**2)
    assert square.moment == pytest.approx(side**2 * (abs(centre) ** 2 + side**2 / 6))


def test_half_a_slot_is_that_of_any_side_alike():
    section = mesh_cross_section(THESIS, star_of_slots(12, 5, 2), FINE)
    corners = section.mesh.p[:, section.mesh.t[:, section.mesh.subdomains["slot_2_L"]]]
    (ax, ay), (bx, by), (cx, cy) = corners.transpose(1, 0, 2)
    area = np.abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)).sum() / 2
    assert section.half_slot_area == pytest.approx(area, rel=1e-12)
