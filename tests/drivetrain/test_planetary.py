"""Planetary gearbox: kinematics, kinetic energy, contact stress, printed sizes."""

from dataclasses import replace
from math import pi, sqrt

import pytest

from drivetrain.planetary import (
    NITRIDED_STEEL,
    GearboxDesign,
    GearboxError,
    GroundTeethDynamicFactor,
    PlanetaryStage,
    PrintedDynamicFactor,
    StageShape,
    face_width,
)
from units import MILLIMETRE

RATIOS = [2.5, 4.2, 8.7, 13.0]
STEEL = 7800.0


def disc(diameter, width):
    """Mass and polar inertia of a solid steel disc."""
    mass = STEEL * width * pi * diameter**2 / 4
    return mass, mass * diameter**2 / 8


def kinetic_energy(shape, width, carrier_speed):
    """Sun and planets that roll inside the fixed ring, solid carrier; speeds from rolling contacts alone."""
    centre_velocity = carrier_speed * shape.carrier_diameter / 2
    planet_speed = -centre_velocity / (shape.planet_diameter / 2)  # no slip at the fixed ring
    sun_speed = 2 * centre_velocity / (shape.sun_diameter / 2)  # far side of the rolling planet
    planet_mass, planet_inertia = disc(shape.planet_diameter, width)
    planets = shape.planets * (planet_mass * centre_velocity**2 + planet_inertia * planet_speed**2) / 2
    sun = disc(shape.sun_diameter, width)[1] * sun_speed**2 / 2
    return sun + planets + disc(shape.carrier_diameter, width)[1] * carrier_speed**2 / 2


@pytest.mark.parametrize("ratio", RATIOS)
def test_wheels_fit_into_the_ring(ratio):
    shape = StageShape(ratio, 72 * MILLIMETRE)
    assert shape.sun_diameter + 2 * shape.planet_diameter == pytest.approx(shape.ring_diameter, rel=1e-14)
    assert shape.sun_diameter + shape.planet_diameter == pytest.approx(shape.carrier_diameter, rel=1e-14)
    assert 1 + shape.ring_diameter / shape.sun_diameter == pytest.approx(ratio, rel=1e-14)


@pytest.mark.parametrize("planets", [2, 3, 5])
@pytest.mark.parametrize("ratio", RATIOS)
def test_inertia_holds_the_kinetic_energy(ratio, planets):
    stage = PlanetaryStage(StageShape(ratio, 72 * MILLIMETRE, planets), 9 * MILLIMETRE, 85 * MILLIMETRE, STEEL)
    energy = kinetic_energy(stage.shape, stage.face_width, carrier_speed=3.7)
    assert stage.inertia_at_carrier * 3.7**2 / 2 == pytest.approx(energy, rel=1e-12)


def test_orbits_double_the_printed_inertia():
    i = 8.7
    stage = PlanetaryStage(StageShape(i, 72 * MILLIMETRE), 9 * MILLIMETRE, 85 * MILLIMETRE, STEEL)
    size = STEEL * stage.face_width * stage.shape.ring_diameter**4
    printed = pi / 128 * size * i**2 / (i - 1) ** 4 * (i**2 - 3 * i + 7)
    assert stage.inertia_at_carrier / printed == pytest.approx(2.19, abs=0.005)


def test_mass_is_that_of_the_discs_and_the_rim():
    stage = PlanetaryStage(StageShape(8.7, 72 * MILLIMETRE), 9 * MILLIMETRE, 85 * MILLIMETRE, STEEL)
    shape, width = stage.shape, stage.face_width
    wheels = disc(shape.sun_diameter, width)[0] + 3 * disc(shape.planet_diameter, width)[0]
    rim = disc(85 * MILLIMETRE, width)[0] - disc(shape.ring_diameter, width)[0]
    assert stage.mass == pytest.approx(wheels + disc(shape.carrier_diameter, width)[0] + rim, rel=1e-12)


@pytest.mark.parametrize("ratio", RATIOS)
def test_face_width_puts_the_sun_at_its_contact_limit(ratio):
    """sigma_H^2 = Z^2 F_t / (b d_sun) (u + 1)/u of the sun-planet pair, with a third of the sun's torque per mesh."""
    shape, torque, speed = StageShape(ratio, 72 * MILLIMETRE), 50.0, 0.6
    width = face_width(shape, torque, speed, NITRIDED_STEEL)
    force = torque / ratio / 3 / (shape.sun_diameter / 2)
    gear_ratio = shape.planet_diameter / shape.sun_diameter
    factor = NITRIDED_STEEL.pitting_factor(ratio * speed * shape.sun_diameter / 2)
    stress = factor * sqrt(force / (width * shape.sun_diameter) * (gear_ratio + 1) / gear_ratio)
    assert stress == pytest.approx(1500e6, rel=1e-12)


def test_pitting_factor_at_rest():
    """Z_E of steel on steel is 191 sqrt(MPa), Z_H at 20 degrees 2.495."""
    assert NITRIDED_STEEL.pitting_factor(0.0) == pytest.approx(191.6e3 * 2.495 * sqrt(1.5), rel=1e-3)


def test_dynamic_factors():
    assert PrintedDynamicFactor().at(1.0) == pytest.approx(6.6 / 5.6)
    assert GroundTeethDynamicFactor().at(1.0) == pytest.approx(sqrt(6.56 / 5.56))
    assert PrintedDynamicFactor().at(0.0) == GroundTeethDynamicFactor().at(0.0) == 1.0


def test_first_stage_width_of_the_thesis(thesis):
    first = thesis.gearbox.size(envelope_radius=42.5 * MILLIMETRE, transmission_ratio=2.3 * MILLIMETRE).stages[0]
    assert 8.9 * MILLIMETRE <= first.face_width <= 9.0 * MILLIMETRE


def test_the_handbook_dynamic_factor_narrows_the_teeth_by_less_than_three_percent(thesis):
    laws = replace(NITRIDED_STEEL, dynamic_factor=GroundTeethDynamicFactor())
    size = dict(envelope_radius=42.5 * MILLIMETRE, transmission_ratio=2.3 * MILLIMETRE)
    ratio = replace(thesis.gearbox, laws=laws).size(**size).stages[0].face_width / (
        thesis.gearbox.size(**size).stages[0].face_width
    )
    assert 0.97 < ratio < 1.0


def test_the_carrier_of_the_first_stage_turns_with_the_linkage(thesis):
    """Torque of stage 1 is F tau_l, of stage 2 a stage ratio less; widths follow but for the dynamic factor."""
    box = thesis.gearbox.size(envelope_radius=42.5 * MILLIMETRE, transmission_ratio=2.3 * MILLIMETRE)
    shape, laws = box.stages[0].shape, thesis.gearbox.laws
    assert box.stages[0].face_width == pytest.approx(face_width(shape, 300 * 0.170, 0.1 / 0.170, laws), rel=1e-12)
    second = face_width(shape, 300 * 0.170 / shape.ratio, 0.1 / 0.170 * shape.ratio, laws)
    assert box.stages[1].face_width == pytest.approx(second, rel=1e-12)


def test_equivalent_mass_is_the_kinetic_energy_at_the_wheel(thesis):
    box = thesis.gearbox.size(envelope_radius=42.5 * MILLIMETRE, transmission_ratio=2.3 * MILLIMETRE)
    wheel_velocity, energy, speed = 0.4, 0.0, 0.4 / 0.170
    for stage in box.stages:
        energy += kinetic_energy(stage.shape, stage.face_width, speed)
        speed *= stage.shape.ratio
    assert box.equivalent_mass * wheel_velocity**2 / 2 == pytest.approx(energy, rel=1e-12)
    assert speed == pytest.approx(wheel_velocity / (2.3 * MILLIMETRE), rel=1e-12)  # the motor


def test_planets_overlap_above_a_ratio_of_14_93():
    assert StageShape(14.9, 0.07).planets_clear_each_other
    assert not StageShape(14.96, 0.07).planets_clear_each_other
    box = GearboxDesign(1, 0.170, 300.0, 0.1).size(envelope_radius=0.0425, transmission_ratio=4e-3)
    assert "3 planets overlap" in box.notes[0]


def test_a_ratio_without_planets_is_refused():
    with pytest.raises(GearboxError, match="ratio above 2"):
        GearboxDesign(3, 0.170, 300.0, 0.1).size(envelope_radius=0.0425, transmission_ratio=25e-3)
