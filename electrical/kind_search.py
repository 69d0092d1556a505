"""The best dimensions of a machine of any kind: most torque for its copper loss within a limit of saturation.

    K_m = T / sqrt(P_cu),    P_cu = 3 N_c rho (l + l_et) (N I)^2 / (k_cp A_s)

the motor constant at full ampere-turns N I, copper of the stated share k_cp in whatever slot there is: it does not ask
how many turns are wound. Torque is the mean over some rotor angles, the current angle is searched with the dimensions.
Sampled over the bounds (Sobol's sequence), then bettered from the best samples on (COBYLA). Source: motor constant,
standard textbook formula.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, pi, sqrt

import numpy as np
import scipy
from scipy.optimize import minimize

from electrical.driven_machine import BegunMachine, DrivenMachine
from geometry.areas import part_areas
from geometry.checks import check_machine
from geometry.errors import GeometryError
from geometry.moves import Move, moved
from geometry.parts import ComposedMachine
from magnetostatics.case import FieldCase
from magnetostatics.flux_map import map_angles
from magnetostatics.newton import FieldSolutionError
from magnetostatics.positions import angles_past_slots
from magnetostatics.probes import probe_reader
from magnetostatics.torque import maxwell_torque
from magnetostatics.turn import Supply, solved_turn
from tasks import Workers

FEWEST_ANGLES = 4  # over a period of the torque
_STEEPEST = 80.0  # degrees of the current angle to either side of the q axis
_STARTS = 2  # best samples that are bettered
_EVALUATIONS = 60  # of each
_FIRST_STEP, _LAST_STEP = 0.15, 0.004  # of the bounds
_UNBUILDABLE = 10.0  # how far one that cannot be built breaks its limit, relative


class NoDesignError(ValueError):
    """No sample can be built within the limit; the message says what to widen."""


@dataclass(frozen=True, eq=False)
class StatedDesign:
    """The machine that is begun with: how it is solved, and what drives it."""

    case: FieldCase
    driven: DrivenMachine


@dataclass(frozen=True)
class KindSearch:
    """moves: what may vary; limit: largest mean flux density across a tooth or the back iron [T]; samples: how many,
    dimensionless"""

    moves: tuple[Move, ...]
    limit: float
    samples: int


@dataclass(frozen=True)
class KindDesign:
    """amounts: of the moves [m, rad or 1]; current_angle: electrical, from the q axis [rad]

    torque: of the stack [Nm]; motor_constant [Nm/sqrt(W)]; tooth, back_iron: largest flux densities [T]
    """

    amounts: tuple[float, ...]
    current_angle: float
    torque: float
    motor_constant: float
    tooth: float
    back_iron: float

    @property
    def flux_density(self) -> float:
        """The larger of both [T]."""
        return max(self.tooth, self.back_iron)


@dataclass(frozen=True)
class KindOutcome:
    """drawn: the machine of the file, its current angle bettered alone; samples: that can be built; best: what was
    found; unbuildable: how many samples could not be drawn or solved"""

    search: KindSearch
    drawn: KindDesign
    samples: tuple[KindDesign, ...]
    best: KindDesign
    unbuildable: int


@dataclass(frozen=True)
class KindTask:
    """Where to look: one place, or on from there. place: shares of the bounds, the current angle last, 0 to 1"""

    stated: StatedDesign
    search: KindSearch
    place: tuple[float, ...]


def kind_search_stage(stated: StatedDesign, search: KindSearch, workers: Workers) -> KindOutcome:
    """Sample, then better the best. Raises NoDesignError where nothing holds the limit."""
    places = scipy.stats.qmc.Sobol(len(search.moves) + 1, seed=0).random(search.samples)
    tasks = {f"design {k}": KindTask(stated, search, tuple(place)) for k, place in enumerate(places.tolist())}
    found = workers.map("sweep", solve_place, tasks)
    built = {name: one for name, one in found.items() if one is not None}
    held = [name for name, one in built.items() if one.flux_density <= search.limit and one.torque > 0]
    if not held:
        raise NoDesignError(
            f"none of {search.samples} designs can be built with at most {search.limit:g} T in teeth and back iron "
            f"({len(built)} can be built at all): widen the bounds of [[variables]] or raise flux_density_max_T"
        )
    first = sorted(held, key=lambda name: -built[name].motor_constant)[:_STARTS]
    bettered = workers.map("optimum", better_place, {f"from {name}": tasks[name] for name in first})
    drawn = KindTask(stated, KindSearch((), search.limit, 0), (0.5,))
    alone = workers.map("as drawn", better_place, {"current angle": drawn})["current angle"]
    best = max((*bettered.values(), *(built[name] for name in first)), key=lambda one: _merit(one, search.limit))
    return KindOutcome(search, alone, tuple(built.values()), best, search.samples - len(built))


def solve_place(task: KindTask) -> KindDesign | None:
    """One design, None where it cannot be drawn or solved."""
    *shares, turn = task.place
    amounts = [move.low + share * (move.high - move.low) for move, share in zip(task.search.moves, shares, strict=True)]
    angle = (2 * turn - 1) * _STEEPEST * pi / 180
    try:
        return _solved(task.stated, task.search.moves, amounts, angle)
    except (GeometryError, FieldSolutionError):
        return None


def better_place(task: KindTask) -> KindDesign:
    """The best design that COBYLA finds from a place on."""
    known: dict[tuple[float, ...], KindDesign | None] = {}

    def at(place: np.ndarray) -> KindDesign | None:
        key = tuple(np.clip(place, 0.0, 1.0).tolist())
        if key not in known:
            known[key] = solve_place(KindTask(task.stated, task.search, key))
        return known[key]

    limit, first = task.search.limit, at(np.array(task.place))
    unit = abs(first.motor_constant) if first is not None else 1.0
    minimize(
        lambda place: _cost(at(place), unit),
        np.array(task.place),
        method="COBYLA",
        constraints=[
            {"type": "ineq", "fun": lambda place: _room(at(place), limit)},
            {"type": "ineq", "fun": lambda place: np.concatenate([place, 1 - place])},
        ],
        options={"rhobeg": _FIRST_STEP, "tol": _LAST_STEP, "maxiter": _EVALUATIONS},
    )
    designs = [one for one in known.values() if one is not None]
    return max(designs, key=lambda one: _merit(one, limit))


def _cost(design: KindDesign | None, unit: float) -> float:
    return 0.0 if design is None else -design.motor_constant / unit


def _room(design: KindDesign | None, limit: float) -> float:
    return -_UNBUILDABLE if design is None else 1 - design.flux_density / limit


def _merit(design: KindDesign, limit: float) -> float:
    """The motor constant, nothing where the limit is broken or the torque runs backwards."""
    return design.motor_constant if design.flux_density <= limit else -inf


def machine_of(driven: DrivenMachine, moves: Sequence[Move], amounts: Sequence[float]) -> ComposedMachine:
    """The stated machine moved; amounts: of the moves [m, rad or 1]. Raises GeometryError where it cannot be built."""
    machine = driven.wound.machine
    if not isinstance(machine, ComposedMachine):
        raise GeometryError("dimensions are moved of a machine that a file puts together from a stator and a rotor")
    changed = moved(machine, moves, amounts)
    check_machine(changed)
    return changed


def begun_as_found(stated: StatedDesign, found: KindOutcome) -> BegunMachine:
    """The best machine with the turns and the current of the stated one and wire that fills its slots as far."""
    return BegunMachine(_found(stated, found))


def begun_as_found_to_be_wound(stated: StatedDesign, found: KindOutcome) -> BegunMachine:
    """The best machine with the current density of the stated one: its current grows with the copper."""
    driven = _found(stated, found)
    grown = driven.wound.copper_area / stated.driven.wound.copper_area
    limits = replace(driven.limits, current_peak=grown * driven.limits.current_peak)
    return BegunMachine(replace(driven, limits=limits))


def _found(stated: StatedDesign, found: KindOutcome) -> DrivenMachine:
    driven, wound = stated.driven, stated.driven.wound
    machine = machine_of(driven, found.search.moves, found.best.amounts)
    wider = sqrt(part_areas(machine).half_slot / part_areas(wound.machine).half_slot)
    wire = wound.design.wire
    sized = replace(
        wire, copper_diameter=wider * wire.copper_diameter, outer_diameter=wider * wire.outer_diameter
    )
    return replace(driven, wound=replace(wound, machine=machine, design=replace(wound.design, wire=sized)))


def begun_as_stated(stated: StatedDesign) -> BegunMachine:
    """The machine of the file itself."""
    return BegunMachine(stated.driven)


def _solved(stated: StatedDesign, moves: Sequence[Move], amounts: Sequence[float], angle: float) -> KindDesign:
    driven, wound = stated.driven, stated.driven.wound
    machine = machine_of(driven, moves, amounts)
    model = stated.case.model(machine)
    supply = Supply(driven.limits.current_peak, angle, wound.equivalent_turns)
    solutions = solved_turn(model, supply, map_angles(model, angles_past_slots(machine, FEWEST_ANGLES)))
    torque = wound.active_length * float(np.mean([maxwell_torque(one) for one in solutions]))
    reader = probe_reader(model)
    read = [reader.read(one) for one in solutions]
    tooth, yoke = (max(v for one in read for n, v in one.items() if n.startswith(k)) for k in ("tooth", "back_iron"))
    constant = torque / sqrt(_copper_loss(stated, machine))
    return KindDesign(tuple(amounts), angle, torque, constant, tooth, yoke)


def _copper_loss(stated: StatedDesign, machine: ComposedMachine) -> float:
    """At full current, in coil sides that are filled as those of the stated machine [W]."""
    driven, wound = stated.driven, stated.driven.wound
    ampere_turns = wound.equivalent_turns * driven.limits.current_peak
    coil_side = 2 * machine.slots * part_areas(machine).half_slot / (6 * wound.coils_in_series)
    length = wound.active_length + replace(wound, machine=machine).end_turn_length
    resistivity = wound.design.wire.resistivity
    return 3 * wound.coils_in_series * resistivity * length * ampere_turns**2 / (stated.case.packing * coil_side)
