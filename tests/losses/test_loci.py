"""Loci of the reference machine: symmetry against brute force, and flux against flux linkage."""

from dataclasses import replace

import numpy as np
import pytest

from geometry.winding import star_of_slots
from losses.iron import iron_loss
from losses.loci import (
    HALF_WAVE,
    WHOLE_PERIOD,
    PartOfPeriod,
    finest_repetition,
    rotor_loci,
    solve_part,
    stator_loci,
)
from losses.magnet import magnet_loss
from magnetostatics.flux_linkage import phase_flux_linkage
from materials.iron_loss import iron_loss_law
from tests.losses.conftest import made, model, phase, point

LAW = iron_loss_law("M235-35A")


@pytest.fixture(scope="module")
def whole_period(reference):
    return solve_part(reference, point(gamma=0.4), 24, WHOLE_PERIOD)


def same_loci(one, other, tolerance):
    """Loci agree where both have values; one may repeat itself."""
    steps = min(len(one.values), len(other.values))
    assert np.abs(one.values[:steps] - other.values[:steps]).max() < tolerance


@pytest.mark.physics
@pytest.mark.parametrize("repetition", [HALF_WAVE, None], ids=["half wave", "sixth"])
def test_symmetry_gives_the_loci_of_the_whole_period(reference, whole_period, repetition):
    """Every element, every step, stator and rotor: copying is exact but for what Newton's method leaves."""
    part = solve_part(reference, point(gamma=0.4), 24, repetition)
    assert len(part.solutions) < len(whole_period.solutions)
    for loci in (stator_loci, rotor_loci):
        same_loci(loci(part), loci(whole_period), 1e-7)  # T; the field reaches 2.4 T
    assert magnet_loss(part).eddy == pytest.approx(magnet_loss(whole_period).eddy, rel=1e-6)


@pytest.mark.physics
@pytest.mark.slow
@pytest.mark.parametrize("slots", [9, 15])
def test_sixth_of_other_machines(slots):
    """9 slots are solved as a whole; 15 in five sectors."""
    own = model(slots)
    part, half = (solve_part(own, point(), 12, repetition) for repetition in (None, HALF_WAVE))
    assert part.repetition.parts == 6
    for loci in (stator_loci, rotor_loci):
        same_loci(loci(part), loci(half), 1e-7)


@pytest.mark.physics
def test_half_the_machine_is_the_machine(loaded):
    whole = solve_part(model(whole=True), point(), 12)
    half = solve_part(loaded.model, point(), 12)
    for loci in (stator_loci, rotor_loci):
        one, other = (iron_loss(loci(part), LAW).total.at(333.0) for part in (half, whole))
        assert one == pytest.approx(other, rel=1e-3)
    assert magnet_loss(half).eddy == pytest.approx(magnet_loss(whole).eddy, rel=1e-4)


@pytest.mark.physics
def test_rotor_sees_multiples_of_six_fifths(whole_period):
    """12 slots, 10 poles: in the rotor's frame only orders 1.2 n of the electrical frequency exist."""
    orders, amplitude = rotor_loci(whole_period).spectrum()
    foreign = np.abs(orders / 1.2 - np.round(orders / 1.2)) > 1e-9
    assert amplitude[foreign].max() < 1e-6 < 0.02 < amplitude[(orders > 0) & ~foreign].max()


def test_periods(loaded):
    assert stator_loci(loaded).periods == 1 and rotor_loci(loaded).periods == pytest.approx(5 / 6)
    assert len(stator_loci(loaded).values) == 48 and len(rotor_loci(loaded).values) == 40


@pytest.mark.physics
def test_stator_field_is_half_wave_symmetric(loaded):
    values = stator_loci(loaded).values
    assert np.abs(values + np.roll(values, 24, axis=0)).max() < 1e-12


@pytest.mark.physics
def test_tooth_flux_is_the_flux_linkage(idle):
    """Without current: 4 coils times tooth flux times the distribution factor is the linkage of a phase, so the EMF.

    The flux is averaged over the height of the tooth, by the elements with their centre in it; what crosses the slot
    instead of reaching the coil's far end is less than 1 %.
    """
    section, loci = idle.model.section, stator_loci(idle)
    m = section.machine
    x, y = section.mesh.p[:, section.mesh.t[:, loci.elements]].mean(axis=1)
    body = (np.abs(y) < m.tooth_width / 2) & (x > m.shoe_top_radius) & (x < m.slot_bottom_radius)
    flux = m.tooth_width * (loci.values[:, body, 0] @ loci.area[body]) / loci.area[body].sum()
    fundamental = 2 * np.abs(np.fft.rfft(flux)[1]) / len(flux)
    linkage = np.array([phase_flux_linkage(solution) for solution in idle.solutions])
    amplitude = np.sqrt(2 / 3 * (linkage**2).sum(1)).mean()
    distribution = section.layout.winding_factor() / np.sin(np.pi * 5 / 12)  # a tooth is a coil
    assert 4 * distribution * fundamental == pytest.approx(amplitude, rel=0.01)


def test_rate_is_the_derivative():
    values = np.cos(2 * phase(48)) + 0.3 * np.sin(5 * phase(48))
    expected = 2 * np.pi * (-2 * np.sin(2 * phase(48)) + 1.5 * np.cos(5 * phase(48)))
    assert made(values).rate()[:, 0, 0] == pytest.approx(expected, abs=1e-10)
    assert made(values, periods=2.0).rate()[:, 0, 0] == pytest.approx(expected / 2, abs=1e-10)


def test_twice_the_steps_change_little(loaded):
    fine = solve_part(loaded.model, point(), 96)
    one, other = (iron_loss(stator_loci(part), LAW).total.at(333.0) for part in (loaded, fine))
    assert one == pytest.approx(other, rel=1e-3)
    one, other = (iron_loss(rotor_loci(part), LAW).total.at(333.0) for part in (loaded, fine))
    assert one == pytest.approx(other, rel=0.03)


def test_winding_without_a_sixth(reference):
    """A phase moved by hand: only the half wave is left."""
    section = reference.section
    coils = list(section.layout.coils)
    coils[0], coils[6] = replace(coils[0], sign=-coils[0].sign), replace(coils[6], sign=-coils[6].sign)
    odd = replace(section, layout=replace(section.layout, coils=tuple(coils)))
    assert finest_repetition(section).parts == 6 and finest_repetition(odd) == HALF_WAVE


@pytest.mark.parametrize("slots, poles", [(12, 8), (12, 10), (12, 14), (9, 8), (9, 10), (18, 16), (36, 6)])
def test_every_balanced_winding_has_a_sixth(slots, poles, reference):
    own = replace(reference.section.machine, slots=slots, pole_pairs=poles // 2)
    section = replace(reference.section, machine=own, layout=star_of_slots(slots, poles // 2))
    assert finest_repetition(section).parts == 6


def test_wrong_sequences_are_refused(idle, loaded):
    with pytest.raises(ValueError, match="equally spaced"):
        PartOfPeriod(idle.solutions[::2] + idle.solutions[-1:], idle.repetition)
    with pytest.raises(ValueError, match="equally spaced"):
        PartOfPeriod(idle.solutions, HALF_WAVE)
    with pytest.raises(ValueError, match="same current"):
        PartOfPeriod(idle.solutions[:4] + loaded.solutions[4:], idle.repetition)
    with pytest.raises(ValueError, match="multiple of 6"):
        solve_part(idle.model, point(), 40)
