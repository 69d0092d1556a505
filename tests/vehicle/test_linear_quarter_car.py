"""Linear quarter car: LQR gains, stationary and transient indices, power theorem, carpets (thesis section 4.2.2)."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import solve_continuous_lyapunov

from tests.vehicle.thesis import (
    COMFORT,
    CRUISE_SPEED,
    HANDLING,
    LQR_COEFFICIENTS,
    QUARTER_CAR_ROAD_DURATION,
    QUASI_IDEAL_PASSIVE,
    TABLE_4_1,
    TRADE_OFF,
    quarter_car,
)
from units import GRAVITY
from vehicle.comfort import WEIGHTING
from vehicle.commands import Feedback
from vehicle.damping import linear_damper
from vehicle.errors import VehicleError
from vehicle.quarter_car import (
    TO_STROKE_STATES,
    LqrWeights,
    damping_feedback,
    groundhook,
    lqr,
    lqr_gain,
    lqr_problem,
    printed_form,
    skyhook,
    spring_negation,
    state_space,
)
from vehicle.ride import Run, Scenario
from vehicle.road import IsoRoad, roughness_of_class
from vehicle.scenarios import runs_of, summaries
from vehicle.spectral import (
    carpet,
    carpet_from_rest,
    ensemble_indices,
    indices_from_rest,
    mean_power_theorem,
    ride_of,
    stationary_covariances,
    stationary_indices,
)

CAR, ROAD = quarter_car(), IsoRoad(roughness_of_class("B"), seed=0)
SETTINGS = (HANDLING, TRADE_OFF, COMFORT)
THEOREM = mean_power_theorem(CAR.tyre_stiffness, ROAD, CRUISE_SPEED)


def ride(feedback):
    return ride_of(CAR, feedback, ROAD, CRUISE_SPEED)


# ---- gains ----------------------------------------------------------------------------------------------------------


@pytest.mark.reference
@pytest.mark.parametrize("weights", SETTINGS)
def test_lqr_coefficients_are_the_printed_ones(weights):
    """Within 0.5 % or the rounding of the printed digits."""
    found = printed_form(lqr(CAR, weights))
    rounding = {2.3e4: 5e-3, 0.5: 0.1, 2.25e4: 17e-3}  # a1 of 4.27 follows as 2.287e4
    for name, printed in LQR_COEFFICIENTS[weights].items():
        assert found[name] == pytest.approx(printed, rel=rounding.get(printed, 5e-3)), name


@pytest.mark.reference
def test_lqr_coefficients_to_the_digits_of_an_independent_solution():
    handling, trade, comfort = (printed_form(lqr(CAR, weights)) for weights in SETTINGS)
    assert list(handling.values()) == pytest.approx([-1.4598e4, 1.6206e4, 1.572e3, 4.376e3], rel=5e-3)
    assert list(trade.values()) == pytest.approx([2.2866e4, 627.0, 216.7, 118.1], rel=5e-3)
    assert [comfort[name] for name in ("a1", "a3", "a5")] == pytest.approx([2.298e4, 0.515, 130.0], rel=5e-3)


@pytest.mark.physics
@pytest.mark.parametrize("weights", SETTINGS)
def test_lqr_gain_solves_the_riccati_equation(weights):
    """P from the stable subspace of the Hamiltonian matrix, without the Riccati solver."""
    a, b, q, r = lqr_problem(CAR, weights)
    hamiltonian = np.block([[a, -b @ b.T / r], [-q, -a.T]])
    values, vectors = np.linalg.eig(hamiltonian)
    stable = vectors[:, values.real < 0]
    p = (stable[4:] @ np.linalg.inv(stable[:4])).real
    gain = lqr_gain(CAR, weights)
    assert gain == pytest.approx((b.T @ p / r)[0], rel=1e-6)
    assert np.allclose(np.linalg.eigvals(a - b @ gain[None]).real.max(), values.real[values.real < 0].max(), rtol=1e-6)


@pytest.mark.reference
def test_the_squared_mass_of_the_text_gives_other_gains():
    """R = 1/m_s^2 is what the text to 4.24 describes: scaling R is scaling both weights inversely."""
    weights = LqrWeights(HANDLING.stroke * CAR.sprung_mass, HANDLING.wheel * CAR.sprung_mass)
    assert printed_form(lqr(CAR, weights))["a1"] == pytest.approx(-7.4e5, rel=0.02)


@pytest.mark.reference
def test_the_wheel_weight_of_the_text_gives_other_gains_too():
    """r_h = 3556 as printed gives a3 = 21.8 and a5 = 312; 3.556e5 on the grid gives the printed 217 and 118."""
    found = printed_form(lqr(CAR, LqrWeights(TRADE_OFF.stroke, 3556.0)))
    assert (found["a3"], found["a5"]) == pytest.approx((21.8, 312.0), rel=5e-3)


@pytest.mark.reference
def test_handling_gain_in_terms_of_the_states():
    assert lqr_gain(CAR, HANDLING) == pytest.approx([37598, -16206, 5949, -1572], abs=1.0)


def test_weights_must_be_positive():
    with pytest.raises(VehicleError, match="LQR weights: stroke must be above zero"):
        LqrWeights(0.0, 1.0)


# ---- model ----------------------------------------------------------------------------------------------------------


@pytest.mark.physics
def test_state_space_is_newtons_law():
    """Right-hand side and outputs against eq. 4.7 written down for one state."""
    a, b, c, d = state_space(CAR)
    z, u = np.array([0.011, -0.004, 0.3, -0.7]), np.array([0.006, 150.0])
    tyre = CAR.tyre_stiffness * (z[1] - u[0])
    rates = [z[2], z[3], u[1] / CAR.sprung_mass, (-u[1] - tyre) / CAR.unsprung_mass]
    assert a @ z + b @ u == pytest.approx(rates)
    assert c @ z + d @ u == pytest.approx([*z, rates[2], z[1] - u[0], z[0] - z[1]])
    assert TO_STROKE_STATES @ z == pytest.approx([z[0] - z[1], z[1], z[2], z[3]])


@pytest.mark.physics
def test_control_laws_as_forces():
    z_s, z_u, v_s, v_u = 0.01, -0.02, 0.4, 0.7
    x = np.array([z_s - z_u, z_u, v_s, v_u])
    assert np.dot(damping_feedback(10.0).row, x) == pytest.approx(10 * (v_s - v_u))
    assert np.dot(skyhook(10.0, 3.0).row, x) == pytest.approx(3 * v_s + 10 * (v_s - v_u))
    assert np.dot(groundhook(10.0, 3.0).row, x) == pytest.approx(-3 * v_u + 10 * (v_s - v_u))
    assert np.dot(spring_negation(10.0, 50.0).row, x) == pytest.approx(-50 * (z_s - z_u) + 10 * (v_s - v_u))
    a = printed_form(Feedback((1.0, 2.0, 3.0, 4.0)))
    assert -a["a1"] * x[0] - a["a2"] * x[1] + a["a3"] * (v_s - v_u) + a["a5"] * v_s == pytest.approx([1, 2, 3, 4] @ x)


# ---- stationary indices ---------------------------------------------------------------------------------------------


@pytest.mark.reference
@pytest.mark.parametrize("weights, comfort, holding", [(HANDLING, 0.0406, 0.0595), (TRADE_OFF, 0.0146, 0.134)])
def test_stationary_indices(weights, comfort, holding):
    found, printed = stationary_indices(ride(lqr(CAR, weights))), TABLE_4_1[weights]
    assert found.comfort / GRAVITY == pytest.approx(comfort, abs=6e-5)
    assert found.road_holding == pytest.approx(holding, abs=6e-4)
    assert weights is TRADE_OFF or found.stroke == pytest.approx(6.5e-3, abs=5e-5)
    assert found.comfort == pytest.approx(printed[0], rel=0.08)
    # handling: 0.057 of the non-linear model; the 0.05 of Table 4.1 is outside what any seed gives
    assert found.road_holding == pytest.approx(0.057 if weights is HANDLING else printed[1], rel=0.10)


@pytest.mark.reference
@pytest.mark.parametrize("damping", QUASI_IDEAL_PASSIVE)
def test_passive_damping_against_tables_4_6_and_4_7(damping):
    found, (comfort, holding) = stationary_indices(ride(damping_feedback(damping))), QUASI_IDEAL_PASSIVE[damping]
    expected = {10e3: (0.0770, 0.098), 2.6e3: (0.0457, 0.0629)}[damping]
    assert (found.comfort / GRAVITY, found.road_holding) == pytest.approx(expected, rel=2e-3)
    assert found.comfort == pytest.approx(comfort, rel=0.09) and found.road_holding == pytest.approx(holding, rel=0.10)


@pytest.mark.physics
@pytest.mark.parametrize("weights", [HANDLING, TRADE_OFF])
def test_stationary_indices_are_the_energy_of_the_impulse_response(weights):
    """Mean square = 0.5 integral h^2 dt, with h integrated in time by a general solver."""
    loop = ride(lqr(CAR, weights))
    outputs = np.array([loop.comfort, loop.road_holding, loop.stroke])

    def rates(_, y):
        return np.concatenate([loop.a @ y[:8], 0.5 * (outputs @ y[:8]) ** 2])

    end = solve_ivp(rates, (0, 40), np.concatenate([loop.b, np.zeros(3)]), method="DOP853", rtol=1e-9, atol=1e-14)
    found = stationary_indices(loop)
    assert np.sqrt(end.y[8:, -1]) == pytest.approx([found.comfort, found.road_holding, found.stroke], rel=1e-3)


@pytest.mark.physics
def test_stationary_indices_are_those_of_a_long_ride():
    """2000 roads of 40 s, 22 hours, against the covariance from rest over the same time."""
    loop, duration = ride(lqr(CAR, HANDLING)), 40.0
    found = ensemble_indices(loop, duration, range(2000), 1e-3)
    expected = indices_from_rest(loop, duration)
    assert np.sqrt(np.mean(found.comfort**2)) == pytest.approx(expected.comfort, rel=1e-3)
    assert np.sqrt(np.mean(found.road_holding**2)) == pytest.approx(expected.road_holding, rel=1e-3)
    assert np.mean(found.mean_power) == pytest.approx(expected.mean_power, rel=2e-3)


@pytest.mark.physics
def test_ride_from_rest_becomes_stationary():
    loop = ride(lqr(CAR, HANDLING))
    late, stationary = indices_from_rest(loop, 2000.0, step=0.02), stationary_indices(loop)
    assert late.comfort == pytest.approx(stationary.comfort, rel=1e-3)
    assert late.road_holding == pytest.approx(stationary.road_holding, rel=1e-3)


@pytest.mark.physics
@pytest.mark.parametrize("weights", SETTINGS)
def test_the_average_over_time_does_not_depend_on_its_step(weights):
    """From rest the covariance of each instant is exact; the coarse step of the carpets, the usual one, an eighth."""
    coarse, usual, fine = (indices_from_rest(ride(lqr(CAR, weights)), 15.0, step) for step in (1e-2, 5e-3, 1.25e-3))
    for one, bound in ((coarse, 3e-5), (usual, 1e-5)):
        assert (one.comfort, one.road_holding) == pytest.approx((fine.comfort, fine.road_holding), rel=bound)


@pytest.mark.physics
def test_linear_and_general_model_ride_alike():
    """The same road, damper and car in the integration of the motion and in the spectral formulas, 12 seeds."""
    step, damping = 1e-3, 2.6e3
    roads = [IsoRoad(ROAD.roughness, seed) for seed in range(12)]
    scenarios = [Scenario("road", CRUISE_SPEED, 15.0, road, time_step=step) for road in roads]
    general = summaries(runs_of(CAR, [linear_damper(damping, "linear")], scenarios))
    linear = ensemble_indices(ride(damping_feedback(damping)), 15.0, range(12), step)
    assert [run.comfort_rms for run in general] == pytest.approx(linear.comfort, rel=5e-3)
    assert [run.road_holding_rms for run in general] == pytest.approx(linear.road_holding, rel=5e-3)
    assert [run.power_mean for run in general] == pytest.approx(linear.mean_power, rel=2e-2)


# ---- power ----------------------------------------------------------------------------------------------------------


@pytest.mark.physics
def test_mean_power_theorem():
    """1/2 k_u (2 pi)^2 G_r v 1/2 for any stabilising law; what a law takes less goes into the road's low-pass."""
    assert THEOREM == pytest.approx(15.48, abs=0.005)
    laws = [lqr(CAR, weights) for weights in SETTINGS] + [damping_feedback(c) for c in QUASI_IDEAL_PASSIVE]
    for law in (*laws, skyhook(193.0, 2000.0), groundhook(2121.0, 40.0)):
        assert stationary_indices(ride(law)).mean_power == pytest.approx(THEOREM, rel=0.01)


@pytest.mark.reference
def test_mean_power_of_simulated_roads():
    found = ensemble_indices(ride(lqr(CAR, HANDLING)), QUARTER_CAR_ROAD_DURATION, range(200), 1e-3).mean_power
    assert np.mean(np.abs(found / THEOREM - 1) < 0.25) > 0.98  # single runs
    groups = found[:198].reshape(33, 6).mean(axis=1)
    assert np.mean(np.abs(groups / THEOREM - 1) < 0.08) > 0.95  # means of six


@pytest.mark.physics
def test_mean_power_of_any_stabilising_feedback():
    """Forty laws drawn at random, spring and damper at every place of the row, as far as they are stable and damped."""
    draw, found = np.random.default_rng(5), []
    while len(found) < 40:
        row = draw.normal(scale=(8e3, 8e3, 2e3, 2e3)) + np.array([0.0, 0.0, 2e3, -2e3])
        loop = ride(Feedback(tuple(row.tolist())))
        if np.linalg.eigvals(loop.a[:4, :4]).real.max() < -0.3:
            found.append(stationary_indices(loop).mean_power)
    assert np.array(found) == pytest.approx(THEOREM, rel=0.01)


@pytest.mark.physics
def test_covariances_of_many_loops_are_those_of_each():
    """Against scipy's solution by Schur vectors; a loop that is not stable has none."""
    laws = [skyhook(c, hook) for c in (10.0, 500.0, 1e4) for hook in (10.0, 2e4)]
    rides = [ride(law) for law in (*laws, spring_negation(10.0, 1.2 * CAR.spring_stiffness))]
    noise = 0.5 * np.outer(rides[0].b, rides[0].b)
    found = stationary_covariances(np.array([one.a for one in rides]), noise)
    for one, covariance in zip(rides[:-1], found, strict=False):
        assert covariance == pytest.approx(solve_continuous_lyapunov(one.a, -noise), rel=1e-8, abs=1e-14)
    assert np.isnan(found[-1]).all()


@pytest.mark.reference
@pytest.mark.parametrize(
    ("law", "held", "printed"),
    [
        (lqr(CAR, HANDLING), 0.0564, 0.057),
        (skyhook(1842.0, 1431.0), 0.0569, 0.055),
        (groundhook(2121.0, 40.0), 0.0594, 0.057),
        (spring_negation(2154.0, 9230.0), 0.0572, 0.056),
    ],
)
def test_noise_held_for_ten_milliseconds_gives_the_printed_road_holding(law, held, printed):
    """With continuous noise the four lie 3 to 8 % higher; a sample time of 10 ms, which is not printed, explains it."""
    roads = [IsoRoad(ROAD.roughness, seed, sample_time=1e-2) for seed in range(12)]
    scenarios = [Scenario("road", CRUISE_SPEED, QUARTER_CAR_ROAD_DURATION, road) for road in roads]
    found = np.mean([run.road_holding_rms for run in summaries([Run(CAR, law, one) for one in scenarios])])
    assert found == pytest.approx(held, rel=0.015)
    assert found == pytest.approx(printed, rel=0.05)


# ---- runs of 15 s from rest -----------------------------------------------------------------------------------------

PERCENTILES = {  # 5, 50, 95 % of comfort [g], road holding, largest stroke [mm]
    HANDLING: ((0.0378, 0.0406, 0.0432), (0.0564, 0.0594, 0.0622), (15.5, 18.9, 24.6)),
    TRADE_OFF: ((0.0125, 0.0144, 0.0167), (0.117, 0.132, 0.151), (42, 63, 93)),
    COMFORT: ((1.0e-4, 1.9e-4, 3.3e-4), (0.39, 0.73, 1.27), (49, 80, 122)),
}


@pytest.mark.reference
@pytest.mark.parametrize("weights", SETTINGS)
def test_spread_of_fifteen_second_runs(weights):
    found = ensemble_indices(ride(lqr(CAR, weights)), QUARTER_CAR_ROAD_DURATION, range(200), 1e-3)
    got = (found.comfort / GRAVITY, found.road_holding, 1e3 * found.stroke_peak)
    for values, expected in zip(got, PERCENTILES[weights], strict=True):
        assert np.percentile(values, (5, 50, 95)) == pytest.approx(expected, rel=0.06)


@pytest.mark.reference
def test_comfort_setting_is_a_transient():
    """Slowest pole -0.0064 /s: the printed 1e-4 g and 0.49 are those of a run that began at rest."""
    loop = ride(lqr(CAR, COMFORT))
    assert np.linalg.eigvals(loop.a).real.max() == pytest.approx(-0.0064, abs=1e-4)
    found = ensemble_indices(loop, QUARTER_CAR_ROAD_DURATION, range(200), 1e-3)
    comfort, holding, stroke = TABLE_4_1[COMFORT]
    for values, printed in ((found.comfort, comfort), (found.road_holding, holding), (found.stroke_peak, stroke)):
        assert 0.5 < np.median(values) / printed < 2.0
    assert stationary_indices(loop).road_holding > 3 * np.median(found.road_holding)


# ---- carpets --------------------------------------------------------------------------------------------------------

C_GRID = 10 * 1000 ** (np.arange(50) / 49)
HOOK_GRID = 10 * 2000 ** (np.arange(50) / 49)
WEIGHT_GRID = 10 ** (8 * np.arange(50) / 49)


def node(grid, value):
    return int(np.argmin(np.abs(np.log(grid / value))))


@pytest.mark.reference
def test_skyhook_carpet():
    found = carpet(CAR, ROAD, CRUISE_SPEED, skyhook, C_GRID, HOOK_GRID)
    c, hook, comfort = found.best(found.comfort)
    assert abs(node(C_GRID, c) - node(C_GRID, 168)) <= 1 and hook == pytest.approx(20e3)
    assert comfort / GRAVITY == pytest.approx(0.0190, abs=5e-5) and comfort / GRAVITY == pytest.approx(2e-2, rel=0.08)
    c, _, holding = found.best(found.road_holding)
    assert node(C_GRID, c) == node(C_GRID, 1842) and holding == pytest.approx(0.055, rel=0.10)
    printed = found.road_holding[node(C_GRID, 1842), node(HOOK_GRID, 1431)]
    assert printed == pytest.approx(holding, rel=5e-3)


@pytest.mark.reference
def test_groundhook_carpet():
    found = carpet(CAR, ROAD, CRUISE_SPEED, groundhook, C_GRID, HOOK_GRID[:30])
    c, hook, comfort = found.best(found.comfort)
    assert hook == 10 and found.comfort[node(C_GRID, 910), 0] == pytest.approx(comfort, rel=5e-3)
    assert abs(node(C_GRID, c) - node(C_GRID, 910)) <= 1
    c, _, holding = found.best(found.road_holding)
    assert node(C_GRID, c) == node(C_GRID, 2121) and holding == pytest.approx(0.057, rel=0.10)
    assert found.road_holding[node(C_GRID, 2121), node(HOOK_GRID, 40)] == pytest.approx(holding, rel=5e-3)


@pytest.mark.reference
def test_spring_negation_carpet():
    c_grid = 10 * 1000 ** (np.arange(0, 100, 3) / 99)
    stiffness = CAR.spring_stiffness ** (np.arange(0, 100, 3) / 99)
    found = carpet(CAR, ROAD, CRUISE_SPEED, spring_negation, c_grid, stiffness)
    _, _, holding = found.best(found.road_holding)
    near = stationary_indices(ride(spring_negation(2154.0, 9230.0))).road_holding
    assert near == pytest.approx(holding, rel=5e-3) and near == pytest.approx(0.056, rel=0.10)
    some = CAR.spring_stiffness * np.array([0.3, 0.9, 1])
    corner = carpet_from_rest(CAR, ROAD, CRUISE_SPEED, spring_negation, C_GRID[::12], some, QUARTER_CAR_ROAD_DURATION)
    c, negated, comfort = corner.best(corner.comfort)
    assert c == 10 and negated == CAR.spring_stiffness
    assert 0.5 < comfort / GRAVITY / 0.002 < 2  # a transient, the body is not held
    with pytest.raises(VehicleError, match="no stationary indices"):
        stationary_indices(ride(spring_negation(10.0, 1.001 * CAR.spring_stiffness)))


@pytest.mark.reference
def test_lqr_carpet():
    stroke, wheel = WEIGHT_GRID[36:44], WEIGHT_GRID[42:49]
    found = carpet(CAR, ROAD, CRUISE_SPEED, lambda s, w: lqr(CAR, LqrWeights(s, w)), stroke, wheel)
    r_s, r_h, holding = found.best(found.road_holding)
    assert r_h == pytest.approx(HANDLING.wheel)
    assert abs(node(WEIGHT_GRID, r_s) - node(WEIGHT_GRID, HANDLING.stroke)) <= 1
    assert stationary_indices(ride(lqr(CAR, HANDLING))).road_holding == pytest.approx(holding, rel=5e-3)


def test_comfort_filter_is_inside_the_loop():
    """Gain from body acceleration to comfort in the state space against the filter's polynomial."""
    loop, s = ride(damping_feedback(2e3)), 2j * np.pi * 3.0
    response = np.linalg.solve(s * np.eye(8) - loop.a, loop.b)
    acceleration = loop.a[2] @ response
    gain = np.polyval(WEIGHTING[0], s) / np.polyval(WEIGHTING[1], s)
    assert loop.comfort @ response == pytest.approx(gain * acceleration)
