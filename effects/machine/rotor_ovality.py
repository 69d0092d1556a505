"""Rotor that is not round."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi

import numpy as np

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal, Uniform


@dataclass(frozen=True)
class RotorOvality(DesignEffect):
    """The rotor is oval: under a magnet at angle a the gap is g (1 - share cos 2(a - direction)).

    A magnet then drives the flux of one whose remanence is 1 + mu_r share g cos 2(a - direction)/(l_m + mu_r g) times
    as large: the series circuit of magnet and gap, iron left out. That the flux of the winding finds another gap as
    well is left out: it is a share of a few per cent of a change of a few per cent.
    """

    title = "oval rotor"
    looks_like = "cogging orders that are multiples of the slots, next to none in the voltage"
    remedy = ("run-out with a dial gauge: two waves a revolution",)
    designs = (MachineAsBuilt,)
    signature = FIELD
    base_rate = 0.005
    base_rate_source = "judgement: ground or turned rotors are round"

    share: float = parameter(
        0.0, "1", prior=LogNormal(0.06, 0.7), low=0.0, high=0.5, source="0.01 to 0.1 mm in a gap of 0.5 mm"
    )
    direction: float = parameter(0.0, "rad", prior=Uniform(-pi / 2, pi / 2), low=-pi / 2, high=pi / 2, source="any")

    @property
    def is_null(self) -> bool:
        return self.share == 0.0

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        if self.is_null:
            return design
        poles, gap = design.machine.poles, design.magnet.recoil_permeability * design.machine.airgap
        reach = self.share * gap / (design.machine.magnet_length + gap)
        place = 2 * np.pi * np.arange(poles) / poles
        factors = 1.0 + reach * np.cos(2 * (place - self.direction))
        strengths = tuple(b * float(k) for b, k in zip(design.magnet_strengths, factors))
        return replace(design, magnet_strengths=strengths)
