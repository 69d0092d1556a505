"""The winding of the matched machine, chosen on its flux map, and the active length it needs behind the real gears.

The match counts on a packing factor and a ratio that are any number, and on a current density for good that is stated;
turns, wires and teeth are whole ones, and what may be asked for good is a matter of temperatures. So the length is made
again: for the peak torque that the flux map gives at the current of the real winding, and for the torque for good, by
the temperatures that a ``ContinuousNeed`` knows. Every winding that could be chosen is valued at the length that it
would need. No field is solved for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import PchipInterpolator

from electrical.circulating import ZeroSequence
from electrical.dq import DriveLimits, mtpa_currents
from electrical.final_length import (
    ContinuousNeed,
    FinalLength,
    LengthNeed,
    final_length,
    length_for_damping,
    length_for_torque,
)
from electrical.flux_map_machine import FluxMapMachine
from electrical.resistance import phase_resistance
from electrical.shaft_demand import ShaftDemand
from electrical.short_circuit import shaft_damping
from electrical.synchronous_machine import SynchronousMachine
from electrical.winding_connection import Delta, Star, WindingConnection
from electrical.winding_design import WindingDesign
from electrical.winding_reason import choice_reason, verdict
from electrical.winding_selection import (
    PerTurnMachine,
    Winding,
    WindingChoice,
    WindingError,
    WindingLimits,
    WindingRequirement,
    evaluate_windings,
    full_designs,
    select_winding,
    with_circulation,
    with_maximum_power,
)
from electrical.wire import Wire
from electrical.wound_machine import WoundMachine, machine_end_turn
from geometry.family import MatchedMachine
from geometry.winding import WindingLayout, star_of_slots
from magnetostatics.flux_map_stage import FluxMap
from materials.insulation import InsulationClass

NEIGHBOURS = 3  # turns either side of the chosen winding that are shown beside it
_COPPERS = 4  # copper sections of a gauge and closing at which the length for good is found; cubic between them


@dataclass(frozen=True)
class WindingInputs:
    """What the winding may be made of and is held to.

    wires: allowed gauges, their copper at the temperature of the winding; paths: allowed numbers of parallel paths;
    closings: whether star, delta or both are allowed; limits: of workshop, bus and power electronics
    insulation: thermal class; nominal_density: current density that the match counts on for good, RMS in the copper
        [A/m^2]
    longest: active length that is allowed [m]
    damping_asked: whether the length must also give the regenerative damping that is required
    """

    wires: tuple[Wire, ...]
    paths: tuple[int, ...]
    closings: tuple[Star | Delta, ...]
    limits: WindingLimits
    insulation: InsulationClass
    nominal_density: float
    longest: float
    damping_asked: bool

    @property
    def resistivity(self) -> float:
        """Of the copper of every gauge [ohm m]."""
        return self.wires[0].resistivity


@dataclass(frozen=True)
class Alternative:
    """What would be wound of one gauge and connection, and why it was chosen or not."""

    winding: Winding
    verdict: str


@dataclass(frozen=True)
class WindingOutcome:
    """What is wound, why, and what it gives.

    wound: the machine with its winding and final length
    chosen: its row; reason: why it was chosen; unrestricted: what would meet the requirement without a current limit
    table: every full slot of the chosen gauge and connection; near: those with a few turns more or less, and
        ``unrestricted``, by turns, with their maximum power
    alternatives: the best of each gauge and connection; left_out: numbers of parallel paths that the study allows and
        the star of slots does not
    requirement: base speed and power that the choice was held to
    length: the final length and what sets it
    limits: peak phase current [A] and voltage [V]
    direct_current, quadrature_current: of the peak torque, i_d and i_q [A]
    peak_torque: largest torque at the overload current, mean over one electrical period [Nm]
    peak_torque_error: what the mesh may have put it off by [Nm]
    peak_torque_ripple: largest less smallest torque over the rotor angle at that current [Nm]
    constant: the same winding as constant parameters, for comparison
    """

    wound: WoundMachine
    chosen: Winding
    reason: str
    unrestricted: Winding | None
    table: tuple[Winding, ...]
    near: tuple[Winding, ...]
    alternatives: tuple[Alternative, ...]
    left_out: tuple[int, ...]
    requirement: WindingRequirement
    length: FinalLength
    limits: DriveLimits
    direct_current: float
    quadrature_current: float
    peak_torque: float
    peak_torque_error: float
    peak_torque_ripple: float
    constant: SynchronousMachine


def winding_stage(
    flux_map: FluxMap,
    matched: MatchedMachine,
    demand: ShaftDemand,
    inputs: WindingInputs,
    continuous: ContinuousNeed,
) -> WindingOutcome:
    """Choose turns, wires in hand, gauge, connection and active length on the flux map.

    The torque counts less the error of its mesh. It is not asked of the winding: the length is made for it.
    Raises WindingError when no winding fits the slot or stays within the current limit, or no number of paths is
    possible.
    """
    requirement = WindingRequirement(demand.base_speed, demand.power, torque=0.0)
    machine = per_turn_machine(flux_map, machine_end_turn(matched.machine, flux_map.coil_pitch))
    connections = possible_connections(layout_of(flux_map, matched), inputs.paths, inputs.closings)
    designs = full_designs(machine.coil_side_area, inputs.wires, connections, inputs.limits)
    needed = Lengths(machine, flux_map.torque_error, demand, inputs, continuous).of(designs)
    windings = evaluate_windings(machine, inputs.limits, designs, needed)
    windings = _with_circulation(machine, flux_map, windings, inputs, requirement)
    choice = select_winding(windings, inputs.limits, requirement)
    length = needed[designs.index(choice.chosen.design)]
    return _outcome(flux_map, matched, machine, choice, length, requirement, inputs)


def rated_speed(winding: WindingOutcome, limits: WindingLimits) -> float:
    """The base speed, or the largest allowed one where that is lower [rad/s]."""
    return min(winding.chosen.base_speed, limits.maximum_speed)


def per_turn_machine(flux_map: FluxMap, end_turn_length: float) -> PerTurnMachine:
    """The machine of a map before its winding is chosen; end_turn_length: [m]."""
    return PerTurnMachine(
        dq=FluxMapMachine.from_per_turn(flux_map.data, turns=1, active_length=1.0, resistance=0.0),
        coils_in_series=flux_map.coils_in_series,
        coil_side_area=flux_map.coil_side_area,
        end_turn_length=end_turn_length,
    )


def layout_of(flux_map: FluxMap, matched: MatchedMachine) -> WindingLayout:
    """The winding that the map was solved with, by its star of slots."""
    machine = matched.machine
    layers = 2 * WindingLayout.phases * flux_map.coils_in_series // machine.slots
    return star_of_slots(machine.slots, machine.pole_pairs, layers, flux_map.coil_pitch)


def possible_connections(
    layout: WindingLayout, paths: tuple[int, ...], closings: tuple[Star | Delta, ...]
) -> tuple[WindingConnection, ...]:
    """Those that are allowed and that the star of slots makes possible; paths: allowed numbers of parallel ones.

    Raises WindingError where none of the numbers of paths is possible.
    """
    numbers = [number for number in paths if number in layout.path_numbers]
    if not numbers:
        raise WindingError(
            f"none of winding_selection.parallel_paths = {list(paths)} is possible: {layout.slots} slots and "
            f"{2 * layout.pole_pairs} poles have equal paths for {list(layout.path_numbers)} only; allow one of these"
        )
    return tuple(WindingConnection(number, closing) for closing in closings for number in numbers)


@dataclass(frozen=True, eq=False)
class Lengths:
    """What a wound machine must be long for, whatever its turns: the ampere-turns follow from the copper.

    torque_error: share of the torque that the mesh may have put on top
    """

    machine: PerTurnMachine
    torque_error: float
    demand: ShaftDemand
    inputs: WindingInputs
    continuous: ContinuousNeed

    def of(self, designs: tuple[WindingDesign, ...]) -> tuple[FinalLength, ...]:
        """Of every design, rounded up to what can be cut."""
        copper = np.array([one.copper_area for one in designs])
        peak, good = self._peak_torque_per_length(copper), self._lengths_for_good(designs)
        rows = zip(copper.tolist(), peak.tolist(), good, strict=True)
        return tuple(final_length(self._needs(*row), self.inputs.longest) for row in rows)

    def _peak_torque_per_length(self, copper: np.ndarray) -> np.ndarray:
        """Surely [Nm/m]; copper: sections of a coil side [m^2]."""
        dq, density = self.machine.dq, self.inputs.limits.overload_current_density
        return (1 - self.torque_error) * np.asarray(dq.torque(*mtpa_currents(dq, 2**0.5 * density * copper)))

    def _lengths_for_good(self, designs: tuple[WindingDesign, ...]) -> list[float]:
        """[m], over the copper of each gauge and closing."""
        kinds: dict[object, list[WindingDesign]] = {}
        for one in designs:
            kinds.setdefault(_kind(one), []).append(one)
        laws = {kind: over_copper(self.continuous, tuple(some)) for kind, some in kinds.items()}
        with np.errstate(divide="ignore"):
            return [float(1 / np.float64(laws[_kind(one)](one.copper_area))) for one in designs]

    def _needs(self, copper: float, peak: float, good: float) -> tuple[LengthNeed, ...]:
        """copper: [m^2]; peak: torque [Nm/m]; good: length for the continuous torque [m]."""
        torques = (
            LengthNeed("the peak torque", length_for_torque(self.demand.torque_peak, peak)),
            LengthNeed(self.continuous.name, good),
        )
        if not self.inputs.damping_asked:
            return torques
        return (*torques, LengthNeed("the damping", self._length_for_damping(copper)))

    def _length_for_damping(self, copper: float) -> float:
        """[m]; of one turn, since turns do not change the damping; copper: [m^2]."""
        machine, longest = self.machine, self.inputs.longest
        resistance = phase_resistance(
            turns=1,
            strands=1,
            wire_area=copper,
            active_length=longest,
            end_turn_length=machine.end_turn_length,
            coils_in_series=machine.coils_in_series,
            resistivity=self.inputs.resistivity,
        )
        reached = shaft_damping(torque_constant=self._constant * longest, phase_resistance=resistance)
        known = {"length": longest, "end_turn_length": machine.end_turn_length}
        return length_for_damping(self.demand.damping, reached=reached, **known)

    @cached_property
    def _constant(self) -> float:
        """Of one turn and one metre, without current [Nm/A]."""
        return 1.5 * self.machine.dq.pole_pairs * float(self.machine.dq.flux_linkage(0.0, 0.0)[0])


def _kind(design: WindingDesign) -> tuple[Wire, Star | Delta]:
    """What a length for good depends on beside the copper."""
    return design.wire, design.connection.closing


def over_copper(continuous: ContinuousNeed, designs: tuple[WindingDesign, ...]) -> Callable[[float], float]:
    """Inverse of the length for good [1/m] over the copper of a coil side [m^2], of one gauge and closing.

    Found at ``_COPPERS`` sections; between them, where it is smooth, by cubics that do not overshoot.
    """
    one_of = {one.copper_area: one for one in designs}
    sections = sorted(one_of)
    places = dict.fromkeys(np.linspace(0, len(sections) - 1, _COPPERS).round().astype(int).tolist())
    known = [sections[place] for place in places]
    inverse = [1 / continuous.length(one_of[area]) for area in known]
    if len(known) == 1:
        return lambda area: inverse[0]
    law = PchipInterpolator(known, inverse)
    return lambda area: float(law(area))


def _with_circulation(
    machine: PerTurnMachine,
    flux_map: FluxMap,
    windings: tuple[Winding, ...],
    inputs: WindingInputs,
    requirement: WindingRequirement,
) -> tuple[Winding, ...]:
    """At the nominal current density and the base speed that is asked for."""
    closed = tuple(one for one in windings if one.design.connection.closing.circulates)
    if not closed:
        return windings
    zero, speed = ZeroSequence.from_per_turn(flux_map.data), requirement.base_speed
    rest = tuple(one for one in windings if not one.design.connection.closing.circulates)
    return rest + with_circulation(machine, zero, closed, inputs.nominal_density, speed)


def _outcome(
    flux_map: FluxMap,
    matched: MatchedMachine,
    machine: PerTurnMachine,
    choice: WindingChoice,
    length: FinalLength,
    requirement: WindingRequirement,
    inputs: WindingInputs,
) -> WindingOutcome:
    near = with_maximum_power(machine, inputs.limits, neighbours(choice))
    chosen = next(one for one in near if one.design == choice.chosen.design)
    wound = _wound(flux_map, matched, chosen)
    field = wound.on_map(flux_map.data)
    i_d, i_q = (float(i) for i in mtpa_currents(field, chosen.current_peak))
    torque = float(field.torque(i_d, i_q))
    return WindingOutcome(
        wound=wound,
        chosen=chosen,
        reason=choice_reason(choice, inputs.limits, requirement),
        unrestricted=choice.unrestricted,
        table=of_the_same_kind(choice),
        near=near,
        alternatives=tuple(Alternative(one, verdict(one, choice, inputs.limits, requirement)) for one in choice.best),
        left_out=tuple(one for one in inputs.paths if one not in layout_of(flux_map, matched).path_numbers),
        requirement=requirement,
        length=length,
        limits=DriveLimits.from_dc_bus(chosen.current_peak, inputs.limits.dc_voltage),
        direct_current=i_d,
        quadrature_current=i_q,
        peak_torque=torque,
        peak_torque_error=flux_map.torque_error * torque,
        peak_torque_ripple=wound.active_length * flux_map.torque_ripple(*wound.ampere_turns(i_d, i_q)),
        constant=chosen.constant_parameters(field.pole_pairs),
    )


def of_the_same_kind(choice: WindingChoice) -> tuple[Winding, ...]:
    """Full slots of the chosen gauge and connection."""
    chosen = choice.chosen.design
    return tuple(one for one in choice.table if one.design.is_like(chosen))


def neighbours(choice: WindingChoice) -> tuple[Winding, ...]:
    """Full slots of the chosen gauge and connection within ``NEIGHBOURS`` turns of the chosen one, and the one that
    would meet the requirement."""
    near = [one for one in of_the_same_kind(choice) if abs(one.turns - choice.chosen.turns) <= NEIGHBOURS]
    further = [choice.unrestricted] if choice.unrestricted is not None and choice.unrestricted not in near else []
    return tuple(sorted(near + further, key=lambda one: one.turns))


def _wound(flux_map: FluxMap, matched: MatchedMachine, winding: Winding) -> WoundMachine:
    return WoundMachine(
        machine=matched.machine,
        coils_in_series=flux_map.coils_in_series,
        coil_pitch=flux_map.coil_pitch,
        design=winding.design,
        active_length=winding.active_length,
    )
