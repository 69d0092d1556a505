"""The JSON files that others read have the keys that were agreed."""

import json

from tests.workbench.toy_bench import LIBRARY, SpringModel, written
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.explain.diagnosis import diagnose
from workbench.models.model import Model
from workbench.report.as_json import comparison_json, diagnosis_json


def hidden(folder):
    campaign = read_campaign(written(folder, lambda x: 1e6 * x**3))
    return Model(SpringModel(), SpringModel().design(campaign.device)), campaign


def test_comparison_has_the_agreed_keys(tmp_path):
    content = json.loads(comparison_json(compare(*hidden(tmp_path / "c"), LIBRARY)))
    assert {"channels", "tolerance_pulls", "model", "views"} <= set(content)
    assert {
        "channel", "unit", "n", "rms_error", "rms_error_percent", "bias", "chi2_per_n", "held_out_chi2_per_n",
        "noise_floor",
    } <= set(content["channels"][0])  # fmt: skip


def test_diagnosis_has_the_agreed_keys(tmp_path):
    content = json.loads(diagnosis_json(diagnose(*hidden(tmp_path / "c"), LIBRARY)))
    assert {
        "verdict", "names", "probability", "ranking", "p_nothing_missing", "p_none_of_these", "p_something_remains",
        "abstention_power", "detection_limits", "next_measurements", "residual_signature", "seed", "wall_s",
    } <= set(content)  # fmt: skip
    assert 0.0 <= content["abstention_power"] <= 1.0
    assert {"value", "std", "low90", "high90", "unit"} == set(content["ranking"][0]["parameters"]["cubic"])
    assert {"channel", "regime", "orders", "exponents", "parity"} <= set(content["residual_signature"])
