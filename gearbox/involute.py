"""Involute spur gears and their meshes, external and internal, for single gears or arrays of them.

Signs as in ISO 21771 and ISO 6336: an internal gear has a negative number of teeth, its profile shift counts positive
towards thicker teeth (a larger tip diameter). Radii and the centre distance are positive lengths here; where the
standard needs the sign it comes from ``side``. All attributes broadcast: a mesh of arrays is a batch of meshes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy import arccos, cos, pi, sin, sqrt, tan

from gearbox.batch import Batch
from units import DEGREE

_NEWTON_STEPS = 12  # from the start below, the residual is rounding for angles from 1 to 50 degrees


@dataclass(frozen=True)
class BasicRack:
    """Rack that generates the teeth: addendum, dedendum, root fillet radius [modules], pressure angle [rad]."""

    addendum: float
    dedendum: float
    fillet_radius: float
    pressure_angle: float

    @property
    def straight_dedendum(self) -> float:
        """Depth of the straight flank below the reference line, h_fP - rho_fP (1 - sin alpha) [modules]."""
        return self.dedendum - self.fillet_radius * (1 - sin(self.pressure_angle))


ISO_53_A = BasicRack(addendum=1.0, dedendum=1.25, fillet_radius=0.38, pressure_angle=20 * DEGREE)  # ISO 53:1998, type A


def involute(angle: Batch) -> Batch:
    """inv(alpha) = tan(alpha) - alpha, dimensionless; angle: alpha [rad]."""
    return tan(angle) - angle


def inverse_involute(value: Batch) -> Batch:
    """The angle [rad] whose involute is the value, dimensionless; NaN for a negative value, which no involute has."""
    value = np.asarray(value, dtype=float)
    usable = np.where(value >= 0, value, np.nan)
    angle = np.cbrt(3 * usable) / (1 + 0.4 * np.cbrt(3 * usable) ** 2) ** 0.5  # tan(a) - a = a^3/3 + ...
    for _ in range(_NEWTON_STEPS):
        angle = angle - (involute(angle) - usable) / np.maximum(tan(angle) ** 2, 1e-30)
    return np.where(usable == 0, 0.0, angle)[()]


@dataclass(frozen=True)
class Gear:
    """One spur gear: signed teeth z, profile shift x [modules], module m [m], tip radius [m], generating rack."""

    teeth: Batch
    shift: Batch
    module: Batch
    tip_radius: Batch
    rack: BasicRack = ISO_53_A

    @property
    def side(self) -> Batch:
        """+1 for an external gear, -1 for an internal one, dimensionless."""
        return np.sign(self.teeth)

    @property
    def reference_radius(self) -> Batch:
        """r = m |z| / 2 [m]."""
        return self.module * np.abs(self.teeth) / 2

    @property
    def base_radius(self) -> Batch:
        """r_b = r cos(alpha) [m]."""
        return self.reference_radius * cos(self.rack.pressure_angle)

    @property
    def root_radius(self) -> Batch:
        """r_f = r + side m (x - h_fP) [m]."""
        return self.reference_radius + self.side * self.module * (self.shift - self.rack.dedendum)

    @property
    def tooth_height(self) -> Batch:
        """h [m]."""
        return np.abs(self.tip_radius - self.root_radius)

    def pressure_angle_at(self, radius: Batch) -> Batch:
        """arccos(r_b / r) [rad]; NaN below the base circle."""
        with np.errstate(invalid="ignore"):
            return arccos(self.base_radius / radius)

    def half_tooth_angle(self, radius: Batch) -> Batch:
        """Half the angle of a tooth [rad] at a radius [m]: pi/(2 z) + 2 x tan(alpha)/z +- (inv alpha - inv alpha_r)."""
        z, alpha = np.abs(self.teeth), self.rack.pressure_angle
        half = (pi / 2 + 2 * self.shift * tan(alpha)) / z
        return half + self.side * (involute(alpha) - involute(self.pressure_angle_at(radius)))

    @property
    def tip_thickness(self) -> Batch:
        """s_a, arc at the tip circle [m]."""
        return 2 * self.tip_radius * self.half_tooth_angle(self.tip_radius)

    @property
    def least_shift(self) -> Batch:
        """Profile shift below which the rack undercuts an external tooth [modules]."""
        return self.rack.straight_dedendum - self.teeth / 2 * sin(self.rack.pressure_angle) ** 2

    @property
    def form_curvature(self) -> Batch:
        """Radius of curvature of the flank where the fillet begins [m]; contact must not go past it.

        rho_Ff = r sin(alpha) - side m (h - x) / sin(alpha) with the straight dedendum h. An internal gear is taken
        as cut
        by a rack of the same profile: a pinion cutter leaves a little more of the flank.
        """
        alpha = self.rack.pressure_angle
        lost = self.module * (self.rack.straight_dedendum - self.shift) / sin(alpha)
        return self.reference_radius * sin(alpha) - self.side * lost


@dataclass(frozen=True)
class Mesh:
    """An external pinion with a wheel, external or internal, at a centre distance [m]."""

    pinion: Gear
    wheel: Gear
    centre_distance: Batch

    @property
    def ratio(self) -> Batch:
        """u = z_2 / z_1, dimensionless, negative for an internal wheel."""
        return self.wheel.teeth / self.pinion.teeth

    @property
    def working_pressure_angle(self) -> Batch:
        """alpha_w [rad]: cos(alpha_w) = |z_1 + z_2| m cos(alpha) / (2 a)."""
        with np.errstate(invalid="ignore"):
            return arccos((self.pinion.base_radius + self.wheel.side * self.wheel.base_radius) / self._signed_distance)

    @property
    def base_pitch(self) -> Batch:
        """p_b = pi m cos(alpha) [m]."""
        return pi * self.pinion.module * cos(self.pinion.rack.pressure_angle)

    @property
    def pinion_curvature_at_tip(self) -> Batch:
        """Radius of curvature of the pinion flank at its tip, end of contact [m]."""
        return sqrt(self.pinion.tip_radius**2 - self.pinion.base_radius**2)

    @property
    def wheel_curvature_at_tip(self) -> Batch:
        """Radius of curvature of the wheel flank at its tip, start of contact [m]."""
        with np.errstate(invalid="ignore"):
            return sqrt(self.wheel.tip_radius**2 - self.wheel.base_radius**2)

    @property
    def line_of_action(self) -> Batch:
        """Distance a sin(alpha_w) between the points where the line of action touches the base circles [m]."""
        return self.centre_distance * sin(self.working_pressure_angle)

    @property
    def pinion_curvature_at_start(self) -> Batch:
        """Radius of curvature of the pinion flank where contact starts, at the tip of the wheel [m]."""
        return self.wheel.side * (self.line_of_action - self.wheel_curvature_at_tip)

    @property
    def contact_ratio(self) -> Batch:
        """eps_alpha: length of the path of contact relative to the base pitch."""
        return (self.pinion_curvature_at_tip - self.pinion_curvature_at_start) / self.base_pitch

    @property
    def addendum_contact_ratios(self) -> tuple[Batch, Batch]:
        """(eps_1, eps_2), both dimensionless: recess and approach parts of eps_alpha."""
        pitch = self.pinion.base_radius * tan(self.working_pressure_angle)
        pair = self.pinion_curvature_at_tip - pitch, pitch - self.pinion_curvature_at_start
        return tuple(part / self.base_pitch for part in pair)

    @property
    def root_clearances(self) -> tuple[Batch, Batch]:
        """(c_1, c_2): tip of the pinion to the root of the wheel, tip of the wheel to the root of the pinion [m]."""
        side = self.wheel.side
        first = self._signed_distance - self.pinion.tip_radius - side * self.wheel.root_radius
        return first, self._signed_distance - self.pinion.root_radius - side * self.wheel.tip_radius

    @property
    def flank_margins(self) -> tuple[Batch, Batch]:
        """Curvature left between the end of contact and the fillet of (pinion, wheel) [m]; negative is interference."""
        wheel_end = self.wheel_curvature(self.pinion_curvature_at_tip)
        return (
            self.pinion_curvature_at_start - np.maximum(self.pinion.form_curvature, 0),
            self.wheel.side * (wheel_end - self.wheel.form_curvature),
        )

    def wheel_curvature(self, pinion_curvature: Batch) -> Batch:
        """Radius of curvature of the wheel flank [m]: the line of action less pinion_curvature [m]."""
        return self.line_of_action - self.wheel.side * pinion_curvature

    def relative_curvature(self, pinion_curvature: Batch) -> Batch:
        """rho = rho_1 rho_2 / (rho_2 +- rho_1) [m]; pinion_curvature: radius of curvature of the pinion flank [m]."""
        wheel = self.wheel_curvature(pinion_curvature)
        return pinion_curvature * wheel / (wheel + self.wheel.side * pinion_curvature)

    @property
    def _signed_distance(self) -> Batch:
        return self.wheel.side * self.centre_distance


def working_angle(pinion_teeth: Batch, wheel_teeth: Batch, shift_sum: Batch, pressure_angle: Batch) -> Batch:
    """alpha_w of a pair without backlash [rad]: inv(alpha_w) = inv(alpha) + 2 (x_1 + x_2)/(z_1 + z_2) tan(alpha).

    shift_sum: x_1 + x_2 [modules]
    """
    added = 2 * shift_sum / (pinion_teeth + wheel_teeth) * tan(pressure_angle)
    return inverse_involute(involute(pressure_angle) + added)


def centre_distance(
    pinion_teeth: Batch, wheel_teeth: Batch, shift_sum: Batch, module: Batch, pressure_angle: Batch
) -> Batch:
    """Centre distance of a pair without backlash [m], positive; shift_sum: x_1 + x_2 [modules]; module: [m]."""
    alpha_w = working_angle(pinion_teeth, wheel_teeth, shift_sum, pressure_angle)
    return np.abs(pinion_teeth + wheel_teeth) * module / 2 * cos(pressure_angle) / cos(alpha_w)


def shift_sum(pinion_teeth: Batch, wheel_teeth: Batch, distance: Batch, module: Batch, pressure_angle: Batch) -> Batch:
    """x_1 + x_2 [modules] that closes a pair at a centre distance [m] without backlash; NaN where no pair reaches it.

    module: [m]
    """
    with np.errstate(invalid="ignore"):
        alpha_w = arccos(np.abs(pinion_teeth + wheel_teeth) * module / 2 * cos(pressure_angle) / distance)
    return (pinion_teeth + wheel_teeth) / (2 * tan(pressure_angle)) * (involute(alpha_w) - involute(pressure_angle))
