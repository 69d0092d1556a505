"""Four-bar linkage between a swing arm and the actuator: closed-form kinematics over the wheel travel.

Plane of the motorcycle, complex coordinates x + jy in metres: origin O at the swing-arm pivot, x rearward, y up. The
swing arm carries hardpoint A and the wheel axle W; the coupler AB drives the lever BC, which turns about C, the axis of
the actuator. Wheel travel is positive upwards (bump). Source: thesis eqs 3.26-3.42, corrected where noted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from units import MILLIMETRE

CLOSURE_SLACK = 1e-9  # m; links this much too short are rounding of the drawn position, not a gap


class LinkageError(ValueError):
    """A linkage that cannot exist or move; the message says which point, length or travel to change."""


@dataclass(frozen=True)
class SwingArm:
    """Input link: hardpoint_a A and wheel_axle W in the nominal position, x + jy [m].

    With the axle of thesis Table 3.8 the y of W is negative, -121.7 mm: the printed +121.7 mm reproduces neither the
    transmission ratio nor the angles printed beside it.
    """

    hardpoint_a: complex
    wheel_axle: complex

    def __post_init__(self) -> None:
        if not (abs(self.hardpoint_a) > 0 and self.wheel_axle.real > 0):
            raise LinkageError(
                "the swing arm needs hardpoint A away from its pivot and the wheel axle behind it (x above 0); found "
                f"A {point_text(self.hardpoint_a)} and W {point_text(self.wheel_axle)}: correct the hardpoints"
            )

    @property
    def length(self) -> float:
        """l_OW [m] (3.28)."""
        return abs(self.wheel_axle)

    def turn(self, travel: ArrayLike) -> np.ndarray:
        """Rotation of the arm from its nominal position [rad], of the shape of the travel.

        asin((dz + y_W) / l_OW) - angle(OW_nom)

        travel: dz [m], any shape. Equation 3.34 with the bracket corrected: the printed one adds the nominal angle
        of OA inside the arcsine and leaves out that of OW. Raises LinkageError when the wheel cannot reach the
        travel.
        """
        sine = (np.asarray(travel, dtype=float) + self.wheel_axle.imag) / self.length
        if np.any(np.abs(sine) >= 1):
            raise LinkageError(
                f"the swing arm of {self.length / MILLIMETRE:.1f} mm cannot carry the wheel through the travel "
                f"{np.min(travel) / MILLIMETRE:g} to {np.max(travel) / MILLIMETRE:g} mm: shorten the travel or correct "
                "the wheel axle"
            )
        return np.arcsin(sine) - np.angle(self.wheel_axle)

    def turn_per_travel(self, travel: ArrayLike) -> np.ndarray:
        """d(theta_OA)/d(dz) = 1 / (l_OW cos theta_OW) [rad/m], of the shape of the travel [m]."""
        return 1 / (self.length * np.cos(self.turn(travel) + np.angle(self.wheel_axle)))


@dataclass(frozen=True)
class Motion:
    """A linkage over its wheel travel. Arrays are (linkages, positions), or (positions,) for one linkage.

    travel: [m], (positions,); a, b: hardpoints x + jy [m], (..., positions); c: hardpoint C [m], (..., 1)
    transmission_ratio: tau_l = d(dz)/d(theta_BC) [m/rad], (..., positions)
    gamma: angle between coupler and lever at B, in 0 ... pi [rad], (..., positions)
    lambda_: angle between swing arm and coupler at A, in 0 ... pi [rad], (..., positions)
    reach: what the coupler and lever lack to close [m], (..., positions), positive where the linkage comes apart; all
        else is NaN there
    """

    travel: np.ndarray
    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    transmission_ratio: np.ndarray
    gamma: np.ndarray
    lambda_: np.ndarray
    reach: np.ndarray

    @property
    def lever_angle(self) -> np.ndarray:
        """theta_BC, the direction from B to C [rad], (..., positions), continuous over the travel."""
        return np.unwrap(np.angle(self.c - self.b), axis=-1)


@dataclass(frozen=True)
class FourBar:
    """Swing arm, coupler AB and lever BC.

    hardpoint_b, hardpoint_c: nominal B and C, x + jy [m], scalar or (linkages,)
    """

    arm: SwingArm
    hardpoint_b: complex | np.ndarray
    hardpoint_c: complex | np.ndarray

    @property
    def coupler_length(self) -> float | np.ndarray:
        """l_AB [m], of the shape of B (3.31)."""
        return np.abs(self.hardpoint_b - self.arm.hardpoint_a)

    @property
    def lever_length(self) -> float | np.ndarray:
        """l_BC [m], of the shape of B and C (3.32)."""
        return np.abs(self.hardpoint_c - self.hardpoint_b)

    def motion(self, travel: ArrayLike) -> Motion:
        """The linkage at a travel [m], (positions,); raises LinkageError when it does not close at each of them."""
        found = self.try_motion(travel)
        worst = np.unravel_index(np.argmax(found.reach), found.reach.shape)
        if found.reach[worst] > CLOSURE_SLACK:
            raise LinkageError(
                f"the links AB {np.max(self.coupler_length) / MILLIMETRE:.1f} mm and BC "
                f"{np.max(self.lever_length) / MILLIMETRE:.1f} mm do not close at a wheel travel of "
                f"{found.travel[worst[-1]] / MILLIMETRE:.1f} mm, where {found.reach[worst] / MILLIMETRE:.1f} mm are "
                "missing: lengthen one of them, move hardpoint C, or shorten the travel"
            )
        return found

    def try_motion(self, travel: ArrayLike) -> Motion:
        """As ``motion``, with NaN and a positive ``reach`` where a linkage does not close, for a whole population.

        travel: [m], (positions,)
        B is where the circles about A (radius l_AB) and C (radius l_BC) meet, on the side of AC on which it is
        drawn; this is the closed form of the loop A + AB + BC = C (3.37). tau_l = l_OW cos(theta_OW) |cross(B - C, B
        - A) / cross(A, B - A)| with its sign (3.42), from the velocity of B.
        """
        travel = np.asarray(travel, dtype=float)
        c = np.asarray(self.hardpoint_c, dtype=complex)[..., None]
        a = self.arm.hardpoint_a * np.exp(1j * self.arm.turn(travel)) + 0 * c
        b, reach = self._third_corner(a, c)
        speed = self.arm.turn_per_travel(travel)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = cross(b - c, b - a) / (cross(a, b - a) * speed)
        gamma, lambda_ = angle_between(a - b, c - b), angle_between(-a, b - a)
        return Motion(travel, a, b, c, ratio, gamma, lambda_, reach)

    def _third_corner(self, a: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """B [m] from A and C, and the gap [m] where the triangle A, B, C does not close."""
        coupler, lever = (np.asarray(length)[..., None] for length in (self.coupler_length, self.lever_length))
        distance = np.abs(c - a)
        reach = np.maximum(distance - coupler - lever, np.abs(coupler - lever) - distance)
        along = (coupler**2 - lever**2 + distance**2) / (2 * distance)
        height = np.sqrt(np.where(reach > CLOSURE_SLACK, np.nan, np.maximum(coupler**2 - along**2, 0)))
        side = np.sign(cross(self.hardpoint_c - self.arm.hardpoint_a, self.hardpoint_b - self.arm.hardpoint_a))
        return a + (c - a) / distance * (along + 1j * np.asarray(side)[..., None] * height), reach


def from_lengths(arm: SwingArm, hardpoint_c: complex, coupler_length: float, lever_length: float) -> FourBar:
    """The linkage of given lengths [m] whose B lies above the line from A to C (left of it seen from C to A).

    hardpoint_c: C, x + jy [m]

    For drawings that state C, l_AB and l_BC instead of B (thesis Table 3.9). Raises LinkageError.
    """
    a, distance = arm.hardpoint_a, abs(hardpoint_c - arm.hardpoint_a)
    along = (coupler_length**2 - lever_length**2 + distance**2) / (2 * distance)
    square = coupler_length**2 - along**2
    if square < 0:
        raise LinkageError(
            f"links of {coupler_length / MILLIMETRE:.1f} and {lever_length / MILLIMETRE:.1f} mm cannot span the "
            f"{distance / MILLIMETRE:.1f} mm from A to C: correct the lengths or the hardpoints"
        )
    direction = (hardpoint_c - a) / distance
    corners = (a + direction * (along + 1j * side * np.sqrt(square)) for side in (1, -1))
    return FourBar(arm, max(corners, key=lambda b: b.imag), hardpoint_c)


def cross(u: complex | np.ndarray, v: complex | np.ndarray) -> np.ndarray:
    """z component of the cross product [product of their units] of two plane vectors u, v [any unit], any shape."""
    return (np.conj(u) * v).imag


def angle_between(u: complex | np.ndarray, v: complex | np.ndarray) -> np.ndarray:
    """Angle between two plane vectors [rad], 0 ... pi, of their shape; u, v: x + jy [any unit], any shape."""
    return np.abs(np.angle(np.conj(u) * v))


def point_text(point: complex) -> str:
    """(x, y) mm of a point [m]."""
    return f"({point.real / MILLIMETRE:.1f}, {point.imag / MILLIMETRE:.1f}) mm"
