"""Magnets narrower than drawn."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class MagnetArc(DesignEffect):
    """Every magnet covers a smaller share of its pole than drawn."""

    title = "magnets narrower than drawn"
    looks_like = "cogging of native order and the higher odd orders of the voltage change, its fundamental hardly"
    remedy = ("width of the magnets", "fifth and third electrical harmonic of the back-EMF")
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: magnet widths are held to 0.1 mm"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    loss: float = parameter(
        0.0, "1", prior=LogNormal(0.04, 0.6), low=0.0, high=0.16, source="magnet width tolerance and chamfers"
    )

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        arc = design.machine.magnet_arc_fraction - self.loss
        return design.with_machine(magnet_arc_fraction=arc) if self.loss else design
