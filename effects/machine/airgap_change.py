"""Air gap not as drawn."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import BuiltMachine
from effects.parameter import parameter
from effects.prior import Normal
from units import MILLIMETRE


@dataclass(frozen=True)
class AirgapChange(DesignEffect):
    """The air gap is larger or smaller than drawn all round: the bore moves, slots and shoes with it.

    Grinding that leaves the slots or the rotor core is ``bore_grinding`` and ``magnet_grinding``.
    """

    title = "air gap not as drawn"
    looks_like = "voltage, torque and inductance change together, cogging most of all"
    remedy = ("feeler gauge or bore and rotor diameter", "inductance")
    designs = (BuiltMachine,)
    exceeds = "airgap"
    signature = FIELD
    base_rate = 0.015
    base_rate_source = "judgement: stacked tolerances of bore and rotor"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    change: float = parameter(
        0.0,
        "m",
        prior=Normal(0.06 * MILLIMETRE),
        low=-0.2 * MILLIMETRE,
        high=0.5 * MILLIMETRE,
        source="ground rotors +-0.05 mm",
    )

    def on_design(self, design: BuiltMachine) -> BuiltMachine:
        return design.with_airgap(self.change)
