"""The reluctivity law against its own calculus, SciPy's PCHIP and the physics of saturation."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad
from scipy.interpolate import PchipInterpolator

from materials.library import known_steels, load_steel, read_curve, steel_file
from materials.reluctivity import LinearReluctivity, MaterialError, SplineReluctivity
from units import MU_0


def curve(name):
    _, H, B = read_curve(steel_file(name))
    return np.array(H), np.array(B)


def frohlich(last_flux, points=30):
    """A smooth steel B = mu_0 H + J_s H/(H + a), tabulated at equal steps of H up to about last_flux."""
    H = np.linspace(0.0, 1.0, points) ** 2 * 500.0 / (1.9 / last_flux - 1.0)
    return H, MU_0 * H + 1.9 * H / (H + 500.0)


LAWS = {name: load_steel(name) for name in known_steels()}
LAWS["air"] = LinearReluctivity(1.0)
LAWS["Frohlich"] = SplineReluctivity.from_points("Frohlich", *frohlich(1.6))
SPLINES = {name: law for name, law in LAWS.items() if name != "air"}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
every_spline = pytest.mark.parametrize("law", SPLINES.values(), ids=SPLINES.keys())
every_steel = pytest.mark.parametrize("name", known_steels())


def flux_densities(top=2.6, count=4001):
    return np.linspace(top / count, top, count)


@every_law
def test_derivative_against_central_differences(law):
    """Relative to the size of its two terms, dH/dB/(2 b2) and nu/(2 b2), which nearly cancel in places."""
    b2 = flux_densities() ** 2
    step = 1e-6 * b2
    nu, derivative = law.nu_and_derivative(b2)
    numeric = (law.nu(b2 + step) - law.nu(b2 - step)) / (2 * step)
    assert np.max(np.abs(numeric - derivative) / (np.abs(derivative) + nu / (2 * b2))) < 1e-6


@every_law
def test_nu_is_the_same_by_both_methods_and_gives_the_field_strength(law):
    b = flux_densities()
    assert_allclose(law.nu(b * b), law.nu_and_derivative(b * b)[0], rtol=1e-14)
    assert_allclose(law.nu(b * b) * b, law.field_strength(b), rtol=1e-12)


@every_spline
def test_start_is_smooth_in_b2(law):
    """nu(0) = dH/dB(0), dnu/d(b2) is finite and constant over the first piece: H is odd and smooth at zero."""
    first = law.table.ends[0]
    nu_0, derivative_0 = law.nu_and_derivative(0.0)
    assert nu_0 == pytest.approx(law.field_strength(1e-9) / 1e-9, rel=1e-9)
    assert np.isfinite(derivative_0)
    nu, derivative = law.nu_and_derivative(np.linspace(0, 0.999 * first, 20) ** 2)
    assert_allclose(derivative, derivative_0, rtol=1e-12)
    assert_allclose(nu, nu_0 + derivative_0 * np.linspace(0, 0.999 * first, 20) ** 2, rtol=1e-12)


@every_spline
def test_derivative_is_continuous_across_every_point(law):
    points = np.append(law.table.starts[1:], law.last_flux_density)
    below, above = (law.nu_and_derivative((points * (1 + side)) ** 2) for side in (-1e-10, 1e-10))
    assert_allclose(below[0], above[0], rtol=1e-8)
    scale = np.abs(below[1]) + below[0] / points**2
    assert np.max(np.abs(below[1] - above[1]) / scale) < 1e-6


@every_law
def test_field_strength_rises_everywhere(law):
    H = law.field_strength(np.linspace(0.0, 4.0, 100_001))
    assert np.all(np.diff(H) > 0)


@every_law
def test_differential_reluctivity_is_positive_and_below_vacuum(law):
    b2 = flux_densities(4.0, 100_000) ** 2
    nu, derivative = law.nu_and_derivative(b2)
    slope = nu + 2 * b2 * derivative
    assert np.all(slope > 0)
    assert np.all(slope <= (1 + 2e-3) / MU_0)


@every_law
def test_energy_and_coenergy_fill_the_rectangle(law):
    b = flux_densities()
    assert_allclose(law.energy_density(b) + law.coenergy_density(b), b * law.field_strength(b), rtol=1e-13)


@every_law
@pytest.mark.parametrize("top", [0.01, 0.7, 1.45, 1.79, 2.1, 2.5])
def test_energy_is_the_integral_of_h_db(law, top):
    points = getattr(law, "table", None)
    breaks = [] if points is None else [*points.starts[1:], law.last_flux_density]
    edges = [0.0, *(point for point in breaks if point < top), top]
    integral = sum(quad(law.field_strength, a, b)[0] for a, b in zip(edges, edges[1:]))
    assert law.energy_density(top) == pytest.approx(integral, rel=1e-10)


@every_law
@pytest.mark.parametrize("top", [0.3, 1.5, 2.5])
def test_coenergy_is_the_integral_of_b_dh(law, top):
    """Gauss quadrature of the inverse law between the points, independent of the closed energy."""
    points = getattr(law, "table", None)
    breaks = [] if points is None else [*points.starts[1:], law.last_flux_density]
    edges = law.field_strength(np.array([0.0, *(point for point in breaks if point < top), top]))
    x, weights = np.polynomial.legendre.leggauss(40)
    h = edges[:-1, None] + np.diff(edges)[:, None] * (x + 1) / 2
    integral = np.sum(np.diff(edges)[:, None] / 2 * weights * law.flux_density(h))
    assert law.coenergy_density(top) == pytest.approx(integral, rel=1e-7)


@every_law
def test_flux_density_inverts_field_strength(law):
    b = np.linspace(-3.0, 3.0, 6001)
    assert_allclose(law.flux_density(law.field_strength(b)), b, atol=1e-12)


@every_law
def test_odd_and_even(law):
    b = flux_densities(count=50)
    assert_allclose(law.field_strength(-b), -law.field_strength(b))
    assert_allclose(law.energy_density(-b), law.energy_density(b))
    assert law.field_strength(0.0) == 0 and law.energy_density(0.0) == 0 and law.flux_density(0.0) == 0


@every_law
@pytest.mark.parametrize("shape", [(), (0,), (7,), (5, 3), (2, 3, 4)])
def test_shapes_pass_through(law, shape):
    b = np.full(shape, 1.9)
    nu, derivative = law.nu_and_derivative(b)
    results = (nu, derivative, law.nu(b), law.field_strength(b), law.flux_density(b), law.energy_density(b))
    assert all(np.shape(result) == shape for result in results)
    assert np.all(np.asarray(b) == 1.9)


@every_steel
def test_points_of_the_table_are_met(name):
    H, B = curve(name)
    assert_allclose(LAWS[name].field_strength(B), H, rtol=1e-12)
    assert_allclose(LAWS[name].flux_density(H), B, atol=1e-12)


@every_steel
def test_is_pchip_from_the_first_point_on(name):
    H, B = curve(name)
    b = np.linspace(B[1], B[-1], 20_001)
    assert_allclose(LAWS[name].field_strength(b), PchipInterpolator(B, H)(b), rtol=1e-12)


@every_steel
def test_the_smooth_start_stays_near_pchip(name):
    """The first piece, 0 to B_1, differs from PCHIP by less than 5 % of H_1: under 1.5 A/m, below 0.1 T."""
    H, B = curve(name)
    b = np.linspace(0.0, B[1], 1001)
    assert np.max(np.abs(LAWS[name].field_strength(b) - PchipInterpolator(B, H)(b))) < 0.05 * H[1]


@every_spline
def test_slope_tends_to_vacuum_and_polarisation_to_saturation(law):
    b = np.array([1e4, 2e4])
    H = law.field_strength(b)
    assert np.diff(H) / np.diff(b) == pytest.approx(1 / MU_0, rel=1e-6)
    assert b[0] - MU_0 * H[0] == pytest.approx(law.saturation_polarisation, abs=1e-6)


@every_spline
def test_permeability_never_rises_beyond_the_table(law):
    b2 = np.linspace(law.last_flux_density, 5.0, 1000) ** 2
    nu, derivative = law.nu_and_derivative(b2)
    slope = nu + 2 * b2 * derivative
    assert np.all(np.diff(slope) >= -1e-9 * slope[:-1])


def test_the_thesis_steel_ends_in_vacuum():
    """Slope mu_0 beyond the last point, as the reference solutions have it."""
    law = load_steel("35PN270")
    H, B = curve("35PN270")
    assert law.field_strength(3.0) == pytest.approx(H[-1] + (3.0 - B[-1]) / MU_0, rel=1e-9)


def test_saturation_polarisation_of_the_steels_is_physical():
    """Silicon steel saturates between pure iron's 2.16 T and 1.9 T; M270-35A's table stops at 1.8 T."""
    assert load_steel("35PN270").saturation_polarisation == pytest.approx(1.93, abs=0.01)
    assert load_steel("M270-35A").saturation_polarisation == pytest.approx(2.00, abs=0.02)


@every_law
def test_another_rise_beyond_the_table_changes_nothing_in_it(law):
    last = getattr(law, "last_flux_density", 3.0)
    inside, beyond = np.linspace(0.0, last, 50), np.linspace(last, last + 0.4, 50)[1:]
    assert_allclose(law.rising(0.3).field_strength(inside), law.field_strength(inside))
    assert np.all(law.rising(0.3).field_strength(beyond) >= law.field_strength(beyond) * (1 - 1e-9))


@every_spline
def test_the_rise_beyond_the_table_goes_from_none_to_more(law):
    last, expected = law.last_flux_density, law.saturation_polarisation
    at_last = last - MU_0 * float(law.field_strength(last))
    flat, more = law.rising(0.0), law.rising(2.0)
    b = np.array([last + 0.01, last + 0.3])
    assert np.diff(flat.field_strength(b)) == pytest.approx(np.diff(b) / MU_0)
    assert more.saturation_polarisation == pytest.approx(at_last + 2 * (expected - at_last))


def test_tables_cut_at_1_8_tesla_rise_up_to_twice_as_much_as_is_expected_from_there():
    """By their own last points; what a table that ends early leaves open."""
    shares = []
    for name in known_steels():
        H, B = curve(name)
        kept = int(np.searchsorted(B, 1.8 + 1e-9))
        if B[-1] < 1.95 or B[kept - 1] < 1.7:
            continue
        short = SplineReluctivity.from_points(name, H[:kept], B[:kept])
        rise = B[-1] - float(short.flux_density(H[kept - 1])) - MU_0 * (H[-1] - H[kept - 1])
        expected = float(short.flux_density(H[-1])) - B[kept - 1] - MU_0 * (H[-1] - H[kept - 1])
        shares.append(rise / expected)
    assert len(shares) >= 12
    assert 1.0 < min(shares) and max(shares) < 1.0 + 2 * 0.6


def test_approach_to_saturation_continues_a_known_steel():
    """Froehlich's steel is known beyond its table: a table that ends at 1.7 T gives B within 1 %
    up to three times its last field."""
    H, B = frohlich(1.7)
    law = SplineReluctivity.from_points("Frohlich", H, B)
    h = np.linspace(H[-1], 3 * H[-1], 20)
    exact = MU_0 * h + 1.9 * h / (h + 500.0)
    assert_allclose(law.flux_density(h), exact, rtol=0.01)


def test_s_shaped_curve_has_falling_then_rising_reluctivity():
    law = load_steel("35PN270")
    assert law.nu_and_derivative(0.2**2)[1] < 0 < law.nu_and_derivative(1.4**2)[1]


def test_end_slope_is_never_flatter_than_vacuum():
    """A rounded last point may give a secant 1 % above 1/mu_0; the law then goes on as vacuum."""
    H, B = np.array([0.0, 100.0, 1e4, 1e5, 1.2e5]), np.array([0.0, 1.0, 1.8, 2.0, 0.0])
    B[-1] = B[-2] + 0.99 * MU_0 * (H[-1] - H[-2])
    law = SplineReluctivity.from_points("rounded", H, B)
    nu, derivative = law.nu_and_derivative((B[-1] * (1 - 1e-9)) ** 2)
    assert nu + 2 * derivative * B[-1] ** 2 == pytest.approx(1 / MU_0, rel=1e-6)
    assert law.field_strength(3.0) == pytest.approx(H[-1] + (3.0 - B[-1]) / MU_0, rel=1e-9)


def test_points_closer_than_the_bins():
    """Many points inside one bin of the interval table are still told apart."""
    H, B = frohlich(1.6)
    extra = 1.0 + 1e-6 * np.arange(1, 6)
    B_dense = np.sort(np.concatenate([B, extra]))
    H_dense = np.interp(B_dense, B, H)
    law = SplineReluctivity.from_points("dense", H_dense, B_dense)
    b = np.concatenate([extra, extra + 3e-7, np.linspace(0.8, 1.5, 1000)])
    assert np.array_equal(law.table.locate(b), np.searchsorted(B_dense, b, side="right") - 1)
    assert_allclose(law.field_strength(b), PchipInterpolator(B_dense, H_dense)(b), rtol=1e-10)


GOOD_H, GOOD_B = [0.0, 50.0, 200.0, 5000.0, 20000.0], [0.0, 0.5, 1.2, 1.7, 1.9]


def changed(values, index, value):
    return [value if i == index else v for i, v in enumerate(values)]


@pytest.mark.parametrize(
    ("H", "B", "words", "point"),
    [
        (changed(GOOD_H, 2, 40.0), GOOD_B, r"point 3 .* does not increase in H", 2),
        (GOOD_H, changed(GOOD_B, 3, 1.2), r"point 4 .* does not increase in B", 3),
        (GOOD_H, changed(GOOD_B, 4, 1.701), r"flatter than vacuum", 4),
        (GOOD_H[:3], GOOD_B[:3], r"at least 4 points, found 3", None),
        (GOOD_H, changed(GOOD_B, 1, np.nan), r"point 2 .* finite", 1),
        (changed(GOOD_H, 4, np.inf), GOOD_B, r"point 5 .* finite", 4),
        (GOOD_H[1:], GOOD_B[1:], r"must be \(0, 0\)", 0),
        (changed(GOOD_H, 0, -50.0), changed(GOOD_B, 0, -0.5), r"point 1 .* negative", 0),
        (GOOD_H, GOOD_B[:4], r"as many H as B", None),
        (GOOD_H, [1e3 * b for b in GOOD_B], r"not in tesla", None),
        ([0, 10, 20, 30], [0, 1.0, 2.0, 2.9], r"stops before its knee", None),
    ],
)
def test_bad_curves_are_refused_by_point(H, B, words, point):
    SplineReluctivity.from_points("good", GOOD_H, GOOD_B)
    with pytest.raises(MaterialError, match=words) as error:
        SplineReluctivity.from_points("bad", H, B)
    assert error.value.point == point


@pytest.mark.parametrize("mu_r", [0.0, -1.0, np.nan, np.inf])
def test_linear_law_needs_a_positive_permeability(mu_r):
    with pytest.raises(MaterialError, match="positive"):
        LinearReluctivity(mu_r)


def test_caller_arrays_are_left_alone():
    H, B = np.array(GOOD_H), np.array(GOOD_B)
    law = SplineReluctivity.from_points("good", H, B)
    before = law.field_strength(1.5)
    H[2], B[2] = 0.0, 0.0
    assert law.field_strength(1.5) == before
