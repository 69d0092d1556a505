"""The mechanical part of an actuator from force-displacement loops: the eight parameters of thesis table 4.2.

The output is driven, the machine is fed a known q-axis current, the force is measured. The model is ``actuator``: the
torque constant only turns the current into torque (thesis section 4.3.1), so it is one of the unknowns.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from actuator.imposed import imposed_motion
from actuator.model import Actuator
from actuator.parts import CompliantMount, MechanicalLoss, fixed_ratio
from bench.errors import RecordError
from bench.identification import Identification, Unknown, identify


@dataclass(frozen=True, eq=False)
class ForceLoop:
    """One record, equally sampled, each (n,).

    name: of the record; time [s], (n,); stroke [m], (n,), velocity [m/s], (n,), of the output, rebound positive
    current: on the q axis, positive where the machine opposes rebound [A], (n,); force: opposing rebound [N], (n,)
    settled: from this time on the force is compared [s]
    """

    name: str
    time: np.ndarray
    stroke: np.ndarray
    velocity: np.ndarray
    current: np.ndarray
    force: np.ndarray
    settled: float = 0.0

    def __post_init__(self) -> None:
        if not self.compared.any():
            raise RecordError(
                f"{self.name}: expected a record longer than the {self.settled:g} s in which it settles, found "
                f"{np.ptp(self.time):g} s; record longer or let it settle less."
            )

    @property
    def compared(self) -> np.ndarray:
        """Which samples count (n,)."""
        return self.time >= self.time[0] + self.settled

    @property
    def measured(self) -> np.ndarray:
        """Force of the samples that count [N], (m,)."""
        return self.force[self.compared]

    def work(self, force: np.ndarray) -> float:
        """Area of the loop, of a force (m,) [N] over the stroke [J]: the energy that the actuator took."""
        return float(np.trapezoid(force, self.stroke[self.compared]))


@dataclass(frozen=True, eq=False)
class LoopMatch:
    """A record beside the identified model (thesis table 4.3).

    loop: the record; answer: force of the model [N], (m,)
    """

    loop: ForceLoop
    answer: np.ndarray

    @property
    def largest_mismatch(self) -> float:
        """Of the force, in size [N]."""
        return float(np.max(np.abs(self.loop.measured - self.answer)))

    @property
    def rms_mismatch(self) -> float:
        """Of the force [N]."""
        return float(np.sqrt(np.mean(np.square(self.loop.measured - self.answer))))

    @property
    def energy_error(self) -> float:
        """Energy that the model takes over the measured one, less one, dimensionless; NaN where none was taken."""
        measured = self.loop.work(self.loop.measured)
        return self.loop.work(self.answer) / measured - 1 if measured else float("nan")


# Nominal values of thesis table 4.2, from which its own search began. Names say what the tables show; values are in SI.
MASS, PLAY, STIFFNESS, CONTACT = (
    "equivalent_mass_kg",
    "play_mm",
    "contact_stiffness_kN_per_m",
    "contact_damping_Ns_per_m",
)
TRANSITION, LOSS = "transition_mm", "viscous_loss_Ns_per_m"
MOUNT_DAMPING, TORQUE_CONSTANT = "mount_damping_Ns_per_m", "torque_constant_mNm_per_A"
NOMINAL = {
    MASS: 5.6,
    PLAY: 2e-4,
    STIFFNESS: 5e5,
    CONTACT: 100.0,
    TRANSITION: 1.5e-3,
    LOSS: 70.0,
    MOUNT_DAMPING: 500.0,
    TORQUE_CONSTANT: 49.3e-3,
}


def unknowns(nominal: Mapping[str, float]) -> tuple[Unknown, ...]:
    """The eight parameters. nominal: values under the names of ``NOMINAL`` [SI]."""
    return tuple(Unknown(name, nominal[name]) for name in NOMINAL)


def actuator_of(values: Mapping[str, float], ratio: float) -> Actuator:
    """The actuator. values: under the names of ``NOMINAL`` [SI]; ratio: tau_t [m/rad]."""
    mount = CompliantMount(
        values[STIFFNESS],
        damping=values[MOUNT_DAMPING],
        play=values[PLAY],
        contact_damping=values[CONTACT],
        transition=values[TRANSITION],
    )
    return Actuator(
        ratio=fixed_ratio(ratio), equivalent_mass=values[MASS], mount=mount, loss=MechanicalLoss(values[LOSS])
    )


def identify_loops(
    loops: Sequence[ForceLoop], nominal: Mapping[str, float], ratio: float, noise: float
) -> tuple[Identification, tuple[LoopMatch, ...]]:
    """The eight parameters from all loops together, and every loop beside the identified model.

    nominal: where the search begins [SI], under the names of ``NOMINAL``; ratio: tau_t [m/rad]
    noise: standard deviation of a reading of the force [N]; the intervals come from the residuals, whatever it is
    """

    def answers(values: Mapping[str, float]) -> list[np.ndarray]:
        """Forces of all loops with these parameters [N], (m,) each."""
        device = actuator_of(values, ratio)
        return [_answer(device, values[TORQUE_CONSTANT], loop) for loop in loops]

    found = identify(answers, unknowns(nominal), [loop.measured for loop in loops], [noise] * len(loops))
    return found, tuple(LoopMatch(loop, answer) for loop, answer in zip(loops, found.answers))


def _answer(device: Actuator, torque_constant: float, loop: ForceLoop) -> np.ndarray:
    run = imposed_motion(device, loop.time, loop.stroke, loop.velocity, torque_constant * loop.current)
    return run.force[loop.compared]
