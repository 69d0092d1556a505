"""Magnetic co-energy of a field solution, and operating points with currents of their own in every phase.

    W'(theta, i) = sum_phases i psi - integral w dS,
    w = integral of H dB in iron and air, nu/2 |B - B_rem|^2 in a magnet (its energy is least at B = B_rem)

The solver's field makes the sum stationary, so the derivatives of W' at fixed mesh are psi = dW'/di and T = dW'/dtheta,
permanent magnets included: they count as a fixed sheet of ampere-turns round a material of permeability mu_r.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from magnetostatics.elements import Elements
from magnetostatics.model import FieldModel, FieldSolution
from units import MU_0


@dataclass(frozen=True)
class PhaseCurrents:
    """An operating point with any three currents: ampere-turns of a coil of each phase [A], at a rotor angle [rad]."""

    angle: float
    ampere_turns: tuple[float, float, float]
    coil_side_area: float
    packing_factor: float = 1.0

    def phase_densities(self, pole_pairs, phase_axis):
        return np.array(self.ampere_turns) / self.coil_side_area


def phase_currents(model: FieldModel, angle: float, ampere_turns) -> PhaseCurrents:
    area = model.section.half_slot_area * model.section.half_slots_per_coil_side
    return PhaseCurrents(angle, tuple(ampere_turns), area)


def ampere_turns_of(model: FieldModel, point) -> np.ndarray:
    """Ampere-turns of one coil of phases A, B, C [A] of any operating point."""
    area = model.section.half_slot_area * model.section.half_slots_per_coil_side
    machine, axis = model.section.machine, model.section.layout.phase_axis
    return point.phase_densities(machine.pole_pairs, axis) * point.packing_factor * area


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
    for name, law in (("stator_iron", materials.stator_steel), ("rotor_iron", materials.rotor_steel)):
        elements = model.elements.take(model.section.mesh.subdomains[name])
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
    machine, magnet = model.section.machine, model.materials.magnet
    elements = model.elements.take(model.section.mesh.subdomains[f"magnet_{number}"])
    x, y = elements.points
    direction = machine.magnetisation.direction_angle(np.arctan2(y, x), number * machine.pole_pitch)
    remanence = (-1) ** number * magnet.remanence
    dx, dy = elements.gradient(solution.a)
    excess = dy - remanence * np.cos(direction), -dx - remanence * np.sin(direction)  # B = (dA/dy, -dA/dx)
    return _half_square(elements, *excess, nu=1 / (MU_0 * magnet.recoil_permeability))
