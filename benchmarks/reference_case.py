"""The machine, states and meshes on which codes are compared, in terms that each of them understands."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import cos, sin, sqrt

import numpy as np

from benchmarks.conforming_mesh import ConformingMesh, conforming_mesh, quadratic
from geometry.cross_section import CrossSection, mesh_cross_section
from geometry.half_cell import MeshDensity
from geometry.machine import Machine, hanselman_machine
from geometry.winding import star_of_slots
from magnetostatics.elements import LINEAR, QUADRATIC, TriangleOrder
from magnetostatics.model import MachineMaterials, OperatingPoint
from materials.library import load_steel
from materials.magnet import Magnet
from materials.reluctivity import Reluctivity
from units import AMPERE_PER_SQUARE_MILLIMETRE, DEGREE, MILLIMETRE

ORDERS = {"P1": LINEAR, "P2": QUADRATIC}
FINE_LAW = 1e-5  # relative error of the straight lines through the sampled reluctivity: 1250 points
SHORT_LAW = 1e-3  # the same, 123 points: peers search their tables point by point; torque moves by 2e-5
_HIGHEST_FLUX_DENSITY = 4.0  # T, end of the sampled law; iterations that overshoot it follow its last line
_SAMPLING_GRID = 400_001
_BESIDE = 1e-3  # rad
_PARALLEL = 1e-12  # rad, between two points of a magnet


@dataclass(frozen=True)
class State:
    """One operating point of the comparison, with a name."""

    name: str
    point: OperatingPoint


def reference_machine() -> Machine:
    """12 slots, 10 poles, R_so 42.5, R_ro 15.7, w_bi 3.3, l_m 2.5, g 0.5, w_s 2 mm (thesis chapter 3)."""
    return hanselman_machine(
        slots=12,
        pole_pairs=5,
        stator_outer_radius=42.5 * MILLIMETRE,
        rotor_outer_radius=15.7 * MILLIMETRE,
        back_iron_width=3.3 * MILLIMETRE,
        magnet_length=2.5 * MILLIMETRE,
        airgap=0.5 * MILLIMETRE,
        slot_opening=2.0 * MILLIMETRE,
        shoe_depth_fraction=0.52,
        shoe_aspect_ratio=1.0,
        shaft_radius=5.0 * MILLIMETRE,
    )


def reference_materials() -> MachineMaterials:
    """35PN270 in stator and rotor, magnets of 1.3 T with the permeability of air."""
    steel = load_steel("35PN270")
    return MachineMaterials(steel, steel, Magnet(remanence=1.3, recoil_permeability=1.0))


def reference_states() -> tuple[State, ...]:
    """Rated current on the q axis first; then off it, overload, and no current where the cogging torque is large.

    At all these rotor angles the nodes of the sliding circle meet for meshes with a multiple of 120 edges around it.
    """
    rated = 6.0 * sqrt(2) * AMPERE_PER_SQUARE_MILLIMETRE
    return (
        State("rated, q axis", OperatingPoint(-21.0 * DEGREE, rated)),
        State("rated, gamma 15", OperatingPoint(-24.0 * DEGREE, rated, 15.0 * DEGREE)),
        State("overload, q axis", OperatingPoint(-21.0 * DEGREE, rated * 20.0 / 6.0)),
        State("no current", OperatingPoint(-22.5 * DEGREE)),
    )


def reference_section(density: MeshDensity = MeshDensity(), whole: bool = False) -> CrossSection:
    """The meshed reference machine: its antiperiodic half, or the whole of it."""
    machine = reference_machine()
    return mesh_cross_section(machine, star_of_slots(machine.slots, machine.pole_pairs), density, whole)


@dataclass(frozen=True, eq=False)
class FieldCase:
    """One field problem: a meshed section with its materials at one state, to be solved with elements of one order.

    order_name: a key of ORDERS; law_tolerance: relative, of the table of nu that the peers read
    """

    section: CrossSection
    materials: MachineMaterials
    state: State
    order_name: str
    law_tolerance: float = FINE_LAW

    @property
    def order(self) -> TriangleOrder:
        """The elements of this project's solver."""
        return ORDERS[self.order_name]

    @property
    def label(self) -> str:
        """For tables: part of the machine, order, state."""
        return f"{self.extent}, {self.order_name}, {self.state.name}"

    @property
    def extent(self) -> str:
        """Part of the machine that is meshed."""
        return "whole" if self.section.sectors == 1 else "sector"

    @cached_property
    def mesh(self) -> ConformingMesh:
        """The mesh for other codes; with the middles of edges as nodes for quadratic elements."""
        mesh = conforming_mesh(self.section, self.state.point.angle)
        return quadratic(mesh) if self.order is QUADRATIC else mesh

    @property
    def current_densities(self) -> dict[str, float]:
        """Current density [A/m^2] over the area of every coil side, by region."""
        section, point = self.section, self.state.point
        phases = point.phase_densities(section.machine.pole_pairs, section.layout.phase_axis) * point.packing_factor
        return {name: float(sign * phases[phase]) for name, (phase, sign) in self.coil_sides.items()}

    @property
    def coil_sides(self) -> dict[str, tuple[int, int]]:
        """Phase and direction of the conductors in every coil side, by region."""
        layout, sides = self.section.layout, self.section.coil_sides
        return {f"slot_{slot}_{side}": layout.coil_side(slot, side) for slot, side in sides}

    @property
    def remanences(self) -> dict[str, tuple[float, float]]:
        """Remanence vector [T] of every magnet with the rotor turned, by region. Parallel magnetisation only."""
        return {f"magnet_{m}": self._remanence(m) for m in range(self.section.magnets)}

    @property
    def turning_remanences(self) -> dict[str, tuple[float, float, float, float]]:
        """Of every magnet with the rotor turned, by region, see ``turning_remanence``."""
        angle = self.state.point.angle
        numbers = range(self.section.magnets)
        return {f"magnet_{m}": turning_remanence(self.section, self.materials, m, angle) for m in numbers}

    def _remanence(self, number: int) -> tuple[float, float]:
        section, corners = self.section, self.section.mesh.t[:, self.section.mesh.subdomains[f"magnet_{number}"]]
        directions = section.magnetisation_angle(number, section.mesh.p[:, corners])
        if np.ptp(directions) > _PARALLEL:
            raise ValueError(f"the comparison holds for parallel magnets, found {section.machine.rotor}")
        strength = section.polarity(number) * self.materials.magnet.remanence
        turned = self.state.point.angle + float(directions.flat[0])
        return strength * cos(turned), strength * sin(turned)

    @property
    def law_table(self) -> tuple[np.ndarray, np.ndarray]:
        """(b2, nu): points of the steel's law for straight lines between them. One steel in stator and rotor only."""
        if self.materials.stator_steel is not self.materials.rotor_steel:
            raise ValueError("the comparison holds for one steel in stator and rotor")
        return sampled_law(self.materials.stator_steel, self.law_tolerance)

    @property
    def torque_ring(self) -> tuple[float, float]:
        """Of the sliding circle and of the stator's rim [m], between which lies the stator half of the air gap."""
        return self.section.machine.mid_gap_radius, self.section.machine.stator.rim_radius


def turning_remanence(
    section: CrossSection, materials: MachineMaterials, number: int, angle: float
) -> tuple[float, float, float, float]:
    """Strength [T] of a magnet of the whole machine, angle of the axis of its pole, direction there and what that turns
    by per angle from there [rad].

    angle: of the rotor [rad]
    """
    axis = number // section.machine.rotor.magnets_per_pitch * section.machine.rotor.pitch
    rays = axis + np.array([0.0, _BESIDE])
    here, beside = section.magnetisation_angle(number, np.stack([np.cos(rays), np.sin(rays)]))
    strength = section.polarity(number) * materials.magnet.remanence
    return strength, axis + angle, float(here) + angle, float(beside - here) / _BESIDE


@lru_cache
def sampled_law(law: Reluctivity, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (b2, nu) between which straight lines keep to a law within a relative tolerance of nu.

    b2: |B|^2 [T^2]; nu: [m/H]. Each line is the longest on a fine grid that holds.
    """
    b2 = np.linspace(0.0, _HIGHEST_FLUX_DENSITY**2, _SAMPLING_GRID)
    nu, chosen = law.nu(b2), [0]
    while chosen[-1] < len(b2) - 1:
        chosen.append(_longest_line(b2, nu, chosen[-1], tolerance))
    return b2[chosen], nu[chosen]


def _longest_line(b2: np.ndarray, nu: np.ndarray, start: int, tolerance: float) -> int:
    """Last index up to which a straight line from ``start`` stays within the tolerance: double, then halve."""
    length = 1
    while start + 2 * length < len(b2) and _line_holds(b2, nu, start, start + 2 * length, tolerance):
        length *= 2
    low, high = start + length, min(start + 2 * length, len(b2) - 1)
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if _line_holds(b2, nu, start, middle, tolerance) else (low, middle - 1)
    return low


def _line_holds(b2: np.ndarray, nu: np.ndarray, start: int, end: int, tolerance: float) -> bool:
    part = slice(start, end + 1)
    line = np.interp(b2[part], b2[[start, end]], nu[[start, end]])
    return bool(np.all(np.abs(line - nu[part]) <= tolerance * nu[part]))
