"""The files for the workshop and for other tools, read back by programs that did not write them."""

import json
from math import pi

import ezdxf
import gmsh
import numpy as np
import pytest
from ezdxf.units import MM

from drivetrain.masses import CopperBars, PartMaterials, part_masses
from electrical.synchronous_machine import SynchronousMachine
from export.dxf import laminations, write_dxf
from export.motulator import parameter_text
from export.step import active_parts, write_step
from geometry.outline import outline_of
from tests.geometry.test_outline import MACHINES

LENGTH = 0.0448  # m
SMALL = 1e-3  # what a mass may be off by
MATERIALS = PartMaterials(7650.0, 7500.0, 8890.0, 7800.0, 0.95)


@pytest.fixture(scope="module", params=MACHINES)
def machine(request):
    return MACHINES[request.param]


@pytest.fixture(scope="module")
def folder(machine, tmp_path_factory):
    path, outline = tmp_path_factory.mktemp("parts"), outline_of(machine)
    for name, layers in laminations(outline).items():
        write_dxf(path / name, layers)
    write_step(path / "active_parts.step", active_parts(outline), LENGTH)
    return path


@pytest.fixture(scope="module")
def masses(machine):
    return part_masses(machine, LENGTH, CopperBars(1e-5, 24, 0.01), MATERIALS)


class Gmsh:
    """A model of gmsh, empty at first."""

    def __enter__(self):
        gmsh.initialize(readConfigFiles=False, interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
        return gmsh.model.occ

    def __exit__(self, *_):
        gmsh.finalize()


# ---- DXF ------------------------------------------------------------------------------------------------------------


def contours_of(path):
    """Closed contours of a DXF as lists of LINE and ARC, or a single CIRCLE, as ezdxf takes them apart."""
    for entity in ezdxf.readfile(path).modelspace():
        if entity.dxftype() == "CIRCLE":
            yield [entity]
        else:
            assert entity.dxftype() == "LWPOLYLINE" and entity.closed
            yield list(entity.virtual_entities())


def area_by_gmsh(contours):
    """Areas [mm^2] that the contours enclose, the largest first."""
    with Gmsh() as occ:
        loops = [occ.addCurveLoop([_curve(occ, one) for one in curves]) for curves in contours]
        return sorted((occ.getMass(2, occ.addPlaneSurface([loop])) for loop in loops), reverse=True)


def _curve(occ, entity):
    if entity.dxftype() == "LINE":
        return occ.addLine(occ.addPoint(*entity.dxf.start), occ.addPoint(*entity.dxf.end))
    centre, radius = tuple(entity.dxf.center), entity.dxf.radius
    if entity.dxftype() == "CIRCLE":
        return occ.addCircle(*centre, radius)
    first, last = np.radians([entity.dxf.start_angle, entity.dxf.end_angle])
    return occ.addCircle(*centre, radius, angle1=first, angle2=last if last > first else last + 2 * pi)


def mass(area_mm2, density, share=1.0):
    return 1e-6 * area_mm2 * LENGTH * density * share


def test_every_drawing_passes_the_audit_and_is_in_millimetres(folder):
    for path in folder.glob("*.dxf"):
        drawing = ezdxf.readfile(path)
        assert not drawing.audit().has_errors and not drawing.audit().has_fixes
        assert drawing.units == MM and drawing.header["$INSUNITS"] == MM


def test_layers_say_what_lies_on_them(folder, machine):
    layers = {path.name: {one.dxf.layer for one in ezdxf.readfile(path).modelspace()} for path in folder.glob("*.dxf")}
    assert layers == {"lamination_stator.dxf": {"STATOR_LAMINATION"}, "lamination_rotor.dxf": {"ROTOR_LAMINATION"},
                      "magnets.dxf": {"MAGNETS"}}  # fmt: skip
    assert len(list(contours_of(folder / "magnets.dxf"))) == machine.poles


def test_masses_by_the_drawings_are_those_of_the_design(folder, masses):
    outer, slots = area_by_gmsh(contours_of(folder / "lamination_stator.dxf"))
    core, shaft = area_by_gmsh(contours_of(folder / "lamination_rotor.dxf"))
    magnets = area_by_gmsh(contours_of(folder / "magnets.dxf"))
    stack = MATERIALS.lamination_density, MATERIALS.stacking
    assert mass(outer - slots, *stack) == pytest.approx(masses.stator_laminations, rel=SMALL)
    assert mass(core - shaft, *stack) == pytest.approx(masses.rotor_laminations, rel=SMALL)
    assert mass(sum(magnets), MATERIALS.magnet_density) == pytest.approx(masses.magnets, rel=SMALL)
    assert mass(shaft, MATERIALS.shaft_density) == pytest.approx(masses.shaft, rel=SMALL)


def test_arcs_are_arcs_about_the_axis(folder, machine):
    """No chord stands for an arc: every ARC has a radius of the drawing, and there are as many as there should be."""
    (slots,) = [one for one in contours_of(folder / "lamination_stator.dxf") if len(one) > 1]
    arcs = [one for one in slots if one.dxftype() == "ARC"]
    radii = {round(1e3 * one, 9) for one in (machine.stator_inner_radius, machine.slot_bottom_radius)}
    radii |= {round(1e3 * machine.opening_top_radius, 9)} if machine.taper_touches_shoe else set()
    assert {round(one.dxf.radius, 9) for one in arcs} == radii
    assert len(arcs) == (4 if machine.taper_touches_shoe else 2) * machine.slots
    for one in arcs:
        assert one.dxf.center.magnitude < 1e-9


def test_the_same_outline_makes_the_same_bytes(folder, machine, tmp_path):
    outline = outline_of(machine)
    name, layers = next(iter(laminations(outline).items()))
    write_dxf(tmp_path / name, layers)
    assert (tmp_path / name).read_bytes() == (folder / name).read_bytes()


# ---- STEP -----------------------------------------------------------------------------------------------------------


def solids_of(path):
    """Volume [mm^3] and height [mm] of every solid by its name."""
    with Gmsh() as occ:
        gmsh.option.setNumber("Geometry.OCCImportLabels", 1)
        tags = [tag for dimension, tag in occ.importShapes(str(path)) if dimension == 3]
        occ.synchronize()
        names = {tag: gmsh.model.getEntityName(3, tag).rsplit("/", 1)[-1] for tag in tags}
        boxes = {tag: occ.getBoundingBox(3, tag) for tag in tags}
        return {names[tag]: (occ.getMass(3, tag), boxes[tag][5] - boxes[tag][2]) for tag in tags}


def test_volumes_are_area_times_length(folder, machine, masses):
    found = solids_of(folder / "active_parts.step")
    assert len(found) == 3 + machine.poles
    assert [height for _, height in found.values()] == pytest.approx([1e3 * LENGTH] * len(found), rel=1e-6)
    volume = {name: 1e-9 * one for name, (one, _) in found.items()}  # m^3
    iron = MATERIALS.lamination_density * MATERIALS.stacking
    assert iron * volume["stator stack"] == pytest.approx(masses.stator_laminations, rel=SMALL)
    assert iron * volume["rotor core"] == pytest.approx(masses.rotor_laminations, rel=SMALL)
    assert MATERIALS.shaft_density * volume["shaft"] == pytest.approx(masses.shaft, rel=SMALL)
    magnets = sum(one for name, one in volume.items() if name.startswith("magnet "))
    assert MATERIALS.magnet_density * magnets == pytest.approx(masses.magnets, rel=SMALL)


# ---- motulator ------------------------------------------------------------------------------------------------------


def test_the_parameters_make_the_same_machine_again():
    machine = SynchronousMachine(5, 6.6e-3, 9.9e-5, 1.06e-4, 0.015)
    idle = SynchronousMachine(5, 9.6e-3, 1.4e-4, 1.6e-4, 0.015)
    read = json.loads(parameter_text(machine, idle, "delta"))
    assert set(read["units"]) == set(read["full_current"]) == {"n_p", "R_s", "L_d", "L_q", "psi_f"}
    for name, one in (("full_current", machine), ("no_current", idle)):
        i, speed, keys = 80.0 - 30.0j, 200.0, read[name]  # currents i_q, i_d as one number
        psi = keys["L_d"] * i.imag + keys["psi_f"], keys["L_q"] * i.real
        torque = 1.5 * keys["n_p"] * (psi[0] * i.real - psi[1] * i.imag)
        assert torque == pytest.approx(one.torque(i.imag, i.real), rel=1e-12)
        volts = keys["R_s"] * i.imag - keys["n_p"] * speed * psi[1], keys["R_s"] * i.real + keys["n_p"] * speed * psi[0]
        assert volts == pytest.approx(one.voltage(i.imag, i.real, speed), rel=1e-12)
