"""Root strength: published form factors, the generated fillet itself, the rack as the limit of a ring."""

import numpy as np
import pytest
from scipy.optimize import brentq

from gearbox.involute import ISO_53_A, BasicRack, Gear
from gearbox.material import CASE_HARDENED_MQ
from gearbox.root import (
    outer_single_contact_radii,
    permissible_root_stress,
    root_roughness_factor,
    root_section,
    root_stress,
    static_root_strength,
)
from units import DEGREE

# Y_Fa and Y_Sa for load at the tip, standard rack with rho_fP = 0.38 m, x = 0: the table of DIN 3990-3 method C
# that machine-design textbooks print (rounded, read from a chart).
PUBLISHED = {17: (2.97, 1.52), 20: (2.80, 1.55), 25: (2.62, 1.59), 30: (2.52, 1.625), 40: (2.40, 1.67),
             50: (2.32, 1.70), 100: (2.18, 1.79), 150: (2.14, 1.83), 200: (2.12, 1.865)}  # fmt: skip


@pytest.mark.parametrize("teeth", PUBLISHED)
def test_published_form_and_stress_factors(teeth):
    gear = Gear(teeth, 0.0, 1.0, teeth / 2 + 1)
    section = root_section(gear, gear.tip_radius)
    form, stress = PUBLISHED[teeth]
    assert section.form_factor == pytest.approx(form, rel=0.008)
    assert section.stress_correction == pytest.approx(stress, rel=0.006)


def generated_fillet(gear, roll):
    """Point of the fillet that the rack's rounding cuts when the gear has rolled by an angle, tooth on the y axis.

    The centre of the rounding moves with the rack; the normal of the cut passes through the pitch point.
    """
    rack, r = gear.rack, gear.reference_radius
    m, alpha = gear.module, rack.pressure_angle
    depth = (rack.dedendum - rack.fillet_radius - gear.shift) * m  # of the centre below the pitch line
    half_land = np.pi / 4 - rack.dedendum * np.tan(alpha) - rack.fillet_radius * (1 - np.sin(alpha)) / np.cos(alpha)
    centre = np.pi / 2 * m - half_land * m + 1j * (r - depth)  # rounding beside the tooth, before rolling
    centre = centre + r * roll  # the rack moves along x
    pitch_point = 1j * r
    normal = (centre - pitch_point) / abs(centre - pitch_point)
    return (centre + rack.fillet_radius * m * normal) * np.exp(1j * roll)  # turned back into the gear


@pytest.mark.parametrize("teeth, shift", [(14, 0.483), (46, 0.076), (25, 0.0), (80, -0.3)])
def test_critical_section_is_the_30_degree_tangent_of_the_generated_fillet(teeth, shift):
    gear = Gear(teeth, shift, 1.0, teeth / 2 + 1 + shift)

    def slope(roll):
        tangent = generated_fillet(gear, roll + 1e-6) - generated_fillet(gear, roll - 1e-6)
        return np.degrees(np.arctan(abs(tangent.real / tangent.imag))) - 30

    rolls = np.linspace(-1.2, 0.6, 2001)
    values = np.array([slope(roll) for roll in rolls])
    crossings = np.flatnonzero((values[:-1] * values[1:] < 0) & (np.abs(values[:-1]) < 5))
    chords = [2 * generated_fillet(gear, brentq(slope, rolls[k], rolls[k + 1])).real for k in crossings]
    section = root_section(gear, gear.tip_radius)
    assert min(abs(chord - section.chord) for chord in chords) < 1e-5


def test_a_ring_of_many_teeth_is_a_rack():
    """Chord and fillet where the 60 degree tangent touches the rounding of a rack tooth."""
    rack = BasicRack(1.0, 1.25, 0.3, 20 * DEGREE)
    section = root_section(Gear(-2_000_000, 0.0, 1.0, 1e6 - 1.0, rack), 1e6 - 1.0)
    land = (
        np.pi / 4
        - 1.25 * np.tan(rack.pressure_angle)
        - 0.3 * (1 - np.sin(rack.pressure_angle)) / np.cos(rack.pressure_angle)
    )
    assert section.chord == pytest.approx(2 * (np.pi / 2 - land - 0.3 * np.cos(60 * DEGREE)), abs=1e-5)
    assert section.fillet == pytest.approx(0.3, abs=1e-5)
    assert section.load_angle == pytest.approx(20 * DEGREE, abs=1e-5)


def test_published_internal_gear():
    """Y_Fa 2.053 and Y_Sa 2.65, textbook values for internal gears, read as a rack with 0.15 m fillet: 7 %."""
    rack = BasicRack(1.0, 1.25, 0.15, 20 * DEGREE)
    section = root_section(Gear(-1_000_000, 0.0, 1.0, 5e5 - 1.0, rack), 5e5 - 1.0)
    assert section.form_factor == pytest.approx(2.053, rel=0.07)
    assert section.stress_correction == pytest.approx(2.65, rel=0.04)


def test_load_point_is_one_base_pitch_before_the_end_of_the_other_gear(printed):
    mesh = printed.sun_mesh
    pinion, _ = outer_single_contact_radii(mesh)
    curvature = np.sqrt(pinion**2 - mesh.pinion.base_radius**2)
    assert curvature == pytest.approx(mesh.pinion_curvature_at_start + mesh.base_pitch, rel=1e-12)
    assert pinion < mesh.pinion.tip_radius


def test_a_slender_beam_has_the_textbook_stress():
    """Y_F alone is bending: sigma = 6 F cos(a) h / (b s^2) for the chord and arm that it was made from."""
    gear = Gear(25, 0.0, 2e-3, 27e-3)
    section = root_section(gear, gear.tip_radius)
    force, width = 1000.0, 0.02
    beam = 6 * force / np.cos(20 * DEGREE) * np.cos(section.load_angle) * section.lever / (width * section.chord**2)
    assert root_stress(section, force, width) == pytest.approx(beam * section.stress_correction, rel=1e-12)


def test_strengths(printed):
    """The test gear's notch has no correction; static strength is 2.5 times with its own notch rule."""
    section = root_section(printed.sun, printed.sun.tip_radius)
    limit = permissible_root_stress(section, CASE_HARDENED_MQ, 10e-6)
    assert limit / (2 * 461e6) == pytest.approx(1.0, abs=0.01)
    static = static_root_strength(section, CASE_HARDENED_MQ)
    assert static == pytest.approx(2 * 461e6 * 2.5 * (0.44 * section.stress_correction + 0.12))
    assert root_roughness_factor(0.5e-6) == 1.12 and root_roughness_factor(10e-6) == pytest.approx(1.0, abs=0.003)


def test_a_larger_shift_thickens_the_root():
    chords = [root_section(Gear(14, x, 1.0, 8.0 + x), 8.0 + x).chord for x in (0.2, 0.5, 0.8)]
    assert chords[0] < chords[1] < chords[2]
    assert ISO_53_A.fillet_radius == 0.38
