"""Mass and inertia of a stage as a sum over its bodies, each turning with its own speed and some of them orbiting."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy import pi

from gearbox.batch import Batch
from gearbox.planetary_set import PlanetarySet


@dataclass(frozen=True)
class Body:
    """Equal bodies of a stage: count, mass [kg], own inertia [kg m^2], speed per carrier speed, orbit [m]."""

    name: str
    count: int
    mass: Batch
    inertia: Batch
    speed: Batch
    orbit: Batch = 0.0

    @property
    def inertia_at_carrier(self) -> Batch:
        """From the kinetic energy: count (J w^2 + m r^2) per squared carrier speed [kg m^2]."""
        return self.count * (self.inertia * self.speed**2 + self.mass * self.orbit**2)


def ring_body(
    name: str,
    outer: Batch,
    inner: Batch,
    width: Batch,
    density: Batch,
    *,
    speed: Batch,
    count: int = 1,
    orbit: Batch = 0.0,
) -> Body:
    """Hollow cylinder, or ``count`` of them.

    outer, inner: radii [m]; width: [m]; density: [kg/m^3]; speed: relative to that of the carrier
    orbit: radius about the axis of the stage [m]
    """
    mass = density * width * pi * (outer**2 - inner**2)
    return Body(name, count, mass, mass * (outer**2 + inner**2) / 2, speed, orbit)


def total_mass(bodies: Iterable[Body]) -> Batch:
    """[kg]"""
    return sum(body.count * body.mass for body in bodies)


def inertia_at_carrier(bodies: Iterable[Body]) -> Batch:
    """[kg m^2]"""
    return sum(body.inertia_at_carrier for body in bodies)


def solid_bodies(gears: PlanetarySet, face_width: Batch, envelope_diameter: float, density: float) -> tuple[Body, ...]:
    """Solid discs of the reference circles and a solid carrier disc through the planet centres: the scaling-law stage.

    face_width, envelope_diameter: [m]; density: [kg/m^3]
    Without profile shift the inertia is pi/256 rho b d_ring^4 i^2/(i - 1)^4 (5 i^2 - 18 i + 26) (thesis eq. 3.111
    with the orbits of the planets).
    """
    discs = (face_width, density)
    return (
        ring_body("sun", gears.sun.reference_radius, 0.0, *discs, speed=gears.ratio),
        ring_body("planets", gears.planet.reference_radius, 0.0, *discs, speed=planet_speed(gears),
                  count=gears.planets, orbit=gears.centre_distance),
        ring_body("carrier", gears.centre_distance, 0.0, *discs, speed=1.0),
        ring_body("ring", envelope_diameter / 2, gears.ring.reference_radius, *discs, speed=0.0),
    )  # fmt: skip


def planet_speed(gears: PlanetarySet) -> Batch:
    """Speed of the planets relative to the carrier's, 1 - |z_ring| / z_planet: they roll inside the fixed ring."""
    return 1 + gears.ring.teeth / gears.planet.teeth


@dataclass(frozen=True)
class Construction:
    """How a stage is built around its teeth.

    bore_fraction: planet bore over root diameter; the pin and its needles fill it, orbit and do not spin
    flange_fraction: thickness of each of the two carrier flanges over the face width, least_flange: not below [m];
        the pins hold them together
    flange_margin: from the pin to the rim of the flange, relative to the radius of the pin
    axial_gap: flange to teeth [m]
    """

    bore_fraction: float
    flange_fraction: float
    least_flange: float
    axial_gap: float
    flange_margin: float = 0.25

    def flange_thickness(self, face_width: Batch) -> Batch:
        """Of one carrier flange [m]."""
        return np.maximum(self.flange_fraction * face_width, self.least_flange)

    def stage_length(self, face_width: Batch) -> Batch:
        """Axial room of a stage: teeth, gaps and both flanges [m]."""
        return face_width + 2 * (self.axial_gap + self.flange_thickness(face_width))

    def bodies(
        self, gears: PlanetarySet, face_width: Batch, envelope_diameter: float, density: float
    ) -> tuple[Body, ...]:
        """Sun, bored planets, pins with needles, carrier flanges and ring; teeth solid up to the reference circle.

        face_width, envelope_diameter: [m]; density: [kg/m^3]
        """
        pin = self.bore_fraction * gears.planet.root_radius
        room, orbit = self.stage_length(face_width), gears.centre_distance
        rim = orbit + pin * (1 + self.flange_margin)
        many = {"count": gears.planets, "orbit": orbit}
        return (
            ring_body("sun", gears.sun.reference_radius, 0.0, room, density, speed=gears.ratio),
            ring_body("planets", gears.planet.reference_radius, pin, face_width, density,
                      speed=planet_speed(gears), **many),
            ring_body("pins", pin, 0.0, room, density, speed=1.0, **many),
            ring_body("carrier flanges", rim, 0.0, self.flange_thickness(face_width), density, speed=1.0, count=2),
            ring_body("ring", envelope_diameter / 2, gears.ring.reference_radius, face_width, density, speed=0.0),
        )  # fmt: skip
