"""The voltage that carbon brushes keep to themselves."""

from dataclasses import dataclass, replace

from effects.base import DesignEffect
from effects.parameter import parameter
from effects.prior import LogNormal
from examples.dc_motor.model import DcMotor


@dataclass(frozen=True)
class BrushDrop(DesignEffect):
    """u = u_b + R i + k omega with the same u_b at every current."""

    title = "voltage drop of the brushes"
    looks_like = "speed too low by the same amount at every torque and voltage; current as predicted"
    remedy = ("voltage at standstill against current",)
    designs = (DcMotor,)

    drop: float = parameter(0.0, "V", prior=LogNormal(1.0, 0.7), low=0.0, high=5.0, source="0.5 to 2 V, carbon brushes")

    def on_design(self, design):
        return design if self.is_null else replace(design, brush_drop=self.drop)
