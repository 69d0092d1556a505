"""Axial arrangement of the actuator: lever side, stages from the slow to the fast one, machine, sensor."""

from __future__ import annotations

from dataclasses import dataclass

from gearbox.errors import GearError
from gearbox.train import Gears, GearTrain
from units import MILLIMETRE


@dataclass(frozen=True)
class MachineEnvelope:
    """The machine as the assembly sees it: stator, rotor and shaft radius, active length, one end winding [m]."""

    stator_outer_radius: float
    rotor_outer_radius: float
    shaft_radius: float
    active_length: float
    end_winding_length: float


@dataclass(frozen=True)
class Housing:
    """What the casing adds.

    wall: radial [m]; lever_side: with two bearings, spline and lock nut [m]
    bearing_seat: either side of the machine [m]; sensor_cover: cover with the position sensor [m]
    """

    wall: float
    lever_side: float
    bearing_seat: float
    sensor_cover: float


@dataclass(frozen=True)
class Part:
    """A cylinder of the axial section: name, kind, start and length along the axis, inner and outer radius.

    start, length, inner_radius, outer_radius: [m]
    """

    name: str
    kind: str
    start: float
    length: float
    inner_radius: float
    outer_radius: float


@dataclass(frozen=True)
class Layout:
    """Parts from the lever to the sensor; the axis starts at the outer face of the lever side. length, diameter [m]"""

    parts: tuple[Part, ...]
    length: float
    diameter: float


def actuator_layout(train: Gears, machine: MachineEnvelope, housing: Housing) -> Layout:
    """The parts in line. Raises GearError when the rotor does not fit its stator."""
    inner = max(machine.stator_outer_radius, train.envelope_diameter / 2)
    if machine.rotor_outer_radius >= machine.stator_outer_radius:
        raise GearError(
            f"the rotor radius {machine.rotor_outer_radius / MILLIMETRE:g} mm must be below the stator radius "
            f"{machine.stator_outer_radius / MILLIMETRE:g} mm"
        )
    at = housing.lever_side + train.length
    start = at + housing.bearing_seat
    gears = _gear_parts(train, housing.lever_side) if isinstance(train, GearTrain) else []
    parts = gears + _machine_parts(machine, start)
    at = start + machine.active_length + 2 * machine.end_winding_length + housing.bearing_seat
    length = at + housing.sensor_cover
    shaft = Part("rotor shaft", "shaft", start - housing.bearing_seat, at - start + housing.bearing_seat, 0.0,
                 machine.shaft_radius)  # fmt: skip
    lever = Part("input shaft", "shaft", 0.0, housing.lever_side, 0.0, 0.4 * inner)
    casing = Part("casing", "casing", 0.0, length, inner, inner + housing.wall)
    return Layout((casing, lever, shaft, *parts), length, 2 * (inner + housing.wall))


def _gear_parts(train: GearTrain, first: float) -> list[Part]:
    """The stages in line from this place [m]."""
    places = [first + sum(train.stage_lengths[:k]) for k in range(len(train.stages))]
    return [part for number, place in enumerate(places) for part in _stage_parts(train, number, place)]


def _stage_parts(train: GearTrain, number: int, start: float) -> list[Part]:
    stage = train.stages[number]
    build, gears, width = train.construction, stage.gears, stage.face_width
    thick, orbit = build.flange_thickness(width), gears.centre_distance
    pin = build.bore_fraction * gears.planet.root_radius
    teeth, rim = start + thick + build.axial_gap, orbit + pin * (1 + build.flange_margin)
    rows = (
        ("ring", "ring", teeth, width, gears.ring.tip_radius, train.envelope_diameter / 2),
        ("sun", "sun", teeth, start + build.stage_length(width) - teeth, 0.0, gears.sun.tip_radius),
        ("planet", "planet", teeth, width, orbit - gears.planet.tip_radius, orbit + gears.planet.tip_radius),
        ("pin", "carrier", start, build.stage_length(width), orbit - pin, orbit + pin),
        ("carrier", "carrier", start, thick, gears.sun.tip_radius, rim),
        ("carrier", "carrier", teeth + width + build.axial_gap, thick, gears.sun.tip_radius, rim),
    )
    return [Part(f"{name} {number + 1}", *rest) for name, *rest in rows]


def _machine_parts(machine: MachineEnvelope, start: float) -> list[Part]:
    stack, end = start + machine.end_winding_length, machine.end_winding_length
    slots = (machine.rotor_outer_radius, machine.stator_outer_radius)
    return [
        Part("stator", "stator", stack, machine.active_length, *slots),
        Part("end winding", "winding", start, end, *slots),
        Part("end winding", "winding", stack + machine.active_length, end, *slots),
        Part("rotor", "rotor", stack, machine.active_length, machine.shaft_radius, machine.rotor_outer_radius),
    ]
