"""Tables, files and sections of the field side, from a tiny sweep."""

import numpy as np
import pandas as pd
import pytest

import report.fields
import report.fits
import report.sweep
from figures.export import read_vtu
from geometry.family import Combination, StatedMachine
from magnetostatics.fields_stage import fields_stage
from magnetostatics.rotation import STATES
from optimisation.fits import fits_stage
from optimisation.freedom import AS_SWEPT
from optimisation.limits import LimitComparison, LimitPoint
from optimisation.optima import GridEdge, Optima, Optimum, optima_stage
from optimisation.states import AlignedTooth
from optimisation.sweep import SaturationLimit, SweepGrid, sweep_stage
from study.inputs_field import field_case
from study.read import read_study
from tasks import InThisProcess

CASE = field_case(read_study("motorcycle"))
LIMIT = SaturationLimit(AlignedTooth(), 1.2, (1.2,))
GRID = SweepGrid((Combination(12, 10),), (42.5e-3,), (0.065, 0.085), 4, (0.30, 0.38), 3)


@pytest.fixture(scope="module")
def maps():
    return sweep_stage(CASE, GRID, LIMIT, InThisProcess())


@pytest.fixture(scope="module")
def optima(maps):
    return optima_stage(CASE, maps, AS_SWEPT, InThisProcess())


def written(files, folder):
    """Names of all files that an export wrote."""
    for file in files:
        path = folder / file.name
        path.parent.mkdir(parents=True, exist_ok=True)
        file.write(path)
    return {str(path.relative_to(folder)) for path in folder.rglob("*.*")}


def paragraphs(section):
    return " ".join(part for part in section.content if isinstance(part, str))


def test_optima_and_maps_as_files(maps, optima, tmp_path):
    names = written(report.sweep.optima_files(optima, maps, CASE), tmp_path)
    assert names == {"optima.csv", "figures/design_map.png", "figures/design_maps.png"}
    row = pd.read_csv(tmp_path / "optima.csv").iloc[0]
    assert row.stator_diameter_mm == 85.0 and row.stator_outer_radius_mm == 42.5
    assert row.back_iron_width_mm == pytest.approx(optima.found[0].back_iron_width * 1e3)
    assert row.half_slot_area_mm2 == pytest.approx(optima.found[0].half_slot_area * 1e6)
    assert row.torque_nominal_Nm_per_m == pytest.approx(optima.found[0].torque_nominal)
    assert (row.reading, row.limit_T) == ("aligned_tooth", 1.2)


def test_maps_in_drawing_units(maps):
    shown = report.sweep.drawn_maps(maps, maps.grid.combinations[0]).sel(stator_diameter_mm=85.0)
    assert float(shown.rotor_outer_radius_mm[0]) == pytest.approx(0.30 * 42.5)
    assert np.array_equal(shown.torque_Nm_per_m, maps.data.torque[0, 0], equal_nan=True)


def test_an_edge_is_a_remark_of_the_report(maps, optima):
    edge = GridEdge(Combination(12, 10), 42.5e-3, "sweep.back_iron_fraction_min", 0.065, 0.064)
    section = report.sweep.section(CASE, maps, Optima(LIMIT, optima.found, (), (edge,)), None)
    assert any("lower sweep.back_iron_fraction_min" in getattr(part, "text", "") for part in section.content)
    assert "linear scaling from 6 A/mm²" in paragraphs(section)


def test_limits_as_files(tmp_path):
    points = (
        LimitPoint("aligned_tooth", 1.2, 55.8, 2.9e-3, 14.5e-3),
        LimitPoint("every_tooth_and_back_iron_over_period", 1.2, np.nan, np.nan, np.nan),
    )
    names = written(report.sweep.limits_files(LimitComparison(LIMIT, points)), tmp_path)
    assert names == {"limits.csv", "figures/limits.png"}
    table = pd.read_csv(tmp_path / "limits.csv")
    assert table.back_iron_width_mm[0] == pytest.approx(2.9) and np.isnan(table.torque_nominal_Nm_per_m[1])


def parabolas():
    """Optima of four radii with a torque of 0.03 R^2, R in mm."""
    rest = {"tooth_width": 5e-3, "torque_nominal_error": 0.1, "torque_overload_error": 0.1, "torque_null": np.nan}
    rest |= {"limited": 1.2, "limit_binds": True, "tooth_worst": 1.5, "back_iron_worst": 1.4}
    rest |= {"field_solutions": 20, "newton_iterations": 3, "combination": Combination(12, 10)}
    found = [
        Optimum(
            stator_outer_radius=r,
            back_iron_width=0.07 * r,
            rotor_outer_radius=0.35 * r,
            half_slot_area=0.06 * r**2,
            torque_nominal=3e4 * r**2,
            torque_nominal_ring=3e4 * r**2,
            torque_overload=7e4 * r**2,
            torque_overload_linear=1e5 * r**2,
            **rest,
        )
        for r in (0.035, 0.04, 0.045, 0.05)
    ]
    return Optima(LIMIT, tuple(found), (), ())


def test_fits_in_the_units_of_their_columns(tmp_path):
    optima = parabolas()
    fits = fits_stage(optima)
    assert written(report.fits.files(fits, optima), tmp_path) == {"fits.csv", "figures/fits.png"}
    rows = pd.read_csv(tmp_path / "fits.csv").set_index("quantity")
    assert rows.p2["torque_nominal_Nm_per_m"] == pytest.approx(0.03)
    assert rows.p1["back_iron_width_mm"] == pytest.approx(0.07)
    assert rows.p2["half_slot_area_mm2"] == pytest.approx(0.06)
    assert rows.from_mm.tolist() == pytest.approx([35.0] * 6) and rows.refused.isna().all()
    assert report.fits.section(fits).title == "Polynomials over the stator radius"


def test_fields_as_files(tmp_path, monkeypatch):
    monkeypatch.setattr("magnetostatics.rotation.COGGING_STEPS", 1)
    found = fields_stage(CASE, StatedMachine(CASE.family.reference), None, InThisProcess())
    figures = ("cross_section_reference", "rotation_reference", "field_reference_nominal")
    expected = {f"reference_{state}.vtu" for state in STATES} | {f"figures/{name}.png" for name in figures}
    assert written(report.fields.files(found, None, CASE), tmp_path) == expected | {"rotation_reference.csv"}
    table = pd.read_csv(tmp_path / "rotation_reference.csv")
    assert table.columns[:2].tolist() == ["angle_mech_deg", "torque_arkkio_Nm_per_m"]
    assert table.angle_mech_deg[0] == pytest.approx(-24.0) and "tooth_5_T" in table
    assert "28.284 A/mm²" in read_vtu(tmp_path / "reference_overload.vtu").description
    assert report.fields.matched(found, None) is None
    assert "mean torque" in paragraphs(report.fields.machine(found))
