"""What the field of the matched machine does to rotor and stator over half an electrical period: torque, radial stress
around the gap, and the pull on a rotor that does not stand in the middle.

Without current, at the nominal and at the overload current density, the current on the q axis; on the mesh of the
sweep. The cogging is solved once more on triangles of half the size.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import lcm, pi

import numpy as np
import xarray as xr

from geometry.cross_section import mesh_cross_section
from geometry.defects import StaticEccentricity, deformed
from geometry.family import MatchedMachine
from geometry.parts import DrawnMachine
from magnetostatics.arc import Arc, angles_from_null, arcs, solved_over
from magnetostatics.case import FieldCase
from magnetostatics.gap_stress import StressWave, radial_stress_orders, stress_over_angle, stress_waves, torque_orders
from magnetostatics.mesh_error import refined_model
from magnetostatics.model import FieldModel
from magnetostatics.rotation_stage import STATES
from magnetostatics.torque import arkkio_torque, magnetic_pull
from tasks import Workers

PULL_STATES = ("no_current", "overload")
STEPS = 48  # over half an electrical period: eight in a period of the cogging of 12 slots and 10 poles
_COGGING_STEPS = 12  # over one period of the cogging
_ORDERS_PER_SLOT = 4  # spatial orders up to so many times the slots
_PULL_STEPS = 6  # over half an electrical period; the pull varies with even multiples of the electrical frequency
_SHIFT = 0.1  # of the air gap; up to there the pull grows in proportion


@dataclass(frozen=True, eq=False)
class GapStress:
    """Torque and radial stress of the machine over half an electrical period, its end left out.

    data: ``torque`` (state, angle) [Nm/m], ring average; ``stress`` (state, angle, part, order) [Pa], the real and the
        imaginary part of the spatial coefficients of ``radial_stress_orders``; ``angle`` [rad]
    cogging_torque: without current over one period of the cogging [Nm/m], (2, n): on the mesh of the sweep, and on
        triangles of half the size
    shift: of the rotor against the stator at which the pull was solved [m]
    pull_per_shift: mean pull towards the narrowest gap [N/m^2], per metre of the machine, of each of ``PULL_STATES``
        (2,)
    centred_pull: largest pull on a rotor in the middle, of the same states and angles [N/m], (2,)
    """

    machine: DrawnMachine
    data: xr.Dataset
    cogging_torque: np.ndarray
    shift: float
    pull_per_shift: np.ndarray
    centred_pull: np.ndarray

    @property
    def span(self) -> float:
        """Half an electrical period [rad]."""
        return self.machine.pole_pitch

    def torque(self, state: str) -> np.ndarray:
        """Over the angles [Nm/m], (n,), in one of ``STATES``."""
        return self.data.torque.sel(state=state).values

    def mean_torque_per_length(self, state: str) -> float:
        """[Nm/m] in one of ``STATES``."""
        return float(self.torque(state).mean())

    def ripple(self, state: str) -> float:
        """Torque from peak to peak [Nm/m] in one of ``STATES``."""
        return float(np.ptp(self.torque(state)))

    def ripple_orders(self, state: str) -> dict[int, float]:
        """Orders of the torque and their amplitude as a share of the mean, the largest first."""
        return torque_orders(self.torque(state), self.span, self.machine.pole_pairs)

    @property
    def cogging_span(self) -> float:
        """One period of the cogging [rad]."""
        return 2 * pi / lcm(self.machine.slots, self.machine.poles)

    @property
    def cogging(self) -> float:
        """Torque without current from peak to peak on the finer mesh [Nm/m]."""
        return float(np.ptp(self.cogging_torque[1]))

    @property
    def cogging_error(self) -> float:
        """What halving the triangles changes in the cogging from peak to peak [Nm/m]."""
        return abs(self.cogging - float(np.ptp(self.cogging_torque[0])))

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


@dataclass(frozen=True, eq=False)
class SolvedStressArc:
    """torque_per_length [Nm/m], (state, angle), and stress [Pa], complex (state, angle, order), of an arc."""

    torque_per_length: np.ndarray
    stress: np.ndarray


@dataclass(frozen=True)
class PullTask:
    """A machine at some rotor angles [rad] in one of ``PULL_STATES``; shift: of its stator [m]."""

    case: FieldCase
    machine: DrawnMachine
    angles: tuple[float, ...]
    density: float  # amplitude of the current density in the copper [A/m^2]
    shift: float


def gap_stress_stage(case: FieldCase, matched: MatchedMachine, workers: Workers) -> GapStress:
    """Solve the machine over half an electrical period, and its pull off centre. Raises FieldSolutionError."""
    machine = matched.machine
    angles = angles_from_null(case, machine, machine.pole_pitch, STEPS)
    cogging = angles_from_null(case, machine, 2 * pi / lcm(machine.slots, machine.poles), _COGGING_STEPS)
    shift = _SHIFT * machine.airgap
    solved = workers.map("gap stress", solve_stress_arc, arcs(case, machine, angles))
    both = workers.map("cogging", solve_cogging, {"one period": Arc(case, machine, tuple(cogging))})
    pulls = workers.map("pull", solve_pull, _pull_tasks(case, machine, shift))
    centred, shifted = np.stack(list(pulls.values())).reshape(2, len(PULL_STATES), _PULL_STEPS, 2)
    return GapStress(
        machine=machine,
        data=_dataset(angles, list(solved.values())),
        cogging_torque=both["one period"],
        shift=shift,
        pull_per_shift=-(shifted - centred)[..., 0].mean(axis=1) / shift,
        centred_pull=np.hypot(*np.moveaxis(centred, -1, 0)).max(axis=1),
    )


def _pull_tasks(case: FieldCase, machine: DrawnMachine, shift: float) -> dict[str, PullTask]:
    """In the middle, then off centre, each in ``PULL_STATES``."""
    angles = tuple(angles_from_null(case, machine, machine.pole_pitch, _PULL_STEPS))
    densities = dict(zip(PULL_STATES, (0.0, case.overload_density)))
    return {
        f"{state}, {'off centre' if amount else 'in the middle'}": PullTask(case, machine, angles, density, amount)
        for amount in (0.0, shift)
        for state, density in densities.items()
    }


def solve_stress_arc(arc: Arc) -> SolvedStressArc:
    """Torque and stress at the angles of an arc, in every one of ``STATES``."""
    model, case = arc.model(), arc.case
    amplitudes = (0.0, case.nominal_density, case.overload_density)
    solved = [solved_over(model, arc.angles, amplitude, case.packing) for amplitude in amplitudes]
    highest = _ORDERS_PER_SLOT * arc.machine.slots
    return SolvedStressArc(
        np.array([[arkkio_torque(one) for one in some] for some in solved]),
        np.array([[radial_stress_orders(one, highest) for one in some] for some in solved]),
    )


def solve_cogging(arc: Arc) -> np.ndarray:
    """Torque without current [Nm/m], (2, n): on the mesh of the sweep, and on triangles of half the size."""
    model = arc.model()
    both = (solved_over(one, arc.angles, 0.0, arc.case.packing) for one in (model, refined_model(model)))
    return np.array([[arkkio_torque(solution) for solution in some] for some in both])


def solve_pull(task: PullTask) -> np.ndarray:
    """Pull on the rotor [N/m], (angles, 2); the stator has gone along the x axis."""
    case, machine = task.case, task.machine
    whole = mesh_cross_section(machine, case.layout(machine), case.density, whole=True)
    section = deformed(whole, StaticEccentricity(task.shift)) if task.shift else whole
    solved = solved_over(FieldModel(section, case.materials), task.angles, task.density, case.packing)
    return np.array([magnetic_pull(solution) for solution in solved])


def _dataset(angles: list[float], arcs: list[SolvedStressArc]) -> xr.Dataset:
    stress = np.concatenate([arc.stress for arc in arcs], axis=1)
    parts = np.stack([stress.real, stress.imag], axis=2)
    return xr.Dataset(
        {
            "torque": (("state", "angle"), np.concatenate([arc.torque_per_length for arc in arcs], axis=1)),
            "stress": (("state", "angle", "part", "order"), parts),
        },
        {"state": list(STATES), "angle": angles, "part": ["real", "imaginary"]},
    )
