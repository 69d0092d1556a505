"""A wrong study gets one sentence that names the place, the value and the way out; never a traceback."""

import os
from pathlib import Path

import pytest

from study.errors import StudyError
from study.read import STUDIES, read_study
from study.usable import check_study
from tests.command_line import airgap

RIGHT = (STUDIES / "motorcycle.toml").read_text(encoding="utf-8")


def changed(tmp_path: Path, old: str, new: str) -> Path:
    """The motorcycle study with one thing changed."""
    assert RIGHT.count(old) == 1, f"{old!r} must stand once in the study"
    path = tmp_path / "wrong.toml"
    path.write_text(RIGHT.replace(old, new), encoding="utf-8")
    return path


def refusal(path, overrides=()) -> str:
    with pytest.raises(StudyError) as caught:
        check_study(read_study(path, overrides))
    return str(caught.value)


def assert_one_sentence(text: str, *named: str) -> None:
    assert text.count("\n") == 0 and text.endswith(".") and len(text) < 500, text
    for part in named:
        assert part in text, f"{part!r} is not named in: {text}"


ONE_THING_WRONG = {
    "unknown key": ("airgap_mm = 0.5 ", "airgp_mm = 0.5 ", ["machine.airgp_mm", "0.5", "machine.airgap_mm"]),
    "key that resembles nothing": ("airgap_mm = 0.5 ", "airgap_mm = 0.5\nxyzzy = 7 ", ["machine.xyzzy", "7", "slots"]),
    "wrong unit": ("airgap_mm = 0.5 ", "airgap_um = 500 ", ["airgap_um = 500", "in um", "write airgap_mm = 0.5"]),
    "wrong unit, speed": ("speed_max_rpm = 15000.0", "speed_max_rad_per_s = 1570.796", ["speed_max_rpm = 15000"]),
    "no unit": ("airgap_mm = 0.5 ", "airgap = 0.5 ", ["machine.airgap", "lacks its unit", "airgap_mm"]),
    "unit of another quantity": ("airgap_mm = 0.5 ", "airgap_kg = 0.5 ", ["cannot be in kg", "airgap_mm"]),
    "metres in a key in mm": ("airgap_mm = 0.5 ", "airgap_mm = 0.0005 ", ["0.0005", "metres", "0.05 to 20 mm"]),
    "unit in the value": ("airgap_mm = 0.5 ", 'airgap_mm = "0.5 mm" ', ['"0.5 mm"', "without a unit"]),
    "missing key": ("airgap_mm = 0.5 ", "# ", ["machine.airgap_mm is missing", "0.05 to 20 mm"]),
    "missing section": ("[match]", "[match_]", ["[match_]", "[match]"]),
    "key in the wrong section": ("airgap_mm = 0.5 ", "airgap_mm = 0.5\nremanence_T = 1.3 ", ["under [materials]"]),
    "negative gap": ("airgap_mm = 0.5 ", "airgap_mm = -0.5 ", ["machine.airgap_mm = -0.5", "0.05 to 20 mm"]),
    "NaN": ("airgap_mm = 0.5 ", "airgap_mm = nan ", ["machine.airgap_mm = nan", "not a finite number"]),
    "infinity": ("airgap_mm = 0.5 ", "airgap_mm = inf ", ["machine.airgap_mm = inf", "not a finite number"]),
    "NaN in a list": ("slots = [9, 12] ", "slots = [9, nan] ", ["sweep.slots", "nan"]),
    "number for a list": ("slots = [9, 12] ", "slots = 9 ", ["sweep.slots = 9", "a list"]),
    "fraction for a count": ("poles = 10 ", "poles = 10.5 ", ["machine.poles = 10.5", "an integer"]),
    "odd number of poles": ("poles = 10 ", "poles = 9 ", ["machine.poles = 9", "even"]),
    "unknown word": ('"parallel" ', '"axial" ', ['"axial"', '"parallel" or "radial" or "halbach"']),
    "number for a name": ('loss_grade = "M235-35A"', "loss_grade = 5", ["loss_grade = 5", "a text in quotes"]),
    "text for true or false": ("enforce_damping = false", 'enforce_damping = "no"', ['"no"', "true or false"]),
    "ends exchanged": ("back_iron_fraction_max = 0.115", "back_iron_fraction_max = 0.03", ["0.045", "0.03"]),
    "teeth wider than the pitch": (
        "back_iron_width_mm = 3.3 ",
        "back_iron_width_mm = 6.3 ",
        ["the teeth", "wider than the slot pitch", "back_iron_width_mm = 6.3", "8.482 mm"],
    ),
    "rotor wider than the stator": ("rotor_outer_radius_mm = 15.7", "rotor_outer_radius_mm = 40", ["= 40"]),
    "infeasible slots and poles": ("\nslots = 12 ", "\nslots = 11 ", ["slots = 11", "machine.poles = 10", "9 or 12"]),
    "infeasible slots in the sweep": ("slots = [9, 12] ", "slots = [9, 10] ", ["sweep.slots = 10", "take 9 or 12"]),
    "missing steel": ('"35PN270"', '"35PN27"', ["materials.steel", "35PN27", "35PN270, M19, M235-35A, M270-35A"]),
    "missing curve file": ('"35PN270"', '"mine.csv"', ["materials.steel", "mine.csv"]),
    "broken TOML": ("[match]", "[match", ["not valid TOML", "(at line "]),
}


@pytest.mark.parametrize("old, new, named", ONE_THING_WRONG.values(), ids=ONE_THING_WRONG.keys())
def test_one_wrong_thing_gives_one_sentence(tmp_path, old, new, named):
    path = changed(tmp_path, old, new)
    assert_one_sentence(refusal(path), "wrong.toml", *named)


def test_a_curve_that_is_not_monotone_is_refused_with_its_line(tmp_path):
    (tmp_path / "mine.csv").write_text("H_A_per_m,B_T\n0,0\n100,0.5\n200,0.9\n300,0.8\n400,1.2\n")
    path = changed(tmp_path, '"35PN270"', '"mine.csv"')
    assert_one_sentence(refusal(path), "wrong.toml", "materials.steel", "mine.csv, line 5", "0.8")


def test_a_good_curve_beside_the_study_is_accepted(tmp_path):
    (tmp_path / "mine.csv").write_text("H_A_per_m,B_T\n0,0\n100,0.5\n200,0.9\n300,1.1\n5000,1.6\n")
    check_study(read_study(changed(tmp_path, '"35PN270"', '"mine.csv"')))


@pytest.mark.parametrize("content", [b"", b"# only a comment\n"], ids=["no bytes", "no keys"])
def test_an_empty_file(tmp_path, content):
    path = tmp_path / "empty.toml"
    path.write_bytes(content)
    assert_one_sentence(refusal(path), "empty.toml is empty", "studies/template.toml")


def test_files_that_cannot_be_read(tmp_path):
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00\x01")
    (tmp_path / "folder.toml").mkdir()
    assert_one_sentence(refusal(tmp_path / "binary.toml"), "binary.toml", "UTF-8")
    assert_one_sentence(refusal(tmp_path / "folder.toml"), "folder.toml cannot be read")
    assert_one_sentence(refusal(tmp_path / "nowhere.toml"), "nowhere.toml does not exist")
    assert_one_sentence(refusal("nowhere"), "nowhere.toml does not exist", "motorcycle")


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may read everything")
def test_a_file_without_read_permission(tmp_path):
    path = changed(tmp_path, "[match]", "[match]")
    path.chmod(0)
    assert_one_sentence(refusal(path), "cannot be read (Permission denied)")


def test_two_wrong_things_give_two_sentences(tmp_path):
    text = RIGHT.replace("airgap_mm = 0.5 ", "airgap_mm = -1 ").replace("poles = 10 ", "poles = 9 ")
    path = tmp_path / "wrong.toml"
    path.write_text(text, encoding="utf-8")
    assert len(refusal(path).splitlines()) == 2


WRONG_OVERRIDES = {
    "foo": ["--set foo", "section.key=value"],
    "airgap_mm=0.6": ["machine.airgap_mm"],
    "machine.airgap_mm=": ["--set machine.airgap_mm=", "nothing"],
    "machine.airgap_mm=0,6": ["0,6", "not a TOML value"],
    "machine.airgap_mm=-1": ["--set machine.airgap_mm=-1", "0.05 to 20 mm"],
    "machine.airgap_um=600": ["write airgap_mm = 0.6"],
    "machine.back_iron_width_mm=6.3": ["--set machine.back_iron_width_mm=6.3", "the teeth"],
    "match.dc_bus_voltage_V=3": ["under [winding_selection]"],
    "machin.airgap_mm=0.6": ["[machin]", "[machine]"],
}


@pytest.mark.parametrize("override, named", WRONG_OVERRIDES.items(), ids=WRONG_OVERRIDES.keys())
def test_a_wrong_override_gives_one_sentence(override, named):
    assert_one_sentence(refusal("motorcycle", [override]), *named)


@pytest.mark.parametrize(
    "old, new, code, named",
    [
        ("airgap_mm = 0.5 ", "airgap_um = 500 ", 2, "write airgap_mm = 0.5."),
        ('"35PN270"', '"35PN27"', 2, "unknown steel"),
        ("airgap_mm = 0.5 ", "airgap_mm = 0.6 ", 0, ""),
    ],
)
def test_the_command_exits_with_2_and_one_line(tmp_path, old, new, code, named):
    done = airgap("check", changed(tmp_path, old, new))
    assert done.returncode == code
    assert named in done.stderr and "Traceback" not in done.stderr
    assert len(done.stderr.splitlines()) == (1 if code else 0)
