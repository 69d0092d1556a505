"""Mechanical parts of an actuator, as they act at the wheel: ratio, gears, friction, and the mount with its play.

Strokes, velocities and forces are positive in rebound; a positive force opposes rebound.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from actuator.errors import ActuatorError, require_not_negative, require_positive


@dataclass(frozen=True)
class Ratio:
    """Wheel travel per rotor angle over the stroke, tau_t(dz) (thesis eqs 3.3, 3.42), straight between the points.

    stroke: from static equilibrium [m], rising, rebound positive; value: tau_t at each of them [m/rad], of one sign
    Beyond the ends the last value stays. Raises ActuatorError for a table that does not rise or a ratio of zero.
    """

    stroke: tuple[float, ...]
    value: tuple[float, ...]

    def __post_init__(self) -> None:
        x, tau = np.array(self.stroke, dtype=float), np.array(self.value, dtype=float)
        sound = x.shape == tau.shape and x.size >= 1 and np.isfinite(x).all() and np.isfinite(tau).all()
        if not (sound and (np.diff(x) > 0).all() and (tau > 0).all()):
            raise ActuatorError(
                "transmission ratio: expected positive finite ratios over strokes that rise, found "
                f"{tau.size} ratios over {x.size} strokes; correct the table"
            )

    @property
    def nominal(self) -> float:
        """At static equilibrium [m/rad]."""
        return float(self.at(0.0))

    def at(self, stroke: float | np.ndarray) -> np.ndarray:
        """tau_t [m/rad], of that shape; stroke: [m], any shape."""
        return np.asarray(np.interp(stroke, self.stroke, self.value))

    def angle(self, stroke: float) -> float:
        """Of the rotor from static equilibrium [rad], the integral of dz / tau_t(z), exact; stroke: [m]."""
        low, high = sorted((0.0, stroke))
        z = np.array([low, *(knot for knot in self.stroke if low < knot < high), high])
        tau = self.at(z)
        rise = np.diff(np.log(tau))
        level = np.where(rise == 0, 1.0, rise)
        mean = np.where(rise == 0, tau[1:], np.diff(tau) / level)  # logarithmic mean of a ratio that goes straight
        return float(np.copysign(np.sum(np.diff(z) / mean), stroke))


def fixed_ratio(value: float) -> Ratio:
    """The same ratio over the whole stroke; value: tau_t [m/rad]."""
    return Ratio((0.0,), (value,))


@dataclass(frozen=True)
class GearEfficiency:
    """Shares that the meshes let through (``gearbox.efficiency``).

    driven: share when the output drives the rotor; driving: share when the rotor drives the output
    The loss goes with the force at the output, the inertia of the rotor included, and turns its sign with the motion.
    """

    driven: float = 1.0
    driving: float = 1.0

    def __post_init__(self) -> None:
        for name, value in (("driven", self.driven), ("driving", self.driving)):
            if not 0 < value <= 1:
                raise ActuatorError(
                    f"gears: the efficiency when {name} must lie above 0 and not above 1, found {value:g}; correct it"
                )

    def through(self, behind: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Force at the output while nothing accelerates [N], of the broadcast shape: F / eta where the output drives,
        F eta where the rotor does.

        behind: F of friction and rotor behind the meshes [N]; velocity: of the output [m/s], which broadcast
        """
        return np.where(behind * velocity > 0, behind / self.driven, behind * self.driving)


LOSSLESS = GearEfficiency()


@dataclass(frozen=True)
class MechanicalLoss:
    """Friction of what turns, at the wheel and the nominal ratio: F = c v + F_c clip(v / v_b).

    viscous: c [Ns/m] (the mechanical loss of thesis Fig. 4.6); coulomb: F_c [N]; breakaway_speed: v_b, below which the
    dry friction is proportional to the velocity, and below which the loss of the gears fades [m/s]
    """

    viscous: float = 0.0
    coulomb: float = 0.0
    breakaway_speed: float = 5e-3

    def __post_init__(self) -> None:
        require_not_negative("mechanical loss", viscous=self.viscous, coulomb=self.coulomb)
        require_positive("mechanical loss", breakaway_speed=self.breakaway_speed)


NO_LOSS = MechanicalLoss()


class Mount:
    """What lies between the suspension and the equivalent mass; the concrete mounts are below."""


@dataclass(frozen=True)
class RigidMount(Mount):
    """The equivalent mass moves with the suspension."""


RIGID = RigidMount()


@dataclass(frozen=True)
class CompliantMount(Mount):
    """Spring and damper behind a play, with a smooth contact (the translational hard stop of thesis Fig. 4.6).

    F = s (K (|d| - b) sign(d) + D d') + c_m d',   s = 3 l^2 - 2 l^3,   l = clip((|d| - b) / transition)

    d: suspension minus equivalent mass; the contact (s > 0) begins at the play b on either side.
    stiffness: K [N/m]; damping: c_m, acts in the play too [Ns/m]; play: b, half of the whole clearance [m];
    contact_damping: D, in both directions [Ns/m]; transition: over which stiffness and damping rise [m], 0: at once
    Without play and transition it is a spring with a damper beside it (Table B.1).
    The force law is that of Simscape's hard stop with stiffness and damping applied smoothly through a transition
    region, damped rebound, as its manual describes it; the thesis names no version and prints no equation.
    """

    stiffness: float
    damping: float = 0.0
    play: float = 0.0
    contact_damping: float = 0.0
    transition: float = 0.0

    def __post_init__(self) -> None:
        require_positive("compliant mount", stiffness=self.stiffness)
        require_not_negative(
            "compliant mount",
            damping=self.damping,
            play=self.play,
            contact_damping=self.contact_damping,
            transition=self.transition,
        )

    def engagement(self, deformation: float | np.ndarray) -> np.ndarray:
        """s, dimensionless, of that shape: 0 in the play, 1 beyond the transition; deformation: [m], any shape."""
        beyond = np.abs(deformation) - self.play
        if self.transition == 0:
            return np.where(beyond > 0, 1.0, 0.0)
        share = np.clip(beyond / self.transition, 0.0, 1.0)
        return np.asarray(share**2 * (3 - 2 * share))

    def force(self, deformation: float | np.ndarray, rate: float | np.ndarray) -> np.ndarray:
        """[N], of that shape; deformation: d [m], any shape; rate: d' [m/s], any shape."""
        beyond = np.sign(deformation) * np.maximum(np.abs(deformation) - self.play, 0.0)
        contact = self.stiffness * beyond + self.contact_damping * rate
        return np.asarray(self.engagement(deformation) * contact + self.damping * rate)

    def tangent(self, deformation: float) -> tuple[float, float]:
        """Stiffness dF/dd [N/m] and damping dF/dd' [Ns/m] at rest at a deformation [m]."""
        beyond, s = max(abs(deformation) - self.play, 0.0), float(self.engagement(deformation))
        share = min(beyond / self.transition, 1.0) if self.transition else 1.0
        steepening = 6 * share * (1 - share) / self.transition if self.transition else 0.0
        return self.stiffness * (s + steepening * beyond), s * self.contact_damping + self.damping

    def deformation(self, force: float) -> float:
        """d, positive, where the mount holds a load [m].

        force: the load [N], its magnitude counts
        """
        wanted, most = abs(force), self.play + self.transition + abs(force) / self.stiffness
        return float(brentq(lambda d: float(self.force(d, 0.0)) - wanted, 0.0, most, xtol=1e-12)) if wanted else 0.0

    def energy(self, deformation: float | np.ndarray) -> np.ndarray:
        """Elastic energy [J], of that shape, the integral of s K (|d| - b); deformation: [m], any shape."""
        beyond = np.maximum(np.abs(deformation) - self.play, 0.0)
        if self.transition == 0:
            return np.asarray(self.stiffness * beyond**2 / 2)
        share = np.minimum(beyond / self.transition, 1.0)
        rising = self.transition**2 * (3 / 4 * share**4 - 2 / 5 * share**5)
        return np.asarray(self.stiffness * (rising + np.maximum(beyond**2 - self.transition**2, 0.0) / 2))
