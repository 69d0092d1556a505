"""The magnets of a study in SI: as it states them, and where it does not, of their grade."""

from __future__ import annotations

from losses.magnet import NDFEB_RESISTIVITY
from materials.errors import MaterialError
from materials.magnet import Magnet
from materials.magnet_grade import MagnetGrade, load_grade
from study.errors import StudyError
from study.schema import Study

# How far what a study states of its magnets may be from their grade, relative: scatter of makers and batches, and for
# the permeability that of vacuum in the place of 1.05 to 1.1, which simple models take.
_SAME_REMANENCE, _SAME_PERMEABILITY, _SAME_DENSITY = 0.03, 0.1, 0.05
_COLDEST = -40.0  # degC, down to which the straight laws of ``materials.magnet_grade`` hold


def magnet_grade(study: Study) -> MagnetGrade | None:
    """The grade of the study's magnets, None where it names none.

    Raises StudyError for an unknown one, and where the study states what the grade does not have.
    """
    name = study.materials.magnet_grade
    if name is None:
        return None
    try:
        grade = load_grade(name)
    except MaterialError as error:
        raise StudyError(f'{study.path}: materials.magnet_grade = "{name}": {error}.') from error
    _check_stated(study, grade)
    return grade


def design_magnet(study: Study) -> Magnet:
    """The magnet that the fields are solved with: what is not stated is that of the grade at its temperature."""
    stated, grade = study.materials.si, magnet_grade(study)
    if grade is None:
        return Magnet(stated.remanence, stated.recoil_permeability)
    permeability = grade.recoil_permeability if stated.recoil_permeability is None else stated.recoil_permeability
    if stated.remanence is not None:
        return Magnet(stated.remanence, permeability)
    return Magnet(_remanence(study, grade, stated.magnet_temperature), permeability)


def magnet_density(study: Study) -> float:
    """Density of the magnets [kg/m^3], that of the grade where none is stated."""
    stated, grade = study.materials.si.magnet_density, magnet_grade(study)
    return float(grade.density if stated is None and grade is not None else stated)


def magnet_resistivity(study: Study) -> float:
    """Resistivity of the magnets [ohm m], that of sintered NdFeB where no grade is named."""
    grade = magnet_grade(study)
    return NDFEB_RESISTIVITY if grade is None else grade.resistivity


def _remanence(study: Study, grade: MagnetGrade, temperature: float) -> float:
    try:
        return grade.remanence_at(temperature)
    except MaterialError as error:
        raise StudyError(f"{study.path}: materials.magnet_temperature_degC = {temperature:g}: {error}.") from error


def _check_stated(study: Study, grade: MagnetGrade) -> None:
    """What a study states beside a grade must be the grade's, the remanence at some temperature it works at."""
    stated = study.materials.si
    warm = grade.remanence_at(grade.largest_temperature)
    for key, value, (low, high), same in (
        ("remanence_T", stated.remanence, (warm, grade.remanence_at(_COLDEST)), _SAME_REMANENCE),
        ("recoil_permeability", stated.recoil_permeability, (grade.recoil_permeability,) * 2, _SAME_PERMEABILITY),
        ("magnet_density_kg_per_m3", stated.magnet_density, (grade.density,) * 2, _SAME_DENSITY),
    ):
        if value is not None and not low * (1 - same) <= value <= high * (1 + same):
            found = f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
            raise StudyError(
                f'{study.path}: materials.{key} = {value:g} is not that of materials.magnet_grade = "{grade.name}", '
                f"which has {found}; leave it out, or name another grade."
            )
