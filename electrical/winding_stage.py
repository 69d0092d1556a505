"""The winding of the matched machine, chosen on its flux map, and the active length it needs behind the real gears.

The match counts on a packing factor and a ratio that are any number; turns, wires and teeth are whole ones. So the
length is made again for the torque that the flux map gives at the current of the real winding. Winding and length are
chosen in turns until neither moves; no field is solved for it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from electrical.dq import DriveLimits, mtpa_currents
from electrical.final_length import FinalLength, LengthNeed, final_length, length_for_damping, length_for_torque
from electrical.flux_map_machine import FluxMapMachine
from electrical.shaft_demand import ShaftDemand
from electrical.short_circuit import shaft_damping
from electrical.synchronous_machine import SynchronousMachine
from electrical.winding_selection import (
    PerTurnMachine,
    Winding,
    WindingChoice,
    WindingLimits,
    WindingRequirement,
    Wire,
    select_winding,
    with_maximum_power,
)
from electrical.wound_machine import WoundMachine, machine_end_turn
from geometry.family import MatchedMachine
from magnetostatics.flux_map_stage import FluxMap

NEIGHBOURS = 3  # turns either side of the chosen winding that are shown beside it
_ROUNDS = 6  # of choosing a winding and giving it its length; two are enough unless the choice changes with the length
_SAME_LENGTH = 1e-6  # relative


@dataclass(frozen=True)
class WindingInputs:
    """What the winding is made of and held to.

    wire: its copper at the temperature of the winding; limits: of workshop, bus and power electronics
    nominal_density: current density of the continuous force, RMS in the copper [A/m^2]
    longest: active length that is allowed [m]
    damping_asked: whether the length must also give the regenerative damping that is required
    """

    wire: Wire
    limits: WindingLimits
    nominal_density: float
    longest: float
    damping_asked: bool


@dataclass(frozen=True)
class WindingOutcome:
    """What is wound, why, and what it gives.

    wound: the machine with its winding and final length
    chosen: its row; reason: why it was chosen; unrestricted: what would meet the requirement without a current limit
    table: every pair that fits; near: fullest slots with a few turns more or less and ``unrestricted``, by turns, with
        their maximum power
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
) -> WindingOutcome:
    """Choose turns, wires in hand and active length on the flux map.

    The torque counts less the error of its mesh. It is not asked of the winding: the length is made for it.
    Raises WindingError when no winding fits the slot or stays within the current limit.
    """
    requirement = WindingRequirement(demand.base_speed, demand.power, torque=0.0)
    one = per_turn_machine(flux_map, matched, inputs.longest)
    machine, choice, length = wound_to_length(one, flux_map.torque_error, demand, inputs)
    return _outcome(flux_map, matched, machine, choice, length, requirement, inputs)


def per_turn_machine(flux_map: FluxMap, matched: MatchedMachine, active_length: float) -> PerTurnMachine:
    """The machine of a map at an active length [m], before its winding is chosen."""
    return PerTurnMachine(
        dq=FluxMapMachine.from_per_turn(flux_map.data, turns=1, active_length=1.0, resistance=0.0),
        coils_in_series=flux_map.coils_in_series,
        coil_side_area=flux_map.coil_side_area,
        active_length=active_length,
        end_turn_length=machine_end_turn(matched.machine, flux_map.coil_pitch),
    )


def wound_to_length(
    machine: PerTurnMachine,
    torque_error: float,
    demand: ShaftDemand,
    inputs: WindingInputs,
) -> tuple[PerTurnMachine, WindingChoice, FinalLength]:
    """(machine with its final length, the winding, what set the length): the two are chosen in turns.

    torque_error: share of the torque that the mesh may have put on top
    """
    requirement = WindingRequirement(demand.base_speed, demand.power, torque=0.0)
    for _ in range(_ROUNDS):
        choice = select_winding(machine, inputs.wire, inputs.limits, requirement)
        needs = length_needs(machine, torque_error, choice.chosen, demand, inputs)
        found = final_length(needs, inputs.longest)
        if abs(found.length / machine.active_length - 1) < _SAME_LENGTH:
            break
        machine = replace(machine, active_length=found.length)
    return machine, select_winding(machine, inputs.wire, inputs.limits, requirement), found


def length_needs(
    machine: PerTurnMachine,
    torque_error: float,
    winding: Winding,
    demand: ShaftDemand,
    inputs: WindingInputs,
) -> tuple[LengthNeed, ...]:
    """What the wound machine must be long for; torque_error: share that the mesh may have put on top."""

    def length(wanted: float, density: float) -> float:
        ampere_turns = winding.turns * inputs.wire.area * winding.strands * density * 2**0.5
        torque = float(machine.dq.torque(*mtpa_currents(machine.dq, ampere_turns)))
        return length_for_torque(wanted, (1 - torque_error) * torque)

    torques = (
        LengthNeed("the peak torque", length(demand.torque_peak, inputs.limits.overload_current_density)),
        LengthNeed("the RMS torque", length(demand.torque_rms, inputs.nominal_density)),
    )
    if not inputs.damping_asked:
        return torques
    return (*torques, _damping_need(machine, winding, demand.damping))


def _damping_need(machine: PerTurnMachine, winding: Winding, damping: float) -> LengthNeed:
    reached = shaft_damping(torque_constant=winding.no_load_torque_constant, phase_resistance=winding.phase_resistance)
    lengths = {"length": machine.active_length, "end_turn_length": machine.end_turn_length}
    return LengthNeed("the damping", length_for_damping(damping, reached=reached, **lengths))


def _outcome(
    flux_map: FluxMap,
    matched: MatchedMachine,
    machine: PerTurnMachine,
    choice: WindingChoice,
    length: FinalLength,
    requirement: WindingRequirement,
    inputs: WindingInputs,
) -> WindingOutcome:
    near = with_maximum_power(machine, inputs.wire, inputs.limits, neighbours(choice))
    chosen = next(one for one in near if one.turns == choice.chosen.turns)
    wound = _wound(flux_map, matched, machine, chosen, inputs.wire)
    field = wound.on_map(flux_map.data)
    i_d, i_q = (float(i) for i in mtpa_currents(field, chosen.current_peak))
    torque = float(field.torque(i_d, i_q))
    return WindingOutcome(
        wound=wound,
        chosen=chosen,
        reason=choice.reason,
        unrestricted=choice.unrestricted,
        table=choice.table,
        near=near,
        requirement=requirement,
        length=length,
        limits=DriveLimits.from_dc_bus(chosen.current_peak, inputs.limits.dc_voltage),
        direct_current=i_d,
        quadrature_current=i_q,
        peak_torque=torque,
        peak_torque_error=flux_map.torque_error * torque,
        peak_torque_ripple=wound.active_length * flux_map.torque_ripple(wound.turns * i_d, wound.turns * i_q),
        constant=chosen.constant_parameters(field.pole_pairs),
    )


def neighbours(choice: WindingChoice) -> tuple[Winding, ...]:
    """Full slots within ``NEIGHBOURS`` turns of the chosen one, and the one that would meet the requirement."""
    near = [one for one in choice.fullest if abs(one.turns - choice.chosen.turns) <= NEIGHBOURS]
    further = [choice.unrestricted] if choice.unrestricted is not None and choice.unrestricted not in near else []
    return tuple(sorted(near + further, key=lambda one: one.turns))


def _wound(
    flux_map: FluxMap, matched: MatchedMachine, machine: PerTurnMachine, winding: Winding, wire: Wire
) -> WoundMachine:
    return WoundMachine(
        machine=matched.machine,
        coils_in_series=flux_map.coils_in_series,
        coil_pitch=flux_map.coil_pitch,
        turns=winding.turns,
        strands=winding.strands,
        wire_area=wire.area,
        active_length=machine.active_length,
        resistivity=wire.resistivity,
    )
