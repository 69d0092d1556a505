"""Machines of any kind from a file: every key in SI where it belongs, and one sentence about anything wrong."""

import pickle
import shutil
import sys
from subprocess import run

import pytest

from electrical.end_turn import Lap, ToothCoil, Wave
from geometry.errors import GeometryError
from geometry.kinds import ROTORS, STATORS
from geometry.own_kinds import module_name
from pipeline.codec import CodecError, decoded, digest, encoded
from pipeline.modules import PROJECT
from study.errors import StudyError
from study.machine_file import MACHINES, part_keys, read_machine
from tests.magnetostatics.other_machines import OUTRUNNER, V_SHAPE

TEXT = (MACHINES / "outrunner_9_12.toml").read_text(encoding="utf-8")


@pytest.fixture
def written(tmp_path):
    """A function that writes the outrunner's file with one thing changed."""
    shutil.copytree(MACHINES / "curves", tmp_path / "curves")

    def write(old, new):
        assert TEXT.count(old) == 1, f"{old!r} must stand once in the file"
        path = tmp_path / "changed.toml"
        path.write_text(TEXT.replace(old, new), encoding="utf-8")
        return path

    return write


@pytest.mark.parametrize("name, machine", [("outrunner_9_12", OUTRUNNER), ("prius_2004", V_SHAPE)])
def test_what_a_file_says_is_the_machine(name, machine):
    found = read_machine(name)
    for part in ("stator", "rotor"):
        stated, wanted = vars(getattr(found.machine, part)), vars(getattr(machine, part))
        assert {k: v for k, v in stated.items() if k != "magnetisation"} == pytest.approx(
            {k: v for k, v in wanted.items() if k != "magnetisation"}, rel=1e-6
        )


def test_winding_length_and_materials():
    found = read_machine("prius_2004")
    assert (found.turns, found.layout.coil_pitch, found.active_length) == (4.5, 6, pytest.approx(0.08382))
    assert (found.materials.magnet.remanence, found.materials.magnet.recoil_permeability) == (1.24, 1.05)


@pytest.mark.parametrize(("name", "steel"), [("v_48_8", "M400-50A"), ("szesynrm", "S235"), ("synrm_48_4", "M270-35A")])
def test_the_steel_is_named_by_its_grade_wherever_its_curve_lies(name, steel):
    """Loss data of M400-50A do not stand in for a curve of M400-50A."""
    assert read_machine(name).steel == steel


def test_the_end_turn_is_stated_or_follows_from_the_coil_pitch(tmp_path):
    text = (MACHINES / "prius_2004.toml").read_text(encoding="utf-8").replace('"curves/', f'"{MACHINES}/curves/')
    stated = tmp_path / "stated.toml"
    stated.write_text(text.replace("coil_pitch = 6", 'coil_pitch = 6\nend_turn = "wave"\noverlength = 2.1'))
    assert read_machine("prius_2004").end_turn == Lap() and read_machine("outrunner_9_12").end_turn == ToothCoil()
    assert read_machine(stated).end_turn == Wave(2.1)


def test_kinds_are_the_files_of_their_folders():
    assert {"straight_teeth", "outward_teeth", "round_bottom_slots"} <= set(STATORS.known)
    magnets = {"surface_magnets", "outer_magnets", "inset_magnets", "v_shape", "spoke"}
    magnets |= {"bread_loaf_magnets", "two_layer_v_shape", "consequent_pole", "outline_magnets"}
    assert magnets | {"flux_barriers"} <= set(ROTORS.known)


def test_every_key_ends_with_its_unit():
    keys = part_keys(ROTORS.known["v_shape"])
    assert (keys["bridge"], keys["tilt"], keys["poles"]) == ("bridge_mm", "tilt_deg", "poles")


WRONG = {
    "kind": ('kind = "outer_magnets"', 'kind = "inner_magnets"', "unknown kind of rotor 'inner_magnets': known are"),
    "no kind": ('kind = "outer_magnets"\n', "", "[rotor] lacks kind"),
    "key": ("magnet_length_mm = 1.287", "magnet_lenght_mm = 1.287", "did you mean magnet_length_mm"),
    "missing": ("magnet_length_mm = 1.287\n", "", "[rotor] lacks magnet_length_mm; add it"),
    "text": ("magnet_length_mm = 1.287", 'magnet_length_mm = "thin"', "magnet_length_mm = 'thin' is not a number"),
    "not finite": ("magnet_length_mm = 1.287", "magnet_length_mm = nan", "is not a number"),
    "half a pole": ("poles = 12", "poles = 12.5", "poles = 12.5 is not a whole number"),
    "magnetisation": ('"parallel"', '"axial"', "take parallel or radial or halbach"),
    "section": ("[mesh]", "[mash]", "did you mean mesh"),
    "turns": ("turns_per_coil = 8\n", "", "[winding] lacks turns_per_coil; add it"),
    "end turn": ("turns_per_coil = 8", 'turns_per_coil = 8\nend_turn = "basket"', "take tooth_coil or lap or wave"),
    "lap": ("turns_per_coil = 8", 'turns_per_coil = 8\nend_turn = "lap"', 'found 1: take "tooth_coil"'),
    "overlength": ("turns_per_coil = 8", "turns_per_coil = 8\noverlength = 2.0", "not to tooth_coil: remove it"),
    "steel": ('"curves/M400-50A_bh.csv"', '"M1"', "unknown steel 'M1'"),
    "no steel": ('stator_steel = "curves/M400-50A_bh.csv"', "", "[materials] lacks stator_steel"),
    "remanence": ("remanence_T = 1.20", "", "[materials] lacks remanence_T"),
    "winding": ("poles = 12", "poles = 18", "cannot carry this winding"),
    "built": ("arc_fraction = 0.635", "arc_fraction = 1.0", "must leave air between them"),
    "gap": ("inner_radius_mm = 7.478", "inner_radius_mm = 6.95", "no air gap between them"),
    "own file": ('"outer_magnets"', '"mine.py:Mine"', "there is no Python file"),
}


@pytest.mark.parametrize("old, new, words", WRONG.values(), ids=WRONG)
def test_one_sentence_about_what_is_wrong(written, old, new, words):
    with pytest.raises(StudyError) as caught:
        read_machine(written(old, new))
    text = str(caught.value)
    assert words in text and text.endswith(".") and "\n" not in text


def test_an_own_class_that_is_none(written, tmp_path):
    (tmp_path / "mine.py").write_text("class Mine:\n    pass\n")
    with pytest.raises(StudyError, match="has no class Mine that is a Rotor"):
        read_machine(written('"outer_magnets"', '"mine.py:Mine"'))


OWN = """
from dataclasses import dataclass
from geometry.parts import Length, MagnetsOfRoundCore

@dataclass(frozen=True)
class Mine(MagnetsOfRoundCore):
    poles: int
    outer_radius: Length

    def draw(self, rim):
        return None

    def check(self):
        pass
"""
NOT_OWN = {
    "a verb": (("def check", "def look"), "lacks check; Rotor in geometry.parts says what is asked"),
    "two": (("MagnetsOfRoundCore", "Rotor"), "lacks rim_radius, direction"),
    "poles": (("poles: int", "pole_number: int"), "lacks poles"),
    "thawed": (("(frozen=True)", ""), "is not frozen: write @dataclass(frozen=True) above it"),
    "no dataclass": (("@dataclass(frozen=True)", ""), "is not frozen"),
    "a slip": (("return None", "return None)"), "cannot be loaded: SyntaxError"),
    "an import": (("import Length", "import Lenght"), "cannot be loaded: ImportError"),
}


@pytest.mark.parametrize(("change", "words"), NOT_OWN.values(), ids=NOT_OWN)
def test_what_an_own_class_lacks_is_said_in_one_sentence(tmp_path, change, words):
    (tmp_path / "mine.py").write_text(OWN.replace(*change))
    with pytest.raises(GeometryError) as caught:
        ROTORS.named("mine.py:Mine", tmp_path)
    assert words in str(caught.value) and "\n" not in str(caught.value)


def test_an_own_class_is_found_again_by_another_process_and_after_an_edit_is_another(tmp_path):
    """Workers and stored results know it by the name of its module alone."""
    file = tmp_path / "numpy.py"  # which hides nothing
    file.write_text(OWN)
    mine = ROTORS.named("numpy.py:Mine", tmp_path)
    there = run([sys.executable, "-c", "import pickle, sys; print(pickle.load(sys.stdin.buffer))"],
                input=pickle.dumps(mine(8, 0.02)), capture_output=True, check=True, cwd=PROJECT)  # fmt: skip
    assert there.stdout.decode().strip() == "Mine(poles=8, outer_radius=0.02)"
    assert decoded(encoded(mine(8, 0.02))) == mine(8, 0.02)
    file.write_text(OWN.replace("return None", "return rim"))
    edited = ROTORS.named("numpy.py:Mine", tmp_path)
    assert edited(8, 0.02) != mine(8, 0.02) and digest(edited(8, 0.02)) != digest(mine(8, 0.02))


def test_a_stored_result_runs_no_file_that_nobody_named(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text(OWN)
    with pytest.raises(CodecError, match="is not a module of this project"):
        decoded({"dataclass": f"{module_name(file)}:Mine", "fields": {"poles": 8, "outer_radius": 0.02}})


def test_a_name_that_is_no_file_lists_what_there_is():
    with pytest.raises(StudyError, match="outrunner_9_12, prius_2004, synrm_48_4"):
        read_machine("nothing")
