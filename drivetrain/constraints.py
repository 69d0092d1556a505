"""What a machine of given cross-section must be able to do, each as a smallest active length over the ratio.

A constraint does not know whether it is enforced: the caller hands it to the match among the enforced or among the
reported ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, sin

import numpy as np

from units import MILLIMETRE

CAPABILITY_SLACK = 1e-6  # relative; a capability this close below its requirement is met
Numbers = float | np.ndarray  # one value or an array of any shape


class Constraint:
    """One limit on the pair (transmission ratio tau_t [m/rad], active length l_em [m])."""

    name: str = "constraint"

    def minimum_length(self, ratio: Numbers) -> Numbers:
        """Smallest active length allowed at these ratios [m], same shape as ``ratio``; not falling in the ratio."""
        return np.zeros_like(np.asarray(ratio, dtype=float))[()]

    def maximum_length(self) -> float:
        """Largest active length allowed [m]."""
        return inf

    def minimum_ratio(self) -> float:
        """Smallest transmission ratio allowed [m/rad]."""
        return 0.0

    def violation(self, ratio: float, length: float) -> str | None:
        """Sentence on what is missing and what it would take, or None when the constraint is met.

        ratio: tau_t [m/rad]; length: l_em [m]
        """
        raise NotImplementedError


class _Force(Constraint):
    """l_em >= F tau_t / r_Tl (3.66) for one force and one torque per length."""

    force: float
    torque_per_length: float

    def minimum_length(self, ratio: Numbers) -> Numbers:
        return self.force / self.torque_per_length * np.asarray(ratio, dtype=float)[()]

    def capability(self, ratio: float, length: float) -> float:
        """Force at the wheel, r_Tl l_em / tau_t [N]; ratio: tau_t [m/rad]."""
        return self.torque_per_length * length / ratio

    def violation(self, ratio: float, length: float) -> str | None:
        reached = self.capability(ratio, length)
        if reached >= self.force * (1 - CAPABILITY_SLACK):
            return None
        return (
            f"{self.name} {reached:.0f} N is {self.force - reached:.0f} N below the requirement of {self.force:.0f} N; "
            f"at {ratio / MILLIMETRE:.3g} mm/rad it would need {self.minimum_length(ratio) / MILLIMETRE:.1f} mm of "
            f"active length instead of {length / MILLIMETRE:.1f} mm"
        )


@dataclass(frozen=True)
class NominalForce(_Force):
    """RMS force at the nominal current density (3.67, 3.95): force [N], torque_per_length [Nm/m]."""

    force: float
    torque_per_length: float
    name: str = "nominal force"


@dataclass(frozen=True)
class OverloadForce(_Force):
    """Peak force at the overload current density (3.69, 3.96): force [N], torque_per_length [Nm/m] there."""

    force: float
    torque_per_length: float
    name: str = "overload force"


@dataclass(frozen=True)
class RegenerativeDamping(Constraint):
    """Damping of the short-circuited machine, c = alpha l^2 / (l + l_et) / tau_t^2 (3.92).

    damping: c required [Ns/m], 0 where none is; alpha: [Ns m/rad^2 per metre], see ``damping_coefficient``;
        end_turn_length: [m]
    Equations 3.94 and 3.97 call required and available damping by mixed names; the available one must not be smaller.
    """

    damping: float
    alpha: float
    end_turn_length: float
    name: str = "regenerative damping"

    def minimum_length(self, ratio: Numbers) -> Numbers:
        """Positive root of a l^2 - l - l_et = 0 with a = alpha / (c tau_t^2) [m] (3.94); 0 for no damping.

        ratio: tau_t [m/rad]
        """
        if self.damping == 0:
            return super().minimum_length(ratio)
        a = self.alpha / (self.damping * np.asarray(ratio, dtype=float) ** 2)
        return ((1 + np.sqrt(1 + 4 * self.end_turn_length * a)) / (2 * a))[()]

    def capability(self, ratio: float, length: float) -> float:
        """Largest damping coefficient at the wheel [Ns/m] (3.92); ratio: tau_t [m/rad]."""
        return self.alpha * length**2 / (length + self.end_turn_length) / ratio**2

    def violation(self, ratio: float, length: float) -> str | None:
        """See ``Constraint``; ratio: tau_t [m/rad]."""
        reached = self.capability(ratio, length)
        if reached >= self.damping * (1 - CAPABILITY_SLACK):
            return None
        return (
            f"{self.name} {reached / 1e3:.1f} kNs/m is {(self.damping - reached) / 1e3:.1f} kNs/m below the "
            f"requirement of {self.damping / 1e3:g} kNs/m; at {ratio / MILLIMETRE:.3g} mm/rad it would need "
            f"{self.minimum_length(ratio) / MILLIMETRE:.1f} mm of active length instead of "
            f"{length / MILLIMETRE:.1f} mm, or {self.damping / reached:.2f} times the squared torque per length for "
            "the same copper"
        )


@dataclass(frozen=True)
class SpeedLimit(Constraint):
    """tau_t >= v_max / omega_max (3.64): velocity [m/s] at the wheel, speed [rad/s] of the rotor."""

    velocity: float
    speed: float
    name: str = "rotor speed"

    def minimum_ratio(self) -> float:
        """v_max / omega_max [m/rad]."""
        return abs(self.velocity) / self.speed

    def violation(self, ratio: float, length: float) -> str | None:
        """See ``Constraint``; ratio: tau_t [m/rad]."""
        if ratio >= self.minimum_ratio() * (1 - CAPABILITY_SLACK):
            return None
        return (
            f"{self.name} {abs(self.velocity) / ratio:.0f} rad/s is above the limit of {self.speed:.0f} rad/s; it "
            f"would need a transmission ratio of {self.minimum_ratio() / MILLIMETRE:.3f} mm/rad at least"
        )


@dataclass(frozen=True)
class LengthLimit(Constraint):
    """l_em <= l_max (3.62): packaging and a rotor that is not too slender; length [m]."""

    length: float
    name: str = "active length"

    def maximum_length(self) -> float:
        return self.length

    def violation(self, ratio: float, length: float) -> str | None:
        """See ``Constraint``; ratio: tau_t [m/rad]."""
        if length <= self.length * (1 + CAPABILITY_SLACK):
            return None
        return f"{self.name} {length / MILLIMETRE:.1f} mm is above the limit of {self.length / MILLIMETRE:.1f} mm"


def largest_stage_ratio(planets: int) -> float:
    """Stage ratio i (dimensionless) at which the pitch circles of neighbouring planets touch; 14.93 for three planets.

    i = 2 / (1 - sin(pi/n))

    d_carrier sin(pi/n) > d_planet with d_carrier = d_ring i / (2 (i - 1)), d_planet = d_ring (i - 2) / (2 (i - 1))
    planets: n, two or more; two clear each other at any ratio
    """
    between = sin(pi / planets)
    return inf if between == 1 else 2 / (1 - between)


@dataclass(frozen=True)
class PlanetClearance(Constraint):
    """tau_t >= tau_l / i_max^N: neighbouring planets of N equal stages clear each other.

    stage_count: N, 0 for a direct drive, whose only ratio is tau_l; planets: of a stage; linkage_ratio: tau_l [m/rad]
    """

    stage_count: int
    planets: int
    linkage_ratio: float
    name: str = "planet clearance"

    def minimum_ratio(self) -> float:
        """tau_l / i_max^N [m/rad], 0 for a direct drive."""
        if self.stage_count == 0:
            return 0.0
        touching = self.linkage_ratio / largest_stage_ratio(self.planets) ** self.stage_count
        return touching * (1 + CAPABILITY_SLACK)

    def violation(self, ratio: float, length: float) -> str | None:
        """See ``Constraint``; ratio: tau_t [m/rad]."""
        if ratio >= self.minimum_ratio() * (1 - CAPABILITY_SLACK):
            return None
        stage_ratio = (self.linkage_ratio / ratio) ** (1 / self.stage_count)
        return (
            f"{self.planets} planets overlap at a stage ratio of {stage_ratio:.2f}, they clear each other below "
            f"{largest_stage_ratio(self.planets):.2f}; it would need more stages, or "
            f"{self.minimum_ratio() / MILLIMETRE:.3f} mm/rad at least"
        )


def damping_coefficient(
    *,
    torque_per_length: float,
    current_density: float,
    coils_in_series: int,
    resistivity: float,
    packing: float,
    coil_side_area: float,
) -> float:
    """alpha_em = r_Tl^2 / (6 N_c rho k_cp A_s J^2) [Ns m/rad^2 per metre] (3.91).

    torque_per_length: [Nm/m] at current_density, RMS [A/m^2 of copper]; resistivity [ohm m]; packing k_cp;
    coil_side_area A_s [m^2]. The turns cancel. ``capability`` with the thesis's numbers is 27.4 kNs/m at 2.3 mm/rad
    and 36 mm, not the 40 kNs/m required.
    """
    copper = packing * coil_side_area
    return torque_per_length**2 / (6 * coils_in_series * resistivity * copper * current_density**2)
