"""The magnets of a study: stated, or of a grade, and never both in contradiction."""

import pytest

from materials.magnet_grade import load_grade
from study.errors import StudyError
from study.inputs_electrical import loss_inputs
from study.inputs_field import machine_materials
from study.inputs_magnets import magnet_inputs
from study.inputs_match import part_materials
from study.magnet_choice import design_magnet, magnet_density
from study.read import STUDIES, read_study
from study.usable import check_magnets

MOTORCYCLE = STUDIES / "motorcycle.toml"
STATED = ("magnet_grade", "remanence_T", "recoil_permeability", "magnet_density_kg_per_m3")


def study_with(folder, without=(), **materials):
    """The motorcycle's with other magnets; without: keys that it does not state."""
    lines = MOTORCYCLE.read_text(encoding="utf-8").splitlines()
    gone = (*without, *materials)
    lines = [line for line in lines if not line.startswith(tuple(f"{key} " for key in gone))]
    at = lines.index("[materials]") + 1
    lines[at:at] = [f"{key} = {value}" for key, value in materials.items()]
    path = folder / "mine.toml"
    path.write_text("\n".join(lines), encoding="utf-8")
    return read_study(path)


def test_what_a_study_states_is_what_the_field_has():
    """The shipped studies name a grade and keep the 1.3 T and the permeability of vacuum that they state."""
    for name in ("motorcycle", "automotive", "robot_joint", "pump"):
        study = read_study(STUDIES / f"{name}.toml")
        magnet = machine_materials(study).magnet
        assert (magnet.remanence, magnet.recoil_permeability, magnet_density(study)) == (1.3, 1.0, 7500.0)
        assert magnet_inputs(study).grade.name == "N42UH"


def test_a_grade_gives_what_is_not_stated(tmp_path):
    study = study_with(tmp_path, STATED, magnet_grade='"Y30H-1"', magnet_temperature_degC=60.0)
    magnet, grade = design_magnet(study), load_grade("Y30H-1")
    assert magnet.remanence == pytest.approx(0.39 * (1 - 0.002 * 40)) and magnet.recoil_permeability == 1.08
    assert part_materials(study).magnet_density == grade.density
    assert loss_inputs(study).magnet_resistivity == 1e4, "ferrite has no eddy currents to speak of"


def test_without_a_grade_everything_is_stated(tmp_path):
    study = study_with(tmp_path, ("magnet_grade",))
    assert design_magnet(study).remanence == 1.3
    with pytest.raises(StudyError, match="materials.magnet_grade is missing"):
        magnet_inputs(study)


def test_what_the_magnets_must_stand_has_defaults(tmp_path):
    found = magnet_inputs(read_study(MOTORCYCLE))
    assert (found.cold, found.hot, found.lost_max) == (-15.0, 120.0, 0.01)
    own = ("magnets.cold_temperature_degC=-40.0", "magnets.hot_temperature_degC=90.0",
           "magnets.lost_volume_max_percent=0.0")  # fmt: skip
    found = magnet_inputs(read_study(MOTORCYCLE, own))
    assert (found.cold, found.hot, found.lost_max) == (-40.0, 90.0, 0.0)


@pytest.mark.parametrize(
    "materials, said",
    [
        ({"magnet_grade": '"N42XY"'}, 'materials.magnet_grade = "N42XY": unknown magnet grade'),
        ({"magnet_grade": '"Y30H-1"'}, 'materials.remanence_T = 1.3 is not that of materials.magnet_grade = "Y30H-1"'),
        ({"recoil_permeability": 1.3}, "materials.recoil_permeability = 1.3 is not that of .* which has 1.05"),
        ({"magnet_density_kg_per_m3": 4900.0}, "materials.magnet_density_kg_per_m3 = 4900 is not that of"),
    ],
)
def test_contradictions_are_one_sentence(tmp_path, materials, said):
    with pytest.raises(StudyError, match=said):
        check_magnets(study_with(tmp_path, **materials))


@pytest.mark.parametrize(
    "without, materials, said",
    [
        (("remanence_T", "magnet_grade"), {}, r"\[materials\] lacks remanence_T; add it, or magnet_grade"),
        (("remanence_T",), {}, "has a magnet_grade without magnet_temperature_degC"),
        ((), {"magnet_temperature_degC": 60.0}, "states remanence_T and magnet_temperature_degC"),
    ],
)
def test_what_is_missing_or_said_twice_is_one_sentence(tmp_path, without, materials, said):
    with pytest.raises(StudyError, match=said):
        study_with(tmp_path, without, **materials)


def test_the_cold_is_not_above_the_heat():
    with pytest.raises(StudyError, match="cold_temperature_degC = 95 above hot_temperature_degC = 90"):
        read_study(MOTORCYCLE, ("magnets.hot_temperature_degC=90.0", "magnets.cold_temperature_degC=95.0"))
