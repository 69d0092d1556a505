"""The gap around a salient rotor of iron without end, solved exactly by matching modes.

The rotor is round, of infinite permeability, with openings of radial sides at R_o > r > R_1, 2 alpha wide, one a pole,
filled with magnets of remanence +-B_r along their middle psi = 0 and of relative permeability mu_r. Outside A = 0 on a
circle R_a, and between currents at radii s > R_o. In an opening and in the gap

    A = +-B_r r sin psi + m + sum_n e_n cos(l_n (psi + alpha)) [(r/R_o)^l_n + (R_1/R_o)^l_n (R_1/r)^l_n],
        l_n = n pi/(2 alpha), so that H is along the normal on all three sides
    A = Re sum_k [g_k f_k(r) + s_k r^k] exp(j k phi),   f_k = (R_o/r)^k - (R_o/R_a)^k (r/R_a)^k
        s_k = mu_0/(2 pi k) integral of J (s^-k - s^k R_a^-2k) exp(-j k phi) dS, at radii s outside of r

A is continuous over each opening (projected on its cosines) and H_phi over the whole circle R_o, being zero on iron
(projected on exp(j k phi)); the g_k are eliminated, the e_n of all openings solved for. B_r along psi = 0 is what makes
the first term a magnet without H of its own: the openings are those of parallel magnetisation.

Source: derived here; the method is that of Lubin, Mezani, Rezzoug, "Exact analytical method for magnetic field
computation in the air gap of cylindrical electrical machines considering slotting effects", IEEE Trans. Magn. 46, 2010.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from units import MU_0


@dataclass(frozen=True)
class SalientRotor:
    """inner, rim: R_1, R_o [m]; half: alpha [rad]; remanence [T]; openings alternate in the sense of their magnets"""

    poles: int
    inner: float
    rim: float
    half: float
    remanence: float
    permeability: float = 1.0


@dataclass(frozen=True, eq=False)
class SalientField:
    """Orders k (K,), and their g_k and s_k of the potential in the gap [Wb/m]; s_k over r^k."""

    rim: float
    outer: float
    orders: np.ndarray
    own: np.ndarray
    currents: np.ndarray

    def potential(self, r):
        """a_k [Wb/m] (K,) and its slope over r [T]."""
        k, falling, rising = self.orders, (self.rim / r) ** self.orders, (r / self.outer) ** self.orders
        back = (self.rim / self.outer) ** k * rising
        given = self.currents * (r / self.rim) ** k
        return self.own * (falling - back) + given, (-self.own * k * (falling + back) + k * given) / r

    def torque(self, r):
        """On the rotor [Nm/m]: pi r^2/mu_0 sum of Re(B_r conj B_phi)."""
        a, slope = self.potential(r)
        return -pi * r**2 / MU_0 * float((1j * self.orders * a / r * np.conj(slope)).real.sum())


def solve_salient(rotor: SalientRotor, outer: float, angle: float, currents: np.ndarray, modes: int) -> SalientField:
    """The field with the rotor turned by an angle [rad].

    outer: R_a [m]; currents: s_k R_o^k [Wb/m] of the orders 1, 2 ... (K,); modes: cosines of an opening
    """
    k, n, mu = np.arange(1, len(currents) + 1), np.arange(1, modes + 1), rotor.permeability
    power = n * pi / (2 * rotor.half)
    fall = (rotor.inner / rotor.rim) ** (2 * power)
    value, slope = 1 + fall, power * (1 - fall)  # of a cosine on the rim, the slope times R_o
    back = (rotor.rim / outer) ** (2 * k)
    ratio = -(1 - back) / (k * (1 + back))  # f_k over R_o f_k'
    waves = _waves(rotor, angle, k, n)  # (openings, K, modes)
    flat = np.moveaxis(waves, 1, 0).reshape(len(k), -1)
    given = currents - ratio * k * currents  # in the gap on the rim, where iron is everywhere
    slopes = np.tile(slope, rotor.poles)
    answer = (np.conj(flat).T @ (flat * (ratio / (mu * pi))[:, None])).real * slopes
    matrix = np.diag(np.tile(rotor.half * value, rotor.poles)) - answer
    right = (np.conj(flat).T @ given).real - _of_magnets(rotor, power)
    e = np.linalg.solve(matrix, right)
    own = (flat @ (slopes * e) / (mu * pi) - k * currents) / (-k * (1 + back))
    return SalientField(rotor.rim, outer, k, own, currents)


def _waves(rotor, angle, k, n):
    """Integral over each opening of cos(l_n (psi + alpha)) exp(-j k phi) (openings, K, modes)."""
    a, (k, n) = rotor.half, np.meshgrid(k, n, indexing="ij")
    power = n * pi / (2 * a)
    one = [np.exp(1j * s * power * a) * a * np.sinc((s * power - k) * a / pi) for s in (1, -1)]
    middles = angle + 2 * pi / rotor.poles * np.arange(rotor.poles)
    return np.exp(-1j * k * middles[:, None, None]) * (one[0] + one[1])


def _of_magnets(rotor, power):
    """+-B_r R_o times the integral of cos(l_n (psi + alpha)) sin psi (openings * modes,)."""
    a = rotor.half
    wave = [np.exp(1j * power * a) * a * np.sinc((power + s) * a / pi) * s for s in (1, -1)]
    integral = ((wave[0] + wave[1]) / 1j).real
    signs = (-1.0) ** np.arange(rotor.poles)
    return np.outer(signs, rotor.remanence * rotor.rim * integral).ravel()
