"""Glue under the magnets."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal
from units import MILLIMETRE


@dataclass(frozen=True)
class GlueGap(DesignEffect):
    """A layer of glue lies under every magnet, and the magnets were ground to the drawn radius over it.

    Magnet and glue in series are a magnet of the drawn thickness l with
        1/mu = (1 - t/l)/mu_r + t/l,   B = (B_r/mu_r)(1 - t/l) mu.
    """

    title = "glue under the magnets"
    looks_like = "voltage, cogging and torque constant all lower, and no temperature explains it"
    remedy = ("thickness of magnets and glue on a cut rotor", "remanence of a spare magnet")
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.01
    base_rate_source = "judgement: drawn rotors forget the glue now and then"

    thickness: float = parameter(
        0.0,
        "m",
        prior=LogNormal(0.08 * MILLIMETRE, 0.5),
        low=0.0,
        high=0.5 * MILLIMETRE,
        source="bond lines of magnet adhesives 0.03 to 0.2 mm (makers' data sheets)",
    )

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        if not self.thickness:
            return design
        magnet, glue = design.magnet, self.thickness / design.machine.magnet_length
        recoil = 1.0 / ((1.0 - glue) / magnet.recoil_permeability + glue)
        remanence = magnet.remanence / magnet.recoil_permeability * (1.0 - glue) * recoil
        return design.with_magnet(remanence=remanence, recoil_permeability=recoil)
