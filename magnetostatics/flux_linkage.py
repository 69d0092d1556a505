"""Flux linkage of the phases."""

from __future__ import annotations

import numpy as np

from magnetostatics.model import FieldSolution


def phase_flux_linkage(solution: FieldSolution) -> np.ndarray:
    """Flux linkage of phases A, B, C (3,) [Wb/m per turn of each coil], summed over the series coils of the machine.

    psi = sum over coils of mean(A over the + side) - mean(A over the - side)
    """
    model = solution.model
    return model.section.sectors * model.phase_loads @ solution.a


def park(phases: np.ndarray, electrical_angle: float, phase_axis: float) -> np.ndarray:
    """(d, q) of three phase values, amplitude-invariant; the d axis lies on magnet 0.

    electrical_angle: p theta [rad]; phase_axis: electrical angle of the axis of phase A [rad]
    """
    angle = electrical_angle - phase_axis - 2 * np.pi / 3 * np.arange(3)
    return 2 / 3 * np.array([np.cos(angle) @ phases, -np.sin(angle) @ phases])
