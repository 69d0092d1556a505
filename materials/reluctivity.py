"""Reluctivity of soft magnetic materials as a smooth law of the flux density.

The field solver minimises the magnetic energy over the vector potential, so the law is H over B, and what enters is

    nu(b2) = H/B   and   dnu/d(b2),   b2 = |B|^2

With these the Newton tangent is nu I + 2 dnu/d(b2) B B^T; its eigenvalue along B is the differential reluctivity
dH/dB, which is positive for every law in this file. dnu/d(b2) itself is negative up to the steepest point of an
S-shaped curve (initial permeability below the maximum); that is physics, not a defect.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, isfinite

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from materials.compiled_law import nu_and_derivative
from materials.errors import MaterialError
from units import MU_0, Values

NU_0 = 1.0 / MU_0  # m/H, reluctivity of vacuum

FEWEST_POINTS = 4
# Maker's tables are rounded, so a secant in deep saturation may come out slightly flatter than vacuum; more than
# this is a wrong curve (the pyleecan curve of M400-50A has 0.5 %).
SLOPE_ROUNDING = 0.02
# No known material polarises further than iron-cobalt: 2.45 T (Bozorth, Ferromagnetism, 1951).
LARGEST_POLARISATION = 2.5  # T
MOST_BINS = 4096  # of the table that finds the interval of a flux density


class Reluctivity:
    """An isotropic anhysteretic law H(B). Arrays of any shape go in, arrays of the same shape come out."""

    def nu(self, b2: Values) -> np.ndarray:
        """Reluctivity H/B [m/H] at the squared flux density b2 = |B|^2 [T^2], b2 >= 0, of its shape."""
        return self.nu_and_derivative(b2)[0]

    def nu_and_derivative(self, b2: Values) -> tuple[np.ndarray, np.ndarray]:
        """Reluctivity H/B [m/H] and its derivative [m/(H T^2)] at b2 = |B|^2 [T^2], both of its shape."""
        raise NotImplementedError

    def field_strength(self, b: Values) -> np.ndarray:
        """H [A/m] at the flux density b [T], of its shape; odd in b."""
        raise NotImplementedError

    def flux_density(self, h: Values) -> np.ndarray:
        """B [T] at the field strength h [A/m], of its shape; the inverse of ``field_strength``, odd in h."""
        raise NotImplementedError

    def energy_density(self, b: Values) -> np.ndarray:
        """w(B) = integral of H dB from 0 to B [J/m^3] at b [T], of its shape; even in b."""
        raise NotImplementedError

    def rising(self, share: float) -> Reluctivity:
        """The law with ``share`` [1], at least 0, of the polarisation that it takes up beyond what was measured; the
        law itself where nothing was."""
        return self

    def coenergy_density(self, b: Values) -> np.ndarray:
        """w'(B) = integral of B dH from 0 to H(B) = H B - w [J/m^3] at the flux density b [T], of its shape."""
        return self.field_strength(b) * np.asarray(b, dtype=float) - self.energy_density(b)


@dataclass(frozen=True)
class LinearReluctivity(Reluctivity):
    """B = mu_0 mu_r H: air, copper, an unmagnetised magnet, or steel in a linear comparison."""

    relative_permeability: float  # mu_r, dimensionless

    def __post_init__(self) -> None:
        if not (isfinite(self.relative_permeability) and self.relative_permeability > 0):
            raise MaterialError(f"a relative permeability must be positive, found {self.relative_permeability}")

    @property
    def reluctivity(self) -> float:
        """1/(mu_0 mu_r) [m/H]."""
        return NU_0 / self.relative_permeability

    def nu_and_derivative(self, b2: Values) -> tuple[np.ndarray, np.ndarray]:
        """Reluctivity [m/H] and its derivative [m/(H T^2)] at b2 [T^2], both of its shape."""
        b2 = np.asarray(b2, dtype=float)
        return np.full_like(b2, self.reluctivity), np.zeros_like(b2)

    def field_strength(self, b: Values) -> np.ndarray:
        """H [A/m] at b [T], of its shape."""
        return self.reluctivity * np.asarray(b, dtype=float)

    def flux_density(self, h: Values) -> np.ndarray:
        """B [T] at h [A/m], of its shape."""
        return np.asarray(h, dtype=float) / self.reluctivity

    def energy_density(self, b: Values) -> np.ndarray:
        """w(B) [J/m^3] at b [T], of its shape."""
        return 0.5 * self.reluctivity * np.asarray(b, dtype=float) ** 2


@dataclass(frozen=True, eq=False)
class PiecewiseCubic:
    """H(B) = a0 + a1 t + a2 t^2 + a3 t^3 with t = B - B_k between the points B_k and B_(k+1) of a table.

    The interval of a flux density is read from a table of equal bins and then moved on over the few points that lie
    inside the bin: some four times faster than a binary search for the many unsorted points of a mesh.
    """

    starts: np.ndarray  # B_k [T], (n - 1,): one per interval
    ends: np.ndarray  # B_(k+1) [T], (n - 1,); infinite for the last, which so takes every larger flux density
    a0: np.ndarray  # [A/m], (n - 1,)
    a1: np.ndarray  # [m/H], (n - 1,)
    a2: np.ndarray  # [m/(H T)], (n - 1,)
    a3: np.ndarray  # [m/(H T^2)], (n - 1,)
    energies: np.ndarray  # integral of H dB up to B_k [J/m^3], (n - 1,)
    bins_per_tesla: float  # [1/T]
    interval_of_bin: np.ndarray  # index of the interval that holds the lower edge of a bin, (bins,)
    points_per_bin: int  # at most

    @classmethod
    def hermite(cls, B: np.ndarray, H: np.ndarray, slopes: np.ndarray) -> PiecewiseCubic:
        """Cubic Hermite interpolant through points B [T], H [A/m] with slopes dH/dB [m/H] there, all (n,)."""
        h = np.diff(B)
        secants = np.diff(H) / h
        a2 = (3 * secants - 2 * slopes[:-1] - slopes[1:]) / h
        a3 = (slopes[:-1] + slopes[1:] - 2 * secants) / h**2
        pieces = h * (H[:-1] + h * (slopes[:-1] / 2 + h * (a2 / 3 + h * a3 / 4)))
        energies = np.concatenate([[0.0], np.cumsum(pieces)[:-1]])
        ends = np.append(B[1:-1], inf)
        return cls(B[:-1], ends, H[:-1], slopes[:-1], a2, a3, energies, *_bin_table(B))

    def locate(self, b: np.ndarray) -> np.ndarray:
        """Index of the interval of each flux density b >= 0 [T], (m,) both."""
        k = self.interval_of_bin.take((b * self.bins_per_tesla).astype(np.intp), mode="clip")
        for _ in range(self.points_per_bin):
            k += b >= self.ends[k]
        return k

    def value(self, b: np.ndarray, k: np.ndarray) -> np.ndarray:
        """H(b) [A/m], (m,), for b [T], (m,), in intervals k (indices), (m,)."""
        t = b - self.starts[k]
        return self.a0[k] + t * (self.a1[k] + t * (self.a2[k] + t * self.a3[k]))

    @cached_property
    def coefficients(self) -> np.ndarray:
        """B_k [T] and a0 to a3, as the compiled law reads them (5, n - 1)."""
        return np.stack([self.starts, self.a0, self.a1, self.a2, self.a3])

    def value_and_slope(self, b: np.ndarray, k: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """H(b) [A/m] and dH/dB [m/H], both (m,), for b [T], (m,), in intervals k (indices), (m,)."""
        t = b - self.starts[k]
        a1, a2t, a3tt = self.a1[k], t * self.a2[k], t * t * self.a3[k]
        return self.a0[k] + t * (a1 + a2t + a3tt), a1 + 2 * a2t + 3 * a3tt

    def integral(self, b: np.ndarray, k: np.ndarray) -> np.ndarray:
        """Integral of H dB from 0 to b [J/m^3], (m,), for b [T], (m,), in intervals k (indices), (m,)."""
        t = b - self.starts[k]
        quartic = self.a1[k] / 2 + t * (self.a2[k] / 3 + t * self.a3[k] / 4)
        return self.energies[k] + t * (self.a0[k] + t * quartic)


def _bin_table(B: np.ndarray) -> tuple[float, np.ndarray, int]:
    """Bins per tesla, interval of each bin, and the largest number of points inside one bin."""
    count = int(min(np.ceil(B[-1] / np.diff(B).min()), MOST_BINS))
    edges = np.linspace(0.0, B[-1], count + 1)
    interval = np.searchsorted(B, edges, side="right") - 1
    return count / B[-1], interval[:-1], int(np.diff(interval).max())


@dataclass(frozen=True)
class ApproachToSaturation:
    """What lies beyond the last point (H_l, B_l): the first term of the law of approach to saturation,

        B = mu_0 H + J_l + c (1 - H_l/H),   c = H_l (dB/dH|_l - mu_0)

    c makes the slope continuous, so the polarisation tends to J_l + c and dB/dH to mu_0. c = 0 is a table that ends
    in full saturation. Valid for c >= 0 and H >= H_l. Source of the law (its 1/H term): Bozorth, Ferromagnetism (1951).
    """

    last_field: float  # H_l [A/m]
    last_flux: float  # B_l [T]
    rise: float  # c [T], by which the polarisation still grows

    @classmethod
    def continuing(cls, last_field: float, last_flux: float, slope: float) -> ApproachToSaturation:
        """Law that leaves the last point, last_field [A/m] and last_flux [T], with the slope dH/dB [m/H]."""
        permeability = 1.0 / slope if slope > 0 else inf
        return cls(last_field, last_flux, max(0.0, last_field * (permeability - MU_0)))

    @property
    def saturation_polarisation(self) -> float:
        """J_s = J_l + c [T]."""
        return self.last_flux - MU_0 * self.last_field + self.rise

    def value(self, b: np.ndarray) -> np.ndarray:
        """H [A/m] at b [T], b >= B_l, of its shape: the positive root of mu_0 H^2 - (b - J_s) H - c H_l = 0."""
        u = b - self.saturation_polarisation
        return (u + np.sqrt(u * u + 4 * MU_0 * self.rise * self.last_field)) / (2 * MU_0)

    def slope(self, h: np.ndarray) -> np.ndarray:
        """dH/dB [m/H] at h [A/m], of its shape."""
        return 1.0 / (MU_0 + self.rise * self.last_field / (h * h))

    def inverse(self, h: np.ndarray) -> np.ndarray:
        """B [T] at h [A/m], h >= H_l, of its shape."""
        return MU_0 * h + self.saturation_polarisation - self.rise * self.last_field / h

    def integral(self, b: np.ndarray) -> np.ndarray:
        """Integral of H dB from B_l to b [T], of its shape [J/m^3]: H B - H_l B_l minus the integral of B dH."""
        h, h_l = self.value(b), self.last_field
        logarithm = self.rise * h_l * np.log(h / h_l)
        coenergy = MU_0 / 2 * (h * h - h_l**2) + self.saturation_polarisation * (h - h_l) - logarithm
        return h * b - h_l * self.last_flux - coenergy


@dataclass(frozen=True, eq=False)
class SplineReluctivity(Reluctivity):
    """Law through the points of a measured curve: monotone cubic H(B), then the approach to saturation.

    * Inside the table: PCHIP of H over B (SciPy's slopes, Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5 (1984)):
      monotone, with continuous slope.
    * From 0 to the first point the start slope is (3 secant - slope at the first point)/2, not PCHIP's: it makes
      d2H/dB2 = 0 at B = 0, as the odd symmetry H(-B) = -H(B) asks for. Then nu = nu(0) + a3 b2 there, a smooth
      function of b2, and dnu/d(b2) is finite; with PCHIP's own start it would go to infinity as 1/B. The slope is
      positive and the piece monotone because PCHIP's slopes stay below three secants.
    * At the last point PCHIP's one-sided slope stands, but never above 1/mu_0 (no steel is flatter than vacuum).
    * Beyond: ``ApproachToSaturation``, joined with continuous slope.

    Build it with ``from_points``.
    """

    name: str
    table: PiecewiseCubic
    tail: ApproachToSaturation

    @classmethod
    def from_points(cls, name: str, H: ArrayLike, B: ArrayLike) -> SplineReluctivity:
        """Law through measured points.

        H: field strength [A/m], shape (n,), n >= 4, starts at 0, strictly increasing
        B: flux density [T], shape (n,), starts at 0, strictly increasing
        Raises MaterialError when the points are not such a curve, when it ends flatter than vacuum, or when it stops
        so early that its continuation would not be physical.
        """
        H, B = np.array(H, dtype=float), np.array(B, dtype=float)
        check_curve(name, H, B)
        slopes = _slopes(H, B)
        tail = ApproachToSaturation.continuing(float(H[-1]), float(B[-1]), float(slopes[-1]))
        _check_saturation(name, tail)
        return cls(name, PiecewiseCubic.hermite(B, H, slopes), tail)

    @property
    def saturation_polarisation(self) -> float:
        """Polarisation B - mu_0 H for H -> infinity [T]."""
        return self.tail.saturation_polarisation

    def rising(self, share: float) -> SplineReluctivity:
        """The law with another rise c beyond its table; where that is not one, the slope jumps at the last point."""
        return replace(self, tail=replace(self.tail, rise=share * self.tail.rise))

    @property
    def last_flux_density(self) -> float:
        """End of the measured table [T]; larger values are extrapolated."""
        return self.tail.last_flux

    def nu_and_derivative(self, b2: Values) -> tuple[np.ndarray, np.ndarray]:
        """nu [m/H] and dnu/d(b2) = (dH/dB - nu)/(2 b2) [m/(H T^2)] at b2 [T^2], of its shape; exact in every piece."""
        b2, shape = _flat(b2)
        table, tail = self.table, self.tail
        nu, derivative = nu_and_derivative(
            b2,
            table.ends,
            table.coefficients,
            table.bins_per_tesla,
            table.interval_of_bin,
            tail.last_flux,
            tail.saturation_polarisation,
            tail.rise * tail.last_field,
        )
        return nu.reshape(shape), derivative.reshape(shape)

    def field_strength(self, b: Values) -> np.ndarray:
        """H [A/m] at b [T], of its shape."""
        b, shape = _flat(b)
        size = np.abs(b)
        H = self.table.value(size, self.table.locate(size))
        beyond = np.flatnonzero(size > self.tail.last_flux)
        H[beyond] = self.tail.value(size[beyond])
        return np.copysign(H, b).reshape(shape)

    def energy_density(self, b: Values) -> np.ndarray:
        """w(B) [J/m^3] at b [T], of its shape."""
        b, shape = _flat(b)
        inside = np.minimum(np.abs(b), self.tail.last_flux)
        energy = self.table.integral(inside, self.table.locate(inside))
        beyond = np.flatnonzero(np.abs(b) > self.tail.last_flux)
        energy[beyond] += self.tail.integral(np.abs(b[beyond]))
        return energy.reshape(shape)

    def flux_density(self, h: Values) -> np.ndarray:
        """B [T] at h [A/m], of its shape."""
        h, shape = _flat(h)
        size = np.abs(h)
        B = _invert_monotone(self.table, np.minimum(size, self.tail.last_field), self.tail)
        beyond = np.flatnonzero(size > self.tail.last_field)
        B[beyond] = self.tail.inverse(size[beyond])
        return np.copysign(B, h).reshape(shape)


def _flat(values: Values) -> tuple[np.ndarray, tuple[int, ...]]:
    values = np.asarray(values, dtype=float)
    return values.ravel(), values.shape


def _slopes(H: np.ndarray, B: np.ndarray) -> np.ndarray:
    """dH/dB at the points [m/H]: PCHIP but for the first and the last, see ``SplineReluctivity``."""
    slopes = PchipInterpolator(B, H)(B, 1)
    slopes[0] = (3 * H[1] / B[1] - slopes[1]) / 2
    slopes[-1] = min(slopes[-1], NU_0)
    return slopes


def _invert_monotone(table: PiecewiseCubic, h: np.ndarray, tail: ApproachToSaturation, steps: int = 60) -> np.ndarray:
    """B with H(B) = h inside the table: Newton's method, halving the bracket where a step would leave it."""
    k = np.searchsorted(table.a0, h, side="right") - 1
    low, high = table.starts[k], np.minimum(table.ends[k], tail.last_flux)
    b = 0.5 * (low + high)
    for _ in range(steps):
        H, slope = table.value_and_slope(b, k)
        low, high = np.where(H <= h, b, low), np.where(H >= h, b, high)
        newton = b - (H - h) / np.maximum(slope, np.finfo(float).tiny)
        step = np.where((newton >= low) & (newton <= high), newton, 0.5 * (low + high)) - b
        b = b + step
        if np.all(np.abs(step) <= 1e-15 * (1.0 + b)):
            return b
    return b


def check_curve(name: str, H: np.ndarray, B: np.ndarray) -> None:
    """Raise MaterialError, with the number of the point, unless (H [A/m], B [T]), both (n,), is a usable curve."""
    if H.ndim != 1 or H.shape != B.shape:
        raise MaterialError(f"{name}: expected as many H as B in two lists, found shapes {H.shape} and {B.shape}")
    if len(H) < FEWEST_POINTS:
        raise MaterialError(f"{name}: a curve needs at least {FEWEST_POINTS} points, found {len(H)}")
    _refuse(name, H, B, ~(np.isfinite(H) & np.isfinite(B)), "is not a pair of finite numbers")
    _refuse(name, H, B, (H < 0) | (B < 0), "is negative; give the first quadrant only")
    if H[0] != 0 or B[0] != 0:
        raise MaterialError(f"{name}: {_point(H, B, 0)} must be (0, 0); add it as the first row", 0)
    for symbol, values in (("H", H), ("B", B)):
        falls = np.append(False, np.diff(values) <= 0)
        _refuse(name, H, B, falls, f"does not increase in {symbol} over the point before it; both columns must")
    _check_last_slope(name, H, B)


def _refuse(name: str, H: np.ndarray, B: np.ndarray, wrong: np.ndarray, reason: str) -> None:
    if wrong.any():
        point = int(np.argmax(wrong))
        raise MaterialError(f"{name}: {_point(H, B, point)} {reason}", point)


def _point(H: np.ndarray, B: np.ndarray, index: int) -> str:
    return f"point {index + 1} (H = {H[index]:g} A/m, B = {B[index]:g} T)"


def _check_last_slope(name: str, H: np.ndarray, B: np.ndarray) -> None:
    permeability = (B[-1] - B[-2]) / (H[-1] - H[-2]) / MU_0
    if permeability * (1 + SLOPE_ROUNDING) < 1:
        raise MaterialError(
            f"{name}: the curve ends with dB/dH = {permeability:.3g} mu_0, flatter than vacuum, at "
            f"{_point(H, B, len(H) - 1)}; B must contain mu_0 H (is the column the polarisation J?)",
            len(H) - 1,
        )


def _check_saturation(name: str, tail: ApproachToSaturation) -> None:
    if tail.saturation_polarisation > LARGEST_POLARISATION:
        raise MaterialError(
            f"{name}: continued beyond its last point (H = {tail.last_field:g} A/m, B = {tail.last_flux:g} T) "
            f"the curve would saturate at {tail.saturation_polarisation:.3g} T, more than any material "
            f"({LARGEST_POLARISATION} T); it stops before its knee or B is not in tesla: add points at higher fields"
        )
