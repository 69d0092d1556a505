"""Electrical losses over torque and speed (what thesis Fig. 4.5 shows): copper, iron and magnets, and the efficiency.

The field is solved on a grid of currents, once; every speed follows by the frequency terms, every winding by its turns.
Signs as in ``electrical``: motor, peak phase values. The torque is that of the air gap; iron and magnet losses count as
electrical (a resistance across the machine), bearings and windage are left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from math import atan2, hypot, pi

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from electrical.dq import OperatingMap, Values
from electrical.wound_machine import WoundMachine
from geometry.cross_section import CrossSection
from geometry.parts import Rotor
from labelled import xr
from losses.copper import copper_loss
from losses.iron import FrequencyTerms, iron_loss
from losses.loci import Repetition, rotor_loci, solve_part, stator_loci
from losses.magnet import NDFEB_RESISTIVITY, magnet_loss
from magnetostatics.model import FieldModel, OperatingPoint
from materials.iron_loss import IronLossLaw

STEPS = 48  # per electrical period
# Grid of the currents as shares of the largest. The direct axis reaches into the strengthening side because the least
# currents of a machine with L_d > L_q lie there.
DIRECT = (-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75)
MAGNETISING = (0.0, 0.25, 0.5, 0.75, 1.0)  # of a machine without magnets, which runs on no other
QUADRATURE = (0.0, 0.25, 0.5, 0.75, 1.0)


@dataclass(frozen=True)
class FieldLosses:
    """Losses in iron and magnets at one current, whole machine per metre."""

    stator: FrequencyTerms
    rotor: FrequencyTerms
    magnet: FrequencyTerms

    def at(self, frequency: Values) -> tuple[Values, Values, Values]:
        """(stator, rotor, magnet) [W/m] at an electrical frequency [Hz]."""
        return self.stator.at(frequency), self.rotor.at(frequency), self.magnet.at(frequency)


def current_point(
    section: CrossSection, direct: float, quadrature: float, packing: float, angle: float = 0.0
) -> OperatingPoint:
    """Operating point of ampere-turns; direct, quadrature: on the axes [A peak per coil]; packing: share of copper."""
    area = section.half_slot_area * section.half_slots_per_coil_side
    return OperatingPoint(angle, hypot(direct, quadrature) / (packing * area), atan2(-direct, quadrature), packing)


def field_losses(
    model: FieldModel,
    point: OperatingPoint,
    law: IronLossLaw,
    *,
    steps: int = STEPS,
    repetition: Repetition | None = None,
    resistivity: float = NDFEB_RESISTIVITY,
    segments: int = 1,
) -> FieldLosses:
    """Iron and magnet losses at one current; stator and rotor of the same sheet.

    steps, repetition: see ``solve_part``; resistivity, segments: see ``magnet_loss``
    """
    part = solve_part(model, point, steps, repetition)
    magnet = magnet_loss(part, resistivity, segments)
    return FieldLosses(
        stator=iron_loss(stator_loci(part), law).total,
        rotor=iron_loss(rotor_loci(part), law).total,
        magnet=FrequencyTerms(0.0, magnet.eddy, 0.0),
    )


@dataclass(frozen=True, eq=False)
class FieldLossTable:
    """Losses over the ampere-turns of a coil.

    direct (D,), quadrature (Q,): peak ampere-turns on the axes [A], quadrature from 0 up
    terms (D, Q, 3, 3) [W s^n/m]: of stator, rotor, magnet; hysteresis, eddy, excess
    """

    direct: np.ndarray
    quadrature: np.ndarray
    terms: np.ndarray

    def at(self, direct: Values, quadrature: Values) -> FieldLosses:
        """Cubic splines through the grid; arrays that broadcast, NaN in, NaN out; the sign of the q axis is dropped.

        Within 2.5 % of a solution of its own in stator and magnets on the reference machine (12 points at random; a
        linear interpolation is off by 13 and 80 %), 19 % in the rotor, whose loss is a thousandth of the stator's.
        Raises ValueError outside the grid.
        """
        points = np.stack(np.broadcast_arrays(np.asarray(direct, dtype=float), np.abs(quadrature)), axis=-1)
        known = np.isfinite(points).all(-1)
        self._check(points[known])
        values = np.full((*points.shape[:-1], 3, 3), np.nan)
        axes = (self.direct, self.quadrature)
        table = RegularGridInterpolator(axes, self.terms, method="cubic", bounds_error=False, fill_value=None)
        values[known] = table(points[known])
        return FieldLosses(*(FrequencyTerms(*(values[..., part, k] for k in range(3))) for part in range(3)))

    def _check(self, points: np.ndarray) -> None:
        for name, axis, column in (("d", self.direct, 0), ("q", self.quadrature, 1)):
            slack = 1e-6 * (axis[-1] - axis[0])
            low, high = points[:, column].min(initial=axis[0]), points[:, column].max(initial=axis[0])
            if low < axis[0] - slack or high > axis[-1] + slack:
                raise ValueError(
                    f"{name}-axis ampere-turns from {low:.4g} to {high:.4g} A leave the table ({axis[0]:.4g} to "
                    f"{axis[-1]:.4g} A): build it for a larger current"
                )


@dataclass(frozen=True)
class LossGrid:
    """Currents of a table. direct, quadrature: peak ampere-turns of a coil on the axes [A], rising"""

    direct: tuple[float, ...]
    quadrature: tuple[float, ...]

    @classmethod
    def of(cls, rotor: Rotor, largest: float) -> LossGrid:
        """Up to a largest peak [A] of a coil of a machine with this rotor."""
        shares = DIRECT if rotor.magnets_per_pitch else MAGNETISING
        return cls(tuple(d * largest for d in shares), tuple(q * largest for q in QUADRATURE))

    @property
    def points(self) -> list[tuple[float, float]]:
        """(d, q) [A], d outermost."""
        return list(product(self.direct, self.quadrature))

    def table(self, losses: list[FieldLosses]) -> FieldLossTable:
        """The table of the losses at ``points``, in that order."""
        terms = [[[t.hysteresis, t.eddy, t.excess] for t in (one.stator, one.rotor, one.magnet)] for one in losses]
        shaped = np.array(terms).reshape(len(self.direct), len(self.quadrature), 3, 3)
        return FieldLossTable(np.array(self.direct), np.array(self.quadrature), shaped)


@dataclass(frozen=True, eq=False)
class PowerLosses:
    """Losses over torque and speed, all of one shape, a point or a plane; NaN where out of reach.

    torque [Nm], speed [rad/s, mechanical], copper, stator_iron, rotor_iron, magnet: [W], of any shape
    circulating: in the copper, by the current round a delta, none in a star [W], of the shape of the torque
    """

    torque: Values
    speed: Values
    copper: Values
    stator_iron: Values
    rotor_iron: Values
    magnet: Values
    circulating: Values

    @property
    def total(self) -> Values:
        """All electrical losses [W], of the shape of the torque."""
        return self.copper + self.circulating + self.stator_iron + self.rotor_iron + self.magnet

    @property
    def mechanical(self) -> Values:
        """T omega [W], of the shape of the torque."""
        return self.torque * self.speed

    @property
    def electrical(self) -> Values:
        """T omega and the losses [W], of the shape of the torque."""
        return self.mechanical + self.total

    @property
    def efficiency(self) -> Values:
        """Power out over power in, shape of the torque, as motor and as generator; NaN where nothing comes out."""
        mechanical, electrical = self.mechanical, self.electrical
        with np.errstate(divide="ignore", invalid="ignore"):
            motor, generator = mechanical / electrical, electrical / mechanical
        return np.where(mechanical > 0, motor, np.where(electrical < 0, generator, np.nan))

    def at(self, torque: float, speed: float) -> PowerLosses:
        """At one torque [Nm] and mechanical speed [rad/s], linear between the points of a map; NaN beyond it.

        The copper loss goes with the square of the torque: between the 161 torques of a map it is off by (1/160)^2/4
        of its largest value.
        """
        axes, at = (self.torque[:, 0], self.speed[0]), [(torque, speed)]
        tables = (self.copper, self.stator_iron, self.rotor_iron, self.magnet, self.circulating)
        read = (RegularGridInterpolator(axes, table, bounds_error=False)(at)[0] for table in tables)
        return PowerLosses(np.float64(torque), np.float64(speed), *read)


def power_losses(
    operating: OperatingMap, wound: WoundMachine, table: FieldLossTable, per_turn: xr.Dataset
) -> PowerLosses:
    """Losses at the currents of an operating map, field weakening included.

    operating: torque, speed and peak phase currents i_d, i_q, for example of ``electrical`` ``operating_map``
    wound: its copper has the resistivity of its temperature; per_turn: flux map of its cross-section (``FluxMap.data``)
    The magnets keep the temperature that the table was solved at.
    """
    frequency = wound.machine.pole_pairs * operating.speed / (2 * pi)
    fields = table.at(*wound.ampere_turns(operating.i_d, operating.i_q))
    stator, rotor, magnet = (wound.active_length * loss for loss in fields.at(frequency))
    copper = copper_loss(wound.phase_resistance, operating.i_d, operating.i_q)
    circulating = wound.circulating_loss(per_turn, operating.i_d, operating.i_q, operating.speed)
    return PowerLosses(operating.torque, operating.speed, copper, stator, rotor, magnet, circulating)
