"""The current that goes round a closed delta, driven by the EMF that its three phases share.

Round the triangle R i_0 + d/dt (psi_0 + L_0 i_0) = 0 holds for each harmonic n = 3, 9, 15 ... of psi_0 by itself:

    I_0n = n w |psi_0n| / |R + j n w L_0|,      P = 3/2 R sum I_0n^2        (peak values, w electrical)

Per turn and metre it is the same for every winding with the same copper: neither turns nor paths change it.
Left out: what i_0 does to the saturation and to the iron, and the end windings in L_0, so that the loss is rather too
large. Source: standard textbook formula; psi_0 and L_0 of the field, ``magnetostatics.zero_sequence``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from electrical.dq import Values
from labelled import xr


@dataclass(frozen=True, eq=False)
class ZeroSequence:
    """Of one turn and one metre.

    orders: of the harmonics, dimensionless (m,); direct (D,), quadrature (Q,): peak ampere-turns of a coil [A]
    linkage: amplitudes of psi_0 [Wb/m], (m, D, Q); inductance: L_0 [H/m]
    """

    orders: np.ndarray
    direct: np.ndarray
    quadrature: np.ndarray
    linkage: np.ndarray
    inductance: float

    @classmethod
    def from_per_turn(cls, data: xr.Dataset) -> ZeroSequence:
        """Of a flux map per turn and metre, with psi_0 over order, id, iq and l_0."""
        table = data["psi_0"].transpose("order", "id", "iq")
        orders, direct, quadrature = (data[name].values for name in ("order", "id", "iq"))
        return cls(orders, direct, quadrature, table.values, float(data["l_0"]))

    def loss(self, direct: Values, quadrature: Values, speed: Values, resistance: Values) -> np.ndarray:
        """P [W/m] in all three phases, of the shape of the arguments, which broadcast; NaN outside the map.

        direct, quadrature: peak ampere-turns of a coil [A]; speed: electrical [rad/s]; resistance: of a phase of one
        turn and one metre [ohm/m]
        """
        direct, quadrature, speed = np.broadcast_arrays(*(np.asarray(v, float) for v in (direct, quadrature, speed)))
        rate, resistance = self.orders * speed[..., None], np.asarray(resistance)[..., None]
        square = np.square(rate * self._linkage_at(direct, quadrature)) / (
            resistance**2 + (rate * self.inductance) ** 2
        )
        return np.asarray(1.5 * np.sum(resistance * square, axis=-1))

    def _linkage_at(self, direct: np.ndarray, quadrature: np.ndarray) -> np.ndarray:
        """Amplitudes [Wb/m], (..., m), linear between the currents of the map."""
        tables, axes = np.moveaxis(self.linkage, 0, -1), (self.direct, self.quadrature)
        at = RegularGridInterpolator(axes, tables, bounds_error=False, fill_value=np.nan)
        return np.asarray(at(np.stack([direct, quadrature], axis=-1))).reshape(*direct.shape, len(self.orders))
