"""What both eccentricities share: how large the shift is, where it points, how it shows and is looked for."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

from effects.base import DesignEffect
from effects.machine.places import LEAKAGE
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal, Uniform


@dataclass(frozen=True)
class Eccentricity(DesignEffect):
    """A part stands beside its axis by ``share`` of the air gap in ``direction``; which part is for the effects."""

    remedy = ("run-out with a dial gauge", "bearing force", "back-EMF of single coils")
    designs = (MachineAsBuilt,)
    signature = LEAKAGE
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    share: float = parameter(
        0.0, "1", prior=LogNormal(0.2, 0.5), low=0.0, high=0.45, source="gaps of small machines, 10 to 40 %"
    )
    direction: float = parameter(0.0, "rad", prior=Uniform(-pi, pi), low=-pi, high=pi, source="any")

    @property
    def is_null(self) -> bool:
        return self.share == 0.0

    def beyond(self, shift: tuple[float, float], airgap: float) -> tuple[float, float]:
        """A shift (x, y) [m] with that of this effect; airgap [m]."""
        amount, (x, y) = self.share * airgap, shift
        return x + amount * cos(self.direction), y + amount * sin(self.direction)
