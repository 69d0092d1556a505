"""Flux linkage of the phases."""

from __future__ import annotations

import numpy as np

from geometry.machine import GeometryError
from magnetostatics.model import FieldSolution


def phase_flux_linkage(solution: FieldSolution) -> np.ndarray:
    """Flux linkage of phases A, B, C (3,) [Wb/m per turn of each coil], summed over the series coils of the machine.

    psi = sum over coils of mean(A over the + side) - mean(A over the - side)
    """
    model = solution.model
    return model.section.sectors * model.phase_loads @ solution.a


def coil_flux_linkage(solution: FieldSolution) -> np.ndarray:
    """Flux linkage of every single coil of the whole machine (coils,) [Wb/m per turn], in the layout's order.

    Positive for flux that a current going in +z through the coil's first side makes: outwards through the tooth of a
    tooth coil. With the signs and turns of the coils, psi_phase = sum over its coils of sign * turns * psi_coil.
    Raises GeometryError when only a sector is solved.
    """
    section = solution.model.section
    if section.sectors > 1:
        raise GeometryError("single coils need the whole machine: mesh_cross_section(..., whole=True)")
    return solution.model.coil_loads @ solution.a


def park(phases: np.ndarray, electrical_angle: float, phase_axis: float) -> np.ndarray:
    """(d, q) of three phase values, amplitude-invariant; the d axis lies on magnet 0.

    electrical_angle: p theta [rad]; phase_axis: electrical angle of the axis of phase A [rad]
    """
    angle = electrical_angle - phase_axis - 2 * np.pi / 3 * np.arange(3)
    return 2 / 3 * np.array([np.cos(angle) @ phases, -np.sin(angle) @ phases])
