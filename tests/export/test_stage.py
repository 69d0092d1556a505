"""What the package reads at the rated point, against other routes to the same numbers; and its data sheet."""

from dataclasses import replace
from math import inf, sqrt
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from drivetrain.costs import PartPrices
from drivetrain.gear_views import braking_demand
from drivetrain.masses import PartMaterials
from drivetrain.outcome import active_masses
from drivetrain.output import Shaft, Wheel
from electrical.braking_stage import CopperHeat, braking_stage
from electrical.driven_machine import driven_machine
from electrical.winding_stage import winding_stage
from export.stage import package_stage
from losses.stage import current_losses_stage, losses_stage
from materials.magnet_grade import load_grade
from report import datasheet
from report import package as package_report
from tests.electrical.analytic_map import DEMAND, GOOD, INPUTS, MATCHED, REQUIRED, TRANSMISSION, Saturating, flux_map
from tests.losses.test_stage_and_figure import LOSSES, Computed
from tests.magnetostatics.test_flux_map_stage import CASE
from tests.uncertainty.a_budget import budget_of_alike
from thermal.cooling import HeatLimits
from thermal.machine import MAGNETS
from thermal.rating import MAGNET_LIMIT, Rating
from uncertainty.budget import Uncertain
from units import AMPERE_PER_SQUARE_MILLIMETRE, RPM

MAP = flux_map(Saturating())
HEAT = CopperHeat(20.0, 120.0, 1.0, 1.393)
NO_PRICES = PartPrices("", None, None, None, None)
PRICES = PartPrices("EUR", 3.0, 80.0, 12.0, 2.0)
COGGING = 0.7  # Nm/m
GAP_STRESS = SimpleNamespace(cogging=COGGING)
MAP_OF_LOSSES = object()
KNOWN = Uncertain(1.0, 0.003, 0.0, 0.004)  # u = 0.5 %
UNCERTAINTY = SimpleNamespace(budget=budget_of_alike(KNOWN))


@pytest.fixture(scope="module")
def winding():
    return winding_stage(MAP, MATCHED, DEMAND, INPUTS, GOOD)


@pytest.fixture(scope="module")
def brake(winding):
    return braking_stage(MAP, winding, INPUTS, braking_demand(REQUIRED, TRANSMISSION), HEAT)


@pytest.fixture(scope="module")
def outcome(winding):
    return SimpleNamespace(masses=active_masses(winding.wound, PartMaterials(7650.0, 7500.0, 8890.0, 7800.0, 0.95)))


@pytest.fixture(scope="module")
def losses(winding):
    solved = current_losses_stage(CASE, MAP, MATCHED, LOSSES, Computed())
    return losses_stage(solved, MAP, driven_machine(winding, INPUTS), LOSSES)


@pytest.fixture(scope="module")
def found(winding, brake, outcome, losses):
    return package_stage(CASE, MAP, winding, INPUTS, brake, outcome, losses, GAP_STRESS, PRICES)


@pytest.fixture(scope="module")
def bare(winding, brake, outcome):
    """Without losses and prices."""
    return package_stage(CASE, MAP, winding, INPUTS, brake, outcome, None, GAP_STRESS, NO_PRICES)


def test_the_overload_is_the_peak_torque_of_the_winding(found, winding):
    assert found.overload.torque == pytest.approx(winding.peak_torque, rel=1e-9)
    assert found.overload.speed == winding.chosen.base_speed
    assert found.overload.voltage_peak == pytest.approx(winding.limits.voltage_peak, rel=1e-6), "that is the base speed"


@pytest.mark.physics
def test_power_in_is_power_out_and_copper_loss(found, winding):
    for state in (found.continuous, found.overload):
        copper = 1.5 * winding.wound.phase_resistance * state.current_peak**2
        assert state.power_in == pytest.approx(state.torque * state.speed + copper, rel=1e-9)


def test_the_continuous_current_is_that_of_the_nominal_density(found, winding):
    density = found.continuous.current_peak / sqrt(2) / (winding.chosen.strands * winding.wound.design.wire.area)
    assert density == pytest.approx(6 * AMPERE_PER_SQUARE_MILLIMETRE)


def test_losses_are_those_of_the_map_around_the_point(found, winding, losses):
    copper = 1.5 * winding.wound.phase_resistance * found.continuous.current_peak**2
    assert found.losses.copper == pytest.approx(copper, rel=1e-3)
    plane, at = losses.losses, found.continuous
    row, column = np.searchsorted(plane.torque[:, 0], at.torque), np.searchsorted(plane.speed[0], at.speed)
    corners = plane.stator_iron[row - 1 : row + 1, column - 1 : column + 1]
    assert corners.min() < found.losses.stator_iron < corners.max()
    assert found.losses.electrical - found.losses.mechanical == pytest.approx(found.losses.total)
    efficiency = plane.efficiency[row - 1 : row + 1, column - 1 : column + 1]
    assert efficiency.min() < found.losses.efficiency < efficiency.max()


def test_the_rated_speed_is_no_faster_than_what_is_allowed(winding, brake, outcome):
    slow = replace(INPUTS, limits=replace(INPUTS.limits, maximum_speed=1000 * RPM))
    found = package_stage(CASE, MAP, winding, slow, brake, outcome, None, GAP_STRESS, NO_PRICES)
    assert found.continuous.speed == pytest.approx(1000 * RPM)


def test_the_brake_is_seen_at_the_rotor(found, brake):
    """At its best speed the shorted machine brakes with the largest torque of the whole curve."""
    speeds, shorted = brake.speed / brake.demand.ratio, found.short_circuit
    for best, one in ((shorted.best_speed_cold, brake.cold), (shorted.best_speed_hot, brake.hot)):
        assert np.interp(best, speeds, one.torque) == pytest.approx(np.nanmax(one.torque))
    assert shorted.current_peak == pytest.approx(brake.cold.current_peak[-1], rel=1e-6)


# ---- data sheet -----------------------------------------------------------------------------------------------------


ENDS = SimpleNamespace(temperature={MAGNETS: 120.0}, hottest_copper=151.0)
SLOW = Rating(speed=0.0, current=40.0, torque=3.0, bound_by=MAGNET_LIMIT, state=ENDS)
WARM = SimpleNamespace(
    slow=SLOW, inputs=SimpleNamespace(limits=HeatLimits(155.0), cooling=SimpleNamespace(ambient=40.0))
)
STATES = (SimpleNamespace(name="no load", lost=0.0), SimpleNamespace(name="overload", lost=0.03))


def sheet(package, winding, brake, outcome, output=Wheel(), magnets=None):
    return datasheet.data_sheet(
        package, CASE, LOSSES, winding, INPUTS, HEAT, brake, WARM, magnets, outcome, UNCERTAINTY, output
    )


def value(table, quantity, condition=""):
    (one,) = table[(table.quantity == quantity) & table.condition.str.contains(condition, regex=False)].value
    return one


def test_the_back_emf_is_the_voltage_of_the_idle_machine(found, winding, brake, outcome):
    table = sheet(found, winding, brake, outcome).table
    voltage = np.hypot(*winding.wound.on_map(MAP.data).voltage(0.0, 0.0, 1000 * RPM))
    assert value(table, "back-EMF", "peak") == pytest.approx(sqrt(3) * voltage, rel=1e-4)
    flux = winding.wound.on_map(MAP.data).flux_linkage(0.0, 0.0)[0]
    assert value(table, "magnet flux linkage") == pytest.approx(1e3 * flux, rel=1e-4)


def test_values_are_those_of_the_stages_in_drawing_units(found, winding, brake, outcome):
    table = sheet(found, winding, brake, outcome).table
    assert value(table, "active length") == pytest.approx(1e3 * winding.wound.active_length)
    assert value(table, "peak torque") == winding.peak_torque
    assert value(table, "turns") == winding.chosen.turns and value(table, "poles") == 10
    cold, hot = table.value[table.quantity == "phase resistance"]
    assert cold == pytest.approx(1e3 * winding.wound.phase_resistance) and hot == pytest.approx(1.393 * cold)
    assert value(table, "L_d", "apparent") == pytest.approx(1e6 * winding.chosen.inductance_d)
    assert value(table, "cogging torque") == pytest.approx(COGGING * winding.wound.active_length)
    cold, hot = table.value[table.quantity == "efficiency"]
    more = 0.393 * 1.5 * winding.wound.phase_resistance * found.continuous.current_peak**2  # W of hot copper
    assert cold == pytest.approx(100 * found.losses.efficiency)
    assert 1 / hot - 1 / cold == pytest.approx(more / found.losses.mechanical / 100, rel=1e-3)
    assert value(table, "active parts") == pytest.approx(outcome.masses.total)
    assert value(table, "bus current", "copper") == pytest.approx(found.overload.power_in / 48.0)


def test_the_temperatures_are_those_of_the_thermal_network(found, winding, brake, outcome):
    table = sheet(found, winding, brake, outcome).table
    assert value(table, "continuous torque", "the magnets bind") == 3.0
    assert value(table, "continuous line current", "40 °C") == pytest.approx(40.0 / sqrt(2))
    assert value(table, "hottest copper", "limit 155 °C") == 151.0 and value(table, "magnets", "limit 120 °C") == 120.0


def test_headline_numbers_carry_their_expanded_uncertainty(found, winding, brake, outcome):
    """U = 2 u in the unit of the value; rows without one carry none, groups without any no column."""
    sheet_of_it = sheet(found, winding, brake, outcome)
    table = sheet_of_it.table
    known = table[table.plus_minus.notna()]
    assert {"peak torque", "phase resistance", "torque constant", "base speed", "active parts"} <= set(known.quantity)
    sure = {"torque ripple", "cogging torque", "magnet flux linkage", "L_d", "L_q", "losses", "shaft", "rotor inertia"}
    assert sure <= set(known.quantity) and not sure & set(table.quantity[table.plus_minus.isna()])
    assert (known.quantity == "bus current").sum() == 2
    warm = known.quantity.isin(["hottest copper", "magnets"]) & (known.unit == "°C")
    expected = (0.01 * known.value.where(~warm, KNOWN.value)).astype(float)
    assert warm.sum() == 2 and known.plus_minus.tolist() == pytest.approx(expected.tolist()), "of the rise, in K"
    page = datasheet.section(sheet_of_it, None).content
    tables = {part.caption: part.frame for part in page if hasattr(part, "frame")}
    assert "plus_minus" not in tables["Dimensions and materials."]
    torques = tables["Torque, speed and supply."].set_index("quantity").plus_minus
    assert torques["peak torque"] == datasheet.plus_minus(0.01 * winding.peak_torque) and torques["bus voltage"] == ""
    assert [datasheet.plus_minus(one) for one in (0.2928, 51.91, 0.02256)] == ["0.29", "52", "0.023"]


@pytest.mark.parametrize("current, rows", [(80.0, 4), (inf, 3)])
def test_magnets_stand_on_the_sheet_where_their_grade_is_known(found, winding, brake, outcome, current, rows):
    inputs = SimpleNamespace(grade=load_grade("N42SH"), lost_max=0.01)
    magnets = SimpleNamespace(inputs=inputs, knee=0.28, temperature=120.0, states=STATES, demagnetising_current=current)
    groups = {group.title: group for group in sheet(found, winding, brake, outcome, magnets=magnets).groups}
    table = groups["Magnets"].table
    assert len(table) == rows and value(table, "volume beyond the knee", "overload") == pytest.approx(3.0)
    assert "Magnets" not in {group.title for group in sheet(found, winding, brake, outcome).groups}
    strong = SimpleNamespace(**vars(magnets) | {"states": STATES[:1]})
    assert (
        value(sheet(found, winding, brake, outcome, magnets=strong).table, "volume beyond the knee", "every state") == 0
    )


def test_every_row_has_its_unit_or_is_a_pure_number(found, winding, brake, outcome):
    table = sheet(found, winding, brake, outcome).table
    assert value(table, "electrical steel") == "35PN270" and value(table, "magnetisation") == "parallel"
    pure = set(table.quantity[table.unit == ""])
    words = {"electrical steel", "magnetisation", "connection", "insulation class"}
    assert pure == words | {"slots", "poles", "magnet arc", "layers", "winding factor", "turns",
                            "wires in hand", "packing factor", "insulated fill", "parallel paths"}  # fmt: skip
    assert not table.duplicated(["quantity", "condition"]).any()


def test_what_was_not_computed_is_not_on_the_sheet(bare, winding, brake, outcome):
    found = sheet(bare, winding, brake, outcome)
    quantities = set(found.table.quantity)
    assert "efficiency" not in quantities and "continuous torque" in quantities
    captions = [getattr(part, "caption", "") for part in datasheet.section(found, None).content]
    assert len(datasheet.section(found, MAP_OF_LOSSES).content) == len(captions) + 1, "with the efficiency map"
    assert "Constants." in captions and not [caption for caption in captions if caption.startswith("Losses")]


def test_a_shaft_has_no_wheel(found, winding, brake, outcome):
    text = sheet(found, winding, brake, outcome, Shaft()).table.to_csv()
    assert "wheel" not in text and "m/s" not in text and "at the shaft" in text


# ---- files ----------------------------------------------------------------------------------------------------------


def test_costs_stand_where_prices_do(found, bare):
    table = package_report.costs_table(found)
    assert table["cost EUR"].iloc[-1] == pytest.approx(table["cost EUR"].iloc[:-1].sum())
    assert list(package_report.costs_table(bare)) == ["part", "mass_kg", "inertia_kg_mm2"]
    assert table.inertia_kg_mm2.tolist() == pytest.approx([1e6 * one.inertia for one in found.costs]), "kg m2 inside"


def test_files(found, winding, brake, outcome, tmp_path):
    (tmp_path / "figures").mkdir()
    files = list(package_report.files(found, winding, sheet(found, winding, brake, outcome)))
    for one in files:
        one.write(tmp_path / one.name)
    table = pd.read_csv(tmp_path / "datasheet.csv")
    assert list(table) == ["quantity", "value", "plus_minus", "unit", "condition"] and len(table) > 50
    coils = pd.read_csv(tmp_path / "winding_connections.csv")
    assert len(coils) == 12 and set(coils.phase) == set("ABC")
    assert (coils["connected to"] == "star point").sum() == 3
    names = {one.name for one in files}
    assert names - set(package_report._FILES) == {"figures/lamination.png", "figures/winding_diagram.png"}
    assert set(package_report._FILES) <= names, "the report names files that are written"
    assert (tmp_path / "drawing.pdf").read_bytes()[:5] == b"%PDF-"
