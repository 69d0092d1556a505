"""All slot openings not as drawn."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from units import MILLIMETRE


@dataclass(frozen=True)
class SlotOpening(DesignEffect):
    """All slots open wider (or narrower) to the gap than drawn."""

    title = "slot openings not as drawn"
    looks_like = "cogging of native order grows with the opening; locked-rotor torque changes little"
    remedy = ("width of the openings", "cogging")
    designs = (MachineAsBuilt,)
    signature = FIELD
    exceeds = "slot_opening"
    base_rate = 0.01
    base_rate_source = "judgement: closing of slots and burrs"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    change: float = parameter(
        0.0,
        "m",
        prior=Normal(0.2 * MILLIMETRE),
        low=-0.8 * MILLIMETRE,
        high=0.8 * MILLIMETRE,
        source="stamping and closing of slots",
    )

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        return design.with_machine(slot_opening=design.machine.slot_opening + self.change)
