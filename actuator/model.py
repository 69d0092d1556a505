"""The actuator as one description, for the simulation, the model of a bench and whoever else drives it."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from actuator.compiled import NUMBERS, ActuatorNumbers
from actuator.drive import IDEAL_MOTOR, DiodeBridge, Drive
from actuator.errors import require_not_negative, require_positive
from actuator.parts import (
    LOSSLESS,
    NO_LOSS,
    RIGID,
    CompliantMount,
    GearEfficiency,
    MechanicalLoss,
    Mount,
    Ratio,
    fixed_ratio,
)


@dataclass(frozen=True)
class Actuator:
    """Motor, gears and linkage between body and wheel (thesis Figs 4.2, 4.4, 4.6), in terms of the wheel.

    With the stroke z of the suspension, that of the equivalent mass x and the ratio tau = tau_t(x):

        F = mount(z - x, z' - x')                              what the suspension feels
        m x'' = F - gears(F, x') - friction(x') - T / tau      m = J / tau^2
        t T' = clip(torque command) - T,   w = x' / tau        torque and speed of the rotor

    drive: motor under torque control or a diode bridge; ratio: tau_t; equivalent_mass: J / tau_t^2 of rotor and gears
    at the nominal ratio [kg]; mount, loss, gears: see ``actuator.parts``. Without arguments an ideal actuator.
    Raises ActuatorError for a mount without an equivalent mass behind it.
    """

    drive: Drive = IDEAL_MOTOR
    ratio: Ratio = fixed_ratio(1.0)
    equivalent_mass: float = 0.0
    mount: Mount = RIGID
    loss: MechanicalLoss = NO_LOSS
    gears: GearEfficiency = LOSSLESS

    def __post_init__(self) -> None:
        require_not_negative("actuator", equivalent_mass=self.equivalent_mass)
        if isinstance(self.mount, CompliantMount):
            require_positive("actuator behind a compliant mount", equivalent_mass=self.equivalent_mass)

    @property
    def is_passive(self) -> bool:
        """Whether no command reaches the machine."""
        return isinstance(self.drive, DiodeBridge)

    @property
    def numbers(self) -> ActuatorNumbers:
        """The same for the compiled equations."""
        limit, mount = self.drive.limit, self.mount
        soft = mount if isinstance(mount, CompliantMount) else CompliantMount(1.0)
        values = {
            **{field.name: getattr(soft, field.name) for field in fields(soft)},
            "rigid": mount is not soft,
            "passive": self.is_passive,
            "mass": self.equivalent_mass,
            "viscous": self.loss.viscous,
            "coulomb": self.loss.coulomb,
            "breakaway": self.loss.breakaway_speed,
            "driven": self.gears.driven,
            "driving": self.gears.driving,
            "nominal_ratio": self.ratio.nominal,
            "time_constant": self.drive.time_constant,
        }
        record = np.array([tuple(values[name] for name in NUMBERS.names or ())], NUMBERS)[0]
        ratio = np.array([self.ratio.stroke, self.ratio.value], dtype=float)
        return ActuatorNumbers(record, ratio, np.array([limit.speed, limit.driving, limit.braking], dtype=float))


IDEAL = Actuator()
