"""From a study to the objects that the library functions take. Every stage builds its models here, in the same way."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

from geometry.cross_section import mesh_cross_section
from geometry.half_cell import MeshDensity
from geometry.machine import Machine
from geometry.winding import WindingLayout, star_of_slots
from magnetostatics.model import FieldModel, MachineMaterials
from magnetostatics.newton import NewtonSettings
from materials.library import load_steel
from optimisation.design import Judge
from optimisation.states import READINGS, SaturationReading
from study.convert import to_machine, to_magnet, to_mesh_density
from study.schema import MachineSection, Study
from units import AMPERE_PER_SQUARE_MILLIMETRE

# Packages whose code decides about every field solution; stages that solve list them as inputs.
FIELD_CODE = ("units", "materials", "geometry", "magnetostatics", "optimisation", "study.convert", "pipeline.models")
FIELD_SECTIONS = ("machine", "materials", "winding", "mesh", "sweep", "saturation")
# Twice the resolution of the sweep, for single states that are looked at.
DETAIL = MeshDensity(gap_edges=360, longest_gap_edge=0.75, gap_layers=2, across_iron=3.0)


@dataclass(frozen=True)
class StudyFamily:
    """The machines of a study's sweep."""

    section: MachineSection

    def machine(
        self, slots: int, stator_outer_radius: float, back_iron_width: float, rotor_outer_radius: float
    ) -> Machine:
        """The study's machine with four numbers changed, lengths in m."""
        return to_machine(
            self.section,
            slots=slots,
            stator_outer_radius=stator_outer_radius,
            back_iron_width=back_iron_width,
            rotor_outer_radius=rotor_outer_radius,
        )


def materials_of(study: Study) -> MachineMaterials:
    """The materials of a study; the steel's path counts from the study file."""
    steel = load_steel(study.materials.steel, study.path.parent)
    return MachineMaterials(steel, steel, to_magnet(study.materials))


def layout_of(study: Study, slots: int | None = None) -> WindingLayout:
    """The winding of a study, or of the same study with another slot count."""
    count = slots or study.machine.slots
    return star_of_slots(count, study.machine.poles // 2, study.winding.layers, study.winding.coil_pitch)


def detail_density(study: Study) -> MeshDensity:
    """Mesh for single states: what the study asks for, or twice the resolution of the sweep."""
    return to_mesh_density(study.mesh) if study.mesh.model_fields_set else DETAIL


def field_model(study: Study, machine: Machine, density: MeshDensity) -> FieldModel:
    """Field model of a machine with the materials and the winding of a study."""
    return FieldModel(mesh_cross_section(machine, layout_of(study, machine.slots), density), materials_of(study))


def nominal_amplitude(study: Study) -> float:
    """Amplitude of the nominal current density [A/m^2]; the study states RMS."""
    return sqrt(2) * study.sweep.j_nominal_rms_A_per_mm2 * AMPERE_PER_SQUARE_MILLIMETRE


def overload_amplitude(study: Study) -> float:
    """Amplitude of the overload current density [A/m^2]; the study states RMS."""
    return sqrt(2) * study.sweep.j_overload_rms_A_per_mm2 * AMPERE_PER_SQUARE_MILLIMETRE


def judge_of(
    study: Study, reading: SaturationReading | None = None, settings: NewtonSettings = NewtonSettings()
) -> Judge:
    """Judge of designs at the study's nominal current density, with its reading of the saturation limit or another."""
    return Judge(
        materials=materials_of(study),
        reading=reading or READINGS[study.saturation.reading],
        amplitude=nominal_amplitude(study),
        packing=study.winding.packing_factor,
        layers=study.winding.layers,
        coil_pitch=study.winding.coil_pitch,
        density=to_mesh_density(study.mesh),
        settings=settings,
    )
