"""The numbers of the data sheet that are read off artefacts at one point, and how the coils are connected.

Nothing is designed or solved here: maps of the stages before are read at the rated point and at full current.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drivetrain.costs import PartCost, PartPrices, part_costs
from drivetrain.outcome import Outcome
from electrical.braking_stage import BrakingOutcome, ShortCircuit
from electrical.dq import mtpa_currents
from electrical.flux_map_machine import FluxMapMachine
from electrical.synchronous_machine import SynchronousMachine
from electrical.winding_stage import WindingInputs, WindingOutcome, rated_speed
from geometry.connections import Connection, connections
from geometry.winding import WindingLayout
from losses.map import PowerLosses
from losses.stage import LossMap
from magnetostatics.case import FieldCase
from magnetostatics.flux_map_stage import FluxMap
from magnetostatics.gap_stress_stage import GapStress


@dataclass(frozen=True)
class OperatingState:
    """The machine at one torque [Nm] and mechanical speed [rad/s].

    i_d, i_q: peak phase currents [A]; voltage_peak: of a phase [V]
    power_in: electrical, without iron and magnet losses [W]
    """

    torque: float
    speed: float
    i_d: float
    i_q: float
    voltage_peak: float
    power_in: float

    @property
    def current_peak(self) -> float:
        """Peak phase current [A]."""
        return float(np.hypot(self.i_d, self.i_q))


@dataclass(frozen=True)
class Package:
    """What a data sheet says beside the artefacts of the other stages.

    layout, connections: of the winding; costs: of the parts, the sum last; currency: of the costs
    continuous: at the nominal current density and the rated speed; overload: at full current and the rated speed
    losses: at the continuous point, None where the study has no loss data
    short_circuit: of the phases; cogging: torque without current from peak to peak [Nm]
    unsaturated: constant parameters without current, slopes of the flux map there
    """

    layout: WindingLayout
    connections: tuple[Connection, ...]
    costs: tuple[PartCost, ...]
    currency: str
    continuous: OperatingState
    overload: OperatingState
    losses: PowerLosses | None
    short_circuit: ShortCircuit
    cogging: float
    unsaturated: SynchronousMachine


def package_stage(
    case: FieldCase,
    flux_map: FluxMap,
    winding: WindingOutcome,
    inputs: WindingInputs,
    braking: BrakingOutcome,
    outcome: Outcome,
    losses: LossMap | None,
    gap_stress: GapStress,
    prices: PartPrices,
) -> Package:
    """Read the artefacts at the rated speed: the base speed, or the largest allowed one where that is lower."""
    wound = winding.wound
    machine, layout = wound.on_map(flux_map.data), case.layout(wound.machine)
    speed = rated_speed(winding, inputs.limits)
    continuous = least_current_state(machine, wound.current_peak(inputs.nominal_density), speed)
    return Package(
        layout=layout,
        connections=connections(layout, wound.design.connection.paths),
        costs=part_costs(outcome.masses, prices),
        currency=prices.currency,
        continuous=continuous,
        overload=least_current_state(machine, winding.limits.current_peak, speed),
        losses=None if losses is None else losses.losses.at(continuous.torque, continuous.speed),
        short_circuit=braking.shorted,
        cogging=gap_stress.cogging * wound.active_length,
        unsaturated=unsaturated_machine(machine),
    )


def least_current_state(machine: FluxMapMachine, current_peak: float, speed: float) -> OperatingState:
    """The largest torque that a peak phase current [A] gives, at a mechanical speed [rad/s].

    P = 1.5 (v_d i_d + v_q i_q), amplitude-invariant
    """
    i_d, i_q = (float(i) for i in mtpa_currents(machine, current_peak))
    v_d, v_q = (float(v) for v in machine.voltage(i_d, i_q, speed))
    torque, power = float(machine.torque(i_d, i_q)), 1.5 * (v_d * i_d + v_q * i_q)
    return OperatingState(torque, speed, i_d, i_q, float(np.hypot(v_d, v_q)), power)


def unsaturated_machine(machine: FluxMapMachine) -> SynchronousMachine:
    """Magnet flux linkage, and incremental inductances without current."""
    (l_dd, _), (_, l_qq) = machine.incremental_inductances(0.0, 0.0)
    psi_m = float(machine.flux_linkage(0.0, 0.0)[0])
    return SynchronousMachine(machine.pole_pairs, psi_m, float(l_dd), float(l_qq), machine.resistance)
