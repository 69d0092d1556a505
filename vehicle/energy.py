"""Energy of a ride through the actuator: powers at its shafts and the battery, duties, efficiencies, balance.

Signs as in the thesis (Fig. 4.3): P > 0 flows from the suspension towards the battery.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from math import sqrt

import numpy as np

from actuator.parts import CompliantMount
from vehicle.indices import rms
from vehicle.ride import RideHistory


@dataclass(frozen=True)
class Power:
    """Power of two signals that need not be sinusoidal (thesis section 4.3.2, eq. 4.31).

    active: mean of effort times flow [W]; apparent: S, RMS of the effort times RMS of the flow [W]
    By Parseval's theorem the RMS is the root of the summed squares of all harmonics, the mean value included.
    """

    active: float
    apparent: float

    @property
    def reactive(self) -> float:
        """sqrt(S^2 - P^2) [W]."""
        return sqrt(max(self.apparent**2 - self.active**2, 0.0))

    @property
    def factor(self) -> float:
        """P / S, dimensionless; nan where nothing moves."""
        return self.active / self.apparent if self.apparent else float("nan")


def power_of(effort: np.ndarray, flow: np.ndarray) -> Power:
    """Of an effort [N, Nm or V], (t,), and its flow [m/s, rad/s or A], (t,)."""
    return Power(float(np.mean(effort * flow)), rms(effort) * rms(flow))


@dataclass(frozen=True)
class Duty:
    """Shares of the time in the four quadrants of effort and flow, dimensionless.

    braking_rebound, braking_bump: passive shares, in rebound and bump; driving_rebound, driving_bump: active shares
    """

    braking_rebound: float
    braking_bump: float
    driving_rebound: float
    driving_bump: float

    @property
    def active(self) -> float:
        """Share of the time in which power flows towards the suspension."""
        return self.driving_rebound + self.driving_bump


def duty_of(effort: np.ndarray, flow: np.ndarray) -> Duty:
    """Of an effort [N or Nm], (t,), and its flow [m/s or rad/s], (t,), of one sign each in rebound."""
    active, rebound = effort * flow < 0, flow > 0
    quadrants = (~active & rebound, ~active & ~rebound, active & rebound, active & ~rebound)
    return Duty(*(float(np.mean(one)) for one in quadrants))


@dataclass(frozen=True)
class RideEnergy:
    """What a ride comes to in energy (thesis Tables 4.6-4.14): means over the time.

    shaft: between suspension and actuator; machine: at the rotor; battery: electrical, at a constant voltage
    mount_loss, gear_loss, friction_loss, machine_loss [W]; stored: what the actuator keeps, over the time [W]
    elastic, inertial: reactive power of mount and equivalent mass [W]
    peak_electrical: of largest magnitude, with its sign [W]; shaft_duty, machine_duty; regenerating: share of the time
    comfort: weighted acceleration, RMS [m/s^2]; road_holding: RMS, dimensionless
    """

    shaft: Power
    machine: Power
    battery: Power
    mount_loss: float
    gear_loss: float
    friction_loss: float
    machine_loss: float
    stored: float
    elastic: float
    inertial: float
    peak_electrical: float
    shaft_duty: Duty
    machine_duty: Duty
    regenerating: float
    comfort: float
    road_holding: float

    @property
    def mechanical_loss(self) -> float:
        """Between suspension and machine [W]."""
        return self.mount_loss + self.gear_loss + self.friction_loss

    @property
    def efficiency(self) -> float:
        """Electrical over mechanical power, dimensionless; below zero where both flow in."""
        return self.battery.active / self.shaft.active

    @property
    def machine_efficiency(self) -> float:
        """Electrical power over that at the rotor, dimensionless."""
        return self.battery.active / self.machine.active

    @property
    def mechanical_efficiency(self) -> float:
        """Power at the rotor over that at the suspension, dimensionless."""
        return self.machine.active / self.shaft.active

    @property
    def closure(self) -> float:
        """What the balance leaves open, of the mechanical power (relative): P - losses - stored - P_el."""
        taken = self.mechanical_loss + self.machine_loss + self.stored
        return (self.shaft.active - taken - self.battery.active) / abs(self.shaft.active)


def ride_energy(history: RideHistory) -> RideEnergy:
    """The energy of one ride.

    Losses in mount, gears and friction are integrated with the motion; the powers at shafts and battery are means over
    the samples of the history, so that the closure is a check.
    """
    inside, actuator = history.inside, history.run.actuator
    span = float(history.time[-1] - history.time[0])
    lost = actuator.drive.loss.at(inside.torque, inside.rotor_speed)
    machine = power_of(inside.torque, inside.rotor_speed)
    electrical = inside.torque * inside.rotor_speed - lost
    elastic, inertial = _reactive(history)
    return RideEnergy(
        shaft=power_of(history.suspension_force, history.velocity),
        machine=machine,
        battery=Power(float(np.mean(electrical)), rms(electrical)),
        mount_loss=float(inside.mount[-1]) / span,
        gear_loss=float(inside.gears[-1]) / span,
        friction_loss=float(inside.friction[-1]) / span,
        machine_loss=float(np.mean(lost)),
        stored=_stored(history) / span,
        elastic=elastic,
        inertial=inertial,
        peak_electrical=float(electrical[np.argmax(np.abs(electrical))]),
        shaft_duty=duty_of(history.suspension_force, history.velocity),
        machine_duty=duty_of(inside.torque, inside.rotor_speed),
        regenerating=float(np.mean(electrical > 0)),
        comfort=rms(history.weighted_acceleration),
        road_holding=rms(history.road_holding),
    )


def _masses(history: RideHistory) -> np.ndarray:
    """Equivalent mass at the wheel over time [kg], (t,)."""
    actuator = history.run.actuator
    return actuator.equivalent_mass * (actuator.ratio.nominal / actuator.ratio.at(history.inside.mass_stroke)) ** 2


def _deformation(history: RideHistory) -> tuple[np.ndarray, np.ndarray]:
    inside = history.inside
    return history.stroke - inside.mass_stroke, history.velocity - inside.mass_velocity


def _stored(history: RideHistory) -> float:
    """Change of the energy in equivalent mass and mount over the ride [J]."""
    energy = _masses(history) * history.inside.mass_velocity**2 / 2
    mount = history.run.actuator.mount
    if isinstance(mount, CompliantMount):
        energy = energy + mount.energy(_deformation(history)[0])
    return float(energy[-1] - energy[0])


def _reactive(history: RideHistory) -> tuple[float, float]:
    """Apparent powers of mount and mass [W], which have no active part."""
    flows = _deformation(history)[1], history.inside.mass_velocity
    elastic, inertial = (power_of(*one).apparent for one in zip(_reactive_forces(history), flows, strict=True))
    return elastic, inertial


def reactive_powers(history: RideHistory) -> tuple[np.ndarray, np.ndarray]:
    """What the spring of the mount and the equivalent mass take and give back [W], both (t,) (thesis Fig. 4.39)."""
    elastic, inertial = _reactive_forces(history)
    return elastic * _deformation(history)[1], inertial * history.inside.mass_velocity


def _reactive_forces(history: RideHistory) -> tuple[np.ndarray, np.ndarray]:
    """Of the spring of the mount and of the equivalent mass [N], both (t,)."""
    mount, v = history.run.actuator.mount, history.inside.mass_velocity
    inertial = _masses(history) * np.gradient(v, history.time)
    deformation, rate = _deformation(history)
    elastic = mount.force(deformation, 0 * rate) if isinstance(mount, CompliantMount) else 0 * rate
    return elastic, inertial


@dataclass(frozen=True)
class Scatter:
    """Mean and standard deviation of a number over equally likely roads [unit of the number]."""

    mean: float
    deviation: float


def scatter(energies: Sequence[RideEnergy]) -> dict[str, Scatter]:
    """Over the seeds, of every number of ``RideEnergy``, by name; nested ones with a dot."""
    rows = [dict(_flat(one)) for one in energies]
    return {name: _of([row[name] for row in rows]) for name in rows[0]}


def _of(values: Sequence[float]) -> Scatter:
    spread = float(np.std(values, ddof=1)) if len(values) > 1 else float("nan")
    return Scatter(float(np.mean(values)), spread)


_OWN = ("mechanical_loss", "efficiency", "machine_efficiency", "mechanical_efficiency", "closure")


def _flat(energy: RideEnergy) -> list[tuple[str, float]]:
    found = [(name, float(getattr(energy, name))) for name in _OWN]
    for field in fields(energy):
        value = getattr(energy, field.name)
        if isinstance(value, Power):
            found += [(f"{field.name}.{k}", getattr(value, k)) for k in ("active", "apparent", "reactive", "factor")]
        elif isinstance(value, Duty):
            found += [(f"{field.name}.{k.name}", getattr(value, k.name)) for k in fields(value)]
            found.append((f"{field.name}.active", value.active))
        else:
            found.append((field.name, float(value)))
    return found
