"""The operating point that somebody asks for by hand: numbers that make no sense are refused before the field is solved."""

from __future__ import annotations

from dataclasses import dataclass

from study.errors import StudyError
from units import AMPERE_PER_SQUARE_MILLIMETRE, DEGREE

# The field repeats itself with every turn; a larger number is a slip, and its rounding would soon be that of the result.
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
                f"{option} {angle:g} makes no sense, the field repeats itself every turn; give degrees between "
                f"{-LARGEST_ANGLE:g} and {LARGEST_ANGLE:g}."
            )
    if not 0 <= amplitude_A_per_mm2 <= LARGEST_CURRENT_DENSITY:
        raise StudyError(
            f"a current density of {amplitude_A_per_mm2:g} A/mm2 (amplitude) makes no sense, copper melts in a fifth of a "
            f"second at {LARGEST_CURRENT_DENSITY:g}; give --j-rms or --j-amplitude between 0 and that."
        )
    return AskedPoint(
        angle_deg * DEGREE, amplitude_A_per_mm2 * AMPERE_PER_SQUARE_MILLIMETRE, current_angle_deg * DEGREE
    )
