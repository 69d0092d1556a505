"""A slotless ring of concentric layers solved exactly by separation of variables.

With A = Re sum_k a_k(r) exp(j k phi), and in every layer a remanence (R_k, T_k: radial, tangential) and a current
density J_k that do not depend on the radius,

    a'' + a'/r - k^2 a/r^2 = -(T_k - j k R_k)/r - mu J_k
    a = c_1 (r/r_o)^k + c_2 (r_i/r)^k + (T_k - j k R_k) r/(k^2 - 1) + mu J_k r^2/(k^2 - 4)
    B_r = j k a/r,   B_phi = -a',   H_phi = nu (B_phi - T_k)

a and H_phi are continuous from layer to layer, but for a current sheet K_k by which H_phi rises on the way outwards;
H_phi = 0 on the innermost circle, where the iron ends, and a = 0 on the outermost. Valid for k > 2.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from units import MU_0


@dataclass(frozen=True)
class Layer:
    """Annulus r_i..r_o [m] of relative permeability mu_r with remanence [T] and current density [A/m^2] of one order k.

    sheet: current density [A/m] on its outer circle
    """

    inner: float
    outer: float
    permeability: float = 1.0
    radial: complex = 0.0
    tangential: complex = 0.0
    current: complex = 0.0
    sheet: complex = 0.0

    @property
    def nu(self) -> float:
        return 1 / (MU_0 * self.permeability)

    def powers(self, k, r):
        """The two solutions without sources at radius r, and their derivatives."""
        rising, falling = (r / self.outer) ** k, (self.inner / r) ** k
        return np.array([rising, falling]), np.array([k * rising, -k * falling]) / r

    def particular(self, k, r):
        """(a, a') that the sources inside the layer ask for."""
        magnet = (self.tangential - 1j * k * self.radial) / (k**2 - 1)
        current = self.current / self.nu / (k**2 - 4)
        return magnet * r + current * r**2, magnet + 2 * current * r

    def tangential_field(self, derivative):
        """H_phi [A/m] from a'."""
        return -self.nu * (derivative + self.tangential)


@dataclass(frozen=True)
class LayeredField:
    """Field of one order k: coefficients (layers, 2)."""

    order: int
    layers: tuple[Layer, ...]
    coefficients: np.ndarray

    def layer_at(self, r):
        return next(i for i, layer in enumerate(self.layers) if r <= layer.outer * (1 + 1e-12))

    def potential(self, r):
        """a_k(r) [Wb/m]."""
        i = self.layer_at(r)
        powers, _ = self.layers[i].powers(self.order, r)
        return powers @ self.coefficients[i] + self.layers[i].particular(self.order, r)[0]

    def radial(self, r):
        """B_r,k(r) [T]."""
        return 1j * self.order * self.potential(r) / r

    def tangential(self, r):
        """B_phi,k(r) [T]."""
        i = self.layer_at(r)
        _, slopes = self.layers[i].powers(self.order, r)
        return -(slopes @ self.coefficients[i] + self.layers[i].particular(self.order, r)[1])

    def ring_mean(self, function, inner, outer, points=8):
        """Mean of function(r) over the area of an annulus inside one layer."""
        nodes, weights = np.polynomial.legendre.leggauss(points)
        radii = inner + (outer - inner) * (nodes + 1) / 2
        return sum(w * r * function(r) for w, r in zip(weights, radii)) / sum(w * r for w, r in zip(weights, radii))

    def torque(self, r):
        """Torque per metre on what lies inside radius r in the air [Nm/m]: r^2/mu_0 times the integral of B_r B_phi."""
        return pi * r**2 / MU_0 * (self.radial(r) * np.conj(self.tangential(r))).real


def solve_layers(order: int, layers) -> LayeredField:
    """Coefficients of one order from the conditions between the layers and at both ends."""
    layers, count = tuple(layers), len(layers)
    matrix, right = np.zeros((2 * count, 2 * count), complex), np.zeros(2 * count, complex)
    first, last = layers[0], layers[-1]
    _, slopes = first.powers(order, first.inner)
    matrix[0, :2] = -first.nu * slopes
    right[0] = -first.tangential_field(first.particular(order, first.inner)[1])
    for i, (below, above) in enumerate(zip(layers, layers[1:])):
        r, columns = below.outer, slice(2 * i, 2 * i + 4)
        (p, dp), (q, dq) = below.powers(order, r), above.powers(order, r)
        (a, da), (b, db) = below.particular(order, r), above.particular(order, r)
        matrix[2 * i + 1, columns] = np.concatenate([p, -q])
        right[2 * i + 1] = b - a
        matrix[2 * i + 2, columns] = np.concatenate([-below.nu * dp, above.nu * dq])
        right[2 * i + 2] = above.tangential_field(db) - below.tangential_field(da) - below.sheet
    matrix[-1, -2:] = last.powers(order, last.outer)[0]
    right[-1] = -last.particular(order, last.outer)[0]
    return LayeredField(order, layers, np.linalg.solve(matrix, right).reshape(-1, 2))


def magnet_harmonic(order: int, pole_pairs: int, remanence: float, arc_fraction: float, turn: float):
    """(R_k, T_k) [T] of alternating magnets, magnet 0 centred on phi = 0. Their direction falls behind the radius by
    turn times the angle from their middle: 0 radial, 1 parallel, p Halbach with the gap outside, -p inside.

    R + j T = B exp(-j turn phi) over an arc,    R_k = 2 p B/pi (s(k - turn) + s(k + turn)),    s(n) = sin(n h)/n
    """
    if (order // pole_pairs) % 2 == 0 or order % pole_pairs:
        return 0.0, 0.0
    half = arc_fraction * pi / (2 * pole_pairs)
    below, above = (half * np.sinc(n * half / pi) for n in (order - turn, order + turn))
    scale = 2 * pole_pairs / pi * remanence
    return scale * (below + above), 1j * scale * (below - above)


def zhu_howe_radial(order, pole_pairs, remanence, arc_fraction, turn, permeability, core, magnet, bore, r):
    """B_r,k(r) [T] between smooth iron of infinite permeability, internal rotor, order k = n p > 1.

    core, magnet, bore: radii R_r, R_m, R_s [m]
    Source: Zhu, Howe, Bolte, Ackermann, "Instantaneous magnetic field distribution in brushless permanent magnet DC
    motors, part I", IEEE Trans. Magn. 29 (1993), eqs 12-22; mu_r M_n is here (R_k + k T_k) / mu_0.
    """
    radial, tangential = magnet_harmonic(order, pole_pairs, remanence, arc_fraction, turn)
    tangential = (1j * tangential).real  # amplitude of sin(k phi)
    total = radial + order * tangential
    k, mu = order, permeability
    of_a3 = (k - 1 / k) * radial + total / k  # their A_3 times the total, which may be zero
    inner, outer, both = core / magnet, magnet / bore, core / bore
    above = (of_a3 - total) + 2 * total * inner ** (k + 1) - (of_a3 + total) * inner ** (2 * k)
    below = (mu + 1) / mu * (1 - both ** (2 * k)) - (mu - 1) / mu * (outer ** (2 * k) - inner ** (2 * k))
    shape = (r / bore) ** (k - 1) * outer ** (k + 1) + (magnet / r) ** (k + 1)
    return k / (k**2 - 1) / mu * above / below * shape
