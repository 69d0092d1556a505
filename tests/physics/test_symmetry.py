"""A sector stands for the whole machine, and the field has the symmetries of machine and winding."""

from __future__ import annotations

from functools import cache
from math import pi, sqrt

import pytest
from numpy.testing import assert_allclose

from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import OperatingPoint
from magnetostatics.probes import probe_reader
from magnetostatics.torque import arkkio_torque, maxwell_torque
from tests.magnetostatics.reference_machine import TIGHT, model_of, reference_machine
from tests.physics.coenergy import coenergy
from units import DEGREE, MILLIMETRE

pytestmark = pytest.mark.physics

# slots, pole pairs, other dimensions, sectors, sign of the potential from one to the next
MACHINES = {
    "12/10 half": (dict(slots=12), 2, -1),
    "12/8 quarter": (dict(slots=12, pole_pairs=4), 4, 1),
    "24/20 quarter": (dict(slots=24, pole_pairs=10, back_iron_width=1.8 * MILLIMETRE), 4, -1),
}
AMPLITUDE = 6e6 * sqrt(2)
ANGLE = -20.3 * DEGREE  # between two nodes


@cache
def solved(name, whole, layers=2):
    model = model_of(reference_machine(**MACHINES[name][0]), whole=whole, layers=layers, settings=TIGHT)
    return model.solve(OperatingPoint(ANGLE, AMPLITUDE, 0.2))


@pytest.mark.parametrize("name", MACHINES)
def test_which_sector_is_solved(name):
    _, sectors, sign = MACHINES[name]
    assert (solved(name, False).model.section.sectors, solved(name, False).model.section.sign) == (sectors, sign)
    assert (solved(name, True).model.section.sectors, solved(name, True).model.section.sign) == (1, 1)


@pytest.mark.parametrize("quantity", (arkkio_torque, maxwell_torque, coenergy))
@pytest.mark.parametrize("name", MACHINES)
def test_sector_and_whole_machine_have_the_same(quantity, name):
    assert_allclose(quantity(solved(name, False)), quantity(solved(name, True)), rtol=1e-6)


@pytest.mark.parametrize("name", MACHINES)
def test_sector_and_whole_machine_have_the_same_flux_linkage(name):
    assert_allclose(phase_flux_linkage(solved(name, False)), phase_flux_linkage(solved(name, True)), rtol=1e-6)


@pytest.mark.parametrize("name", MACHINES)
def test_sector_and_whole_machine_have_the_same_flux_densities(name):
    """Every probe of the sector, and its repetition in the next sector of the whole machine."""
    sector, whole = (probe_reader(field.model).read(field) for field in (solved(name, False), solved(name, True)))
    teeth = solved(name, False).model.section.teeth
    for probe, value in sector.items():
        part, number = probe.rsplit("_", 1)
        assert_allclose([whole[probe], whole[f"{part}_{int(number) + teeth}"]], value, rtol=1e-5)


def test_half_machine_with_a_single_layer():
    """With one layer coil 6 is still minus coil 0: the half machine stands for the whole."""
    assert solved("12/10 half", False, 1).model.section.sectors == 2
    half, whole = (arkkio_torque(solved("12/10 half", whole, 1)) for whole in (False, True))
    assert_allclose(half, whole, rtol=1e-6)


@cache
def nine_slots(angle, gamma=0.2):
    model = model_of(reference_machine(slots=9), settings=TIGHT)
    return model.solve(OperatingPoint(angle, AMPLITUDE, gamma))


def test_nine_slots_have_no_sector():
    section = nine_slots(ANGLE).model.section
    assert (section.sectors, section.teeth, section.magnets) == (1, 9, 10)


@pytest.mark.parametrize("turn", (pi / 5, 2 * pi / 5, 2 * pi / 3))
def test_nine_slots_turned_by_what_they_repeat_on(turn):
    """One pole on, currents and magnets change sign together; a third of a turn on, the phases change places."""
    for route in (arkkio_torque, maxwell_torque, coenergy):
        assert_allclose(route(nine_slots(ANGLE + turn)), route(nine_slots(ANGLE)), rtol=1e-6)


def test_nine_slots_turned_by_a_pole_reverse_their_flux():
    assert_allclose(phase_flux_linkage(nine_slots(ANGLE + pi / 5)), -phase_flux_linkage(nine_slots(ANGLE)), rtol=1e-6)


@pytest.mark.parametrize("name", ("12/10 half", "12/8 quarter"))
def test_mirror_image(name):
    """Seen from behind, rotor angle, phase sequence and torque change sign: T(-theta) = -T(theta) without current."""
    model = solved(name, False).model
    torques = [arkkio_torque(model.solve(OperatingPoint(sign * ANGLE))) for sign in (1, -1)]
    assert abs(torques[0]) > 0.1
    assert_allclose(torques[1], -torques[0], rtol=1e-5)


def test_motoring_and_braking_are_mirror_images():
    """Mirroring the machine about the axis of phase A turns (theta, i_q) into (-theta, -i_q)."""
    model = solved("12/10 half", False).model
    axis = model.section.layout.phase_axis / 5 - pi / 2 / 5 - pi / 10  # magnet 0 on the axis of phase A, p theta = axis
    for offset in (1.1 * DEGREE, 3.7 * DEGREE):
        motoring = model.solve(OperatingPoint(axis + offset, AMPLITUDE, 0.2))
        braking = model.solve(OperatingPoint(axis - offset, AMPLITUDE, pi - 0.2))
        assert_allclose(arkkio_torque(braking), -arkkio_torque(motoring), rtol=1e-8)
