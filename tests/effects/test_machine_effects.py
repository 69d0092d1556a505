"""Effects on a machine as built: nothing at zero, the right place otherwise, alternatives for magnet, slot and coil."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from effects.base import DesignEffect, Effect
from effects.library import package_effects
from effects.machine.bearing_friction import BearingFriction
from effects.machine.dynamic_eccentricity import DynamicEccentricity
from effects.machine.lost_turns import LostTurns
from effects.machine.magnet_temperature import MagnetTemperature
from effects.machine.phase_imbalance import PhaseImbalance
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameters_of
from tests.workbench.models.machine_case import drawn, surrogate
from workbench.models.machine.answers import Answers
from workbench.models.machine.drag import lost_torque

OWN = {name: cls for name, cls in package_effects().items() if cls.__module__.startswith("effects.machine.")}
FIELD = {name: cls for name, cls in OWN.items() if issubclass(cls, DesignEffect)}


def moved(effect: Effect) -> Effect:
    """Every parameter half a standard deviation above its centre."""
    return effect.at(np.full(len(parameters_of(effect)), 0.5))


def test_enough_act_through_the_field():
    assert len(FIELD) >= 16


@pytest.mark.parametrize("name", FIELD)
def test_null_changes_nothing(name):
    for effect in OWN[name].variants(drawn()):
        assert effect.on_design(drawn()) == drawn()


@pytest.mark.parametrize("name", FIELD)
def test_every_variant_makes_another_machine(name):
    variants = OWN[name].variants(drawn())
    designs = [moved(effect).on_design(drawn()) for effect in variants]
    assert all(design != drawn() for design in designs)
    assert len({repr(design) for design in designs}) == len(variants)


def test_alternatives():
    counts = {name: len(cls.variants(drawn())) for name, cls in OWN.items()}
    assert (counts["weak_magnet"], counts["magnet_position"], counts["wide_slot"]) == (10, 10, 12)
    assert (counts["lost_turns"], counts["phase_imbalance"], counts["airgap_change"]) == (12, 3, 1)


def test_warm_magnets_follow_their_coefficient():
    assert_allclose(MagnetTemperature(rise=50.0).on_design(drawn()).magnet.remanence, 1.3 * (1 - 0.0012 * 50))


def test_lost_turns_take_resistance_and_turns():
    """One of the 28 turns of phase A, which has the coils 0, 1, 6 and 7 (star of slots of 12 slots, 10 poles)."""
    design = LostTurns(coil=1, turns=1.0).on_design(drawn())
    assert design.turns[1] == 6.0 and design.turns[0] == 7.0
    changed = [r / 12.6e-3 for r in design.phase_resistance]
    assert_allclose(changed, [27 / 28, 1.0, 1.0])


def test_no_more_turns_are_missing_than_there_are():
    """The search tries large sizes; an effect that raised there would not be tried at all."""
    design = LostTurns(coil=1, turns=8.0).on_design(drawn())
    assert design.turns[1] == 0.0
    assert_allclose(design.phase_resistance[0] / 12.6e-3, 21 / 28)


def test_phase_imbalance_changes_four_coils():
    design = PhaseImbalance(phase=2, share=0.1).on_design(drawn())
    assert sum(turns != 7.0 for turns in design.turns) == 4
    assert_allclose(design.phase_resistance[2], 1.1 * 12.6e-3)


def test_eccentricities_add_up():
    before = replace(drawn(), rotor_shift=(1e-5, 0.0))
    after = DynamicEccentricity(share=0.1, direction=np.pi / 2).on_design(before)
    assert_allclose(after.rotor_shift, (1e-5, 5e-5))


def test_friction_has_the_sign_of_the_motion():
    """By the column of the direction, by the sign of the speed, and none where neither is known."""
    answers = Answers(surrogate(), BearingFriction(level=0.01).on_design(drawn()))
    both = np.array([1.0, -1.0])
    assert_allclose(lost_torque(answers, {"angle_mech": both, "direction": both}), [-0.01, 0.01])
    assert_allclose(lost_torque(answers, {"speed": 50 * both}), [-0.01, 0.01])
    assert_allclose(lost_torque(answers, {"speed": np.array([50.0, 50.0]), "direction": both}), [-0.01, 0.01])
    assert not lost_torque(answers, {"angle_mech": both}).any()


def test_they_act_on_machines_only():
    assert all(issubclass(MachineAsBuilt, cls.designs) for cls in OWN.values())
