"""``airgap turn``: what it prints and writes, on coarse meshes, and wrong input."""

import csv
from dataclasses import replace
from math import cos, pi

import numpy as np
import pytest

from geometry.cross_section import mesh_cross_section
from geometry.magnetisation import PARALLEL
from geometry.rotors.surface_magnets import SurfaceMagnets
from magnetostatics.model import FieldModel
from magnetostatics.turn import Supply, turned
from pipeline.modules import PROJECT
from pipeline.turn_command import COLUMNS
from study.machine_file import MACHINES, read_machine
from tests.command_line import airgap

OWN = PROJECT / "examples/own_rotor/bread_loaf.toml"


@pytest.fixture(scope="module")
def coarse(tmp_path_factory):
    """The outrunner on a coarse mesh."""
    path = tmp_path_factory.mktemp("machine") / "coarse.toml"
    text = (MACHINES / "outrunner_9_12.toml").read_text(encoding="utf-8")
    text = text.replace("= 720", "= 120").replace("elements_across_iron = 3.0", "elements_across_iron = 1.0")
    path.write_text(text.replace('"curves/', f'"{MACHINES}/curves/'), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def rows(coarse, tmp_path_factory):
    path = tmp_path_factory.mktemp("turn") / "turn.csv"
    done = airgap("turn", coarse, "--current-A", 5, "--positions", 6, "--span-deg", 20, "--csv", path)
    assert done.returncode == 0, done.stderr
    assert "Outrunner" in done.stdout and "torque, mean" in done.stdout and "fundamental" not in done.stdout
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_a_row_for_every_position(rows):
    assert tuple(rows[0]) == COLUMNS
    assert [float(row["angle_deg"]) for row in rows] == pytest.approx(np.arange(6) * 20 / 6)


def test_torque_of_the_stack_is_that_of_its_flux_linkages(rows):
    """T = 1.5 p psi_d i_q without current in the d axis, on the mean; no route to the torque knows of the other."""
    torque = np.mean([float(row["torque_Nm"]) for row in rows])
    assert torque == pytest.approx(1.5 * 6 * np.mean([float(row["psi_d_Wb"]) for row in rows]) * 5.0, rel=0.01)
    assert torque == pytest.approx(np.mean([float(row["torque_by_fluxes_Nm"]) for row in rows]), rel=0.01)


def test_fundamental_of_a_period_and_picture(coarse, tmp_path):
    done = airgap("turn", coarse, "--positions", 12, "--png", tmp_path / "field.png")
    assert done.returncode == 0 and "fundamental of a phase 0.27" in done.stdout
    assert (tmp_path / "field.png").read_bytes()[:4] == b"\x89PNG"


@pytest.mark.parametrize(
    "arguments, words",
    (
        (("--current-A", "nan"), "--current-A must be a finite number"),
        (("--span-deg", "inf"), "--span-deg must be a finite number"),
        (("--positions", "0"), "--positions must be 1 or more"),
        (("--csv", "no/such/folder/x.csv"), "does not exist"),
    ),
)
def test_wrong_input_is_one_sentence_and_exit_code_2(coarse, arguments, words):
    done = airgap("turn", coarse, "--positions", "1", *arguments)
    assert done.returncode == 2 and words in done.stderr and len(done.stderr.strip().splitlines()) == 1


def test_a_rotor_of_ones_own():
    """55 lines of Python beside a file: its flux lies between those of round magnets as thin and as thick as it is."""
    done = airgap("turn", OWN, "--positions", 1)
    assert done.returncode == 0 and "Bread-loaf" in done.stdout
    linkage = float(done.stdout.split("mean  d ")[1].split()[0])
    own = read_machine(OWN)
    rotor = own.machine.rotor
    thin, thick = (1e3 * round_magnets(own, base) for base in (rotor.flat_distance / cos(pi / 10), rotor.flat_distance))
    assert thin < linkage < thick


def round_magnets(own, core):
    """Flux linkage of the d axis [Wb] with round magnets on a core of this radius [m]."""
    outer = own.machine.rotor.outer_radius
    rotor = SurfaceMagnets(10, outer, outer - core, 5e-3, 1.0, PARALLEL)
    section = mesh_cross_section(replace(own.machine, rotor=rotor), own.layout, own.density)
    model = FieldModel(section, own.materials)
    return turned(model, Supply(0.0, 0.0, own.turns), own.active_length, [0.0]).dq_linkage[0, 0]
