"""Waves of the radial stress: known ones are found again, a smooth gap against its series, what symmetry forbids."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import pi

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.defects import StaticEccentricity
from geometry.family import MatchedMachine
from geometry.half_cell import MeshDensity
from magnetostatics import gap_stress_stage as stage
from magnetostatics.case import FamilyCase
from magnetostatics.gap_stress import (
    amplitude_of,
    classical_pull,
    effective_gap,
    radial_stress_orders,
    stress_over_angle,
    stress_waves,
    torque_orders,
)
from magnetostatics.gap_stress_stage import gap_stress_stage
from magnetostatics.model import FieldModel, MachineMaterials, OperatingPoint
from magnetostatics.rotation import STATES
from magnetostatics.torque import gap_force_density, magnetic_pull
from materials.magnet import Magnet
from materials.reluctivity import LinearReluctivity
from study.inputs_field import field_case
from study.read import read_study
from tasks import InThisProcess
from tests.magnetostatics.reference_machine import SWEEP, model_of, reference_machine
from tests.magnetostatics.whole_machine import COARSE, NINE_SLOTS, whole_model, with_defects
from tests.physics.slotless_ring import EXACT, Ring, ring_section
from units import MU_0

HIGHEST = 48
POSITIONS = 24
PLACES = 2 * pi * np.arange(256) / 256


def orders_of(waves):
    """Spatial coefficients over half an electrical period of waves (r, nu, amplitude, phase), by a sum over places."""
    time = pi * np.arange(POSITIONS)[:, None] / POSITIONS
    stress = sum(size * np.cos(r * PLACES - nu * time + phase) for r, nu, size, phase in waves)
    return np.fft.fft(stress, axis=1)[:, : HIGHEST + 1] / len(PLACES)


KNOWN = ((0, 0, 3.0, 0.0), (4, 2, 2.0, 0.3), (-2, 4, 1.0, 1.0), (12, 0, 0.5, -0.4), (0, 6, 0.25, 2.0))


def test_known_waves_are_found_with_their_signs():
    found = stress_waves(orders_of(KNOWN))
    assert [(one.spatial_order, one.temporal_order) for one in found[:5]] == [(r, nu) for r, nu, _, _ in KNOWN]
    assert_allclose([one.amplitude for one in found[:5]], [size for _, _, size, _ in KNOWN], rtol=1e-12)
    assert found[5].amplitude < 1e-12
    assert amplitude_of(found, found[2]) == pytest.approx(1.0) and amplitude_of(found[:2], found[2]) == 0.0


def test_the_stress_over_the_angle_is_the_sum_of_its_waves():
    stress = stress_over_angle(orders_of(KNOWN), PLACES)
    expected = sum(size * np.cos(r * PLACES + phase) for r, _, size, phase in KNOWN)
    assert_allclose(stress[0], expected, atol=1e-12)


def test_orders_of_a_torque_count_electrical_periods():
    """Over half an electrical period of five pole pairs: the sixth harmonic, and the mean as the unit."""
    angles = pi / 5 * np.arange(48) / 48
    found = torque_orders(-4 + 0.2 * np.cos(6 * 5 * angles) + 0.1 * np.sin(12 * 5 * angles), pi / 5, 5)
    assert list(found)[:2] == [6, 12]
    assert_allclose(list(found.values())[:3], (0.05, 0.025, 0.0), atol=1e-12)


def exact_ring_orders(ring, radii, weights):
    """Coefficients of (B_r^2 - B_phi^2)/(2 mu_0) of the exact series, averaged over circles."""
    means = []
    for radius in radii:
        radial = tangential = 0.0
        for order in 5 * np.arange(1, 40, 2):
            wave = np.exp(1j * order * PLACES_FINE)
            field = ring.field(order)
            radial = radial + (field.radial(radius) * wave).real
            tangential = tangential + (field.tangential(radius) * wave).real
        means.append(np.fft.fft((radial**2 - tangential**2) / (2 * MU_0))[: HIGHEST + 1] / len(PLACES_FINE))
    return np.average(means, axis=0, weights=weights)


PLACES_FINE = 2 * pi * np.arange(2048) / 2048


def test_a_smooth_gap_has_the_stress_of_its_series():
    """Slotless ring against separation of variables: mean and multiples of the poles, sizes and phases."""
    ring = Ring()
    m = ring.machine
    model = FieldModel(ring_section(m, 12, 2), ring.materials, EXACT)
    found = radial_stress_orders(model.solve(OperatingPoint(0.0)), HIGHEST)
    radii = np.linspace(m.mid_gap_radius, m.stator_inner_radius, 5)
    exact = exact_ring_orders(ring, radii, radii * np.array([0.5, 1, 1, 1, 0.5]))
    assert_allclose(found, exact, atol=2e-3 * exact[0].real)
    assert exact[0].real > 3e4 and abs(found[10]) > 0.1 * exact[0].real
    assert_allclose(found[np.arange(HIGHEST + 1) % 10 > 0], 0.0)


@cache
def idle(**changes):
    return whole_model(COARSE, **changes).solve(OperatingPoint(0.1))


def test_the_order_nought_is_the_mean_of_the_stress():
    """Against the integral of (B_r^2 - B_phi^2)/(2 mu_0) over the ring, from the field itself."""
    solution = idle()
    orders = radial_stress_orders(solution, HIGHEST)
    ring, _ = gap_force_density(solution)
    dx, dy = ring.gradient(solution.a)
    x, y = ring.points / np.hypot(*ring.points)
    radial, tangential = dy * x - dx * y, -dy * y - dx * x
    mean = np.average((radial**2 - tangential**2) / (2 * MU_0), weights=ring.weights)
    assert orders[0] == pytest.approx(mean, rel=1e-10)
    assert stress_over_angle(orders, PLACES).mean() == pytest.approx(mean, rel=1e-10)


def test_spatial_orders_are_multiples_of_what_slots_and_poles_share():
    """12 slots and 10 poles: even ones only, on a mesh of the whole machine that knows of no symmetry."""
    orders = np.abs(radial_stress_orders(idle(), HIGHEST))
    assert orders[1::2].max() < 1e-9 * orders[0] and orders[[10, 12, 2]].min() > 1e-4 * orders[0]
    nine = np.abs(radial_stress_orders(idle(**NINE_SLOTS), HIGHEST))
    assert nine[1] > 1e-2 * nine[0], "9 slots and 8 poles share nothing: the rotor is pulled aside"


def coarse_case() -> FamilyCase:
    case = field_case(read_study("motorcycle"))
    coarse = MeshDensity(gap_edges=120, longest_gap_edge=2.0, gap_layers=1, across_iron=1.0)
    return replace(case, density=coarse)


@pytest.fixture(scope="module")
def found():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stage, "_PULL_STEPS", 2)
        case = coarse_case()
        return gap_stress_stage(case, MatchedMachine(case.family.reference), InThisProcess())


@pytest.fixture(scope="module")
def rotation(found):
    return found.rotation


@pytest.mark.parametrize("state, shift", (("no_current", 12), ("nominal", 6), ("overload", 6)))
def test_every_wave_is_made_of_pole_pairs_and_slots(rotation, state, shift):
    """r = p nu + b shift: magnets' waves turn with the rotor; slots shift orders by 12, currents, whose sign changes
    after six slots, by 6."""
    waves = rotation.waves(state)
    large = [one for one in waves if one.amplitude > 5e-3 * waves[0].amplitude]
    assert len(large) > 20 and (waves[0].spatial_order, waves[0].temporal_order) == (0, 0)
    assert all((one.spatial_order - 5 * one.temporal_order) % shift == 0 for one in large)


def test_the_current_makes_the_wave_of_two_periods_that_bends_the_stator(rotation):
    """-2 = 10 - 12: the working field of 5 pairs with the winding's of 7, that turns against it."""
    two = {
        state: sum(one.amplitude for one in rotation.waves(state) if abs(one.spatial_order) == 2) for state in STATES
    }
    assert two["overload"] > 5 * two["no_current"] and two["overload"] > 0.1 * rotation.mean_stress


def test_the_torque_is_that_of_the_fields_and_ripples_with_the_sixth(rotation):
    assert rotation.mean_torque_per_length("nominal") == pytest.approx(
        55.6, rel=0.02
    )  # Nm/m, guarded in tests/reference
    assert abs(rotation.mean_torque_per_length("no_current")) < 0.01
    assert all(order % 6 == 0 for order in list(rotation.ripple_orders("overload"))[:3])
    assert rotation.ripple("overload") == pytest.approx(np.ptp(rotation.data.torque.values[2]))


def test_the_cogging_has_its_own_mesh_error(found):
    """Over six degrees of the rotor, odd about its middle; on this coarse mesh the error is large, and said to be."""
    fine = found.cogging_torque
    assert found.rotation.cogging_span == pytest.approx(pi / 30) and found.cogging == np.ptp(fine)
    assert_allclose(fine[1:], -fine[:0:-1], atol=1e-3 * found.cogging)
    assert found.cogging_error == abs(np.ptp(fine) - np.ptp(found.rotation.torque("no_current")))
    close = 2.36  # Nm/m, on triangles a quarter of the size
    assert abs(close - found.cogging) < found.cogging_error < 0.5 * close


def test_nothing_pulls_a_rotor_in_the_middle(found):
    pulls = found.pull_per_shift * found.shift
    assert found.centred_pull.max() < 1e-6 * pulls.min()


def test_the_classical_pull_is_near_that_of_the_field(found):
    """Curvature, and harmonics that feel the gap more than the first, are what it lacks: 12 %."""
    machine = found.rotation.machine
    classical = classical_pull(found.rotation.mean_stress, machine.mid_gap_radius, effective_gap(machine, 1.0))
    assert classical == pytest.approx(found.pull_per_shift[0], rel=0.15)
    plain = classical_pull(found.rotation.mean_stress, machine.mid_gap_radius, machine.airgap + machine.magnet_length)
    assert plain < 0.75 * found.pull_per_shift[0], "a gap that counts as thin against the poles"


def test_the_classical_pull_is_that_of_the_field_where_it_should_be():
    """Four poles, 1.5 mm from core to bore, slots nearly closed, linear iron: 4 %."""
    iron = LinearReluctivity(1e5)
    machine = reference_machine(
        pole_pairs=2, magnet_length=1e-3, rotor_outer_radius=18e-3, back_iron_width=8e-3, slot_opening=0.5e-3
    )
    materials = MachineMaterials(iron, iron, Magnet(1.3, 1.0))
    centred = model_of(machine, SWEEP, whole=True, materials=materials)
    shift = 0.05e-3
    solved = [one.solve(OperatingPoint(0.05)) for one in (centred, with_defects(centred, StaticEccentricity(shift)))]
    pull = (magnetic_pull(solved[0]) - magnetic_pull(solved[1]))[0] / shift
    mean_stress = radial_stress_orders(solved[0], 0)[0].real
    classical = classical_pull(mean_stress, machine.mid_gap_radius, effective_gap(machine, 1.0))
    assert classical == pytest.approx(pull, rel=0.06)


def test_the_classical_pull_of_a_sinusoidal_field():
    """pi r B^2/(2 mu_0 g) of 0.8 T, 50 mm and 1 mm: 40 N for each micron and metre."""
    mean_stress = 0.8**2 / 2 / (2 * MU_0)
    assert classical_pull(mean_stress, 0.05, 1e-3) == pytest.approx(pi * 0.05 * 0.8**2 / (2 * MU_0 * 1e-3))
    assert classical_pull(mean_stress, 0.05, 1e-3) == pytest.approx(40e6, rel=1e-3)
