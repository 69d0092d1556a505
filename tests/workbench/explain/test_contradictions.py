"""A gauged gap speaks against an effect that opens it far beyond; a stated device, against a fit that needs another."""

import re

import pytest

from effects.machine.airgap_change import AirgapChange
from effects.machine.end_leakage import EndLeakage
from tests.workbench.toy_bench import LIBRARY, SpringModel, written
from workbench.data.campaign import read_campaign
from workbench.data.table import Tolerance
from workbench.explain.contradictions import contradiction, exceeded
from workbench.explain.hypotheses import null_of
from workbench.findings import Estimate
from workbench.likelihood.bench import bench_of
from workbench.models.model import Model

SIZE = {"change": Estimate(2.3e-4, 2e-5, 2e-4, 2.6e-4, "m")}


@pytest.mark.parametrize(
    "effect, sigma, relative, says",
    [
        (AirgapChange, 1e-5, False, "by 23 of its standard deviations"),
        (AirgapChange, 1e-4, False, ""),  # the tolerance is as wide as the effect
        (AirgapChange, 1e-5, True, ""),
        (EndLeakage, 1e-5, False, ""),
    ],
)
def test_a_tolerance_of_the_same_input_is_said(effect, sigma, relative, says):
    said = contradiction(effect, SIZE, [Tolerance("airgap_mm", sigma, relative)])
    assert says in said and bool(says) == bool(said)


@pytest.mark.parametrize("stiffness, says", [(850.0, "stiffness says otherwise"), (1003.0, "")])
def test_a_device_that_is_another_one_is_said(tmp_path, stiffness, says):
    """Of 850 N/m where 1000 are stated, to 1 %."""
    campaign = read_campaign(written(tmp_path, stiffness=stiffness))
    model = Model(SpringModel(), SpringModel().design(campaign.device))
    said = " ".join(exceeded(null_of(bench_of(model, campaign, LIBRARY))))
    assert says in said and bool(says) == bool(said)
    lower = re.findall(r"lower than \[device\] states, by (\d+) %", said)
    assert list(map(float, lower)) == pytest.approx([15.0] if says else [], abs=1)
