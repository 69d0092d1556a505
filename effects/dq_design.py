"""A permanent-magnet synchronous machine in its rotor frame as the effects see it: constants, and lists of laws.

Motor signs, amplitude-invariant: currents, voltages and flux linkages are peak phase values; omega = p * speed.

    e_d = -omega psi_q,  e_q = omega psi_d,   i = i_m + g e,   v = R i + e
    g = iron_conductance + iron_hysteresis / |omega|
    psi = (psi_m + L_d i_md, L_q i_mq) + sum of flux laws of i_m
    T_shaft = 1.5 p (psi_d i_mq - psi_q i_md) - sum of torque laws - sum of brakes of i_m
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import sqrt
from typing import Protocol

import numpy as np


class FluxLaw(Protocol):
    """What is added to the flux linkages of constant inductances."""

    def flux(self, i_d: np.ndarray, i_q: np.ndarray, machine: DqMachine) -> tuple[np.ndarray, np.ndarray]:
        """Added psi_d and psi_q [Vs] at magnetising currents [A]; from one co-energy, so that no torque is invented."""


class TorqueLaw(Protocol):
    """A loss between the air gap and the shaft."""

    def lost_torque(self, speed: np.ndarray, torque: np.ndarray) -> np.ndarray:
        """Torque lost [Nm], positive against a positive speed [rad/s], at an air-gap torque [Nm]."""


class BrakeLaw(Protocol):
    """A loss between the air gap and the shaft that follows from the currents."""

    def lost_torque(self, speed: np.ndarray, i_d: np.ndarray, i_q: np.ndarray) -> np.ndarray:
        """Torque lost [Nm], positive against a positive speed [rad/s], at magnetising currents [A]."""


@dataclass(frozen=True)
class DqMachine:
    """A permanent-magnet synchronous machine.

    pole_pairs: p;  psi_m: magnet flux linkage [Vs];  inductance_d, inductance_q: [H];  resistance: of one phase [ohm]
    reference_T: temperature at which psi_m and resistance hold [degC]
    copper_coefficient, remanence_coefficient: relative change of R and psi_m per kelvin of winding_T and magnet_T [1/K]
    iron_conductance: 1 / R_fe, in parallel with the induced voltage [1/ohm]
    iron_hysteresis: the same times |omega|, of a loss in proportion to the frequency [rad/s/ohm]
    voltage_per_dc: largest peak phase voltage of its inverter over the voltage of the d.c. link [1]
    """

    pole_pairs: float
    psi_m: float
    inductance_d: float
    inductance_q: float
    resistance: float
    reference_T: float = 20.0
    copper_coefficient: float = 0.0
    remanence_coefficient: float = 0.0
    iron_conductance: float = 0.0
    iron_hysteresis: float = 0.0
    voltage_per_dc: float = 1.0 / sqrt(3.0)  # space vectors up to the circle that their hexagon holds
    fluxes: tuple[FluxLaw, ...] = field(default=())
    torques: tuple[TorqueLaw, ...] = field(default=())
    brakes: tuple[BrakeLaw, ...] = field(default=())

    def with_flux(self, law: FluxLaw) -> DqMachine:
        return replace(self, fluxes=self.fluxes + (law,))

    def with_torque(self, law: TorqueLaw) -> DqMachine:
        return replace(self, torques=self.torques + (law,))

    def with_brake(self, law: BrakeLaw) -> DqMachine:
        return replace(self, brakes=self.brakes + (law,))

    def with_turns(self, factor: float) -> DqMachine:
        """``factor`` times the turns in the same slots: psi_m with it, inductances and resistance with its square."""
        return replace(
            self,
            psi_m=self.psi_m * factor,
            inductance_d=self.inductance_d * factor**2,
            inductance_q=self.inductance_q * factor**2,
            resistance=self.resistance * factor**2,
        )
