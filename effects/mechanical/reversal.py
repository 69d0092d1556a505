"""Where dry friction changes its sign: presliding rounds the step."""

from __future__ import annotations

from effects.parameter import parameter
from effects.prior import LogNormal

REVERSAL = 1e-3  # m/s, below it presliding rounds the reversal (Armstrong-Helouvry et al. 1994)


def reversal_velocity() -> float:
    """The parameter of an effect [m/s]: F ~ tanh(velocity / reversal)."""
    source = "textbook: presliding of lubricated contacts (Armstrong-Helouvry et al. 1994)"
    return parameter(REVERSAL, "m/s", prior=LogNormal(REVERSAL, 0.7), low=1e-5, high=0.05, source=source)
