"""Figures from tables: design maps, fits, limits, rotation, match, winding."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from matplotlib.text import Text

from drivetrain.constraints import OverloadForce, RegenerativeDamping
from drivetrain.match import LengthCurve
from drivetrain.output import Wheel
from figures.design_map import constrained_flux_density, design_map, design_maps, in_millimetres, select_optimum
from figures.fits import QUANTITIES, fits, is_refused
from figures.limits import limits
from figures.match import best_row, match_curves, match_over_radius, radius_table
from figures.rotation import mean_over_period, probe_columns, rotation
from figures.winding import RequiredPoint, WheelPoint, force_velocity, torque_speed
from geometry.family import Combination
from units import RPM

TWELVE = Combination(12, 10)
READING, LIMIT = "aligned_tooth", 1.2


def words(figure):
    """All texts of a figure in one string."""
    return "\n".join(text.get_text() for text in figure.findobj(Text))


# ---- design map -----------------------------------------------------------------------------------------------------


def test_feasible_is_below_the_limit_and_buildable(design_space):
    one = design_space.sel(stator_diameter_mm=85.0)
    design = in_millimetres(one, READING, LIMIT)
    assert design.feasible.shape == (6, 7), "rotor radius upwards, back iron to the right"
    expected = (one.tooth_aligned_T <= LIMIT).transpose("rotor_radius", "back_iron").values
    assert (design.feasible == expected).all()
    assert not design.feasible[:, -1].any(), "what cannot be built is not feasible"
    assert design.feasible.any() and not design.feasible[:, 0].all()
    assert not replace(design, torque=np.full((6, 7), np.nan)).feasible.any()
    assert design.x[0] == pytest.approx(0.05 * 42.5) and design.y[-1] == pytest.approx(0.47 * 42.5)


def test_reading_decides_what_is_limited(design_space):
    one = design_space.sel(stator_diameter_mm=85.0)
    limited = constrained_flux_density(one, "every_tooth_and_back_iron_over_period")
    assert np.allclose(limited, one.back_iron_worst_T, equal_nan=True)
    assert np.allclose(constrained_flux_density(one, "every_tooth"), one.tooth_worst_T, equal_nan=True)
    with pytest.raises(ValueError, match="aligned_tooth, every_tooth.*found 'everything'"):
        constrained_flux_density(one, "everything")


def test_limited_map_of_the_sweep_is_used_where_it_fits(design_space):
    one = design_space.assign(limited_T=3 * design_space.tooth_worst_T).assign_attrs(reading="every_tooth")
    one = one.sel(stator_diameter_mm=85.0)
    assert np.allclose(constrained_flux_density(one, "every_tooth"), 3 * one.tooth_worst_T, equal_nan=True)
    assert np.allclose(constrained_flux_density(one, READING), one.tooth_aligned_T, equal_nan=True)


def test_design_map_is_complete(design_space, optima, assert_readable):
    figure = design_map(design_space, optima[optima.slots == 12], "12 slots, 10 poles", 85.0, READING, LIMIT)
    text = words(figure)
    for part in ("torque per length / (Nm/m)", "mean |B| / T", "back-iron width / mm", "rotor outer radius / mm"):
        assert part in text
    assert f"optimum {85**2 / 130:.1f} Nm/m" in text and "12 slots, 10 poles, Ø 85 mm, limit 1.2 T" in text
    star = [line for line in figure.axes[0].lines if line.get_marker() == "*"]
    assert star[0].get_xydata().tolist() == [[pytest.approx(2.55), pytest.approx(14.45)]]
    assert_readable(figure)


def test_overview_has_a_panel_for_each_diameter(design_space, optima, assert_readable):
    figure = design_maps(design_space, optima[optima.slots == 9], "9 slots, 10 poles", READING, LIMIT)
    text = words(figure)
    assert "Ø 70 mm: 37.7 Nm/m" in text and "Ø 100 mm: none feasible" in text
    assert_readable(figure)


def test_no_optimum_is_not_invented(optima):
    optima = optima[optima.slots == 9]
    assert select_optimum(optima, 100.0, READING, LIMIT) is None
    assert select_optimum(optima, 85.0, READING, 1.6) is None
    assert select_optimum(optima, 85.0, READING, LIMIT).back_iron_width_mm == pytest.approx(2.55)


# ---- fits and limits ------------------------------------------------------------------------------------------------


@pytest.fixture
def polynomials():
    fit = {"p2": 0.01, "p1": 1.0, "p0": 2.0, "r_squared": 0.98765, "rms_residual": 0.123}
    rows = [{"slots": slots, "poles": 10, "quantity": name, **fit} for slots in (9, 12) for name, _, _ in QUANTITIES]
    return pd.DataFrame(rows).assign(refused=["R2 below 0.99"] + [np.nan] * (len(rows) - 1))


def test_fits_print_their_quality(optima, polynomials, assert_readable):
    figure = fits(optima, polynomials)
    text = words(figure)
    assert text.count("= 0.98765") == 12 and text.count("rms residual 0.123") == 12
    assert text.count("refused") == 2, "beside the quality and in the legend"
    for part in ("torque per length / (Nm/m)", "back-iron width / mm", "half-slot area / mm²"):
        assert part in text
    assert "stator outer radius / mm" in text
    dotted = [line for line in figure.axes[0].lines if line.get_linestyle() == ":"]
    assert len(dotted) == 1 and dotted[0].get_ydata()[0] == pytest.approx(0.01 * 35**2 + 35 + 2)
    assert_readable(figure)


@pytest.mark.parametrize("value, refused", [("", False), (np.nan, False), (False, False), (None, False), ("bad", True)])
def test_refused_is_a_reason(value, refused):
    assert is_refused(value) is refused


def test_limits_show_what_is_infeasible(assert_readable):
    table = pd.DataFrame(
        [
            {"reading": reading, "limit_T": limit, "torque_nominal_Nm_per_m": 50 * limit - 10 * number}
            for number, reading in enumerate((READING, "every_tooth"))
            for limit in (1.2, 1.4, 1.6)
        ]
    ).assign(back_iron_width_mm=3.0, rotor_outer_radius_mm=15.0)
    table.loc[3, ["torque_nominal_Nm_per_m", "back_iron_width_mm", "rotor_outer_radius_mm"]] = np.nan
    figure = limits(table, chosen_reading=READING, chosen_limit_T=1.2)
    crosses = [line for line in figure.axes[0].lines if line.get_marker() == "x"]
    assert [line.get_xdata().tolist() for line in crosses] == [[1.2]]
    assert crosses[0].get_ydata().tolist() == [0.0], "on the lower edge, where no data are"
    assert "every tooth: no machine keeps the limit" in words(figure)
    assert "flux-density limit / T" in words(figure) and "choice of the study" in words(figure)
    assert_readable(figure)


# ---- rotation -------------------------------------------------------------------------------------------------------


@pytest.fixture
def turning():
    angle = np.linspace(-72, 0, 25)
    wave = np.sin(angle / 36 * np.pi)
    probes = {f"tooth_{k}_T": 1.2 + 0.1 * k * wave for k in (10, 2, 1, 0)} | {"back_iron_0_T": 1.1 + 0 * wave}
    torques = {"torque_arkkio_Nm_per_m": 55 + wave, "torque_maxwell_Nm_per_m": 55.1 + wave}
    return pd.DataFrame({"angle_mech_deg": angle, **torques, "torque_no_current_Nm_per_m": wave, **probes})


def test_rotation_is_complete(turning, assert_readable):
    figure = rotation(turning, null_angle_deg=-24.0, q_axis_angle_deg=-21.0)
    text = words(figure)
    assert "mean 55.000 Nm/m" in text and "mean 55.100 Nm/m" in text
    assert "null angle −24°" in text and "q-axis angle −21°" in text
    assert "mechanical rotor angle / °" in text and "|B| / T" in text
    assert_readable(figure)


def test_rotation_of_a_machine_without_magnets_has_no_cogging(turning, assert_readable):
    figure = rotation(turning.assign(torque_no_current_Nm_per_m=0.0))
    assert len(figure.axes) == len(rotation(turning).axes) - 1
    assert "cogging" in words(rotation(turning)) and "cogging" not in words(figure)
    assert "(b) flux density in the teeth" in words(figure)
    assert_readable(figure)


def test_probes_are_in_the_order_of_their_numbers(turning):
    assert probe_columns(turning, "tooth_") == ["tooth_0_T", "tooth_1_T", "tooth_2_T", "tooth_10_T"]


def test_mean_counts_the_repeated_sample_once():
    angle = np.linspace(0, 4, 5)
    assert mean_over_period(angle, np.array([2.0, 1.0, 0.0, 1.0, 2.0])) == 1.0
    assert mean_over_period(angle, np.array([2.0, 1.0, 0.0, 1.0, 1.0])) == 1.0


# ---- match ----------------------------------------------------------------------------------------------------------


MATCHED = SimpleNamespace(transmission_ratio=2.3e-3, active_length=36e-3, total_cost=0.6, ratio_bounds=(1.3e-3, 4.5e-3))


def test_match_curves_tell_enforced_from_reported(assert_readable):
    ratio = np.linspace(1e-3, 5e-3, 50)
    terms = {"mass_term": 100 * ratio, "inertia_term": 0.2 * 2e-3 / ratio, "radius_term": np.full(50, 0.17)}
    curves = SimpleNamespace(
        ratio=ratio,
        lengths=(LengthCurve(OverloadForce(1, 1), 15 * ratio), LengthCurve(RegenerativeDamping(1, 1, 0), 20 * ratio)),
        active_length=15 * ratio,
        feasible=(ratio > 1.3e-3) & (ratio < 4.5e-3),
        cost=sum(terms.values()),
        **terms,
    )
    figure = match_curves(curves, MATCHED, output=Wheel(), title="12 slots, Ø 85 mm", length_limit=70e-3)
    text = words(figure)
    assert "regenerative damping (not enforced)" in text and "overload force (not enforced)" not in text
    assert "2.30 mm/rad, 36.0 mm" in text and "transmission ratio / (mm/rad)" in text
    thick = max(figure.axes[0].lines, key=lambda line: line.get_linewidth())
    shown = np.isfinite(thick.get_ydata())
    assert (shown == curves.feasible).all()
    assert_readable(figure)


def test_radius_without_a_match_stays_empty(assert_readable):
    numbers = {"transmission_ratio": 2.3e-3, "active_length": 36e-3, "cost": 0.6}
    found = {name: np.array([np.nan, value]) for name, value in numbers.items()}
    result = SimpleNamespace(radii=np.array([35e-3, 42.5e-3]), **found)
    table = pd.concat([radius_table(TWELVE, law, result, Wheel()) for law in ("field", "linear")])
    assert table.stator_outer_radius_mm.tolist() == [35.0, 42.5] * 2
    assert table.cost.isna().tolist() == [True, False] * 2
    other = radius_table(Combination(9, 14), "linear", result, Wheel())
    figure = match_over_radius(
        pd.concat([table, other]), Wheel(), best=best_row(TWELVE, "field", 42.5e-3, MATCHED, Wheel())
    )
    assert "12 slots, 10 poles, overload torque scaled linearly" in words(figure) and "chosen" in words(figure)
    assert_readable(figure)


# ---- winding --------------------------------------------------------------------------------------------------------


def test_envelopes_with_the_chosen_one_thick(assert_readable):
    speed = np.linspace(0, 1500, 40)
    torque = np.minimum(6.0, 4000 / np.maximum(speed, 1.0))
    envelope = SimpleNamespace(speed=speed, torque=torque, power=torque * speed)
    seven, five = (f"{turns} wires in hand, star, 2 parallel paths" for turns in ("7 turns of 22", "5 turns of 31"))
    demand = (RequiredPoint("peak force", 6643 * RPM, 6.0),)
    figure = torque_speed({seven: envelope, five: envelope}, seven, demand)
    lines = {line.get_label(): line for line in figure.axes[0].lines}
    assert lines[f"{seven} (chosen)"].get_linewidth() > lines[five].get_linewidth()
    assert lines["peak force"].get_xdata()[0] == pytest.approx(6643)
    assert "rotor speed / rpm" in words(figure) and "power / kW" in words(figure)
    assert_readable(figure)


def test_maps_are_drawn_at_the_wheel(assert_readable):
    torque, speed = np.meshgrid(np.linspace(-6, 6, 31), np.linspace(-1500, 1500, 41), indexing="ij")
    current = np.where(np.abs(torque * speed) < 4000, 20 * np.abs(torque) + 1, np.nan)
    operating = SimpleNamespace(torque=torque, speed=speed, voltage_peak=current / 5, current_peak=current)
    point = WheelPoint("force peak", 1.6, -2614.0)
    limit = SimpleNamespace(voltage_peak=27.7, current_peak=122.0)
    figure = force_velocity(operating, 2.3e-3, output=Wheel(), title="7 turns", required=(point,), limits=limit)
    axes = figure.axes[0]
    assert axes.get_xlabel() == "velocity at the wheel / (m/s)" and axes.get_ylabel() == "force at the wheel / kN"
    assert axes.get_xlim() == pytest.approx((-1500 * 2.3e-3, 1500 * 2.3e-3))
    assert axes.dataLim.y1 == pytest.approx(6 / 2.3)
    marker = [line for line in axes.lines if line.get_label() == "force peak"][0]
    assert marker.get_xydata().tolist() == [[1.6, -2.614]]
    assert "limit 27.7 V" in words(figure) and "peak phase current / A" in words(figure)
    assert_readable(figure)
