"""The machine at work as a source of heat: its torque and losses over the current, warm magnets and warm copper in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from electrical.dq import DriveLimits, torque_speed_envelope
from electrical.flux_map_machine import FluxMapMachine
from losses.copper import copper_loss, proximity_ratio
from materials.conductor import Conductor
from materials.magnet import Magnet
from thermal.field_loss import FieldHeat, FieldLoss
from thermal.machine import CASING, COPPER_HEAT, ENDS, MAGNETS, ROTOR, SLOT, TEETH, YOKE, CooledMachine, yoke_share
from thermal.network import Heat, Network, Temperatures

_CURRENTS = 81  # of the curve of torque over current; linear between them to 0.02 % of the largest torque


@dataclass(frozen=True)
class HotCopper:
    """Resistivity over that of the wound machine; conductor: its law; reference: temperature of the wound machine
    [degC]."""

    conductor: Conductor
    reference: float

    def factor(self, temperature: float) -> float:
        """Resistance over that of the wound machine at a temperature [degC], dimensionless."""
        return float(self.conductor.resistivity(temperature) / self.conductor.resistivity(self.reference))


@dataclass(frozen=True, eq=False)
class Operation:
    """The machine over its current at one speed, with the current of least heat or, where voltage lacks, the most
    torque.

    speed: of the rotor [rad/s]; current: peak, rising from 0 [A], (n,)
    cold_torque: with the magnets as they are mapped [Nm], (n,); magnets: as they are mapped
    """

    speed: float
    pole_pairs: int
    current: np.ndarray
    cold_torque: np.ndarray
    magnets: Magnet

    def torque(self, magnet_temperature: float) -> np.ndarray:
        """Over the currents [Nm], (n,), with magnets at a temperature [degC].

        In proportion to the remanence. The iron of the reference machine, less saturated, gives some of it back: a
        field with 11 % less remanence, 100 K, loses 10.3 % of the torque at 1 A/mm², 9.6 % at 6 and 9.5 % at 20, so
        that this is on the safe side by some 2 %.
        """
        return self.cold_torque * self.magnets.remanence_share(magnet_temperature)

    def torque_of(self, current: float, magnet_temperature: float) -> float:
        """Of a peak current [A] with magnets at a temperature [degC], [Nm]."""
        return float(np.interp(current, self.current, self.torque(magnet_temperature)))

    def current_of(self, torque: np.ndarray, magnet_temperature: float) -> np.ndarray:
        """Peak current [A] of a torque [Nm], any shape, with magnets at a temperature [degC]; the largest beyond it."""
        return np.interp(np.abs(torque), self.torque(magnet_temperature), self.current)


def operation(machine: FluxMapMachine, limits: DriveLimits, speed: float, magnets: Magnet) -> Operation:
    """Of a machine with its hot resistance at a rotor speed [rad/s]; no torque where the voltage does not allow it."""
    current = np.linspace(0.0, float(limits.current_peak), _CURRENTS)
    family = machine.with_resistance(np.full(_CURRENTS - 1, machine.resistance))
    envelope = torque_speed_envelope(family, DriveLimits(current[1:], np.full(_CURRENTS - 1, limits.voltage_peak)),
                                     np.full(_CURRENTS - 1, speed))  # fmt: skip
    torque = np.append(0.0, np.nan_to_num(envelope.torque, nan=0.0))
    return Operation(speed, machine.pole_pairs, current, np.maximum.accumulate(torque), magnets)


class Loading(Protocol):
    """What current flows: mean squares over time, which is all that counts for slow temperatures."""

    def squares(self, magnet_temperature: float) -> tuple[float, float]:
        """squares: mean i^2 [A^2 peak] and mean (w i)^2 [A^2 rad^2/s^2], with magnets at a temperature [degC]."""


@dataclass(frozen=True)
class SteadyCurrent:
    """One peak current [A]; electrical_speed: p times that of the rotor [rad/s]."""

    current: float
    electrical_speed: float

    def squares(self, magnet_temperature: float) -> tuple[float, float]:
        """squares [A^2, A^2 rad^2/s^2] as in ``Loading``; magnet_temperature [degC] does not matter."""
        return self.current**2, (self.electrical_speed * self.current) ** 2


@dataclass(frozen=True, eq=False)
class TorqueHistory:
    """torque: of the rotor [Nm], (n,); speed [rad/s], (n,); each for the same time. Field weakening is left out."""

    torque: np.ndarray
    speed: np.ndarray
    operation: Operation

    def current(self, magnet_temperature: float) -> np.ndarray:
        """Peak current over time [A], (n,), with magnets at a temperature [degC]."""
        return self.operation.current_of(self.torque, magnet_temperature)

    def squares(self, magnet_temperature: float) -> tuple[float, float]:
        """squares [A^2, A^2 rad^2/s^2] as in ``Loading``; magnet_temperature [degC]."""
        current = self.current(magnet_temperature)
        electrical = self.operation.pole_pairs * self.speed
        return float(np.mean(current**2)), float(np.mean((electrical * current) ** 2))


@dataclass(frozen=True, eq=False)
class LoadedMachine:
    """A cooled machine with what flows in it, a ``Body``.

    field: losses by the turning field, scalars; friction: of gears and bearings, into the casing [W]
    """

    machine: CooledMachine
    copper: HotCopper
    loading: Loading
    field: FieldHeat
    friction: float

    def network(self, temperature: Temperatures) -> Network:
        """See ``Body``; temperature [degC]."""
        return self.machine.network(temperature)

    def heat(self, temperature: Temperatures) -> Heat:
        """Of every part [W]; temperature [degC]. The wires in the slot and in the end windings have resistances of
        their own; iron loss counts in proportion to the mass of teeth and yoke, and what circulates in a delta as at
        the temperature of the loss map."""
        wound = self.machine.wound
        ends, yoke = wound.end_turn_share, yoke_share(wound.dimensions)
        square, fast = self.loading.squares(temperature[MAGNETS])
        slot, outside = (self.copper.factor(temperature[name]) for name in (SLOT, ENDS))
        direct = copper_loss(wound.phase_resistance, 0.0, square**0.5)
        stirred = proximity_ratio(wound) * copper_loss(wound.phase_resistance, 0.0, fast**0.5)
        return {
            SLOT: (1 - ends) * (direct * slot + stirred / slot + float(self.field.copper)),
            ENDS: ends * (direct * outside + float(self.field.copper)),
            TEETH: (1 - yoke) * float(self.field.stator),
            YOKE: yoke * float(self.field.stator),
            ROTOR: float(self.field.rotor),
            MAGNETS: float(self.field.magnets),
            CASING: self.friction,
        }


def steady_load(
    machine: CooledMachine, copper: HotCopper, operation: Operation, field: FieldLoss, friction: float, current: float
) -> LoadedMachine:
    """The machine at one peak current [A]; friction: [W]. Iron loss at the torque with cold magnets."""
    torque = operation.torque_of(current, operation.magnets.reference_temperature)
    found = field.at(np.array(torque), np.array(operation.speed))
    loading = SteadyCurrent(current, operation.pole_pairs * operation.speed)
    return LoadedMachine(machine, copper, loading, found, friction)


def copper_ripple(
    machine: CooledMachine, copper: HotCopper, history: TorqueHistory, step: float, temperature: Temperatures
) -> float:
    """Of the copper under a history of torques, from its coldest to its warmest, if all of its heat stayed [K].

    step: of time [s]; temperature: means of the parts [degC]
    What the mean of the losses hides, at most: some of the heat leaves while it arises.
    """
    resistance = machine.wound.phase_resistance * copper.factor(temperature[SLOT])
    loss = copper_loss(resistance, 0.0, history.current(temperature[MAGNETS]))
    energy = np.cumsum(loss - np.mean(loss)) * step
    return float(np.ptp(energy) / (machine.weights.copper * COPPER_HEAT))
