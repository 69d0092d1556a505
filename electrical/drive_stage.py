"""The chosen machine over speed, and neighbouring windings, by the flux map and by constant parameters."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from electrical.dq import DriveLimits, Envelope, base_speed, maximum_power, peak_torque, torque_speed_envelope
from electrical.driven_machine import DrivenMachine
from electrical.performance import Performance, performance
from electrical.synchronous_machine import SynchronousMachine
from electrical.winding_design import WindingDesign
from electrical.winding_selection import Winding, choose_among
from electrical.winding_stage import WindingInputs, WindingOutcome
from electrical.wound_machine import WoundMachine
from magnetostatics.flux_map_stage import FluxMap


@dataclass(frozen=True)
class Neighbour:
    """One winding valued on the flux map and by its constant parameters, and its envelope on the map."""

    field: Winding
    constant: Winding
    envelope: Envelope


@dataclass(frozen=True, eq=False)
class DriveOutcome:
    """See the module. field: by the flux map; constant: by constant parameters.

    neighbours: by turns; by_constant: the winding that constant parameters would choose of them
    """

    field: Performance
    constant: Performance
    neighbours: tuple[Neighbour, ...]
    by_constant: Winding

    def neighbour(self, design: WindingDesign) -> Neighbour:
        """The neighbour of this design."""
        return next(one for one in self.neighbours if one.field.design == design)


def drive_stage(
    flux_map: FluxMap, winding: WindingOutcome, driven: DrivenMachine, inputs: WindingInputs
) -> DriveOutcome:
    """Follow the wound machine over torque and speed, on its flux map and beside it by constant parameters.

    Raises FluxMapMachineError when the map is too small for the current limit.
    """
    machine, limits, fastest = driven.wound.on_map(flux_map.data), driven.limits, driven.fastest
    field = performance(machine, limits, fastest, machine.reach)
    pairs = tuple(_neighbour(flux_map, winding, one, field.envelope.speed, inputs) for one in winding.near)
    return DriveOutcome(
        field,
        performance(winding.constant, limits, fastest, machine.reach),
        neighbours=pairs,
        by_constant=choose_among(tuple(one.constant for one in pairs), inputs.limits, winding.requirement),
    )


def by_constant_parameters(
    winding: Winding, machine: SynchronousMachine, limits: DriveLimits, fastest: float
) -> Winding:
    """A winding with base speed, powers and peak torque of its constant parameters; fastest: speed [rad/s]."""
    torque, base = float(peak_torque(machine, limits)), float(base_speed(machine, limits))
    best = maximum_power(machine, limits, fastest)
    return replace(
        winding,
        peak_torque=torque,
        base_speed=base,
        power_at_base_speed=torque * base,
        maximum_power=float(best.power),
        speed_at_maximum_power=float(best.speed),
    )


def _neighbour(
    flux_map: FluxMap, winding: WindingOutcome, one: Winding, speed: np.ndarray, inputs: WindingInputs
) -> Neighbour:
    wound: WoundMachine = replace(winding.wound, design=one.design, active_length=one.active_length)
    limits = DriveLimits.from_dc_bus(one.current_peak, inputs.limits.dc_voltage)
    field = wound.on_map(flux_map.data)
    constant = one.constant_parameters(field.pole_pairs)
    plain = by_constant_parameters(one, constant, limits, inputs.limits.maximum_speed)
    return Neighbour(one, plain, torque_speed_envelope(field, limits, speed))
