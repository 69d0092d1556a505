"""How long a machine must be for its continuous torque, by the temperatures of its network at that length.

For every length the whole network is made anew: conductors, ways and casing grow with it, the current falls. The torque
is asked at the RMS speed and at the least current that gives it; magnets and copper settle at their temperatures
together. Where the voltage leaves less at that speed, turns are at fault and not the length, and the outcome says so.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf, pi
from typing import ClassVar, Protocol

import numpy as np
from scipy.optimize import brentq

from electrical.dq import mtpa_currents
from electrical.final_length import ContinuousNeed
from electrical.flux_map_machine import FluxMapMachine
from electrical.winding_design import WindingDesign
from electrical.wound_machine import WoundMachine
from geometry.parts import DrawnMachine
from losses.map import FieldLossTable
from magnetostatics.flux_map_stage import FluxMap
from thermal.errors import NoSteadyState
from thermal.field_loss import FieldHeat
from thermal.load import HotCopper, LoadedMachine, Operation, TorqueHistory
from thermal.machine import CooledMachine
from thermal.network import settled
from thermal.rating import FAR_BEYOND, excess
from thermal.stage import BuiltMachine, HeatInputs

_CURRENTS = 81  # of the curve of torque over current; linear between them to 0.02 % of the largest torque
_STEP = 1.3  # between lengths that are looked at before the first that is enough is refined
_FOUND = 1e-7  # m
REACH = 3.0  # of the longest length allowed, up to which one is looked for


class Enclosure(Protocol):
    """What a wound machine is built into; it grows with the machine."""

    def around(self, wound: WoundMachine) -> BuiltMachine:
        """Casing, weights and friction."""


@dataclass(frozen=True, eq=False)
class CurrentCurve:
    """A cross-section of one turn and one metre over the current, at one speed.

    current: peak ampere-turns of a coil from 0 up [A], (n,); direct, quadrature: their parts of least current [A], (n,)
    torque: with the magnets as they are mapped [Nm/m], (n,)
    field: losses of the turning field [W/m], (n,) each, none in the copper
    """

    current: np.ndarray
    direct: np.ndarray
    quadrature: np.ndarray
    torque: np.ndarray
    field: FieldHeat


@dataclass(frozen=True, eq=False)
class LengthByTemperature(ContinuousNeed):
    """Length for a torque [Nm] at a speed of the rotor [rad/s], both for good; the torque counts less the error of its
    mesh.

    table: losses of the turning field, None where the steel has no loss data; longest: length that is allowed [m]
    """

    flux_map: FluxMap
    machine: DrawnMachine
    table: FieldLossTable | None
    enclosure: Enclosure
    inputs: HeatInputs
    torque: float
    speed: float
    longest: float
    name: ClassVar[str] = "the continuous torque by temperature"

    def length(self, design: WindingDesign) -> float:
        """See ``ContinuousNeed``: the first length [m] at which no limit is passed, infinite where none up to ``REACH``
        times the longest is. A longer machine may be worse: its iron loses more."""

        def beyond(length: float) -> float:
            return self.excess(self.wound(design, length))

        least = self._asked / (float(self.curve.torque[-1]) * self._share)
        return first_root(beyond, least, max(least, REACH * self.longest))

    def wound(self, design: WindingDesign, length: float) -> WoundMachine:
        """With a winding and an active length [m]."""
        found = self.flux_map
        return WoundMachine(self.machine, found.coils_in_series, found.coil_pitch, design, length)

    def excess(self, wound: WoundMachine) -> float:
        """By how much the nearer limit is passed in the end [K]."""
        load = self.load(wound)
        try:
            temperature = settled(load, load.machine.cold())
        except NoSteadyState:
            return FAR_BEYOND
        return excess(load.machine.hottest_copper(temperature), temperature, self.inputs.limits)

    def load(self, wound: WoundMachine) -> LoadedMachine:
        """The machine under the torque, in what it is built into at its length."""
        inputs, built = self.inputs, self.enclosure.around(wound)
        cooled = CooledMachine(wound, built.weights, built.stacking, built.casing, inputs.cooling, self.speed)
        copper = HotCopper(inputs.conductor, inputs.winding_temperature)
        history = TorqueHistory(np.array([self._asked]), np.array([self.speed]), self._operation(wound))
        friction = built.friction(np.array(self.speed * built.ratio))
        return LoadedMachine(cooled, copper, history, self._field(wound), friction)

    @cached_property
    def curve(self) -> CurrentCurve:
        """Up to the overload of the fullest coil side."""
        found = self.flux_map
        machine = FluxMapMachine.from_per_turn(found.data, turns=1, active_length=1.0, resistance=0.0)
        current = np.linspace(0.0, found.overload_ampere_turns, _CURRENTS)
        d, q = (np.append(0.0, part) for part in mtpa_currents(machine, current[1:]))
        return CurrentCurve(current, d, q, np.asarray(machine.torque(d, q)), self._losses(d, q))

    def _losses(self, direct: np.ndarray, quadrature: np.ndarray) -> FieldHeat:
        """Of one metre [W/m], (n,) each; direct, quadrature: ampere-turns [A], (n,)."""
        nothing = np.zeros(len(direct))
        if self.table is None:
            return FieldHeat(nothing, nothing, nothing, nothing)
        frequency = self.machine.pole_pairs * self.speed / (2 * pi)
        return FieldHeat(*self.table.at(direct, quadrature).at(frequency), nothing)

    @property
    def _asked(self) -> float:
        """Torque with what the mesh may have put on top [Nm]."""
        return self.torque / (1 - self.flux_map.torque_error)

    @property
    def _share(self) -> float:
        """Of the remanence, dimensionless, with the magnets at their limit, as warm as they may be."""
        return self.inputs.magnets.remanence_share(self.inputs.limits.magnets)

    def _operation(self, wound: WoundMachine) -> Operation:
        """The curve with the turns and the length of a machine."""
        curve, pairs = self.curve, self.machine.pole_pairs
        current, torque = curve.current / wound.equivalent_turns, curve.torque * wound.active_length
        return Operation(self.speed, pairs, current, torque, self.inputs.magnets)

    def _field(self, wound: WoundMachine) -> FieldHeat:
        """At the current of the torque with magnets at their limit, the largest that may flow, scalars [W]."""
        curve, length = self.curve, wound.active_length
        at = self._asked / (self._share * length)
        d, q, *parts = (
            float(np.interp(at, curve.torque, one))
            for one in (curve.direct, curve.quadrature, curve.field.stator, curve.field.rotor, curve.field.magnets)
        )
        turns = wound.equivalent_turns
        circulating = wound.circulating_loss(self.flux_map.data, d / turns, q / turns, self.speed)
        stator, rotor, magnets = (np.array(length * part) for part in parts)
        return FieldHeat(stator, rotor, magnets, circulating)


def first_root(beyond: Callable[[float], float], low: float, high: float) -> float:
    """The smallest length [m] between low and high at which a function is zero or less; infinite where it stays above.

    low, high: [m]; beyond: length [m] -> any unit
    """
    length, value = low, beyond(low)
    while value > 0:
        if length >= high:
            return inf
        before, length = length, min(_STEP * length, high)
        value = beyond(length)
        if value <= 0:
            return float(brentq(beyond, before, length, xtol=_FOUND))
    return low
