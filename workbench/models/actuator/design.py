"""An actuator as the effects see it: ``effects.damper_design.Damper`` at the output, made from machine, gears, linkage.

Output and rotor:  v = tau w,  F = T / tau,  tau = linkage ratio / gear ratio.  With the RMS line-to-line voltage
u = sqrt(3/2) e and the current i' = sqrt(3/2) i, of the peak phase voltage e and the peak q-axis current i,

    F v = T w = 3/2 e i = u i',   K = sqrt(3/2) p psi_m / tau [Vs/m = N/A],   u = (R + R_shunt) i'

so that R, L and the shunts, in star, are those of one phase (thesis eq. 3.75: K^2 = 2/3 K_t^2 / tau^2).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import sqrt

import numpy as np

from effects.damper_design import Damper
from effects.electrical.force_constant_saturation import ForceConstantSaturation
from effects.mechanical.coulomb_friction import CoulombFriction

OF_PEAK = sqrt(1.5)  # u over the peak phase voltage, i' over the peak q-axis current


@dataclass(frozen=True)
class ActuatorInputs:
    """What is drawn, SI; at a shaft the linkage ratio is 1, forces are torques and masses inertias.

    pole_pairs: p;  psi_m: magnet flux linkage, peak of a phase [Vs];  phase_resistance: at reference_T [ohm]
    inductance: of a phase, sqrt(L_d L_q) [H];  reference_T [degC]
    gear_ratio: fast over slow speed [1];  linkage_ratio: output travel over angle of the slow shaft [m/rad or 1]
    efficiency_driven, efficiency_driving: of the meshes, the output drives the rotor and the other way round [1]
    equivalent_mass: of rotor and gears at the output [kg or kg m^2]
    viscous_friction [Ns/m or Nms/rad], coulomb_friction [N or Nm]: at the output
    saturation: s of K(i') = K / (1 + s i'^2) [1/A^2]
    """

    pole_pairs: float
    psi_m: float
    phase_resistance: float
    inductance: float
    gear_ratio: float
    linkage_ratio: float
    equivalent_mass: float
    reference_T: float = 20.0
    efficiency_driven: float = 1.0
    efficiency_driving: float = 1.0
    viscous_friction: float = 0.0
    coulomb_friction: float = 0.0
    saturation: float = 0.0

    @property
    def ratio(self) -> float:
        """tau [m/rad or 1]."""
        return self.linkage_ratio / self.gear_ratio


@dataclass(frozen=True)
class Actuator(Damper):
    """inputs: what the constants of the damper were made from;  is_shaft: the output is a shaft, not a wheel"""

    inputs: ActuatorInputs = field(kw_only=True)
    is_shaft: bool = field(default=False, kw_only=True)

    @classmethod
    def of(cls, inputs: ActuatorInputs, is_shaft: bool) -> Actuator:
        """The actuator as drawn, with its friction and the saturation of its machine."""
        bare = cls(
            force_constant=OF_PEAK * inputs.pole_pairs * inputs.psi_m / inputs.ratio,
            internal_resistance=inputs.phase_resistance,
            moving_mass=inputs.equivalent_mass,
            viscous_damping=inputs.viscous_friction,
            inductance=inputs.inductance,
            inputs=inputs,
            is_shaft=is_shaft,
        )
        saturating = ForceConstantSaturation(inputs.saturation).on_design(bare)
        return CoulombFriction(level=inputs.coulomb_friction).on_design(saturating)


@dataclass(frozen=True, eq=False)
class Reactance:
    """A winding that turns past its magnets at constant speed: of the voltage e only e R^2 / (R^2 + X^2) drives the
    current that makes torque; the rest of the current weakens the field.

    reactance: X = w_e L in each row [ohm] (n,).  A machine with L_d = L_q; with others X^2 = w_e^2 L_d L_q, and the
    torque of their difference is left out.
    """

    reactance: np.ndarray

    def left(self, voltage: np.ndarray, resistance: np.ndarray) -> np.ndarray:
        """Voltage left [V]; see ``effects.damper_design.CircuitLaw``."""
        return voltage / (1.0 + (self.reactance / resistance) ** 2)
