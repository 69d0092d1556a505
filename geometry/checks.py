"""Can this machine be built? Every rule names what is wrong and which parameter to move."""

from __future__ import annotations

from math import asin, isfinite, sin

from geometry.machine import GeometryError, Machine
from units import MILLIMETRE

_SMALLEST_GAP_BETWEEN_SHOES = 0.05 * MILLIMETRE  # below this the shoes touch within any lamination tolerance
_SMALLEST_SLOT_DEPTH = 0.2 * MILLIMETRE  # between the shoe and the slot bottom, for the slot to hold any copper


def check_machine(machine: Machine) -> None:
    """Raise GeometryError with one sentence for the first rule that the machine breaks."""
    for rule in (_check_numbers, _check_radii, _check_rotor, _check_shoes, _check_teeth, _check_slot):
        rule(machine)


def _mm(length: float) -> str:
    return f"{length / MILLIMETRE:.3f} mm"


def _check_numbers(m: Machine) -> None:
    lengths = {name: value for name, value in vars(m).items() if isinstance(value, float)}
    for name, value in lengths.items():
        if not isfinite(value) or value <= 0:
            raise GeometryError(f"{name} must be a positive finite number, found {value}: correct {name}")
    if m.magnet_arc_fraction > 1:
        raise GeometryError(
            "magnet_arc_fraction must be at most 1 (neighbouring magnets touch), found "
            f"{m.magnet_arc_fraction}: reduce it"
        )


def _check_radii(m: Machine) -> None:
    if m.stator_inner_radius >= m.slot_bottom_radius:
        raise GeometryError(
            f"the stator bore radius {_mm(m.stator_inner_radius)} must be smaller than the slot bottom radius "
            f"{_mm(m.slot_bottom_radius)}: reduce rotor_outer_radius or back_iron_width, or enlarge stator_outer_radius"
        )


def _check_rotor(m: Machine) -> None:
    if m.rotor_core_radius <= m.shaft_radius:
        raise GeometryError(
            f"the rotor core under the magnets ends at {_mm(m.rotor_core_radius)}, inside the shaft of radius "
            f"{_mm(m.shaft_radius)}: enlarge rotor_outer_radius, or reduce magnet_length or shaft_radius"
        )


def _check_shoes(m: Machine) -> None:
    pitch = m.slot_pitch * m.stator_inner_radius
    if m.tooth_width >= pitch:
        raise GeometryError(
            f"the teeth ({_mm(m.tooth_width)}) are wider than the slot pitch at the bore ({_mm(pitch)}): "
            "reduce back_iron_width or tooth_width, or enlarge rotor_outer_radius"
        )
    if m.opening_width < _SMALLEST_GAP_BETWEEN_SHOES:
        raise GeometryError(
            f"the shoes of neighbouring teeth touch: the opening between them would be {_mm(m.opening_width)}, "
            f"it must be at least {_mm(_SMALLEST_GAP_BETWEEN_SHOES)}: enlarge slot_opening or reduce tooth_width"
        )
    if m.slot_opening >= pitch:
        raise GeometryError(
            f"slot_opening {_mm(m.slot_opening)} exceeds the slot pitch at the bore ({_mm(pitch)}): reduce slot_opening"
        )


def _check_teeth(m: Machine) -> None:
    if m.shoe_top_radius + _SMALLEST_SLOT_DEPTH >= m.slot_bottom_radius:
        raise GeometryError(
            f"the tooth shoe reaches {_mm(m.shoe_top_radius)} while the slot ends at {_mm(m.slot_bottom_radius)}, "
            "no room is left for copper: reduce rotor_outer_radius, back_iron_width or the shoe depth"
        )


def _slot_half_width(m: Machine, radius: float) -> float:
    """Distance from the slot axis to the tooth flank, measured at right angles to the slot axis, at this radius."""
    return radius * sin(m.slot_pitch / 2 - asin(m.tooth_width / 2 / radius))


def _check_slot(m: Machine) -> None:
    half_width = _slot_half_width(m, m.shoe_top_radius)
    if half_width <= 0:
        raise GeometryError(
            f"the slot area is negative: neighbouring teeth of width {_mm(m.tooth_width)} overlap at radius "
            f"{_mm(m.shoe_top_radius)}: reduce back_iron_width or tooth_width, or enlarge rotor_outer_radius"
        )
    if 2 * half_width <= m.opening_width:
        raise GeometryError(
            f"the slot is {_mm(2 * half_width)} wide where the shoe ends, narrower than its opening of "
            f"{_mm(m.opening_width)}: reduce slot_opening or tooth_width, or enlarge rotor_outer_radius"
        )
