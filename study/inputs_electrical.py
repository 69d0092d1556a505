"""What flux map, winding and losses read of a study, in SI."""

from __future__ import annotations

from math import sqrt

from electrical.braking_stage import CopperHeat
from electrical.winding_connection import CLOSINGS, Delta, Star
from electrical.winding_selection import WindingLimits
from electrical.winding_stage import WindingInputs
from electrical.wire import Wire
from losses.stage import LossInputs
from magnetostatics.flux_map_stage import ANGLES, CURRENTS, FluxMapGrid
from materials.conductor import Conductor
from materials.enamelled_wire import gauge
from materials.insulation import InsulationClass, insulation_class
from study.magnet_choice import magnet_resistivity
from study.schema import Study, WindingChoiceSection

COLD = 20.0  # degC
CLASS = "F"  # of the insulation, where the study names none: usual for enamelled wire in small machines (estimate)
# Wires with enamel over the coil side: a space factor of 0.7 in squares d x d times pi/4, what winding by hand or
# needle reaches (estimate; the liner is not taken off the coil side, so that it is in this number too).
INSULATED_FILL = 0.55
CIRCULATING_SHARE = 0.05  # of the copper loss; half of it is what the continuous torque falls by (estimate)
PATHS, CONNECTIONS = (1,), ("star",)  # where the study allows no others: all coils of a phase in series, in star


def flux_map_grid(study: Study) -> FluxMapGrid:
    """Angles and currents of the flux map; how far it reaches follows from the copper that the slot may hold."""
    return FluxMapGrid(
        largest_packing=winding_limits(study).largest_packing,
        overload_density=sqrt(2) * study.sweep.si.j_overload_rms,
        angles=study.flux_map.angles or ANGLES,
        currents=study.flux_map.currents or CURRENTS,
    )


def winding_inputs(study: Study) -> WindingInputs:
    """Wires, connections, limits and length of the winding."""
    return WindingInputs(
        wires=wires(study),
        paths=allowed_paths(study.winding_selection),
        closings=allowed_closings(study.winding_selection),
        limits=winding_limits(study),
        insulation=winding_class(study),
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


def wires(study: Study) -> tuple[Wire, ...]:
    """The allowed gauges, thinnest first, with copper at the temperature of the winding.

    Raises MaterialError for a diameter that is not sold.
    """
    return allowed_wires(study.winding_selection, winding_resistivity(study))


def allowed_wires(choice: WindingChoiceSection, resistivity: float) -> tuple[Wire, ...]:
    """The gauges that a file allows, thinnest first; resistivity: of their copper [ohm m].

    Raises MaterialError for a diameter that is not sold.
    """
    section = choice.si
    sizes = [gauge(diameter, section.enamel_grade) for diameter in sorted(set(section.wire_diameters))]
    return tuple(Wire(one.copper_diameter, one.outer_diameter, resistivity) for one in sizes)


def winding_class(study: Study) -> InsulationClass:
    """The thermal class of the winding's insulation."""
    return insulation_class(study.winding_selection.insulation_class or CLASS)


def copper_heat(study: Study) -> CopperHeat:
    """How the resistance of the copper changes between a cold machine and one as warm as its insulation allows."""
    now, copper, hot = winding_resistivity(study), winding_conductor(study), winding_class(study).mean
    return CopperHeat(COLD, hot, *(float(copper.resistivity(one)) / now for one in (COLD, hot)))


def winding_limits(study: Study) -> WindingLimits:
    """What workshop, bus and power electronics allow."""
    section = study.winding_selection.si
    return WindingLimits(
        packing_limit=study.winding.packing_factor,
        packing_tolerance=section.packing_tolerance,
        overload_current_density=study.sweep.si.j_overload_rms,
        dc_voltage=section.dc_bus_voltage,
        maximum_speed=section.speed_max,
        insulated_fill=insulated_fill(study.winding_selection),
        circulating_share=circulating_share(study.winding_selection),
        phase_current_rms=section.phase_current_max_rms,
    )


def insulated_fill(choice: WindingChoiceSection) -> float:
    """Largest share of a coil side that the wires fill with their enamel, dimensionless."""
    return INSULATED_FILL if choice.insulated_fill_max is None else choice.insulated_fill_max


def circulating_share(choice: WindingChoiceSection) -> float:
    """Largest loss by the current round a delta over the copper loss, dimensionless."""
    stated = choice.delta_circulating_loss_max
    return CIRCULATING_SHARE if stated is None else stated


def allowed_paths(choice: WindingChoiceSection) -> tuple[int, ...]:
    """Numbers of parallel paths, dimensionless."""
    return choice.parallel_paths or PATHS


def allowed_closings(choice: WindingChoiceSection) -> tuple[Star | Delta, ...]:
    """Star, delta or both."""
    return tuple(CLOSINGS[name] for name in choice.connections or CONNECTIONS)


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
