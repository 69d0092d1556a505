"""Where an actuator acts, in words and units: at a wheel, or on a shaft.

Inside the project both are the same numbers: an effort [N or Nm], a speed [m/s or rad/s] and an inertia [kg or kg m^2]
behind a linkage ratio [m/rad or 1]. Reports take the words from here, so that a robot joint has no wheel.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from units import FACTORS, written


@dataclass(frozen=True)
class Output:
    """Words and drawing units of the output; units are keys of ``units.FACTORS``, empty for a pure number.

    place: where it is; end: side of the actuator that faces it; effort, speed, inertia: what they are called there
    """

    place: ClassVar[str]
    end: ClassVar[str]
    effort: ClassVar[str]
    effort_unit: ClassVar[str]
    speed: ClassVar[str]
    speed_unit: ClassVar[str]
    inertia: ClassVar[str]
    inertia_unit: ClassVar[str]
    damping_unit: ClassVar[str]
    ratio_unit: ClassVar[str]

    def at_speed(self, speed: float) -> str:
        """``1.64 m/s`` of a speed in SI [m/s or rad/s]."""
        return f"{speed / FACTORS[self.speed_unit]:.3g} {written(self.speed_unit)}"


@dataclass(frozen=True)
class Wheel(Output):
    """A linkage turns the rotation of the lever into the travel of a wheel."""

    place = "at the wheel"
    end = "lever side"
    effort, effort_unit = "force", "N"
    speed, speed_unit = "velocity", "m_per_s"
    inertia, inertia_unit = "equivalent mass", "kg"
    damping_unit = "kNs_per_m"
    ratio_unit = "mm_per_rad"


@dataclass(frozen=True)
class Shaft(Output):
    """The load sits on the slow shaft: a robot joint, a pump."""

    place = "at the shaft"
    end = "shaft side"
    effort, effort_unit = "torque", "Nm"
    speed, speed_unit = "speed", "rpm"
    inertia, inertia_unit = "inertia", "kg_m2"
    damping_unit = "Nms_per_rad"
    ratio_unit = ""
