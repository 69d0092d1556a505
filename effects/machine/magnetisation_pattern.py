"""Direction of magnetisation."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal


@dataclass(frozen=True)
class MagnetisationPattern(DesignEffect):
    """The magnets are magnetised ``share`` of the way from parallel to radial beyond the drawing, or short of it: at
    every point the direction is turned by that share of the point's angle from the middle of the magnet."""

    title = "direction of magnetisation"
    looks_like = "third harmonic of the voltage and locked-rotor torque change"
    remedy = ("field around the bare rotor", "harmonics of the back-EMF")
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: what a fixture makes is seldom checked"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    share: float = parameter(
        0.0, "1", prior=Normal(0.2), low=-0.6, high=1.0, source="fixtures between parallel and radial"
    )

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        return replace(design, radial_share=design.radial_share + self.share)
