"""What a machine gives over speed within the limits of its drive: full current, envelope, best currents, plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from electrical.dq import (
    DqMachine,
    DriveLimits,
    Envelope,
    OperatingMap,
    corner_speed,
    mtpa_currents,
    mtpv_currents,
    operating_map,
    peak_torque,
    torque_speed_envelope,
)
from electrical.driven_machine import DrivenMachine
from electrical.plane import plane_dataset, plane_record
from labelled import xr
from magnetostatics.flux_map_stage import FluxMap

_SPEEDS = 151  # of the envelope
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


@dataclass(frozen=True, eq=False)
class Performance:
    """See the module.

    mtpa_direct, mtpa_quadrature: i_d, i_q from no current to the limit [A], (currents,)
    mtpv_direct, mtpv_quadrature: i_d, i_q over the speeds of the envelope [A], (speeds,), NaN where the current limit
        rules
    data: least currents over torque and speed, a data set of ``OperatingMap``
    """

    full: FullCurrent
    envelope: Envelope
    mtpa_direct: np.ndarray
    mtpa_quadrature: np.ndarray
    mtpv_direct: np.ndarray
    mtpv_quadrature: np.ndarray
    data: xr.Dataset

    @property
    def plane(self) -> OperatingMap:
        """Least currents over torque and speed."""
        return plane_record(OperatingMap, self.data)


def performance_stage(flux_map: FluxMap, driven: DrivenMachine) -> Performance:
    """Of a wound machine on its flux map. Raises FluxMapMachineError when the map is too small for the current."""
    machine = driven.wound.on_map(flux_map.data)
    return performance(machine, driven.limits, driven.fastest, machine.reach)


def performance(machine: DqMachine, limits: DriveLimits, fastest: float, reach: float) -> Performance:
    """Up to a mechanical speed ``fastest`` [rad/s]; reach: largest current that MTPV is looked for with [A]."""
    speed = np.linspace(0.0, fastest, _SPEEDS)
    return Performance(
        full_current(machine, limits),
        torque_speed_envelope(machine, limits, speed),
        *mtpa_currents(machine, np.linspace(0.0, limits.current_peak, _CURVE)),
        *mtpv_currents(machine, limits.voltage_peak, speed, reach),
        data=plane_dataset(operating_plane(machine, limits, fastest)),
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
