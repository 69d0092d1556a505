"""How warm the wound machine becomes, and what it may do for ever and for a while: the continuous effort."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from electrical.dq import mtpa_currents
from electrical.flux_map_machine import FluxMapMachine
from electrical.winding_stage import WindingInputs, WindingOutcome
from magnetostatics.flux_map_stage import FluxMap
from materials.conductor import Conductor
from materials.magnet import Magnet
from thermal.air import StillAir
from thermal.cooling import Cooling, HeatLimits
from thermal.errors import NoSteadyState
from thermal.field_loss import FieldLoss
from thermal.load import HotCopper, LoadedMachine, Operation, TorqueHistory, copper_ripple, operation
from thermal.machine import Casing, CooledMachine, Weights
from thermal.rating import (
    Heated,
    LossSlope,
    Overload,
    Rating,
    State,
    allowed_for,
    continuous,
    loss_slope,
    overload,
    state_of,
)

SHORT = 10.0  # s, for which the overload of the thesis is meant (text to eq. 3.68)
# What another workshop would make of the estimates, or another guess.
_FILLERS = (
    (0.05, "wires hardly impregnated, filler of 0.05 W/(m K)"),
    (0.8, "potted with a filled resin, 0.8 W/(m K)"),
)
_GAPS = ((1e-5, "laminations close to the casing, 0.01 mm"), (6e-5, "laminations loose in the casing, 0.06 mm"))
_BARE = 0.1  # emissivity of machined aluminium
_NO_OVERLOAD = Overload(np.empty(0), np.empty(0))
_MOUNT = 2.0  # W/K, an aluminium flange on a plate of some 0.1 m^2 in still air; estimate


@dataclass(frozen=True)
class HeatInputs:
    """What a study says: cooling, limits, magnets, conductor and winding_temperature, which the resistance of the
    wound machine belongs to [degC]."""

    cooling: Cooling
    limits: HeatLimits
    magnets: Magnet
    conductor: Conductor
    winding_temperature: float


@dataclass(frozen=True)
class BuiltMachine:
    """What the machine is built into, and the friction there.

    stacking: steel over stack, dimensionless; ratio: of output over rotor speed [m/rad or 1]
    viscous [Ns/m or Nms/rad], coulomb [N or Nm]: friction at the output
    """

    weights: Weights
    stacking: float
    casing: Casing
    ratio: float
    viscous: float
    coulomb: float

    def friction(self, speed: np.ndarray) -> float:
        """Mean heat [W]; speed: of the output [m/s or rad/s], any shape."""
        return float(np.mean(self.viscous * speed**2 + self.coulomb * np.abs(speed)))


@dataclass(frozen=True, eq=False)
class Duty:
    """What is asked of the output over time, each for the same time step.

    effort [N or Nm] (n,), speed [m/s or rad/s] (n,); step [s], 0 where only the RMS values are known
    """

    effort: np.ndarray
    speed: np.ndarray
    step: float

    @property
    def speed_rms(self) -> float:
        """Of the output [m/s or rad/s]."""
        return float(np.sqrt(np.mean(self.speed**2)))


@dataclass(frozen=True)
class WhatIf:
    """Another value of an estimate; effort: continuous, slowly turning [N or Nm]; bound_by: the nearer limit."""

    words: str
    effort: float
    bound_by: str


@dataclass(frozen=True, eq=False)
class HeatOutcome:
    """How warm the machine becomes.

    inputs: cooling and limits; ratio: of output over rotor speed [m/rad or 1]
    slow, at_speed: ratings turning slowly and at the RMS speed; slope: of the temperatures at the slow one
    duty: state under the duty, None where it runs away
    nominal_effort: at the current density that the study calls nominal, cold [N or Nm]; nominal_density: RMS [A/m^2]
    slow_density: RMS in the copper at the slow rating [A/m^2]
    cold, warm: overload from the surroundings' temperature and from the duty; warm is empty where the duty is too warm
    cold_short, warm_short: effort allowed for 10 s [N or Nm]; peak_effort: at the largest current, cold [N or Nm]
    ripple: of the slot copper under the duty, as if it kept all its heat [K]; peak to peak
    field_known: whether losses in iron and magnets are in; what_ifs: other estimates
    """

    inputs: HeatInputs
    ratio: float
    slow: Rating
    at_speed: Rating
    slope: LossSlope
    duty: State | None
    nominal_effort: float
    nominal_density: float
    slow_density: float
    cold: Overload
    warm: Overload
    cold_short: float
    warm_short: float
    peak_effort: float
    ripple: float
    field_known: bool
    what_ifs: tuple[WhatIf, ...]

    def effort(self, torque: np.ndarray | float) -> np.ndarray | float:
        """At the output [N or Nm], of the shape of the torque; torque: of the rotor [Nm], any shape."""
        return torque / self.ratio

    @property
    def warm_is_possible(self) -> bool:
        """Whether the duty stays below every limit."""
        return self.duty is not None and self.duty.margin(self.inputs.limits) > 0


def heat_stage(
    flux_map: FluxMap,
    winding: WindingOutcome,
    windings: WindingInputs,
    built: BuiltMachine,
    duty: Duty,
    field: FieldLoss,
    inputs: HeatInputs,
) -> HeatOutcome:
    """Rate the wound machine by its temperatures, at rest over time and under its duty.

    Slowly turning means: at no speed, the current shared by the phases over time. A machine that stands still for
    minutes with one phase at its peak heats that phase up to twice as much.
    """
    assembled = Assembled(flux_map, winding, built, field, inputs)
    slow, fast = assembled.heated(0.0), assembled.heated(duty.speed_rms)
    history = assembled.history(duty, fast.operation)
    state = _state(assembled.under(duty, history))
    rating = continuous(slow)
    start = slow.machine.cold() if state is None else state.temperature
    cold, density = slow.machine.cold(), windings.nominal_density
    return HeatOutcome(
        inputs=inputs,
        ratio=built.ratio,
        slow=rating,
        at_speed=continuous(fast),
        slope=loss_slope(slow, rating),
        duty=state,
        nominal_effort=_nominal(assembled.machine, winding.wound.current_peak(density)) / built.ratio,
        nominal_density=density,
        slow_density=rating.current / winding.wound.current_peak(1.0),
        cold=overload(slow, cold, rating),
        warm=_NO_OVERLOAD if state is None else overload(slow, start, rating),
        cold_short=allowed_for(slow, cold, SHORT) / built.ratio,
        warm_short=0.0 if state is None else allowed_for(slow, start, SHORT) / built.ratio,
        peak_effort=float(slow.operation.cold_torque[-1]) / built.ratio,
        ripple=copper_ripple(fast.machine, assembled.copper, history, duty.step, start),
        field_known=field.known,
        what_ifs=tuple(what_ifs(slow, built.ratio)),
    )


def _nominal(machine: FluxMapMachine, current: float) -> float:
    return float(machine.torque(*mtpa_currents(machine, current)))


def _state(load: LoadedMachine) -> State | None:
    try:
        return state_of(load)
    except NoSteadyState:
        return None


@dataclass(frozen=True, eq=False)
class Assembled:
    """Machine, casing and losses: everything that is the same at every speed."""

    flux_map: FluxMap
    winding: WindingOutcome
    built: BuiltMachine
    field: FieldLoss
    inputs: HeatInputs

    @property
    def copper(self) -> HotCopper:
        """How its resistance goes with the temperature."""
        return HotCopper(self.inputs.conductor, self.inputs.winding_temperature)

    @property
    def machine(self) -> FluxMapMachine:
        """With the resistance of its hottest copper, so that the voltage lasts."""
        wound = self.winding.wound
        hot = wound.phase_resistance * self.copper.factor(self.inputs.limits.copper)
        return wound.on_map(self.flux_map.data).with_resistance(hot)

    def heated(self, speed: float) -> Heated:
        """Machine and currents at a speed of the output [m/s or rad/s]."""
        rotor = speed / self.built.ratio
        return Heated(
            self.cooled(rotor),
            self.copper,
            operation(self.machine, self.winding.limits, rotor, self.inputs.magnets),
            self.field,
            self.built.friction(np.array(speed)),
            self.inputs.limits,
        )

    def cooled(self, speed: float) -> CooledMachine:
        """The network at a speed of the rotor [rad/s]."""
        built = self.built
        return CooledMachine(
            self.winding.wound, built.weights, built.stacking, built.casing, self.inputs.cooling, speed
        )

    def history(self, duty: Duty, at_speed: Operation) -> TorqueHistory:
        """Torque and speed of the rotor under a duty."""
        return TorqueHistory(duty.effort * self.built.ratio, duty.speed / self.built.ratio, at_speed)

    def under(self, duty: Duty, history: TorqueHistory) -> LoadedMachine:
        """The machine under its duty: the mean of the losses, with the films of the RMS speed."""
        field = self.field.at(history.torque, history.speed).mean
        cooled, friction = self.cooled(history.operation.speed), self.built.friction(duty.speed)
        return LoadedMachine(cooled, self.copper, history, field, friction)


def what_ifs(heated: Heated, ratio: float) -> Iterator[WhatIf]:
    """The rating with other estimates, one at a time; ratio: of output over rotor speed [m/rad or 1]."""
    for words, cooling in _others(heated.machine.cooling):
        found = continuous(replace(heated, machine=replace(heated.machine, cooling=cooling)))
        yield WhatIf(words, found.torque / ratio, found.bound_by)


def _others(cooling: Cooling) -> Iterator[tuple[str, Cooling]]:
    """What another workshop would make, or another guess, in words."""
    for filler, words in _FILLERS:
        yield words, replace(cooling, filler_conductivity=filler)
    for gap, words in _GAPS:
        yield words, replace(cooling, casing_gap=gap)
    if isinstance(cooling.film, StillAir):
        yield "bare metal outside, emissivity 0.1", replace(cooling, film=StillAir(_BARE))
    yield f"{_MOUNT:g} W/K more into what it is mounted on", replace(cooling, mount=cooling.mount + _MOUNT)
