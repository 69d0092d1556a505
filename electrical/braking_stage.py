"""The wound machine as a brake over the speed of the output: with shorted phases, cold and hot, and controlled."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from electrical.braking import Braking, holds_up_to, short_circuit, strongest_braking
from electrical.winding_stage import WindingInputs, WindingOutcome
from magnetostatics.flux_map_stage import FluxMap

_POINTS = 241  # speeds
_SLOWEST = 2e-3  # of the fastest speed


@dataclass(frozen=True)
class CopperHeat:
    """Between which temperatures the copper works.

    cold, hot: [degC]; cold_resistance, hot_resistance: over that of the wound machine, dimensionless
    """

    cold: float
    hot: float
    cold_resistance: float
    hot_resistance: float


@dataclass(frozen=True)
class BrakingDemand:
    """What is asked of a brake.

    damping: [Ns/m or Nms/rad], 0 where none is asked for; speed_rms, speed_peak: of the output [m/s or rad/s]
    ratio: of output over rotor speed [m/rad or 1]
    """

    damping: float
    speed_rms: float
    speed_peak: float
    ratio: float


@dataclass(frozen=True)
class ShortCircuit:
    """The machine with shorted phases.

    current_peak: largest phase current over the speeds of the brake, peak [A]
    torque: largest against the motion [Nm], the same cold and hot
    best_speed_cold, best_speed_hot: of the rotor, at which it brakes most [rad/s]
    """

    current_peak: float
    torque: float
    best_speed_cold: float
    best_speed_hot: float


@dataclass(frozen=True, eq=False)
class BrakingOutcome:
    """Braking of the rotor at each speed of the output.

    demand: what is asked; heat: of the copper; speed: of the output [m/s or rad/s], (n,)
    cold, hot: with shorted phases; controlled: hot, inside the limits of current and voltage
    back_emf: line to line peak at the peak speed [V]; bus_voltage [V]
    """

    demand: BrakingDemand
    heat: CopperHeat
    speed: np.ndarray
    cold: Braking
    hot: Braking
    controlled: Braking
    back_emf: float
    bus_voltage: float

    def damping(self, braking: Braking) -> np.ndarray:
        """At the output [Ns/m or Nms/rad], (n,)."""
        return braking.damping / self.demand.ratio**2

    def held_up_to(self, braking: Braking) -> float:
        """Speed of the output up to which the damping is reached that is asked for [m/s or rad/s]."""
        return holds_up_to(self.speed, self.damping(braking), self.demand.damping)

    @property
    def poles(self) -> tuple[float, float]:
        """Speed of the output at which the shorted machine brakes most, cold and hot [m/s or rad/s]."""
        cold, hot = (self.speed[int(np.nanargmax(one.torque))] for one in (self.cold, self.hot))
        return float(cold), float(hot)

    @property
    def shorted(self) -> ShortCircuit:
        """The brake with shorted phases at the rotor."""
        cold, hot = (speed / self.demand.ratio for speed in self.poles)
        current = max(float(np.nanmax(one.current_peak)) for one in (self.cold, self.hot))
        return ShortCircuit(current, float(np.nanmax(self.cold.torque)), cold, hot)


def braking_stage(
    flux_map: FluxMap, winding: WindingOutcome, inputs: WindingInputs, demand: BrakingDemand, heat: CopperHeat
) -> BrakingOutcome:
    """Follow the wound machine over the speeds that are asked of the output."""
    machine, wound = winding.wound.on_map(flux_map.data), winding.wound
    speed = np.geomspace(_SLOWEST, 1.0, _POINTS) * demand.speed_peak
    rotor = speed / demand.ratio
    cold, hot = (
        machine.with_resistance(wound.phase_resistance * f) for f in (heat.cold_resistance, heat.hot_resistance)
    )
    return BrakingOutcome(
        demand,
        heat,
        speed,
        short_circuit(cold, rotor),
        short_circuit(hot, rotor),
        strongest_braking(hot, winding.limits, rotor),
        sqrt(3.0) * float(np.hypot(*machine.voltage(0.0, 0.0, rotor[-1]))),
        inputs.limits.dc_voltage,
    )
