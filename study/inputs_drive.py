"""A load on the slow shaft in SI: a robot joint or a pump in the place of a wheel and its linkage.

The stages speak of a force [N] and a velocity [m/s] behind a linkage ratio [m/rad]; on a shaft these are a torque [Nm]
and a speed [rad/s] behind a ratio of 1, and an equivalent mass is an inertia [kg m^2].
"""

from __future__ import annotations

from dataclasses import dataclass

from drivetrain.output import Output, Shaft, Wheel
from drivetrain.requirements import Linkage, Requirements
from study.schema import DriveSection, Study


@dataclass(frozen=True)
class Friction:
    """At the output: viscous [Ns/m or Nms/rad], coulomb [N or Nm]."""

    viscous: float
    coulomb: float


def output(study: Study) -> Output:
    """Where the actuator acts."""
    return Wheel() if study.drive is None else Shaft()


def drive_requirements(section: DriveSection) -> Requirements:
    """What the load asks for at the shaft."""
    si = section.si
    return Requirements(
        maximum_damping=si.damping or 0.0,
        force_rms=si.torque_rms,
        velocity_rms=si.speed_rms,
        power_rms=si.power_rms,
        velocity_peak=si.speed_peak,
        force_peak=si.torque_peak,
        velocity_at_force_peak=si.speed_at_torque_peak,
        power_peak=si.torque_at_power_peak * si.speed_at_power_peak,
        force_at_power_peak=si.torque_at_power_peak,
        velocity_at_power_peak=si.speed_at_power_peak,
    )


def drive_linkage(section: DriveSection) -> Linkage:
    """The shaft itself."""
    diameter = section.si.diameter_max
    return Linkage(1.0, 1.0, None if diameter is None else diameter / 2)


def largest_equivalent_mass(study: Study) -> float:
    """Inertia of rotor and gears at the output that counts as 1 in the cost [kg, kg m^2 on a shaft]."""
    return study.match.si.equivalent_mass_max if study.drive is None else study.drive.si.inertia_max


def friction_at(study: Study) -> Friction:
    """Of the whole, at the output."""
    section = study.assembly.si if study.drive is None else study.drive.si
    return Friction(section.viscous_friction, section.coulomb_friction)
