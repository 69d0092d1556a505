"""What a machine of given cross-section must be able to do, each as a smallest active length over the ratio.

A constraint does not know whether it is enforced: the caller hands it to the match among the enforced or among the
reported ones. What it violates is data; an ``Output`` words it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, sin
from typing import ClassVar

import numpy as np

from drivetrain.finding import Finding
from drivetrain.output import Output, amount
from units import MILLIMETRE, Values

CAPABILITY_SLACK = 1e-6  # relative; a capability this close below its requirement is met


class Constraint:
    """One limit on the pair (transmission ratio tau_t [m/rad], active length l_em [m]).

    at_most: whether what is reached must not exceed what is needed
    """

    at_most: ClassVar[bool] = False

    def name(self, output: Output) -> str:
        """What is limited, in words."""
        raise NotImplementedError

    def quantity(self, output: Output) -> str:
        """What is reached and needed, in words."""
        return self.name(output)

    def unit(self, output: Output) -> str:
        """Drawing unit of that quantity, a key of ``units.FACTORS``; empty for a pure number."""
        raise NotImplementedError

    @property
    def needed(self) -> float:
        """The limit, in the unit of the limited quantity [SI]."""
        raise NotImplementedError

    def capability(self, ratio: float, length: float) -> float:
        """What is reached, in the unit of ``needed``; ratio: tau_t [m/rad]; length: l_em [m]."""
        raise NotImplementedError

    def remedy(self, violation: Violation, output: Output) -> str:
        """What it would take, as the end of a sentence."""
        raise NotImplementedError

    def minimum_length(self, ratio: Values) -> Values:
        """Smallest active length allowed at these ratios [m], same shape as ``ratio``; not falling in the ratio."""
        return np.zeros_like(np.asarray(ratio, dtype=float))[()]

    def maximum_length(self) -> float:
        """Largest active length allowed [m]."""
        return inf

    def minimum_ratio(self) -> float:
        """Smallest transmission ratio allowed [m/rad]."""
        return 0.0

    def violation(self, ratio: float, length: float) -> Violation | None:
        """What is missing, None when the constraint is met; ratio: tau_t [m/rad]; length: l_em [m]."""
        reached = self.capability(ratio, length)
        if self.at_most:
            met = reached <= self.needed * (1 + CAPABILITY_SLACK)
        else:
            met = reached >= self.needed * (1 - CAPABILITY_SLACK)
        return None if met else Violation(self, reached, ratio, length)


@dataclass(frozen=True)
class Violation(Finding):
    """A constraint that is not met.

    reached: [SI], in the unit of ``constraint.needed``; ratio: tau_t [m/rad]; length: l_em [m]
    """

    constraint: Constraint
    reached: float
    ratio: float
    length: float

    def words(self, output: Output) -> str:
        """What is missing and what it would take."""
        constraint = self.constraint
        reached, needed, apart = (
            amount(value, constraint.unit(output))
            for value in (self.reached, constraint.needed, abs(constraint.needed - self.reached))
        )
        limit = f"above the limit of {needed}" if constraint.at_most else f"{apart} below the requirement of {needed}"
        remedy = constraint.remedy(self, output)
        return f"{constraint.quantity(output)} {reached} is {limit}" + (f"; {remedy}" if remedy else "")


def _longer(violation: Violation, output: Output) -> str:
    """The active length at which a constraint would be met."""
    wanted = violation.constraint.minimum_length(violation.ratio)
    return (
        f"at {output.ratio(violation.ratio)} it would need {wanted / MILLIMETRE:.1f} mm of active length instead of "
        f"{violation.length / MILLIMETRE:.1f} mm"
    )


class _Force(Constraint):
    """l_em >= F tau_t / r_Tl (3.66) for one force and one torque per length."""

    force: float
    torque_per_length: float

    def minimum_length(self, ratio: Values) -> Values:
        return self.force / self.torque_per_length * np.asarray(ratio, dtype=float)[()]

    def capability(self, ratio: float, length: float) -> float:
        """Force (on a shaft: torque) at the output, r_Tl l_em / tau_t [N]; ratio: tau_t [m/rad]."""
        return self.torque_per_length * length / ratio

    @property
    def needed(self) -> float:
        return self.force

    def unit(self, output: Output) -> str:
        return output.effort_unit

    def remedy(self, violation: Violation, output: Output) -> str:
        return _longer(violation, output)


@dataclass(frozen=True)
class NominalForce(_Force):
    """RMS force at the nominal current density (3.67, 3.95): force [N], torque_per_length [Nm/m]."""

    force: float
    torque_per_length: float

    def name(self, output: Output) -> str:
        return f"nominal {output.effort}"


@dataclass(frozen=True)
class OverloadForce(_Force):
    """Peak force at the overload current density (3.69, 3.96): force [N], torque_per_length [Nm/m] there."""

    force: float
    torque_per_length: float

    def name(self, output: Output) -> str:
        return f"overload {output.effort}"


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

    @property
    def needed(self) -> float:
        return self.damping

    def name(self, output: Output) -> str:
        return "regenerative damping"

    def unit(self, output: Output) -> str:
        return output.damping_unit

    def minimum_length(self, ratio: Values) -> Values:
        """Positive root of a l^2 - l - l_et = 0 with a = alpha / (c tau_t^2) [m] (3.94); 0 for no damping.

        ratio: tau_t [m/rad]
        """
        if self.damping == 0:
            return super().minimum_length(ratio)
        a = self.alpha / (self.damping * np.asarray(ratio, dtype=float) ** 2)
        return ((1 + np.sqrt(1 + 4 * self.end_turn_length * a)) / (2 * a))[()]

    def capability(self, ratio: float, length: float) -> float:
        """Largest damping coefficient at the output [Ns/m] (3.92); ratio: tau_t [m/rad]."""
        return self.alpha * length**2 / (length + self.end_turn_length) / ratio**2

    def remedy(self, violation: Violation, output: Output) -> str:
        share = self.damping / violation.reached
        return f"{_longer(violation, output)}, or {share:.2f} times the squared torque per length for the same copper"


@dataclass(frozen=True)
class SpeedLimit(Constraint):
    """tau_t >= v_max / omega_max (3.64): velocity [m/s] at the output (on a shaft its speed), speed [rad/s] of the
    rotor."""

    velocity: float
    speed: float
    at_most: ClassVar[bool] = True

    @property
    def needed(self) -> float:
        return self.speed

    def name(self, output: Output) -> str:
        return "rotor speed"

    def unit(self, output: Output) -> str:
        return "rad_per_s"

    def minimum_ratio(self) -> float:
        """v_max / omega_max [m/rad]."""
        return abs(self.velocity) / self.speed

    def capability(self, ratio: float, length: float) -> float:
        """Speed of the rotor [rad/s]; ratio: tau_t [m/rad]."""
        return abs(self.velocity) / ratio

    def remedy(self, violation: Violation, output: Output) -> str:
        return f"it would need a transmission ratio of {output.ratio(self.minimum_ratio())} at least"


@dataclass(frozen=True)
class LengthLimit(Constraint):
    """l_em <= l_max (3.62): packaging and a rotor that is not too slender; length [m]."""

    length: float
    at_most: ClassVar[bool] = True

    @property
    def needed(self) -> float:
        return self.length

    def name(self, output: Output) -> str:
        return "active length"

    def unit(self, output: Output) -> str:
        return "mm"

    def maximum_length(self) -> float:
        return self.length

    def capability(self, ratio: float, length: float) -> float:
        """The length itself [m]; ratio: tau_t [m/rad]."""
        return length

    def remedy(self, violation: Violation, output: Output) -> str:
        return ""


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
    at_most: ClassVar[bool] = True

    @property
    def needed(self) -> float:
        return largest_stage_ratio(self.planets)

    def name(self, output: Output) -> str:
        return "planet clearance"

    def quantity(self, output: Output) -> str:
        return "stage ratio"

    def unit(self, output: Output) -> str:
        return ""

    def minimum_ratio(self) -> float:
        """tau_l / i_max^N [m/rad], 0 for a direct drive."""
        if self.stage_count == 0:
            return 0.0
        touching = self.linkage_ratio / largest_stage_ratio(self.planets) ** self.stage_count
        return touching * (1 + CAPABILITY_SLACK)

    def capability(self, ratio: float, length: float) -> float:
        """The ratio of one of the equal stages, dimensionless; ratio: tau_t [m/rad]."""
        return (self.linkage_ratio / ratio) ** (1 / self.stage_count) if self.stage_count else 1.0

    def remedy(self, violation: Violation, output: Output) -> str:
        least = output.ratio(self.minimum_ratio())
        return f"above it {self.planets} planets overlap, it would need more stages or {least} at least"


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
