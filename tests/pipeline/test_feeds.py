"""What feeds the match: results of the stages before it in the place of what the study states."""

import json

import pytest

from pipeline import feeds
from pipeline.feeds import fed, stated
from pipeline.stage import StageError
from study.read import read_study

REQUIRED = {
    "maximum_damping_kNs_per_m": 40.0, "force_rms_N": 310.0, "velocity_rms_m_per_s": 0.1, "power_rms_W": 40.0,
    "velocity_peak_m_per_s": 3.5, "force_peak_N": 2700.0, "velocity_at_force_peak_m_per_s": 1.6,
    "power_peak_W": 4700.0, "force_at_power_peak_N": 1400.0, "velocity_at_power_peak_m_per_s": 3.3,
}  # fmt: skip
LINKAGE = {
    "ratio_nominal_mm_per_rad": 161.0, "ratio_max_mm_per_rad": 167.0, "link_ab_length_mm": 195.0,
    "link_bc_length_mm": 52.0, "hardpoint_c_mm": [50.0, 140.0],
}  # fmt: skip


@pytest.fixture
def results(tmp_path, monkeypatch):
    monkeypatch.setattr(feeds, "results_folder", lambda study_id: tmp_path)
    (tmp_path / "requirements.json").write_text(json.dumps({"values": REQUIRED}))
    (tmp_path / "linkage.json").write_text(json.dumps({"section": LINKAGE}))
    return tmp_path


def test_computed_values_take_the_place_of_the_stated_ones(results):
    study = fed(read_study("motorcycle"))
    assert study.requirements.force_peak_N == 2700.0 and study.linkage.ratio_max_mm_per_rad == 167.0
    assert study.linkage.envelope_radius_max_mm == 60.0  # what the front does not decide stays
    assert fed(study) == study


def test_stated_feeds_leave_the_study_alone(results):
    study = read_study("motorcycle", ["chain.requirements=stated", "chain.linkage=stated"])
    assert fed(study) == study and stated(study) is None


def test_the_other_feed_is_what_the_study_states(results):
    own = read_study("motorcycle")
    other = stated(own)
    assert fed(other).requirements == own.requirements and fed(other).linkage == own.linkage
    assert stated(read_study("automotive")) is None  # states no requirement


def test_a_stage_that_has_not_run_is_named(results):
    (results / "linkage.json").unlink()
    with pytest.raises(StageError, match=r"linkage.json .* does not exist; run `make linkage`"):
        fed(read_study("motorcycle"))
