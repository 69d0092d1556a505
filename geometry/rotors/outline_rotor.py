"""A rotor inside its stator without magnets, cut out of the outline of its lamination."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from geometry.cut_out_rotor import CutOutRotor
from geometry.errors import GeometryError
from geometry.parts import WithoutMagnets


@dataclass(frozen=True)
class OutlineRotor(WithoutMagnets, CutOutRotor):
    """See ``geometry.cut_out_rotor``; the axis of a pole is that of high permeance.

    repeats_after: 1 where all poles are alike, 2 where every second one is
    """

    repeats_after: int = 1

    @property
    def repeats(self) -> int:
        return self.poles // self.repeats_after

    @property
    def first_ray(self) -> float:
        """The axis of the pole where all are alike, otherwise that of low permeance before it [rad]: mirror lines."""
        return 0.0 if self.repeats_after == 1 else -pi / self.poles

    def check(self) -> None:
        if self.repeats_after not in (1, 2):
            raise GeometryError(f"repeats_after is 1 or 2 poles, found {self.repeats_after}")
        super().check()
