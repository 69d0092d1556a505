"""Both machines over one electrical period, and fields that can be drawn without solving them again."""

import numpy as np
import pytest

import magnetostatics.rotation_stage as module
from figures.whole_field import null_field, whole_field
from geometry.family import Combination, MatchedMachine, StatedMachine
from magnetostatics.model import OperatingPoint
from magnetostatics.rotation_stage import STATES, null_points, rotations_stage
from magnetostatics.torque import arkkio_torque
from pipeline.codec import decoded, encoded
from study.inputs_field import field_case
from study.read import read_study
from tasks import InThisProcess

CASE = field_case(read_study("motorcycle"))


@pytest.fixture(scope="module")
def found():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "_STEPS", 12)
        patch.setattr("magnetostatics.arc._TOGETHER", 5)
        machine = CASE.family.machine(Combination(9, 10), back_iron_width=2.6e-3, rotor_outer_radius=17e-3)
        return rotations_stage(CASE, StatedMachine(CASE.family.reference), MatchedMachine(machine), InThisProcess())


def test_mean_ripple_and_cogging_of_the_reference(found):
    seen = found.reference
    assert seen.mean_torque == pytest.approx(55.67, rel=2e-3)
    assert 0.5 < seen.ripple < 3.0 and seen.routes_apart < 2e-3
    assert 0 < seen.torque_error < 0.2


def test_the_last_angle_repeats_the_first(found):
    for seen in (found.reference, found.matched):
        assert seen.data.sizes["angle"] == 13
        assert float(seen.data.angle[-1] - seen.data.angle[0]) == pytest.approx(2 * np.pi / 5)
        assert float(seen.data.torque_ring[-1]) == pytest.approx(float(seen.data.torque_ring[0]), rel=1e-4)
        assert abs(float(seen.data.torque_no_current[0])) < 1e-3, "no cogging with a magnet on a tooth"


def test_every_angle_is_as_solved_alone(found):
    model = CASE.model(CASE.family.reference)
    for k in (0, 4, 5, 11):
        point = OperatingPoint(float(found.reference.data.angle[k]), CASE.nominal_density, 0.0, CASE.packing)
        assert float(found.reference.data.torque_ring[k]) == pytest.approx(arkkio_torque(model.solve(point)), rel=1e-4)


def test_probes_by_name(found):
    names = list(found.matched.data.probe.values)
    assert {"tooth_0", "tooth_8", "back_iron_0"} <= set(names) and len(names) == 18
    assert float(found.matched.data.flux_density.max()) < 2.2


def test_kept_fields_are_drawn_as_if_just_solved(found):
    state = STATES.index("overload")
    solution = CASE.detailed_model(CASE.family.reference).solve(null_points(CASE, CASE.family.reference)[state])
    fresh, kept = whole_field(solution), null_field(found.reference.fields, CASE, "overload")
    assert kept.description == fresh.description and kept.region.names == fresh.region.names
    assert kept.areas.sum() == pytest.approx(fresh.areas.sum())
    energies = [(np.hypot(*field.cell_flux_density) ** 2 * field.areas).sum() for field in (fresh, kept)]
    assert energies[0] == pytest.approx(energies[1], rel=2e-3)


def test_without_a_match_there_is_the_reference_alone(monkeypatch):
    monkeypatch.setattr(module, "_STEPS", 1)
    assert rotations_stage(CASE, StatedMachine(CASE.family.reference), None, InThisProcess()).matched is None


def test_it_can_be_kept(found):
    datasets = []
    again = decoded(encoded(found, datasets), datasets)
    assert again.reference.machine == found.reference.machine
    assert again.matched.fields.points == found.matched.fields.points
    assert len(datasets) == 4
