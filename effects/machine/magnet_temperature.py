"""Warm magnets."""

from __future__ import annotations

from dataclasses import dataclass

from effects.machine.magnet_effect import MagnetEffect
from effects.machine.places import FIELD
from effects.machine_design import BuiltMachine
from effects.parameter import parameter
from effects.prior import LogNormal


@dataclass(frozen=True)
class MagnetTemperature(MagnetEffect):
    """The magnets are warmer than where they were read, and weaker everywhere: B_r (1 + alpha rise).

    It acts on top of a column ``magnet_T`` and of the key ``magnet_temperature`` of the device, in every kind of table.
    alpha: temperature coefficient of the remanence of the device; -0.11 to -0.12 %/K for NdFeB (makers' data sheets).
    """

    title = "warm magnets"
    looks_like = "voltage, cogging and torque constant all lower; flux change with current hardly different"
    remedy = ("back-EMF after a night without current", "remanence of a spare magnet")
    signature = FIELD
    base_rate = 0.04
    base_rate_source = "judgement: few benches read the temperature of the magnets"

    rise: float = parameter(
        0.0, "K", prior=LogNormal(25.0, 0.7), low=0.0, high=150.0, source="NdFeB grades end at 80 to 180 degC"
    )

    def on_design(self, design: BuiltMachine) -> BuiltMachine:
        alpha = design.magnet.temperature_coefficient
        return design.with_magnet(remanence=design.magnet.remanence * (1.0 + alpha * self.rise))
