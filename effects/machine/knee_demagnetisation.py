"""Magnets that lost one edge to a demagnetising field."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi

from effects.base import DesignEffect
from effects.machine.places import FIELD
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class KneeDemagnetisation(DesignEffect):
    """Too much current pushed one edge of every magnet over its knee; which edge, of one direction of the torque, is
    an alternative.

    A share of the pole pitch has lost its magnetisation there: the arc is smaller by it, and the middle of what is
    left sits half of it further from the lost edge. In truth the edge is weak, not gone.
    """

    title = "magnet edges demagnetised"
    looks_like = "as narrower magnets, and the voltage is ahead or behind by half of what they lost"
    remedy = ("gaussmeter along a pole: one edge lower than the other", "back-EMF before and after an overload")
    designs = (MachineAsBuilt,)
    signature = FIELD
    contains = ("magnet_arc",)
    base_rate = 0.005
    base_rate_source = "judgement: after overloads of warm machines only"

    edge: int = 1  # 1: the one in front when turning counter-clockwise, -1: the one behind
    share: float = parameter(
        0.0,
        "1",
        prior=LogNormal(0.04, 0.6),
        low=0.0,
        high=0.16,
        source="first traces of an overload, 1 to 10 % of a pole",
    )

    @classmethod
    def variants(cls, design: MachineAsBuilt) -> tuple[KneeDemagnetisation, ...]:
        return cls(edge=1), cls(edge=-1)

    def on_design(self, design: MachineAsBuilt) -> MachineAsBuilt:
        if not self.share:
            return design
        narrower = design.with_machine(magnet_arc_fraction=design.machine.magnet_arc_fraction - self.share)
        turn = -self.edge * self.share * pi / design.machine.poles
        return replace(narrower, rotor_turn=design.rotor_turn + turn)
