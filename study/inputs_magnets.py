"""What the magnets of a study must stand, in SI."""

from __future__ import annotations

from electrical.magnets_stage import MagnetInputs
from study.errors import StudyError
from study.inputs_electrical import flux_map_grid
from study.magnet_choice import magnet_grade
from study.schema import Study
from thermal.cooling import MAGNET_LIMIT

COLD = -15.0  # degC; the coldest air that a machine stands by IEC 60034-1 (site of operation); it counts for ferrites
# 1 % of the volume without remanence costs about as much flux, half of what remanence scatters between batches.
LOST_MAX = 0.01


def magnet_inputs(study: Study) -> MagnetInputs:
    """Grade, temperatures and limit of the check against demagnetisation, at the rotor angles of the flux map.

    Raises StudyError without a grade.
    """
    grade, section = magnet_grade(study), study.magnets.si
    if grade is None:
        raise StudyError(f"{study.path}: materials.magnet_grade is missing; add it for the check of the magnets.")
    return MagnetInputs(
        grade=grade,
        cold=COLD if section.cold_temperature is None else section.cold_temperature,
        hot=hottest(study),
        lost_max=LOST_MAX if section.lost_volume_max is None else section.lost_volume_max,
        angles=flux_map_grid(study).angles,
    )


def hottest(study: Study) -> float:
    """The temperature up to which the magnets are held against demagnetisation, and are let warm up [degC]."""
    stated = study.magnets.si.hot_temperature
    return MAGNET_LIMIT if stated is None else float(stated)
