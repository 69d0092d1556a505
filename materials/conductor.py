"""Resistivity of a winding's conductor over temperature."""

from __future__ import annotations

from dataclasses import dataclass

from materials.errors import MaterialError
from units import Values


@dataclass(frozen=True)
class Conductor:
    """rho(T) = rho_ref (1 + alpha (T - T_ref)), valid from about -50 to 200 degC."""

    reference_resistivity: float  # rho_ref [Ohm m]
    temperature_coefficient: float  # alpha [1/K]
    reference_temperature: float  # T_ref [degC]

    def __post_init__(self) -> None:
        if not self.reference_resistivity > 0:
            raise MaterialError(f"a resistivity must be positive, found {self.reference_resistivity:g} Ohm m")

    def resistivity(self, temperature: Values) -> Values:
        """rho [Ohm m] at the temperature [degC], scalar or array of any shape."""
        return self.reference_resistivity * (
            1.0 + self.temperature_coefficient * (temperature - self.reference_temperature)
        )


# Resistivity at 20 degC as the thesis takes it; temperature coefficient of annealed copper, IEC 60028.
COPPER = Conductor(reference_resistivity=1.68e-8, temperature_coefficient=0.00393, reference_temperature=20.0)
