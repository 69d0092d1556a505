"""A machine of any kind on a page: what stands in the sheet is what one turn at one current says."""

import csv

import pytest

from losses import map as loss_map
from study.machine_file import MACHINES
from tests.command_line import airgap

COARSE = """[flux_map]
angles = 2
currents = 7
[mesh]
gap_edges_per_revolution = 144
gap_layers = 1
elements_across_iron = 1.0
"""


@pytest.fixture
def quick(monkeypatch):
    """Losses at few currents; the stages do the rest as ever."""
    for name in ("DIRECT", "MAGNETISING", "QUADRATURE"):
        monkeypatch.setattr(loss_map, name, getattr(loss_map, name)[:1] + (0.25, 0.5, 1.0))


def coarse(name, folder):
    """A shipped machine as it is drawn, on a coarse mesh, beside its curves."""
    text = (MACHINES / f"{name}.toml").read_text(encoding="utf-8")
    drawn = text[: min(text.index("[search]"), text.index("[mesh]"))]
    text = drawn.replace('"curves/', f'"{MACHINES}/curves/') + COARSE
    path = folder / f"{name}.toml"
    path.write_text(text, encoding="utf-8")
    return path


def sheet(folder):
    with open(folder / "sheet.csv", encoding="utf-8") as file:
        return [(row["quantity"], row["value"], row["condition"]) for row in csv.DictReader(file)]


def value(rows, quantity, condition=""):
    return next(float(v) for name, v, said in rows if name == quantity and condition in said)


@pytest.mark.slow
def test_an_outer_rotor_from_its_map_to_its_sheet(tmp_path, quick):
    path = coarse("outrunner_9_12", tmp_path)
    done = airgap("run", path, "--out", tmp_path / "out", "--jobs", 1)
    assert done.returncode == 0, done.stderr
    rows = sheet(tmp_path / "out")
    assert value(rows, "magnet flux linkage") == pytest.approx(0.2763, rel=5e-3)  # mWb, another code, fine mesh
    assert value(rows, "magnets") == pytest.approx(41.7e-6 * 7e-3 * 7500, rel=1e-2)
    peak, ohms = value(rows, "peak torque"), 1e-3 * value(rows, "resistance between terminals") / 2
    assert value(rows, "torque constant") == pytest.approx(peak / 12)
    assert value(rows, "motor constant") == pytest.approx(peak / (1.5 * ohms * 12**2) ** 0.5)
    assert "air radius" not in {name for name, *_ in rows}, "only the model ends there"
    assert value(rows, "L_d", "no load") == pytest.approx(value(rows, "L_q", "no load"), rel=0.02)
    turn = airgap("turn", path, "--current-A", 12, "--positions", 24, "--span-deg", 10)
    said = next(line for line in turn.stdout.splitlines() if line.startswith("torque, mean"))
    assert value(rows, "peak torque") == pytest.approx(float(said.split()[6]), rel=2e-3), "by fluxes"
    assert {"report.html", "lamination_rotor.dxf", "turn.csv"} <= {one.name for one in (tmp_path / "out").iterdir()}


@pytest.mark.slow
def test_a_reluctance_machine_runs_on_its_magnetising_current(tmp_path, quick):
    path = coarse("synrm_48_4", tmp_path)
    path.write_text(path.read_text(encoding="utf-8").replace("loss_grade", "# loss_grade"), encoding="utf-8")
    done = airgap("machine", path, "--out", tmp_path / "out", "--to", "sheet", "--jobs", 1)
    assert done.returncode == 0, done.stderr
    rows = sheet(tmp_path / "out")
    of_magnets = {"magnet flux linkage", "magnets", "cogging torque", "magnet loss"}
    assert not of_magnets & {name for name, *_ in rows}
    assert all(value(rows, f"largest flux density, layer {layer} bridge") > 1.0 for layer in range(3))
    assert value(rows, "L_d", "no load") > 4 * value(rows, "L_q", "no load")
    assert value(rows, "peak torque") > 10 and not (tmp_path / "out" / "magnets.dxf").exists()


def test_a_model_of_a_bench_is_refused_for_a_machine(tmp_path):
    done = airgap("run", coarse("outrunner_9_12", tmp_path), "--with", tmp_path / "model.toml")
    assert done.returncode == 2 and "is a machine's file" in done.stderr


VARIABLES = """
[search]
flux_density_max_T = 1.3
samples = 8

[[variables]]
name = "teeth"
moves = ["stator.tooth_width"]
by_mm = [-0.5, 0.3]
"""


@pytest.mark.slow
def test_dimensions_are_bettered_until_the_iron_is_as_saturated_as_it_may_be(tmp_path):
    """Thinner teeth leave more room for copper; the limit of the flux density ends that."""
    path = coarse("outrunner_9_12", tmp_path)
    path.write_text(path.read_text(encoding="utf-8") + VARIABLES, encoding="utf-8")
    done = airgap("machine", path, "--out", tmp_path / "out", "--to", "search", "--jobs", 1)
    assert done.returncode == 0, done.stderr
    with open(tmp_path / "out" / "designs.csv", encoding="utf-8") as file:
        best, *sampled = csv.DictReader(file)
    held = [float(one["motor_constant_Nm_per_sqrtW"]) for one in sampled if max(iron(one)) <= 1.3]
    assert float(best["motor_constant_Nm_per_sqrtW"]) >= max(held)
    assert max(iron(best)) == pytest.approx(1.3, rel=5e-3) and max(iron(best)) <= 1.3
    assert -0.5 < float(best["teeth (mm)"]) < -0.1


def iron(row):
    return float(row["tooth_T"]), float(row["back_iron_T"])


WRONG = {
    "stator.tooth_widht": "is no dimension in mm; take of stator.bore_radius",
    "rotor.arc_fraction": "is no dimension in mm",
}


@pytest.mark.parametrize("dimension", WRONG)
def test_a_dimension_that_is_not_there_is_said(tmp_path, dimension):
    path = coarse("outrunner_9_12", tmp_path)
    path.write_text(path.read_text() + VARIABLES.replace("stator.tooth_width", dimension), encoding="utf-8")
    done = airgap("machine", path, "--out", tmp_path / "out")
    assert done.returncode == 2 and WRONG[dimension] in done.stdout + done.stderr


def test_a_file_without_a_drive_is_told_the_key_that_lacks(tmp_path):
    path = coarse("outrunner_9_12", tmp_path)
    path.write_text(path.read_text().replace("dc_bus_voltage_V = 12.0\n", ""))
    done = airgap("machine", path, "--out", tmp_path / "out")
    assert done.returncode != 0 and "[drive] lacks dc_bus_voltage_V" in done.stdout + done.stderr
