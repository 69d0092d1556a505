"""One magnet out of place."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from units import DEGREE


@dataclass(frozen=True)
class MagnetPosition(DesignEffect):
    """One magnet sits too far on round the rotor; which one is an alternative."""

    title = "one magnet out of place"
    looks_like = "cogging orders that are multiples of the slots, hardly a trace in the fundamental of the voltage"
    remedy = ("angles between the poles with a gaussmeter",)
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: one magnet slips while the glue sets"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    magnet: int = 0  # its number
    angle: float = parameter(
        0.0,
        "rad",
        prior=Normal(0.5 * DEGREE),
        low=-2 * DEGREE,
        high=2 * DEGREE,
        source="gluing without pockets, 0.1 to 0.2 mm",
    )

    @classmethod
    def variants(cls, design: MachineAsBuilt) -> tuple[MagnetPosition, ...]:
        return tuple(cls(magnet=k) for k in range(len(design.magnet_turns)))

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        turn = design.magnet_turns[self.magnet] + self.angle
        return design.with_one("magnet_turns", self.magnet, turn)
