"""Current against the magnets lowers their flux for as long as it flows: they work on the bent part of their curve."""

from dataclasses import dataclass

import numpy as np

from effects.law_effects import FluxEffect
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class MagnetsGiveWay(FluxEffect):
    """psi_d = psi_m (1 - c i_d^2) + L_d i_d where i_d < 0: the recoil line bends down against the field."""

    title = "magnets give way to opposing current"
    looks_like = "v_q and short-circuit current below the model at negative i_d, as the model at positive i_d"
    remedy = ("flux linkage of the d axis against i_d, both signs",)

    bend: float = parameter(
        0.0, "1/A^2", prior=LogNormal(1e-4, 1.5), low=0.0, high=0.05, source="one percent of the flux at 10 A"
    )

    def flux(self, i_d, i_q, machine):
        opposing = np.minimum(i_d, 0.0)
        return -machine.psi_m * self.bend * opposing**2, np.zeros_like(i_q)
