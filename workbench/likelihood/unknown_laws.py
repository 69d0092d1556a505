"""Laws of a device that no effect of the library is, run through its model: size |x|^power of one quantity x.

A missing law acts in every table at once: a force of the velocity brakes at constant velocity, widens force loops and
raises the impedance. An unknown function of one table (``unknown``) does not know that, and two effects of the library
may take its place. What the power does not follow is left to the error of the law.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from effects.base import Effect, ResponseEffect
from effects.damper_design import Damper
from effects.dq_design import DqMachine
from effects.law_effects import CouplingEffect, FluxEffect, ForceEffect, TorqueEffect
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import Normal
from workbench.believed import LAW_RATE

VELOCITY, TRAVEL = 0.1, 2e-3  # m/s, m; at a shaft rad/s, rad: where a law of a damper has its size
FREQUENCY = 300.0  # rad/s, electrical, where a law of the speed of a machine has its size
TURNING = 100.0  # rad/s, of the shaft, where a law of the speed of a rotor has its size
SHEAR = 1e3  # Pa, a tenth of what a small machine makes in its gap, of which such a law is a share
LOAD = 0.2  # of the current that cancels the magnets, where a law of the current has its size
MOST = (-1.0, 3.0)  # of minus ln of a factor
TURN = 0.01  # of where a law has its size, over which its sign turns


@dataclass(frozen=True)
class UnknownLaw(Effect):
    """size: at ``reference``, as a share of ``scale``;  reference, scale: [SI], as the device has them"""

    goes_with: ClassVar[str]
    model_error = 0.1
    model_error_source = "a law that nobody knows is followed by a power of one quantity to a tenth"
    base_rate = LAW_RATE

    size: float = parameter(
        0.0, "1", prior=Normal(0.1), low=-10.0, high=10.0, source="engineering judgement: a tenth of what is known"
    )
    power: float = parameter(
        1.0, "1", prior=Normal(centre=1.25, sd=0.6), low=0.0, high=4.0, source="textbook: dry friction 0, flow 2"
    )
    reference: float = 1.0
    scale: float = 1.0

    @staticmethod
    def sized(design) -> tuple[float, float]:
        """Reference and scale of the law for a device [SI]."""
        raise NotImplementedError

    @classmethod
    def variants(cls, design):
        reference, scale = cls.sized(design)
        return (cls(reference=reference, scale=scale),)

    @property
    def is_null(self) -> bool:
        return self.size == 0.0

    def words(self) -> str:
        """For people."""
        return f"{self.goes_with} to the power {self.power:.2g}"

    def even(self, x: np.ndarray) -> np.ndarray:
        """size scale |x / x_0|^power."""
        return self.size * self.scale * np.abs(x / self.reference) ** self.power

    def odd(self, x: np.ndarray) -> np.ndarray:
        """The same with the sign of x."""
        return self.even(x) * x / np.hypot(x, TURN * self.reference)


def _short_circuit(design: Damper) -> float:
    """Current of the shorted damper at ``VELOCITY`` [A]."""
    return design.force_constant * VELOCITY / design.internal_resistance


@dataclass(frozen=True)
class UnknownForceOfVelocity(UnknownLaw, ForceEffect):
    """A force against the motion."""

    goes_with = "a force that goes with the velocity"

    @staticmethod
    def sized(design):
        return VELOCITY, design.force_constant * _short_circuit(design)

    def force(self, position, velocity):
        return self.odd(velocity)


@dataclass(frozen=True)
class UnknownForceOfPosition(UnknownLaw, ForceEffect):
    """A force towards the middle of the stroke."""

    goes_with = "a force that goes with the position"

    @staticmethod
    def sized(design):
        return TRAVEL, design.force_constant * _short_circuit(design)

    def force(self, position, velocity):
        return self.odd(position)


@dataclass(frozen=True)
class UnknownCouplingOfCurrent(UnknownLaw, CouplingEffect):
    """A force constant that changes with the current."""

    goes_with = "a force constant that changes with the current"

    @staticmethod
    def sized(design):
        return _short_circuit(design), 1.0

    def coupling(self, position, current):
        return np.exp(-np.clip(self.even(current), *MOST))


@dataclass(frozen=True)
class UnknownCouplingOfPosition(UnknownLaw, CouplingEffect):
    """A force constant that changes over the stroke."""

    goes_with = "a force constant that changes with the position"

    @staticmethod
    def sized(design):
        return TRAVEL, 1.0

    def coupling(self, position, current):
        return np.exp(-np.clip(self.even(position), *MOST))


def _load(design: DqMachine) -> float:
    """``LOAD`` as a current [A]."""
    return LOAD * design.psi_m / design.inductance_d


def _torque(design: DqMachine) -> float:
    """Torque of that current [Nm]."""
    return 1.5 * design.pole_pairs * design.psi_m * _load(design)


@dataclass(frozen=True)
class UnknownTorqueOfSpeed(UnknownLaw, TorqueEffect):
    """A torque against the rotation."""

    goes_with = "a torque that goes with the speed"

    @staticmethod
    def sized(design):
        return FREQUENCY / design.pole_pairs, _torque(design)

    def lost_torque(self, speed, torque):
        return self.odd(speed)


@dataclass(frozen=True)
class UnknownTorqueOfLoad(UnknownLaw, TorqueEffect):
    """A torque against the rotation that the load makes."""

    goes_with = "a loss of torque that goes with the torque"

    @staticmethod
    def sized(design):
        return _torque(design), _torque(design)

    def lost_torque(self, speed, torque):
        return self.even(torque) * np.tanh(speed)


@dataclass(frozen=True)
class UnknownFluxOfDirectCurrent(UnknownLaw, FluxEffect):
    """Flux linkage of the d axis."""

    goes_with = "an inductance L_d that changes with the current"

    @staticmethod
    def sized(design):
        return _load(design), 1.0

    def flux(self, i_d, i_q, machine):
        return -machine.inductance_d * i_d * np.minimum(self.even(i_d), 1.0), np.zeros_like(i_q)


@dataclass(frozen=True)
class UnknownFluxOfQuadratureCurrent(UnknownLaw, FluxEffect):
    """Flux linkage of the q axis."""

    goes_with = "an inductance L_q that changes with the current"

    @staticmethod
    def sized(design):
        return _load(design), 1.0

    def flux(self, i_d, i_q, machine):
        return np.zeros_like(i_d), -machine.inductance_q * i_q * np.minimum(self.even(i_q), 1.0)


@dataclass(frozen=True)
class UnknownDropOfCurrent(UnknownLaw, ResponseEffect):
    """A voltage along the current between what is commanded and the machine."""

    goes_with = "a voltage that goes with the current"
    designs = (DqMachine,)

    @staticmethod
    def sized(design):
        return _load(design), 0.1 * FREQUENCY * design.psi_m

    def on_response(self, response, conditions, kind, design):
        if kind != "dq_operation":
            return response
        size = np.hypot(conditions["i_d"], conditions["i_q"])
        along = self.odd(size) / np.maximum(size, 1e-12)
        more = {f"v_{axis}": response[f"v_{axis}"] + along * conditions[f"i_{axis}"] for axis in "dq"}
        return {**response, **more}


@dataclass(frozen=True)
class UnknownTorqueOfRotor(UnknownLaw, ResponseEffect):
    """A torque against the rotation of a machine with a field of its own, wherever the speed is known."""

    goes_with = "a torque that goes with the speed"
    designs = (MachineAsBuilt,)

    @staticmethod
    def sized(design):
        radius = design.cross_section.mid_gap_radius
        return TURNING, SHEAR * 2 * np.pi * radius**2 * design.length

    def on_response(self, response, conditions, kind, design):
        if "torque" not in response or "speed" not in conditions:
            return response
        return {**response, "torque": response["torque"] - self.odd(conditions["speed"])}


LAWS: Mapping[str, type[UnknownLaw]] = {
    law.name(): law
    for law in (
        UnknownForceOfVelocity,
        UnknownForceOfPosition,
        UnknownCouplingOfCurrent,
        UnknownCouplingOfPosition,
        UnknownTorqueOfSpeed,
        UnknownTorqueOfLoad,
        UnknownFluxOfDirectCurrent,
        UnknownFluxOfQuadratureCurrent,
        UnknownDropOfCurrent,
        UnknownTorqueOfRotor,
    )
}


def without_laws(names: frozenset[str]) -> frozenset[str]:
    """The effects of the library among names."""
    return names.difference(LAWS)
