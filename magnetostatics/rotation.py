"""A machine over half an electrical period: torque by both routes, radial stress around the gap, and every probe.

Without current, at the nominal and at the overload current density, the current on the q axis; on the mesh of the
sweep. Half a period later magnets and currents have changed their signs and nothing else, so that all of it repeats.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import lcm, pi

import numpy as np

from geometry.parts import DrawnMachine
from labelled import xr
from magnetostatics.arc import Arc, angles_from_null, arcs, solved_over
from magnetostatics.case import FieldCase
from magnetostatics.gap_stress import StressWave, radial_stress_orders, stress_over_angle, stress_waves, torque_orders
from magnetostatics.model import FieldSolution
from magnetostatics.positions import q_axis_angle
from magnetostatics.probes import probe_reader
from magnetostatics.torque import arkkio_torque, maxwell_torque
from tasks import Workers

STATES = ("no_current", "nominal", "overload")
COGGING_STEPS = 12  # over one period of the cogging, of which half an electrical period holds a whole number
_ORDERS_PER_SLOT = 4  # spatial orders of the stress up to so many times the slots


@dataclass(frozen=True, eq=False)
class Rotation:
    """One machine over half an electrical period from the null position on, its end left out.

    q_axis_angle: rotor angle of the q-axis current's peak in phase A [rad]
    data: over ``state`` and ``angle`` [rad]: ``torque`` (``arkkio_torque``), ``torque_circle`` (``maxwell_torque``)
        [Nm/m]; ``stress`` (.., part, order) [Pa], the real and the imaginary part of the spatial coefficients of
        ``radial_stress_orders``; ``flux_density`` (.., probe) [T]
    """

    machine: DrawnMachine
    q_axis_angle: float
    data: xr.Dataset

    @property
    def null_angle(self) -> float:
        """Rotor angle of a magnet on a tooth, the first of the angles [rad]."""
        return float(self.data.angle[0])

    @property
    def span(self) -> float:
        """Half an electrical period [rad]."""
        return self.machine.pole_pitch

    @property
    def cogging_span(self) -> float:
        """One period of the cogging [rad]."""
        return 2 * pi / lcm(self.machine.slots, self.machine.poles)

    @property
    def cogging_angles(self) -> np.ndarray:
        """The first of the angles, over one period of the cogging [rad], (n,)."""
        return self.data.angle.values[: round(self.data.sizes["angle"] * self.cogging_span / self.span)]

    @property
    def one_period(self) -> xr.Dataset:
        """The data over a whole electrical period, the last angle a period after the first."""
        thrice = [self.data.assign_coords(angle=self.data.angle + k * self.span) for k in range(3)]
        return xr.concat([*thrice[:2], thrice[2].isel(angle=[0])], "angle")

    def torque(self, state: str) -> np.ndarray:
        """Ring average over the angles [Nm/m], (n,), in one of ``STATES``."""
        return self.data.torque.sel(state=state).values

    def mean_torque_per_length(self, state: str) -> float:
        """[Nm/m] in one of ``STATES``."""
        return float(self.torque(state).mean())

    def ripple(self, state: str) -> float:
        """Torque from peak to peak [Nm/m] in one of ``STATES``; without current the cogging."""
        return float(np.ptp(self.torque(state)))

    def ripple_orders(self, state: str) -> dict[int, float]:
        """Orders of the torque and their amplitude as a share of the mean, the largest first."""
        return torque_orders(self.torque(state), self.span, self.machine.pole_pairs)

    def routes_apart(self, state: str) -> float:
        """Largest relative difference of the two torque routes in one of ``STATES``."""
        return float(np.abs(self.data.torque_circle.sel(state=state).values / self.torque(state) - 1).max())

    def stress_orders(self, state: str) -> np.ndarray:
        """Spatial coefficients over the angles [Pa], complex (angles, orders), in one of ``STATES``."""
        parts = self.data.stress.sel(state=state)
        return parts.sel(part="real").values + 1j * parts.sel(part="imaginary").values

    def waves(self, state: str) -> tuple[StressWave, ...]:
        """Waves of the radial stress, the largest first, in one of ``STATES``."""
        return stress_waves(self.stress_orders(state))

    def stress_map(self, state: str, places: np.ndarray) -> np.ndarray:
        """Radial stress [Pa], (angles, m), at places around the gap [rad], (m,), in one of ``STATES``."""
        return stress_over_angle(self.stress_orders(state), places)

    @property
    def mean_stress(self) -> float:
        """Of the radial stress without current [Pa]."""
        return float(self.stress_orders("no_current")[:, 0].real.mean())


def solve_rotation(name: str, case: FieldCase, machine: DrawnMachine, workers: Workers) -> Rotation:
    """Solve a machine over half an electrical period; name: of the tasks. Raises FieldSolutionError."""
    cogging_periods = lcm(machine.slots, machine.poles) // machine.poles
    angles = angles_from_null(case, machine, machine.pole_pitch, COGGING_STEPS * cogging_periods)
    solved = workers.map(name, solve_arc, arcs(case, machine, angles))
    data = xr.concat([_dataset(one) for one in solved.values()], "angle")
    return Rotation(machine, q_axis_angle(machine, case.layout(machine)), data)


@dataclass(frozen=True, eq=False)
class SolvedArc:
    """The data of ``Rotation`` at the angles of an arc, which become a table where the tables are.

    angles: [rad]; ring_average, circle_integral: of the stress, the torque [Nm/m], (states, angles)
    stress: [Pa], (states, angles, 2, orders); flux_density: [T], (states, angles, probes); probes: their names
    """

    angles: tuple[float, ...]
    ring_average: np.ndarray
    circle_integral: np.ndarray
    stress: np.ndarray
    flux_density: np.ndarray
    probes: tuple[str, ...]


def solve_arc(arc: Arc) -> SolvedArc:
    """What ``Rotation`` holds of the angles of an arc."""
    model, case = arc.model(), arc.case
    states: list[list[FieldSolution]] = []
    for density in (0.0, case.nominal_density, case.overload_density):
        start = states[-1][0] if states else None
        states.append(solved_over(model, arc.angles, density, case.packing, start))
    reader, highest = probe_reader(model), _ORDERS_PER_SLOT * arc.machine.slots
    stress = np.array([[radial_stress_orders(one, highest) for one in solved] for solved in states])
    return SolvedArc(
        angles=arc.angles,
        ring_average=np.array([[arkkio_torque(one) for one in solved] for solved in states]),
        circle_integral=np.array([[maxwell_torque(one) for one in solved] for solved in states]),
        stress=np.stack([stress.real, stress.imag], axis=2),
        flux_density=np.array([[list(reader.read(one).values()) for one in solved] for solved in states]),
        probes=tuple(reader.names),
    )


def _dataset(arc: SolvedArc) -> xr.Dataset:
    data = {
        "torque": (("state", "angle"), arc.ring_average),
        "torque_circle": (("state", "angle"), arc.circle_integral),
        "stress": (("state", "angle", "part", "order"), arc.stress),
        "flux_density": (("state", "angle", "probe"), arc.flux_density),
    }
    names = {"state": list(STATES), "part": ["real", "imaginary"], "probe": list(arc.probes)}
    return xr.Dataset(data, {"angle": list(arc.angles), **names})
