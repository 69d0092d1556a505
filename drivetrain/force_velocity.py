"""The machine seen at the wheel: peak phase voltage and current over actuator force and velocity."""

from __future__ import annotations

from electrical.dq import DqMachine, DriveLimits, OperatingMap, Values, operating_map


def force_velocity_map(
    machine: DqMachine, limits: DriveLimits, transmission_ratio: float, force: Values, velocity: Values
) -> OperatingMap:
    """Currents and voltage needed for each actuator force [N] and velocity [m/s] (thesis Fig. 3.27).

    T = F tau_t, omega = v / tau_t (eqs 3.4, 3.5); tau_t in m/rad, arrays that broadcast, any signs. A positive product
    of force and velocity is motor operation. The gearbox is taken as free of loss.
    """
    return operating_map(machine, limits, force * transmission_ratio, velocity / transmission_ratio)
