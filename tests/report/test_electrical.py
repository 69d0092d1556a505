"""What people read of flux map, winding and drive: files under their names, sections with the one peak torque."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from drivetrain.gear_views import braking_demand
from drivetrain.output import Wheel
from electrical.braking_stage import CopperHeat, braking_stage
from electrical.drive_stage import drive_stage
from electrical.driven_machine import driven_machine
from electrical.winding_stage import winding_stage
from figures.report import render_report
from report import braking, drive
from report import flux_map as map_report
from report import winding as winding_report
from tests.electrical.analytic_map import (
    DEMAND,
    GOOD,
    INPUTS,
    MATCHED,
    REQUIRED,
    TRANSMISSION,
    Saturating,
    flux_map,
)
from tests.electrical.wires import series_star
from units import RPM

MAP = flux_map(Saturating())


@pytest.fixture(scope="module")
def winding():
    return winding_stage(MAP, MATCHED, DEMAND, INPUTS, GOOD)


@pytest.fixture(scope="module")
def driven(winding):
    return drive_stage(MAP, winding, driven_machine(winding, INPUTS), INPUTS)


def written(files, folder):
    (folder / "figures").mkdir()
    for one in files:
        one.write(folder / one.name)
    return folder


def test_files_of_the_flux_map(winding, tmp_path):
    written(map_report.files(MAP, winding), tmp_path)
    with np.load(tmp_path / "flux_map_export.npz") as tables:
        assert tables["pole_pairs"] == 5 and tables["torque"].max() > 1
    assert (tmp_path / "flux_map_export.mat").stat().st_size > 1000


def test_table_of_windings(winding, tmp_path):
    table = pd.read_csv(written(winding_report.files(winding), tmp_path) / "windings.csv")
    chosen = table[table.chosen]
    assert len(chosen) == 1 and len(table) == len(winding.table)
    assert chosen.base_speed_rpm.item() == pytest.approx(winding.chosen.base_speed / RPM)
    assert chosen.phase_to_phase_resistance_mOhm.item() == pytest.approx(2e3 * winding.wound.phase_resistance)
    assert table.maximum_power_W.notna().sum() == len(winding.near)


def test_alternatives_say_what_was_chosen_and_why_the_others_were_not(tmp_path):
    """One row for each gauge and number of paths; paths that the star of slots has not are said."""
    thin = replace(INPUTS.wires[0], copper_diameter=4e-4, outer_diameter=4.39e-4)
    inputs = replace(INPUTS, wires=(thin, *INPUTS.wires), paths=(1, 2, 3))
    found = winding_stage(MAP, MATCHED, DEMAND, inputs, GOOD)
    table = pd.read_csv(written(winding_report.files(found), tmp_path) / "winding_alternatives.csv")
    assert sorted(zip(table.wire_mm, table.paths)) == [(0.4, 1), (0.4, 2), (0.5, 1), (0.5, 2)]
    chosen = table[table.verdict == "chosen"]
    assert chosen.turns.item() == found.chosen.turns and chosen.paths.item() == found.chosen.design.connection.paths
    assert table.verdict[table.verdict != "chosen"].str.contains("%|less copper|as good").all()
    section = winding_report.section(found, inputs, None)
    page = render_report((section,), tmp_path, title="winding")
    assert "Paths by the number of 3 would not be equal" in page and str(found.chosen.design) in page
    assert found.left_out == (3,) and list(winding_report.remarks(found, inputs, None))[-1].startswith("Paths by")


def test_files_of_the_drive(driven, winding, tmp_path):
    folder = written(drive.files(driven, winding, MAP, TRANSMISSION, REQUIRED, Wheel()), tmp_path)
    envelope = pd.read_csv(folder / "flux_map_envelope.csv")
    columns = (("torque", "Nm"), ("power", "W"), ("i_d", "A"), ("i_q", "A"), ("voltage", "V"))
    wanted = [f"{quantity}_{model}_{unit}" for model in ("field", "constant") for quantity, unit in columns]
    assert list(envelope) == ["speed_rpm", *wanted, "i_d_mtpv_A", "i_q_mtpv_A"]
    assert envelope.torque_field_Nm[0] == pytest.approx(winding.peak_torque)
    both = pd.read_csv(folder / "windings_field.csv")
    assert {"base_speed_field_rpm", "base_speed_constant_rpm", "peak_torque_field_Nm", "chosen"} <= set(both)
    pictures = "flux_map field_envelope torque_speed force_velocity force_velocity_field".split()
    assert sorted(path.stem for path in (folder / "figures").iterdir()) == sorted(pictures)


@pytest.mark.parametrize(("turns", "strands", "said"), [(1, 1, "1 turn of 1 wire in hand, star"),
                                                        (15, 11, "15 turns of 11 wires in hand, star")])  # fmt: skip
def test_figures_count_the_wires_in_words(turns, strands, said):
    assert drive._name(SimpleNamespace(field=SimpleNamespace(design=series_star(turns, strands)))) == said


def test_the_peak_torque_is_one_number_in_the_report(driven, winding):
    said = f"{winding.peak_torque:.3f} ± {winding.peak_torque_error:.3f} Nm"
    assert said in drive.section(driven, winding, Wheel()).content[0]
    numbers = winding_report.section(winding, INPUTS, None).content[0].numbers
    key = next(one for one in numbers if one.name == "peak torque")
    assert key.value == winding.peak_torque
    assert winding_report.windings_table(winding).query("chosen").peak_torque_Nm.item() == pytest.approx(key.value)
    assert drive.windings_table(driven, winding).query("chosen").peak_torque_field_Nm.item() == pytest.approx(key.value)


def test_sections_can_be_printed(winding):
    match = SimpleNamespace(chosen=SimpleNamespace(active_length=0.04))
    sections = (map_report.section(MAP), winding_report.section(winding, INPUTS, match))
    page = render_report(sections, title="", subtitle="")
    assert "Newton iterations" in page and "instead of the 40.00 mm of the match, set by the peak torque" in page


@pytest.fixture(scope="module")
def brake(winding):
    return braking_stage(
        MAP, winding, INPUTS, braking_demand(REQUIRED, TRANSMISSION), CopperHeat(20.0, 120.0, 1.0, 1.393)
    )


def test_files_of_the_brake(brake, tmp_path):
    table = pd.read_csv(written(braking.files(brake, Wheel()), tmp_path) / "braking.csv")
    assert table.velocity_m_per_s.iloc[-1] == pytest.approx(REQUIRED.velocity_peak)
    shorted, controlled = table.force_shorted_hot_N, table.force_controlled_hot_N
    assert controlled.iloc[0] > 10 * shorted.iloc[0] and (controlled.dropna() > 0).all()
    slow = table.damping_shorted_cold_kNs_per_m.iloc[0] / table.damping_shorted_hot_kNs_per_m.iloc[0]
    assert slow == pytest.approx(1.393, rel=0.02), "far below the pole the damping is that of the resistance"


def test_the_section_says_up_to_where_the_damping_holds(brake):
    assert (braking.summary_table(brake, Wheel())["holds up to"] == "no speed").iloc[0], "40 kNs/m are too much for it"
    brake = replace(brake, demand=replace(brake.demand, damping=0.5 * brake.damping(brake.hot)[0]))
    table = braking.summary_table(brake, Wheel())
    slow = f"damping at {Wheel().at_speed(brake.speed[0])} / (kNs/m)"
    assert table[slow].iloc[0] * 1e3 == pytest.approx(brake.damping(brake.cold)[0]), "each damping with its speed"
    cold, hot, controlled = (brake.held_up_to(one) for one in (brake.cold, brake.hot, brake.controlled))
    assert brake.poles[0] < brake.poles[1] and max(cold, hot) < controlled
    assert np.interp(hot, brake.speed, brake.damping(brake.hot)) == pytest.approx(brake.demand.damping, rel=1e-3)
    assert list(table["holds up to"]) == [Wheel().at_speed(speed) for speed in (cold, hot, controlled)]
    assert any(Wheel().at_speed(hot) in line for line in braking.remarks(brake, Wheel()))


def test_a_back_emf_beyond_the_bus_is_said(brake):
    (line,) = [line for line in braking.remarks(brake, Wheel()) if "back-EMF" in line]
    assert f"{brake.back_emf:.0f} V" in line and "48 V" in line
    assert not [line for line in braking.remarks(replace(brake, bus_voltage=1e4), Wheel()) if "back-EMF" in line]
