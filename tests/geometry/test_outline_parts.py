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
from geometry.rotors.outline_magnets import OutlineMagnets
from geometry.rotors.outline_rotor import OutlineRotor
from magnetostatics.currents import PhaseCurrents
from magnetostatics.torque import maxwell_torque
from study.machine_file import MACHINES, read_machine
from tests.magnetostatics.other_machines import (
    LOAVES,
    RELUCTANCE,
    TWO_LAYERS,
    V_SHAPE,
    currents,
    model_of,
    section_of,
)

DENSITY = MeshDensity(gap_edges=480, longest_gap_edge=2.5, gap_layers=2, across_iron=5.0)


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """The rotor lamination of a machine whose barriers are known, as a file."""
    path = tmp_path_factory.mktemp("outline") / "rotor.dxf"
    write_dxf(path, laminations(outline_of(RELUCTANCE))["lamination_rotor.dxf"])
    return path


def test_an_exported_rotor_comes_back(exported):
    rotor = OutlineRotor(4, read_outline(exported), RELUCTANCE.rotor.outer_radius)
    again = replace(RELUCTANCE, rotor=rotor)
    rotor.check()
    assert part_areas(again).rotor_laminations == pytest.approx(part_areas(RELUCTANCE).rotor_laminations, rel=1e-6)
    torques = []
    for machine in (RELUCTANCE, again):
        model = model_of(machine, DENSITY)
        torques.append(maxwell_torque(model.solve(currents(model, 0.07, 300.0, -0.8, 1.0))))
    assert torques[1] == pytest.approx(torques[0], rel=5e-3), "meshed otherwise"


RETURNING = {
    "V shape": (V_SHAPE, (V_SHAPE.rotor.tilt - pi / 2,), 337.5),
    "two layers": (TWO_LAYERS, tuple(layer.tilt - pi / 2 for layer in TWO_LAYERS.rotor.layers), 337.5),
    "loaves": (LOAVES, (0.0,), 300.0),
}


@pytest.fixture(params=RETURNING)
def returning(request, tmp_path):
    """A machine, its rotor from the files that are cut by, and ampere-turns of a coil."""
    machine, magnetised, current = RETURNING[request.param]
    for name, layers in laminations(outline_of(machine)).items():
        write_dxf(tmp_path / name, layers)
    outline, magnets = (read_outline(tmp_path / f"{name}.dxf") for name in ("lamination_rotor", "magnets"))
    poles, radius = machine.rotor.poles, machine.rotor.outer_radius
    again = replace(machine, rotor=OutlineMagnets(poles, outline, radius, magnets=magnets, magnetised=magnetised))
    return machine, again, current


def test_exported_magnets_come_back(returning):
    """Areas, where each magnet lies, and the torque of a mesh of its own."""
    machine, again, current = returning
    again.rotor.check()
    assert part_areas(again).rotor_laminations == pytest.approx(part_areas(machine).rotor_laminations, rel=1e-6)
    assert part_areas(again).magnets == pytest.approx(part_areas(machine).magnets, rel=1e-6)
    torques = []
    for one in (machine, again):
        model = model_of(one, DENSITY)
        torques.append(maxwell_torque(model.solve(currents(model, 0.07, current, 0.5, 1.0))))
    assert torques[1] == pytest.approx(torques[0], rel=5e-3), "meshed otherwise"


@pytest.mark.parametrize(
    "changes, words",
    [
        ({"magnetised": (-0.3, 0.2)}, "has 1 magnets and magnetised 2 directions"),
        ({"magnetised": (0.0,)}, "one beside the axis is not"),
        ({"magnets": ()}, "has 0 magnets"),
    ],
    ids=["directions", "along the axis", "none"],
)
def test_what_is_wrong_with_magnets_is_said(tmp_path, changes, words):
    for name, layers in laminations(outline_of(V_SHAPE)).items():
        write_dxf(tmp_path / name, layers)
    outline, magnets = (read_outline(tmp_path / f"{name}.dxf") for name in ("lamination_rotor", "magnets"))
    rotor = OutlineMagnets(8, outline, V_SHAPE.rotor.outer_radius, magnets=magnets, magnetised=(-0.3,))
    with pytest.raises(GeometryError, match=words):
        replace(rotor, **changes).check()


def test_a_file_states_outlines_of_magnets(tmp_path):
    text = (MACHINES / "prius_2004.toml").read_text(encoding="utf-8").replace('"curves/', f'"{MACHINES}/curves/')
    for name, layers in laminations(outline_of(V_SHAPE)).items():
        write_dxf(tmp_path / name, layers)
    rotor = """[rotor]
kind = "outline_magnets"
poles = 8
outline = "lamination_rotor.dxf:ROTOR_LAMINATION"
magnets = "magnets.dxf:MAGNETS"
magnetised_deg = [-17.46331]
outer_radius_mm = 80.2

"""
    path = tmp_path / "cut.toml"
    path.write_text(text[: text.index("[rotor]")] + rotor + text[text.index("[winding]") :])
    found = read_machine(path).machine
    assert found.rotor.magnets_per_pitch == 2
    assert part_areas(found).magnets == pytest.approx(part_areas(V_SHAPE).magnets, rel=1e-5)


def test_a_laminate_of_a_laboratory_closes_and_fills_its_pitch():
    """Lines and arcs in any order; what they bound in half a pitch is all of it."""
    outline = [one.turned(-pi / 4) for one in read_outline(MACHINES / "outlines" / "SzESynRM_rotor.dxf")]
    faces = cut_out(outline, (0.0, pi / 4), (84e-3,))
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
        ({"axis": 0.1}, "half a pitch of the outline has 2 pieces of iron"),
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
    rotor.check()
    with pytest.raises(GeometryError, match="differ by .* of their iron.* repeats_after = 2"):
        replace(rotor, repeats_after=1).check()
    replace(rotor, repeats_after=1, unequal=0.03).check()
    with pytest.raises(GeometryError, match="1 or 2 poles, found 3"):
        replace(rotor, repeats_after=3).check()


def test_two_unlike_poles_with_all_alike_are_one(exported):
    """Drawn from the other mirror line and twice as far: the same lamination, the same torque in both directions."""
    one = OutlineRotor(4, read_outline(exported), RELUCTANCE.rotor.outer_radius)
    machines = [replace(RELUCTANCE, rotor=rotor) for rotor in (one, replace(one, repeats_after=2))]
    assert machines[1].sectors == 2 and not machines[1].is_antiperiodic and machines[1].half_wave
    between = [replace(machine, stator=replace(machine.stator, slots=30)).half_wave for machine in machines]
    assert between == [True, False]  # a pole further on is between two slots
    areas = [part_areas(machine).rotor_laminations for machine in machines]
    assert areas[1] == pytest.approx(areas[0], rel=1e-9)
    models = [model_of(machine, DENSITY) for machine in machines]
    for point in (PhaseCurrents(0.07, (300.0, -280.0, -20.0)), PhaseCurrents(0.2, (-100.0, 300.0, -200.0))):
        one_pole, two_poles = (maxwell_torque(model.solve(point)) for model in models)
        assert two_poles == pytest.approx(one_pole, rel=3e-3), "meshed otherwise"


def test_holes_on_the_axis_of_a_pole_are_no_iron():
    """The rotor of a laboratory, two unlike poles at once: its mesh fills the disc once, the iron of its outline."""
    machine = read_machine("szesynrm").machine
    section = section_of(machine, MeshDensity(gap_edges=192, gap_layers=1, across_iron=1.0))
    mesh = section.mesh
    sides = mesh.p[:, mesh.t[1:]] - mesh.p[:, mesh.t[:1]]
    areas = 0.5 * (sides[0, 0] * sides[1, 1] - sides[0, 1] * sides[1, 0])
    assert areas.sum() == pytest.approx(pi * 0.12**2 / 2, rel=2e-3) and section.sectors == 2
    rotor = areas[mesh.subdomains["rotor_iron"]].sum()
    assert rotor == pytest.approx(part_areas(machine).rotor_laminations / 2, rel=2e-3)
    narrow, wide = 1673.1e-6, 1711.9e-6  # m^2, of half poles, by the faces of each alone
    assert part_areas(machine).rotor_laminations == pytest.approx(4 * (narrow + wide), rel=1e-3)
