"""Magnet grades: temperature laws and knee at values computed by hand, and data that agree with their own names."""

import pytest

from materials.errors import MaterialError
from materials.magnet_grade import known_grades, load_grade
from units import MU_0

GRADES = [load_grade(name) for name in known_grades()]
KILOJOULE_PER_MGOE = 7.9577  # 1 MGOe = 1e7/(4 pi) J/m^3 / 1e5


def test_all_kinds_are_there():
    kinds = ("sintered NdFeB", "sintered SmCo5", "sintered Sm2Co17", "anisotropic hard ferrite", "isotropic NdFeB")
    assert len(GRADES) >= 8 and all(any(one.material.startswith(kind) for one in GRADES) for kind in kinds)


@pytest.mark.parametrize(
    "name, mgoe",
    [("N35", 35), ("N42", 42), ("N48H", 48), ("N42SH", 42), ("N42UH", 42), ("N38UH", 38), ("SmCo5-20", 20),
     ("Sm2Co17-24", 24), ("bonded-NdFeB-10", 10), ("C5", 3.4), ("Y30H-1", 30 / KILOJOULE_PER_MGOE)],
)  # fmt: skip
def test_the_energy_product_is_that_of_the_name(name, mgoe):
    """(BH)max of a straight recoil line is B_r^2/(4 mu_0 mu_r), where the knee lies below half the remanence."""
    grade = load_grade(name)
    assert grade.knee_at(20.0) < grade.remanence / 2
    product = grade.remanence**2 / (4 * MU_0 * grade.recoil_permeability)
    assert product / 1e3 == pytest.approx(mgoe * KILOJOULE_PER_MGOE, rel=0.07)


def test_a_hot_magnet_by_hand():
    """N42SH at 120 degC: 1.3 (1 - 0.11) T; 1592 (1 - 0.535) kA/m; 1.157 - 4e-7 pi 1.05 0.9 740.28e3 T."""
    grade = load_grade("N42SH")
    assert grade.remanence_at(120.0) == pytest.approx(1.157)
    assert grade.coercivity_at(120.0) == pytest.approx(740.28e3)
    assert grade.knee_at(120.0) == pytest.approx(0.27790, abs=1e-5)
    assert grade.remanence_at(20.0) == 1.30 and grade.coercivity_at(20.0) == 1592e3


def test_a_cold_ferrite_by_hand():
    """Y30H-1 at -15 degC: 0.39 (1 + 0.07) T; 235 (1 - 0.105) kA/m; 0.4173 - 4e-7 pi 1.08 0.9 210.325e3 T."""
    grade = load_grade("Y30H-1")
    assert grade.remanence_at(-15.0) == pytest.approx(0.4173)
    assert grade.knee_at(-15.0) == pytest.approx(0.16040, abs=1e-5)


def test_the_recoil_line_of_the_magnet_leads_to_the_knee():
    grade = load_grade("N38UH")
    magnet, field = grade.magnet_at(100.0), grade.knee_share * grade.coercivity_at(100.0)
    assert magnet.remanence - MU_0 * magnet.recoil_permeability * field == pytest.approx(grade.knee_at(100.0))
    assert magnet.at(20.0).remanence == pytest.approx(grade.remanence)


@pytest.mark.parametrize("grade", GRADES, ids=lambda one: one.name)
def test_ferrites_are_weak_in_the_cold_and_all_others_in_the_heat(grade):
    assert grade.weaker_of(-15.0, 60.0) == (-15.0 if "ferrite" in grade.material else 60.0)


def test_a_magnet_that_has_nothing_left_is_refused():
    with pytest.raises(MaterialError, match="N42 has no coercivity left at 160 degC: it works up to 80 degC"):
        load_grade("N42").coercivity_at(160.0)


def test_an_unknown_grade_names_the_known_ones():
    with pytest.raises(MaterialError, match="unknown magnet grade 'N99': known are N35, N42"):
        load_grade("N99")
