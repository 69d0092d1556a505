"""Torque per metre of the whole machine by two independent routes."""

from __future__ import annotations

import numpy as np

from geometry.cross_section import CrossSection
from magnetostatics.elements import Elements
from magnetostatics.model import FieldSolution
from units import MU_0


def arkkio_torque(solution: FieldSolution) -> float:
    """Ring average of the Maxwell stress over the stator half of the air gap [Nm/m], counter-clockwise on the rotor.

    T/l = 1/(mu_0 (r_o - r_i)) integral over the ring of r B_r B_phi dS
    The ring ends at the sliding circle: the rotor half of the gap is sheared when the rotor stands between two nodes,
    the stator half keeps its mesh at every angle, so the torque over the angle is free of mesh noise (to 0.03 %).
    Source: Arkkio 1987; any ring gives the same when the field is exact, and is far less sensitive than one contour.
    """
    model = solution.model
    section = model.section
    gap = section.mesh.subdomains["gap"]
    ring = model.elements.take(np.setdiff1d(gap, model.rotor_band, assume_unique=True))
    depth = section.machine.stator_inner_radius - section.machine.mid_gap_radius
    return float(section.sectors * _stress_moment(ring, solution.a) / (MU_0 * depth))


def _stress_moment(elements: Elements, a: np.ndarray) -> float:
    """integral r B_r B_phi dS, with B = (dA/dy, -dA/dx)."""
    dx, dy = elements.gradient(a)
    x, y = elements.points
    times_radial, times_tangential = x * dy - y * dx, -(x * dx + y * dy)  # r B_r, r B_phi
    return (times_radial * times_tangential / np.hypot(x, y) * elements.weights).sum()


def maxwell_torque(solution: FieldSolution) -> float:
    """Maxwell stress on the mid-gap circle [Nm/m], positive counter-clockwise on the rotor.

    T/l = contour integral of r B_r H_phi ds = - sum_i f_i (dA/dphi)_i
    f_i = integral of -H_phi v_i ds are the consistent fluxes of the weak form on the rotor side of the sliding circle
    (the residual of the rotor's equations there), and dA/dphi = r B_r is the derivative of the trigonometric
    interpolant of A along the circle. Sampling B_phi inside the elements instead is off by 1-3 % at this order; the
    consistent flux converges twice as fast as the field.
    """
    model = solution.model
    slide = model.unknowns.rotor_slide
    band = model.band_elements(model.unknowns.turn(solution.point.angle).rest)
    flux = band.scatter(_local_products(band, solution.a) / MU_0, model.size)[slide]
    values = solution.a[slide]
    if model.section.sectors > 1:  # both ends of the sector are one place
        flux[0] += model.section.sign * flux[-1]
        flux, values = flux[:-1], values[:-1]
    return -model.section.sectors * float(flux @ _angle_derivative(values, model.section))


def _local_products(elements: Elements, a: np.ndarray) -> np.ndarray:
    """integral grad A . grad v per element (6, E)."""
    return elements.forces(*elements.gradient(a))


def _angle_derivative(values: np.ndarray, section: CrossSection) -> np.ndarray:
    """d/dphi of equally spaced values over one sector, by the Fourier series of the whole period."""
    period = np.concatenate([values, -values]) if section.antiperiodic else values
    periods_around = section.sectors / (2 if section.antiperiodic else 1)
    orders = np.fft.fftfreq(len(period), 1 / len(period)) * periods_around
    return np.fft.ifft(1j * orders * np.fft.fft(period)).real[: len(values)]
