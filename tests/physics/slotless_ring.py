"""A slotless machine as a hand-made structured mesh, so that the field solver meets a problem with an exact solution.

30 "slots" without teeth: an annulus of copper cut into 60 half slots, between a smooth gap and a smooth stator yoke.
The real winding layout and the real ``FieldModel`` work on it. One pole pitch is meshed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil, pi

import numpy as np
from skfem import MeshTri

from geometry.cross_section import CrossSection
from geometry.machine import Machine
from geometry.magnetisation import ParallelMagnetisation
from geometry.winding import star_of_slots
from magnetostatics.elements import LINEAR, Elements
from magnetostatics.model import FieldModel, MachineMaterials
from magnetostatics.newton import NewtonSettings
from materials.magnet import Magnet
from materials.reluctivity import LinearReluctivity
from tests.physics.ring_series import Layer, magnet_harmonic, solve_layers
from units import MILLIMETRE

SLOTS, POLE_PAIRS = 30, 5
EXACT = NewtonSettings(tolerance=1e-9)

RING = Machine(
    slots=SLOTS,
    pole_pairs=POLE_PAIRS,
    stator_outer_radius=26 * MILLIMETRE,
    rotor_outer_radius=15.7 * MILLIMETRE,
    back_iron_width=6 * MILLIMETRE,
    tooth_width=1 * MILLIMETRE,  # of no meaning here, as slot opening and shoe
    magnet_length=2.5 * MILLIMETRE,
    airgap=0.5 * MILLIMETRE,
    slot_opening=1 * MILLIMETRE,
    shoe_d1=1 * MILLIMETRE,
    shoe_d2=1 * MILLIMETRE,
    shaft_radius=8 * MILLIMETRE,  # nothing inside conducts flux
)


@dataclass(frozen=True)
class Ring:
    """One slotless machine: magnetisation, recoil permeability and permeability of the iron."""

    machine: Machine = RING
    recoil_permeability: float = 1.0
    iron_permeability: float = 1e6
    remanence: float = 1.3

    @property
    def parallel(self) -> bool:
        return isinstance(self.machine.magnetisation, ParallelMagnetisation)

    @property
    def materials(self) -> MachineMaterials:
        iron = LinearReluctivity(self.iron_permeability)
        return MachineMaterials(iron, iron, Magnet(self.remanence, self.recoil_permeability))

    def layers(self, order, angle=0.0, magnets=1.0, current=0.0, sheet=0.0):
        """Layers of one order: magnets times their remanence, turned by angle [rad]; current density, current sheet."""
        m, iron, recoil = self.machine, self.iron_permeability, self.recoil_permeability
        radial, tangential = magnet_harmonic(order, m.pole_pairs, self.remanence, m.magnet_arc_fraction, self.parallel)
        turned = magnets * np.exp(-1j * order * angle)
        return (
            Layer(m.shaft_radius, m.rotor_core_radius, iron),
            Layer(m.rotor_core_radius, m.rotor_outer_radius, recoil, radial * turned, tangential * turned),
            Layer(m.rotor_outer_radius, m.stator_inner_radius),
            Layer(m.stator_inner_radius, m.slot_bottom_radius, current=current, sheet=sheet),
            Layer(m.slot_bottom_radius, m.stator_outer_radius, iron),
        )

    def field(self, order, **sources):
        return solve_layers(order, self.layers(order, **sources))


def with_machine(ring: Ring, **changes) -> Ring:
    return replace(ring, machine=replace(ring.machine, **changes))


def ring_section(machine: Machine, edges_per_half_slot: int, gap_layers: int = 1) -> CrossSection:
    """Structured mesh of one pole pitch; elements are about square on the sliding circle."""
    step = machine.slot_pitch / 2 / edges_per_half_slot
    edge = machine.mid_gap_radius * step
    gap = np.linspace(machine.mid_gap_radius, machine.stator_inner_radius, gap_layers + 1)
    copper = _radii(machine.stator_inner_radius, machine.slot_bottom_radius, edge)
    yoke = _radii(machine.slot_bottom_radius, machine.stator_outer_radius, 2 * edge)
    core = _radii(machine.shaft_radius, machine.rotor_core_radius, 2 * edge)
    magnet = _radii(machine.rotor_core_radius, machine.rotor_outer_radius, edge)
    below = np.linspace(machine.rotor_outer_radius, machine.mid_gap_radius, gap_layers + 1)
    angles = step * np.arange(6 * edges_per_half_slot + 1)  # a pole pitch is three slots
    stator = _annulus(np.concatenate([gap, copper[1:], yoke[1:]]), angles - machine.slot_pitch / 2)
    rotor = _annulus(np.concatenate([core, magnet[1:], below[1:]]), angles - machine.pole_pitch / 2)
    return _section(machine, stator, rotor)


def _radii(inner, outer, length):
    return np.linspace(inner, outer, max(1, ceil((outer - inner) / length - 1e-9)) + 1)


def _annulus(radii, angles):
    """Points (2, n) and triangles (3, m) of a grid, radius by radius, with alternating diagonals."""
    r, phi = np.meshgrid(radii, angles, indexing="ij")
    node = np.arange(r.size).reshape(r.shape)
    a, b, c, d = (x.ravel() for x in (node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]))
    even = np.add(*np.indices((len(radii) - 1, len(angles) - 1))).ravel() % 2 == 0
    first = np.where(even, [a, b, c], [a, b, d])
    second = np.where(even, [a, c, d], [b, c, d])
    return np.array([(r * np.cos(phi)).ravel(), (r * np.sin(phi)).ravel()]), np.hstack([first, second])


def _section(machine, stator, rotor) -> CrossSection:
    offset = stator[0].shape[1]
    points, triangles = np.hstack([stator[0], rotor[0]]), np.hstack([stator[1], rotor[1] + offset])
    mesh = MeshTri(points, triangles, sort_t=False, validate=False)
    mesh = mesh.with_subdomains(_regions(machine, mesh))
    mesh = mesh.with_boundaries(_boundaries(machine, mesh, offset))
    layout = star_of_slots(machine.slots, machine.pole_pairs)
    return CrossSection(machine, layout, mesh, machine.sectors, machine.is_antiperiodic, pieces=())


def _regions(m, mesh):
    x, y = mesh.p[:, mesh.t].mean(axis=1)
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    half, covered = m.slot_pitch / 2, m.magnet_arc_fraction * m.pole_pitch / 2
    is_magnet = (radius > m.rotor_core_radius) & (radius < m.rotor_outer_radius)
    number = np.floor(angle / half).astype(int)  # half slot counted from the axis of tooth 0
    is_copper = (radius > m.stator_inner_radius) & (radius < m.slot_bottom_radius)
    regions = {
        "stator_iron": radius > m.slot_bottom_radius,
        "gap": (radius > m.rotor_outer_radius) & (radius < m.stator_inner_radius),
        "magnet_0": is_magnet & (np.abs(angle) < covered),
        "between": is_magnet & (np.abs(angle) > covered),
        "rotor_iron": radius < m.rotor_core_radius,
    }
    for i in range(-1, 2 * m.slots // m.sectors - 1):
        regions[f"slot_{(i // 2) % m.slots}_{'RL'[i % 2]}"] = is_copper & (number == i)
    return {name: np.flatnonzero(inside) for name, inside in regions.items()}


def _boundaries(m, mesh, offset):
    radius, angle = np.hypot(*mesh.p), np.arctan2(mesh.p[1], mesh.p[0])
    is_stator = np.arange(mesh.p.shape[1]) < offset
    on_slide = np.abs(radius - m.mid_gap_radius) < 1e-9
    start, end = -m.slot_pitch / 2, m.pole_pitch - m.slot_pitch / 2
    nodes = {
        "outer": np.abs(radius - m.stator_outer_radius) < 1e-9,
        "stator_slide": on_slide & is_stator,
        "rotor_slide": on_slide & ~is_stator,
        "stator_start": is_stator & (np.abs(angle - start) < 1e-9),
        "stator_end": is_stator & (np.abs(angle - end) < 1e-9),
        "rotor_start": ~is_stator & (np.abs(angle + m.pole_pitch / 2) < 1e-9),
        "rotor_end": ~is_stator & (np.abs(angle - m.pole_pitch / 2) < 1e-9),
    }
    facets = mesh.boundary_facets()
    a, b = mesh.facets[:, facets]
    return {name: facets[inside[a] & inside[b]] for name, inside in nodes.items()}


class SheetModel(FieldModel):
    """The field model with a sinusoidal current sheet on the bore of the yoke instead of currents in the slots.

    sheet: complex amplitude K of Re K exp(j p phi) [A/m]; magnets: factor of their load
    """

    def __init__(self, *arguments, sheet: complex, magnets: float = 1.0, **options):
        super().__init__(*arguments, **options)
        self.sheet, self.magnets = sheet, magnets

    def load(self, point):
        return self.magnets * self.magnet_loads.sum(0) + sheet_load(self, self.sheet)


def sheet_load(model: FieldModel, sheet: complex) -> np.ndarray:
    """integral K v R dphi over the bore of the yoke (n,) [A]."""
    mesh, radius = model.section.mesh, model.section.machine.slot_bottom_radius
    edges = np.flatnonzero((np.abs(np.hypot(*mesh.p[:, mesh.facets]) - radius) < 1e-9).all(axis=0))
    first, last = np.arctan2(*mesh.p[::-1, mesh.facets[:, edges]])
    load = np.zeros(model.size)
    for t, weight in zip(*np.polynomial.legendre.leggauss(6)):
        phi = (first * (1 - t) + last * (1 + t)) / 2
        strength = (sheet * np.exp(1j * POLE_PAIRS * phi)).real * weight / 2 * radius * np.abs(last - first)
        for dofs, share in _edge_functions(model, edges, t):
            np.add.at(load, dofs, share * strength)
    return load


def _edge_functions(model, edges, t):
    """(degrees of freedom, value) of the functions on an edge at -1 <= t <= 1."""
    a, b = model.section.mesh.facets[:, edges]
    if model.order is LINEAR:
        return (a, (1 - t) / 2), (b, (1 + t) / 2)
    return (a, t * (t - 1) / 2), (b, t * (t + 1) / 2), (model.section.mesh.p.shape[1] + edges, 1 - t * t)


def winding_harmonic(layout, densities, order: int) -> complex:
    """J_k [A/m^2] of a current density that is constant in every half slot; densities of phases A, B, C [A/m^2]."""
    total, width = 0.0, pi / layout.slots
    for slot in range(layout.slots):
        for half, side in enumerate("RL"):
            phase, sign = layout.coil_side(slot, side)
            start = (2 * slot + half) * width
            turned = np.exp(-1j * order * start) - np.exp(-1j * order * (start + width))
            total += sign * densities[phase] * turned / (1j * order)
    return total / pi


def exact_flux_linkage(ring: Ring, layout, fields) -> np.ndarray:
    """Flux linkage of phases A, B, C [Wb/m per turn] from fields of several orders: sum over coil sides of +-mean A.

    A mean over the copper of A_k exp(j k phi) is the conjugate of the winding harmonic of a unit current, times area.
    """
    m = ring.machine
    side = pi / layout.slots  # angle of a half slot
    linkage = np.zeros(3)
    for field in fields:
        mean = field.ring_mean(field.potential, m.stator_inner_radius, m.slot_bottom_radius)
        for phase, unit in enumerate(np.eye(3)):
            linkage[phase] += (mean * np.conj(winding_harmonic(layout, unit, field.order))).real * pi / side
    return linkage


def stator_ring(model: FieldModel) -> Elements:
    """Elements of the stator half of the gap, which no turn of the rotor touches."""
    return model.elements.take(np.setdiff1d(model.section.mesh.subdomains["gap"], model.rotor_band))


def radial_harmonic(solution, order: int) -> complex:
    """B_r,k [T], mean over the area of the stator half of the gap: 2 integral B_r exp(-j k phi) dS / area."""
    ring = stator_ring(solution.model)
    dx, dy = ring.gradient(solution.a)
    x, y = ring.points
    radial = (x * dy - y * dx) / np.hypot(x, y)
    return 2 * (radial * np.exp(-1j * order * np.arctan2(y, x)) * ring.weights).sum() / ring.weights.sum()


def exact_radial_harmonic(ring: Ring, order: int, **sources) -> complex:
    """The same mean of the exact field."""
    field, m = ring.field(order, **sources), ring.machine
    return field.ring_mean(field.radial, m.mid_gap_radius, m.stator_inner_radius)
