"""Damage by cutting."""

from __future__ import annotations

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class CutEdgeDamage(DesignEffect):
    """Cutting has taken a share of the permeability at the edges of the stator steel, falling to nothing 0.7 mm in.

    J(H, x) = J_s((1 - loss (1 - x/depth)^2) H). Depths of 0.5 to 1 mm: Bali, Muetze, IEEE Trans. Ind. Appl. 54 (2018)
    366-375.
    """

    title = "damage by cutting"
    looks_like = "lower flux at low and medium saturation; narrow teeth suffer most"
    remedy = ("core loss and permeability of cut rings of two widths", "flux linkage at low current")
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: punched sheets have it, it shows at low flux only"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    loss: float = parameter(
        0.0,
        "1",
        prior=LogNormal(0.35, 0.5),
        low=0.0,
        high=0.9,
        source="punched non-oriented sheets, order of magnitude",
    )

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        return replace(design, edge_damage=design.edge_damage + self.loss)
