"""Steel grades by name and by file."""

import pytest

from materials.errors import MaterialError
from materials.iron_loss import MEASURED
from materials.library import STEELS, known_steels, load_steel

GOOD = "# a comment\nH_A_per_m,B_T\n0,0\n50,0.5\n200,1.2\n5000,1.7\n20000,1.9\n"


def write(folder, text, name="own.csv"):
    (folder / name).write_text(text, encoding="utf-8")
    return name


def test_the_grades_of_the_package_load():
    assert len(known_steels()) == 15 and {"35PN270", "M270-35A"} < set(known_steels())
    assert load_steel("35PN270").name == "35PN270"
    assert load_steel("35PN270").flux_density(500.0) == pytest.approx(1.37458745883333)
    assert load_steel("M270-35A").flux_density(596.0) == pytest.approx(1.4)


# EN 10106: polarisation that a grade must reach at 2500, 5000 and 10 000 A/m [T]
LEAST = {
    "M270-50A": (1.49, 1.60, 1.70), "M310-50A": (1.49, 1.60, 1.70), "M330-50A": (1.49, 1.60, 1.70),
    "M350-50A": (1.50, 1.60, 1.70), "M400-50A": (1.53, 1.63, 1.73), "M470-50A": (1.54, 1.64, 1.74),
    "M530-50A": (1.56, 1.65, 1.75), "M700-50A": (1.60, 1.69, 1.77), "M800-50A": (1.60, 1.70, 1.78),
    "M235-35A": (1.49, 1.60, 1.70), "M530-65A": (1.54, 1.64, 1.74),
}  # fmt: skip


@pytest.mark.parametrize("grade", LEAST)
def test_the_sheets_reach_the_polarisation_of_their_standard(grade):
    """What was measured lies above the least, and nowhere more than 5 % above."""
    law = load_steel(grade)
    for field, least in zip((2500.0, 5000.0, 10000.0), LEAST[grade]):
        assert least < law.flux_density(field) < 1.06 * least


@pytest.mark.parametrize("grade", known_steels())
def test_every_curve_states_its_source_and_saturates_like_steel(grade):
    text = (STEELS / f"{grade}_bh.csv").read_text(encoding="utf-8")
    assert "# Source" in text
    assert 1.9 < load_steel(grade).saturation_polarisation < 2.2


def test_at_least_eight_sheets_have_a_curve_and_a_measured_loss():
    assert len(set(known_steels()) & set(MEASURED)) >= 8


def test_own_file_beside_the_study(tmp_path):
    law = load_steel(write(tmp_path, GOOD), tmp_path)
    assert law.name == "own"
    assert law.field_strength(1.2) == pytest.approx(200.0)


def test_own_file_with_other_column_order_blank_lines_and_byte_order_mark(tmp_path):
    text = "\ufeffB_T, H_A_per_m\n0,0\n\n0.5,50\n1.2,200\n# the knee\n1.7,5000\n1.9,20000\n"
    assert load_steel(write(tmp_path, text), tmp_path).field_strength(1.2) == pytest.approx(200.0)


def test_unknown_grade_lists_the_known_ones():
    with pytest.raises(MaterialError, match="unknown steel 'M300'.*35PN270, M19, M235-35A, M270-35A"):
        load_steel("M300")


def test_missing_file_is_named(tmp_path):
    with pytest.raises(MaterialError, match="no curve file .*absent.csv"):
        load_steel("absent.csv", tmp_path)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("200,1.2", "40,1.2", "own.csv, line 5: own: point 3 .* does not increase in H"),
        ("200,1.2", "200,high", "own.csv, line 5: expected two numbers, found '200', 'high'"),
        ("200,1.2", "200", "own.csv, line 5: expected two numbers"),
        ("200,1.2", "200,nan", "own.csv, line 5: .* finite"),
        ("H_A_per_m", "H", "own.csv: column H_A_per_m missing; found H, B_T"),
        ("5000,1.7\n20000,1.9\n", "", "own.csv: own: a curve needs at least 4 points, found 3"),
        (GOOD, "# nothing\n", "holds no data"),
    ],
)
def test_errors_name_the_file_and_the_line(tmp_path, old, new, words):
    name = write(tmp_path, GOOD.replace(old, new))
    with pytest.raises(MaterialError, match=words):
        load_steel(name, tmp_path)
