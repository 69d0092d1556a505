"""The stage on a flux map in closed form: ratings that sit on their limit, overloads, duties and what people read."""

from dataclasses import replace

import numpy as np
import pytest

from drivetrain.output import Shaft, Wheel
from electrical.winding_stage import winding_stage
from figures.report import Table
from materials.conductor import COPPER
from materials.magnet import Magnet
from pipeline.codec import decoded, digest, encoded
from report.heat import files, flow_table, overload_table, rating_table, remarks, section, temperature_table
from tests.electrical.analytic_map import DEMAND, GOOD, INPUTS, MATCHED, Saturating, flux_map
from tests.thermal.built import CASING, COOLING, WEIGHTS
from thermal.air import StillAir
from thermal.cooling import HeatLimits
from thermal.course import course
from thermal.field_loss import FieldHeat, FieldLoss, NoLossData
from thermal.machine import MAGNETS, ROTOR, SLOT, TEETH, YOKE
from thermal.network import settled
from thermal.rating import COPPER_LIMIT, CURRENT_LIMIT, MAGNET_LIMIT, allowed_for, continuous, overload, state_of
from thermal.stage import Assembled, BuiltMachine, Duty, HeatInputs, heat_stage

MAP = flux_map(Saturating())
BUILT = BuiltMachine(WEIGHTS, 0.95, CASING, 2.3e-3, 250.0, 3.0)
STATED = Duty(np.array([300.0]), np.array([0.1]), 0.0)
HEAT = HeatInputs(COOLING, HeatLimits(155.0), Magnet(1.3), COPPER, 20.0)


class Turning(FieldLoss):
    """20 mW for each rad/s in the stator, a tenth in the magnets."""

    known = True

    def at(self, torque, speed):
        stator = 0.02 * np.abs(speed) + 0.0 * torque
        return FieldHeat(stator, 0 * stator, 0.1 * stator, 0 * stator)


@pytest.fixture(scope="module")
def winding():
    return winding_stage(MAP, MATCHED, DEMAND, INPUTS, GOOD)


@pytest.fixture(scope="module")
def found(winding):
    return heat_stage(MAP, winding, INPUTS, BUILT, STATED, Turning(), HEAT)


def heated(winding, inputs=HEAT, speed=0.0, field=Turning()):
    return Assembled(MAP, winding, BUILT, field, inputs).heated(speed)


# ---- ratings --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("copper", "magnets", "bound"), ((100.0, 300.0, COPPER_LIMIT), (300.0, 90.0, MAGNET_LIMIT)))
def test_a_rating_sits_on_the_limit_that_binds(winding, copper, magnets, bound):
    rating = continuous(heated(winding, replace(HEAT, limits=HeatLimits(copper, magnets))))
    at = rating.state.hottest_copper if bound is COPPER_LIMIT else rating.state.temperature[MAGNETS]
    assert rating.bound_by == bound and at == pytest.approx(min(copper, magnets), abs=0.01)
    assert rating.state.margin(HeatLimits(copper, magnets)) == pytest.approx(0.0, abs=0.01)


def test_far_from_every_limit_the_current_binds(winding):
    cold = replace(HEAT, cooling=replace(COOLING, mount=1e3, ambient=-50.0), limits=HeatLimits(390.0, 390.0))
    rating = continuous(heated(winding, cold))
    assert rating.bound_by == CURRENT_LIMIT and rating.current == pytest.approx(winding.limits.current_peak)


def test_a_machine_that_is_too_warm_without_current_has_no_rating(winding):
    rating = continuous(heated(winding, replace(HEAT, limits=HeatLimits(155.0, 39.0))))
    assert rating.current == 0.0 and rating.torque == 0.0


def test_the_rating_is_where_a_long_time_ends(winding, found):
    one = heated(winding)
    end = course(one.load(found.slow.current), one.machine.cold(), 1e5).end
    state = found.slow.state
    assert end[SLOT] == pytest.approx(state.temperature[SLOT], abs=0.05)
    assert state.lost == pytest.approx(sum(state.heat.values()))


def test_the_slope_is_what_a_little_more_loss_does(winding, found):
    """Against more current in the place of less; and a rise can but grow faster than its loss, as copper warms."""
    more = state_of(heated(winding).load(found.slow.current * 1.01))
    state, loss = found.slow.state, 2 * np.log(1.01)
    assert found.slope.copper == pytest.approx((more.hottest_copper - state.hottest_copper) / loss, rel=0.03)
    magnets = more.temperature[MAGNETS] - state.temperature[MAGNETS]
    assert found.slope.magnets == pytest.approx(magnets / loss, rel=0.03)
    assert found.slope.copper > state.hottest_copper - COOLING.ambient


def test_speed_friction_and_warm_surroundings_cost_effort(winding, found):
    assert found.at_speed.torque < found.slow.torque
    warmer = continuous(heated(winding, replace(HEAT, cooling=replace(COOLING, ambient=60.0))))
    assert warmer.torque < 0.95 * found.slow.torque


def test_weaker_magnets_when_hot_cost_effort(winding, found):
    steady = continuous(heated(winding, replace(HEAT, magnets=Magnet(1.3, temperature_coefficient=0.0))))
    assert steady.current == pytest.approx(found.slow.current, rel=1e-4)
    lost = 0.0011 * (found.slow.state.temperature[MAGNETS] - 20.0)
    assert found.slow.torque == pytest.approx((1 - lost) * steady.torque, rel=1e-3)


# ---- overloads ------------------------------------------------------------------------------------------------------


def test_an_overload_meets_its_limit_when_its_time_is_over(winding, found):
    one = heated(winding)
    assert np.all(np.diff(found.cold.duration) < 0) and np.all(np.diff(found.cold.torque) > 0)
    time, torque = found.cold.duration[-3], found.cold.torque[-3]
    assert allowed_for(one, one.machine.cold(), float(time)) == pytest.approx(torque, rel=2e-3)


def test_for_ten_seconds_more_is_allowed_from_cold_than_from_the_duty(found):
    most = found.peak_effort
    assert found.effort(found.slow.torque) < found.warm_short <= found.cold_short < most
    assert found.cold.duration[-1] > found.warm.duration[-1]


def test_what_is_too_warm_already_has_no_overload(winding, found):
    one = heated(winding)
    hot = dict.fromkeys(one.machine.cold(), 200.0)
    assert allowed_for(one, hot, 10.0) == 0.0 and len(overload(one, hot, found.slow).duration) == 0


# ---- duties ---------------------------------------------------------------------------------------------------------


def test_a_duty_of_one_point_is_that_steady_state(winding, found):
    one = heated(winding, speed=0.1)
    current = float(one.operation.current_of(np.array(300.0 * 2.3e-3), found.duty.temperature[MAGNETS]))
    assert settled(one.load(current), one.machine.cold())[SLOT] == pytest.approx(found.duty.temperature[SLOT], abs=1e-3)
    assert found.ripple == 0.0 and found.warm_is_possible


def test_a_duty_over_time_counts_with_its_mean_loss(winding):
    """Twice the effort for a quarter of the time heats as the effort itself does, here far from saturation."""
    uneven = Duty(np.tile([600.0, 0.0, 0.0, 0.0], 100), np.full(400, 0.1), 0.01)
    assembled, one = Assembled(MAP, winding, BUILT, Turning(), HEAT), heated(winding, speed=0.1)
    ends = [state_of(assembled.under(duty, assembled.history(duty, one.operation))) for duty in (uneven, STATED)]
    assert ends[0].temperature[SLOT] == pytest.approx(ends[1].temperature[SLOT], abs=0.1)
    assert ends[0].heat[SLOT] > 1.0, "else this shows nothing"


@pytest.mark.parametrize("effort", (780.0, 2600.0), ids=("too warm", "without end"))
def test_a_duty_that_is_too_much_is_said_and_leaves_no_overload(winding, effort):
    hot = replace(HEAT, cooling=replace(COOLING, film=StillAir(0.1)))
    found = heat_stage(MAP, winding, INPUTS, BUILT, Duty(np.array([effort]), np.array([0.1]), 0.0), Turning(), hot)
    assert not found.warm_is_possible and found.warm_short == 0.0 and len(found.warm.duration) == 0
    assert (found.duty is None) == (effort > 2000.0)
    assert any("duty in service" in line for line in remarks(found, Shaft()))
    assert section(found, Shaft()).title == "Heat and continuous torque"


# ---- for people -----------------------------------------------------------------------------------------------------


def test_the_report_of_a_drive_speaks_of_no_wheel(found):
    said = [one if isinstance(one, str) else one.frame.to_string() if isinstance(one, Table) else repr(one)
            for one in section(found, Shaft()).content]  # fmt: skip
    words = " ".join(said)
    for absent in ("wheel", "road", "force", "m/s", " kN"):
        assert absent not in words, absent
    assert "Continuous torque" in words and " rpm" in words and "in service" in words


def test_tables_say_what_the_outcome_holds(found):
    ratings = rating_table(found, Wheel()).set_index("what")["force / N"]
    assert ratings["continuous, slowly turning"] == pytest.approx(found.slow.torque / 2.3e-3)
    warm = temperature_table(found, Wheel()).set_index("part")["slowly_turning_degC"]
    assert warm["hottest copper"] == pytest.approx(found.slow.state.hottest_copper)
    flows = flow_table(found.at_speed.state)
    assert flows[flows.to == "ambient"].share_percent.sum() == pytest.approx(100.0) and (flows.heat_W >= 0).all()
    assert set(overload_table(found, Wheel())["from"]) == {"cold", "the duty"}


def test_without_loss_data_the_run_says_so(winding, found):
    one = heated(winding, field=NoLossData(), speed=0.1)
    assert sum(one.load(10.0).heat(one.machine.cold())[name] for name in (TEETH, YOKE, MAGNETS, ROTOR)) == 0.0
    assert any("no loss data" in line for line in remarks(replace(found, field_known=False), Wheel()))
    assert not any("no loss data" in line for line in remarks(found, Wheel()))


@pytest.mark.parametrize(("share", "said"), ((0.95, False), (0.7, True)))
def test_another_density_than_was_counted_on_is_said_with_its_key(found, share, said):
    allowed = found.slow_density * found.at_speed.current / found.slow.current
    lines = [one for one in remarks(replace(found, nominal_density=share * allowed), Wheel()) if "j_nominal" in one]
    assert bool(lines) == said and all(f"allow {allowed / 1e6:.3g} A/mm²" in one for one in lines)


def test_files_are_written(found, tmp_path):
    (tmp_path / "figures").mkdir()
    for one in files(found, Wheel()):
        one.write(tmp_path / one.name)
        assert (tmp_path / one.name).stat().st_size > 100


def test_the_outcome_is_written_and_read_again(found):
    again = decoded(encoded(found))
    assert digest(again) == digest(found) and again.slow.state.temperature == found.slow.state.temperature
