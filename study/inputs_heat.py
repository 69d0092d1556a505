"""How the machine is cooled and how warm it may become, in SI; what a study does not state has the rooms' defaults."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from materials.magnet import ROOM_TEMPERATURE, Magnet
from study.inputs_electrical import winding_class, winding_conductor
from study.inputs_magnets import hottest
from study.magnet_choice import design_magnet, magnet_grade
from study.schema import Study
from thermal.air import Film, GivenFilm, StillAir
from thermal.cooling import (
    AMBIENT,
    CASING_GAP,
    EMISSIVITY,
    FILLER_CONDUCTIVITY,
    LINER_CONDUCTIVITY,
    LINER_THICKNESS,
    Cooling,
    HeatLimits,
)
from thermal.field_loss import FieldLoss, NoLossData
from thermal.slot import Liner
from thermal.stage import HeatInputs


def heat_inputs(study: Study) -> HeatInputs:
    """Cooling, limits, and how copper and magnets change as they warm up."""
    section, winding = study.thermal.si, study.winding_selection.si
    return HeatInputs(
        cooling(study),
        HeatLimits(
            winding_class(study).hottest,
            _or(section.magnet_temperature_max, hottest(study)),
        ),
        warming_magnet(study),
        winding_conductor(study),
        winding.winding_temperature,
    )


def cooling(study: Study) -> Cooling:
    """What leads the heat away beside the machine itself."""
    section = study.thermal.si
    return Cooling(
        ambient=_or(section.ambient_temperature, AMBIENT),
        film=_film(section.film, _or(section.emissivity, EMISSIVITY)),
        mount=_or(section.mount_conductance, 0.0),
        filler_conductivity=_or(section.slot_filler_conductivity, FILLER_CONDUCTIVITY),
        liner=Liner(_or(section.slot_liner, LINER_THICKNESS), _or(section.slot_liner_conductivity, LINER_CONDUCTIVITY)),
        casing_gap=_or(section.casing_gap, CASING_GAP),
    )


def warming_magnet(study: Study) -> Magnet:
    """How the remanence falls: the study's coefficient, else that of its grade, else that of sintered NdFeB."""
    magnet, grade = design_magnet(study), magnet_grade(study)
    stated = study.thermal.si.remanence_temperature_coefficient
    if stated is not None:
        return replace(magnet, temperature_coefficient=stated)
    if grade is None:
        return magnet
    reference = _or(study.materials.si.magnet_temperature, ROOM_TEMPERATURE)
    coefficient = grade.remanence_coefficient * grade.remanence / grade.remanence_at(reference)
    return replace(magnet, temperature_coefficient=coefficient, reference_temperature=reference)


def no_loss_data(study: Study) -> FieldLoss:
    """In the place of a loss map, for a steel without loss data."""
    return NoLossData()


def _film(stated: float | None, emissivity: float) -> Film:
    return StillAir(emissivity) if stated is None else GivenFilm(stated)


def _or(stated: Any, otherwise: float) -> float:
    return otherwise if stated is None else float(stated)
