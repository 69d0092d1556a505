"""Magnetic co-energy of a field solution, and operating points with currents of their own in every phase.

    W'(theta, i) = sum_phases i psi - integral w dS,
    w = integral of H dB in iron and air, nu/2 |B - B_rem|^2 in a magnet (its energy is least at B = B_rem)

The solver's field makes the sum stationary, so the derivatives of W' at fixed mesh are psi = dW'/di and T = dW'/dtheta,
permanent magnets included: they count as a fixed sheet of ampere-turns round a material of permeability mu_r.
"""

from __future__ import annotations

import numpy as np

from magnetostatics.currents import PhaseCurrents
from magnetostatics.elements import Elements
from magnetostatics.local_steel import law_in
from magnetostatics.model import FieldModel, FieldSolution
from units import MU_0


def phase_currents(model: FieldModel, angle: float, ampere_turns) -> PhaseCurrents:
    return PhaseCurrents(angle, tuple(ampere_turns))


def ampere_turns_of(model: FieldModel, point) -> np.ndarray:
    """Ampere-turns of one coil of phases A, B, C [A] of any operating point."""
    return point.ampere_turns(model.section)


def coenergy(solution: FieldSolution) -> float:
    """W' per metre of the whole machine [J/m]."""
    model = solution.model
    currents = model.load(solution.point) - model.magnet_loads.sum(0)
    stored = _air(solution) + _iron(solution) + sum(_magnet(solution, m) for m in range(model.section.magnets))
    return float(model.section.sectors * (currents @ solution.a - stored))


def _half_square(elements: Elements, x, y, nu=1 / MU_0) -> float:
    return nu / 2 * ((x * x + y * y) * elements.weights).sum()


def _iron(solution) -> float:
    model, materials = solution.model, solution.model.materials
    total = 0.0
    for name, steel in (("stator_iron", materials.stator_steel), ("rotor_iron", materials.rotor_steel)):
        elements = model.elements.take(model.section.mesh.subdomains[name])
        law = law_in(steel, model.section, name)
        total += (law.energy_density(np.hypot(*elements.gradient(solution.a))) * elements.weights).sum()
    return total


def _air(solution) -> float:
    """Air and copper; the rotor side of the gap as it is sheared at this angle."""
    model = solution.model
    subdomains = model.section.mesh.subdomains
    others = [where for name, where in subdomains.items() if "iron" in name or "magnet" in name]
    plain = np.setdiff1d(np.arange(model.section.mesh.nelements), np.concatenate([*others, model.rotor_band]))
    band = model.band_elements(model.unknowns.turn(solution.point.angle).rest)
    return sum(_half_square(part, *part.gradient(solution.a)) for part in (model.elements.take(plain), band))


def _magnet(solution, number: int) -> float:
    model = solution.model
    magnet = model.materials.magnet_at(number)
    elements = model.elements.take(model.section.mesh.subdomains[f"magnet_{number}"])
    direction = model.section.magnetisation_angle(number, elements.points) + magnet.axis_error
    remanence = (-1) ** number * magnet.remanence
    dx, dy = elements.gradient(solution.a)
    excess = dy - remanence * np.cos(direction), -dx - remanence * np.sin(direction)  # B = (dA/dy, -dA/dx)
    return _half_square(elements, *excess, nu=1 / (MU_0 * magnet.recoil_permeability))
