"""The wound machine over speed: envelope, MTPV, operating plane, and neighbouring windings by both models."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from electrical.dq import (
    DqMachine,
    DriveLimits,
    Envelope,
    OperatingMap,
    base_speed,
    corner_speed,
    maximum_power,
    mtpa_currents,
    mtpv_currents,
    operating_map,
    peak_torque,
    torque_speed_envelope,
)
from electrical.plane import plane_dataset, plane_record
from electrical.synchronous_machine import SynchronousMachine
from electrical.winding_design import WindingDesign
from electrical.winding_selection import Winding, choose_among
from electrical.winding_stage import WindingInputs, WindingOutcome
from electrical.wound_machine import WoundMachine
from magnetostatics.flux_map_stage import FluxMap

_SPEEDS = 151  # of the envelopes
_PLANE_SPEEDS, _PLANE_TORQUES = 121, 81
_CURVE = 61  # currents of the MTPA curve


@dataclass(frozen=True)
class FullCurrent:
    """What a machine gives at the full current: at MTPA and on the q axis.

    direct, quadrature: i_d, i_q of MTPA [A]; torque, torque_on_q [Nm]; base_speed, corner_speed_on_q [rad/s]
    """

    direct: float
    quadrature: float
    torque: float
    base_speed: float
    torque_on_q: float
    corner_speed_on_q: float


@dataclass(frozen=True)
class Neighbour:
    """One winding valued on the flux map and by its constant parameters, and its envelope on the map."""

    field: Winding
    constant: Winding
    envelope: Envelope


@dataclass(frozen=True, eq=False)
class DriveOutcome:
    """See the module. field: the flux map; constant: constant parameters.

    mtpa_direct, mtpa_quadrature: i_d, i_q from no current to the limit [A], (currents,)
    mtpv_direct, mtpv_quadrature: i_d, i_q over the speeds of the envelopes [A], (speeds,), NaN where the current
        limit rules
    field_plane, constant_plane: least currents over torque and speed, data sets of ``OperatingMap``
    neighbours: by turns; by_constant: the winding that constant parameters would choose of them
    """

    field: FullCurrent
    constant: FullCurrent
    envelope: Envelope
    constant_envelope: Envelope
    mtpa_direct: np.ndarray
    mtpa_quadrature: np.ndarray
    mtpv_direct: np.ndarray
    mtpv_quadrature: np.ndarray
    field_plane: xr.Dataset
    constant_plane: xr.Dataset
    neighbours: tuple[Neighbour, ...]
    by_constant: Winding

    @property
    def plane(self) -> OperatingMap:
        """Least currents on the flux map."""
        return plane_record(OperatingMap, self.field_plane)

    @property
    def plane_of_constant_parameters(self) -> OperatingMap:
        """Least currents by constant parameters."""
        return plane_record(OperatingMap, self.constant_plane)

    def neighbour(self, design: WindingDesign) -> Neighbour:
        """The neighbour of this design."""
        return next(one for one in self.neighbours if one.field.design == design)


def drive_stage(flux_map: FluxMap, winding: WindingOutcome, inputs: WindingInputs) -> DriveOutcome:
    """Follow the wound machine over torque and speed, on its flux map and beside it by constant parameters.

    Raises FluxMapMachineError when the map is too small for the current limit.
    """
    field, constant, limits = winding.wound.on_map(flux_map.data), winding.constant, winding.limits
    fastest = inputs.limits.maximum_speed
    speed = np.linspace(0.0, fastest, _SPEEDS)
    pairs = tuple(_neighbour(flux_map, winding, one, speed, inputs) for one in winding.near)
    return DriveOutcome(
        full_current(field, limits),
        full_current(constant, limits),
        torque_speed_envelope(field, limits, speed),
        torque_speed_envelope(constant, limits, speed),
        *mtpa_currents(field, np.linspace(0.0, limits.current_peak, _CURVE)),
        *mtpv_currents(field, limits.voltage_peak, speed, field.reach),
        field_plane=plane_dataset(operating_plane(field, limits, fastest)),
        constant_plane=plane_dataset(operating_plane(constant, limits, fastest)),
        neighbours=pairs,
        by_constant=choose_among(tuple(one.constant for one in pairs), inputs.limits, winding.requirement),
    )


def full_current(machine: DqMachine, limits: DriveLimits) -> FullCurrent:
    """A machine at its full current."""
    i_d, i_q = mtpa_currents(machine, limits.current_peak)
    return FullCurrent(
        float(i_d),
        float(i_q),
        float(machine.torque(i_d, i_q)),
        float(corner_speed(machine, limits, i_d, i_q)),
        float(machine.torque(0.0, limits.current_peak)),
        float(corner_speed(machine, limits, 0.0, limits.current_peak)),
    )


def operating_plane(machine: DqMachine, limits: DriveLimits, fastest: float) -> OperatingMap:
    """Least currents from no torque to the largest and from rest to ``fastest`` [rad/s]."""
    torque = np.linspace(0.0, float(peak_torque(machine, limits)), _PLANE_TORQUES)
    return operating_map(machine, limits, torque[:, None], np.linspace(0.0, fastest, _PLANE_SPEEDS))


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
