"""Many designs at once: as if each were alone, on a few meshes, and those that cannot be built are said so."""

from dataclasses import replace

import pytest

import magnetostatics.case as module
from optimisation.design import DesignSolver, Judge
from optimisation.states import AlignedTooth
from optimisation.torque import MeanTorque, NullTorque
from study.inputs_field import field_case
from study.read import read_study
from tests.optimisation.machines import machine_of

CASE = field_case(read_study("motorcycle"))
JUDGE = Judge(CASE, AlignedTooth(), CASE.nominal_density, NullTorque())
OUTER = 42.5e-3
SHARES = [(width, rotor) for rotor in (0.33, 0.35) for width in (0.05, 0.06, 0.07, 0.1)]
MACHINES = [machine_of(CASE.family, 12, OUTER, width * OUTER, rotor * OUTER) for width, rotor in SHARES]
IMPOSSIBLE = replace(MACHINES[0], rotor_outer_radius=OUTER)


@pytest.fixture(scope="module")
def drawn():
    return []


@pytest.fixture(scope="module")
def designs(drawn):
    original = module.mesh_cross_section

    def counted(machine, *others):
        drawn.append(machine)
        return original(machine, *others)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "mesh_cross_section", counted)
        yield DesignSolver(JUDGE).designs([*MACHINES[:3], IMPOSSIBLE, *MACHINES[3:]])


def test_they_come_in_the_order_given_and_what_cannot_be_built_is_none(designs):
    assert designs[3] is None
    assert [design.machine for design in designs if design] == MACHINES


def test_few_meshes_reach_them_all(designs, drawn):
    assert len(drawn) == 2 < len(MACHINES) / 2


def test_each_is_as_on_a_mesh_of_its_own(designs):
    for design in filter(None, designs):
        alone = JUDGE.judge(design.machine)
        assert design.torque == pytest.approx(alone.torque, rel=1e-3)
        assert design.tooth_aligned == pytest.approx(alone.tooth_aligned, rel=2e-3)


def test_the_torque_is_closer_to_that_of_a_fine_mesh_than_the_ring_average():
    machine = machine_of(CASE.family, 12, 57.5e-3, 0.06 * 57.5e-3, 0.41 * 57.5e-3)
    density = replace(CASE.density, longest_gap_edge=0.9)
    coarse = _with_density(density).judge(machine)
    fine = _with_density(replace(density, gap_edges=720, gap_layers=3, across_iron=3.0)).judge(machine)
    assert coarse.torque == pytest.approx(fine.torque, rel=1e-3)
    assert coarse.torque_ring != pytest.approx(fine.torque_ring, rel=2e-3)


def _with_density(density):
    return replace(JUDGE, case=replace(CASE, density=density))


def test_the_mean_starts_from_the_fields_of_the_similar_design():
    """Further states come out the same whether a similar design was solved before or not."""
    judge = replace(JUDGE, objective=MeanTorque(2))
    together = DesignSolver(judge).designs(MACHINES[:2])
    for design in together:
        assert design.torque == pytest.approx(judge.judge(design.machine).torque, rel=1e-3)
