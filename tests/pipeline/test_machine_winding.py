"""The winding of machines of other kinds, chosen on their maps: what is chosen does in the field what is said of it."""

import csv
import re
import tomllib
from dataclasses import replace
from math import atan2, hypot, pi
from pathlib import Path

import pytest

from electrical import turning_stage
from electrical.point_field import FieldPoints
from electrical.point_winding_stage import Candidates, PointWinding, PointWindingInputs
from magnetostatics.case import FieldCase
from magnetostatics.flux_map import map_angles
from magnetostatics.flux_map_stage import FluxMap
from magnetostatics.turn import Supply, turned
from pipeline.graph import Stage
from pipeline.machine_stages import graph_of_machine
from pipeline.modules import PROJECT
from pipeline.results import Results
from pipeline.run import Run
from processes import ThisProcess
from report.stated_machine import MachineSheet
from study.machine_file import MACHINES, read_machine
from study.machine_winding import read_points, read_selection
from tests.command_line import airgap

MAP = """
[flux_map]
angles = {angles}
currents = {currents}
[mesh]
gap_edges_per_revolution = {edges}
gap_layers = 1
elements_across_iron = 1.0
"""
DRAWN = ("candidates", "winding", "points")
OUTRUNNER = """
[winding_selection]
wire_diameters_mm = [0.2, 0.315]
enamel_grade = 1
packing_factor = 0.35
packing_tolerance = 0.0
j_overload_rms_A_per_mm2 = 20.0
parallel_paths = [1, 3, 7]
connections = ["star", "delta"]

[[operating_points]]
torque_Nm = 0.004
speed_rpm = 4000.0

[[operating_points]]
torque_Nm = 0.003
speed_rpm = 8000.0
"""
V_SHAPE = """
[winding_selection]
wire_diameters_mm = [0.9]
enamel_grade = 1
packing_factor = 0.45
packing_tolerance = 0.0
j_overload_rms_A_per_mm2 = 20.0
parallel_paths = [4]

[[operating_points]]
torque_Nm = 250.0
speed_rpm = 1500.0

[[operating_points]]
torque_Nm = 50.0
speed_rpm = 6000.0
"""
RELUCTANCE = """
[winding_selection]
wire_diameters_mm = [0.71]
enamel_grade = 1
packing_factor = 0.4
packing_tolerance = 0.0
j_overload_rms_A_per_mm2 = 12.0

[[operating_points]]
torque_Nm = 9.0
speed_rpm = 1500.0

[[operating_points]]
torque_Nm = 3.0
speed_rpm = 4500.0
"""


def written(name, selection, folder, *, angles, currents, edges):
    """A shipped machine with a winding that is to be chosen: no turns, no wire; on a coarse mesh, without losses."""
    text = (MACHINES / f"{name}.toml").read_text(encoding="utf-8")
    drawn = text[: min(text.index("[search]"), text.index("[mesh]"))].replace('"curves/', f'"{MACHINES}/curves/')
    drawn = re.sub(r"(?m)^(turns_per_coil|wire_diameter_mm|wires_in_hand|loss_grade).*\n", "", drawn)
    path = folder / f"{name}.toml"
    path.write_text(drawn + selection + MAP.format(angles=angles, currents=currents, edges=edges), encoding="utf-8")
    return path


def run_to(last, path, folder):
    """Pictures only of the winding: the others are drawn elsewhere."""
    graph = graph_of_machine(read_machine(path))
    drawn = [replace(one, files=None) if isinstance(one, Stage) and one.name not in DRAWN else one
             for one in graph.nodes]  # fmt: skip
    graph = replace(graph, nodes=tuple(drawn))
    run = Run(graph, read_machine(path), Results(folder), ThisProcess())
    run.all(graph.before(graph.stage(last)))
    assert not run.failures
    return run


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """Of a name with its selection and points of the map: what the run has made, each once."""
    made = {}

    def of(name, selection, **points):
        if name not in made:
            folder = tmp_path_factory.mktemp(name)
            made[name] = run_to("points", written(name, selection, folder, **points), folder / "out")
        return made[name]

    return of


KINDS = {
    "outrunner_9_12": (OUTRUNNER, {"angles": 1, "currents": 6, "edges": 108}),
    "v_48_8": (V_SHAPE, {"angles": 1, "currents": 11, "edges": 192}),
    "synrm_48_4": (RELUCTANCE, {"angles": 1, "currents": 7, "edges": 144}),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_the_chosen_winding_does_in_the_field_what_was_said_of_it(found, name):
    """Coils of real turns, each with the current of its path, solved anew at the least current of every point.

    Torque by flux linkage and current, voltage with the resistance of real wires: as the stage says of the field to
    round-off, and as the map says within its stated error, or the 1 % that its splines leave in deep field weakening.
    """
    selection, points = KINDS[name]
    run = found(name, selection, **points)
    chosen, driven = run.value(PointWinding).chosen, run.value(PointWinding).driven
    flux_map, design, wound = run.value(FluxMap), chosen.winding.design, driven.wound
    off = max(flux_map.torque_error, 0.01)
    model, pole_pairs = run.value(FieldCase).model(wound.machine), wound.machine.pole_pairs
    paths = design.connection.paths
    assert not design.connection.closing.circulates
    copper = design.strands * pi / 4 * design.wire.copper_diameter**2
    turn = 2 * (wound.active_length + wound.end_turn_length)
    ohms = design.wire.resistivity * turn * design.turns * wound.coils_in_series / paths / copper / paths
    assert chosen.winding.phase_resistance == pytest.approx(ohms, rel=1e-9)
    said = run.value(FieldPoints).points
    assert [one.asked for one in said] == list(run.value(PointWindingInputs).points)
    for one in said:
        d, q = one.direct, one.quadrature
        assert one.current <= chosen.needed_current * (1 + 1e-9)
        coil = Supply(one.current / paths, atan2(-d, q), design.turns)
        at = map_angles(model, points["angles"])
        psi_d, psi_q = turned(model, coil, wound.active_length, at).dq_linkage.mean(axis=0) / paths
        torque = 1.5 * pole_pairs * (psi_d * q - psi_q * d)
        omega = pole_pairs * one.asked.speed
        voltage = hypot(ohms * d - omega * psi_q, ohms * q + omega * psi_d)
        assert (one.torque, one.voltage) == pytest.approx((torque, voltage), rel=1e-6)
        assert torque == pytest.approx(one.asked.torque / (1 - flux_map.torque_error), rel=off)
        assert voltage == pytest.approx(one.map_voltage, rel=off)
        assert one.map_voltage <= driven.limits.voltage_peak + 1e-6
    assert max(one.current for one in said) == pytest.approx(chosen.needed_current, rel=1e-6)


def test_a_reluctance_machine_is_weakened_with_its_salient_torque_alone(found):
    run = found("synrm_48_4", RELUCTANCE, **KINDS["synrm_48_4"][1])
    driven = run.value(PointWinding).driven
    machine = driven.wound.on_map(run.value(FluxMap).data)
    assert abs(machine.flux_linkage(0.0, 0.0)[0]) < 1e-3 * machine.flux_linkage(driven.limits.current_peak, 0.0)[0]
    assert run.value(PointWinding).chosen.winding.inductance_d > 2 * run.value(PointWinding).chosen.winding.inductance_q


def test_every_candidate_fills_the_slot_and_says_what_refuses_it(found):
    run = found("outrunner_9_12", OUTRUNNER, **KINDS["outrunner_9_12"][1])
    candidates = run.value(Candidates)
    assert candidates.left_out == (7,) and {one.refused_by for one in candidates.valued} >= {"", "line current"}
    for one in candidates.valued:
        design = one.winding.design
        assert one.winding.packing <= 0.35 < (design.turns * (design.strands + 1)) * design.wire.area / (
            candidates.coil_side_area
        ) or one.winding.insulated_fill <= 0.55
        assert bool(one.refused_by) == any(
            torque < point.torque for torque, point in zip(one.torques, candidates.inputs.points, strict=True)
        ) or one.refused_by == "current round the delta"


def test_from_the_points_to_the_sheet_and_what_is_kept_where_none_will_do(tmp_path, found, monkeypatch):
    monkeypatch.setattr(turning_stage, "STEPS", 2)
    path = written("outrunner_9_12", OUTRUNNER, tmp_path, **KINDS["outrunner_9_12"][1])
    out = found("outrunner_9_12", OUTRUNNER, **KINDS["outrunner_9_12"][1]).results.folder
    run = run_to("sheet", path, out)
    with open(out / "windings.csv", encoding="utf-8") as file:
        assert {"reaches every point"} < {row["verdict"] for row in csv.DictReader(file)}
    with open(out / "winding_alternatives.csv", encoding="utf-8") as file:
        (chosen,) = [row for row in csv.DictReader(file) if row["verdict"] == "chosen"]
    rows = run.value(MachineSheet).sheet.table.set_index(["quantity", "condition"]).value
    assert rows["turns", "of one coil"] == int(chosen["turns"])
    asked = rows["largest torque at 4000 rpm", "asked are 0.004 Nm"]
    assert asked == pytest.approx(float(chosen["torque_at_4000_rpm_Nm"])) and asked >= 0.004
    (said,) = [one for one in run.sections() if one.title == "Winding"]
    assert "reach every point" in said.content[0] and (out / "figures" / "torque_speed.png").is_file()

    path.write_text(path.read_text(encoding="utf-8").replace("torque_Nm = 0.004", "torque_Nm = 1.0"), encoding="utf-8")
    refused = airgap("machine", path, "--out", out, "--jobs", 1)
    said = "raise j_overload_rms_A_per_mm2 or packing_factor in [winding_selection] or ask for less"
    assert refused.returncode == 1 and said in refused.stderr and "flux_map: unchanged" in refused.stdout
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "This run could not go on" in page and "Nothing was chosen" in page
    with open(out / "windings.csv", encoding="utf-8") as file:
        assert all("asked are 1 Nm" in row["verdict"] for row in csv.DictReader(file))


WRONG = {
    "elsewhere": ("enamel_grade = 1", "enamel_grade = 1\nphase_current_max_rms_A = 20.0", "in [drive] as line_"),
    "near": ("packing_factor", "packing_facter", "did you mean packing_factor"),
    "range": ("packing_factor = 0.35", "packing_factor = 3.5", "outside the allowed range; give 0.05 to 0.95"),
    "lacks": ("packing_factor = 0.35\n", "", "[winding_selection] lacks packing_factor; add it: a number (copper over"),
    "kind": ("enamel_grade = 1", 'enamel_grade = "1"', 'enamel_grade = "1" is not accepted; give an integer'),
    "closing": ('["star", "delta"]', '["zigzag"]', "connections"),
    "point": ("torque_Nm = 0.003", "torque_Nm = -1.0", "[[operating_points]] torque_Nm = -1.0 is outside"),
    "fast": ("speed_rpm = 8000.0", "speed_rpm = 13000.0", "is beyond speed_max_rpm = 12000 of [drive]"),
    "no points": (OUTRUNNER[OUTRUNNER.index("[[") :], "", "add [[operating_points]] with torque_Nm and speed_rpm"),
    "points alone": (
        OUTRUNNER[: OUTRUNNER.index("[[")], "", "[[operating_points]] are for a winding to be chosen: add [winding_sel"
    ),
    "gauge": ("[0.2, 0.315]", "[0.21]", "no wire of 0.21 mm is in the table"),
    "thick": ("[0.2, 0.315]", "[2.0]", "does not fit"),
    "paths": ("[1, 3, 7]", "[2]", "have equal paths for"),
}  # fmt: skip


@pytest.mark.parametrize("old, new, words", WRONG.values(), ids=WRONG)
def test_one_sentence_about_what_is_wrong(tmp_path, found, old, new, words):
    """In the file, before anything is solved; what only the map tells, from a map that is there."""
    path = written("outrunner_9_12", OUTRUNNER.replace(old, new), tmp_path, **KINDS["outrunner_9_12"][1])
    kept = found("outrunner_9_12", OUTRUNNER, **KINDS["outrunner_9_12"][1]).results.folder
    done = airgap("machine", path, "--out", kept, "--to", "candidates", "--jobs", 1)
    (said,) = [line for line in done.stderr.splitlines() if words in line]
    assert done.returncode != 0 and said.count(". ") == 0


def test_the_example_of_the_readme_is_one():
    text = (PROJECT / "README.md").read_text(encoding="utf-8")
    stated = tomllib.loads(re.search(r"```toml\n(\[winding_selection\].*?)```", text, re.DOTALL)[1])
    assert read_selection(Path("README.md"), stated).parallel_paths == (1, 2, 4)
    assert [one.torque_Nm for one in read_points(Path("README.md"), stated)] == [250.0, 50.0]


def test_turns_that_are_to_be_chosen_are_missed_where_a_winding_is_needed(tmp_path):
    path = written("outrunner_9_12", OUTRUNNER, tmp_path, **KINDS["outrunner_9_12"][1])
    done = airgap("turn", path)
    assert done.returncode != 0 and "[winding] lacks turns_per_coil; add it" in done.stdout + done.stderr
