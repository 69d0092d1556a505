"""Vehicles: a motorcycle of four degrees of freedom and a quarter car, both a rigid body on axles.

Heights are counted upwards from the static equilibrium, pitch is positive with the front up. All suspension
quantities are at the wheel. The last axle carries the actuator.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, inf

import numpy as np
from scipy.linalg import eigh

from units import GRAVITY
from vehicle.damping import DamperCurve
from vehicle.errors import VehicleError, require_not_negative, require_positive


@dataclass(frozen=True)
class Tyre:
    """Vertical spring that cannot pull (thesis eqs 3.12, 4.5); stiffness k_u [N/m]."""

    stiffness: float

    def __post_init__(self) -> None:
        require_positive("tyre", stiffness=self.stiffness)


@dataclass(frozen=True)
class EndStops:
    """Springs that act beyond the free stroke (thesis eq. 3.16).

    bump, rebound: strokes from static equilibrium [m]; stiffness: k_stop [N/m]
    """

    bump: float
    rebound: float
    stiffness: float

    def __post_init__(self) -> None:
        if not self.bump < 0 < self.rebound:
            raise VehicleError(
                f"end stops: bump must be below and rebound above the static position, found {self.bump:g} and "
                f"{self.rebound:g} m; correct the strokes"
            )
        require_not_negative("end stops", stiffness=self.stiffness)


NO_STOPS = EndStops(-inf, inf, 0.0)


@dataclass(frozen=True)
class Axle:
    """One wheel with its suspension.

    position: ahead of the centre of gravity [m]; sprung_mass: share of the body that rests on it [kg];
    unsprung_mass [kg]; spring_stiffness: k_s at the wheel [N/m]; tyre; stops.
    """

    position: float
    sprung_mass: float
    unsprung_mass: float
    spring_stiffness: float
    tyre: Tyre
    stops: EndStops = NO_STOPS

    def __post_init__(self) -> None:
        require_positive(
            "axle",
            sprung_mass=self.sprung_mass,
            unsprung_mass=self.unsprung_mass,
            spring_stiffness=self.spring_stiffness,
        )

    @property
    def static_load(self) -> float:
        """Force between tyre and road at rest [N]."""
        return (self.sprung_mass + self.unsprung_mass) * GRAVITY

    @property
    def static_spring_deflection(self) -> float:
        """Compression of the spring at rest [m]."""
        return self.sprung_mass * GRAVITY / self.spring_stiffness

    @property
    def static_tyre_deflection(self) -> float:
        """Compression of the tyre at rest [m]; lifted further than this it leaves the road."""
        return self.static_load / self.tyre.stiffness


class Vehicle:
    """A body on axles, front first. The concrete vehicles give the attributes named here.

    sprung_mass [kg], pitch_inertia [kg m^2], cog_height: centre of gravity above the road [m];
    axles: (n,); passive_dampers: curves of all axles but the last, (n - 1,).
    """

    sprung_mass: float
    pitch_inertia: float
    cog_height: float

    @property
    def axles(self) -> tuple[Axle, ...]:
        """All axles, front first."""
        raise NotImplementedError

    @property
    def passive_dampers(self) -> tuple[DamperCurve, ...]:
        """Curves of all axles but the last."""
        raise NotImplementedError

    @property
    def actuated(self) -> Axle:
        """The axle with the actuator."""
        return self.axles[-1]

    @property
    def total_mass(self) -> float:
        """Body and wheels [kg]."""
        return self.sprung_mass + sum(axle.unsprung_mass for axle in self.axles)

    def delays(self, speed: float) -> tuple[float, ...]:
        """Time after the first wheel at which each wheel meets the same point of the road [s] (3.18-3.19).

        speed: of the vehicle [m/s]

        z_r,r(t) = z_r(t - (l_f + l_r) / v): the thesis prints t + Delta t, but the rear wheel comes later.
        """
        first = self.axles[0].position
        return tuple((first - axle.position) / speed if axle.position != first else 0.0 for axle in self.axles)

    @property
    def stretch_matrix(self) -> np.ndarray:
        """Suspension strokes from body height, sine of the pitch, wheel heights [1, m, 1], (n, 2 + n).

        Thesis eqs 3.10-3.11, 3.15.
        """
        positions = np.array([[axle.position] for axle in self.axles])
        count = len(self.axles)
        return np.hstack([np.ones((count, 1)), positions, -np.eye(count)])

    @property
    def natural_frequencies(self) -> np.ndarray:
        """Undamped natural frequencies about static equilibrium [Hz], (2 + n,), rising."""
        strokes = self.stretch_matrix
        stiffness = strokes.T @ np.diag([axle.spring_stiffness for axle in self.axles]) @ strokes
        stiffness += np.diag([0.0, 0.0, *(axle.tyre.stiffness for axle in self.axles)])
        masses = np.diag([self.sprung_mass, self.pitch_inertia, *(axle.unsprung_mass for axle in self.axles)])
        return _frequencies(stiffness, masses)

    @property
    def rigid_tyre_frequencies(self) -> np.ndarray:
        """The same of the body alone, with the wheels held [Hz], (2,)."""
        body = self.stretch_matrix[:, :2]
        stiffness = body.T @ np.diag([axle.spring_stiffness for axle in self.axles]) @ body
        return _frequencies(stiffness, np.diag([self.sprung_mass, self.pitch_inertia]))


def _frequencies(stiffness: np.ndarray, masses: np.ndarray) -> np.ndarray:
    return np.sqrt(np.maximum(eigh(stiffness, masses, eigvals_only=True), 0)) / (2 * np.pi)


@dataclass(frozen=True)
class Motorcycle(Vehicle):
    """Body with bounce and pitch on two wheels (thesis Fig. 3.6, eqs 3.8-3.16), the actuator at the rear.

    sprung_mass m_s [kg], pitch_inertia J_s [kg m^2], cog_height h_COG [m], front and rear axle, front_damper.
    The static loads follow from the weight distribution that the axles state.
    """

    sprung_mass: float
    pitch_inertia: float
    cog_height: float
    front: Axle
    rear: Axle
    front_damper: DamperCurve

    def __post_init__(self) -> None:
        require_positive("motorcycle", sprung_mass=self.sprung_mass, pitch_inertia=self.pitch_inertia)
        require_positive("motorcycle", cog_height=self.cog_height)
        carried = self.front.sprung_mass + self.rear.sprung_mass
        if abs(carried - self.sprung_mass) > 1e-6 * self.sprung_mass:
            raise VehicleError(
                f"motorcycle: the axles carry {carried:g} kg of a body of {self.sprung_mass:g} kg; the two must agree"
            )
        if not self.front.position > 0 > self.rear.position:
            raise VehicleError(
                "motorcycle: the front axle must lie ahead of (positive) and the rear axle behind (negative) the "
                f"centre of gravity, found {self.front.position:g} and {self.rear.position:g} m; correct the positions"
            )

    @cached_property
    def axles(self) -> tuple[Axle, ...]:
        """Front and rear."""
        return self.front, self.rear

    @property
    def passive_dampers(self) -> tuple[DamperCurve, ...]:
        """Of the fork."""
        return (self.front_damper,)

    @property
    def wheelbase(self) -> float:
        """l_f + l_r [m]."""
        return self.front.position - self.rear.position


def fork_stiffness(leg_stiffness: float, inclination: float) -> float:
    """k_sf = 2 k / cos^2(eps) [N/m]: two legs inclined against the vertical (thesis eq. 3.6); inclination [rad]."""
    return 2 * leg_stiffness / cos(inclination) ** 2


def swing_arm_stiffness(spring_stiffness: float, motion_ratio: float) -> float:
    """k_sr = k tau^2 [N/m] (thesis eq. 3.7); motion_ratio: spring travel over wheel travel, dimensionless.

    Table 3.2 gives 0.454 "m/rad", wheel stroke over arm rotation; only as a dimensionless ratio does it give the
    stiffness of 35.0 kN/m that the printed pitch mode of 1.8 Hz needs.
    """
    return spring_stiffness * motion_ratio**2


@dataclass(frozen=True)
class QuarterCar(Vehicle):
    """One wheel with its part of the body (thesis Fig. 4.7, eqs 4.3-4.5).

    sprung_mass m_s [kg], unsprung_mass m_u [kg], spring_stiffness k_s [N/m], tyre_stiffness k_u [N/m], stops.
    """

    sprung_mass: float
    unsprung_mass: float
    spring_stiffness: float
    tyre_stiffness: float
    stops: EndStops = NO_STOPS

    pitch_inertia = 1.0  # never turned: the axle lies under the centre of gravity
    cog_height = 0.0  # propulsion does not act on it

    def __post_init__(self) -> None:
        require_positive(
            "quarter car",
            sprung_mass=self.sprung_mass,
            unsprung_mass=self.unsprung_mass,
            spring_stiffness=self.spring_stiffness,
            tyre_stiffness=self.tyre_stiffness,
        )

    @cached_property
    def axles(self) -> tuple[Axle, ...]:
        """The only one, under the body."""
        tyre = Tyre(self.tyre_stiffness)
        return (Axle(0.0, self.sprung_mass, self.unsprung_mass, self.spring_stiffness, tyre, self.stops),)

    @property
    def passive_dampers(self) -> tuple[DamperCurve, ...]:
        """None: the only axle is the actuated one."""
        return ()

    @property
    def natural_frequencies(self) -> np.ndarray:
        """Undamped natural frequencies of body and wheel [Hz], (2,), rising."""
        return super().natural_frequencies[1:]  # the first is the pitch, which nothing turns
