"""Laws of a device that no effect of the library is, run through its model.

A missing law acts in every table at once: a force of the velocity brakes at constant velocity, widens force loops and
raises the impedance. An unknown function of one table (``unknown``) does not know that, and two effects of the library
may take its place. Each law is a family of few numbers that stands for many closed forms:

    a power of one quantity             size |x / x_0|^p
    a drag that thins                   size v (1 + (v / v_c)^2)^((p - 1) / 2)
    a part between spring and dashpot   size (j f / f_0)^(p - 1) (x / x_0)^q, beside the device or as its mount
    a reading that bends                F (1 + size x^n / (1 + x^n)), x = |F| / level

What the family does not follow is left to the error of the law.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from effects.base import Effect, InstrumentEffect, ResponseEffect
from effects.damper_design import Damper
from effects.dq_design import DqMachine
from effects.law_effects import CouplingEffect, FluxEffect, ForceEffect, TorqueEffect
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal, Normal
from workbench.believed import LAW_RATE

VELOCITY, TRAVEL = 0.1, 2e-3  # m/s, m; at a shaft rad/s, rad: where a law of a damper has its size
SWING = 10.0  # Hz, where a part between spring and dashpot has its size
FREQUENCY = 300.0  # rad/s, electrical, where a law of the speed of a machine has its size
TURNING = 100.0  # rad/s, of the shaft, where a law of the speed of a rotor has its size
SHEAR = 1e3  # Pa, a tenth of what a small machine makes in its gap, of which such a law is a share
LOAD = 0.2  # of the current that cancels the magnets, where a law of the current has its size
LAW_ERRORS = (0.01, 0.1)  # relative, of a family: some truths it follows closely, of others it has only the trend
MOST = (-1.0, 3.0)  # of minus ln of a factor
TURN = 0.01  # of where a law has its size, over which its sign turns
QUARTER = (np.arange(16) + 0.5) * np.pi / 32  # angles of a quarter of a sine, over which a bent reading is averaged


@dataclass(frozen=True)
class UnknownLaw(Effect):
    """size: at ``reference``, as a share of ``scale``;  reference, scale: [SI], as the device has them

    error: relative, of the family against the law that it stands for [1]
    """

    goes_with: ClassVar[str]
    model_error = LAW_ERRORS[-1]
    model_error_source = "engineering judgement: how well a family of few numbers follows a law is not known before"
    base_rate = LAW_RATE

    size: float = parameter(
        0.0, "1", prior=Normal(0.1), low=-10.0, high=10.0, source="engineering judgement: a tenth of what is known"
    )
    reference: float = 1.0
    scale: float = 1.0
    error: float = LAW_ERRORS[-1]

    @property
    def law_error(self) -> float:
        return self.error

    @property
    def with_errors(self) -> tuple[UnknownLaw, ...]:
        return tuple(replace(self, error=error) for error in LAW_ERRORS)

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
        return self.goes_with


# ---- powers of one quantity ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class UnknownPower(UnknownLaw):
    """size scale |x / x_0|^power of a quantity x."""

    power: float = parameter(
        1.0, "1", prior=Normal(centre=1.25, sd=0.6), low=0.0, high=4.0, source="textbook: dry friction 0, flow 2"
    )

    def words(self) -> str:
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


def _braking(design: Damper) -> float:
    """Force of that current [N]."""
    return design.force_constant * _short_circuit(design)


@dataclass(frozen=True)
class UnknownForceOfVelocity(UnknownPower, ForceEffect):
    """A force against the motion."""

    goes_with = "a force that goes with the velocity"

    @staticmethod
    def sized(design):
        return VELOCITY, _braking(design)

    def force(self, position, velocity):
        return self.odd(velocity)


@dataclass(frozen=True)
class UnknownForceOfPosition(UnknownPower, ForceEffect):
    """A force towards the middle of the stroke."""

    goes_with = "a force that goes with the position"

    @staticmethod
    def sized(design):
        return TRAVEL, _braking(design)

    def force(self, position, velocity):
        return self.odd(position)


@dataclass(frozen=True)
class UnknownCouplingOfCurrent(UnknownPower, CouplingEffect):
    """A force constant that changes with the current."""

    goes_with = "a force constant that changes with the current"

    @staticmethod
    def sized(design):
        return _short_circuit(design), 1.0

    def coupling(self, position, current):
        return np.exp(-np.clip(self.even(current), *MOST))


@dataclass(frozen=True)
class UnknownCouplingOfPosition(UnknownPower, CouplingEffect):
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
class UnknownTorqueOfSpeed(UnknownPower, TorqueEffect):
    """A torque against the rotation."""

    goes_with = "a torque that goes with the speed"

    @staticmethod
    def sized(design):
        return FREQUENCY / design.pole_pairs, _torque(design)

    def lost_torque(self, speed, torque):
        return self.odd(speed)


@dataclass(frozen=True)
class UnknownTorqueOfLoad(UnknownPower, TorqueEffect):
    """A torque against the rotation that the load makes."""

    goes_with = "a loss of torque that goes with the torque"

    @staticmethod
    def sized(design):
        return _torque(design), _torque(design)

    def lost_torque(self, speed, torque):
        return self.even(torque) * np.tanh(speed)


@dataclass(frozen=True)
class UnknownFluxOfDirectCurrent(UnknownPower, FluxEffect):
    """Flux linkage of the d axis."""

    goes_with = "an inductance L_d that changes with the current"

    @staticmethod
    def sized(design):
        return _load(design), 1.0

    def flux(self, i_d, i_q, machine):
        return -machine.inductance_d * i_d * np.minimum(self.even(i_d), 1.0), np.zeros_like(i_q)


@dataclass(frozen=True)
class UnknownFluxOfQuadratureCurrent(UnknownPower, FluxEffect):
    """Flux linkage of the q axis."""

    goes_with = "an inductance L_q that changes with the current"

    @staticmethod
    def sized(design):
        return _load(design), 1.0

    def flux(self, i_d, i_q, machine):
        return np.zeros_like(i_d), -machine.inductance_q * i_q * np.minimum(self.even(i_q), 1.0)


@dataclass(frozen=True)
class UnknownDropOfCurrent(UnknownPower, ResponseEffect):
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
class UnknownTorqueOfRotor(UnknownPower, ResponseEffect):
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


# ---- other laws of a damper ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class UnknownThinningForce(UnknownLaw, ForceEffect):
    """A force against the motion that is a dashpot's up to a corner and goes with a lower power beyond it: fluids and
    greases that thin, parts that slip (Carreau 1972; with power 0 it saturates)."""

    goes_with = "a force that goes with the velocity and thins"

    corner: float = parameter(
        0.05,
        "m/s",
        prior=LogNormal(0.05, 0.8),
        low=1e-3,
        high=10.0,
        source="engineering judgement: within the velocities of a test; far below them it is dry friction",
    )
    power: float = parameter(
        0.3, "1", prior=Normal(centre=0.3, sd=0.25), low=0.0, high=1.0, source="textbook: greases and melts 0.2 to 0.6"
    )

    @staticmethod
    def sized(design):
        return VELOCITY, _braking(design)

    def words(self) -> str:
        return f"{self.goes_with} to the power {self.power:.2g} beyond {self.corner:.2g} m/s"

    def force(self, position, velocity):
        x, at_reference = velocity / self.corner, self.reference / self.corner
        size = self.size * self.scale / self._thinned(at_reference)
        return size * self._thinned(x)

    def _thinned(self, x):
        """x (1 + x^2)^((power - 1) / 2)."""
        return x * (1.0 + x**2) ** (0.5 * (self.power - 1.0))


@dataclass(frozen=True)
class UnknownPart(UnknownLaw, ResponseEffect):
    """A part between spring (power 0), dashpot (1) and mass (2), of impedance size scale (j f / f_0)^(power - 1)
    (x / x_0)^amplitude_power [N s/m], x the amplitude: rubber, felt, creep, boundary layers (Bagley and Torvik 1983);
    filled rubber is softer at large strokes (Payne 1962).

    Validity: impedance tables; in steady motion it carries nothing, and loops in time are left as they are.
    """

    designs = (Damper,)

    size: float = parameter(
        0.0, "1", prior=LogNormal(0.03, 1.2), low=0.0, high=10.0, source="engineering judgement: some per cent"
    )
    power: float = parameter(
        0.5, "1", prior=Normal(centre=0.5, sd=0.4), low=0.0, high=2.0, source="textbook: spring 0, dashpot 1, mass 2"
    )
    amplitude_power: float = parameter(
        0.0, "1", prior=Normal(0.4), low=-1.0, high=1.0, source="textbook: filled rubber -0.2 to -0.6, a linear part 0"
    )

    @staticmethod
    def sized(design):
        return SWING, design.force_constant**2 / design.internal_resistance

    def words(self) -> str:
        between = f"{self.goes_with} that stands at {self.power:.2g} between spring (0) and dashpot (1)"
        return f"{between} and goes with the amplitude to the power {self.amplitude_power:.2g}"

    def part(self, frequency: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        """(j f / f_0)^(power - 1) (x / x_0)^amplitude_power [1]."""
        return (1j * frequency / self.reference) ** (self.power - 1.0) * (amplitude / TRAVEL) ** self.amplitude_power

    def together(self, impedance: np.ndarray, part: np.ndarray) -> np.ndarray:
        """Impedance of the device with the part [N s/m]."""
        raise NotImplementedError

    def on_response(self, response, conditions, kind, design):
        if kind != "impedance" or self.is_null:
            return response
        part = self.part(conditions["frequency"], conditions["amplitude"])
        z = self.together(response["re"] + 1j * response["im"], part)
        return {**response, "re": z.real, "im": z.imag}


@dataclass(frozen=True)
class UnknownPartBeside(UnknownPart):
    """In parallel with the device."""

    goes_with = "a force beside the device"

    def together(self, impedance, part):
        return impedance + self.size * self.scale * part


@dataclass(frozen=True)
class UnknownMount(UnknownPart):
    """In series: what carries the device gives. The same size is what it gives over what it carries."""

    goes_with = "a lossy mount"

    power: float = parameter(
        0.2, "1", prior=LogNormal(0.2, 0.7), low=0.0, high=1.0, source="textbook: loss factors of rubber 0.1 to 0.5"
    )

    def together(self, impedance, part):
        return impedance / (1.0 + impedance * self.size / (self.scale * part))


@dataclass(frozen=True)
class UnknownBendOfForce(UnknownLaw, InstrumentEffect):
    """The force amplifier has another gain beyond a level; the fundamental of a sine of amplitude F_0 takes the mean of
    2 sin^2 times the gain (describing function, Gelb and Vander Velde 1968).

    Validity: force and impedance; slopes of lines are left as they are.
    """

    goes_with = "a gain of the force reading that changes"
    designs = (Damper,)
    SHARPNESS: ClassVar[tuple[float, ...]] = (2.0, 8.0)

    size: float = parameter(
        0.0, "1", prior=Normal(0.03), low=-0.5, high=0.5, source="data sheet class: uncalibrated ranges 1 to 3 %"
    )
    level: float = parameter(
        0.2, "1", prior=LogNormal(0.2, 1.0), low=1e-4, high=100.0, source="anywhere within the readings of a test"
    )
    sharpness: float = 2.0

    @staticmethod
    def sized(design):
        return _braking(design), 1.0

    @classmethod
    def variants(cls, design):
        reference, scale = cls.sized(design)
        return tuple(cls(reference=reference, scale=scale, sharpness=n) for n in cls.SHARPNESS)

    def words(self) -> str:
        return f"{self.goes_with} beyond {self.level * self.reference:.2g} N"

    def gain(self, force: np.ndarray) -> np.ndarray:
        """Reading over force [1]."""
        x = np.abs(force) / (self.level * self.reference)
        return 1.0 + self.size / (1.0 + np.maximum(x, 1e-9) ** -self.sharpness)

    def on_reading(self, response, conditions, kind):
        if self.is_null:
            return response
        if "force" in response:
            return {**response, "force": response["force"] * self.gain(response["force"])}
        return self._on_impedance(response, conditions) if kind == "impedance" else response

    def _on_impedance(self, response, conditions):
        force = np.hypot(response["re"], response["im"]) * 2 * np.pi * conditions["frequency"] * conditions["amplitude"]
        factor = np.mean(2 * np.sin(QUARTER) ** 2 * self.gain(force[:, None] * np.sin(QUARTER)), axis=1)
        return {**response, "re": response["re"] * factor, "im": response["im"] * factor}


LAWS: Mapping[str, type[UnknownLaw]] = {
    law.name(): law
    for law in (
        UnknownForceOfVelocity,
        UnknownForceOfPosition,
        UnknownCouplingOfCurrent,
        UnknownCouplingOfPosition,
        UnknownThinningForce,
        UnknownPartBeside,
        UnknownMount,
        UnknownBendOfForce,
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
    return names if LAWS.keys().isdisjoint(names) else names.difference(LAWS)
