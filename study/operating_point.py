"""The operating point that somebody asks for by hand: numbers without sense are refused before the field is solved."""

from __future__ import annotations

from dataclasses import dataclass

from study.errors import StudyError
from units import AMPERE_PER_SQUARE_MILLIMETRE, DEGREE

# The field repeats itself with every turn; a larger number is a slip, and its rounding would soon be seen in the field.
LARGEST_ANGLE = 3.6e5  # deg, a thousand turns
# At 1000 A/mm2 copper melts in a fifth of a second: rho J^2 = 17 GW/m^3 on 3.4 MJ/(m^3 K) are 4900 K/s.
LARGEST_CURRENT_DENSITY = 1000.0  # A/mm2, amplitude


@dataclass(frozen=True)
class AskedPoint:
    """Rotor angle (mechanical) [rad], amplitude of the current density [A/m^2], current angle (electrical) [rad]."""

    angle: float
    amplitude: float
    current_angle: float


def asked_point(angle_deg: float, amplitude_A_per_mm2: float, current_angle_deg: float) -> AskedPoint:
    """The point in SI.

    Raises StudyError with one sentence for an angle beyond ``LARGEST_ANGLE`` or a current density that is negative or
    beyond ``LARGEST_CURRENT_DENSITY``; NaN and the infinities are beyond.
    """
    for option, angle in (("--angle-deg", angle_deg), ("--current-angle-deg", current_angle_deg)):
        if not abs(angle) <= LARGEST_ANGLE:
            raise StudyError(
                f"{option} must be a finite number of degrees, at most {LARGEST_ANGLE:g} either way, found {angle:g}; "
                "the field repeats itself every turn."
            )
    if not 0 <= amplitude_A_per_mm2 <= LARGEST_CURRENT_DENSITY:
        raise StudyError(
            f"the current density must be a finite number, zero or more and at most {LARGEST_CURRENT_DENSITY:g} A/mm2 "
            f"(amplitude), found {amplitude_A_per_mm2:g}; at that copper melts in a fifth of a second."
        )
    return AskedPoint(
        angle_deg * DEGREE, amplitude_A_per_mm2 * AMPERE_PER_SQUARE_MILLIMETRE, current_angle_deg * DEGREE
    )
