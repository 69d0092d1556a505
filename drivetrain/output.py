"""Where an actuator acts, in words and units: at a wheel, or on a shaft.

Inside the project both are the same numbers: an effort [N or Nm], a speed [m/s or rad/s] and an inertia [kg or kg m^2]
behind a linkage ratio [m/rad or 1]. Reports take the words from here, so that a robot joint has no wheel.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from units import FACTORS, written


def labelled(words: str, unit: str) -> str:
    """``velocity / (m/s)``: words with a unit (a key of ``units.FACTORS``), nothing behind them for a pure number."""
    shown = written(unit)
    return f"{words} / {f'({shown})' if '/' in shown else shown}" if unit else words


def in_unit(value: Any, unit: str) -> Any:
    """A number or an array in SI as it is shown in a unit; a pure number for none."""
    return value / FACTORS.get(unit, 1.0)


def amount(value: float, unit: str) -> str:
    """``1.64 m/s`` of a number in SI and the unit to show it in."""
    shown = in_unit(value, unit)
    digits = f"{shown:.3g}" if abs(shown) < 1000 else f"{shown:.0f}"
    return f"{digits} {written(unit)}" if unit else digits


@dataclass(frozen=True)
class Output:
    """Words and drawing units of the output; units are keys of ``units.FACTORS``, empty for a pure number.

    place: where it is; end: side of the actuator that faces it; effort, speed, inertia: what they are called there
    inertia_key: of the study, where the inertia that counts as 1 is stated; axis_unit: of the effort in figures
    transmission: what may be varied between rotor and output; duty: where the RMS values act; duty_name: in names
    demands: what is asked, attribute of ``drivetrain.requirements.Requirements``, words, unit
    features: what a comparison of actuators shows: attribute of ``drivetrain.outcome.Features``, words, unit
    """

    place: ClassVar[str]
    end: ClassVar[str]
    effort: ClassVar[str]
    effort_unit: ClassVar[str]
    speed: ClassVar[str]
    speed_unit: ClassVar[str]
    inertia: ClassVar[str]
    inertia_unit: ClassVar[str]
    inertia_key: ClassVar[str]
    transmission: ClassVar[str]
    duty: ClassVar[str]
    duty_name: ClassVar[str]
    damping_unit: ClassVar[str]
    ratio_unit: ClassVar[str]
    axis_unit: ClassVar[str]
    demands: ClassVar[tuple[tuple[str, str, str], ...]]
    features: ClassVar[tuple[tuple[str, str, str], ...]]

    def overall_ratio(self, ratio: float) -> str:
        """A transmission ratio tau_t [m/rad or 1] as a sentence."""
        raise NotImplementedError

    def ratio(self, ratio: float) -> str:
        """A transmission ratio tau_t [m/rad or 1] inside a sentence."""
        raise NotImplementedError

    def ratio_columns(self, transmission_ratio: float, linkage_ratio: float) -> dict[str, float]:
        """tau_t and tau_l [m/rad or 1] as columns of a table, in drawing units."""
        raise NotImplementedError

    @property
    def inertia_column(self) -> str:
        """Name of a table's column: ``equivalent_mass_kg``."""
        return self.column(self.inertia.replace(" ", "_"), self.inertia_unit)

    def column(self, quantity: str, unit: str) -> str:
        """Name of a table's column: ``transmission_ratio_mm_per_rad``."""
        return f"{quantity}_{unit}" if unit else quantity

    def at_speed(self, speed: float) -> str:
        """``1.64 m/s`` of a speed in SI [m/s or rad/s]."""
        return amount(speed, self.speed_unit)


@dataclass(frozen=True)
class Wheel(Output):
    """A linkage turns the rotation of the lever into the travel of a wheel."""

    place = "at the wheel"
    end = "lever side"
    effort, effort_unit = "force", "N"
    speed, speed_unit = "velocity", "m_per_s"
    inertia, inertia_unit, inertia_key = "equivalent mass", "kg", "match.equivalent_mass_max_kg"
    transmission = "ratio and linkage"
    duty, duty_name = "on the road", "road"
    damping_unit = "kNs_per_m"
    ratio_unit = "mm_per_rad"
    axis_unit = "kN"
    demands = (
        ("maximum_damping", "maximum damping", "kNs_per_m"),
        ("force_rms", "force rms", "N"),
        ("velocity_rms", "velocity rms", "m_per_s"),
        ("power_rms", "power rms", "W"),
        ("velocity_peak", "velocity peak", "m_per_s"),
        ("force_peak", "force peak", "N"),
        ("velocity_at_force_peak", "velocity at force peak", "m_per_s"),
        ("power_peak", "power peak", "W"),
        ("force_at_power_peak", "force at power peak", "N"),
        ("velocity_at_power_peak", "velocity at power peak", "m_per_s"),
    )
    features = (
        ("effort_peak", "peak force at the wheel", "N"),
        ("slow_shaft_torque", "peak torque at the slow shaft", "Nm"),
        ("machine_torque", "peak torque of the machine", "Nm"),
        ("equivalent_mass", "equivalent inertia at the wheel", "kg"),
        ("transmission_ratio", "overall transmission ratio", "mm_per_rad"),
        ("gear_ratio", "gearbox, fast over slow speed", ""),
        ("linkage_ratio", "linkage, nominal", "mm_per_rad"),
        ("mass", "mass", "kg"),
        ("diameter", "diameter of the envelope", "mm"),
        ("length", "length of the envelope", "mm"),
    )

    def overall_ratio(self, ratio: float) -> str:
        """ratio: tau_t [m/rad]."""
        return f"Overall ratio {ratio / FACTORS[self.ratio_unit]:.3f} {written(self.ratio_unit)}"

    def ratio(self, ratio: float) -> str:
        return f"{ratio / FACTORS[self.ratio_unit]:.4g} {written(self.ratio_unit)}"

    def ratio_columns(self, transmission_ratio: float, linkage_ratio: float) -> dict[str, float]:
        ratios = {"transmission_ratio": transmission_ratio, "linkage_ratio": linkage_ratio}
        unit = self.ratio_unit
        return {self.column(name, unit): value / FACTORS[unit] for name, value in ratios.items()}


@dataclass(frozen=True)
class Shaft(Output):
    """The load sits on the slow shaft: a robot joint, a pump."""

    place = "at the shaft"
    end = "shaft side"
    effort, effort_unit = "torque", "Nm"
    speed, speed_unit = "speed", "rpm"
    inertia, inertia_unit, inertia_key = "inertia", "kg_m2", "drive.inertia_max_kg_m2"
    transmission = "gear ratio"
    duty, duty_name = "in service", "service"
    damping_unit = "Nms_per_rad"
    ratio_unit = ""
    axis_unit = "Nm"
    demands = (
        ("maximum_damping", "damping in short circuit", "Nms_per_rad"),
        ("force_rms", "torque rms", "Nm"),
        ("velocity_rms", "speed rms", "rpm"),
        ("power_rms", "power rms", "W"),
        ("velocity_peak", "speed peak", "rpm"),
        ("force_peak", "torque peak", "Nm"),
        ("velocity_at_force_peak", "speed at torque peak", "rpm"),
        ("power_peak", "power peak", "W"),
        ("force_at_power_peak", "torque at power peak", "Nm"),
        ("velocity_at_power_peak", "speed at power peak", "rpm"),
    )
    features = (
        ("effort_peak", "peak torque at the shaft", "Nm"),
        ("machine_torque", "peak torque of the machine", "Nm"),
        ("equivalent_mass", "inertia at the shaft", "kg_m2"),
        ("gear_ratio", "rotor speed over shaft speed", ""),
        ("mass", "mass", "kg"),
        ("diameter", "diameter of the envelope", "mm"),
        ("length", "length of the envelope", "mm"),
    )

    def overall_ratio(self, ratio: float) -> str:
        """ratio: of output over rotor speed, dimensionless."""
        return f"The rotor turns {1 / ratio:.3f} times as fast as the shaft"

    def ratio(self, ratio: float) -> str:
        return f"1:{1 / ratio:.4g}"

    def ratio_columns(self, transmission_ratio: float, linkage_ratio: float) -> dict[str, float]:
        return {"gear_ratio": linkage_ratio / transmission_ratio}
