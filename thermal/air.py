"""Air at atmospheric pressure, and how it takes heat: in still air, in a narrow gap that turns, beside a rotor.

Film coefficients h [W/(m^2 K)] from the correlations of the field; each is good to some 10 to 30 %.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from thermal.errors import ThermalError
from units import GRAVITY

KELVIN = 273.15  # K at 0 degC
STEFAN_BOLTZMANN = 5.670374e-8  # W/(m^2 K^4)
_PRESSURE, _GAS_CONSTANT = 101325.0, 287.05  # Pa; J/(kg K), dry air
_HEAT = 1007.0  # J/(kg K), of air between 0 and 150 degC (Incropera, Fundamentals of Heat and Mass Transfer, Table A.4)
# End space of closed machines after Schubert, as cited by Staton, Boglietti and Cavagnino, IEEE Trans. Energy Convers.
# 20(3) (2005): h = k_1 (1 + k_2 v^k_3).
_END_STILL, _END_STIRRED, _END_POWER = 15.0, 0.4, 0.9  # W/(m^2 K); with v in m/s; dimensionless


@dataclass(frozen=True)
class Air:
    """At a film temperature [degC], -50 to 300 degC."""

    temperature: float

    @property
    def density(self) -> float:
        """Ideal gas [kg/m^3]."""
        return _PRESSURE / (_GAS_CONSTANT * (self.temperature + KELVIN))

    @property
    def viscosity(self) -> float:
        """Dynamic, Sutherland's law with 1.716e-5 Pa s at 273.15 K and S = 110.4 K [Pa s]."""
        kelvin = self.temperature + KELVIN
        return 1.716e-5 * (kelvin / 273.15) ** 1.5 * (273.15 + 110.4) / (kelvin + 110.4)

    @property
    def conductivity(self) -> float:
        """Sutherland's form with 0.0241 W/(m K) at 273.15 K and S = 194 K (White, Viscous Fluid Flow) [W/(m K)]."""
        kelvin = self.temperature + KELVIN
        return 0.0241 * (kelvin / 273.15) ** 1.5 * (273.15 + 194.0) / (kelvin + 194.0)

    @property
    def kinematic_viscosity(self) -> float:
        """nu [m^2/s]."""
        return self.viscosity / self.density

    @property
    def prandtl(self) -> float:
        """nu over thermal diffusivity, dimensionless."""
        return self.viscosity * _HEAT / self.conductivity

    @property
    def volumetric_heat(self) -> float:
        """Heat that a volume stores [J/(m^3 K)]."""
        return self.density * _HEAT


def still_air_film(diameter: float, surface: float, ambient: float) -> float:
    """Natural convection from a long horizontal cylinder [W/(m^2 K)].

    Nu = (0.60 + 0.387 Ra^(1/6) / (1 + (0.559/Pr)^(9/16))^(8/27))^2,  Ra = g beta dT D^3 Pr / nu^2

    diameter [m]; surface, ambient: temperatures [degC]; properties at their mean
    Validity: Ra up to 1e12. Source: Churchill and Chu, Int. J. Heat Mass Transfer 18 (1975) 1049.
    """
    air = Air((surface + ambient) / 2)
    expansion = 1 / (air.temperature + KELVIN)
    grashof = GRAVITY * expansion * abs(surface - ambient) * diameter**3 / air.kinematic_viscosity**2
    shape = (1 + (0.559 / air.prandtl) ** (9 / 16)) ** (8 / 27)
    nusselt = (0.60 + 0.387 * (grashof * air.prandtl) ** (1 / 6) / shape) ** 2
    return nusselt * air.conductivity / diameter


def radiation_film(emissivity: float, surface: float, ambient: float) -> float:
    """Radiation of a small grey body to large surroundings, eps sigma (T^2 + T_a^2)(T + T_a) [W/(m^2 K)].

    emissivity: dimensionless; surface, ambient: temperatures [degC]. Standard textbook formula.
    """
    hot, cold = surface + KELVIN, ambient + KELVIN
    return emissivity * STEFAN_BOLTZMANN * (hot**2 + cold**2) * (hot + cold)


def air_gap_film(gap: float, mid_radius: float, speed: float, temperature: float) -> float:
    """Heat across the air gap from wall to wall, over the area at mid gap, by its Taylor number [W/(m^2 K)].

    Nu = 2 below Ta_m = 1700, 0.128 Ta_m^0.367 up to 1e4, 0.409 Ta_m^0.241 up to 1e7
    h = Nu k / (2 gap),  Ta_m = omega^2 r_m gap^3 / nu^2

    gap, mid_radius: [m]; speed: of the rotor [rad/s]; temperature: of the air [degC]
    Smooth walls and a gap that is thin against the radius, so that the geometrical factor of Ta_m is one; slots stir it
    a little more. Raises ThermalError beyond 1e7.
    Source: Becker and Kaye, J. Heat Transfer 84 (1962) 97, as reviewed by Howey, Childs and Holmes, IEEE Trans. Ind.
    Electron. 59(3) (2012) 1367. The limits meet to 2 %.
    """
    air = Air(temperature)
    taylor = speed**2 * mid_radius * gap**3 / air.kinematic_viscosity**2
    if taylor > 1e7:
        raise ThermalError(f"the air gap has a Taylor number of {taylor:.3g}, beyond the correlation's 1e7")
    return _gap_nusselt(taylor) * air.conductivity / (2 * gap)


def _gap_nusselt(taylor: float) -> float:
    if taylor < 1700:
        return 2.0
    return 0.128 * taylor**0.367 if taylor < 1e4 else 0.409 * taylor**0.241


def end_space_film(peripheral_speed: float) -> float:
    """Between the air beside the stack and what stands in it, h = 15 (1 + 0.4 v^0.9) [W/(m^2 K)].

    peripheral_speed: of the rotor, v [m/s]; radiation at rest is in it
    Closed machines without blades on the rotor; published coefficients differ by a factor of two. Source: see module.
    """
    return _END_STILL * (1 + _END_STIRRED * abs(peripheral_speed) ** _END_POWER)


class Film:
    """How the outside of a casing gives heat to the surroundings; the concrete ones are below."""

    def at(self, diameter: float, surface: float, ambient: float) -> float:
        """h [W/(m^2 K)] of a casing of a diameter [m] at temperatures of surface and ambient [degC]."""
        raise NotImplementedError


@dataclass(frozen=True)
class StillAir(Film):
    """Natural convection and radiation; emissivity: of the surface, dimensionless."""

    emissivity: float

    def at(self, diameter: float, surface: float, ambient: float) -> float:
        """See ``Film``: diameter [m], surface and ambient [degC]."""
        return still_air_film(diameter, surface, ambient) + radiation_film(self.emissivity, surface, ambient)


@dataclass(frozen=True)
class GivenFilm(Film):
    """A coefficient that somebody knows, of moving air or of water; film [W/(m^2 K)]."""

    film: float

    def at(self, diameter: float, surface: float, ambient: float) -> float:
        """See ``Film``: diameter [m], surface and ambient [degC]."""
        return self.film


def cylinder_surface(diameter: float, length: float) -> float:
    """Outside of a closed cylinder, both ends with it [m^2]; diameter, length: [m]."""
    return pi * diameter * length + pi * diameter**2 / 2
