"""What can be found before computing is found then, and said in one sentence with key, value and way out."""

import csv
import re

import pytest

from materials.library import read_curve, steel_file
from pipeline.cli import main
from study.errors import StudyError
from study.inputs_machine import machine_family, mesh_density
from study.operating_point import asked_point
from study.read import STUDIES, read_study
from study.usable import check_mesh, check_study


def refusal(overrides, study="motorcycle") -> str:
    with pytest.raises(StudyError) as caught:
        check_study(read_study(study, overrides))
    text = str(caught.value)
    assert text.count("\n") == 0 and text.endswith(".") and len(text) < 600, text
    return text


WRONG = {
    "no design of one diameter": (
        ["sweep.stator_diameters_mm=[20, 80, 90, 100, 110]"],
        ["sweep.slots = 9", "sweep.stator_diameters_mm = 20", "inside the shaft of radius 5.000 mm"],
    ),
    "no design of one slot count": (
        ["sweep.slots=[12, 24]", "machine.poles=8", "machine.tooth_width_mm=5"],
        ["sweep.slots = 24", "sweep.back_iron_fraction_*", "leave that number out"],
    ),
    "three diameters": (["sweep.stator_diameters_mm=[80, 90, 100]"], ["stator_diameters_mm names 3", "add 1"]),
    "thick wire": (
        ["winding_selection.wire_diameters_mm=[2.0]", "winding_selection.insulated_fill_max=0.01"]
        + ["sweep.stator_diameters_mm=[60, 62, 64, 66]"],
        ["wire_diameters_mm = [2.0]", "0.01 with enamel", "thinner wire"],
    ),
    "a wire that is not sold": (["winding_selection.wire_diameters_mm=[0.52]"], ["take 0.5 or 0.56"]),
    "no wire": (["winding_selection.wire_diameters_mm=[]"], ["wire_diameters_mm"]),
    "a wire twice": (["winding_selection.wire_diameters_mm=[0.5, 0.5]"], ["names a value twice"]),
    "unequal paths": (["winding_selection.parallel_paths=[1, 4]"], ["parallel_paths = 4", "star of slots", "[1, 2]"]),
    "unknown class": (['winding_selection.insulation_class="Z"'], ["winding_selection.insulation_class"]),
    "very fine mesh": (
        ["mesh.elements_across_tooth=40"],
        ["a design of the sweep", "reduce mesh.elements_across_tooth (now elements_across_tooth = 40.0)"],
    ),
    "very many edges": (["mesh.gap_edges_per_revolution=14400"], ["reduce mesh.gap_edges_per_revolution", "14400"]),
    "poles without a winding": (
        ["sweep.poles=[10, 12]"],
        ["sweep.slots = 12", "sweep.poles = 12", "cannot carry this winding"],
    ),
    "many slots and poles": (
        ["machine.slots=180", "machine.poles=178", "machine.slot_opening_mm=0.1", "machine.tooth_width_mm=0.3"]
        + ["sweep.slots=[180]"],
        ["180 and 178 meet", "change slots or poles"],
    ),
    "coil pitch of whole pole pairs": (
        ["winding.coil_pitch=12", "machine.slots=18", "machine.poles=6", "sweep.slots=[18]"],
        ["winding.coil_pitch = 12", "links no flux"],
    ),
    "coil pitch of one slot count only": (
        ["winding.coil_pitch=9", "machine.slots=12"],
        ["sweep.slots = 9", "winding.coil_pitch = 9", "lies between 1 and 8"],
    ),
    "single layer, even pitch": (["winding.layers=1", "winding.coil_pitch=2"], ["winding.coil_pitch = 2", "odd"]),
    "force": (["requirements.force_rms_N=3000"], ["force_rms_N = 3000 above force_peak_N = 2614"]),
    "velocity": (["requirements.velocity_rms_m_per_s=4"], ["velocity_rms_m_per_s = 4 above velocity_peak_m"]),
    "power": (["requirements.power_rms_W=5000"], ["power_rms_W = 5000 above power_peak_W"]),
    "velocity at the peak force": (["requirements.velocity_at_force_peak_m_per_s=5"], ["force_peak_m_per_s = 5"]),
    "force at the peak power": (["requirements.force_at_power_peak_N=5000"], ["force_at_power_peak_N = 5000"]),
    "power beyond force and velocity": (["requirements.power_peak_W=20000"], ["power_peak_W = 20000", "= 8887.6"]),
    "current densities": (["sweep.j_nominal_rms_A_per_mm2=30"], ["j_nominal_rms_A_per_mm2 = 30 not below"]),
    "linkage": (["linkage.ratio_nominal_mm_per_rad=180"], ["ratio_nominal_mm_per_rad = 180 above ratio_max"]),
}  # fmt: skip


@pytest.mark.parametrize("overrides, named", WRONG.values(), ids=WRONG.keys())
def test_one_sentence_before_anything_is_computed(overrides, named):
    text = refusal(overrides)
    assert all(part in text for part in named), text


@pytest.mark.parametrize("factor, column", [((1, 1e3), "B_T"), ((1, 1e4), "B_T"), ((1e-3, 1), "H_A_per_m")])
def test_a_curve_in_the_wrong_unit_names_its_column(tmp_path, factor, column):
    _, fields, fluxes = read_curve(steel_file("M270-35A"))
    rows = [(factor[0] * h, factor[1] * b) for h, b in zip(fields, fluxes)]
    with open(tmp_path / "mine.csv", "w", newline="") as file:
        csv.writer(file).writerows([("H_A_per_m", "B_T"), *rows])
    text = refusal([f"materials.steel='{tmp_path / 'mine.csv'}'"])
    assert "materials.steel" in text and f"column {column} looks wrong" in text


def test_a_few_designs_that_cannot_be_built_are_fine():
    check_study(read_study("motorcycle", ["machine.tooth_width_mm=6"]))


@pytest.mark.parametrize(
    "zero", ["maximum_damping_kNs_per_m", "velocity_rms_m_per_s", "power_rms_W", "velocity_at_force_peak_m_per_s"]
)
def test_requirements_that_mean_something_may_be_zero(zero):
    study = read_study("motorcycle", [f"requirements.{zero}=0"])
    assert getattr(study.requirements, zero) == 0


def test_three_slots_and_two_poles_can_be_meshed():
    study = read_study("motorcycle", ["machine.slots=3", "machine.poles=2", "sweep.slots=[3]"])
    check_mesh(study, machine_family(study.machine).reference, mesh_density(study.mesh))


def test_the_check_says_it_and_exits_with_2(capsys):
    with pytest.raises(SystemExit) as caught:
        main(["check", "motorcycle", "--set", "sweep.stator_diameters_mm=[80, 90, 100]"])
    assert caught.value.code == 2
    out, said = capsys.readouterr()
    assert out == "" and re.fullmatch(r"studies/motorcycle\.toml: .*\n", said)


@pytest.mark.parametrize("study", sorted(path.stem for path in STUDIES.glob("*.toml")))
def test_the_shipped_studies_are_usable(study, capsys):
    main(["check", study])
    assert capsys.readouterr().out.endswith("usable\n")


SENSELESS = {
    "angle": ((1e300, 0.0, 0.0), "--angle-deg must be a finite number of degrees, at most 360000 either way"),
    "angle, NaN": ((float("nan"), 0.0, 0.0), "found nan"),
    "current angle": ((0.0, 6.0, float("inf")), "--current-angle-deg must be"),
    "current": ((0.0, 1e9, 0.0), "found 1e+09"),
    "negative current": ((0.0, -1.0, 0.0), "zero or more and at most 1000 A/mm2 (amplitude), found -1"),
    "current, NaN": ((0.0, float("nan"), 0.0), "found nan"),
}


@pytest.mark.parametrize("numbers, named", SENSELESS.values(), ids=SENSELESS.keys())
def test_an_operating_point_that_makes_no_sense_is_refused(numbers, named):
    with pytest.raises(StudyError) as caught:
        asked_point(*numbers)
    assert named in str(caught.value) and str(caught.value).endswith(".")


def test_an_operating_point_in_si():
    point = asked_point(180.0, 10.0, -90.0)
    assert point.angle == pytest.approx(3.14159265) and point.amplitude == 1e7
    assert point.current_angle == pytest.approx(-1.570796327)
