"""The first swing of the current when the phases of a turning machine are shorted at once.

In the rotor frame, with theta = omega_e t and no voltage,

    dpsi_d/dtheta = psi_q - R i_d / omega_e,   dpsi_q/dtheta = -psi_d - R i_q / omega_e

Without resistance the flux linkage stands still in the stator, so that it turns backwards before the rotor: half a turn
later it lies against the magnets with the size it had, and with a constant L_d

    i_d = -(psi_m + |psi_0|) / L_d,   |psi_0|^2 = (psi_m + L_d i_d0)^2 + (L_q i_q0)^2      (standard textbook estimate)

twice the steady current from no load on. The resistance makes it less; that and the saturation are followed here. The
speed is constant, and dampers are left out (magnets and sheet have none that count).
"""

from __future__ import annotations

import numpy as np
import scipy

from electrical.flux_map_machine import FluxMapMachine

_STEPS = 361  # over one electrical turn, from which the peak is taken: half a degree beside it costs 4e-5
_TOLERANCE = 1e-7  # relative, of the currents


def first_peak(machine: FluxMapMachine, speed: float, i_d: float, i_q: float) -> tuple[float, float]:
    """(i_d, i_q) [A] where i_d is smallest within an electrical turn after the short circuit.

    speed: mechanical [rad/s], positive; i_d, i_q: before it, peak [A]. Beyond the edge of the map it goes on with its
    smallest incremental inductance, so that the peak is too large there rather than too small.
    """
    drag = float(machine.resistance) / (machine.pole_pairs * speed)

    def rate(_: float, i: np.ndarray) -> np.ndarray:
        (psi_d,), (psi_q,) = machine.continued_flux_linkage(i[:, None])
        return np.linalg.solve(
            machine.continued_inductances(i[:, None])[:, :, 0], [psi_q - drag * i[0], -psi_d - drag * i[1]]
        )

    size = float(np.hypot(i_d, i_q)) + machine.reach
    turn = np.linspace(0.0, 2 * np.pi, _STEPS)
    tolerances = {"rtol": _TOLERANCE, "atol": _TOLERANCE * size}
    found = scipy.integrate.solve_ivp(rate, (0.0, turn[-1]), [i_d, i_q], t_eval=turn, **tolerances)
    worst = int(np.argmin(found.y[0]))
    return float(found.y[0, worst]), float(found.y[1, worst])
