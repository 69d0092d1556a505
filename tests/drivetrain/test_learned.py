"""What a bench taught changes the inputs of a design by its laws, and nothing where nothing was learned."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from drivetrain.added_friction import NO_FRICTION, AddedFriction
from drivetrain.learned import (
    END_LEAKAGE,
    NOTHING_LEARNED,
    OUTPUT_FRICTION,
    QUANTITIES,
    REMANENCE,
    ROTOR_VISCOUS,
    STACKING,
    STEEL_FIELD,
    STEEL_SATURATION,
    Learned,
    Lesson,
    case_as_learned,
    demand_as_learned,
)
from drivetrain.requirements import Requirements, Transmission, shaft_demand
from magnetostatics.flux_map_stage import with_end_leakage
from tests.drivetrain.fitted_machines import CASE

REQUIRED = Requirements(0.0, 30.0, 1.2, 40.0, 3.1, 80.0, 1.5, 150.0, 60.0, 2.5)
TRANSMISSION = Transmission(0.02, 0.025)


def learned(*pairs):
    return Learned(tuple(Lesson(quantity.name, "", quantity, value) for quantity, value in pairs))


def test_nothing_learned_changes_no_input():
    assert case_as_learned(CASE, NOTHING_LEARNED) == CASE
    assert case_as_learned(CASE, NOTHING_LEARNED).materials.stator_steel is CASE.materials.stator_steel
    assert demand_as_learned(REQUIRED, TRANSMISSION, NOTHING_LEARNED) == shaft_demand(REQUIRED, TRANSMISSION)
    assert NOTHING_LEARNED.friction == NO_FRICTION and NO_FRICTION.left(0.1, 3.0, 7.0) == 0.1


def test_lessons_about_one_quantity_join_by_its_law():
    both = learned((REMANENCE, 0.9), (REMANENCE, 0.5), (END_LEAKAGE, 0.1), (END_LEAKAGE, 0.2), (OUTPUT_FRICTION, 2.0))
    assert both.of(REMANENCE) == pytest.approx(0.45)
    assert both.of(END_LEAKAGE) == pytest.approx(0.28)
    assert both.of(OUTPUT_FRICTION) == 2.0 and both.of(STACKING) == 1.0
    assert len({quantity.name for quantity in QUANTITIES}) == len(QUANTITIES)


def test_magnets_and_steel_are_those_of_the_bench():
    case = case_as_learned(CASE, learned((REMANENCE, 0.9), (STACKING, 0.95), (STEEL_FIELD, 2.0)))
    assert case.materials.magnet.remanence == pytest.approx(0.9 * CASE.materials.magnet.remanence)
    before, after = CASE.materials.stator_steel, case.materials.stator_steel
    at = 1.5
    assert after.field_strength(np.array(0.95 * at)) > 1.9 * before.field_strength(np.array(at))
    weaker = case_as_learned(CASE, learned((STEEL_SATURATION, 0.9))).materials.rotor_steel
    assert weaker.flux_density(np.array(0.9 * 1e4)) == pytest.approx(0.9 * before.flux_density(np.array(1e4)))


def test_what_is_needed_is_what_is_left():
    friction = AddedFriction(0.02, 1e-4, 3.0, 0.5, 0.04)
    made = friction.needed(80.0, 1.5, 0.02)
    assert friction.left(made, 1.5, 0.02) == pytest.approx(80.0)
    assert made == pytest.approx((80.0 + 3.0 + 0.02 / 0.02 + (0.5 + 1e-4 / 0.02**2) * 1.5) / 0.96)
    assert friction.left(1.0, 0.0, 0.02) == 0.0, "a machine that its friction holds gives nothing"


def test_friction_is_asked_of_the_rotor_where_the_ratio_is_largest():
    taught = learned((OUTPUT_FRICTION, 4.0), (ROTOR_VISCOUS, 1e-3))
    asked, plain = demand_as_learned(REQUIRED, TRANSMISSION, taught), shaft_demand(REQUIRED, TRANSMISSION)
    assert asked.torque_peak - plain.torque_peak == pytest.approx(4.0 * 0.025 + 1e-3 * 1.5 / 0.025)
    assert asked.power - plain.power == pytest.approx((4.0 + 1e-3 * 2.5 / 0.025**2) * 2.5)
    assert replace(asked, torque_peak=0, torque_rms=0, power=0) == replace(plain, torque_peak=0, torque_rms=0, power=0)


def test_end_leakage_takes_its_share_of_the_magnets_flux_only():
    i_d, i_q, angle = np.linspace(-8.0, 2.0, 6), np.array([0.0, 4.0, 8.0]), np.array([0.0, 0.1])
    d, q = np.meshgrid(i_d, i_q, indexing="ij")
    psi_d = 0.5 + 0.01 * d + 0.02 * angle[:, None, None]
    cogging = np.array([0.3, -0.3])[:, None, None]
    torque = 7.5 * (psi_d * q - 0.01 * q * d) + cogging
    dims = ("angle", "id", "iq")
    values = {"psi_d": (dims, psi_d), "psi_q": (dims, 0.01 * q + 0 * psi_d), "torque": (dims, torque)}
    data = xr.Dataset(values, {"angle": angle, "id": i_d, "iq": i_q}, {"pole_pairs": 5})
    assert with_end_leakage(data, 0.0) is data
    less = with_end_leakage(data, 0.1)
    magnets = 0.5 + 0.02 * angle
    assert np.allclose(less.psi_d, psi_d - 0.1 * magnets[:, None, None], atol=1e-12)
    assert np.allclose(less.psi_q, data.psi_q)
    assert np.allclose(less.torque, 0.9 * (torque - cogging) + 0.81 * cogging)
    assert less.attrs == data.attrs and less.torque.dims == dims
