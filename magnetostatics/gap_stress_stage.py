"""What the field of the matched machine does to rotor and stator: torque and radial stress around the gap as it turns,
and the pull on a rotor that does not stand in the middle.

The cogging is solved once more on triangles of half the size.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry.cross_section import mesh_cross_section
from geometry.defects import StaticEccentricity, deformed
from geometry.family import MatchedMachine
from geometry.parts import DrawnMachine
from magnetostatics.arc import Arc, angles_from_null, solved_over
from magnetostatics.case import FieldCase
from magnetostatics.mesh_error import refined_model
from magnetostatics.model import FieldModel
from magnetostatics.rotation import Rotation, solve_rotation
from magnetostatics.torque import arkkio_torque, magnetic_pull
from tasks import Workers

PULL_STATES = ("no_current", "overload")
_PULL_STEPS = 6  # over half an electrical period; the pull varies with even multiples of the electrical frequency
_SHIFT = 0.1  # of the air gap; up to there the pull grows in proportion


@dataclass(frozen=True, eq=False)
class GapStress:
    """Torque and radial stress of the matched machine, and the magnetic pull.

    cogging_torque: without current on triangles of half the size [Nm/m], (n,), at the rotation's
        ``cogging_angles``
    shift: of the rotor against the stator at which the pull was solved [m]
    pull_per_shift: mean pull towards the narrowest gap [N/m^2], per metre of the machine, of each of ``PULL_STATES``
        (2,)
    centred_pull: largest pull on a rotor in the middle, of the same states and angles [N/m], (2,)
    """

    rotation: Rotation
    cogging_torque: np.ndarray
    shift: float
    pull_per_shift: np.ndarray
    centred_pull: np.ndarray

    @property
    def cogging(self) -> float:
        """Torque without current from peak to peak on the finer mesh [Nm/m]."""
        return float(np.ptp(self.cogging_torque))

    @property
    def cogging_error(self) -> float:
        """What halving the triangles changes in the cogging from peak to peak [Nm/m]."""
        return abs(self.cogging - self.rotation.ripple("no_current"))


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
    rotation, shift = solve_rotation("gap stress", case, machine, workers), _SHIFT * machine.airgap
    period = Arc(case, machine, tuple(rotation.cogging_angles.tolist()))
    finer = workers.map("cogging", solve_finer_cogging, {"one period": period})
    pulls = workers.map("pull", solve_pull, _pull_tasks(case, machine, shift))
    centred, shifted = np.stack(list(pulls.values())).reshape(2, len(PULL_STATES), _PULL_STEPS, 2)
    return GapStress(
        rotation=rotation,
        cogging_torque=finer["one period"],
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


def solve_finer_cogging(arc: Arc) -> np.ndarray:
    """Torque without current on triangles of half the size of those of the sweep [Nm/m], (n,)."""
    solved = solved_over(refined_model(arc.model()), arc.angles, 0.0, arc.case.packing)
    return np.array([arkkio_torque(one) for one in solved])


def solve_pull(task: PullTask) -> np.ndarray:
    """Pull on the rotor [N/m], (angles, 2); the stator has gone along the x axis."""
    case, machine = task.case, task.machine
    whole = mesh_cross_section(machine, case.layout(machine), case.density, whole=True)
    section = deformed(whole, StaticEccentricity(task.shift)) if task.shift else whole
    solved = solved_over(FieldModel(section, case.materials), task.angles, task.density, case.packing)
    return np.array([magnetic_pull(solution) for solution in solved])
