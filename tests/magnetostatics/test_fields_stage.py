"""The reference machine over half an electrical period, and fields that can be drawn without solving them again."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from figures.whole_field import null_field, whole_field
from geometry.family import Combination, MatchedMachine, StatedMachine
from magnetostatics.fields_stage import fields_stage, null_points
from magnetostatics.model import OperatingPoint
from magnetostatics.newton import NewtonSettings
from magnetostatics.probes import probe_reader
from magnetostatics.rotation import STATES, solve_rotation
from magnetostatics.torque import arkkio_torque
from pipeline.codec import decoded, encoded
from study.inputs_field import field_case
from study.read import read_study
from tasks import InThisProcess

CASE = field_case(read_study("motorcycle"))
NINE = CASE.family.machine(Combination(9, 10), back_iron_width=2.6e-3, rotor_outer_radius=17e-3)


@pytest.fixture(scope="module")
def found():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("magnetostatics.rotation.COGGING_STEPS", 2)
        patch.setattr("magnetostatics.arc._TOGETHER", 5)
        return fields_stage(CASE, StatedMachine(CASE.family.reference), MatchedMachine(NINE), InThisProcess())


def test_mean_ripple_and_cogging_of_the_reference(found):
    seen = found.rotation
    assert seen.mean_torque_per_length("nominal") == pytest.approx(55.67, rel=2e-3)
    assert 0.5 < seen.ripple("nominal") < 3.0 and seen.routes_apart("nominal") < 2e-3
    assert 0 < found.reference.torque_error < 0.2
    assert abs(seen.torque("no_current")[0]) < 1e-3, "no cogging with a magnet on a tooth"


@pytest.mark.parametrize("machine", (CASE.family.reference, NINE), ids=("12/10", "9/10"))
def test_half_a_period_stands_for_the_whole(machine, monkeypatch):
    """The other half as solved: every torque, and every probe in the same tooth beside the largest of them."""
    monkeypatch.setattr("magnetostatics.rotation.COGGING_STEPS", 1)
    model = CASE.model(machine, NewtonSettings(1e-9))
    monkeypatch.setattr("magnetostatics.arc.Arc.model", lambda arc: model)
    seen = solve_rotation("turn", CASE, machine, InThisProcess())
    period = seen.one_period.sel(state="nominal")
    count = seen.data.sizes["angle"]
    assert period.sizes["angle"] == 2 * count + 1
    assert float(period.angle[-1] - period.angle[0]) == pytest.approx(2 * np.pi / 5)
    for k in (count, count + 2, 2 * count):
        solution = model.solve(OperatingPoint(float(period.angle[k]), CASE.nominal_density, 0.0, CASE.packing))
        assert float(period.torque[k]) == pytest.approx(arkkio_torque(solution), rel=1e-6)
        probes = np.array(list(probe_reader(model).read(solution).values()))
        assert_allclose(period.flux_density[k], probes, rtol=0, atol=1e-6 * probes.max())


def test_every_angle_is_as_solved_alone(found):
    model, seen = CASE.model(CASE.family.reference), found.rotation
    for state, density in zip(STATES, (0.0, CASE.nominal_density, CASE.overload_density), strict=True):
        for k in (0, 4, 5, 11):
            point = OperatingPoint(float(seen.data.angle[k]), density, 0.0, CASE.packing)
            assert seen.torque(state)[k] == pytest.approx(arkkio_torque(model.solve(point)), rel=1e-4, abs=1e-3)


def test_probes_by_name(found):
    names = list(found.rotation.data.probe.values)
    assert {"tooth_0", "tooth_5", "back_iron_0"} <= set(names)
    assert 1.0 < float(found.rotation.data.flux_density.sel(state="nominal").max()) < 2.2


def test_kept_fields_are_drawn_as_if_just_solved(found):
    state = STATES.index("overload")
    solution = CASE.detailed_model(CASE.family.reference).solve(null_points(CASE, CASE.family.reference)[state])
    fresh, kept = whole_field(solution), null_field(found.reference, CASE, "overload")
    assert kept.description == fresh.description and kept.region.names == fresh.region.names
    assert kept.areas.sum() == pytest.approx(fresh.areas.sum())
    energies = [(np.hypot(*field.cell_flux_density) ** 2 * field.areas).sum() for field in (fresh, kept)]
    assert energies[0] == pytest.approx(energies[1], rel=2e-3)


def test_without_a_match_there_is_the_reference_alone(monkeypatch):
    monkeypatch.setattr("magnetostatics.rotation.COGGING_STEPS", 1)
    assert fields_stage(CASE, StatedMachine(CASE.family.reference), None, InThisProcess()).matched is None


def test_it_can_be_kept(found):
    datasets = []
    again = decoded(encoded(found, datasets), datasets)
    assert again.rotation.machine == found.rotation.machine
    assert again.matched.points == found.matched.points
    assert len(datasets) == 3
