"""A machine with windings and materials for every kind of rotor: those of ``machines/``, and of the kinds that none of
them has one inside the stator of one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from math import pi
from pathlib import Path
from tempfile import TemporaryDirectory

from export.dxf import laminations, write_dxf
from geometry.magnetisation import PARALLEL, HalbachMagnetisation
from geometry.outline import Curve, outline_of
from geometry.outline_file import read_outline
from geometry.parts import ComposedMachine, Rotor
from geometry.rotors.bread_loaf_magnets import BreadLoafMagnets
from geometry.rotors.outline_magnets import OutlineMagnets
from geometry.rotors.ribbed_v_shape import RibbedVShape
from geometry.rotors.spoke import Spoke
from geometry.rotors.surface_magnets import SurfaceMagnets
from pipeline.modules import PROJECT
from study.machine_file import MachineFile, read_machine
from units import MILLIMETRE as mm

FILES = ("outrunner_9_12", "inset_ferrite_6_4", "prius_2004", "v2_48_8", "consequent_12_8", "synrm_48_4",
         "szesynrm_outline")  # fmt: skip
OWN_MACHINE = PROJECT / "examples" / "own_machine" / "assisted.toml"
INSIDE_OF_TWELVE_SLOTS = (
    SurfaceMagnets(8, 15.7 * mm, 2.5 * mm, 5.0 * mm, 0.85, PARALLEL),
    BreadLoafMagnets(8, 15.7 * mm, 12.8 * mm, 9.0 * mm, 5.0 * mm),
    Spoke(8, 15.7 * mm, 3.0 * mm, 6.0 * mm),
)


def drawn() -> Iterator[tuple[str, MachineFile]]:
    """Every kind of rotor, with parallel magnets."""
    for name in FILES:
        yield name, read_machine(name)
    v, twelve = read_machine("prius_2004"), read_machine("consequent_12_8")
    rib = RibbedVShape(rib=1.2 * mm, **vars(v.machine.rotor))
    yield "prius_2004, a rib between its magnets", _with_rotor(v, rib)
    yield cut_out_with_magnets()
    for rotor in INSIDE_OF_TWELVE_SLOTS:
        yield "consequent_12_8, another rotor", _with_rotor(twelve, rotor)


@cache
def cut_out_with_magnets() -> tuple[str, MachineFile]:
    """The Prius motor, its rotor by outlines of lamination and magnets."""
    found = read_machine("prius_2004")
    rotor = found.machine.rotor
    outline, magnets = read_back(found.machine, "lamination_rotor", "magnets")
    cut = OutlineMagnets(rotor.poles, outline, rotor.rim_radius, magnets=magnets, magnetised=(rotor.tilt - pi / 2,))
    return "prius_2004, cut out of its own outlines", _with_rotor(found, cut)


def halbach() -> tuple[str, MachineFile]:
    """The outrunner with magnets that turn their direction along the gap."""
    found = read_machine("outrunner_9_12")
    return "outrunner_9_12, Halbach", _with_rotor(
        found, replace(found.machine.rotor, magnetisation=HalbachMagnetisation())
    )


def own() -> tuple[str, MachineFile]:
    """A rotor that is no kind of the package, with bars of ferrite across its poles."""
    return "one's own", read_machine(OWN_MACHINE)


def _with_rotor(found: MachineFile, rotor: Rotor) -> MachineFile:
    return replace(found, machine=replace(found.machine, rotor=rotor))


def read_back(machine: ComposedMachine, *parts: str) -> tuple[tuple[Curve, ...], ...]:
    """Outlines as a workshop has them: drawn parts in DXF files, written and read back."""
    with TemporaryDirectory() as name:
        for file, layers in laminations(outline_of(machine)).items():
            write_dxf(Path(name) / file, layers)
        return tuple(read_outline(Path(name) / f"{part}.dxf") for part in parts)
