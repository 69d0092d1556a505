"""Bridges of a rotor with buried magnets or barriers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from effects.base import DesignEffect
from effects.drawn_design import DrawnAsBuilt
from effects.machine.places import FIELD
from effects.parameter import parameter
from effects.prior import Normal
from units import MILLIMETRE


@dataclass(frozen=True)
class BridgeWidth(DesignEffect):
    """The iron that holds the rotor together over its holes is thicker or thinner than drawn.

    A bridge is saturated and leads B_s times its width past the air gap; a wider one weakens the magnets' flux.
    """

    title = "bridges not as drawn"
    looks_like = "voltage and torque of the magnets off by a constant flux, not by one that goes with the current"
    remedy = ("microscope on a rotor sheet", "back-EMF with the rotor warm and cold, beside the magnets' coefficient")
    designs = (DrawnAsBuilt,)
    signature = FIELD
    base_rate = 0.02
    base_rate_source = "engineering judgement: bridges are traced from photographs or move with the die, 0.1 to 0.3 mm"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion
    model_error_source = "engineering judgement: as that of the other effects of the field, not measured on its own"

    change: float = parameter(
        0.0, "m", prior=Normal(0.2 * MILLIMETRE), low=-0.8 * MILLIMETRE, high=1.5 * MILLIMETRE,
        source="engineering judgement: a tenth of a millimetre punched, some tenths traced",
    )  # fmt: skip

    @classmethod
    def can_act_on(cls, design: Any) -> bool:
        return super().can_act_on(design) and hasattr(design.machine.rotor, "bridge")

    def on_design(self, design: DrawnAsBuilt) -> DrawnAsBuilt:
        if self.is_null:
            return design
        return design.with_dimension("rotor", "bridge", design.machine.rotor.bridge + self.change)
