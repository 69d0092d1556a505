"""What the diagnosis makes of what a campaign holds: bands, and one campaign."""

import json

import numpy as np
import pytest

from benchmarks.blind_campaigns import ANSWERS, Wanted, write_campaign
from benchmarks.information_used import bands, gained, singles


def test_bands_hold_what_they_say():
    seen = np.array([10.0, 25.0, 36.0, 100.0, 1000.0])
    found = list(bands(seen, seen + 2 * np.sqrt(seen)))
    assert [(row.chi2_from, row.campaigns) for row in found] == [(20.0, 2), (80.0, 1)]
    assert found[0].seen == pytest.approx(30.5) and found[0].gained == pytest.approx(41.5)
    assert [row.deviation for row in found] == pytest.approx([1.0, 1.0])
    assert found[1].share == pytest.approx(1.2)


def test_a_plain_effect_gains_about_what_can_be_seen_of_it(tmp_path):
    task = {"bench": "dq", "group": "single", "number": 78, "scored": True, "folder": str(tmp_path), "crime": False}
    name, answer = Wanted("dq", "single", 78, True).name, write_campaign(task)
    (tmp_path / "dq" / ANSWERS).write_text(json.dumps({name: answer}), encoding="utf-8")
    [(key, effect, seen)] = singles(tmp_path)
    assert effect == "torque_offset"
    assert abs(gained({"folder": str(tmp_path / key), "effect": effect}) - seen) < 3 * 2 * np.sqrt(seen)
