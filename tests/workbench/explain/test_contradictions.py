"""A gauged gap speaks against an effect that opens it far beyond the gauge."""

import pytest

from effects.machine.airgap_change import AirgapChange
from effects.machine.end_leakage import EndLeakage
from workbench.data.table import Tolerance
from workbench.explain.contradictions import contradiction
from workbench.findings import Estimate

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
