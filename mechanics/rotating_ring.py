"""Stresses of a turning ring of laminations that carries the pull of magnets at its rim: the exact plane solution."""

from __future__ import annotations

from dataclasses import dataclass

from units import Values


@dataclass(frozen=True)
class RotatingRing:
    """A flat ring of constant thickness, free at its bore, with an even radial pull at its rim.

    inner, outer: radii a, b [m]; density: rho [kg/m^3]; poisson_ratio: nu, dimensionless
    speed: omega [rad/s]; rim_pull: q, outwards, per area of the rim [Pa]

    Plane stress, linear elasticity, no holes but the bore, not shrunk onto its shaft.
    Source: Timoshenko, Goodier, Theory of Elasticity: rotating disk with a hole, and Lamé's ring under pressure.
    """

    inner: float
    outer: float
    density: float
    poisson_ratio: float
    speed: float
    rim_pull: float = 0.0

    def radial_stress(self, radius: Values) -> Values:
        """sigma_r [Pa] at a radius r [m], any shape.

        sigma_r = (3 + nu)/8 rho omega^2 (a^2 + b^2 - a^2 b^2/r^2 - r^2) + q b^2/(b^2 - a^2) (1 - a^2/r^2)
        """
        a, b = self.inner**2, self.outer**2
        return self._inertia * (a + b - a * b / radius**2 - radius**2) + self._pull * (1 - a / radius**2)

    def hoop_stress(self, radius: Values) -> Values:
        """sigma_phi [Pa] at a radius r [m], any shape.

        sigma_phi = (3 + nu)/8 rho omega^2 (a^2 + b^2 + a^2 b^2/r^2 - (1 + 3 nu)/(3 + nu) r^2)
                    + q b^2/(b^2 - a^2) (1 + a^2/r^2)
        """
        a, b = self.inner**2, self.outer**2
        falling = (1 + 3 * self.poisson_ratio) / (3 + self.poisson_ratio) * radius**2
        return self._inertia * (a + b + a * b / radius**2 - falling) + self._pull * (1 + a / radius**2)

    @property
    def largest_stress(self) -> float:
        """Hoop stress at the bore [Pa]; nothing else acts there, so that it is the equivalent stress too."""
        return float(self.hoop_stress(self.inner))

    @property
    def _inertia(self) -> float:
        return (3 + self.poisson_ratio) / 8 * self.density * self.speed**2

    @property
    def _pull(self) -> float:
        return self.rim_pull * self.outer**2 / (self.outer**2 - self.inner**2)
