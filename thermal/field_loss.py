"""Heat by the turning field at a torque and a speed, where the steel has loss data, and where it has none."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from losses.map import PowerLosses


@dataclass(frozen=True, eq=False)
class FieldHeat:
    """stator: its iron [W], any shape; rotor: its iron [W], that shape; magnets [W], that shape; copper: by the current
    round a delta [W], that shape."""

    stator: np.ndarray
    rotor: np.ndarray
    magnets: np.ndarray
    copper: np.ndarray

    @property
    def mean(self) -> FieldHeat:
        """Over all points, scalars."""
        return FieldHeat(*(np.mean(one) for one in (self.stator, self.rotor, self.magnets, self.copper)))


class FieldLoss:
    """The loss that the turning field makes; the concrete ones are below."""

    known: bool

    def at(self, torque: np.ndarray, speed: np.ndarray) -> FieldHeat:
        """torque [Nm], speed of the rotor [rad/s]: any signs, arrays of shapes that broadcast."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class MappedLoss(FieldLoss):
    """Linear between the points of a loss map; plane: torque along the first index, speed from 0 along the second.

    Beyond the largest torque of a speed its last value counts, beyond the largest speed that of the largest: the
    machine does not get there. Half the map, motoring: braking differs by the voltage limit alone. Magnets as warm as
    the map was solved for, which is colder, so that iron loss is on the safe side.
    """

    plane: PowerLosses
    known = True

    def at(self, torque: np.ndarray, speed: np.ndarray) -> FieldHeat:
        """See ``FieldLoss``: torque [Nm], speed [rad/s], arrays of shapes that broadcast."""
        torques, speeds = self.plane.torque[:, 0], self.plane.speed[0]
        motoring = torques >= 0
        points = np.stack(np.broadcast_arrays(np.abs(torque), np.abs(speed)), axis=-1)
        points = np.minimum(points, [torques[-1], speeds[-1]])
        tables = (self.plane.stator_iron, self.plane.rotor_iron, self.plane.magnet, self.plane.circulating)
        axes = (torques[motoring], speeds)
        found = (RegularGridInterpolator(axes, _continued(one[motoring]))(points) for one in tables)
        return FieldHeat(*(one.reshape(points.shape[:-1]) for one in found))


@dataclass(frozen=True)
class NoLossData(FieldLoss):
    """The steel has no loss data: copper and friction are all the heat that is counted."""

    known = False

    def at(self, torque: np.ndarray, speed: np.ndarray) -> FieldHeat:
        """Nothing; torque [Nm] and speed [rad/s], arrays that broadcast."""
        nothing = np.zeros(np.broadcast_shapes(np.shape(torque), np.shape(speed)))
        return FieldHeat(nothing, nothing, nothing, nothing)


def _continued(table: np.ndarray) -> np.ndarray:
    """A table with the last value of each column that is one in the place of NaN below it."""
    rows = np.where(np.isfinite(table), np.arange(len(table))[:, None], 0)
    return np.take_along_axis(table, np.maximum.accumulate(rows, axis=0), axis=0)
