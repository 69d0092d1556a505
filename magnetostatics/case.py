"""What every field solution of one study shares: materials, winding, mesh and the two current densities.

A ``FieldCase`` is a plain value: a task carries it to its worker, and a field solution there depends on nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass

from geometry.cross_section import mesh_cross_section
from geometry.family import MachineFamily, StatedMachine
from geometry.half_cell import MeshDensity
from geometry.parts import DrawnMachine
from geometry.winding import WindingLayout, star_of_slots
from magnetostatics.model import FieldModel, MachineMaterials
from magnetostatics.newton import NewtonSettings


@dataclass(frozen=True)
class FieldCase:
    """See the module.

    layers, coil_pitch [slots, None: what the star of slots gives], packing: of the winding; copper over slot area
    density: mesh of sweep, optima and maps; detail: mesh for single states that are looked at
    nominal_density, overload_density: amplitudes of the current density in the copper [A/m^2]
    end_leakage: share of the magnets' flux that closes beyond the ends of the stack, where no plane field sees it, or
        that the winding lacks for another reason
    """

    materials: MachineMaterials
    layers: int
    coil_pitch: int | None
    packing: float
    density: MeshDensity
    detail: MeshDensity
    nominal_density: float
    overload_density: float
    end_leakage: float = 0.0

    @property
    def kept(self) -> float:
        """Share of the torque of magnets and currents that the ends leave."""
        return 1.0 - self.end_leakage

    def layout(self, machine: DrawnMachine) -> WindingLayout:
        """The winding of a machine of this study."""
        return star_of_slots(machine.slots, machine.pole_pairs, self.layers, self.coil_pitch)

    def model(self, machine: DrawnMachine, settings: NewtonSettings = NewtonSettings()) -> FieldModel:
        """Field model of a machine on the mesh of the sweep. Raises GeometryError when it cannot be built."""
        return FieldModel(mesh_cross_section(machine, self.layout(machine), self.density), self.materials, settings)

    def detailed_model(self, machine: DrawnMachine) -> FieldModel:
        """Field model of a machine on the finer mesh."""
        return FieldModel(mesh_cross_section(machine, self.layout(machine), self.detail), self.materials)


@dataclass(frozen=True, kw_only=True)
class FamilyCase(FieldCase):
    """The case of a study that varies its machine. family: the machines among which it looks for the best"""

    family: MachineFamily


def field_case(case: FamilyCase) -> FieldCase:
    """The case for those who have their machine."""
    return case


def stated_machine(case: FamilyCase) -> StatedMachine:
    """The machine that the family begins with."""
    return StatedMachine(case.family.reference)
