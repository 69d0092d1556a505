"""Parts cut out of outlines: those that were exported before come back, those of a laboratory close."""

from dataclasses import replace
from math import pi

import pytest

from export.dxf import laminations, write_dxf
from geometry.areas import part_areas
from geometry.arrangement import cut_out, is_inside
from geometry.errors import GeometryError
from geometry.half_cell import MeshDensity
from geometry.outline import outline_of
from geometry.outline_file import read_outline
from geometry.rotors.outline_rotor import OutlineRotor
from magnetostatics.torque import maxwell_torque
from study.machine_file import MACHINES, read_machine
from tests.magnetostatics import other_machines
from tests.magnetostatics.other_machines import RELUCTANCE, currents, model_of

DENSITY = MeshDensity(gap_edges=480, longest_gap_edge=2.5, gap_layers=2, across_iron=5.0)


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """The rotor lamination of a machine whose barriers are known, as a file."""
    path = tmp_path_factory.mktemp("outline") / "rotor.dxf"
    write_dxf(path, laminations(outline_of(RELUCTANCE))["lamination_rotor.dxf"])
    return path


def test_an_exported_rotor_comes_back(exported, monkeypatch):
    rotor = OutlineRotor(4, read_outline(exported), RELUCTANCE.rotor.outer_radius)
    again = replace(RELUCTANCE, rotor=rotor)
    rotor.check()
    assert part_areas(again).rotor_laminations == pytest.approx(part_areas(RELUCTANCE).rotor_laminations, rel=1e-6)
    monkeypatch.setitem(other_machines.PITCHES, again, other_machines.PITCHES[RELUCTANCE])
    torques = []
    for machine in (RELUCTANCE, again):
        model = model_of(machine, DENSITY)
        torques.append(maxwell_torque(model.solve(currents(model, 0.07, 300.0, -0.8, 1.0))))
    assert torques[1] == pytest.approx(torques[0], rel=5e-3), "meshed otherwise"


def test_a_laminate_of_a_laboratory_closes_and_fills_its_pitch():
    """Lines and arcs in any order; what they bound in half a pitch is all of it."""
    outline = [one.turned(-pi / 4) for one in read_outline(MACHINES / "outlines" / "SzESynRM_rotor.dxf")]
    faces = cut_out(outline, pi / 4, (84e-3,))
    assert sum(face.contour.area for face in faces) == pytest.approx(pi / 8 * 84e-3**2, rel=1e-9)
    assert sum(is_inside(outline, face.inside) for face in faces) == 1 and len(faces) == 6


def test_a_stator_of_a_laboratory():
    stator = read_machine("szesynrm_outline").machine.stator
    inner, outer = stator.slot_radii
    assert inner == pytest.approx(85.65e-3, abs=0.05e-3) and outer == pytest.approx(107.5e-3, abs=0.05e-3)
    assert 5e-3 < stator.probed_tooth_width < 7e-3


@pytest.mark.parametrize(
    "changes, words",
    [
        ({"outer_radius": 0.043}, "reaches 42.000 mm from the axis and outer_radius is 43.000 mm"),
        ({"axis": 0.1}, "half a pole of the outline has 2 pieces of iron"),
        ({"outline": "open"}, "does not close at x|pieces of iron|differ by"),
    ],
    ids=["radius", "axis", "open"],
)
def test_what_is_wrong_is_said(exported, changes, words):
    outline = read_outline(exported)
    face = max((one for one in outline if abs(one.centre) > 0.01), key=lambda one: one.length)
    if changes.get("outline") == "open":
        changes = {"outline": tuple(one for one in outline if one is not face)}
    rotor = replace(OutlineRotor(4, outline, RELUCTANCE.rotor.outer_radius), **changes)
    with pytest.raises(GeometryError, match=words):
        rotor.check()


def test_poles_that_differ_are_allowed_only_where_it_is_said():
    rotor = read_machine("szesynrm_outline").machine.rotor
    with pytest.raises(GeometryError, match="differ by .* of their iron"):
        replace(rotor, unequal=1e-3).check()
