"""Loops of another integrator through the workbench: what is left out of the model of the device is named.

The campaigns are those that ``python -m benchmarks.loop_diagnosis`` wrote.
"""

from pathlib import Path

import pytest

from benchmarks.loop_diagnosis import SPRING
from effects.library import package_effects
from workbench.data.campaign import read_campaign
from workbench.explain.diagnosis import diagnose
from workbench.models.bases import nominal_model

CAMPAIGNS = Path(__file__).resolve().parents[2] / "results" / "reference" / "loop_diagnosis"


@pytest.mark.parametrize(
    "left_out, effect, size, value",
    (
        ("compliance", "mount_compliance", "compliance", 1 / SPRING.stiffness),
        ("backlash", "backlash", "play", 2 * 5e-5),
    ),
)
def test_what_is_left_out_is_named_with_its_size(left_out, effect, size, value):
    campaign = read_campaign(CAMPAIGNS / left_out)
    found = diagnose(nominal_model(campaign), campaign, package_effects())
    assert found.verdict == "effect" and found.names == (effect,) and found.probability > 0.99
    estimate = found.ranking[0].parameters[size]
    assert estimate.low90 < value < estimate.high90 and estimate.value == pytest.approx(value, rel=0.05)
