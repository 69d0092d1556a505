"""Which currents an inverter chooses for a torque: the smallest that its voltage allows.

    without a limit    min |i|  on T(i_d, i_q) = T*:             T_d i_q - T_q i_d = 0      (maximum torque per ampere)
    with one           |v| <= k v_dc, k = ``voltage_per_dc``: where the first asks for more, the currents on T = T*
                       between it and the lowest voltage at which |v| = k v_dc              (field weakening)
    beyond             where even the lowest voltage that gives the torque is above the limit, that voltage: the
                       inverter overmodulates                                               (maximum torque per volt)

|i| is of the magnetising currents, which differ from those at the terminals by the small current of the iron loss.
A real inverter takes its currents from a table of its own machine; what that costs is not in here.
"""

from __future__ import annotations

import numpy as np

from workbench.models.dq.operation import Currents, Operation, newton

HALVINGS = 50  # of the currents between two points: to rounding
_CONTOUR_STEPS = 8  # of Newton's method for i_q at a torque, which is nearly linear in it
_START_STEPS = 5  # of the closed form without saturation; a start need not be exact
_NO_TORQUE = "no currents give this torque: it is beyond what the machine as declared can do"


def least_current(operation: Operation, torque: np.ndarray) -> Currents:
    """Magnetising currents [A] of the smallest size for shaft torques [Nm] (n,)."""
    scale = operation.torque_scale

    def missing(i_d: np.ndarray, i_q: np.ndarray) -> Currents:
        t_d, t_q = operation.slopes(operation.shaft_torque, i_d, i_q)
        return operation.shaft_torque(i_d, i_q) - torque, t_d * i_q - t_q * i_d

    size = scale + np.abs(torque)
    return newton(missing, *_start(operation, torque), size, size, _NO_TORQUE)


def lowest_voltage(operation: Operation, torque: np.ndarray) -> Currents:
    """Magnetising currents [A] of the lowest terminal voltage for shaft torques [Nm] (n,), at speeds other than 0."""
    d, flux = operation.design, operation.psi_m

    def squared(i_d: np.ndarray, i_q: np.ndarray) -> np.ndarray:
        return (operation.voltage(i_d, i_q) / operation.omega) ** 2

    def missing(i_d: np.ndarray, i_q: np.ndarray) -> Currents:
        t_d, t_q = operation.slopes(operation.shaft_torque, i_d, i_q)
        v_d, v_q = operation.slopes(squared, i_d, i_q)
        return operation.shaft_torque(i_d, i_q) - torque, t_d * v_q - t_q * v_d

    i_q = torque * d.inductance_d / (1.5 * d.pole_pairs * d.inductance_q * flux)
    size = operation.torque_scale + np.abs(torque)
    shape = size * flux * d.inductance_d / operation.cancelling_current
    return newton(missing, -operation.cancelling_current, i_q, size, shape, _NO_TORQUE)


def within_voltage(operation: Operation, torque: np.ndarray, limit: np.ndarray) -> Currents:
    """Magnetising currents [A] for shaft torques [Nm] with peak phase voltages up to a limit [V], each (n,)."""
    i_d, i_q = least_current(operation, torque)
    over = np.flatnonzero(operation.voltage(i_d, i_q) > limit)
    if len(over):
        i_d, i_q = i_d.copy(), i_q.copy()
        i_d[over], i_q[over] = _weakened(operation.of(over), torque[over], limit[over], i_d[over], i_q[over])
    return i_d, i_q


def _weakened(operation: Operation, torque: np.ndarray, limit: np.ndarray, i_d: np.ndarray, i_q: np.ndarray):
    """From currents that ask for too much voltage towards those of the lowest, until the limit holds."""
    low_d, low_q = lowest_voltage(operation, torque)
    near, far = i_d, low_d
    for _ in range(HALVINGS):
        middle, i_q = (near + far) / 2, _contour(operation, torque, (near + far) / 2, i_q)
        over = operation.voltage(middle, i_q) > limit
        near, far = np.where(over, middle, near), np.where(over, far, middle)
    return far, _contour(operation, torque, far, i_q)


def _contour(operation: Operation, torque: np.ndarray, i_d: np.ndarray, i_q: np.ndarray) -> np.ndarray:
    """i_q that gives the torque with an i_d, from one nearby [A]."""
    for _ in range(_CONTOUR_STEPS):
        missing = operation.shaft_torque(i_d, i_q) - torque
        if np.abs(missing / operation.torque_scale).max() < 1e-13:
            break
        h = 1e-4 * operation.cancelling_current
        i_q = i_q - missing * h / (operation.shaft_torque(i_d, i_q + h) - torque - missing)
    return i_q


def _start(operation: Operation, torque: np.ndarray) -> Currents:
    """Least current of the machine with constant inductances, nearly."""
    d = operation.design
    saliency, i_d = d.inductance_d - d.inductance_q, np.zeros(operation.rows)
    for _ in range(_START_STEPS):
        i_q = torque / (1.5 * d.pole_pairs * (operation.psi_m + saliency * i_d))
        i_d = 2 * saliency * i_q**2 / (operation.psi_m + np.sqrt(operation.psi_m**2 + (2 * saliency * i_q) ** 2))
    return i_d, i_q
