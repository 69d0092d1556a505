"""What a wound machine can do at the output.

The output is a wheel behind a linkage or a shaft: an effort [N or Nm], a speed [m/s or rad/s] and an inertia [kg or
kg m^2] behind a transmission ratio [m/rad or 1]. The machine is its flux map, so that saturation, current and voltage
are in every number; gears and bearings are free of loss here, but for what a bench has shown.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import sqrt
from typing import Any

import numpy as np

from drivetrain.added_friction import NO_FRICTION, AddedFriction
from electrical.braking import strongest_braking
from electrical.dq import DriveLimits, torque_speed_envelope
from electrical.flux_map_machine import FluxMapMachine
from electrical.resistance import phase_resistance
from electrical.short_circuit import winding_damping

_IN_A_BATCH = ("turns", "strands", "active_length", "dc_voltage", "transmission_ratio")
Values = Any  # a number, or one for each design of a batch (designs,)


@dataclass(frozen=True, eq=False)
class ActuatorDesign:
    """Machine, winding, supply and transmission of an actuator, SI.

    per_turn: the machine with one turn a coil, one metre long and without resistance
    peak_torque_per_length: at the overload current density [Nm/m], as the winding stage states it
    turns, strands: of the equivalent star (``electrical.winding_connection``) and wires of one of its turns, neither a
        whole number in general; wire_area [m^2]; resistivity [ohm m]
    coils_in_series of a phase; active_length, end_turn_length [m]
    continuous_torque: what the temperatures allow at the RMS speed [Nm], as the heat stage states it; rated_length: at
        which it does [m]
    overload_density: current density in the copper, RMS [A/m^2]; dc_voltage [V]
    transmission_ratio: tau_t [m/rad or 1]
    rotor_inertia_per_length [kg m]; gearbox_inertia: at the rotor shaft [kg m^2]
    friction: losses on the way to the output that a bench has shown

    turns, strands, active_length, dc_voltage and transmission_ratio may be arrays (designs,): a batch of designs. Their
    product of turns and strands is the same in all, so that the ampere-turns are.
    """

    per_turn: FluxMapMachine
    peak_torque_per_length: float
    turns: Values
    strands: Values
    wire_area: float
    resistivity: float
    coils_in_series: int
    active_length: Values
    end_turn_length: float
    continuous_torque: float
    rated_length: float
    overload_density: float
    dc_voltage: Values
    transmission_ratio: Values
    rotor_inertia_per_length: float
    gearbox_inertia: float
    friction: AddedFriction = NO_FRICTION

    @property
    def resistance(self) -> Values:
        """Of one phase [ohm]."""
        return phase_resistance(
            turns=self.turns,
            strands=self.strands,
            wire_area=self.wire_area,
            active_length=self.active_length,
            end_turn_length=self.end_turn_length,
            coils_in_series=self.coils_in_series,
            resistivity=self.resistivity,
        )

    def _ampere_turns(self, density: float) -> float:
        """Peak phase current at an RMS current density, times the turns [A]."""
        return sqrt(2) * density * self.wire_area * float(np.max(self.turns * self.strands))

    @property
    def phase_current_rms(self) -> Values:
        """RMS phase current of the overload [A]."""
        return self.overload_density * self.wire_area * self.strands

    def effort_at(self, speed: float) -> Values:
        """Largest effort [N or Nm] at an output speed [m/s or rad/s], magnitude, within current and voltage; 0 where
        none is left."""
        designs = np.broadcast_shapes(np.shape(self._volts_per_turn), np.shape(self.transmission_ratio))
        made = self.effort_over(np.full(designs, abs(speed)))
        return self.friction.left(made, abs(speed), self.transmission_ratio)

    def effort_over(self, speed: np.ndarray) -> np.ndarray:
        """The same effort without friction [N or Nm], (n,), over speeds for one design; for a batch one speed a design.

        speed: of the output [m/s or rad/s], (n,)
        """
        torque = self._torque_per_length(np.abs(speed) / self.transmission_ratio) * self.active_length
        return torque / self.transmission_ratio

    @property
    def _volts_per_turn(self) -> Values:
        """Bus voltage for each turn and metre [V/m]."""
        return self.dc_voltage / (self.turns * self.active_length)

    def braking_at(self, speed: float) -> Values:
        """Largest effort against the motion [N or Nm] at an output speed [m/s or rad/s], within current and voltage."""
        torque = strongest_braking(*self._one_turn(speed / self.transmission_ratio)).torque
        return np.nan_to_num(torque, nan=0.0) * self.active_length / self.transmission_ratio

    def _torque_per_length(self, rotor_speed: np.ndarray) -> np.ndarray:
        """Envelope per turn and metre [Nm/m]."""
        return np.asarray(np.nan_to_num(torque_speed_envelope(*self._one_turn(rotor_speed)).torque, nan=0.0))

    def _one_turn(self, rotor_speed: Values) -> tuple[FluxMapMachine, DriveLimits, np.ndarray]:
        """Machine and limits per turn and metre, and the speed [rad/s], of one shape: v = N l v_1, i = i_1 / N,
        R = N^2 l R_1."""
        one_turn = self.resistance / (self.turns**2 * self.active_length)
        shape = np.broadcast_shapes(np.shape(rotor_speed), np.shape(one_turn), np.shape(self._volts_per_turn))
        machine = self.per_turn.with_resistance(np.broadcast_to(one_turn, shape))
        volts = np.broadcast_to(self._volts_per_turn, shape)
        limits = DriveLimits.from_dc_bus(self._ampere_turns(self.overload_density), volts)
        return machine, limits, np.broadcast_to(rotor_speed, shape)

    @property
    def peak_torque(self) -> Values:
        """Largest torque of the machine at rest [Nm]."""
        return self.peak_torque_per_length * self.active_length

    @property
    def effort_peak(self) -> Values:
        """Largest effort at rest [N or Nm]."""
        return self.friction.left(self.peak_torque / self.transmission_ratio, 0.0, self.transmission_ratio)

    @property
    def effort_continuous(self) -> Values:
        """Effort that the temperatures allow for ever [N or Nm].

        At another length in proportion to it where the ways inside the machine are the bottleneck, to its root where
        the casing is, which stays: the smaller of the two, on the safe side.
        """
        longer = self.active_length / self.rated_length
        made = self.continuous_torque * np.minimum(longer, np.sqrt(longer)) / self.transmission_ratio
        return self.friction.left(made, 0.0, self.transmission_ratio)

    @property
    def low_speed_damping(self) -> Values:
        """Damping with short-circuited phases at low speed, 2 K_t^2 / (3 R tau_t^2) (3.75), no-load flux
        [Ns/m or Nms/rad]."""
        flux = float(self.per_turn.flux_linkage(0.0, 0.0)[0]) * self.turns * self.active_length
        return winding_damping(
            torque_constant=1.5 * self.per_turn.pole_pairs * flux,
            phase_resistance=self.resistance,
            transmission_ratio=self.transmission_ratio,
        )

    @property
    def equivalent_mass(self) -> Values:
        """Rotor and gears at the output, J / tau_t^2 [kg or kg m^2] (3.100)."""
        rotor = self.rotor_inertia_per_length * self.active_length
        return (rotor + self.gearbox_inertia) / self.transmission_ratio**2


def together(designs: Sequence[ActuatorDesign]) -> ActuatorDesign:
    """One batch of designs that differ in turns, strands, length, voltage or transmission ratio; each may be one."""
    sizes = [np.broadcast_shapes((1,), *(np.shape(getattr(one, name)) for name in _IN_A_BATCH)) for one in designs]
    rows = list(zip(designs, sizes, strict=True))
    changed: dict[str, Any] = {
        name: np.concatenate([np.broadcast_to(getattr(one, name), size) for one, size in rows]) for name in _IN_A_BATCH
    }
    return replace(designs[0], **changed)
