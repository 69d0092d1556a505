"""What is asked of the actuator and where it acts, as every stage behind them reads it."""

from __future__ import annotations

from dataclasses import dataclass

from electrical.shaft_demand import ShaftDemand


@dataclass(frozen=True)
class Requirements:
    """Demands at the wheel in nominal and overload condition (thesis Table 3.7), magnitudes.

    maximum_damping: regenerative damping [Ns/m], 0 where none is asked for
    force_rms [N], velocity_rms [m/s], power_rms [W]: nominal working point
    velocity_peak [m/s]; force_peak [N] at velocity_at_force_peak [m/s]; power_peak [W] = force_at_power_peak [N] times
    velocity_at_power_peak [m/s]
    """

    maximum_damping: float
    force_rms: float
    velocity_rms: float
    power_rms: float
    velocity_peak: float
    force_peak: float
    velocity_at_force_peak: float
    power_peak: float
    force_at_power_peak: float
    velocity_at_power_peak: float


@dataclass(frozen=True)
class StatedRequirements:
    """What a study states of its own beside what its vehicle asks for, for the comparison."""

    requirements: Requirements


@dataclass(frozen=True)
class Linkage:
    """Transmission from wheel travel to the lever of the actuator, tau_l.

    ratio_nominal: in the nominal wheel position [m/rad]
    ratio_max: the largest along the travel [m/rad], where torques are largest
    envelope_radius_max: largest outer radius of the actuator [m], None where nothing limits it
    """

    ratio_nominal: float
    ratio_max: float
    envelope_radius_max: float | None = None


@dataclass(frozen=True)
class Transmission:
    """Overall transmission from wheel travel to the rotor, linkage and gears together, tau_t.

    nominal: in the nominal wheel position [m/rad]
    largest: along the travel [m/rad], where a force asks for the largest torque
    """

    nominal: float
    largest: float


@dataclass(frozen=True)
class InstallationSpace:
    """Room for the actuator; radius_max: its largest outer radius [m], None where nothing limits it."""

    radius_max: float | None


def shaft_demand(required: Requirements, transmission: Transmission) -> ShaftDemand:
    """What the demands at the wheel are at the rotor: omega = v / tau_t, T = F tau_t, d = c tau_t^2 (3.4, 3.5, 3.120).

    Speeds and the damping count in the nominal position, as in the match; forces where the ratio is largest, so that
    they hold over the whole travel. Equation 3.120 prints 60 v/(2 pi) tau_t; the ratio divides (6643 rpm at 1.6 m/s and
    2.3 mm/rad).
    """
    return ShaftDemand(
        base_speed=required.velocity_at_force_peak / transmission.nominal,
        power=required.power_peak,
        torque_peak=required.force_peak * transmission.largest,
        torque_rms=required.force_rms * transmission.largest,
        damping=required.maximum_damping * transmission.nominal**2,
    )
