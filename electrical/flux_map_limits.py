"""What a current and a voltage limit leave of a saturated machine: MTPA, MTPV, base speed, torque over speed.

The same questions as in ``synchronous_machine``, answered by searches on the flux map instead of closed forms; in the
limit of a linear map both agree. Resistance is counted. Quadrant of motoring, i_q >= 0.
"""

from __future__ import annotations

from math import pi

import numpy as np

from electrical.flux_map_machine import FluxMapMachine, FluxMapMachineError
from electrical.synchronous_machine import (
    GOLDEN,
    VOLTAGE_SLACK,
    DriveLimits,
    Envelope,
    corner_speed,
)

_GOLDEN_STEPS = 36  # shrinks an interval to 3e-8 of its length; a maximum is known no better in double precision
_ROOT_STEPS = 12  # of the root search, which more than doubles the digits in two steps
_SAMPLES = 33  # of i_q on a line of constant i_d, between which the voltage limit is bracketed
_ON_EDGE = 1e-6  # relative to the width of the map


def mtpa_currents(machine: FluxMapMachine, current_peak):
    """(i_d, i_q) of the largest torque at a given peak phase current [A], any shape.

    Golden-section search over the current angle gamma, i_d = -I sin(gamma), i_q = I cos(gamma).
    Raises FluxMapMachineError when the circle leaves the map.
    """
    current = np.asarray(current_peak, dtype=float)
    _check_reach(machine, current)
    with np.errstate(divide="ignore", invalid="ignore"):
        low = -np.arcsin(np.where(current > 0, np.minimum(machine.i_d[-1] / current, 1.0), 1.0))
    gamma = _golden_maximum(
        lambda g: machine.torque(-current * np.sin(g), current * np.cos(g)), low, np.full_like(low, pi / 2)
    )
    return -current * np.sin(gamma), current * np.cos(gamma)


def base_speed(machine: FluxMapMachine, limits: DriveLimits):
    """Highest mechanical speed at which the full current gives its largest torque [rad/s]."""
    return corner_speed(machine, limits, *mtpa_currents(machine, limits.current_peak))


def torque_speed_envelope(machine: FluxMapMachine, limits: DriveLimits, speed) -> Envelope:
    """Largest motoring torque under both limits at each mechanical speed [rad/s], not negative, any shape.

    For each i_d the largest allowed i_q is found by bisection on |v| = V, and a golden-section search over i_d takes
    the best: MTPA, field weakening and MTPV in one. Torque and currents are NaN where no current keeps the voltage
    inside. Raises FluxMapMachineError when the current limit leaves the map, or the best current lies on its edge at
    positive i_d.
    """
    speed = np.asarray(speed, dtype=float)
    if not np.all(speed >= 0):
        raise FluxMapMachineError("the motoring envelope needs speeds that are not negative")
    _check_reach(machine, limits.current_peak)
    low = np.full(speed.shape, -float(limits.current_peak))
    high = np.full(speed.shape, min(float(limits.current_peak), machine.i_d[-1]))
    i_d = _golden_maximum(lambda i: _merit(machine, limits, speed, i), low, high)
    i_q, excess = _largest_i_q(machine, limits, speed, i_d)
    reached = excess <= VOLTAGE_SLACK * limits.voltage_peak**2
    i_d, i_q = np.where(reached, i_d, np.nan), np.where(reached, i_q, np.nan)
    _check_edge(machine, limits, i_d)
    voltage = np.hypot(*machine.voltage(i_d, i_q, speed))
    return Envelope(speed, machine.torque(i_d, i_q), i_d, i_q, voltage)


def mtpv_currents(machine: FluxMapMachine, voltage_peak: float, speed):
    """(i_d, i_q) of the largest torque that a peak phase voltage [V] allows at each speed, whatever the current.

    NaN where that current lies beyond the map's reach.
    """
    limits = DriveLimits(machine.reach, voltage_peak)
    envelope = torque_speed_envelope(machine, limits, speed)
    free = envelope.current_peak < (1 - _ON_EDGE) * machine.reach
    return np.where(free, envelope.i_d, np.nan), np.where(free, envelope.i_q, np.nan)


def _merit(machine, limits, speed, i_d):
    """Torque where i_d is allowed, minus the excess of |v|^2 elsewhere: one peak over the whole range of i_d."""
    i_q, excess = _largest_i_q(machine, limits, speed, i_d)
    return np.where(excess > 0, -excess, machine.torque(i_d, i_q))


def _largest_i_q(machine, limits, speed, i_d):
    """Largest i_q >= 0 inside both limits at this i_d, and by how much |v|^2 exceeds V^2 at best [V^2]."""
    chord = np.sqrt(np.maximum(limits.current_peak**2 - i_d**2, 0.0))
    samples = chord[..., None] * np.linspace(0.0, 1.0, _SAMPLES)
    excess = _voltage_excess(machine, limits, speed[..., None], np.broadcast_to(i_d[..., None], samples.shape), samples)
    last = _last_true(excess <= 0)
    ends = [np.maximum(last, 0)[..., None], np.minimum(last + 1, _SAMPLES - 1)[..., None]]
    (low, high), (at_low, at_high) = (
        [np.take_along_axis(values, end, axis=-1)[..., 0] for end in ends] for values in (samples, excess)
    )
    i_q = _root(lambda i: _voltage_excess(machine, limits, speed, i_d, i), low, high, at_low, at_high)
    return np.where(last >= 0, i_q, 0.0), np.where(last >= 0, 0.0, excess.min(axis=-1))


def _root(function, low, high, at_low, at_high):
    """Root between low, where the function is not positive, and high, elementwise; low where both are one point.

    The Illinois rule: a chord, with the value at an end halved that two steps in turn have left where it is.
    """
    side = np.zeros(np.shape(low))
    for _ in range(_ROOT_STEPS):
        rise = at_high - at_low
        share = np.divide(-at_low, rise, out=np.zeros_like(rise), where=rise > 0)
        new = low + np.clip(share, 0, 1) * (high - low)
        at_new = function(new)
        fits = at_new <= 0
        at_high = np.where(fits & (side > 0), at_high / 2, np.where(fits, at_high, at_new))
        at_low = np.where(~fits & (side < 0), at_low / 2, np.where(fits, at_new, at_low))
        low, high, side = np.where(fits, new, low), np.where(fits, high, new), np.where(fits, 1, -1)
    return low


def _voltage_excess(machine, limits, speed, i_d, i_q):
    v_d, v_q = machine.voltage(i_d, i_q, speed)
    return v_d**2 + v_q**2 - limits.voltage_peak**2


def _last_true(found: np.ndarray) -> np.ndarray:
    """Index of the last True along the last axis, -1 without one."""
    last = found.shape[-1] - 1 - found[..., ::-1].argmax(axis=-1)
    return np.where(found.any(axis=-1), last, -1)


def _golden_maximum(merit, low, high):
    """Position of the single maximum of ``merit`` between low and high, elementwise; one evaluation a step."""
    left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_left, at_right = merit(left), merit(right)
    for _ in range(_GOLDEN_STEPS):
        go_left = at_left > at_right
        low, high = np.where(go_left, low, left), np.where(go_left, right, high)
        new = np.where(go_left, high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        at_new = merit(new)
        left, right = np.where(go_left, new, right), np.where(go_left, left, new)
        at_left, at_right = np.where(go_left, at_new, at_right), np.where(go_left, at_left, at_new)
    return (low + high) / 2


def _check_reach(machine, current):
    if np.max(current) > machine.reach * (1 + VOLTAGE_SLACK):
        raise FluxMapMachineError(
            f"the current limit of {np.max(current):.4g} A leaves the map, which reaches {machine.reach:.4g} A: "
            "solve a larger map"
        )


def _check_edge(machine, limits, i_d):
    edge = machine.i_d[-1]
    if limits.current_peak > edge and np.any(edge - i_d < _ON_EDGE * (edge - machine.i_d[0])):
        raise FluxMapMachineError(
            f"the best current lies on the edge of the map at i_d = {edge:.4g} A: solve a larger map"
        )
