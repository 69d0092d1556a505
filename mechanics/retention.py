"""What holds the magnets on a turning rotor: glue, or a sleeve over them.

The magnets' own attraction to core and stator is left out: the flux is denser at the core, so that it holds them.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, pi, sin

from geometry.machine import Machine
from materials.strength import SleeveMaterial
from mechanics.checks import LoadCheck

_HOLD_THE_MAGNETS = "a sleeve (mechanics.sleeve_material), or a glue of more mechanics.glue_tensile_strength_MPa"
_LOOSEN = "less mechanics.sleeve_prestress_MPa, with more mechanics.sleeve_thickness_mm in its place"
_TIGHTEN = "more mechanics.sleeve_prestress_MPa or mechanics.sleeve_thickness_mm"


@dataclass(frozen=True)
class MagnetRing:
    """The magnets of a machine at overspeed.

    density: of the magnets [kg/m^3]; active_length [m]; speed: omega [rad/s]; torque: peak, all on the magnets [Nm]
    """

    machine: Machine
    density: float
    active_length: float
    speed: float
    torque: float

    @property
    def tension(self) -> float:
        """Radial pull per bonded area [Pa], where the magnets are: rho omega^2 (r_o^3 - r_i^3)/(3 r_i)."""
        return self._moment / self.machine.rotor_core_radius

    @property
    def pull(self) -> float:
        """Centrifugal force of one magnet [N], 2 l sin(arc/2) rho omega^2 (r_o^3 - r_i^3)/3."""
        arc = self.machine.magnet_arc_fraction * self.machine.pole_pitch
        return 2 * self.active_length * sin(arc / 2) * self._moment

    @property
    def mean_rim_pull(self) -> float:
        """Radial pull on the core, spread over its whole rim [Pa]."""
        return self.machine.magnet_arc_fraction * self.tension

    @property
    def shear(self) -> float:
        """Of the bond by the torque [Pa], T/(2 pi r_i^2 l arc)."""
        bonded = 2 * pi * self.machine.rotor_core_radius * self.active_length * self.machine.magnet_arc_fraction
        return self.torque / self.machine.rotor_core_radius / bonded

    @property
    def _moment(self) -> float:
        outer, inner = self.machine.rotor_outer_radius, self.machine.rotor_core_radius
        return self.density * self.speed**2 * (outer**3 - inner**3) / 3


class Retention:
    """How the magnets are held; the concrete ways are below."""

    def checks(self, magnets: MagnetRing) -> tuple[LoadCheck, ...]:
        """What must hold at overspeed."""
        raise NotImplementedError

    def rim_pull(self, magnets: MagnetRing) -> float:
        """What the core must carry at its rim, outwards, per area [Pa]."""
        raise NotImplementedError


@dataclass(frozen=True)
class Glue(Retention):
    """A bond over the whole inner face of a magnet.

    tensile_strength, shear_strength: at the temperature of the rotor [Pa]; safety: wanted, dimensionless, and covers
        what mean stresses do not show: peel at the edges, voids, age

    Tension and shear count by the square root of the sum of the squares of their shares (an estimate, on the safe side
    of separate limits).
    """

    tensile_strength: float
    shear_strength: float
    safety: float

    def checks(self, magnets: MagnetRing) -> tuple[LoadCheck, ...]:
        """The share of the strength that tension and shear use up, against 1."""
        used = hypot(magnets.tension / self.tensile_strength, magnets.shear / self.shear_strength)
        return (LoadCheck("glue of the magnets", self.safety, used, 1.0, "", _HOLD_THE_MAGNETS),)

    def rim_pull(self, magnets: MagnetRing) -> float:
        """The whole pull of the magnets [Pa]."""
        return magnets.mean_rim_pull


@dataclass(frozen=True)
class Sleeve(Retention):
    """A ring that is shrunk or wound over the magnets and presses them onto the core.

    thickness: t [m]; prestress: hoop stress of the fitted sleeve at rest [Pa]; safety: wanted, dimensionless

    Thin ring on a core that does not give: p_0 = sigma_0 t/r; at speed the sleeve holds itself and the magnets,
    p = p_0 - rho r t omega^2 - p_magnets must not vanish, and sigma_0 + rho r^2 omega^2 bounds its hoop stress.
    Valid for t below a tenth of r; heat, which expands core and magnets, is left out, and so is the torque, which steps
    of the core or glue take beside the sleeve.
    Source: Binder, Schneider, Klohr, "Fixation of buried and surface-mounted magnets in high-speed permanent-magnet
    synchronous machines", IEEE Trans. Ind. Appl. 42 (2006).
    """

    material: SleeveMaterial
    thickness: float
    prestress: float
    safety: float

    def checks(self, magnets: MagnetRing) -> tuple[LoadCheck, ...]:
        """The hoop stress against the strength, and what the magnets pull against what the sleeve presses."""
        hoop = self.prestress + self._own_hoop_stress(magnets)
        inner, outer = magnets.machine.rotor_core_radius, magnets.machine.rotor_outer_radius
        pull, press = magnets.mean_rim_pull * inner / outer, self._press(magnets)
        return (
            LoadCheck("sleeve in hoop direction", self.safety, hoop, self.material.strength, "MPa", _LOOSEN),
            LoadCheck("sleeve against the pull of the magnets", self.safety, pull, press, "MPa", _TIGHTEN),
        )

    def rim_pull(self, magnets: MagnetRing) -> float:
        """Nothing [Pa]: the sleeve carries the magnets, and what it presses the core with is on the safe side."""
        return 0.0

    def _press(self, magnets: MagnetRing) -> float:
        """What the sleeve has left for the magnets [Pa], on their outer face."""
        left = max(self.prestress - self._own_hoop_stress(magnets), 0.0)
        return left * self.thickness / self._radius(magnets)

    def _own_hoop_stress(self, magnets: MagnetRing) -> float:
        return self.material.density * (self._radius(magnets) * magnets.speed) ** 2

    def _radius(self, magnets: MagnetRing) -> float:
        """Of the middle of the sleeve [m]."""
        return magnets.machine.rotor_outer_radius + self.thickness / 2
