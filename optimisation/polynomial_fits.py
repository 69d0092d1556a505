"""Second-order polynomials of the optima over the stator radius, refused where they do not describe the points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

ORDER = 2
_LARGEST_RELATIVE_RESIDUAL = 0.03


class FitRefused(ValueError):
    """A fit that must not be used; the message says why and what to look at."""


@dataclass(frozen=True)
class PolynomialFit:
    """y = p2 x^2 + p1 x + p0 over the fitted range of x.

    coefficients (p2, p1, p0); x_range; r_squared; rms_residual and largest_residual in the unit of y; refused: the
    reason why the fit must not be used, empty when it may
    """

    quantity: str
    coefficients: tuple[float, float, float]
    x_range: tuple[float, float]
    r_squared: float
    rms_residual: float
    largest_residual: float
    refused: str = ""

    def __call__(self, x):
        """Value at x. Raises FitRefused for a bad fit or outside the fitted range."""
        if self.refused:
            raise FitRefused(f"the fit of {self.quantity} is refused: {self.refused}")
        low, high = self.x_range
        if np.any(np.asarray(x) < low - 1e-9) or np.any(np.asarray(x) > high + 1e-9):
            raise FitRefused(f"the fit of {self.quantity} holds from {low:g} to {high:g}, asked for {x}")
        return np.polyval(self.coefficients, x)


def fit_polynomial(quantity: str, x: np.ndarray, y: np.ndarray) -> PolynomialFit:
    """Least-squares second-order polynomial with its residuals and R^2.

    The fit is marked as refused when there are too few points for its order to be tested, or when a
    residual exceeds 3 % of the mean (a flat quantity may have a low R^2 and still be described well).
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if len(x) < ORDER + 2:
        reason = f"{len(x)} points cannot test a polynomial of order {ORDER}; at least {ORDER + 2} are needed"
        nothing = (np.nan, np.nan, np.nan)
        return PolynomialFit(quantity, nothing, _range(x), np.nan, np.nan, np.nan, reason)
    coefficients = np.polyfit(x, y, ORDER)
    residual = y - np.polyval(coefficients, x)
    spread = ((y - y.mean()) ** 2).sum()
    r_squared = 1 - (residual**2).sum() / spread if spread > 0 else 1.0
    worst = int(np.argmax(np.abs(residual)))
    reason = _reason_to_refuse(x[worst], abs(residual[worst]) / np.mean(np.abs(y)), r_squared)
    rms = float(np.sqrt((residual**2).mean()))
    return PolynomialFit(
        quantity, tuple(coefficients), _range(x), float(r_squared), rms, float(abs(residual[worst])), reason
    )


def _range(x: np.ndarray) -> tuple[float, float]:
    return (float(x.min()), float(x.max())) if len(x) else (np.nan, np.nan)


def _reason_to_refuse(where: float, relative: float, r_squared: float) -> str:
    if relative <= _LARGEST_RELATIVE_RESIDUAL:
        return ""
    return (
        f"the point at {where:g} is {relative:.1%} of the mean away from the curve (R^2 = {r_squared:.4f}), more than "
        f"{_LARGEST_RELATIVE_RESIDUAL:.0%}: look at the optimum there, or fit a narrower range"
    )
