"""What a wound machine can do at the wheel, which requirements hold, and what would make them hold.

The machine is its flux map, so that saturation, current and voltage are in every number; gears and bearings are free of
loss here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi, sqrt

import numpy as np

from electrical.dq import DriveLimits, mtpa_currents, torque_speed_envelope
from electrical.flux_map_machine import FluxMapMachine
from electrical.resistance import phase_resistance
from electrical.short_circuit import winding_damping
from units import MILLIMETRE

SLACK = 1e-6  # relative; a capability this close to its requirement is met
LEVER_RANGE = 3.0  # a lever is moved to a third of its value or to three times it, not further
_STEPS = 4  # between which the bisection starts
_BISECTIONS = 7  # of a lever: its value to 0.2 %


@dataclass(frozen=True, eq=False)
class ActuatorDesign:
    """Machine, winding, supply and transmission of an actuator, SI.

    flux_map: per turn and metre over angle, id, iq, as ``magnetostatics.flux_map`` gives it
    turns, strands: wires of one turn, need not be whole while a lever is moved; wire_area [m^2]; resistivity [ohm m]
    coils_in_series of a phase; active_length, end_turn_length [m]
    nominal_density, overload_density: current density in the copper, RMS [A/m^2]; dc_voltage [V]
    transmission_ratio: tau_t [m/rad]
    stator_outer_radius, rotor_outer_radius [m]; density [kg/m^3]: the motor is a solid steel cylinder, its rotor too
    gearbox_mass, other_mass [kg]; gearbox_inertia: at the rotor shaft [kg m^2]
    """

    flux_map: object
    turns: float
    strands: float
    wire_area: float
    resistivity: float
    coils_in_series: int
    active_length: float
    end_turn_length: float
    nominal_density: float
    overload_density: float
    dc_voltage: float
    transmission_ratio: float
    stator_outer_radius: float
    rotor_outer_radius: float
    density: float
    gearbox_mass: float
    other_mass: float
    gearbox_inertia: float

    @cached_property
    def machine(self) -> FluxMapMachine:
        """The machine with its winding."""
        resistance = phase_resistance(
            turns=self.turns,
            strands=self.strands,
            wire_area=self.wire_area,
            active_length=self.active_length,
            end_turn_length=self.end_turn_length,
            coils_in_series=self.coils_in_series,
            resistivity=self.resistivity,
        )
        return FluxMapMachine.from_per_turn(
            self.flux_map, turns=self.turns, active_length=self.active_length, resistance=resistance
        )

    @property
    def limits(self) -> DriveLimits:
        """Peak phase current of the overload and peak phase voltage of the bus."""
        return DriveLimits.from_dc_bus(self._current(self.overload_density), self.dc_voltage)

    def _current(self, density: float) -> float:
        """Peak phase current at an RMS current density [A]."""
        return sqrt(2) * density * self.wire_area * self.strands

    def force_at(self, velocity):
        """Largest force [N] at wheel velocities [m/s], magnitudes, within current and voltage; 0 where none is left."""
        speed = np.abs(np.atleast_1d(velocity)) / self.transmission_ratio
        torque = torque_speed_envelope(self.machine, self.limits, speed).torque
        return np.nan_to_num(torque, nan=0.0) / self.transmission_ratio

    @property
    def peak_torque(self) -> float:
        """Largest torque at rest [Nm]."""
        return float(self.machine.torque(*mtpa_currents(self.machine, self.limits.current_peak)))

    @property
    def force_peak(self) -> float:
        """Largest force at rest [N]."""
        return self.peak_torque / self.transmission_ratio

    @property
    def force_continuous(self) -> float:
        """Force at the nominal current density [N]."""
        current = self._current(self.nominal_density)
        return float(self.machine.torque(*mtpa_currents(self.machine, current))) / self.transmission_ratio

    @property
    def regenerative_damping(self) -> float:
        """Damping with short-circuited phases at low speed, 2 K_t^2 / (3 R tau_t^2) [Ns/m] (3.75), no-load flux."""
        machine = self.machine
        torque_constant = 1.5 * machine.pole_pairs * float(machine.flux_linkage(0.0, 0.0)[0])
        return winding_damping(
            torque_constant=torque_constant,
            phase_resistance=machine.resistance,
            transmission_ratio=self.transmission_ratio,
        )

    @property
    def mass(self) -> float:
        """[kg]"""
        motor = self.density * pi * self.stator_outer_radius**2 * self.active_length
        return motor + self.gearbox_mass + self.other_mass

    @property
    def equivalent_mass(self) -> float:
        """Rotor and gears at the wheel, J / tau_t^2 [kg] (3.100, 3.102 with R_ro^4)."""
        rotor = self.density * pi * self.rotor_outer_radius**4 * self.active_length / 2
        return (rotor + self.gearbox_inertia) / self.transmission_ratio**2


@dataclass(frozen=True)
class Requirement:
    """One demand: what is needed, how it is read off a design, and whether that is a lower or an upper bound.

    scale, unit: of the number as it is shown, value / scale
    """

    name: str
    needed: float
    reading: Callable[[ActuatorDesign], float]
    at_most: bool = False
    scale: float = 1.0
    unit: str = ""

    def check(self, design: ActuatorDesign) -> Check:
        """The requirement against one design."""
        return Check(self, float(self.reading(design)))


@dataclass(frozen=True)
class Check:
    """A requirement and the value that a design reaches."""

    requirement: Requirement
    reached: float

    @property
    def margin(self) -> float:
        """Relative; negative where the requirement does not hold."""
        ratio = self.reached / self.requirement.needed - 1
        return -ratio if self.requirement.at_most else ratio

    @property
    def holds(self) -> bool:
        return self.margin >= -SLACK


@dataclass(frozen=True)
class Lever:
    """An input that can be moved: its present value, unit for showing, and the design with another value."""

    name: str
    value: float
    scale: float
    unit: str
    moved: Callable[[ActuatorDesign, float], ActuatorDesign]


def levers_of(design: ActuatorDesign) -> tuple[Lever, ...]:
    """Active length, transmission ratio, bus voltage, and turns at constant copper (the current grows as they fall)."""

    def rewound(one: ActuatorDesign, turns: float) -> ActuatorDesign:
        return replace(one, turns=turns, strands=one.turns * one.strands / turns)

    return (
        Lever("active length", design.active_length, MILLIMETRE, "mm", lambda d, x: replace(d, active_length=x)),
        Lever("transmission ratio", design.transmission_ratio, MILLIMETRE, "mm/rad",
              lambda d, x: replace(d, transmission_ratio=x)),
        Lever("bus voltage", design.dc_voltage, 1.0, "V", lambda d, x: replace(d, dc_voltage=x)),
        Lever("turns, at the same copper", design.turns, 1.0, "", rewound),
    )  # fmt: skip


@dataclass(frozen=True)
class Remedy:
    """The smallest move of one lever that makes a failing requirement hold, and what would fail then.

    value: None where the lever does not reach it within ``LEVER_RANGE``
    """

    requirement: Requirement
    lever: Lever
    value: float | None
    fails_then: tuple[str, ...] = ()


def remedies(design: ActuatorDesign, requirements: Sequence[Requirement]) -> tuple[Remedy, ...]:
    """For every requirement that does not hold: each lever alone, in both directions, the smaller move of the two."""
    failing = [one for one in requirements if not one.check(design).holds]
    return tuple(_remedy(design, one, lever, requirements) for one in failing for lever in levers_of(design))


def _remedy(design, requirement, lever, requirements) -> Remedy:
    found = [_smallest_move(design, requirement, lever, factor) for factor in (LEVER_RANGE, 1 / LEVER_RANGE)]
    reached = [value for value in found if value is not None]
    if not reached:
        return Remedy(requirement, lever, None)
    value = min(reached, key=lambda x: abs(np.log(x / lever.value)))
    moved = lever.moved(design, value)
    others = tuple(
        one.name for one in requirements if one is not requirement
        and one.check(design).holds and not one.check(moved).holds
    )  # fmt: skip
    return Remedy(requirement, lever, value, others)


def _smallest_move(design, requirement, lever, factor):
    """Value of the lever nearest to the present one at which the requirement holds, towards ``factor`` times it."""

    def holds(share):
        return requirement.check(lever.moved(design, lever.value * factor**share)).holds

    shares = np.linspace(0, 1, _STEPS + 1)[1:]
    first = next((k for k, share in enumerate(shares) if holds(share)), None)
    if first is None:
        return None
    low, high = (shares[first - 1] if first else 0.0), shares[first]
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        low, high = (low, middle) if holds(middle) else (middle, high)
    return lever.value * factor**high
