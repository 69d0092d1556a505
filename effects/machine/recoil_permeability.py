"""Recoil permeability of the magnets."""

from __future__ import annotations

from dataclasses import dataclass

from effects.machine.magnet_effect import MagnetEffect
from effects.machine.places import FIELD
from effects.machine_design import BuiltMachine
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class RecoilPermeability(MagnetEffect):
    """The recoil line of the magnets is steeper than declared: mu_r + excess; the remanence stays."""

    title = "recoil permeability"
    looks_like = "lower voltage and inductance-like changes: the magnets are a shorter magnetic gap"
    remedy = ("demagnetisation curve of a spare magnet", "flux linkage against current")
    signature = FIELD
    base_rate = 0.005
    base_rate_source = "judgement: data sheets are near"
    model_error = 0.02  # of a field solution on the mesh of a bench model, and of its expansion

    excess: float = parameter(
        0.0, "1", prior=LogNormal(0.05, 0.6), low=0.0, high=0.5, source="NdFeB 1.03 to 1.10 (makers' data sheets)"
    )

    def on_design(self, design: BuiltMachine) -> BuiltMachine:
        return design.with_magnet(recoil_permeability=design.magnet.recoil_permeability + self.excess)
