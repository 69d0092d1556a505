"""Fits drawn by lot, what the match makes of them, and the budget: against least squares by hand and exact scalings."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from drivetrain.asked import ControlledDamping, PeakPower
from drivetrain.masses import DrawnParts
from drivetrain.match import DampingReported
from drivetrain.matching import Matcher
from geometry.family import Combination
from losses.map import PowerLosses
from magnetostatics.demagnetisation import MagnetFlux
from optimisation.fits import QUANTITIES, CombinationFits, SectionFits
from optimisation.polynomial_fits import fit_polynomial
from tests.drivetrain.fitted_machines import CASE, POLYNOMIALS
from tests.drivetrain.test_matching import INPUTS, LINKAGE, REQUIRED
from uncertainty import budget
from uncertainty import match_spread as module
from uncertainty.budget import Uncertain, of_match, of_product, of_wound, scatter_of
from uncertainty.match_spread import DrawTask, drawn_fits, match_draws
from units import MILLIMETRE

RADII = np.linspace(35.0, 57.5, 8) * MILLIMETRE
SCALES = {"back_iron_width": 1e-3, "rotor_outer_radius": 1e-3, "half_slot_area": 1e-6}
CHOSEN = (Combination(12, 10), 42.5 * MILLIMETRE)


def fits():
    """The polynomials of the motorcycle as fits, without residual."""
    return SectionFits(
        tuple(
            CombinationFits(
                combination,
                tuple(
                    fit_polynomial(name, RADII, SCALES.get(name, 1.0) * np.polyval(powers[name], RADII / MILLIMETRE))
                    for name in QUANTITIES
                ),
            )
            for combination, powers in POLYNOMIALS.items()
        )
    )


def matcher():
    inputs = replace(INPUTS, damping=DampingReported())
    masses = DrawnParts(inputs.masses, CASE.packing)
    return Matcher(CASE, fits(), REQUIRED, LINKAGE, inputs, masses, radii=4, ratio_samples=21)


def test_held_out_is_every_point_off_a_curve_through_the_others():
    rng = np.random.default_rng(1)
    values = 50.0 + 1e3 * RADII + rng.normal(0.0, 0.3, len(RADII))
    off = []
    for k in range(len(RADII)):
        others = np.arange(len(RADII)) != k
        off.append(values[k] - np.polyval(np.polyfit(RADII[others] * 1e3, values[others], 2), RADII[k] * 1e3))
    found = fit_polynomial("", RADII, values).scatter
    assert found.held_out == pytest.approx(np.sqrt(np.mean(np.square(off))), rel=1e-6)


def test_the_covariance_is_the_scatter_of_fits_of_noisy_points():
    rng = np.random.default_rng(2)
    many = np.array([fit_polynomial("", RADII, 50 + rng.normal(0, 0.3, len(RADII))).coefficients for _ in range(2000)])
    covariances = np.mean(
        [fit_polynomial("", RADII, 50 + rng.normal(0, 0.3, len(RADII))).scatter.covariance for _ in range(200)], axis=0
    )
    assert np.diag(covariances) == pytest.approx(np.diag(np.cov(many.T)), rel=0.15)


def test_the_match_of_fits_without_scatter_is_the_match():
    own = matcher()
    drawn = drawn_fits(own.fits, np.random.default_rng(1))  # polynomials through themselves
    (found,) = match_draws(DrawTask(own, (drawn,), CHOSEN))
    expected = own.match(own.section(CHOSEN[0], INPUTS.overload, CHOSEN[1]))
    assert found.active_length == pytest.approx(expected.active_length)
    assert found.transmission_ratio == pytest.approx(expected.transmission_ratio)


def test_a_weaker_machine_is_longer():
    """The force sets the length: at one ratio it goes with one over the torque, and the ratio hardly moves."""
    own = matcher()
    tasks = DrawTask(own, (own.fits, module._scaled(own.fits, (0.98, 0.98))), CHOSEN)
    drawn, weak = match_draws(tasks)
    assert weak.torque_overload == pytest.approx(0.98 * drawn.torque_overload)
    lengths, ratios = weak.active_length / drawn.active_length, weak.transmission_ratio / drawn.transmission_ratio
    assert lengths == pytest.approx(ratios / 0.98, rel=1e-6) and lengths > 1.015


def test_the_free_choice_takes_the_least_cost_and_says_where_it_ends():
    own = matcher()
    (found,) = match_draws(DrawTask(own, (own.fits,), None))
    tried = (own.over_radius(Combination(slots, 10), INPUTS.overload).over_radius.best for slots in (9, 12))
    best = min(tried, key=lambda one: one.total_cost)
    assert (found.slots, found.stator_outer_radius) == (
        best.section.machine.slots,
        pytest.approx(best.section.machine.stator_outer_radius, rel=1e-6),
    )
    assert found.radius_bound == bool(min(abs(found.stator_outer_radius / RADII[[0, -1]] - 1)) < 1e-6)


def test_what_cannot_be_matched_is_a_draw_without_a_match():
    own = matcher()
    assert match_draws(DrawTask(own, (module._scaled(own.fits, (0.1, 0.1)),), CHOSEN)) == (None,)


def moved(**standard):
    """A deviation with these standard uncertainties, relative, signed."""
    return SimpleNamespace(standard=lambda quantity: standard[quantity])


def test_a_product_moves_with_all_its_factors_at_once():
    """P = T w: a deviation that lifts one and lowers the other does less to the product than either; bounds add."""
    found = SimpleNamespace(
        mesh=SimpleNamespace(torque=0.003, speed=0.004, loss=float("nan")),
        sensitivities=(moved(torque=0.03, speed=-0.03, loss=0.1), moved(torque=0.004, speed=-0.001, loss=0.2)),
    )
    power = of_product(found, 5.0, torque=1, speed=1)
    assert power == Uncertain(5.0, pytest.approx(0.007 / 3**0.5), 0.0, pytest.approx(0.003))
    assert of_product(found, 1.0, torque=2, speed=-1).tolerance == pytest.approx(np.hypot(0.09, 0.009))
    assert of_product(found, 1.0, loss=0.5).mesh == 0.0, "what is not known of the mesh is left out"
    assert of_product(found, 1.0) == Uncertain(1.0, 0.0, 0.0, 0.0)


def test_the_efficiency_moves_with_its_losses():
    """At 90 %, three quarters copper, a fifth iron: d ln eta = -0.1 (0.75 d ln P_cu + 0.2 d ln P_fe)."""
    at = PowerLosses(*map(np.array, (9.0, 1.0, 0.75, 0.15, 0.05, 0.05, 0.0)))
    mesh = SimpleNamespace(copper_loss=0.01, iron_loss=float("nan"))
    found = SimpleNamespace(mesh=mesh, sensitivities=(moved(copper_loss=0.04, iron_loss=-0.03),))
    known = budget._efficiency(found, at)
    assert known.value == pytest.approx(0.9) and known.mesh == pytest.approx(0.1 * 0.75 * 0.01 / 3**0.5)
    assert known.tolerance == pytest.approx(0.1 * (0.75 * 0.04 - 0.2 * 0.03))


def test_what_goes_into_the_terminals_moves_with_the_losses_alone():
    """The rated point stays: at 10 % of losses, three quarters copper, a fifth iron, these move a tenth of the input.
    At full current, 9 W at the shaft and 1.5 R I^2 = 3 W: three quarters of the torque, a quarter of the resistance."""
    at = PowerLosses(*map(np.array, (9.0, 1.0, 0.75, 0.15, 0.05, 0.05, 0.0)))
    quantities = {"peak_torque": 9.0, "resistance": 2.0, "continuous_torque": 9.0}
    names = ("copper_loss", "iron_loss", "ripple", "cogging", "base_speed")
    one = moved(
        copper_loss=0.04,
        iron_loss=-0.03,
        peak_torque=0.02,
        resistance=0.08,
        **dict.fromkeys((*names[2:], "continuous_torque"), 0.0),
    )
    known = dict.fromkeys((*names, *quantities), 0.0)
    found = SimpleNamespace(
        values=SimpleNamespace(**known | quantities),
        mesh=SimpleNamespace(**known),
        sensitivities=(one,),
        rated_speed=1.0,
    )
    losses = SimpleNamespace(losses=SimpleNamespace(at=lambda torque, speed: at))
    rated = budget._losses(found, losses).rated_input
    assert rated.value == 10.0 and rated.tolerance == pytest.approx(0.1 * (0.75 * 0.04 - 0.2 * 0.03))
    need = SimpleNamespace(length=0.04)
    winding = SimpleNamespace(
        chosen=SimpleNamespace(base_speed=2.0, power_at_base_speed=18.0, maximum_power=None),
        limits=SimpleNamespace(current_peak=1.0),
        length=SimpleNamespace(needs=(need,)),
    )
    performance = budget._performance(found, winding, None)
    assert performance.largest_power is None, "not asked for"
    full = performance.overload_input
    assert full.value == 12.0 and full.tolerance == pytest.approx(0.75 * 0.02 + 0.25 * 0.08)


def test_temperatures_are_known_by_their_rise():
    """120 K of rise with 150 K per unit of ln P: 4 % of loss are 6 K of copper, a fortieth of a rise of its own."""
    found = SimpleNamespace(
        mesh=SimpleNamespace(copper_loss=0.0, resistance=0.0), sensitivities=(moved(copper_loss=0.04, resistance=0.02),)
    )
    state = SimpleNamespace(hottest_copper=160.0, temperature={"magnets": 40.0})
    heat = SimpleNamespace(
        slow=SimpleNamespace(current=2.0, state=state),
        slope=SimpleNamespace(copper=150.0, magnets=0.0),
        inputs=SimpleNamespace(cooling=SimpleNamespace(ambient=40.0)),
    )
    known = budget._heat(found, heat)
    assert known.copper_rise.value == 120.0 and known.copper_rise.plus_minus == pytest.approx(2 * 6.0)
    assert known.magnet_rise.plus_minus == 0.0 and known.continuous_current.tolerance == pytest.approx(0.01)


def test_the_volume_beyond_the_knee_moves_with_the_field_against_it():
    """0.8 T below the remanence at worst: 1 % of it are 8 mT of the knee, 2u 16 mT, and a point lies 10 mT above."""
    values = np.array([[[0.05], [0.11], [0.5], [0.9]]])
    magnets = SimpleNamespace(
        flux=MagnetFlux(values, np.ones((4, 1))), knee=0.1, knee_off_by=lambda relative: 0.1 + 0.8 * relative
    )
    opposing = Uncertain(6e5, 0.0, 0.0, 0.01)
    known = budget._kept(magnets, opposing)
    assert known.value == 0.75 and known.mesh == 0.0 and known.plus_minus == pytest.approx(0.25)
    assert budget._kept(magnets, replace(opposing, tolerance=0.004)).plus_minus == 0.0
    assert budget._magnets(None, None).kept is None and budget._magnets(None, None).demagnetising_current is None


def test_what_is_reached_at_a_speed_is_asked_of_the_rotor_there():
    check = SimpleNamespace(requirement=PeakPower(4000.0, 3.0), reached=2500.0)
    outcome = SimpleNamespace(checks=(check,), features=SimpleNamespace(transmission_ratio=2e-3))
    found = SimpleNamespace(mesh=SimpleNamespace(resistance=0.0), sensitivities=(moved(resistance=0.02),))
    asked = []
    known = budget._at_speed(found, outcome, PeakPower, lambda speed: asked.append(speed) or {"resistance": -0.5})
    assert asked == [1500.0] and known == Uncertain(2500.0, 0.0, 0.0, pytest.approx(0.01))
    assert budget._at_speed(found, outcome, ControlledDamping, None) is None, "not asked for"
    check.reached = 0.0
    assert budget._at_speed(found, outcome, PeakPower, None) is None, "nothing left"


def test_uncertainties_add_as_the_gum_says():
    known = Uncertain(200.0, 0.003, 0.004, 0.012)
    assert known.combined == pytest.approx(0.013) and known.expanded == pytest.approx(0.026)
    draws = tuple(SimpleNamespace(x=value) for value in (9.0, 10.0, 11.0)) + (None,)
    assert scatter_of(draws, lambda one: one.x) == pytest.approx(0.1)
    spread = SimpleNamespace(mesh=draws, fit=draws[1:], tolerance=draws)
    assert of_match(spread, 5.0, lambda one: one.x).fit == pytest.approx(np.std([10, 11], ddof=1) / 10.5)
    found = SimpleNamespace(
        values=SimpleNamespace(mass=2.0), mesh=SimpleNamespace(mass=0.03), sensitivities=(moved(mass=-0.01),)
    )
    assert of_wound(found, "mass") == Uncertain(2.0, pytest.approx(0.03 / 3**0.5), 0.0, 0.01)
    assert of_wound(found, "mass", 7.0).value == 7.0
