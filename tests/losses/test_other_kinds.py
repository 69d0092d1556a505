"""Losses of machines of other kinds: symmetry against the whole period, wherever the magnets lie."""

from dataclasses import replace

import pytest

from geometry.cross_section import mesh_cross_section
from geometry.half_cell import MeshDensity
from losses.iron import iron_loss
from losses.loci import HALF_WAVE, WHOLE_PERIOD, finest_repetition, rotor_loci, solve_part, stator_loci
from losses.magnet import magnet_loss
from magnetostatics.model import FieldModel, OperatingPoint
from magnetostatics.newton import NewtonSettings
from materials.iron_loss import iron_loss_law
from study.machine_file import read_machine
from tests.losses.test_loci import same_loci

COARSE = {"outrunner_9_12": 144, "prius_2004": 192, "synrm_48_4": 192, "inset_ferrite_6_4": 144}  # whole edges a step
STEPS = 24  # so that the sixth harmonic has a rate
POINT = OperatingPoint(0.0, 6e6, 0.4, 0.3)


def model(name, edges=None, whole=False):
    read = read_machine(name)
    density = MeshDensity(gap_edges=edges or COARSE[name], longest_gap_edge=20.0, gap_layers=1, across_iron=1.0)
    section = mesh_cross_section(read.machine, read.layout, density, whole)
    return FieldModel(section, read.materials, NewtonSettings(tolerance=1e-10))


@pytest.mark.physics
@pytest.mark.parametrize("name", COARSE)
def test_symmetry_gives_the_loci_of_the_whole_period(name):
    """Two magnets a pole, none, and outside of the stator: each element finds the one that it is a copy of."""
    solved = model(name)
    whole = solve_part(solved, POINT, STEPS, WHOLE_PERIOD)
    for repetition in {finest_repetition(solved.section), HALF_WAVE}:
        part = solve_part(solved, POINT, STEPS, repetition)
        for loci in (stator_loci, rotor_loci):
            same_loci(loci(part), loci(whole), 1e-6)
        assert magnet_loss(part).eddy == pytest.approx(magnet_loss(whole).eddy, rel=1e-6)


@pytest.mark.physics
def test_pieces_of_a_buried_magnet_are_cut_across_it():
    """The magnet is 18.9 mm wide across its magnetisation; two pieces are half as wide each, and lose less."""
    part = solve_part(model("prius_2004"), POINT, STEPS)
    one, two = magnet_loss(part), magnet_loss(part, segments=2)
    assert one.width == pytest.approx(18.9e-3, rel=1e-6) and two.width == one.width / 2
    assert 0.2 * one.eddy < two.eddy < 0.9 * one.eddy


def test_without_magnets_nothing_is_lost_in_them():
    part = solve_part(model("synrm_48_4"), replace(POINT, current_angle=-0.8), 12)
    assert magnet_loss(part).eddy == 0.0 and magnet_loss(part).frequency_limit == float("inf")


@pytest.mark.physics
def test_poles_that_are_not_alike_have_no_symmetry_in_time():
    """Consequent poles: only a whole period repeats, of which a sector shows what the whole machine does; what half a
    period would make of the poles of iron is another loss."""
    sector, law = model("consequent_12_8", 192), iron_loss_law("M235-35A")
    assert finest_repetition(sector.section) == WHOLE_PERIOD
    part, whole = solve_part(sector, POINT, STEPS), solve_part(model("consequent_12_8", 192, whole=True), POINT, STEPS)
    for loci in (stator_loci, rotor_loci):
        losses = [iron_loss(loci(one), law).total.at(400.0) for one in (part, whole)]
        assert losses[1] == pytest.approx(losses[0], rel=1e-6) and losses[0] > 0
    assert magnet_loss(whole).eddy == pytest.approx(magnet_loss(part).eddy, rel=1e-6)
    halved = iron_loss(stator_loci(solve_part(sector, POINT, STEPS, HALF_WAVE)), law).total.at(400.0)
    assert abs(halved / iron_loss(stator_loci(part), law).total.at(400.0) - 1) > 0.02
