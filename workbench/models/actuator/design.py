"""An actuator as the effects see it: ``effects.damper_design.Damper`` at the output, made from the one description.

Output and rotor:  v = tau w,  F = T / tau.  With the RMS line-to-line voltage u = sqrt(3/2) e and the current
i' = sqrt(3/2) i, of the peak phase voltage e and the peak q-axis current i,

    F v = T w = 3/2 e i = u i',   K = sqrt(3/2) p psi_m / tau [Vs/m = N/A],   u = (R + R_shunt) i'

so that R, L and the shunts, in star, are those of one phase (thesis eq. 3.75: K^2 = 2/3 K_t^2 / tau^2).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import sqrt

import numpy as np

from actuator.model import Actuator
from actuator.parts import GearEfficiency, MechanicalLoss, fixed_ratio
from effects.damper_design import Damper
from effects.electrical.force_constant_saturation import ForceConstantSaturation
from effects.mechanical.coulomb_friction import CoulombFriction
from electrical.synchronous_machine import SynchronousMachine

OF_PEAK = sqrt(1.5)  # u over the peak phase voltage, i' over the peak q-axis current


@dataclass(frozen=True)
class OnBench:
    """What lies on the bench.

    actuator: as simulation and exported unit take it, at its nominal ratio and without drive; its mount does not act at
    rest or at constant speed; on a shaft the ratio is 1 over that of the gears, masses are inertias, forces torques
    machine: at the terminals; reference_T: at which its resistance holds [degC]
    saturation: s of K(i') = K / (1 + s i'^2) [1/A^2]
    """

    actuator: Actuator
    machine: SynchronousMachine
    reference_T: float = 20.0
    saturation: float = 0.0


REQUIRED = ("pole_pairs", "psi_m", "phase_resistance", "inductance", "transmission_ratio", "equivalent_mass")
OPTIONAL = ("reference_T", "saturation", "efficiency_driven", "efficiency_driving", "viscous_friction",
            "coulomb_friction")  # fmt: skip


def read(values: Mapping[str, float]) -> OnBench:
    """From the numbers of a ``[device]`` table; values: by the names of ``REQUIRED`` and ``OPTIONAL`` [SI]."""
    given = {"reference_T": 20.0, "saturation": 0.0, **values}
    inductance = given["inductance"]
    machine = SynchronousMachine(
        int(given["pole_pairs"]), given["psi_m"], inductance, inductance, given["phase_resistance"]
    )
    actuator = Actuator(
        ratio=fixed_ratio(given["transmission_ratio"]),
        equivalent_mass=given["equivalent_mass"],
        loss=MechanicalLoss(given.get("viscous_friction", 0.0), given.get("coulomb_friction", 0.0)),
        gears=GearEfficiency(given.get("efficiency_driven", 1.0), given.get("efficiency_driving", 1.0)),
    )
    return OnBench(actuator, machine, given["reference_T"], given["saturation"])


def written(found: OnBench) -> dict[str, float]:
    """The numbers of a ``[device]`` table, by the names of ``REQUIRED`` and ``OPTIONAL`` [SI]; ``read`` reads them.

    Of a machine with L_d and L_q their geometric mean: at constant speed that is what a shunted current meets.
    """
    machine, actuator = found.machine, found.actuator
    numbers = (
        machine.pole_pairs, machine.psi_m, machine.resistance, np.sqrt(machine.inductance_d * machine.inductance_q),
        actuator.ratio.nominal, actuator.equivalent_mass, found.reference_T, found.saturation, actuator.gears.driven,
        actuator.gears.driving, actuator.loss.viscous, actuator.loss.coulomb,
    )  # fmt: skip
    return dict(zip((*REQUIRED, *OPTIONAL), (float(one) for one in numbers), strict=True))


@dataclass(frozen=True)
class BenchActuator(Damper):
    """drawn: what the constants of the damper were made from;  is_shaft: the output is a shaft, not a wheel"""

    drawn: OnBench = field(kw_only=True)
    is_shaft: bool = field(default=False, kw_only=True)

    @classmethod
    def of(cls, drawn: OnBench, is_shaft: bool) -> BenchActuator:
        """The actuator as drawn, with its friction and the saturation of its machine."""
        constants, loss = written(drawn), drawn.actuator.loss
        bare = cls(
            force_constant=OF_PEAK * constants["pole_pairs"] * constants["psi_m"] / constants["transmission_ratio"],
            internal_resistance=constants["phase_resistance"],
            moving_mass=drawn.actuator.equivalent_mass,
            viscous_damping=loss.viscous,
            inductance=constants["inductance"],
            drawn=drawn,
            is_shaft=is_shaft,
        )
        saturating = ForceConstantSaturation(drawn.saturation).on_design(bare)
        return CoulombFriction(level=loss.coulomb).on_design(saturating)


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
