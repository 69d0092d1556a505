"""What each tolerance of the drawing does to the wound machine, and what magnets that differ do to its cogging."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import hypot, nan, sqrt

import numpy as np

from drivetrain.outcome import OutcomeInputs
from electrical.magnets_stage import MagnetsOutcome, with_grade
from electrical.winding_selection import WEAKENING
from electrical.winding_stage import WindingInputs, WindingOutcome
from electrical.wound_machine import WoundMachine
from geometry.machine import Machine
from losses.stage import LossMap
from magnetostatics.case import FieldCase
from magnetostatics.flux_map_stage import FluxMap
from magnetostatics.gap_stress_stage import GapStress
from tasks import Workers
from uncertainty.deviations import Deviation, Tolerances
from uncertainty.field_slopes import (
    FLUX_D,
    FLUX_Q,
    IRON_LOSS,
    RIPPLE,
    AtTheKnee,
    Cogging,
    FieldState,
    LoadedInductances,
    LoadedIron,
    NoLoad,
    OpposingField,
    StateSlopes,
    StateTask,
    mesh_errors,
    solve_slopes,
)
from uncertainty.scatter import CoggingScatter, cogging_scatter
from uncertainty.wound_slopes import (
    COGGING,
    FULL,
    KNEE,
    NO_LOAD,
    NOMINAL,
    OPPOSED,
    PARTS,
    QUADRATURE,
    OperatedMachine,
    Quantities,
    operated_machine,
    relative_slopes,
    values_of,
)


@dataclass(frozen=True)
class Sensitivity:
    """What one deviation does; relative: derivative of each quantity over itself [1 per unit of the deviation]."""

    deviation: Deviation
    relative: Quantities

    def standard(self, quantity: str) -> float:
        """Its standard uncertainty in a quantity, relative, with the sign of the derivative."""
        return float(getattr(self.relative, quantity)) * self.deviation.standard_uncertainty

    def worst(self, quantity: str) -> float:
        """The most that it does to a quantity, relative, without sign."""
        return abs(float(getattr(self.relative, quantity))) * self.deviation.half_width


@dataclass(frozen=True, eq=False)
class ToleranceOutcome:
    """The machine and what its tolerances do.

    values: of the machine as drawn [SI]; sensitivities: one a deviation
    mesh: bounds of what the mesh may have put the quantities off by, relative; NaN where it was not looked at
    rated_speed: mechanical, of the iron loss [rad/s]; elasticity: d ln T / d ln I at the nominal current, dimensionless
    scatter: cogging of machines whose magnets differ and whose rotor stands off centre
    """

    tolerances: Tolerances
    values: Quantities
    sensitivities: tuple[Sensitivity, ...]
    mesh: Quantities
    rated_speed: float
    elasticity: float
    scatter: CoggingScatter

    def standard(self, quantity: str) -> float:
        """Standard uncertainty of a quantity by all deviations, which are independent; standard: relative."""
        return sqrt(sum(one.standard(quantity) ** 2 for one in self.sensitivities))

    def worst(self, quantity: str) -> float:
        """All deviations at their ends, each at the one that hurts, relative."""
        return sum(one.worst(quantity) for one in self.sensitivities)

    def variance_share(self, one: Sensitivity, quantity: str) -> float:
        """Share of one deviation in the variance of a quantity, dimensionless."""
        return (one.standard(quantity) / self.standard(quantity)) ** 2

    def worst_first(self, quantity: str) -> tuple[Sensitivity, ...]:
        """Those that do most to a quantity at their ends first."""
        return tuple(sorted(self.sensitivities, key=lambda one: -one.worst(quantity)))


def tolerances_stage(
    case: FieldCase,
    flux_map: FluxMap,
    winding: WindingOutcome,
    windings: WindingInputs,
    gap_stress: GapStress,
    losses: LossMap | None,
    magnets: MagnetsOutcome | None,
    parts: OutcomeInputs,
    tolerances: Tolerances,
    workers: Workers,
) -> ToleranceOutcome:
    """Differentiate the wound machine over every deviation, and draw machines whose magnets differ by lot.

    losses: whose sheet counts, None where the study has no loss data; magnets: None where it names no grade; parts:
    what they are made of
    Raises FieldSolutionError, and GeometryError for a tolerance that the machine cannot be built with.
    """
    operated, machine = operated_machine(flux_map, winding, windings), winding.wound.dimensions
    states = _drawn_states(case, machine, operated, losses) | _magnet_states(case, winding.wound, magnets)
    found = workers.map("tolerances", solve_slopes, _slope_tasks(machine, states, tolerances.deviations))
    looked_at = {name: states[name] for name in _MESHED if name in states}
    errors = workers.map("mesh of the tolerances", mesh_errors, looked_at)
    length, materials = winding.wound.active_length, parts.materials
    iron_loss, cogging = _iron_loss(found) * length, gap_stress.cogging * length
    slopes = [(one, _slopes_of(one, found, states, machine)) for one in tolerances.deviations]
    return ToleranceOutcome(
        tolerances=tolerances,
        values=values_of(operated, winding, iron_loss, cogging, magnets, materials),
        sensitivities=tuple(
            Sensitivity(one, relative_slopes(one, field, operated, materials)) for one, field in slopes
        ),
        mesh=_mesh(errors, operated, flux_map, gap_stress),
        rated_speed=operated.speed,
        elasticity=operated.elasticity,
        scatter=cogging_scatter(case, machine, tolerances.eccentricity * machine.airgap, workers),
    )


_MESHED = (NO_LOAD, FULL, QUADRATURE, OPPOSED, KNEE)  # states whose mesh is looked at


def _drawn_states(
    case: FieldCase, machine: Machine, operated: OperatedMachine, losses: LossMap | None
) -> dict[str, StateTask]:
    """What is solved of the field of the machine as drawn, by name."""
    return {name: StateTask(case, machine, state) for name, state in _states(operated, losses).items()}


def _states(operated: OperatedMachine, losses: LossMap | None) -> dict[str, FieldState]:
    nominal, full = (operated.ampere_turns(one) for one in (operated.nominal, operated.full))
    most = hypot(*full)
    loaded = FieldState(*nominal) if losses is None else LoadedIron(*nominal, losses.law, operated.frequency)
    return {
        NO_LOAD: NoLoad(),
        NOMINAL: loaded,
        FULL: FieldState(*full),
        QUADRATURE: LoadedInductances(-WEAKENING * most, most),
        COGGING: Cogging(),
    }


def _magnet_states(case: FieldCase, wound: WoundMachine, magnets: MagnetsOutcome | None) -> dict[str, StateTask]:
    """The magnets of their grade at their worst temperature, in their worst state and where they meet the knee, on the
    finer mesh, on which they are judged."""
    if magnets is None:
        return {}
    share, worst = magnets.inputs.lost_max, magnets.worst
    states: dict[str, FieldState] = {OPPOSED: OpposingField(*_turns_of(wound, worst.i_d, worst.i_q), share)}
    if magnets.at_knee is not None:
        states[KNEE] = AtTheKnee(*_turns_of(wound, -magnets.at_knee, 0.0), share, magnets.field_at_knee)
    warm = replace(with_grade(case, magnets.inputs.grade, magnets.temperature), density=case.detail)
    return {name: StateTask(warm, wound.dimensions, state) for name, state in states.items()}


def _turns_of(wound: WoundMachine, i_d: float, i_q: float) -> tuple[float, float]:
    """Ampere-turns of a coil of currents [A peak]."""
    d, q = wound.ampere_turns(i_d, i_q)
    return float(d), float(q)


def _slope_tasks(
    machine: Machine, states: Mapping[str, StateTask], deviations: tuple[Deviation, ...]
) -> dict[str, StateTask]:
    """One for each state and each machine in the middle of tolerances: mostly the drawn one."""
    middles = dict.fromkeys(one.centre(machine) for one in deviations)
    return {
        _task_name(name, machine, middle): replace(
            task, machine=middle, deviations=tuple(one for one in deviations if one.centre(machine) == middle)
        )
        for middle in middles
        for name, task in states.items()
    }


def _task_name(state: str, drawn: Machine, middle: Machine) -> str:
    return state if middle == drawn else f"{state}, magnets of arc {middle.magnet_arc_fraction:.4f}"


def _slopes_of(
    deviation: Deviation, found: Mapping[str, StateSlopes], states: Mapping[str, StateTask], machine: Machine
) -> dict[str, np.ndarray]:
    """Of one deviation in every state [1 per unit of the deviation]."""
    middle = deviation.centre(machine)
    return {name: found[_task_name(name, machine, middle)].of(deviation) for name in states}


def _iron_loss(found: Mapping[str, StateSlopes]) -> float:
    """[W/m], NaN where it was not read."""
    values = found[NOMINAL].values
    return float(values[IRON_LOSS]) if len(values) > IRON_LOSS else nan


def _mesh(
    errors: Mapping[str, np.ndarray], operated: OperatedMachine, flux_map: FluxMap, gap_stress: GapStress
) -> Quantities:
    """Bounds, relative; torque and cogging have theirs already, the base speed that of its flux linkages."""
    magnets, inductance_d, inductance_q = errors[NO_LOAD].tolist()
    flux_d, flux_q = errors[FULL][[FLUX_D, FLUX_Q]].tolist()
    loaded_flux, loaded_d, loaded_q = errors[QUADRATURE].tolist()
    torque = flux_map.torque_error
    (at_the_knee,), (opposing,) = (errors.get(name, (nan,)) for name in (KNEE, OPPOSED))
    return Quantities(
        peak_torque=torque,
        continuous_torque=torque,
        magnet_flux=magnets,
        inductance_d=inductance_d,
        inductance_q=inductance_q,
        resistance=0.0,
        base_speed=operated.base_speed_error(flux_d, flux_q),
        copper_loss=2 / operated.elasticity * torque,
        iron_loss=nan,
        ripple=float(errors[FULL][RIPPLE]),
        cogging=gap_stress.cogging_error / gap_stress.cogging,
        loaded_flux=loaded_flux,
        loaded_inductance_d=loaded_d,
        loaded_inductance_q=loaded_q,
        demagnetising_current=float(at_the_knee),
        opposing_field=float(opposing),
        **dict.fromkeys(PARTS, 0.0),
    )
