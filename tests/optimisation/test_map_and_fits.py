"""Best point of a map with a known answer, and polynomials that must be refused."""

import numpy as np
import pytest

from optimisation.design_map import DesignMap
from optimisation.polynomial_fits import FitRefused, fit_polynomial


def known_map(**changes):
    """Torque w (4 - w) + r (4 - r) limited by w + r: without a limit best at (2, 2), with w + r <= 3 at (1.5, 1.5)."""
    widths, radii = np.linspace(0.5, 3.5, 9), np.linspace(0.5, 3.5, 8)
    w, r = np.meshgrid(widths, radii, indexing="ij")
    values = {"widths": widths, "radii": radii, "torque": w * (4 - w) + r * (4 - r), "limited": w + r}
    return DesignMap(**{**values, **changes})


def test_best_point_on_the_limit_lies_between_the_grid_lines():
    best = known_map().best_point(3.0)
    assert (best.width, best.radius) == pytest.approx((1.5, 1.5), abs=0.03)
    assert best.torque == pytest.approx(7.5, rel=1e-3)


def test_best_point_inside_the_limit():
    best = known_map().best_point(10.0)
    assert (best.width, best.radius, best.torque) == pytest.approx((2.0, 2.0, 8.0), abs=0.03)


def test_designs_that_cannot_be_built_are_left_out():
    full = known_map()
    torque = np.where(full.widths[:, None] > 1.4, np.nan, full.torque)
    assert known_map(torque=torque).best_point(10.0).width <= 1.4


def test_no_best_point_below_every_flux_density():
    assert known_map().best_point(0.9) is None


X = np.linspace(35e-3, 57.5e-3, 10)  # m


def parabola(x):
    return 1e5 * x**2 - 3000 * x + 60


def test_a_parabola_is_found_exactly():
    fit = fit_polynomial("torque", X, parabola(X))
    assert fit.powers == pytest.approx((1e5, -3000, 60))
    assert fit.r_squared == pytest.approx(1.0)
    assert fit(40e-3) == pytest.approx(parabola(40e-3))


def test_the_coefficients_are_of_one_size():
    """In powers of the radius in metres they differ by 1e3; centred and scaled they do not."""
    c2, c1, c0 = np.abs(fit_polynomial("torque", X, parabola(X)).coefficients)
    assert max(c2, c1, c0) / min(c2, c1, c0) < 20


def test_an_outlier_makes_the_fit_refused():
    y = parabola(X)
    y[4] *= 1.2
    fit = fit_polynomial("torque", X, y)
    with pytest.raises(FitRefused, match="45 mm is .* of the mean away.*sweep.stator_diameters_mm"):
        fit(40e-3)


def test_three_points_cannot_test_a_parabola():
    with pytest.raises(FitRefused, match="3 points cannot test.*sweep.stator_diameters_mm"):
        fit_polynomial("torque", X[:3], X[:3])(36e-3)


def test_a_fit_does_not_extrapolate():
    with pytest.raises(FitRefused, match="holds from 35 to 57.5 mm of stator radius, asked for 60"):
        fit_polynomial("torque", X, X)(60e-3)
