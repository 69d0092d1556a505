"""What flux map, winding and losses read of a study, in SI."""

from __future__ import annotations

from math import sqrt

from electrical.braking_stage import CopperHeat
from electrical.winding_selection import WindingLimits, Wire
from electrical.winding_stage import WindingInputs
from losses.stage import LossInputs
from magnetostatics.flux_map_stage import ANGLES, CURRENTS, FluxMapGrid
from materials.conductor import Conductor
from study.magnet_choice import magnet_resistivity
from study.schema import Study


def flux_map_grid(study: Study) -> FluxMapGrid:
    """Angles and currents of the flux map; how far it reaches follows from the copper that the slot may hold."""
    return FluxMapGrid(
        largest_packing=winding_limits(study).largest_packing,
        overload_density=sqrt(2) * study.sweep.si.j_overload_rms,
        angles=study.flux_map.angles or ANGLES,
        currents=study.flux_map.currents or CURRENTS,
    )


def winding_inputs(study: Study) -> WindingInputs:
    """Wire, limits and length of the winding."""
    section = study.winding_selection.si
    return WindingInputs(
        wire=Wire(section.wire_diameter, winding_resistivity(study)),
        limits=winding_limits(study),
        nominal_density=study.sweep.si.j_nominal_rms,
        longest=study.match.si.length_max,
        damping_asked=study.match.enforce_damping,
    )


def loss_inputs(study: Study) -> LossInputs:
    """Whose loss data stand for the study's steel."""
    section = study.winding_selection.si
    return LossInputs(
        steel=study.materials.steel,
        loss_grade=study.materials.loss_grade,
        winding_temperature=section.winding_temperature,
        magnet_resistivity=magnet_resistivity(study),
    )


COLD, HOT = 20.0, 120.0  # degC; a winding of class B (130 degC, IEC 60085) less ten for its hottest place


def copper_heat(study: Study) -> CopperHeat:
    """How the resistance of the copper changes between a cold and a hot machine."""
    now, copper = winding_resistivity(study), winding_conductor(study)
    return CopperHeat(COLD, HOT, *(float(copper.resistivity(one)) / now for one in (COLD, HOT)))


def winding_limits(study: Study) -> WindingLimits:
    """What workshop, bus and power electronics allow."""
    section = study.winding_selection.si
    return WindingLimits(
        packing_limit=study.winding.packing_factor,
        packing_tolerance=section.packing_tolerance,
        overload_current_density=study.sweep.si.j_overload_rms,
        dc_voltage=section.dc_bus_voltage,
        maximum_speed=section.speed_max,
        phase_current_rms=section.phase_current_max_rms,
    )


def winding_resistivity(study: Study) -> float:
    """Resistivity of the copper at the temperature of the winding [ohm m]."""
    return float(winding_conductor(study).resistivity(study.winding_selection.si.winding_temperature))


def winding_conductor(study: Study) -> Conductor:
    """The law of the copper, as the study states it."""
    materials = study.materials.si
    return Conductor(
        reference_resistivity=materials.copper_resistivity,
        temperature_coefficient=materials.copper_temperature_coefficient,
        reference_temperature=materials.copper_reference_temperature,
    )
