"""Torque per metre of the whole machine by two independent routes, and the magnetic pull on its rotor."""

from __future__ import annotations

import numpy as np

from magnetostatics.elements import Elements
from magnetostatics.model import FieldSolution
from units import MU_0


def arkkio_torque(solution: FieldSolution) -> float:
    """Ring average of the Maxwell stress over the stator half of the air gap [Nm/m], counter-clockwise on the rotor.

    T/l = 1/(mu_0 (r_o - r_i)) integral over the ring of r B_r B_phi dS
    The ring ends at the sliding circle: the rotor half of the gap is sheared when the rotor stands between two nodes,
    the stator half keeps its mesh at every angle, so the torque over the angle is free of mesh noise (to 0.03 %).
    Between a sliding circle and a bore that are not concentric it is the same average over the circles of ``GapHalf``.
    The torque counts about the axis of rotation.
    Source: Arkkio 1987; any ring gives the same when the field is exact, and is far less sensitive than one contour.
    """
    ring, density = gap_force_density(solution)
    x, y = ring.points
    return float(solution.model.section.sectors * ((x * density[1] - y * density[0]) * ring.weights).sum())


def magnetic_pull(solution: FieldSolution) -> np.ndarray:
    """Force of the stator on the rotor (2,) [N/m], x and y in the frame of the stator.

    F/l = integral over the stator half of the gap of sigma . grad h dS, the stress averaged over all circles between
    sliding circle and bore, as in ``arkkio_torque``. Zero in a machine of two or more sectors: they balance.
    """
    if solution.model.section.sectors > 1:
        return np.zeros(2)
    ring, density = gap_force_density(solution)
    return (density * ring.weights).sum(axis=(1, 2))


def gap_force_density(solution: FieldSolution) -> tuple[Elements, np.ndarray]:
    """Stator half of the gap, and at its quadrature points (2, Q, E) the share in the force on the rotor [N/m^3]:

    f = sigma . grad h,  sigma = (B B^T - |B|^2/2 I)/mu_0,  h from 0 on the sliding circle to 1 on the bore
    """
    model = solution.model
    gap = model.section.mesh.subdomains["gap"]
    ring = model.elements.take(gap[~model.section.rotor_elements[gap]])
    dx, dy = ring.gradient(solution.a)
    b = np.stack([dy, -dx])
    upwards = model.section.stator_gap.gradient(ring.points)
    return ring, (b * (b * upwards).sum(0) - (b * b).sum(0) / 2 * upwards) / MU_0


def maxwell_torque(solution: FieldSolution) -> float:
    """Maxwell stress on the mid-gap circle [Nm/m], positive counter-clockwise on the rotor.

    T/l = contour integral of r B_r H_phi ds = - sum_i f_i (dA/dphi)_i
    f_i = integral of -H_phi v_i ds are the consistent fluxes of the weak form on the rotor side of the sliding circle
    (the residual of the rotor's equations there), and dA/dphi = r B_r is the derivative of A along the circle. Sampling
    B_phi inside the elements instead is off by 1-3 % at this order; the consistent flux converges twice as fast.
    """
    model = solution.model
    slide, sign = model.unknowns.rotor_slide, model.unknowns.sector_sign
    band = model.band_elements(model.unknowns.turn(solution.point.angle).rest)
    flux = band.scatter(_local_products(band, solution.a) / MU_0, model.size)[slide]
    values = solution.a[slide]
    if model.section.sectors > 1:  # both ends of the sector are one place
        flux[0] += sign * flux[-1]
        flux, values = flux[:-1], values[:-1]
    steps = model.unknowns.steps_per_edge
    slopes = _angle_derivative(values, sign, model.unknowns.edge_angle / steps, steps)
    return -model.section.sectors * float(flux @ slopes)


def _local_products(elements: Elements, a: np.ndarray) -> np.ndarray:
    """integral grad A . grad v per element (6, E)."""
    return elements.forces(*elements.gradient(a))


def _angle_derivative(values: np.ndarray, sign: int, spacing: float, steps_per_edge: int) -> np.ndarray:
    """dA/dphi at equally spaced points of one sector: the mean of what the functions of both neighbouring edges give.

    values: A at the nodes, for quadratic functions also at the middles of the edges in between (the odd places)
    sign: of the neighbouring sector; spacing: between the points [rad]
    """
    around = np.concatenate([sign * values[-2:], values, sign * values[:2]])
    near = (around[3:-1] - around[1:-3]) / (2 * spacing)
    if steps_per_edge == 1:
        return near
    far = (around[4:] - around[:-4]) / (4 * spacing)
    slopes = near.copy()
    slopes[::2] = (2 * near - far)[::2]
    return slopes
