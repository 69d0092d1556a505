"""Magnets longer than the stack."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import LEAKAGE
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class MagnetOverhang(DesignEffect):
    """Magnets reach beyond the stack and add a share of their flux to the winding through its ends.

    Voltage and the torque of magnets and current rise by the share, cogging by its square, flux change not at all: the
    opposite of end leakage. As a rule of thumb half of the flux of the overhang gets in.
    """

    title = "magnets longer than the stack"
    looks_like = "voltage and torque constant higher, as with stronger magnets, flux change with current unchanged"
    remedy = ("length of magnets and stack", "flux linkage against current")
    designs = (MachineAsBuilt,)
    signature = LEAKAGE
    base_rate = 0.01
    base_rate_source = "judgement: overhangs are drawn mostly, and then declared"

    share: float = parameter(
        0.0,
        "1",
        prior=LogNormal(0.02, 0.7),
        low=0.0,
        high=0.2,
        source="1 mm on either side of a stack of 50 mm, half in",
    )

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        return replace(design, end_leakage=design.end_leakage - self.share)
