"""Second-order polynomials of the optima over the stator radius, refused where they do not describe the points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from units import MILLIMETRE, percent

ORDER = 2
_LARGEST_RELATIVE_RESIDUAL = 0.03
_ROUNDING = 1e-9  # m, beyond the range

Values = Sequence[float] | np.ndarray


class FitRefused(ValueError):
    """A fit that must not be used; the message says why and what to look at."""


@dataclass(frozen=True)
class FitScatter:
    """How sure a fit is, as its own points show.

    covariance: of the coefficients (c2, c1, c0), s^2 (X^T X)^-1 [unit of y squared], three rows
    held_out: root mean square of what each point is off a curve through all others, r/(1 - h) [unit of y]
    """

    covariance: tuple[tuple[float, ...], ...]
    held_out: float


@dataclass(frozen=True)
class PolynomialFit:
    """y = c2 t^2 + c1 t + c0 with t = (R - centre)/scale, over the fitted range of the stator radius R [m].

    The radius is centred and scaled, so that the coefficients are of one size and well determined.
    coefficients: (c2, c1, c0) [unit of y]; rms_residual, largest_residual: [unit of y]; centre, scale, x_range [m]
    r_squared: dimensionless; scatter: how sure the curve is
    refused: the reason why the fit must not be used, empty when it may
    """

    quantity: str
    coefficients: tuple[float, float, float]
    centre: float
    scale: float
    x_range: tuple[float, float]
    r_squared: float
    rms_residual: float
    largest_residual: float
    scatter: FitScatter
    refused: str = ""

    @property
    def powers(self) -> tuple[float, float, float]:
        """(p2, p1, p0) [unit of y over m^2, m, 1] of y = p2 R^2 + p1 R + p0 with R in metres."""
        c2, c1, c0 = self.coefficients
        p2, p1 = c2 / self.scale**2, c1 / self.scale
        return p2, p1 - 2 * p2 * self.centre, c0 - p1 * self.centre + p2 * self.centre**2

    def __call__(self, radius: float | np.ndarray) -> float | np.ndarray:
        """Value at a stator radius [m]. Raises FitRefused for a bad fit or outside the fitted range."""
        if self.refused:
            raise FitRefused(f"the fit of {self.quantity} is refused: {self.refused}")
        low, high = self.x_range
        if np.any(np.asarray(radius) < low - _ROUNDING) or np.any(np.asarray(radius) > high + _ROUNDING):
            asked = np.asarray(radius) / MILLIMETRE
            raise FitRefused(
                f"the fit of {self.quantity} holds from {low / MILLIMETRE:g} to {high / MILLIMETRE:g} mm of stator "
                f"radius, asked for {asked} mm: widen sweep.stator_diameters_mm"
            )
        return np.polyval(self.coefficients, (radius - self.centre) / self.scale)


def fit_polynomial(quantity: str, radii: Values, values: Values) -> PolynomialFit:
    """Least-squares second-order polynomial over the stator radius [m] with its residuals and R^2.

    radii: [m], (n,); values: of the quantity [any unit], (n,)

    The fit is marked as refused when there are too few points for its order to be tested, or when a
    residual exceeds 3 % of the mean (a flat quantity may have a low R^2 and still be described well).
    """
    x, y = np.asarray(radii, dtype=float), np.asarray(values, dtype=float)
    if len(x) < ORDER + 2:
        return _too_few(quantity, x)
    centre, scale = float((x.min() + x.max()) / 2), float(np.ptp(x) / 2)
    coefficients = np.polyfit((x - centre) / scale, y, ORDER)
    residual = y - np.polyval(coefficients, (x - centre) / scale)
    spread = ((y - y.mean()) ** 2).sum()
    r_squared = float(1 - (residual**2).sum() / spread) if spread > 0 else 1.0
    worst = int(np.argmax(np.abs(residual)))
    reason = _reason_to_refuse(x[worst], abs(residual[worst]) / np.mean(np.abs(y)), r_squared)
    rms, largest = float(np.sqrt((residual**2).mean())), float(abs(residual[worst]))
    c2, c1, c0 = coefficients.tolist()
    scatter = fit_scatter((x - centre) / scale, residual)
    return PolynomialFit(quantity, (c2, c1, c0), centre, scale, _range(x), r_squared, rms, largest, scatter, reason)


def fit_scatter(places: np.ndarray, residual: np.ndarray) -> FitScatter:
    """The scatter of a least-squares fit by its residuals.

    places: t of the points, dimensionless, (n,), four or more; residual: of each point [any unit], (n,)
    h is the leverage of a point, the diagonal of X (X^T X)^-1 X^T; standard textbook formulas of least squares, which
    take the misfits of neighbouring points as independent.
    """
    powers = np.vander(places, ORDER + 1)
    inverse = np.linalg.inv(powers.T @ powers)
    leverage = np.einsum("ij,jk,ik->i", powers, inverse, powers)
    variance = (residual**2).sum() / (len(places) - ORDER - 1)
    covariance = tuple(tuple(row) for row in (variance * inverse).tolist())
    return FitScatter(covariance, float(np.sqrt(((residual / (1 - leverage)) ** 2).mean())))


def _too_few(quantity: str, x: np.ndarray) -> PolynomialFit:
    reason = (
        f"{len(x)} points cannot test a polynomial of order {ORDER}; at least {ORDER + 2} are needed: "
        "add to sweep.stator_diameters_mm"
    )
    unknown = float("nan")
    three = (unknown,) * 3
    scatter = FitScatter((three,) * 3, unknown)
    return PolynomialFit(quantity, three, unknown, unknown, _range(x), unknown, unknown, unknown, scatter, reason)


def _range(x: np.ndarray) -> tuple[float, float]:
    return (float(x.min()), float(x.max())) if len(x) else (float("nan"), float("nan"))


def _reason_to_refuse(where: float, relative: float, r_squared: float) -> str:
    if relative <= _LARGEST_RELATIVE_RESIDUAL:
        return ""
    return (
        f"the point at {where / MILLIMETRE:g} mm is {percent(relative, 1)} of the mean away from the curve "
        f"(R^2 = {r_squared:.4f}), more than {percent(_LARGEST_RELATIVE_RESIDUAL)}: look at the optimum there, or fit "
        "a narrower range (sweep.stator_diameters_mm)"
    )
