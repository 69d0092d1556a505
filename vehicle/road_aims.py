"""Comfort, road holding and recovered power as aims of the search over all stages.

A design is seen by the road through its equivalent mass alone: the force that is asked of its motor at the wheel does
not depend on the ratio, as long as current and voltage allow it. The vehicle is therefore driven with some equivalent
masses, and a design follows from what its motor does there: torque and speed scale with its ratio, the copper loss with
the squared torque, the idle loss with powers of the speed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, log, pi

import numpy as np
from scipy.interpolate import CubicSpline

from drivetrain.matching import MatchInputs
from drivetrain.whole_design import Aims, RatedDesign, RoadMachine, WholeProblem
from tasks import Workers
from vehicle.demands import RideCase
from vehicle.designed import DesignedActuator
from vehicle.energy import ride_energy
from vehicle.errors import VehicleError
from vehicle.ride import RideHistory
from vehicle.road_runs import RoadTask, read_of_rides, road_task

_TELLS = 1e-2  # relative: a road of 30 s tells no smaller difference of comfort or road holding
_POWERS = (1.0, 2.0, 1.5)  # of the speed in the losses of hysteresis, eddies and excess
_LIGHTEST, _COUNT = 0.15, 6  # of the largest allowed equivalent mass; how many masses are driven


@dataclass(frozen=True, eq=False)
class RoadResponse:
    """What the road makes of an actuator over its equivalent mass.

    ratio: tau_t that was driven [m/rad]; masses: that were driven, rising [kg], (m,)
    means: of every command with every mass (m, commands, 7): comfort [m/s^2], road holding, power at the rotor [W],
    squared torque [Nm^2], and the magnitude of the rotor's speed to the powers of ``_POWERS`` [rad/s to that power]
    """

    ratio: float
    masses: np.ndarray
    means: np.ndarray

    def indices(self, equivalent_mass: float, ratio: float, machine: RoadMachine) -> tuple[float, float, float]:
        """Comfort [m/s^2], road holding and recovered power [W], each with the command that serves it best.

        equivalent_mass [kg] and ratio [m/rad] of a design with a machine; infinite, infinite and minus infinite beyond
        the masses that were driven
        """
        if not self.masses[0] <= equivalent_mass <= self.masses[-1]:
            return inf, inf, -inf
        comfort, holding, rotor, torque, *speed = self._course(equivalent_mass).T
        scale, idle = ratio / self.ratio, machine.idle
        terms = np.array([idle.hysteresis, idle.eddy, idle.excess])
        per_speed = terms * (machine.pole_pairs / (2 * pi * scale)) ** np.array(_POWERS)
        recovered = rotor - machine.copper * scale**2 * torque - per_speed @ speed
        return float(comfort.min()), float(holding.min()), float(recovered.max())

    @cached_property
    def _course(self) -> CubicSpline:
        """The means over the mass [kg]."""
        return CubicSpline(self.masses, self.means)


@dataclass(frozen=True, eq=False)
class RoadAims(Aims):
    """Mass, comfort, road holding and recovered power; response: of the road."""

    response: RoadResponse

    words = "mass, comfort, road holding and recovered power on the first random road"

    def costs(self, problem: WholeProblem, rated: RatedDesign) -> tuple[float, ...]:
        """As ``road_costs`` [kg, 1, 1, W], (4,)."""
        mass, equivalent_mass, *_ = rated.values.objectives
        machine, ratio = problem.machine_of(rated.design), rated.design.transmission_ratio
        return road_costs(mass, *self.response.indices(equivalent_mass, ratio, machine))


def road_costs(mass: float, comfort: float, road_holding: float, recovered: float) -> tuple[float, ...]:
    """Mass [kg], logarithms of comfort and road holding to a hundredth, power not recovered [W]; less is better, (4,).

    mass [kg]; comfort [m/s^2]; road_holding: dimensionless; recovered [W]
    """
    felt, holding = (round(log(one) / _TELLS) * _TELLS if one < inf else inf for one in (comfort, road_holding))
    return mass, felt, holding, -recovered


def road_aims(response: RoadResponse) -> Aims:
    """The aims of a study that asks for the road."""
    return RoadAims(response)


def road_response_stage(
    case: RideCase, own: DesignedActuator, inputs: MatchInputs, workers: Workers
) -> RoadResponse:
    """The designed actuator with other equivalent masses over the first random road, with every damping of the case.

    inputs: their largest equivalent mass bounds what is driven. Masses with which the force loop is not stable, or the
    ride not possible, are left out. Raises VehicleError where fewer than two remain.
    """
    masses = np.geomspace(_LIGHTEST, 1.0, _COUNT) * inputs.scales.equivalent_mass
    tasks = {f"{mass:.3g} kg": _task(case, own, float(mass)) for mass in masses}
    found = dict(zip(masses, workers.map("equivalent masses on the road", driven_mass, tasks).values(), strict=True))
    kept = {mass: one for mass, one in found.items() if not isinstance(one, str)}
    if len(kept) < 2:
        said = "; ".join(one for one in found.values() if isinstance(one, str))
        raise VehicleError(f"fewer than two equivalent masses can be driven over the road: {said}")
    return RoadResponse(own.actuator.ratio.nominal, np.array(list(kept)), np.array(list(kept.values())))


def _task(case: RideCase, own: DesignedActuator, mass: float) -> RoadTask:
    return road_task(case, replace(own.actuator, equivalent_mass=mass), own.loop)


def driven_mass(task: RoadTask) -> tuple[list[float], ...] | str:
    """Means of every command with one mass as in ``RoadResponse`` [SI], (commands, 7), or why it cannot be driven."""
    return read_of_rides(task, _means)


def _means(history: RideHistory) -> list[float]:
    energy, inside = ride_energy(history), history.inside
    speeds = [float(np.mean(np.abs(inside.rotor_speed) ** k)) for k in _POWERS]
    squared = float(np.mean(inside.torque**2))
    return [energy.comfort, energy.road_holding, energy.machine.active, squared, *speeds]
