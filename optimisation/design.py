"""One design of the cross-section, judged: torque per metre and flux densities in the states of a reading."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan
from statistics import fmean
from typing import Protocol

from geometry.cross_section import mesh_cross_section
from geometry.half_cell import MeshDensity
from geometry.machine import Machine
from geometry.winding import WindingLayout, star_of_slots
from magnetostatics.model import FieldModel, FieldSolution, MachineMaterials
from magnetostatics.probes import probe_reader
from magnetostatics.torque import arkkio_torque, maxwell_torque
from optimisation.states import SaturationReading, aligned_teeth


class MachineFamily(Protocol):
    """Machines that differ in the four numbers of the cross-section optimisation, all lengths in m."""

    def machine(self, slots: int, stator_outer_radius: float, back_iron_width: float, rotor_outer_radius: float) -> Machine:
        ...


@dataclass(frozen=True)
class Judge:
    """Solves a machine and reads what the optimisation needs.

    amplitude: current density amplitude in the copper [A/m^2]; packing: copper share of the slot
    """

    materials: MachineMaterials
    reading: SaturationReading
    amplitude: float
    packing: float
    layers: int = 2
    coil_pitch: int | None = None
    density: MeshDensity = MeshDensity()

    def layout(self, machine: Machine) -> WindingLayout:
        """The winding of a machine of this study."""
        return star_of_slots(machine.slots, machine.pole_pairs, self.layers, self.coil_pitch)

    def at_amplitude(self, amplitude: float) -> Judge:
        """The same judge with another current density amplitude [A/m^2]."""
        return replace(self, amplitude=amplitude)

    def judge(self, machine: Machine) -> Design:
        """Mesh and solve a machine in every state of the reading.

        Raises GeometryError when it cannot be built, FieldSolutionError when the field does not converge.
        """
        layout = self.layout(machine)
        section = mesh_cross_section(machine, layout, self.density)
        model = FieldModel(section, self.materials)
        states = self.reading.states(machine, layout, self.amplitude, self.packing)
        probes = probe_reader(model)
        solution, seen = None, []
        for state in states:
            solution = model.solve(state, start=solution)
            seen.append(_look(solution, probes.read(solution)))
        return _summary(machine, section.half_slot_area * section.half_slots_per_coil_side, self.reading, seen)


@dataclass(frozen=True)
class Design:
    """What the optimisation knows of one design; torque in Nm/m (mean over the states), flux densities in T (worst)."""

    machine: Machine
    torque: float
    torque_maxwell: float
    tooth_aligned: float
    tooth_worst: float
    back_iron_worst: float
    limited: float
    coil_side_area: float  # m^2
    newton_iterations: int


def _look(solution: FieldSolution, flux: dict[str, float]) -> dict[str, float]:
    """Torques and worst flux densities of one solved state."""
    section = solution.model.section
    teeth = {k % section.teeth for k in aligned_teeth(section.machine, solution.point.angle)}
    return {
        "torque": arkkio_torque(solution),
        "torque_maxwell": maxwell_torque(solution),
        "aligned": max((flux[f"tooth_{k}"] for k in teeth), default=nan),
        "tooth": max(value for name, value in flux.items() if name.startswith("tooth")),
        "back_iron": max(value for name, value in flux.items() if name.startswith("back_iron")),
        "iterations": solution.newton.iterations,
    }


def _summary(machine: Machine, area: float, reading: SaturationReading, seen: list[dict[str, float]]) -> Design:
    def worst(key):
        return max((state[key] for state in seen if state[key] == state[key]), default=nan)

    aligned, tooth, back_iron = worst("aligned"), worst("tooth"), worst("back_iron")
    return Design(
        machine=machine,
        torque=fmean(state["torque"] for state in seen),
        torque_maxwell=fmean(state["torque_maxwell"] for state in seen),
        tooth_aligned=aligned,
        tooth_worst=tooth,
        back_iron_worst=back_iron,
        limited=reading.limited(aligned, tooth, back_iron),
        coil_side_area=area,
        newton_iterations=sum(state["iterations"] for state in seen),
    )
