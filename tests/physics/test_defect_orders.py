"""Mechanical orders that a defect adds to cogging and flux linkage, and the symmetries that they come from.

A defect of the rotor passes all Q slots alike: its cogging repeats after a slot pitch and has orders k Q. A defect of
the stator sees all 2p poles alike: orders k 2p. An eccentricity of one part modulates the gap with order 1, so that of
the orders m Q +- s (static, of degree s in the amplitude) those count that are multiples of 2p, and vice versa
(dynamic).
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import pi

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.defects import DynamicEccentricity, MagnetPosition, SlotOpening, StaticEccentricity
from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import coil_flux_linkage, phase_flux_linkage
from magnetostatics.torque import arkkio_torque, magnetic_pull
from tests.magnetostatics.whole_machine import COARSE, NINE_SLOTS, TWELVE_EIGHT, whole_model, with_defects

pytestmark = pytest.mark.physics

TWELVE_TEN: dict = {}
SHIFT = 0.1e-3  # 20 % of the air gap


def weak(model, number=3, share=0.9):
    magnet = model.materials.magnet
    less = replace(magnet, remanence=share * magnet.remanence)
    return model.like(materials=model.materials.with_magnet(number, less))


ROTOR = {
    "weak magnet": weak,
    "magnet position": lambda model: with_defects(model, MagnetPosition(3, 0.02)),
    "dynamic": lambda model: with_defects(model, DynamicEccentricity(SHIFT, 0.3)),
}
STATOR = {
    "slot opening": lambda model: with_defects(model, SlotOpening(2, 0.5e-3)),
    "static": lambda model: with_defects(model, StaticEccentricity(SHIFT, 0.3)),
}


@cache
def model_with(defect, machine):
    changes = dict(machine)
    model = whole_model(COARSE, **changes)
    return (ROTOR | STATOR)[defect](model) if defect else model


def solve(defect, machine, angle):
    return _solve(defect, tuple(machine.items()), float(angle))


@cache
def _solve(defect, machine, angle):
    return model_with(defect, machine).solve(PhaseCurrents(angle, (0.0, 0.0, 0.0)))


def torque(defect, machine, angle):
    return arkkio_torque(solve(defect, machine, angle))


@cache
def _orders(defect, machine, repeats, steps):
    """Amplitudes [Nm/m] of the cogging that repeats so many times a turn, by mechanical order."""
    angles = 2 * pi / repeats * np.arange(steps) / steps
    found = np.abs(np.fft.rfft([torque(defect, dict(machine), angle) for angle in angles])) * 2 / steps
    return dict(zip((repeats * np.arange(len(found))).tolist(), found))


def orders(defect, machine, repeats, steps):
    return _orders(defect, tuple(machine.items()), repeats, steps)


@pytest.mark.parametrize("defect", ROTOR)
def test_cogging_of_a_rotor_defect_repeats_after_a_slot_pitch(defect):
    first, later, part = (torque(defect, TWELVE_TEN, 0.1 + turn) for turn in (0.0, pi / 6, pi / 30))
    assert later == pytest.approx(first, abs=1e-5)
    assert abs(part - first) > 5e-3  # and no longer after the 6 degrees of the machine as drawn


@pytest.mark.parametrize("defect", STATOR)
def test_cogging_of_a_stator_defect_repeats_after_a_pole_pitch(defect):
    first, later, part = (torque(defect, TWELVE_TEN, 0.1 + turn) for turn in (0.0, pi / 5, pi / 30))
    assert later == pytest.approx(first, abs=1e-5)
    assert abs(part - first) > 5e-3


# Orders above and below a tenth of the largest of the defect, native ones (60) apart
TWELVE_TEN_ORDERS = {
    "weak magnet": (12, 10, {24, 36, 48}),
    "magnet position": (12, 10, {12, 24, 36, 48}),
    "dynamic": (12, 10, {12, 48}),
    "slot opening": (10, 12, {10, 20, 30}),
    "static": (10, 12, {10, 50}),
}


@pytest.mark.parametrize("defect", TWELVE_TEN_ORDERS)
def test_orders_of_twelve_slots_and_ten_poles(defect):
    repeats, steps, expected = TWELVE_TEN_ORDERS[defect]
    found = orders(defect, TWELVE_TEN, repeats, steps)
    new = {order: size for order, size in found.items() if order % 60}
    assert {order for order, size in new.items() if size > 0.1 * max(new.values())} == expected


def test_small_orders_of_a_weak_magnet():
    """12 is there as well, if far smaller than the three above it."""
    found = orders("weak magnet", TWELVE_TEN, 12, 10)
    assert 3e-3 < found[12] < 0.1 * found[24]


@pytest.mark.parametrize(("defect", "repeats", "steps"), (("static", 8, 18), ("dynamic", 12, 12)))
def test_eccentricity_is_silent_in_twelve_slots_and_eight_poles(defect, repeats, steps):
    """Only the fourth degree of the amplitude could be heard: below a thousandth of the native cogging.

    All positions are on the nodes of the sliding circle; between them the mesh itself makes as much.
    """
    found = orders(defect, TWELVE_EIGHT, repeats, steps)
    new = [size for order, size in found.items() if order % 24]
    assert max(new) < 1e-3 * found[24]


@pytest.mark.parametrize(("defect", "order"), (("weak magnet", 12), ("slot opening", 8)))
def test_other_defects_are_heard_in_twelve_slots_and_eight_poles(defect, order):
    found = orders(defect, TWELVE_EIGHT, order, 96 // order)
    assert found[order] > 5e-3 * found[24]


@pytest.mark.parametrize(("defect", "repeats"), (("static", 8), ("dynamic", 9)))
def test_eccentricity_is_loud_in_nine_slots_and_eight_poles(defect, repeats):
    """9 - 1 = 8: the first degree of the amplitude makes cogging of order 8 (static) or 9 (dynamic)."""
    found = orders(defect, NINE_SLOTS, repeats, 12)
    assert found[repeats] > 0.2
    assert found[repeats] > 4 * found[2 * repeats]


@pytest.mark.parametrize("turn", (1, 4))
def test_another_weak_magnet_turns_the_signature(turn):
    """Magnet 3 + k weak is magnet 3 weak with the rotor turned by k poles; the pull stays, flux changes sign with k."""
    base = whole_model(COARSE)
    first, other = weak(base), weak(base, 3 + turn)
    there = first.solve(PhaseCurrents(0.1 + turn * pi / 5, (0.0, 0.0, 0.0)))
    here = other.solve(PhaseCurrents(0.1, (0.0, 0.0, 0.0)))
    assert arkkio_torque(here) == pytest.approx(arkkio_torque(there), abs=1e-5)
    assert_allclose(magnetic_pull(here), magnetic_pull(there), atol=1e-3)
    assert_allclose(phase_flux_linkage(here), (-1) ** turn * phase_flux_linkage(there), atol=1e-8)


def test_all_magnets_weak_together_is_a_weaker_magnet():
    base = whole_model(COARSE)
    all_weak = base
    for number in range(10):
        all_weak = weak(all_weak, number)
    one = base.like(materials=replace(base.materials, magnet=replace(base.materials.magnet, remanence=1.17)))
    assert_allclose(all_weak.magnet_loads, one.magnet_loads, rtol=1e-12, atol=1e-9)


def flux_orders(defect, read):
    """Mechanical orders that a defect adds to what a reader finds over a turn, against the fundamental.

    32 positions: the native orders 5 and 15 of the flux linkage and what lies beside them are not mixed up.
    """
    angles = 2 * pi * np.arange(32) / 32
    sound, defective = ([read(solve(d, TWELVE_TEN, angle)) for angle in angles] for d in (None, defect))
    return np.abs(np.fft.rfft(np.subtract(defective, sound))) / np.abs(np.fft.rfft(sound))[5]


def test_flux_linkage_of_a_weak_magnet():
    """A tenth of one of ten: 1 % of the fundamental, and 3 and 7 beside it in a phase of coils 0, 1, 6 and 7.

    Even orders cancel between opposite coils.
    """
    found = flux_orders("weak magnet", lambda solution: phase_flux_linkage(solution)[0])
    assert found[5] == pytest.approx(0.01, rel=0.1)
    assert min(found[[3, 7]]) > 3e-3
    assert max(found[[2, 4, 6, 8]]) < 1e-4


def test_a_single_coil_hears_a_dynamic_eccentricity():
    """4 = 5 - 1 and 6 = 5 + 1 in one coil, which the phase does not show."""
    coil = flux_orders("dynamic", lambda solution: coil_flux_linkage(solution)[0])
    assert min(coil[[4, 6]]) > 3e-3
    phase = flux_orders("dynamic", lambda solution: phase_flux_linkage(solution)[0])
    assert max(phase[[4, 6]]) < 1e-4
