"""Losses along the path of contact and from power balance; inertia from kinetic energy; mass of the scaling laws."""

from math import pi

import numpy as np
import pytest

from drivetrain.planetary import PlanetaryStage, StageShape
from gearbox.bodies import Construction, inertia_at_carrier, planet_speed, solid_bodies, total_mass
from gearbox.efficiency import basic_efficiency, loss_factor, stage_efficiency
from gearbox.errors import GearError
from gearbox.involute import Gear, Mesh, centre_distance
from gearbox.planetary_set import PlanetarySet
from units import DEGREE, MILLIMETRE

MM = MILLIMETRE


def outer_pair():
    gears = [Gear(z, 0.0, MM, (z / 2 + 1) * MM) for z in (25, 40)]
    return Mesh(*gears, centre_distance(25, 40, 0.0, MM, 20 * DEGREE))


def integrated_loss(mesh):
    """Sum over pairs in contact of load share times sliding over rolling speed, averaged over one base pitch."""
    start, pitch = mesh.pinion_curvature_at_start, mesh.base_pitch
    position = start + (np.arange(200000) + 0.5) / 200000 * mesh.contact_ratio * pitch
    alone = (position - start > (mesh.contact_ratio - 1) * pitch) & (position - start < pitch)
    share = np.where(alone, 1.0, 0.5)
    spin = 1.0 / mesh.pinion.base_radius  # pinion turns so that its base circle moves at 1 m/s
    wheel_spin = spin / abs(mesh.ratio)
    sliding = np.abs(spin * position - wheel_spin * mesh.wheel_curvature(position))
    return np.mean(share * sliding) * mesh.contact_ratio  # rolling speed of the base circles is 1


@pytest.mark.parametrize("name", ["outer", "sun_mesh", "ring_mesh"])
def test_loss_factor_is_the_integral_over_the_path_of_contact(printed, name):
    mesh = outer_pair() if name == "outer" else getattr(printed, name)
    # the loss factor is per power of the working force at the base circle
    assert loss_factor(mesh) == pytest.approx(integrated_loss(mesh), rel=1e-4)


def test_published_form_of_the_loss_factor():
    """pi (1/z_1 + 1/z_2) (1 - eps + eps_1^2 + eps_2^2)."""
    mesh = outer_pair()
    eps_1, eps_2 = mesh.addendum_contact_ratios
    expected = pi * (1 / 25 + 1 / 40) * (1 - mesh.contact_ratio + eps_1**2 + eps_2**2)
    assert loss_factor(mesh) == pytest.approx(expected, rel=1e-12)


def test_stage_efficiency_from_the_power_that_rolls_through_the_teeth(printed):
    """Torque balance seen from the carrier: the rolling power is that of the sun relative to the carrier."""
    friction = 0.05
    eta, i = basic_efficiency(printed, friction), printed.ratio
    carrier_drives, sun_drives = stage_efficiency(printed, friction)
    sun, ring = 1.0, (i - 1) * eta  # torques, the sun drives: ring torque lowered by the losses
    assert sun_drives == pytest.approx((sun + ring) / (sun * i), rel=1e-12)
    ring = (i - 1) / eta  # the carrier drives: power flows through the teeth towards the sun
    assert carrier_drives == pytest.approx(sun * i / (sun + ring), rel=1e-12)
    assert 0.95 < carrier_drives < sun_drives < 1


def test_no_friction_no_loss(printed):
    assert stage_efficiency(printed, 0.0) == (pytest.approx(1.0), pytest.approx(1.0))
    with pytest.raises(GearError, match="coefficient of friction"):
        basic_efficiency(printed, -0.1)


def scaling_law_set(ratio, ring_diameter):
    """Reference circles of thesis eqs 3.106-3.108 as gears of 1 mm module: no whole tooth numbers needed."""
    ring = ring_diameter / MM
    sun = ring / (ratio - 1)
    planet = (ring - sun) / 2
    gears = (Gear(z, 0.0, MM, 0.0) for z in (sun, planet, -ring))
    return PlanetarySet(*gears, (sun + planet) / 2 * MM, 3)


@pytest.mark.parametrize("ratio", [2.5, 4.2, 8.7, 13.0])
def test_solid_stage_has_the_inertia_of_the_scaling_law(ratio):
    ring, width, rho = 72 * MM, 9 * MM, 7800.0
    bodies = solid_bodies(scaling_law_set(ratio, ring), width, 85 * MM, rho)
    law = pi / 256 * rho * width * ring**4 * ratio**2 / (ratio - 1) ** 4 * (5 * ratio**2 - 18 * ratio + 26)
    assert inertia_at_carrier(bodies) == pytest.approx(law, rel=1e-12)
    stage = PlanetaryStage(StageShape(ratio, ring), width, 85 * MM, rho)
    assert total_mass(bodies) == pytest.approx(stage.mass, rel=1e-12)


def test_printed_law_lacks_the_orbits():
    """Thesis eq. 3.111 is sun, spins and carrier exactly."""
    ring, width, rho, i = 72 * MM, 9 * MM, 7800.0, 8.7
    bodies = solid_bodies(scaling_law_set(i, ring), width, 85 * MM, rho)
    without = sum(body.count * body.inertia * body.speed**2 for body in bodies)
    printed = pi / 128 * rho * width * ring**4 * i**2 / (i - 1) ** 4 * (i**2 - 3 * i + 7)
    assert without == pytest.approx(printed, rel=1e-12)


def test_planets_roll_in_the_ring(printed):
    """No speed where planet and ring roll on each other: pitch circles at the working centre distance."""
    pitch_radius = printed.centre_distance * 46 / (109 - 46)
    assert printed.centre_distance + planet_speed(printed) * pitch_radius == pytest.approx(0.0, abs=1e-15)


def test_built_stage_by_kinetic_energy_of_small_pieces(printed):
    """Planets and pins cut into pieces whose speeds are summed; flanges and sun as in the textbook."""
    build = Construction(bore_fraction=0.5, flange_fraction=0.25, least_flange=1.5 * MM, axial_gap=0.5 * MM)
    bodies = {body.name: body for body in build.bodies(printed, 12 * MM, 85 * MM, 7800.0)}
    pin = 0.5 * printed.planet.root_radius
    radius = np.linspace(pin, printed.planet.reference_radius, 401)
    middle = (radius[1:] + radius[:-1]) / 2
    angle = (np.arange(64) + 0.5) * 2 * pi / 64
    mass = 7800.0 * 12 * MM * pi * np.diff(radius**2)[:, None] / 64
    place = middle[:, None] * np.exp(1j * angle)
    velocity = 1j * (printed.centre_distance + planet_speed(printed) * place)
    energy = 3 * np.sum(mass * np.abs(velocity) ** 2) / 2
    assert bodies["planets"].inertia_at_carrier / 2 == pytest.approx(energy, rel=1e-4)
    pins = 3 * 7800.0 * pi * pin**2 * 19 * MM * (printed.centre_distance**2 + pin**2 / 2)
    assert bodies["pins"].inertia_at_carrier == pytest.approx(pins, rel=1e-12)  # 12 + 2 (3 + 0.5) mm long


def test_thin_stages_keep_their_least_flange():
    build = Construction(0.45, 0.25, 1.5 * MM, 0.5 * MM)
    assert build.flange_thickness(4 * MM) == pytest.approx(1.5 * MM)
    assert build.stage_length(12 * MM) == pytest.approx(19 * MM)
