"""Every kind of rotor against what NGSolve found on the same triangles (``python -m benchmarks.other_kinds``)."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.airgap_run import solve_cold
from benchmarks.comparison import EXACT
from benchmarks.drawn_kinds import halbach, own
from benchmarks.other_kinds import TABLE, case_of, machines
from geometry.kinds import ROTORS
from geometry.magnetisation import RadialMagnetisation
from study.machine_file import read_machine

MACHINES = tuple(machines())
WITHIN = 1e-5  # relative


def table():
    with open(TABLE, encoding="utf-8", newline="") as file:
        return {(row["kind"], row["machine"]): row for row in csv.DictReader(file)}


def test_every_kind_was_compared():
    """And Halbach magnets and a rotor of one's own."""
    kinds = {kind.__name__ for kind in ROTORS.known.values()} | {type(own()[1].machine.rotor).__name__}
    assert {kind for kind, _ in table()} == kinds
    assert halbach()[0] in {name for _, name in table()}


def test_both_codes_agree():
    for row in table().values():
        assert abs(float(row["torque_Nm_per_m"])) > 0.1
        assert max(float(value) for name, value in row.items() if name.endswith("difference")) < WITHIN


@pytest.mark.parametrize(("name", "found"), MACHINES, ids=[type(found.machine.rotor).__name__ for _, found in MACHINES])
def test_torque_is_still_that_of_the_other_code(name, found):
    case = case_of(found)
    row = table()[type(found.machine.rotor).__name__, name]
    assert case.section.mesh.nelements == int(row["triangles"])
    assert solve_cold(case, EXACT).torque == pytest.approx(float(row["torque_Nm_per_m"]), rel=WITHIN)


@pytest.mark.parametrize(("name", "grounded"), [("outrunner_9_12", {0.02}), ("prius_2004", {0.05532, 0.13462})])
def test_the_potential_is_zero_on_the_circles_that_the_parts_name(name, grounded):
    case = case_of(read_machine(name), "P1")
    radius = np.hypot(*case.mesh.points[case.mesh.outer].T)
    assert set(np.round(radius, 9).ravel().tolist()) == grounded


def test_magnets_that_are_not_parallel_are_refused_where_one_vector_is_told():
    found = read_machine("outrunner_9_12")
    radial = replace(found.machine.rotor, magnetisation=RadialMagnetisation())
    case = case_of(replace(found, machine=replace(found.machine, rotor=radial)))
    with pytest.raises(ValueError, match="parallel magnets"):
        _ = case.remanences
