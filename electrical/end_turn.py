"""Length of the copper outside the iron: a half circle on either side of the machine, over the pitch of the coil."""

from __future__ import annotations

from math import asin, pi


def slot_centre_distance(
    *, slots: int, slot_inner_radius: float, slot_outer_radius: float, tooth_width: float
) -> float:
    """Arc between the centres of the two half-slots that one tooth coil fills, D_et [m].

    D_et = (R_1 + R_2)/2 theta_w                        (3.85)
    theta_w = pi/N_s + asin(w_tb / (R_1 + R_2))         (3.89)

    slots: number of slots N_s
    slot_inner_radius, slot_outer_radius: where a coil side begins and ends; R_1 = R_ro + g + d_1 + d_2 and
        R_2 = R_so - w_bi inside a stator around its rotor [m] (3.86)
    tooth_width: w_tb [m]
    Raises ValueError when the slot has no depth or the tooth is wider than the slot pitch at mid slot.
    Source: thesis eqs 3.85-3.89; coils wound on single teeth only.
    """
    diameter = slot_inner_radius + slot_outer_radius
    _check_slot(slots, slot_inner_radius, slot_outer_radius, tooth_width)
    return diameter / 2 * (pi / slots + asin(tooth_width / diameter))


def end_turn_length(
    *, slots: int, slot_inner_radius: float, slot_outer_radius: float, tooth_width: float, coil_pitch: int
) -> float:
    """Length of one end turn, a half circle over the distance D of the two coil sides, l_et = pi D / 2 [m] (3.84).

    coil_pitch: y [slots]. At 1, a coil round one tooth, D is ``slot_centre_distance`` (3.85). Above, a coil that
        crosses others on its way, D is the arc over y slot pitches at mid slot, y 2 pi/N_s (R_1 + R_2)/2: the sides of
        two layers share their slots, so that coils reach from slot centre to slot centre in the mean. 71.9 mm of end
        turn at y = 3 on the 85 mm, 12-slot machine. The other arguments and the errors as in ``slot_centre_distance``.
    Equation 3.90 writes R_1 + R_2 without d_1 + d_2, against its own definition 3.86; the shoe is kept here (16.30 mm
    instead of 15.72 mm on the 85 mm, 12-slot machine).
    Validity: a half circle at mid slot without straight ends. Over several slots it is on the long side: sides that
    rise straight at an angle a to the slot's mouth would be D / cos(a) long, 1.15 to 1.41 D for 30 to 45 degrees,
    where a half circle is 1.57 D.
    Source: thesis eqs 3.84-3.90 for y = 1; the same half circle over y slot pitches for y > 1.
    """
    if coil_pitch < 1:
        raise ValueError(f"a coil spans one slot pitch or more; found {coil_pitch}")
    distance = slot_centre_distance(
        slots=slots,
        slot_inner_radius=slot_inner_radius,
        slot_outer_radius=slot_outer_radius,
        tooth_width=tooth_width,
    )
    if coil_pitch > 1:
        distance = coil_pitch * pi * (slot_inner_radius + slot_outer_radius) / slots
    return pi * distance / 2


def _check_slot(slots: int, slot_inner_radius: float, slot_outer_radius: float, tooth_width: float) -> None:
    if slot_outer_radius <= slot_inner_radius:
        raise ValueError(
            f"the slot has no depth: its bottom radius is {slot_outer_radius:.6g} m, the top of the shoe "
            f"{slot_inner_radius:.6g} m; reduce the rotor radius, the shoe or the back iron"
        )
    pitch = pi * (slot_inner_radius + slot_outer_radius) / slots
    if not 0 < tooth_width < pitch:
        raise ValueError(
            f"tooth width must lie between 0 and the slot pitch at mid slot, {pitch:.6g} m; found {tooth_width:.6g} m"
        )
