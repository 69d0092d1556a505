"""Load factors of ISO 6336-1: what tooth errors, speed and deflection add to the nominal tooth force.

Simplified against the standard's method B: tooth deviations are those of the accuracy grade (ISO 1328-1:1995 formulas),
not measured ones; the sun of equally spaced planets does not bend, so the lines of contact are misaligned by
manufacture alone, and the twist of the sun is left out; teeth are not modified (no tip relief, no crowning).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearbox.batch import Batch
from gearbox.involute import Gear, Mesh
from units import MILLIMETRE

MICROMETRE = 1e-6  # m
STIFFNESS = 1e9  # Pa, N/(mm um)
LINE_LOAD = 1e3  # N/m, N/mm
_FULL_LINE_LOAD = 100 * LINE_LOAD  # ISO 6336-1: stiffness and relative errors are constant above it


@dataclass(frozen=True)
class Quality:
    """Manufacture: accuracy grade of ISO 1328-1, application factor K_A, mesh load factor K_gamma.

    application: K_A, dimensionless; load_sharing: K_gamma, share of the most loaded planet over the mean
    """

    grade: int = 6
    application: float = 1.0
    load_sharing: float = 1.0


@dataclass(frozen=True)
class LoadFactors:
    """K_V, K_Hbeta, K_Fbeta, K_Halpha, K_Falpha and the product K_A K_gamma.

    external: K_A K_gamma, dimensionless; dynamic, face_contact, face_root, transverse_contact, transverse_root:
        dimensionless, arrays like the load
    """

    external: float
    dynamic: Batch
    face_contact: Batch
    face_root: Batch
    transverse_contact: Batch
    transverse_root: Batch

    @property
    def contact(self) -> Batch:
        """Factor on the tooth force for the flank, dimensionless."""
        return self.external * self.dynamic * self.face_contact * self.transverse_contact

    @property
    def root(self) -> Batch:
        """Factor on the tooth force for the root, dimensionless."""
        return self.external * self.dynamic * self.face_root * self.transverse_root


def load_factors(
    mesh: Mesh, face_width: Batch, force: Batch, speed: Batch, density: float, quality: Quality
) -> LoadFactors:
    """Load factors of a mesh.

    face_width [m]; force: nominal tangential force at the reference circle [N]; speed: of the pinion relative to the
    carrier [rad/s]. All broadcast with the mesh. density [kg/m^3]
    """
    external = quality.application * quality.load_sharing
    line_load = external * force / face_width
    single, mean = tooth_stiffness(mesh, line_load)
    pitch_error, form_error = _effective_errors(mesh, quality.grade)
    dynamic = _dynamic(mesh, line_load, single, mean, pitch_error, form_error, speed, density)
    face = _face(mesh, face_width, line_load * dynamic, mean, quality.grade)
    height = np.minimum(mesh.pinion.tooth_height, mesh.wheel.tooth_height)
    slim = np.maximum(face_width / height, 3.0)
    face_root = face ** (slim**2 / (1 + slim + slim**2))
    transverse = _transverse(mesh, line_load * dynamic * face, mean, pitch_error)
    return LoadFactors(external, dynamic, face, face_root, *transverse)


def tooth_stiffness(mesh: Mesh, line_load: Batch) -> tuple[Batch, Batch]:
    """(c', c_gamma): stiffness of a pair and mean stiffness of the mesh per width [Pa] (ISO 6336-1, method B).

    c' = 0.8 c'_th C_B with 1/c'_th = q' from the tooth numbers and shifts; the teeth of a ring count as infinitely
    many.
    line_load: K_A F_t / b [N/m]; below 100 N/mm the stiffness falls in proportion.
    """
    z_1, x_1, x_2 = mesh.pinion.teeth, mesh.pinion.shift, mesh.wheel.shift
    inverse_2 = np.where(np.asarray(mesh.wheel.teeth) > 0, 1 / np.abs(mesh.wheel.teeth), 0.0)
    flexibility = (
        0.04723 + 0.15551 / z_1 + 0.25791 * inverse_2 - 0.00635 * x_1 - 0.11654 * x_1 / z_1
        - 0.00193 * x_2 - 0.24188 * x_2 * inverse_2 + 0.00529 * x_1**2 + 0.00182 * x_2**2
    )  # fmt: skip
    rack = mesh.pinion.rack
    basic_rack = (1 + 0.5 * (1.2 - rack.dedendum)) * (1 - 0.02 * (20 - np.degrees(rack.pressure_angle)))
    light = np.minimum(1.0, line_load / _FULL_LINE_LOAD)
    single = 0.8 / flexibility * basic_rack * STIFFNESS * light
    return single, single * (0.75 * mesh.contact_ratio + 0.25)


def pitch_deviation(module: Batch, diameter: Batch, grade: int) -> Batch:
    """f_pt [m] of ISO 1328-1:1995: (0.3 (m + 0.4 sqrt d) + 4) 2^((Q - 5)/2) um, module and diameter [m]."""
    m, d = module / MILLIMETRE, diameter / MILLIMETRE
    return (0.3 * (m + 0.4 * np.sqrt(d)) + 4) * 2 ** ((grade - 5) / 2) * MICROMETRE


def profile_deviation(module: Batch, diameter: Batch, grade: int) -> Batch:
    """f_falpha [m] of ISO 1328-1:1995: (2.5 sqrt m + 0.17 sqrt d + 0.5) 2^((Q - 5)/2) um; module, diameter: [m]."""
    m, d = module / MILLIMETRE, diameter / MILLIMETRE
    return (2.5 * np.sqrt(m) + 0.17 * np.sqrt(d) + 0.5) * 2 ** ((grade - 5) / 2) * MICROMETRE


def helix_deviation(diameter: Batch, face_width: Batch, grade: int) -> Batch:
    """F_beta [m] of ISO 1328-1:1995: (0.1 sqrt d + 0.63 sqrt b + 4.2) 2^((Q - 5)/2) um."""
    d, b = diameter / MILLIMETRE, face_width / MILLIMETRE
    return (0.1 * np.sqrt(d) + 0.63 * np.sqrt(b) + 4.2) * 2 ** ((grade - 5) / 2) * MICROMETRE


def _effective_errors(mesh: Mesh, grade: int) -> tuple[Batch, Batch]:
    """Base pitch and profile errors of the larger gear after running-in of case-hardened teeth, 0.075 f up to 3 um."""
    diameter = 2 * np.maximum(mesh.pinion.reference_radius, mesh.wheel.reference_radius)
    base_pitch = pitch_deviation(mesh.pinion.module, diameter, grade) * np.cos(mesh.pinion.rack.pressure_angle)
    form = profile_deviation(mesh.pinion.module, diameter, grade)
    return tuple(error - np.minimum(0.075 * error, 3 * MICROMETRE) for error in (base_pitch, form))


def _dynamic(
    mesh: Mesh,
    line_load: Batch,
    single: Batch,
    mean: Batch,
    pitch_error: Batch,
    form_error: Batch,
    speed: Batch,
    density: Batch,
) -> Batch:
    """K_V by the relative speed N = speed z_1 / sqrt(c_gamma / m_red) (ISO 6336-1, 6.5, method B, eps_gamma <= 2).

    below resonance  N <= 0.85          1 + N (0.32 B_p + 0.34 B_f + 0.23 B_k)
    main resonance   0.85 < N <= 1.15   1 + 0.32 B_p + 0.34 B_f + 0.90 B_k
    above            N >= 1.5           0.47 B_p + 0.47 B_f + C_v7, linear from N = 1.15
    B_p, B_f: base pitch and profile error times c' over the line load; B_k = 1 without tip relief.
    """
    full = np.maximum(line_load, _FULL_LINE_LOAD)
    b_p, b_f = single * pitch_error / full, single * form_error / full
    relative = np.abs(speed) * mesh.pinion.teeth * np.sqrt(_reduced_mass(mesh, density) / mean)
    below = 1 + relative * (0.32 * b_p + 0.34 * b_f + 0.23)
    resonant = 1 + 0.32 * b_p + 0.34 * b_f + 0.90
    eps = mesh.contact_ratio
    above = 0.47 * b_p + 0.47 * b_f + np.where(eps <= 1.5, 0.75, 0.125 * np.sin(np.pi * (eps - 2)) + 0.875)
    beyond = resonant + (above - resonant) * np.clip((relative - 1.15) / 0.35, 0, 1)
    return np.where(relative <= 0.85, below, beyond)


def _reduced_mass(mesh: Mesh, density: Batch) -> Batch:
    """Mass per width of the two gears reduced to the line of action [kg/m]; a ring counts as fixed.

    Solid external wheels of diameter d_m = (d_a + d_f)/2: m = J / (b r_b^2), J/b = pi/2 rho r_m^4. Planetary stages
    load a sun at three meshes at once, which lowers its share; left out, on the safe side for N.
    """

    def own(gear: Gear) -> Batch:
        middle = (gear.tip_radius + gear.root_radius) / 2
        return np.where(gear.side > 0, np.pi / 2 * density * middle**4 / gear.base_radius**2, np.inf)

    return 1 / (1 / own(mesh.pinion) + 1 / own(mesh.wheel))


def _face(mesh: Mesh, face_width: Batch, line_load: Batch, mean: Batch, grade: int) -> Batch:
    """K_Hbeta = 1 + F_by c_gb / (2 F_m/b), sqrt(2 F_by c_gb / (F_m/b)) above 2 (ISO 6336-1, 7, method C).

    F_bx = f_ma = F_beta of the wheel's grade; running-in y_b = 0.15 F_bx up to 6 um; c_gb = 0.85 c_ga.
    """
    diameter = 2 * np.maximum(mesh.pinion.reference_radius, mesh.wheel.reference_radius)
    error = helix_deviation(diameter, face_width, grade)
    error = error - np.minimum(0.15 * error, 6 * MICROMETRE)
    load = error * 0.85 * mean / line_load
    return np.where(load <= 2, 1 + load / 2, np.sqrt(2 * load))


def _transverse(mesh: Mesh, line_load: Batch, mean: Batch, pitch_error: Batch) -> tuple[Batch, Batch]:
    """(K_Halpha, K_Falpha) = eps/2 (0.9 + 0.4 c_ga f_pb / (F_tH/b)), held in 1 ... eps/(eps Z_eps^2), 1 ... 1/Y_eps.

    ISO 6336-1, 8, method B, eps_gamma <= 2.
    """
    eps = mesh.contact_ratio
    factor = eps / 2 * (0.9 + 0.4 * mean * pitch_error / line_load)
    contact_limit, root_limit = 3 / (4 - eps), eps / (0.25 * eps + 0.75)
    return np.clip(factor, 1.0, np.maximum(contact_limit, 1)), np.clip(factor, 1.0, np.maximum(root_limit, 1))
