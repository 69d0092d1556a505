"""Eddy currents in the magnets, while they are too weak to act back on the field.

    J = -sigma (dA/dt - mean of dA/dt over the piece),     P = integral J^2/sigma        per metre

A as the rotor sees it. The mean is the voltage per length that keeps the net current of each piece at zero: every
magnet, or every segment of it, is insulated from its neighbours and carries its current back within itself.

Assumptions: two dimensions, so the current closes far away at the ends and pieces must be long against their width
(shorter ones lose less: the estimate is an upper one); resistance-limited, so the skin depth of what moves must exceed
the width of the piece (``frequency_limit``); sinusoidal currents without the inverter's ripple.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from electrical.dq import Values
from geometry.cross_section import CrossSection
from losses.loci import Loci, PartOfPeriod, magnet_potential_loci
from units import MU_0

NDFEB_RESISTIVITY = 1.4e-6  # Ohm m, sintered NdFeB across the grain at room temperature (makers' data: 1.2 to 1.6)


@dataclass(frozen=True)
class MagnetLoss:
    """Loss of all magnets, P = eddy f^2 [W/m] with the electrical frequency f [Hz].

    order: harmonic of the electrical frequency, seen by the rotor, that loses most; 0 where nothing moves
    width: of one piece [m]; resistivity [Ohm m]; permeability: relative
    """

    eddy: float
    order: float
    width: float
    resistivity: float
    permeability: float

    def at(self, frequency: Values) -> Values:
        """Loss [W/m] at an electrical frequency [Hz]."""
        return self.eddy * np.square(frequency)

    @property
    def frequency_limit(self) -> float:
        """Electrical frequency [Hz] where the skin depth at ``order`` falls to the width: rho/(pi mu w^2 order)."""
        if self.order == 0:
            return np.inf
        return self.resistivity / (pi * MU_0 * self.permeability * self.width**2 * self.order)


def magnet_loss(part: PartOfPeriod, resistivity: float = NDFEB_RESISTIVITY, segments: int = 1) -> MagnetLoss:
    """Eddy-current loss of the magnets at one current.

    resistivity: [Ohm m]; segments: pieces of equal width into which every magnet is cut along its magnetisation
    A magnet that two poles share counts as two pieces.
    """
    section = part.model.section
    total, width, by_order, orders = 0.0, 0.0, np.zeros(1), np.zeros(1)
    for number, loci in enumerate(magnet_potential_loci(part)):
        elements = part.model.elements.take(loci.elements)
        width = max(width, _width(section, loci, number))
        pieces = _pieces(_across(section, number, elements.points.transpose(0, 2, 1)), segments)
        density, spectrum, orders = _piece_losses(loci, elements.weights.T, pieces, segments)
        total, by_order = total + density, by_order + spectrum
    return MagnetLoss(
        eddy=float(section.sectors * total / resistivity),
        order=float(orders[np.argmax(by_order)]) if total > 0 else 0.0,
        width=width / segments,
        resistivity=resistivity,
        permeability=part.model.materials.magnet.recoil_permeability,
    )


def skin_depth(frequency: float, resistivity: float = NDFEB_RESISTIVITY, permeability: float = 1.05) -> float:
    """sqrt(rho / (pi f mu)) [m]; permeability: relative."""
    return sqrt(resistivity / (pi * frequency * MU_0 * permeability))


def _width(section: CrossSection, loci: Loci, number: int) -> float:
    """Of a magnet across its magnetisation [m]."""
    corners = section.mesh.p[:, section.mesh.t[:, loci.elements]]
    return float(np.ptp(_across(section, number, corners)))


def _across(section: CrossSection, number: int, points: np.ndarray) -> np.ndarray:
    """Distance of points (2, ...) of a magnet from the plane along its magnetisation [m], (...)."""
    middle = points.reshape(2, -1).mean(axis=1)
    direction = float(section.magnetisation_angle(number, middle))
    return points[1] * np.cos(direction) - points[0] * np.sin(direction)


def _pieces(across: np.ndarray, segments: int) -> np.ndarray:
    """Number of the segment of every quadrature point (E, Q), of equal widths."""
    low, high = across.min(), across.max()
    return np.clip(((across - low) / (high - low) * segments).astype(int), 0, segments - 1)


def _piece_losses(
    loci: Loci, weights: np.ndarray, pieces: np.ndarray, segments: int
) -> tuple[float, np.ndarray, np.ndarray]:
    """integral <(dA/dt - mean)^2> per f^2, the same by order, and the orders."""
    w, piece = weights.ravel(), pieces.ravel()
    rate = loci.rate().reshape(len(loci.values), -1)
    for k in range(segments):
        inside = piece == k
        rate[:, inside] -= (rate[:, inside] @ w[inside] / w[inside].sum())[:, None]
    steps = len(rate)
    power = 2 * np.abs(np.fft.rfft(rate, axis=0) / steps) ** 2 @ w
    return (rate**2).mean(0) @ w, power, np.arange(len(power)) / loci.periods
