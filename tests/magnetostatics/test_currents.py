"""Any currents in phases and coils, and coils whose turns are not as designed."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.errors import GeometryError
from magnetostatics.currents import CoilCurrents, PhaseCurrents, coil_currents
from magnetostatics.flux_linkage import coil_flux_linkage, phase_flux_linkage
from magnetostatics.model import OperatingPoint
from magnetostatics.torque import arkkio_torque
from tests.magnetostatics.reference_machine import TIGHT, model_of, reference_machine
from tests.magnetostatics.whole_machine import whole_model

POINT = OperatingPoint(-0.353, 6e6 * sqrt(2), 0.2)
UNBALANCED = PhaseCurrents(-0.353, (30.0, -5.0, -11.0), turns=7)


def with_turns(model, turns):
    return model.like(replace(model.section, layout=model.section.layout.with_turns(turns)))


@pytest.mark.parametrize("whole", (False, True))
def test_a_balanced_supply_in_phase_currents(whole):
    """N i = J k_cp A_s: the same right-hand side in amperes as in amperes per square metre."""
    model = model_of(reference_machine(), whole=whole)
    densities = POINT.phase_densities(5, model.section.layout.phase_axis)
    currents = densities * 0.3 * model.section.half_slot_area / 7
    assert_allclose(model.load(PhaseCurrents(POINT.angle, tuple(currents), 7)), model.load(POINT), rtol=1e-12)


def test_turns_times_currents_is_what_counts():
    model = model_of(reference_machine())
    other = PhaseCurrents(UNBALANCED.angle, tuple(7 * i for i in UNBALANCED.currents))
    assert_allclose(model.load(UNBALANCED), model.load(other), rtol=1e-14)


def test_half_the_machine_stands_for_the_whole_at_unbalanced_currents():
    half = model_of(reference_machine(), settings=TIGHT).solve(UNBALANCED)
    whole = model_of(reference_machine(), whole=True, settings=TIGHT).solve(UNBALANCED)
    assert_allclose(phase_flux_linkage(half), phase_flux_linkage(whole), rtol=1e-6)
    assert_allclose(arkkio_torque(half), arkkio_torque(whole), rtol=1e-6)


@pytest.mark.parametrize("layers", (2, 1))
def test_coils_add_up_to_phases(layers):
    model = model_of(reference_machine(), whole=True, layers=layers)
    solution = model.solve(UNBALANCED)
    coils, layout = coil_flux_linkage(solution), model.section.layout
    sums = [sum(k.sign * psi for k, psi in zip(layout.coils, coils) if k.phase == i) for i in range(3)]
    assert_allclose(phase_flux_linkage(solution), sums, rtol=1e-12)


def test_flux_of_a_tooth_coil_is_that_through_its_tooth():
    """Magnet 0, outwards, on tooth 0: coil 0 links the largest positive flux, the one opposite the largest negative."""
    psi = coil_flux_linkage(whole_model().solve(PhaseCurrents(0.0, (0.0, 0.0, 0.0))))
    assert np.argmax(psi) == 0 and np.argmin(psi) == 6
    assert psi[0] == pytest.approx(-psi[6], rel=1e-6)
    assert 1.2 < psi[0] / 5.5e-3 < 1.6  # T in the tooth


def test_the_same_currents_coil_by_coil():
    model = whole_model()
    for point in (POINT, UNBALANCED):
        assert_allclose(model.load(coil_currents(point, model.section)), model.load(point), rtol=1e-12)


def test_a_coil_with_lost_turns():
    """Coil 6 without a tenth of its turns: that much less flux linkage of its phase and of ampere-turns in it."""
    base = whole_model()
    model = with_turns(base, {6: 0.9})
    idle = PhaseCurrents(-0.353, (0.0, 0.0, 0.0))
    sound, lost = base.solve(idle), model.solve(idle)
    coil = base.section.layout.coils[6]
    change = phase_flux_linkage(lost) - phase_flux_linkage(sound)
    expected = np.zeros(3)
    expected[coil.phase] = -0.1 * coil.sign * coil_flux_linkage(sound)[6]
    assert_allclose(change, expected, atol=1e-10)
    missing = 0.1 * coil.sign * UNBALANCED.ampere_turns(base.section)[coil.phase] * base.coil_loads[6]
    assert_allclose(base.load(UNBALANCED) - model.load(UNBALANCED), missing, atol=1e-9)


def test_all_coils_with_fewer_turns_scale_flux_linkage():
    model = with_turns(whole_model(), {k: 0.8 for k in range(12)})
    fields = whole_model().solve(replace(UNBALANCED, turns=5.6)), model.solve(UNBALANCED)
    assert_allclose(phase_flux_linkage(fields[1]), 0.8 * phase_flux_linkage(fields[0]), rtol=1e-8)


def test_turns_that_differ_break_the_sector():
    from geometry.cross_section import mesh_cross_section

    layout = model_of(reference_machine()).section.layout
    assert mesh_cross_section(reference_machine(), layout.with_turns({3: 0.5})).sectors == 1
    assert mesh_cross_section(reference_machine(), layout.with_turns({3: 0.5, 9: 0.5})).sectors == 2


def test_shorted_turns_push_the_flux_out_of_their_coil():
    """A current in shorted turns of coil 4 against its flux lowers that flux."""
    model = whole_model()
    angle = -0.353
    currents = np.zeros(12)
    psi = coil_flux_linkage(model.solve(CoilCurrents(angle, tuple(currents))))[4]
    currents[4] = -100.0 * np.sign(psi)
    assert abs(coil_flux_linkage(model.solve(CoilCurrents(angle, tuple(currents))))[4]) < abs(psi)


def test_what_a_sector_cannot_tell_is_refused():
    half = model_of(reference_machine())
    with pytest.raises(GeometryError, match="whole machine"):
        coil_flux_linkage(half.solve(POINT))
    with pytest.raises(GeometryError, match="whole machine"):
        half.load(CoilCurrents(0.0, (0.0,) * 12))
    with pytest.raises(GeometryError, match="12 coils, found the currents of 3"):
        whole_model().load(CoilCurrents(0.0, (1.0, 2.0, 3.0)))
    with pytest.raises(GeometryError, match="no coil 12"):
        half.section.layout.with_turns({12: 0.9})
    with pytest.raises(GeometryError, match="zero or more"):
        half.section.layout.with_turns({2: -0.9})
