"""The radial Maxwell stress around the air gap as waves over angle and rotor position.

    sigma(phi, theta) = sum over r, nu of A cos(r phi - nu p (theta - theta_0) + psi)

r is the spatial order, positive for a wave that turns with the rotor; nu the temporal order, in multiples of the
electrical frequency. After half an electrical period the field is its own negative and the stress the same again, so
that nu is even.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import pi, tanh

import numpy as np

from geometry.machine import Machine
from magnetostatics.model import FieldSolution
from magnetostatics.torque import gap_force_density
from units import MU_0


@dataclass(frozen=True)
class StressWave:
    """One wave of the radial stress: amplitude [Pa] of a spatial and a temporal order, signs as in the module."""

    spatial_order: int
    temporal_order: int
    amplitude: float


def radial_stress_orders(solution: FieldSolution, highest: int) -> np.ndarray:
    """Spatial Fourier coefficients of the radial stress [Pa], complex (highest + 1,).

    c_n = 1/S integral over the stator half of the gap of sigma_rr exp(-i n phi) dS
    sigma_rr = (B_r^2 - B_phi^2)/(2 mu_0), averaged over the circles of the ring of area S as in ``arkkio_torque``;
    sigma(phi) = c_0 + 2 Re sum of c_n exp(i n phi), positive where the stator pulls the rotor outwards.
    Valid where stator and sliding circle are concentric. Of a meshed sector only its multiples are not zero.
    highest: spatial order, dimensionless; take it below a quarter of the edges around the gap
    """
    section = solution.model.section
    ring, density = gap_force_density(solution)
    x, y = ring.points
    radial = section.stator_gap.depth * (density * ring.points).sum(0) / np.hypot(x, y)
    orders = np.arange(highest + 1)
    waves = np.exp(-1j * orders[:, None] * np.arctan2(y, x).ravel())
    mean = waves @ (radial * ring.weights).ravel() / ring.weights.sum()
    return np.where(orders % section.sectors == 0, mean, 0.0)


def stress_over_angle(orders: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Radial stress [Pa], (..., m), at places around the gap from its spatial coefficients.

    orders: coefficients [Pa], complex (..., n), of the orders from 0 on; angles: from the axis of tooth 0 [rad], (m,)
    """
    twice = np.full(orders.shape[-1], 2.0)
    twice[0] = 1.0
    waves = np.exp(1j * np.arange(orders.shape[-1])[:, None] * angles)
    return np.real((orders * twice) @ waves)


def stress_waves(orders: np.ndarray) -> tuple[StressWave, ...]:
    """Every wave of the stress, the largest first; the mean stress has the orders 0, 0.

    orders: coefficients [Pa], complex (positions, n), of the orders from 0 on at rotor positions that are evenly spread
        over half an electrical period, its end left out
    """
    positions = len(orders)
    over_time = np.fft.fft(orders, axis=0) / positions
    reach = (positions - 1) // 2
    waves = [
        _wave(int(n), m, complex(over_time[m % positions, n]))
        for n in range(orders.shape[1])
        for m in range(0 if n == 0 else -reach, reach + 1)
    ]
    return tuple(sorted(waves, key=lambda wave: -wave.amplitude))


def moving(waves: Iterable[StressWave]) -> tuple[StressWave, ...]:
    """Those that change in time."""
    return tuple(wave for wave in waves if wave.temporal_order)


def amplitude_of(waves: Iterable[StressWave], like: StressWave) -> float:
    """Amplitude [Pa] of the wave with the orders of another one; 0 where there is none."""
    orders = like.spatial_order, like.temporal_order
    return next((one.amplitude for one in waves if (one.spatial_order, one.temporal_order) == orders), 0.0)


def _wave(order: int, half_periods: int, coefficient: complex) -> StressWave:
    """2 |C| cos(n phi + 2 m tau): it turns against the rotor where n and m have one sign."""
    alone = order == 0 and half_periods == 0
    spatial = -order if half_periods > 0 else order
    return StressWave(spatial, 2 * abs(half_periods), abs(coefficient) * (1 if alone else 2))


def torque_orders(torque: np.ndarray, span: float, pole_pairs: int) -> dict[int, float]:
    """Amplitude of each order of a torque, relative to the magnitude of its mean; {order: share}, the largest first.

    torque: at evenly spread rotor positions, the end left out, in any unit (n,); span: that they cover [rad]
    Orders are multiples of the electrical frequency.
    """
    share = 2 * np.abs(np.fft.rfft(torque))[1:] / len(torque) / abs(float(np.mean(torque)))
    step = 2 * pi / (span * pole_pairs)
    found = {round(step * k): float(value) for k, value in enumerate(share, 1)}
    return dict(sorted(found.items(), key=lambda one: -one[1]))


def classical_pull(mean_stress: float, radius: float, effective_gap: float) -> float:
    """Magnetic pull per shift of the rotor [N/m^2], per metre of the machine: F/(l e).

    F = pi r l <B^2> e / (mu_0 g), with <B^2> = 2 mu_0 sigma_0 the mean square of the flux density in the gap, from its
    mean radial stress; of a sinusoidal field of amplitude B it is pi r l B^2 e/(2 mu_0 g).
    Standard textbook formula: iron without saturation, a gap that is thin against radius and poles, two pole pairs or
    more, a shift small against the gap. Harmonics of the field count like the first, though they feel the gap more.

    mean_stress: sigma_0 [Pa]; radius: r of the gap [m]; effective_gap: g, see ``effective_gap`` [m]
    """
    mean_square = 2 * MU_0 * mean_stress
    return pi * radius * mean_square / (MU_0 * effective_gap)


def effective_gap(machine: Machine, recoil_permeability: float) -> float:
    """The gap g [m] by which the field changes as B'/B = -1/g when the gap changes.

    g = tanh(k h)/k,   h = airgap + l_m/mu_r,   k = p/r
    Own derivation for a plane wave between magnets and smooth iron, B ~ 1/sinh(k h); for few poles it is the usual h.

    recoil_permeability: mu_r, dimensionless
    """
    height = machine.airgap + machine.magnet_length / recoil_permeability
    wave_number = machine.pole_pairs / machine.mid_gap_radius
    return tanh(wave_number * height) / wave_number
