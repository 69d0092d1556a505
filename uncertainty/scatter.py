"""Cogging of machines whose magnets differ, and whose rotor does not stand in the middle: new orders.

As drawn, the cogging of all poles and slots cancels but for multiples of their least common multiple. One odd magnet
passes the Q slots alike, so what it adds repeats after a slot pitch, with the orders Q, 2Q, ...; to first order it is
its deviation times one waveform w, and the magnets m of a machine add up,

    T(theta) = T_drawn(theta) + sum over m of delta_m w(theta + m tau_p)

so that thousands of machines are drawn by lot from two waveforms. An eccentricity acts with its square where slots and
poles share a divisor; so it is solved at its size. Of the stator alone it repeats after a pole pitch (orders k 2p), of
the rotor after a slot pitch. Not covered: slots that differ from each other, a rotor that tilts, parts that are oval.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import lcm, pi

import numpy as np
import scipy

from geometry.cross_section import CrossSection, mesh_cross_section
from geometry.defects import DynamicEccentricity, MagnetPosition, StaticEccentricity, deformed
from geometry.machine import Machine
from geometry.morph import Defect, Morpher
from magnetostatics.arc import Arc, solved_over
from magnetostatics.case import FieldCase
from magnetostatics.model import FieldModel, FieldSolution
from magnetostatics.sensitivity import Variation, sensitivities
from magnetostatics.torque import arkkio_torque
from magnetostatics.variations import OneMagnet, Shape
from tasks import Workers
from uncertainty.deviations import MagnetScatter

STEPS = 6  # of a period, even of the drawn cogging
_MACHINES = 2000  # drawn by lot
_SEED = 1  # of the lot: the same machines every time
_ANGLES_TOGETHER = 10  # of a task; each starts from the field of the one before
_FINER = 4  # points between two steps at which the peaks are looked for
_ANGLE_STEP = 1e-8  # rad, small against any scatter


@dataclass(frozen=True, eq=False)
class CoggingScatter:
    """Cogging of machines that are not as drawn, per metre of length, ``STEPS`` to a period of the drawn cogging.

    pole_steps: steps from one magnet to the next
    drawn: over a slot pitch, from magnet 0 on tooth 0 on [Nm/m], (n,)
    remanence, position: what a magnet adds over a slot pitch, on magnet 0 [Nm/m per T, Nm/m per rad], (n,)
    static, dynamic: drawn cogging with the eccentricity, over a pole pitch (k,) and over a slot pitch (n,) [Nm/m]
    eccentricity: that they were solved at [m]
    """

    machine: Machine
    pole_steps: int
    drawn: np.ndarray
    remanence: np.ndarray
    position: np.ndarray
    static: np.ndarray
    dynamic: np.ndarray
    eccentricity: float

    def machines(self, scatter: MagnetScatter) -> np.ndarray:
        """Cogging from peak to peak [Nm/m] of machines drawn by lot, (machines,); magnets uniform in the scatter."""
        lots = np.random.default_rng(_SEED).uniform(-1.0, 1.0, (2, _MACHINES, self.machine.poles))
        added = lots[0] * scatter.remanence @ self._of_magnets(self.remanence)
        added += lots[1] * scatter.position @ self._of_magnets(self.position)
        return peak_to_peak(self.drawn + added)

    def orders_of_magnets(self, scatter: MagnetScatter) -> dict[int, float]:
        """Root mean square over all machines of the amplitude of each mechanical order that is new [Nm/m].

        The magnets are independent, so their squares add up: sigma^2 |c|^2 a magnet.
        """
        spread = scatter.remanence * _orders(self.remanence), scatter.position * _orders(self.position)
        size = np.hypot(*spread) * (self.machine.poles / 3) ** 0.5
        return self._new_orders(size, self.machine.slots)

    @property
    def orders_of_static(self) -> dict[int, float]:
        """New orders of a stator beside the axis and their amplitude [Nm/m]."""
        return self._new_orders(_orders(self.static), self.machine.poles)

    @property
    def orders_of_dynamic(self) -> dict[int, float]:
        """New orders of a rotor beside its axis and their amplitude [Nm/m]."""
        return self._new_orders(_orders(self.dynamic), self.machine.slots)

    def _of_magnets(self, waveform: np.ndarray) -> np.ndarray:
        """What each magnet adds per unit, (poles, n)."""
        return np.stack([np.roll(waveform, -m * self.pole_steps) for m in range(self.machine.poles)])

    def _new_orders(self, amplitude: np.ndarray, first: int) -> dict[int, float]:
        """By mechanical order, without those of the machine as drawn; first: the lowest order, dimensionless."""
        native = lcm(self.machine.slots, self.machine.poles)
        found = {first * k: float(size) for k, size in enumerate(amplitude) if k and first * k % native}
        return dict(sorted(found.items(), key=lambda one: -one[1]))


@dataclass(frozen=True)
class ScatterArc(Arc):
    """Rotor angles of the whole machine, and how its parts stand beside the axis."""

    defects: tuple[Defect, ...] = ()

    def model(self) -> FieldModel:
        """Of the whole machine with its defects, on the mesh of the sweep."""
        whole = mesh_cross_section(self.machine, self.case.layout(self.machine), self.case.density, whole=True)
        section = deformed(whole, *self.defects) if self.defects else whole
        return FieldModel(section, self.case.materials)

    def solved(self) -> list[FieldSolution]:
        """Without current."""
        return solved_over(self.model(), self.angles, 0.0, self.case.packing)


def cogging_scatter(case: FieldCase, machine: Machine, eccentricity: float, workers: Workers) -> CoggingScatter:
    """Solve the whole machine without current; eccentricity: of stator and rotor, each alone [m]."""
    native = lcm(machine.slots, machine.poles)
    step = 2 * pi / native / STEPS
    per_slot, per_pole = STEPS * native // machine.slots, STEPS * native // machine.poles
    static, dynamic = StaticEccentricity(eccentricity), DynamicEccentricity(eccentricity)
    magnets = workers.map("magnets that differ", solve_magnet_waveforms, _arcs(case, machine, per_slot, step))
    stator = workers.map("stator off centre", solve_cogging, _arcs(case, machine, per_pole, step, static))
    rotor = workers.map("rotor off centre", solve_cogging, _arcs(case, machine, per_slot, step, dynamic))
    drawn, remanence, position = np.concatenate(list(magnets.values()), axis=1)
    return CoggingScatter(
        machine=machine,
        pole_steps=per_pole,
        drawn=mirrored(drawn, -1),
        remanence=mirrored(remanence, -1),
        position=mirrored(position, 1),
        static=mirrored(np.concatenate(list(stator.values())), -1),
        dynamic=mirrored(np.concatenate(list(rotor.values())), -1),
        eccentricity=eccentricity,
    )


def _arcs(case: FieldCase, machine: Machine, count: int, step: float, *defects: Defect) -> dict[str, ScatterArc]:
    """Half of a period of ``count`` steps [rad], both ends included: the other half is its mirror image."""
    angles = (step * np.arange(count // 2 + 1)).tolist()
    return {
        f"arc {first}": ScatterArc(case, machine, tuple(angles[first : first + _ANGLES_TOGETHER]), defects)
        for first in range(0, len(angles), _ANGLES_TOGETHER)
    }


def mirrored(half: np.ndarray, sign: int) -> np.ndarray:
    """The whole period of what is even (sign 1) or odd (-1) about its start: tooth 0 and magnet 0 on the axis.

    half: [any unit], (n/2 + 1,), both ends included; mirrored: [the same], (n,)
    """
    return np.concatenate([half, sign * half[-2:0:-1]])


def solve_magnet_waveforms(arc: ScatterArc) -> np.ndarray:
    """Cogging as drawn and its derivatives by remanence and place of magnet 0 over the angles of the arc.

    solve_magnet_waveforms: [Nm/m, Nm/m per T, Nm/m per rad], (3, n)
    """
    solutions = arc.solved()
    morpher = Morpher(solutions[0].model.section)

    def displaced(change: float) -> CrossSection:
        return morpher.to(arc.machine, [MagnetPosition(0, change)])

    variations: dict[str, Variation] = {"remanence": OneMagnet(0), "position": Shape(displaced, _ANGLE_STEP)}
    rows = []
    for solution in solutions:
        found = sensitivities(solution, variations, lambda one: np.array([arkkio_torque(one)]))
        rows.append([arkkio_torque(solution), found["remanence"][0], found["position"][0]])
    return np.array(rows).T


def solve_cogging(arc: ScatterArc) -> np.ndarray:
    """Torque without current [Nm/m], (n,)."""
    return np.array([arkkio_torque(solution) for solution in arc.solved()])


def peak_to_peak(waveforms: np.ndarray) -> np.ndarray:
    """Of periods, with points between their steps by their harmonics: the highest point lies between two.

    waveforms: [any unit], (..., n); peak_to_peak: [the same], (...,)
    """
    return np.ptp(scipy.signal.resample(waveforms, _FINER * waveforms.shape[-1], axis=-1), axis=-1)


def _orders(waveform: np.ndarray) -> np.ndarray:
    """Amplitude of each harmonic of one period [unit of the waveform]."""
    return 2 * np.abs(np.fft.rfft(waveform)) / len(waveform)
