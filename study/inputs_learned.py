"""Inputs of a study with what a bench has taught about its machines; where it taught nothing they are the study's."""

from __future__ import annotations

from dataclasses import replace

from drivetrain.learned import IRON_LOSS, RECOIL, REMANENCE, RESISTANCE, Learned, case_as_learned
from drivetrain.outcome import OutcomeInputs
from electrical.magnets_stage import MagnetInputs
from electrical.winding_stage import WindingInputs
from losses.stage import LossInputs
from magnetostatics.case import FamilyCase
from study.inputs_electrical import loss_inputs, winding_inputs
from study.inputs_field import field_case
from study.inputs_magnets import magnet_inputs
from study.inputs_outcome import outcome_inputs
from study.schema import Study


def study_itself(study: Study) -> Study:
    """For views that read a study beside something else."""
    return study


def field_case_as_learned(study: Study, learned: Learned) -> FamilyCase:
    """Magnets, steel and end leakage as the bench has shown them."""
    return case_as_learned(field_case(study), learned)


def winding_inputs_as_learned(study: Study, learned: Learned) -> WindingInputs:
    """The wires with the resistance of the winding on the bench."""
    inputs, factor = winding_inputs(study), learned.of(RESISTANCE)
    return replace(inputs, wires=tuple(replace(one, resistivity=factor * one.resistivity) for one in inputs.wires))


def loss_inputs_as_learned(study: Study, learned: Learned) -> LossInputs:
    """The loss data with the iron loss of the bench."""
    inputs = loss_inputs(study)
    return replace(inputs, iron_factor=inputs.iron_factor * learned.of(IRON_LOSS))


def magnet_inputs_as_learned(study: Study, learned: Learned) -> MagnetInputs:
    """The grade with the remanence and the recoil line of the bench; its coercivity stays."""
    inputs = magnet_inputs(study)
    grade = replace(
        inputs.grade,
        remanence=inputs.grade.remanence * learned.of(REMANENCE),
        recoil_permeability=inputs.grade.recoil_permeability * learned.of(RECOIL),
    )
    return replace(inputs, grade=grade)


def outcome_inputs_as_learned(study: Study, learned: Learned) -> OutcomeInputs:
    """What the actuator is held against, with the friction of the bench."""
    return replace(outcome_inputs(study), added_friction=learned.friction)
