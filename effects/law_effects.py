"""Effects that are themselves a law of a lumped device: the design takes the effect and asks it for a force or flux."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from effects.base import DesignEffect
from effects.damper_design import Damper
from effects.dq_design import DqMachine


class ForceEffect(DesignEffect):
    """A force against the motion of the damper's mass; a concrete effect writes ``force``."""

    designs: ClassVar[tuple[type, ...]] = (Damper,)

    def force(self, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Force against the motion [N]; see ``effects.damper_design.ForceLaw``."""
        raise NotImplementedError

    def on_design(self, design: Damper) -> Damper:
        return design if self.is_null else design.with_force(self)


class CircuitEffect(DesignEffect):
    """Something in series with the winding of the damper; a concrete effect writes ``left``."""

    designs: ClassVar[tuple[type, ...]] = (Damper,)

    def left(self, voltage: np.ndarray, resistance: np.ndarray) -> np.ndarray:
        """Voltage left for the resistances [V]; see ``effects.damper_design.CircuitLaw``."""
        raise NotImplementedError

    def on_design(self, design: Damper) -> Damper:
        return design if self.is_null else design.with_circuit(self)


class CouplingEffect(DesignEffect):
    """A force constant that depends on position or current; a concrete effect writes ``coupling``."""

    designs: ClassVar[tuple[type, ...]] = (Damper,)

    def coupling(self, position: np.ndarray, current: np.ndarray) -> np.ndarray:
        """K over the nominal K [1]; see ``effects.damper_design.CouplingLaw``."""
        raise NotImplementedError

    def on_design(self, design: Damper) -> Damper:
        return design if self.is_null else design.with_coupling(self)


class FluxEffect(DesignEffect):
    """Flux linkage that constant inductances leave out; a concrete effect writes ``flux``."""

    designs: ClassVar[tuple[type, ...]] = (DqMachine,)

    def flux(self, i_d: np.ndarray, i_q: np.ndarray, machine: DqMachine) -> tuple[np.ndarray, np.ndarray]:
        """Added psi_d and psi_q [Vs]; see ``effects.dq_design.FluxLaw``."""
        raise NotImplementedError

    def on_design(self, design: DqMachine) -> DqMachine:
        return design if self.is_null else design.with_flux(self)


class TorqueEffect(DesignEffect):
    """Torque lost between air gap and shaft; a concrete effect writes ``lost_torque``."""

    designs: ClassVar[tuple[type, ...]] = (DqMachine,)

    def lost_torque(self, speed: np.ndarray, torque: np.ndarray) -> np.ndarray:
        """Torque lost [Nm]; see ``effects.dq_design.TorqueLaw``."""
        raise NotImplementedError

    def on_design(self, design: DqMachine) -> DqMachine:
        return design if self.is_null else design.with_torque(self)
