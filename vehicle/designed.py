"""The actuator of a study, from what its stages have found."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from actuator.drive import MappedLoss, MappedMotor, TorqueLimit
from actuator.model import Actuator
from actuator.parts import LOSSLESS, CompliantMount, GearEfficiency, MechanicalLoss, Ratio, fixed_ratio
from actuator.terminals import Terminals
from control.force_loop import ForceLoop
from drivetrain.linkage_stage import LinkageFront
from drivetrain.outcome import Outcome
from electrical.braking import strongest_braking
from electrical.dq import mtpa_currents, torque_speed_envelope
from electrical.synchronous_machine import SynchronousMachine
from electrical.winding_stage import WindingOutcome
from gearbox.stage import GearboxOutcome
from losses.stage import LossMap
from magnetostatics.flux_map_stage import FluxMap

# The prototype of thesis chapter 4, whose mount and loop stand in for those of an actuator that was not measured:
# nominal value times identified gain (Table 4.2), printed loop (Table 4.5), and the lag of a current control (4.2.1).
PROTOTYPE_MOUNT = CompliantMount(
    stiffness=5e5 * 1.352,
    damping=500.0 * 0.590,
    play=2e-4 * 0.046,
    contact_damping=100.0 * 5.452,
    transition=1.5e-3 * 2.558,
)
PROTOTYPE_LOOP = ForceLoop(proportional=7.4, integral=1000.0, derivative=5.9e-3, filter=6283.0)
PROTOTYPE_LAG = 1e-3  # s
_CURRENTS = 40  # of the table of the terminals


@dataclass(frozen=True)
class ActuatorInputs:
    """What a study says of its actuator beyond machine, gears and linkage.

    mount: between suspension and equivalent mass; torque_lag: of drive and current control [s]; loop: around the force
    """

    mount: CompliantMount
    torque_lag: float
    loop: ForceLoop


@dataclass(frozen=True)
class DesignedActuator:
    """The actuator that was designed, and the loop around its force."""

    actuator: Actuator
    loop: ForceLoop


def designed_actuator(
    winding: WindingOutcome,
    flux_map: FluxMap,
    losses: LossMap,
    gears: GearboxOutcome,
    front: LinkageFront | None,
    outcome: Outcome,
    inputs: ActuatorInputs,
) -> DesignedActuator:
    """Motor on flux map and loss map, gears with their meshing losses, the linkage over its travel, the study's mount.

    front: None for a linkage of which two ratios are all that is known; then the nominal one holds everywhere
    """
    driven = driven_parts(outcome, gears)
    actuator = replace(
        driven,
        drive=MappedMotor(torque_limit(winding, flux_map, losses), loss_law(losses), inputs.torque_lag),
        ratio=driven.ratio if front is None else ratio_over_stroke(front, gears),
        mount=inputs.mount,
    )
    return DesignedActuator(actuator, inputs.loop)


def driven_parts(outcome: Outcome, gears: GearboxOutcome | None) -> Actuator:
    """Ratio, equivalent mass, friction and meshes of a design without drive and mount; gears: None for a direct one."""
    limits = outcome.limits
    return Actuator(
        ratio=fixed_ratio(outcome.features.transmission_ratio),
        equivalent_mass=limits.equivalent_mass,
        loss=MechanicalLoss(limits.viscous_friction, limits.coulomb_friction),
        gears=LOSSLESS if gears is None else GearEfficiency(*gears.train.efficiency),
    )


def designed_terminals(winding: WindingOutcome, flux_map: FluxMap) -> Terminals:
    """Bus voltage, and the phase current of each torque at the least current, up to the overload."""
    machine, limits = winding.wound.on_map(flux_map.data), winding.limits
    current = np.linspace(0.0, float(limits.current_peak), _CURRENTS + 1)
    torque = machine.torque(*mtpa_currents(machine, current[1:]))
    bus = sqrt(3) * float(limits.voltage_peak)  # ``DriveLimits.from_dc_bus``
    return Terminals(bus, (0.0, *np.asarray(torque).tolist()), tuple(current.tolist()))


def ratio_over_stroke(front: LinkageFront, gears: GearboxOutcome) -> Ratio:
    """tau_t over the stroke of the suspension, which is the wheel travel with the other sign."""
    motion = front.built.motion
    order = np.argsort(-motion.travel)
    ratio = motion.transmission_ratio[order] / gears.train.ratio
    return Ratio(tuple((-motion.travel[order]).tolist()), tuple(ratio.tolist()))


def loss_law(losses: LossMap) -> MappedLoss:
    """Losses over torque and speed of the rotor, as motor and as generator."""
    data = losses.losses
    return MappedLoss(np.asarray(data.torque)[:, 0], np.asarray(data.speed)[0], np.asarray(data.total))


def torque_limit(winding: WindingOutcome, flux_map: FluxMap, losses: LossMap) -> TorqueLimit:
    """Within current and voltage over the speeds of the loss map; braking, no more than the peak torque."""
    machine, speed = winding.wound.on_map(flux_map.data), np.asarray(losses.losses.speed)[0]
    driving = np.nan_to_num(torque_speed_envelope(machine, winding.limits, speed).torque, nan=0.0)
    braking = np.nan_to_num(strongest_braking(machine, winding.limits, speed[1:]).torque, nan=0.0)
    braking = np.minimum(np.concatenate([driving[:1], braking]), winding.peak_torque)
    return TorqueLimit(*(tuple(one.tolist()) for one in (speed, driving, braking)))


@dataclass(frozen=True)
class BenchMachine:
    """The machine of an actuator as a bench meets it at its terminals.

    machine: constant parameters, inductances at the overload current; terminals: currents over torque
    """

    machine: SynchronousMachine
    terminals: Terminals


def bench_machine(winding: WindingOutcome, flux_map: FluxMap) -> BenchMachine:
    """Of a design."""
    machine = winding.wound.on_map(flux_map.data).constant_parameters(float(winding.limits.current_peak))
    return BenchMachine(machine, designed_terminals(winding, flux_map))
