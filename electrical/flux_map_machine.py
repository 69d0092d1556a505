"""A synchronous machine handed over as a flux map: saturation and cross-saturation in, the same questions out.

Rotor frame, amplitude-invariant: currents, voltages and flux linkages are peak phase values. Motor signs.

    (i_d, i_q) -> psi_d, psi_q      a bicubic spline each, twice continuously differentiable
    T   = 1.5 p (psi_d i_q - psi_q i_d)
    v_d = R i_d - omega_e psi_q,    v_q = R i_q + omega_e psi_d

Steady state and mean over the rotor angle: no ripple, no iron loss. ``SynchronousMachine`` is the same machine with
constant parameters; what a current and a voltage limit leave of either is in ``electrical.dq``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from electrical.bicubic import Bicubics
from electrical.dq import LIMIT_SLACK, Values, torque_of, voltage_of
from electrical.newton import damped_newton
from electrical.synchronous_machine import SynchronousMachine
from labelled import xr

_FEWEST = 4  # points along an axis that a cubic spline needs
_CHECKED_PER_CELL = 4  # where the Jacobian is looked at, points along each side of a cell
_OUTSIDE = 1e-9  # relative to the span of the map; a current this far beyond its edge counts as on it
_INVERSE_TOLERANCE = 1e-13  # of the flux linkage, relative to the largest in the map
_ON_EDGE = 1e-6  # relative to the width of the map


class FluxMapMachineError(ValueError):
    """A flux map that does not describe a machine, or a current or flux linkage outside it; the message says which."""


@dataclass(frozen=True, eq=False)
class FluxMapMachine:
    """Machine described by its flux linkages over a rectangular grid of currents, a ``DqMachine``.

    pole_pairs: p
    i_d (n,), i_q (m,): peak phase currents, increasing, four or more each [A]
    psi_d, psi_q (n, m): peak flux linkages of one phase [Wb]
    resistance: one phase R [ohm], may be zero; an array of several windings is a family

    Between the currents of a map of ``magnetostatics.flux_map_stage`` the splines leave the best current angle off by
    up to 0.2 degrees, now this way and now that; the optimum is so flat that this costs 3e-5 of the torque. The torque
    itself is off by up to 0.5 % at a fifth of the largest current, 0.02 % at the largest (V magnets in one and two
    layers, flux barriers; against three times as many currents along each axis).

    Raises FluxMapMachineError when the spline through the points is not strictly monotone, that is when the symmetric
    part of its incremental inductances is not positive definite somewhere: only then is the inverse unique everywhere.
    Currents outside the grid are refused, not extrapolated.
    """

    pole_pairs: int
    i_d: np.ndarray
    i_q: np.ndarray
    psi_d: np.ndarray
    psi_q: np.ndarray
    resistance: Values

    def __post_init__(self) -> None:
        _check_axis("i_d", self.i_d)
        _check_axis("i_q", self.i_q)
        for name in ("psi_d", "psi_q"):
            _check_table(name, getattr(self, name), (len(self.i_d), len(self.i_q)))
        if self.pole_pairs < 1 or np.any(np.asarray(self.resistance) < 0):
            raise FluxMapMachineError(
                "a machine has a pole pair or more and no negative resistance; "
                f"found {self.pole_pairs}, {self.resistance}"
            )
        self._check_monotone()

    @classmethod
    def from_per_turn(
        cls, data: xr.Dataset, *, turns: float, active_length: float, resistance: Values
    ) -> FluxMapMachine:
        """The machine with a winding: i = NI / N_t, psi = N_t l psi_1, mean over the rotor angle.

        data: map per turn and metre with the variables psi_d, psi_q over angle, id, iq (an ``xarray.Dataset`` of
            ``magnetostatics.flux_map``), the angles evenly spaced over one period
        turns: N_t of one coil; active_length: l [m]; resistance: of one phase [ohm]
        """
        mean = data[["psi_d", "psi_q"]].mean("angle").transpose("id", "iq")
        scale = turns * active_length
        return cls(
            pole_pairs=int(data.attrs["pole_pairs"]),
            i_d=data["id"].values / turns,
            i_q=data["iq"].values / turns,
            psi_d=scale * mean["psi_d"].values,
            psi_q=scale * mean["psi_q"].values,
            resistance=resistance,
        )

    # ---- current to flux linkage --------------------------------------------------------------------------------

    def __call__(self, i_d: Values, i_q: Values) -> tuple[Values, Values, Values]:
        """(psi_d, psi_q, torque) [Wb, Wb, Nm] at peak phase currents [A]; arrays broadcast."""
        psi = self.flux_linkage(i_d, i_q)
        return *psi, torque_of(self.pole_pairs, psi, i_d, i_q)

    def flux_linkage(self, i_d: Values, i_q: Values) -> tuple[Values, Values]:
        """(psi_d, psi_q) [Wb] at peak phase currents [A]."""
        self._check_inside(i_d, i_q)
        psi_d, psi_q = self._psi(i_d, i_q)
        return psi_d[()], psi_q[()]

    def torque(self, i_d: Values, i_q: Values) -> Values:
        """T = 1.5 p (psi_d i_q - psi_q i_d) [Nm]."""
        return self(i_d, i_q)[2]

    def voltage(self, i_d: Values, i_q: Values, speed: Values) -> tuple[Values, Values]:
        """(v_d, v_q) in the steady state [V peak phase] at mechanical speed [rad/s]."""
        return voltage_of(self.resistance, self.flux_linkage(i_d, i_q), i_d, i_q, self.pole_pairs * speed)

    def incremental_inductances(self, i_d: Values, i_q: Values) -> np.ndarray:
        """d(psi_d, psi_q) / d(i_d, i_q) (2, 2, ...) [H].

        Reciprocity (L_dq = L_qd) holds for the map itself and for the two splines as far as they follow it.
        """
        self._check_inside(i_d, i_q)
        return self._psi.slopes(i_d, i_q)

    def apparent_inductances(self, i_d: Values, i_q: Values) -> tuple[Values, Values]:
        """((psi_d(i_d, i_q) - psi_d(0, i_q)) / i_d, psi_q / i_q) [H]; currents of zero are refused.

        On the axes these are the usual apparent inductances; elsewhere cross-saturation of the magnet flux is left in
        psi_d(0, i_q).
        """
        if np.any(np.asarray(i_d) == 0) or np.any(np.asarray(i_q) == 0):
            raise FluxMapMachineError("no apparent inductance at zero current: take the incremental one there")
        psi_d, psi_q = self.flux_linkage(i_d, i_q)
        return (psi_d - self.flux_linkage(np.zeros_like(i_d, dtype=float), i_q)[0]) / i_d, psi_q / i_q

    # ---- flux linkage to current --------------------------------------------------------------------------------

    def currents(self, psi_d: Values, psi_q: Values) -> tuple[Values, Values]:
        """(i_d, i_q) [A] at flux linkages [Wb]: Newton's method with the spline's derivatives, to 1e-13 of the flux.

        Raises FluxMapMachineError when a flux linkage belongs to no current of the map.
        """
        i_d, i_q, inside = self.continued_currents(psi_d, psi_q)
        if not np.all(inside):
            raise FluxMapMachineError(
                f"{np.size(inside) - np.count_nonzero(inside)} of {np.size(inside)} flux linkages need currents "
                f"outside the map, {self._extent()}: solve a larger map"
            )
        return i_d, i_q

    def continued_currents(self, psi_d: Values, psi_q: Values) -> tuple[Values, Values, np.ndarray]:
        """(i_d, i_q, inside) for any flux linkage [Wb]; ``inside`` tells which belong to the map.

        Beyond its edge the map is continued along straight lines with its smallest incremental inductance, which keeps
        it monotone. Meant for the corners of look-up tables, which no drive within the limits visits.
        """
        psi_d, psi_q = np.broadcast_arrays(np.asarray(psi_d, dtype=float), np.asarray(psi_q, dtype=float))
        i = self._nearest(psi_d.ravel(), psi_q.ravel())
        i = self._newton(np.stack([psi_d.ravel(), psi_q.ravel()]), i).reshape(2, *psi_d.shape)
        inside = self.holds(*i)
        return *np.where(inside, self._clip(i), i), inside

    def holds(self, i_d: Values, i_q: Values) -> np.ndarray:
        """Whether currents [A] lie in the map."""
        i = np.stack([np.asarray(i_d, dtype=float), np.asarray(i_q, dtype=float)])
        return np.all(np.abs(i - self._clip(i)) <= self._slack(i), axis=0)

    def continued_flux_linkage(self, i: np.ndarray) -> np.ndarray:
        """(psi_d, psi_q) [Wb] (2, k), beyond the edge along the straight lines; i: any i_d, i_q [A] (2, k)."""
        return -self._miss(i, np.zeros_like(i))

    def continued_inductances(self, i: np.ndarray) -> np.ndarray:
        """Slopes of the same [H] (2, 2, k); i: any i_d, i_q [A] (2, k)."""
        return self._continued_jacobian(i)

    # ---- the constant-parameter machine -------------------------------------------------------------------------

    def constant_parameters(self, current: float) -> SynchronousMachine:
        """No-load flux linkage, and apparent inductances at a current [A] on the negative d axis and on the q axis."""
        psi_m = float(self.flux_linkage(0.0, 0.0)[0])
        inductance_d = (psi_m - float(self.flux_linkage(-current, 0.0)[0])) / current
        inductance_q = float(self.flux_linkage(0.0, current)[1]) / current
        return SynchronousMachine(self.pole_pairs, psi_m, inductance_d, inductance_q, self.resistance)

    @property
    def reach(self) -> float:
        """Largest peak current of which a whole motoring quarter lies in the map [A]: 0 <= i_q and i_d <= 0, or
        0 <= i_d where the map has no other, as that of a machine without magnets."""
        return float(min(max(-self.i_d[0], self.i_d[-1]), self.i_q[-1]))

    def direct_range(self, current: Values) -> tuple[Values, Values]:
        """Range of i_d [A] inside a current [A] and inside the map.

        Raises FluxMapMachineError where the motoring quarter of the current leaves the map.
        """
        if np.max(current) > self.reach * (1 + LIMIT_SLACK):
            raise FluxMapMachineError(
                f"the current limit of {np.max(current):.4g} A leaves the map, which reaches {self.reach:.4g} A: "
                "solve a larger map"
            )
        return np.maximum(-np.asarray(current, dtype=float), self.i_d[0])[()], np.minimum(current, self.i_d[-1])

    def with_resistance(self, resistance: Values) -> FluxMapMachine:
        """The same machine with another resistance of one phase [ohm]; an array makes it a family."""
        return replace(self, resistance=resistance)

    def check_best(self, i_d: Values, current: Values) -> None:
        """Raises FluxMapMachineError where a best i_d [A] lies on the edge of the map at positive i_d."""
        edge = self.i_d[-1]
        near = edge - np.asarray(i_d) < _ON_EDGE * (edge - self.i_d[0])
        if np.any(near & (np.asarray(current) > edge)):
            raise FluxMapMachineError(
                f"the best current lies on the edge of the map at i_d = {edge:.4g} A: solve a larger map"
            )

    # ---- splines ------------------------------------------------------------------------------------------------

    @cached_property
    def _psi(self) -> Bicubics:
        return Bicubics.through(self.i_d, self.i_q, (self.psi_d, self.psi_q))

    @cached_property
    def _box(self) -> np.ndarray:
        """Lower and upper end of i_d and i_q (2, 2): [[d low, q low], [d high, q high]]."""
        return np.array([[self.i_d[0], self.i_q[0]], [self.i_d[-1], self.i_q[-1]]])

    def _clip(self, i: np.ndarray) -> np.ndarray:
        low, high = self._box.reshape(2, 2, *[1] * (i.ndim - 1))
        return np.clip(i, low, high)

    def _slack(self, i: np.ndarray) -> np.ndarray:
        return _OUTSIDE * (self._box[1] - self._box[0]).reshape(2, *[1] * (i.ndim - 1))

    def _check_inside(self, *currents: Values) -> None:
        for current, low, high in zip(currents, *self._box):
            slack = _OUTSIDE * (high - low)
            least, most = (end.reduce(current, axis=None, initial=low) for end in (np.fmin, np.fmax))  # NaN passes
            if least < low - slack or most > high + slack:
                raise FluxMapMachineError(f"a current lies outside the map, {self._extent()}: solve a larger map")

    def _extent(self) -> str:
        return f"i_d {self.i_d[0]:.4g} to {self.i_d[-1]:.4g} A, i_q {self.i_q[0]:.4g} to {self.i_q[-1]:.4g} A"

    @cached_property
    def _fine_jacobian(self) -> np.ndarray:
        return self._psi.slopes(*np.meshgrid(_refined(self.i_d), _refined(self.i_q), indexing="ij"))

    def _check_monotone(self) -> None:
        (dd, dq), (qd, qq) = self._fine_jacobian
        definite = (dd > 0) & (dd * qq > ((dq + qd) / 2) ** 2)
        if not definite.all():
            row, column = np.argwhere(~definite)[0]
            raise FluxMapMachineError(
                f"the map is not monotone near i_d = {_refined(self.i_d)[row]:.4g} A, "
                f"i_q = {_refined(self.i_q)[column]:.4g} A: "
                "check the order of the axes and the signs, or solve a finer grid to a tighter tolerance"
            )

    # ---- inverse ------------------------------------------------------------------------------------------------

    @cached_property
    def _edge_inductance(self) -> np.ndarray:
        """Slope (2,) with which the map goes on beyond its edge [H]."""
        return np.array([self._fine_jacobian[0, 0].min(), self._fine_jacobian[1, 1].min()])

    def _nearest(self, psi_d: np.ndarray, psi_q: np.ndarray) -> np.ndarray:
        """Grid currents (2, k) whose flux linkages are closest."""
        distance = (self.psi_d.ravel()[:, None] - psi_d) ** 2 + (self.psi_q.ravel()[:, None] - psi_q) ** 2
        row, column = np.unravel_index(distance.argmin(axis=0), self.psi_d.shape)
        return np.stack([self.i_d[row], self.i_q[column]])

    def _newton(self, psi: np.ndarray, i: np.ndarray) -> np.ndarray:
        """Currents (2, k) of the continued map at flux linkages psi (2, k)."""
        close = _INVERSE_TOLERANCE * np.hypot(self.psi_d, self.psi_q).max()
        i, found = damped_newton(lambda trial: self._miss(trial, psi), self._continued_jacobian, i, close)
        if not found.all():
            raise FluxMapMachineError(
                f"the inverse of the map was not found to {_INVERSE_TOLERANCE:g} for {np.count_nonzero(~found)} flux "
                "linkages: solve a finer map"
            )
        return i

    def _miss(self, i: np.ndarray, psi: np.ndarray) -> np.ndarray:
        inside = self._clip(i)
        beyond = self._edge_inductance[:, None] * (i - inside)
        return psi - self._psi(*inside) - beyond

    def _continued_jacobian(self, i: np.ndarray) -> np.ndarray:
        inside = self._clip(i)
        edge = np.diag(self._edge_inductance)[:, :, None]
        return np.where((i != inside)[None], edge, self._psi.slopes(*inside))


def _check_axis(name: str, values: np.ndarray) -> None:
    if np.ndim(values) != 1 or len(values) < _FEWEST or np.any(np.diff(values) <= 0):
        raise FluxMapMachineError(
            f"{name} must be {_FEWEST} increasing currents or more; found shape {np.shape(values)}"
        )
    if not values[0] <= 0 <= values[-1]:
        raise FluxMapMachineError(f"{name} must reach zero; found {values[0]:.4g} to {values[-1]:.4g} A")


def _check_table(name: str, values: np.ndarray, shape: tuple[int, int]) -> None:
    if np.shape(values) != shape or not np.all(np.isfinite(values)):
        raise FluxMapMachineError(
            f"{name} must be finite with one value per (i_d, i_q), {shape}; found {np.shape(values)}"
        )


def _refined(axis: np.ndarray) -> np.ndarray:
    """The axis with every interval divided."""
    count = _CHECKED_PER_CELL * (len(axis) - 1) + 1
    return np.interp(np.linspace(0, len(axis) - 1, count), np.arange(len(axis)), axis)
