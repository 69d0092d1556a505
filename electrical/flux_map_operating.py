"""Smallest current for each torque and speed of a saturated machine, under a current and a voltage limit."""

from __future__ import annotations

import numpy as np

from electrical.flux_map_machine import FluxMapMachine
from electrical.synchronous_machine import VOLTAGE_SLACK, DriveLimits, OperatingMap

_DIRECT = 241  # values of i_d that are tried
_QUADRATURE = 161  # values of i_q between which the torque is inverted


def operating_map(machine: FluxMapMachine, limits: DriveLimits, torque, speed) -> OperatingMap:
    """Peak currents and voltage over torques (t,) [Nm], none negative, and speeds (s,) [rad/s]: arrays (t, s).

    On each line of constant i_d the torque is inverted to i_q, and of the i_d whose voltage fits the one of least
    current is taken: MTPA (to 1/240 of the current limit), field weakening and MTPV in one. NaN where out of reach.
    """
    torque, speed = np.asarray(torque, dtype=float), np.asarray(speed, dtype=float)
    i_d = np.linspace(-float(limits.current_peak), 0.0, _DIRECT)
    i_q = _quadrature_currents(machine, limits, torque, i_d)  # (t, d)
    direct = np.broadcast_to(i_d, i_q.shape)
    psi = machine.flux_linkage(direct, np.nan_to_num(i_q))
    best = [_least_current(machine, limits, direct, i_q, psi, one) for one in speed]
    currents = np.stack(best, axis=-1)  # (2, t, s)
    shape = np.broadcast_arrays(torque[:, None], speed[None, :])
    voltage = np.hypot(*machine.voltage(*np.nan_to_num(currents), shape[1]))
    return OperatingMap(*shape, *currents, np.where(np.isnan(currents[0]), np.nan, voltage))


def _quadrature_currents(machine, limits, torque, i_d):
    """i_q that gives each torque at each i_d, (t, d); NaN beyond the current limit."""
    columns = []
    for one in i_d:
        largest = np.sqrt(max(limits.current_peak**2 - one**2, 0.0))
        samples = np.linspace(0.0, largest, _QUADRATURE)
        columns.append(np.interp(torque, machine.torque(np.full_like(samples, one), samples), samples, right=np.nan))
    return np.stack(columns, axis=-1)


def _least_current(machine, limits, i_d, i_q, psi, speed):
    """(i_d, i_q) (2, t) of least current at one speed; where the voltage decides, on its limit between two samples."""
    omega = machine.pole_pairs * speed
    voltage = np.hypot(machine.resistance * i_d - omega * psi[1], machine.resistance * i_q + omega * psi[0])
    fits = voltage <= limits.voltage_peak * (1 + VOLTAGE_SLACK)
    current = np.where(fits, np.hypot(i_d, i_q), np.inf)
    at, rows = np.argmin(current, axis=1), np.arange(len(current))
    after = np.minimum(at + 1, current.shape[1] - 1)  # nearer to no weakening
    rise = voltage[rows, after] - voltage[rows, at]
    held = ~fits[rows, after] & np.isfinite(i_q[rows, after]) & (rise > 0)
    share = np.where(held, (limits.voltage_peak - voltage[rows, at]) / np.where(held, rise, 1.0), 0.0)
    share = np.where(np.isfinite(share), np.clip(share, 0.0, 1.0), 0.0)
    found = [(1 - share) * one[rows, at] + share * np.where(held, one[rows, after], 0.0) for one in (i_d, i_q)]
    return np.where(np.isfinite(current[rows, at]), found, np.nan)
