"""Planetary gearbox from its ratio and envelope: diameters, face width against pitting, mass, inertia.

Equal planets in each stage (three in the thesis), ring fixed, sun on the fast side, carrier on the slow side; stage 1
is the slow one, driven by the linkage. Scaling laws after Saerens et al., thesis eqs 3.103-3.118,
corrected where noted.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, radians, sin, sqrt

import numpy as np

from drivetrain.constraints import largest_stage_ratio
from electrical.dq import Values

STEEL_DENSITY = 7800.0  # kg/m^3, thesis below eq. 3.101
PLANETS = 3  # per stage, thesis below eq. 3.115


class GearboxError(ValueError):
    """A gearbox that cannot exist; the message says which ratio or size to move."""


class DynamicFactor:
    """Factor K_v by which tooth errors raise the load at speed; the concrete rules are below."""

    def at(self, pitch_line_velocity: Values) -> Values:
        """K_v at the peripheral speed of the sun [m/s]."""
        raise NotImplementedError


@dataclass(frozen=True)
class PrintedDynamicFactor(DynamicFactor):
    """K_v = (5.6 + sqrt(v)) / 5.6, thesis eq. 3.118: without the root of the handbook's rule for ground teeth."""

    def at(self, pitch_line_velocity: Values) -> Values:
        """K_v, dimensionless; pitch_line_velocity: [m/s]."""
        return (5.6 + pitch_line_velocity**0.5) / 5.6


@dataclass(frozen=True)
class GroundTeethDynamicFactor(DynamicFactor):
    """K_v = sqrt((5.56 + sqrt(v)) / 5.56), shaved or ground teeth, v in m/s.

    Shigley's Mechanical Engineering Design, the handbook that eq. 3.118 refers to. At the slow suns of this gearbox
    (0.02 m/s) its teeth are 1.3 % narrower than with the printed rule.
    """

    def at(self, pitch_line_velocity: Values) -> Values:
        """K_v, dimensionless; pitch_line_velocity: [m/s]."""
        return ((5.56 + pitch_line_velocity**0.5) / 5.56) ** 0.5


@dataclass(frozen=True)
class GearLaws:
    """Material and design numbers of the gears.

    density [kg/m^3], youngs_modulus [Pa], poisson_ratio, contact_strength sigma_H [Pa], pressure_angle [rad],
    overload_factor K_A, contact_ratio_factor Z_eps, ring_fraction: ring pitch diameter over envelope diameter,
    dynamic_factor: rule for K_v.
    """

    density: float
    youngs_modulus: float
    poisson_ratio: float
    contact_strength: float
    pressure_angle: float
    overload_factor: float
    contact_ratio_factor: float
    ring_fraction: float
    dynamic_factor: DynamicFactor

    def pitting_factor(self, pitch_line_velocity: Values) -> Values:
        """Z = Z_E Z_H Z_eps sqrt(K_A K_v) [sqrt(Pa)], eqs 3.115-3.118.

        Z_E = sqrt(E / (2 pi (1 - nu^2)))               (3.116)
        Z_H = sqrt(2 / (cos alpha sin alpha))           (3.117)
        """
        elastic = sqrt(self.youngs_modulus / (2 * pi * (1 - self.poisson_ratio**2)))
        zone = sqrt(2 / (cos(self.pressure_angle) * sin(self.pressure_angle)))
        load = (self.overload_factor * self.dynamic_factor.at(pitch_line_velocity)) ** 0.5
        return elastic * zone * self.contact_ratio_factor * load


# Thesis below eqs 3.101, 3.103 and 3.115-3.118. The printed dynamic factor is kept: it is on the safe side, and the
# first-stage width that the printed equations give, 8.9 mm, needs it (8.8 mm with the handbook's).
NITRIDED_STEEL = GearLaws(
    density=STEEL_DENSITY,
    youngs_modulus=210e9,
    poisson_ratio=0.3,
    contact_strength=1500e6,
    pressure_angle=radians(20.0),
    overload_factor=1.5,
    contact_ratio_factor=1.0,
    ring_fraction=0.85,
    dynamic_factor=PrintedDynamicFactor(),
)


@dataclass(frozen=True)
class StageShape:
    """Pitch diameters of one stage from its ratio i = 1 + d_ring/d_sun, ring pitch diameter [m], number of planets."""

    ratio: Values
    ring_diameter: float
    planets: int = PLANETS

    def __post_init__(self) -> None:
        least = np.min(self.ratio)
        if not least > 2:
            raise GearboxError(
                f"a stage with a fixed ring needs a ratio above 2 for its planets to have a diameter; found "
                f"{least:.4g}: use fewer stages (match.gearbox_stages) or a smaller transmission ratio"
            )

    @property
    def sun_diameter(self) -> Values:
        """d_sun = d_ring / (i - 1) (3.106)."""
        return self.ring_diameter / (self.ratio - 1)

    @property
    def planet_diameter(self) -> Values:
        """d_planet = d_ring (i - 2) / (2 (i - 1)) (3.107)."""
        return self.ring_diameter * (self.ratio - 2) / (2 * (self.ratio - 1))

    @property
    def carrier_diameter(self) -> Values:
        """d_carrier = d_ring i / (2 (i - 1)), the circle of the planet centres (3.108)."""
        return self.ring_diameter * self.ratio / (2 * (self.ratio - 1))

    @property
    def planets_clear_each_other(self) -> bool:
        """Pitch circles of neighbouring planets do not overlap: d_carrier sin(pi/n) > d_planet; i < 14.93 for three."""
        return self.carrier_diameter * sin(pi / self.planets) > self.planet_diameter


@dataclass(frozen=True)
class PlanetaryStage:
    """One stage with its face width [m] inside an envelope diameter [m], made of steel of one density [kg/m^3]."""

    shape: StageShape
    face_width: Values
    envelope_diameter: float
    density: float

    @property
    def mass(self) -> Values:
        """Sun, planets, solid carrier and ring [kg].

        m = pi/4 rho b [d_sun^2 + n d_planet^2 + d_carrier^2 + D^2 - d_ring^2]          (3.109)
        """
        shape = self.shape
        rim = self.envelope_diameter**2 - shape.ring_diameter**2
        squares = shape.sun_diameter**2 + shape.planets * shape.planet_diameter**2 + shape.carrier_diameter**2 + rim
        return pi / 4 * self.density * self.face_width * squares

    @property
    def inertia_at_carrier(self) -> Values:
        """Inertia of all moving parts seen at the carrier [kg m^2].

        J = pi/512 rho b d_ring^4 i^2 / (i - 1)^4 [16 + i^2 + 3 n (i - 2)^2]

        Sun, solid carrier, and n planets that spin and orbit; for three the bracket is 2 (5 i^2 - 18 i + 26). Equation
        3.111, pi/128 (i^2 - 3 i + 7), is the same without the orbits: a factor 2.19 at i = 8.7.
        """
        i = self.shape.ratio
        size = self.density * self.face_width * self.shape.ring_diameter**4
        return pi / 512 * size * i**2 / (i - 1) ** 4 * (16 + i**2 + 3 * self.shape.planets * (i - 2) ** 2)


@dataclass(frozen=True)
class Gearbox:
    """Stages from the linkage to the motor behind a linkage ratio tau_l [m/rad]."""

    stages: tuple[PlanetaryStage, ...]
    linkage_ratio: float

    @property
    def mass(self) -> Values:
        """Sum over the stages [kg] (3.110)."""
        return sum(stage.mass for stage in self.stages)

    @property
    def equivalent_mass(self) -> Values:
        """Inertia of all stages seen at the wheel [kg] (3.111-3.112).

        m_eq = sum_j J_j i^(2 (j - 1)) / tau_l^2: the carrier of stage j turns i^(j-1) times as fast as the linkage.
        """
        total: Values = 0.0
        speed_ratio: Values = 1.0
        for stage in self.stages:
            total += stage.inertia_at_carrier * (speed_ratio / self.linkage_ratio) ** 2
            speed_ratio *= stage.shape.ratio
        return total

    @property
    def notes(self) -> tuple[str, ...]:
        """What cannot be built although the scaling laws size it, in words."""
        return tuple(
            f"stage {number}: {stage.shape.planets} planets overlap at a ratio of {stage.shape.ratio:.2f} "
            f"(they clear each other below {largest_stage_ratio(stage.shape.planets):.2f}); use more stages"
            for number, stage in enumerate(self.stages, start=1)
            if not stage.shape.planets_clear_each_other
        )


@dataclass(frozen=True)
class GearboxDesign:
    """What a gearbox is sized from.

    stage_count: N, 0 for a direct drive
    linkage_ratio: tau_l [m/rad]; one number for a linkage whose ratio varies over the wheel travel. The thesis's match
        follows from the nominal value (170 mm/rad); the largest (175 mm/rad) widens the teeth by 4 %
    force_rms, velocity_rms: fatigue load at the wheel [N, m/s]
    laws: material and design numbers; planets: of a stage
    """

    stage_count: int
    linkage_ratio: float
    force_rms: float
    velocity_rms: float
    laws: GearLaws = NITRIDED_STEEL
    planets: int = PLANETS

    @property
    def largest_transmission_ratio(self) -> float:
        """tau_t at which the stage ratio falls to 2 and the planets vanish [m/rad]; tau_l without stages."""
        return self.linkage_ratio / 2**self.stage_count

    def stage_ratio(self, transmission_ratio: Values) -> Values:
        """i = (tau_l / tau_t)^(1/N), dimensionless, equal stages (3.104-3.105); tau_t in m/rad."""
        return (self.linkage_ratio / transmission_ratio) ** (1 / self.stage_count)

    def size(self, *, envelope_radius: float, transmission_ratio: Values) -> Gearbox:
        """Gearbox of this envelope radius [m] and overall ratio tau_t [m/rad] (3.103-3.118); a family at an array of
        ratios.

        Raises GearboxError when the stage ratio is not above 2.
        """
        if self.stage_count == 0:
            return Gearbox((), self.linkage_ratio)
        ring = self.laws.ring_fraction * 2 * envelope_radius  # 3.103
        shape = StageShape(self.stage_ratio(transmission_ratio), ring, self.planets)
        widths = (face_width(shape, *self._carrier_load(shape.ratio, j), self.laws) for j in range(self.stage_count))
        stages = tuple(PlanetaryStage(shape, width, 2 * envelope_radius, self.laws.density) for width in widths)
        return Gearbox(stages, self.linkage_ratio)

    def _carrier_load(self, ratio: Values, stages_before: int) -> tuple[Values, Values]:
        """Torque [Nm] and speed [rad/s] of the carrier behind so many stages.

        T_c = F tau_l / i^(j-1), omega_c = v i^(j-1) / tau_l: eqs 3.113-3.114 print i^j, one stage too far for the
        carrier that they speak of.
        """
        speed_ratio = ratio**stages_before
        return self.force_rms * self.linkage_ratio / speed_ratio, self.velocity_rms / self.linkage_ratio * speed_ratio


def face_width(shape: StageShape, carrier_torque: Values, carrier_speed: Values, laws: GearLaws) -> Values:
    """Face width at which the contact stress between sun and planets reaches its limit [m].

    b = (T_c / n) / [ (sigma_H / Z)^2 (i - 2) / (2 (i - 1)^2) d_ring^2 ]

    From sigma_H^2 = Z^2 F_t / (b d_sun) (u + 1)/u with F_t = 2 T_sun / (n d_sun), T_sun = T_c / i and
    (u + 1)/u = i/(i - 2). Equation 3.115 prints sigma_H/Z without its square and i^-2 for (i - 2).

    carrier_torque: T_c [Nm]; carrier_speed: [rad/s]
    """
    i = shape.ratio
    velocity = i * carrier_speed * shape.sun_diameter / 2
    stress_ratio = laws.contact_strength / laws.pitting_factor(velocity)
    return carrier_torque / shape.planets / (stress_ratio**2 * (i - 2) / (2 * (i - 1) ** 2) * shape.ring_diameter**2)
