"""Mechanical impedance of a shunted actuator at its output, lumped: thesis appendix B.

    driver --mount (k_m, c_m)-- m_eq --friction c_eq and machine-- ground
    Z = F / v = Z_m Z_i / (Z_m + Z_i),   Z_m = c_m + k_m / s,   Z_i = s m_eq + c_eq + N / tau^2      (B.4)

N is the torque over the speed of the swinging machine (``electrical.shunted_machine``): K_t K_e / (R + s L) for one
with a commutator, as printed; a synchronous machine depends on how far it swings as well, and so does a diode bridge.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, sqrt

import numpy as np

from electrical.shunted_machine import Circuit
from electrical.synchronous_machine import SynchronousMachine
from units import Values
from vehicle.errors import VehicleError, require_not_negative, require_positive

_CLOSE = 1e-8  # relative error of the rotor's swing at which it is found
_SLOPES = (0.2, 5.0)  # of a step, over what is missing
_MOST_STEPS = 50


@dataclass(frozen=True)
class LumpedActuator:
    """A shunted actuator at its output.

    machine: at its shaft; circuit: what its terminals feed; transmission_ratio: tau_t [m/rad]
    equivalent_mass: m_eq [kg]; viscous_friction: c_eq [Ns/m]
    mount_stiffness: k_m [N/m], infinite where the mount is rigid; mount_damping: c_m [Ns/m]
    """

    machine: SynchronousMachine
    circuit: Circuit
    transmission_ratio: float
    equivalent_mass: float
    viscous_friction: float
    mount_stiffness: float = inf
    mount_damping: float = 0.0

    def __post_init__(self) -> None:
        require_positive("lumped actuator", transmission_ratio=self.transmission_ratio)
        require_not_negative(
            "lumped actuator",
            equivalent_mass=self.equivalent_mass,
            viscous_friction=self.viscous_friction,
            mount_damping=self.mount_damping,
        )
        if not self.mount_stiffness > 0:
            raise VehicleError(
                f"lumped actuator: mount stiffness must be above zero, found {self.mount_stiffness:g}; leave it out "
                "for a rigid mount"
            )

    @property
    def natural_frequency(self) -> float:
        """Of the mass on its mount with the driver held [Hz] (B.6)."""
        return sqrt(self.mount_stiffness / self.equivalent_mass) / (2 * pi)

    def static_damping(self, shunt: Values) -> Values:
        """Slope of force over velocity at constant velocity, friction included [Ns/m]; shunt: [ohm], any shape."""
        return self.viscous_friction + self.circuit.slope(self.machine, shunt) / self.transmission_ratio**2

    def impedance(self, frequency: Values, shunt: Values, top_velocity: Values) -> np.ndarray:
        """Fundamental of the force over that of the velocity at the driver [Ns/m], complex.

        frequency: [Hz]; shunt: [ohm]; top_velocity: amplitude of the driver's velocity [m/s]; they broadcast.
        Returns: impedance of their shape. The rotor's motion is taken as a sine.
        Raises VehicleError where no amplitude of the rotor fits that of the driver.
        """
        frequency, shunt, driver = np.broadcast_arrays(
            *(np.asarray(v, float) for v in (frequency, shunt, top_velocity))
        )
        mount = self._mount(frequency)
        inner = self._inner(frequency, shunt, self._rotor_velocity(frequency, shunt, driver, mount))
        return inner / (1 + inner / mount)

    def _mount(self, frequency: np.ndarray) -> np.ndarray:
        return self.mount_damping + self.mount_stiffness / (2j * pi * frequency)

    def _inner(self, frequency: np.ndarray, shunt: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Z_i where the rotor, seen at the output, swings with this velocity."""
        machine = self.circuit.dynamic_damping(self.machine, frequency, velocity / self.transmission_ratio, shunt)
        return 2j * pi * frequency * self.equivalent_mass + self.viscous_friction + machine / self.transmission_ratio**2

    def _rotor_velocity(
        self, frequency: np.ndarray, shunt: np.ndarray, driver: np.ndarray, mount: np.ndarray
    ) -> np.ndarray:
        """|v_rotor| = |v_driver| / |1 + Z_i(v_rotor) / Z_m|, by the secant rule on the logarithm."""
        if np.isinf(self.mount_stiffness):
            return driver

        def missing(logarithm: np.ndarray) -> np.ndarray:
            """Logarithm of the velocity that follows from a velocity [m/s], over the latter's."""
            inner = self._inner(frequency, shunt, np.exp(logarithm))
            return np.log(driver / np.abs(1 + inner / mount)) - logarithm

        before, wrong_before = np.log(driver), missing(np.log(driver))
        here = before + wrong_before
        for _ in range(_MOST_STEPS):
            wrong = missing(here)
            if np.all(np.abs(wrong) < _CLOSE):
                return np.exp(here)
            change = wrong_before - wrong
            slope = np.divide(
                here - before, change, out=np.ones_like(here), where=np.abs(change) > _CLOSE * np.abs(wrong)
            )
            before, wrong_before, here = here, wrong, here + np.clip(slope, *_SLOPES) * wrong
        raise VehicleError(
            "impedance: no swing of the rotor was found that fits the driver's velocity; ask for smaller amplitudes"
        )
