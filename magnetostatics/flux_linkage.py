"""Flux linkage of the phases."""

from __future__ import annotations

import numpy as np

from geometry.errors import GeometryError
from magnetostatics.currents import PhaseCurrents
from magnetostatics.model import FieldSolution, OperatingPoint


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


def flux_linkage_torque(solution: FieldSolution) -> float:
    """Mean torque that the flux linkages of one rotor position stand for [Nm/m], whole machine, on the rotor.

    T/l = 1.5 p (psi_d i_q - psi_q i_d),  i the ampere-turns of a coil, psi per turn and metre
    The energy of the field is the same after one electrical period, so the mean of this over a period is that of the
    torque (to 0.1 % at 9 and 12 slots); cogging is not in it.
    Raises TypeError for a state without phase currents.
    """
    section, point = solution.model.section, solution.point
    if not isinstance(point, OperatingPoint | PhaseCurrents):
        raise TypeError(f"torque from flux linkages needs the currents of phases, found {type(point).__name__}")
    electrical = section.machine.pole_pairs * point.angle
    psi_d, psi_q = park(phase_flux_linkage(solution), electrical, section.layout.phase_axis)
    i_d, i_q = park(point.ampere_turns(section), electrical, section.layout.phase_axis)
    return float(1.5 * section.machine.pole_pairs * (psi_d * i_q - psi_q * i_d))


def park(phases: np.ndarray, electrical_angle: float, phase_axis: float) -> np.ndarray:
    """(d, q), (2,), of three phase values, (3,), amplitude-invariant; the d axis lies on magnet 0.

    phases: [any unit], (3,), that of the result; park: [the same], (2,)
    electrical_angle: p theta [rad]; phase_axis: electrical angle of the axis of phase A [rad]
    """
    angle = electrical_angle - phase_axis - 2 * np.pi / 3 * np.arange(3)
    return 2 / 3 * np.array([np.cos(angle) @ phases, -np.sin(angle) @ phases])
