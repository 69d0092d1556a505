"""Pitting of the flanks: contact stress and permissible stress after ISO 6336-2."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy import cos, sin, sqrt

from gearbox.batch import Batch
from gearbox.involute import Mesh
from gearbox.material import GearMaterial
from units import MILLIMETRE


@dataclass(frozen=True)
class Lubrication:
    """Oil and surface: viscosity_40 nu_40 [m^2/s], flank_roughness and root_roughness R_z [m]."""

    viscosity_40: float
    flank_roughness: float
    root_roughness: float


def zone_factor(mesh: Mesh) -> Batch:
    """Z_H = sqrt(2 cos(alpha_w) / (cos^2(alpha) sin(alpha_w))), spur gears."""
    alpha_w = mesh.working_pressure_angle
    return sqrt(2 * cos(alpha_w) / (cos(mesh.pinion.rack.pressure_angle) ** 2 * sin(alpha_w)))


def contact_ratio_factor(mesh: Mesh) -> Batch:
    """Z_eps = sqrt((4 - eps_alpha) / 3), spur gears."""
    return sqrt((4 - mesh.contact_ratio) / 3)


def single_contact_factors(mesh: Mesh) -> tuple[Batch, Batch]:
    """(Z_B, Z_D), both dimensionless: stress at the inner points of single contact over that at the pitch point.

    sqrt of the relative curvatures rho_C / rho_B, not below 1. For an external pair it is the standard's M_1, M_2. The
    standard sets Z_D = 1 for an internal wheel; Z_B follows from the same curvatures there.
    """
    pitch = mesh.pinion.base_radius * np.tan(mesh.working_pressure_angle)
    inner_pinion = mesh.pinion_curvature_at_tip - mesh.base_pitch
    inner_wheel = mesh.pinion_curvature_at_start + mesh.base_pitch
    at_pitch = mesh.relative_curvature(pitch)
    with np.errstate(invalid="ignore"):
        pair = (sqrt(at_pitch / mesh.relative_curvature(point)) for point in (inner_pinion, inner_wheel))
        z_b, z_d = (np.maximum(factor, 1.0) for factor in pair)
    return z_b, np.where(mesh.wheel.side > 0, z_d, 1.0)


def contact_stress(mesh: Mesh, force: Batch, face_width: Batch, elasticity_factor: float) -> Batch:
    """sigma_H0 [Pa] at the pitch point: Z_H Z_E Z_eps sqrt(F_t / (d_1 b) (u + 1)/u).

    force: F_t at the reference circle [N]; face_width [m]. Multiply by Z_B or Z_D and sqrt(K) of
    ``LoadFactors.contact``.
    """
    diameter, u = 2 * mesh.pinion.reference_radius, mesh.ratio
    nominal = sqrt(force / (diameter * face_width) * (u + 1) / u)
    return zone_factor(mesh) * elasticity_factor * contact_ratio_factor(mesh) * nominal


def permissible_contact_stress(mesh: Mesh, material: GearMaterial, oil: Lubrication, velocity: Batch) -> Batch:
    """sigma_HG at the knee of the S-N line, safety 1 [Pa]: sigma_Hlim Z_L Z_V Z_R (Z_W = Z_X = 1).

    velocity: at the pitch line relative to the carrier [m/s]. Hard flanks, sigma_Hlim above 1200 MPa.
    """
    return material.contact_limit * lubricant_factor(oil) * velocity_factor(velocity) * roughness_factor(mesh, oil)


def lubricant_factor(oil: Lubrication) -> Batch:
    """Z_L = C + 4 (1 - C) / (1.2 + 134/nu_40)^2, C = 0.91; 1 for the reference oil of 100 mm^2/s at 50 degrees."""
    return 0.91 + 4 * 0.09 / (1.2 + 134e-6 / oil.viscosity_40) ** 2


def velocity_factor(velocity: Batch) -> Batch:
    """Z_V = C + 2 (1 - C) / sqrt(0.8 + 32/v), C = 0.93."""
    return 0.93 + 2 * 0.07 / sqrt(0.8 + 32 / np.maximum(np.abs(velocity), 1e-9))


def roughness_factor(mesh: Mesh, oil: Lubrication) -> Batch:
    """Z_R = (3 um / R_z10)^0.08, R_z10 = R_z (10 mm / rho_red)^(1/3)."""
    relative = mesh.relative_curvature(mesh.pinion.base_radius * np.tan(mesh.working_pressure_angle))
    comparable = oil.flank_roughness * np.cbrt(10 * MILLIMETRE / relative)
    return (3e-6 / comparable) ** 0.08


def hertz_stress(
    mesh: Mesh, normal_force: Batch, face_width: Batch, pinion_curvature: Batch, material: GearMaterial
) -> Batch:
    """Contact pressure of two cylinders [Pa] under a normal force [N].

    pinion_curvature: radius of curvature of the pinion flank there [m]

    sigma = Z_E sqrt(F / (b rho)). At the pitch point it is ``contact_stress`` with Z_eps = 1.
    """
    relative = mesh.relative_curvature(pinion_curvature)
    return material.elasticity_factor * sqrt(normal_force / (face_width * relative))


def pitch_velocity(mesh: Mesh, speed: Batch) -> Batch:
    """Peripheral speed of the pinion at its working pitch circle [m/s], speed relative to the carrier [rad/s]."""
    return np.abs(speed) * mesh.pinion.base_radius / cos(mesh.working_pressure_angle)
