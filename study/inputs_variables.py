"""What the optima of a study may choose beside back iron and rotor radius, in SI."""

from __future__ import annotations

from math import sqrt

from geometry.variables import AIRGAP, FURTHER, MAGNET_ARC, MAGNET_LENGTH, SLOT_OPENING, Variable
from optimisation.build_rules import BuildRule, MagnetStands, WireEnters
from optimisation.freedom import AS_SWEPT, Freedom
from study.errors import StudyError
from study.inputs_electrical import wires
from study.inputs_magnets import magnet_inputs
from study.magnet_choice import magnet_grade
from study.schema import Study
from units import MILLIMETRE


def freedom(study: Study) -> Freedom:
    """The variables of [variables] with their bounds, and the rules that keep the machine buildable.

    Raises StudyError for bounds within which nothing can be built.
    """
    stated = study.variables.si
    further = tuple(one.between(*getattr(stated, one.name)) for one in FURTHER if getattr(stated, one.name) is not None)
    if not further:
        return AS_SWEPT
    for one in further:
        _check_bounds(study, one)
    return Freedom(further, _rules(study, further))


def _check_bounds(study: Study, variable: Variable) -> None:
    """Bounds that contradict what else the study states."""
    name = f"{study.path}: variables.{variable.key}"
    sleeve, wire = study.mechanics.si.sleeve_thickness, thickest_wire(study)
    if variable.name == MAGNET_ARC.name and variable.high >= 1:
        raise StudyError(f"{name} reaches 1, where magnets touch and the mesh is another; end it below, say at 0.98.")
    if variable.name == AIRGAP.name and sleeve is not None and variable.low <= sleeve:
        raise StudyError(
            f"{name} starts at {variable.amount(variable.low)}, which mechanics.sleeve_thickness_mm = "
            f"{sleeve / MILLIMETRE:g} fills; start above it."
        )
    if variable.name == SLOT_OPENING.name and variable.low < wire:
        raise StudyError(
            f"{name} starts at {variable.amount(variable.low)}, through which the insulated wire of "
            f"{wire / MILLIMETRE:g} mm does not pass (winding_selection); start there or above."
        )


def _rules(study: Study, further: tuple[Variable, ...]) -> tuple[BuildRule, ...]:
    wire = WireEnters(thickest_wire(study))
    if magnet_grade(study) is not None:
        return wire, _magnet_stands(study)
    if any(one.name == MAGNET_LENGTH.name for one in further):
        raise StudyError(
            f"{study.path}: variables.{MAGNET_LENGTH.key} needs materials.magnet_grade, whose knee says how short the "
            "magnets may become; name the grade."
        )
    return (wire,)


def _magnet_stands(study: Study) -> MagnetStands:
    """The overload current against the weakest magnet between cold and hot."""
    inputs = magnet_inputs(study)
    worst = inputs.grade.weaker_of(inputs.cold, inputs.hot)
    return MagnetStands(
        remanence=inputs.grade.remanence_at(worst),
        knee=inputs.grade.knee_at(worst),
        recoil_permeability=inputs.grade.recoil_permeability,
        slot_density=sqrt(2) * study.sweep.si.j_overload_rms * study.winding.packing_factor,
    )


def thickest_wire(study: Study) -> float:
    """Diameter of the thickest of the allowed wires over its enamel [m]."""
    return max(wire.outer_diameter for wire in wires(study))
