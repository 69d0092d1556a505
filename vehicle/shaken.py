"""The thesis's quarter car with a harmonic force on its body (Figs 4.35-4.39): what the real actuator does inside."""

from __future__ import annotations

from dataclasses import dataclass, replace

from actuator.model import Actuator
from vehicle.designed import DesignedActuator
from vehicle.energy_stage import STEP, EnergyOutcome, outcome_of
from vehicle.printed_car import PRINTED_CAR, PRINTED_DAMPING
from vehicle.ride import HarmonicForce, Run, Scenario

SHAKING = HarmonicForce(amplitude=500.0, frequency=1.0)  # N, Hz, text to Fig. 4.35
DURATION = 15.0  # s, as the rides over the road; not printed
AMPLIFIED = 100.0  # of the mechanical loss, text to Fig. 4.37
AS_STATED, MORE_FRICTION = "friction as stated", f"friction {AMPLIFIED:g} times"


@dataclass(frozen=True)
class PrintedShaking:
    """What the text to Figs 4.35-4.39 says, None where it says nothing.

    mechanical, electrical: mean powers [W]; shaft_passive, machine_passive: shares of the time, dimensionless
    shaft_factor, machine_factor: power factors, dimensionless
    """

    mechanical: float
    electrical: float
    shaft_passive: float
    machine_passive: float
    shaft_factor: float | None = None
    machine_factor: float | None = None


PRINTED = {
    AS_STATED: PrintedShaking(16.0, 9.0, 1.00, 0.96, 1.0, 0.96),
    MORE_FRICTION: PrintedShaking(16.0, -9.0, 0.99, 0.07),
}


def shaken(own: DesignedActuator) -> EnergyOutcome:
    """The maximum damping with the force loop, the friction as it is and amplified; a command of the outcome each.

    Raises what ``vehicle.ride.simulate`` raises.
    """
    scenario = Scenario("harmonic force", 0.0, DURATION, body_force=SHAKING, time_step=STEP)
    actuators = {AS_STATED: own.actuator, MORE_FRICTION: with_more_friction(own.actuator, AMPLIFIED)}
    runs = {name: Run(PRINTED_CAR, PRINTED_DAMPING[0], scenario, one, own.loop) for name, one in actuators.items()}
    return outcome_of(own, runs)


def with_more_friction(actuator: Actuator, factor: float) -> Actuator:
    """An actuator whose viscous loss, the loss element of the thesis, is so many times its own; factor: [1]."""
    return replace(actuator, loss=replace(actuator.loss, viscous=factor * actuator.loss.viscous))
