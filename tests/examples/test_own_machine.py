"""A rotor outside of the package is a short class, and its machine does what its page says."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.drawn_kinds import OWN_MACHINE as FILE
from geometry.cross_section import mesh_cross_section
from geometry.errors import GeometryError
from geometry.kinds import ROTORS
from geometry.moves import moved
from geometry.parts import part_units
from magnetostatics.model import FieldModel
from magnetostatics.turn import Supply, turned
from study.machine_file import read_machine
from units import DEGREE, MILLIMETRE

OWN = read_machine(FILE)
PAGE = FILE.with_name("README.md").read_text(encoding="utf-8")
POSITIONS = 10


def torque(found, gamma):
    """Means over 30 degrees by both routes at 20 A [Nm]; gamma: [deg]."""
    model = FieldModel(mesh_cross_section(found.machine, found.layout, found.density), found.materials)
    supply = Supply(20.0, gamma * DEGREE, found.equivalent_turns)
    one = turned(model, supply, found.active_length, (30 * DEGREE * np.arange(POSITIONS) / POSITIONS).tolist())
    return one.torque.mean(axis=0)


def test_it_is_sixty_lines_and_no_kind_of_the_package():
    assert len(FILE.with_name("assisted.py").read_text(encoding="utf-8").splitlines()) <= 60
    assert type(OWN.machine.rotor).__name__ not in {kind.__name__ for kind in ROTORS.known.values()}


@pytest.mark.parametrize(("name", "gamma"), [("synrm_48_4", -30), (FILE, 60)])
def test_torque_of_the_page_by_two_routes(name, gamma):
    ring, fluxes = torque(read_machine(name), gamma)
    assert ring == pytest.approx(fluxes, rel=5e-4)
    assert f"{ring:.1f} Nm | {gamma}°" in PAGE


def test_best_dimensions_of_the_page():
    best = moved(OWN.machine, OWN.search.moves, np.array([2.0, 0.3578, -1.5695]) * MILLIMETRE)
    assert f"{torque(replace(OWN, machine=best), 57)[0]:.1f} Nm | 57°" in PAGE


@pytest.mark.parametrize(
    ("change", "words"),
    [({"depth": 13e-3}, "enlarge depth"), ({"magnet_width": 40e-3}, "enlarge depth"), ({"layers": 4}, "reduce layers")],
)
def test_what_cannot_be_built_names_the_dimension_to_move(change, words):
    with pytest.raises(GeometryError, match=words):
        replace(OWN.machine.rotor, **change).check()


def test_dimensions_have_units():
    assert part_units(type(OWN.machine.rotor))["iron_width"] == "mm"
