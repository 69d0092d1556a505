"""Stress of the stator by its housing."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal

LOSS_PER_FIELD = 0.5  # relative rise of the loss over that of the field; measured curves lie between 0.3 and 1


@dataclass(frozen=True)
class PressFitStress(DesignEffect):
    """A housing squeezes the stator: the steel needs (1 + strain) times the field and loses more.

    J(H) = J_s(H/(1 + strain)), P = (1 + strain/2) P_sheet: compressive stress of tens of MPa along the yoke, taken as
    even over the stack. The saturation polarisation stays.
    """

    title = "stator squeezed by its housing"
    looks_like = "slightly lower flux where the steel is not saturated, and more drag"
    remedy = ("inductance and drag before and after pressing in", "ring sample under stress")
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.005
    base_rate_source = "judgement: shrunk housings are common, its trace in an air-gap machine is faint"

    strain: float = parameter(
        0.0, "1", prior=LogNormal(0.5, 0.6), low=0.0, high=3.0, source="compressive stress of 20 to 100 MPa"
    )

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        field, loss = 1.0 + self.strain, 1.0 + LOSS_PER_FIELD * self.strain
        return replace(design, field_scale=design.field_scale * field, iron_loss_factor=design.iron_loss_factor * loss)
