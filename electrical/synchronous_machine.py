"""A synchronous machine with constant parameters.

    psi_d = L_d i_d + psi_m,   psi_q = L_q i_q
    T = 1.5 p i_q (psi_m + (L_d - L_q) i_d)

Frame, signs and what follows under limits: ``electrical.dq``. Saturation is left out, and with iron and mechanical loss
it makes deep field weakening optimistic: 16 % more power than the thesis's FluxMotor run gives.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

import numpy as np

from electrical.dq import Values, require, torque_of, voltage_of

_TURNING = 1 - 1e-9  # of the direct current at which the torque of a salient machine changes its sign


@dataclass(frozen=True)
class SynchronousMachine:
    """Constant-parameter permanent-magnet synchronous machine, a ``DqMachine``.

    pole_pairs: p
    psi_m: magnet flux linkage, peak of one phase [Wb]
    inductance_d, inductance_q: phase inductances L_d, L_q [H], may differ either way
    resistance: one phase R [ohm], may be zero

    Every field but ``pole_pairs`` may be an array that broadcasts against the speeds: a family of machines.
    Raises ValueError for parameters that no machine has.
    """

    pole_pairs: int
    psi_m: Values
    inductance_d: Values
    inductance_q: Values
    resistance: Values

    def __post_init__(self) -> None:
        require(self.pole_pairs > 0, "pole pairs must be positive", self.pole_pairs)
        require(bool(np.all(np.asarray(self.psi_m) > 0)), "magnet flux linkage must be positive", self.psi_m)
        require(bool(np.all(np.asarray(self.inductance_d) > 0)), "L_d must be positive", self.inductance_d)
        require(bool(np.all(np.asarray(self.inductance_q) > 0)), "L_q must be positive", self.inductance_q)
        require(bool(np.all(np.asarray(self.resistance) >= 0)), "resistance must not be negative", self.resistance)

    @property
    def saliency(self) -> Values:
        """L_d - L_q [H]; negative for the usual buried magnet, zero for a magnet on a round rotor."""
        return self.inductance_d - self.inductance_q

    @property
    def torque_constant(self) -> Values:
        """K_t = 1.5 p psi_m, torque per peak ampere on the q axis [Nm/A]."""
        return 1.5 * self.pole_pairs * self.psi_m

    @property
    def reach(self) -> float:
        """Constant parameters hold at any current [A]."""
        return inf

    def flux_linkage(self, i_d: Values, i_q: Values) -> tuple[Values, Values]:
        """(psi_d, psi_q) [Wb] at peak phase currents i_d, i_q [A]."""
        return self.psi_m + self.inductance_d * i_d, self.inductance_q * i_q

    def incremental_inductances(self, i_d: Values, i_q: Values) -> np.ndarray:
        """d(psi_d, psi_q) / d(i_d, i_q) (2, 2, ...) [H]: L_d and L_q on the diagonal."""
        shape = np.broadcast_shapes(np.shape(i_d), np.shape(i_q), np.shape(self.inductance_d))
        slopes = np.zeros((2, 2, *shape))
        slopes[0, 0], slopes[1, 1] = self.inductance_d, self.inductance_q
        return slopes

    def torque(self, i_d: Values, i_q: Values) -> Values:
        """T = 1.5 p (psi_d i_q - psi_q i_d) [Nm]."""
        return torque_of(self.pole_pairs, self.flux_linkage(i_d, i_q), i_d, i_q)

    def voltage(self, i_d: Values, i_q: Values, speed: Values) -> tuple[Values, Values]:
        """(v_d, v_q) in the steady state [V peak phase] at mechanical speed [rad/s]."""
        return voltage_of(self.resistance, self.flux_linkage(i_d, i_q), i_d, i_q, self.pole_pairs * speed)

    def direct_range(self, current: Values) -> tuple[Values, Values]:
        """Range of i_d [A] inside a current [A] in which psi_m + (L_d - L_q) i_d stays positive."""
        shape = np.broadcast_shapes(np.shape(self.psi_m), np.shape(self.inductance_d), np.shape(current))
        reach = np.broadcast_to(np.asarray(current, dtype=float), shape)
        d_l = np.broadcast_to(np.asarray(self.saliency, dtype=float), shape)
        with np.errstate(divide="ignore"):
            turning = _TURNING * self.psi_m / np.abs(d_l)
        low = np.where(d_l > 0, np.maximum(-reach, -turning), -reach)
        return low[()], np.where(d_l < 0, np.minimum(reach, turning), reach)[()]

    def with_resistance(self, resistance: Values) -> SynchronousMachine:
        """The same machine with another resistance of one phase [ohm]; an array makes it a family."""
        return replace(self, resistance=resistance)

    def check_best(self, i_d: Values, current: Values) -> None:
        """Constant parameters end nowhere."""
