"""How torque, flux linkages, inductances, iron loss, cogging and the current that demagnetises change with the
cross-section and its materials.

A state is a current at rotor angles over a part of the electrical period; what is read of its solutions together is
read again a step further along each deviation (``magnetostatics.sensitivity``), which costs a back-substitution a
deviation and angle in the place of a mesh and a solution. The ampere-turns stay those of the wires.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import lcm, pi

import numpy as np

from geometry.machine import Machine
from geometry.morph import Morpher
from losses.iron import iron_loss
from losses.loci import PartOfPeriod, finest_repetition, rotor_loci, solve_part, stator_loci
from magnetostatics.arc import solved_over
from magnetostatics.case import FieldCase
from magnetostatics.demagnetisation import MagnetFlux, magnet_flux
from magnetostatics.flux_map import flux_and_torque, flux_torque_and_inductances, map_angles, operating_point
from magnetostatics.mesh_error import SAFETY, refined_model
from magnetostatics.model import FieldModel, FieldSolution, OperatingPoint
from magnetostatics.positions import null_angle
from magnetostatics.sensitivity import Variation, ahead
from magnetostatics.torque import arkkio_torque
from magnetostatics.variations import SameAmpereTurns
from materials.iron_loss import IronLossLaw
from uncertainty.deviations import Deviation
from units import MU_0

_STEPS = 36  # of an electrical period: six in the sixth after which three equal phases see the same
_COGGING_STEPS = 12  # of a period of the cogging
TORQUE, FLUX_D, FLUX_Q, RIPPLE, IRON_LOSS = range(5)  # places of what a loaded state gives; the last with loss data
_OF_THE_FINER_MESH = 2  # every so manieth angle is solved on the finer mesh
_MAGNET_ANGLES = 6  # over 60 electrical degrees; even, so that every second one is as many of either current
_LITTLE = 0.02  # relative, of a current against the magnets

Solutions = Sequence[FieldSolution]


@dataclass(frozen=True)
class FieldState:
    """The machine under a current over a part of the electrical period; the concrete ones are below.

    direct, quadrature: ampere-turns of a coil, i_d and i_q [A peak]
    """

    direct: float
    quadrature: float

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of what is read."""
        return "torque", "psi_d", "psi_q", "ripple"

    def solutions(self, model: FieldModel) -> list[FieldSolution]:
        """Evenly over the part of the period after which the machine sees the same again."""
        return _solved(model, self.direct, self.quadrature)

    def read(self, solutions: Solutions) -> np.ndarray:
        """What the solutions make together [Nm/m, Wb/m, H/m or W/m], (k,), in the order of the quantities.

        ripple: torque from peak to peak
        """
        each = [flux_and_torque(one) for one in solutions]
        means, ripple = _means(each), float(np.ptp([one["torque"] for one in each]))
        return np.array([*(means[name] for name in ("torque", "psi_d", "psi_q")), ripple])


@dataclass(frozen=True)
class LoadedIron(FieldState):
    """With the iron loss too; law: of the sheet; frequency: electrical [Hz]."""

    law: IronLossLaw
    frequency: float

    @property
    def quantities(self) -> tuple[str, ...]:
        return (*super().quantities, "iron_loss")

    def read(self, solutions: Solutions) -> np.ndarray:
        """See ``FieldState``; read: [Nm/m, Wb/m, Wb/m, Nm/m], and the loss of stator and rotor [W/m], (5,)."""
        part = PartOfPeriod(tuple(solutions), finest_repetition(solutions[0].model.section))
        loss = sum(iron_loss(loci(part), self.law).total.at(self.frequency) for loci in (stator_loci, rotor_loci))
        return np.append(super().read(solutions), loss)


@dataclass(frozen=True)
class NoLoad(FieldState):
    """Without current: flux linkage of the magnets and incremental inductances; direct, quadrature: 0 [A]."""

    direct: float = 0.0
    quadrature: float = 0.0

    @property
    def quantities(self) -> tuple[str, ...]:
        return "psi_d", "l_dd", "l_qq"

    def read(self, solutions: Solutions) -> np.ndarray:
        """See ``FieldState`` [Wb/m, H/m, H/m], (3,)."""
        means = _means([flux_torque_and_inductances(one) for one in solutions])
        return np.array([means[name] for name in self.quantities])


@dataclass(frozen=True)
class LoadedInductances(FieldState):
    """The current on the q axis, and with a current against d beside it; apparent inductances as on the data sheet.

    direct: of that second current, quadrature: of both [A peak]
    """

    @property
    def quantities(self) -> tuple[str, ...]:
        return "psi_d", "l_d", "l_q"

    def solutions(self, model: FieldModel) -> list[FieldSolution]:
        """Of the one current, then of the other."""
        return _solved(model, 0.0, self.quadrature) + _solved(model, self.direct, self.quadrature)

    def read(self, solutions: Solutions) -> np.ndarray:
        """Flux linkage of the first current and apparent inductances [Wb/m, H/m, H/m], (3,)."""
        each = [flux_and_torque(one) for one in solutions]
        first, weakened = _means(each[: len(each) // 2]), _means(each[len(each) // 2 :])
        l_d = (weakened["psi_d"] - first["psi_d"]) / self.direct
        return np.array([first["psi_d"], l_d, first["psi_q"] / self.quadrature])


@dataclass(frozen=True)
class Cogging(FieldState):
    """Without current over half a period of the cogging, which is odd about a magnet on a tooth.

    direct, quadrature: 0 [A]
    """

    direct: float = 0.0
    quadrature: float = 0.0

    @property
    def quantities(self) -> tuple[str, ...]:
        return ("cogging",)

    def solutions(self, model: FieldModel) -> list[FieldSolution]:
        machine = model.section.machine
        step = 2 * pi / lcm(machine.slots, machine.poles) / _COGGING_STEPS
        inside = np.arange(1, _COGGING_STEPS // 2)
        angles = null_angle(machine, model.section.layout) + step * inside
        return solved_over(model, angles.tolist(), 0.0, OperatingPoint.packing_factor)

    def read(self, solutions: Solutions) -> np.ndarray:
        """From peak to peak [Nm/m], (1,)."""
        return np.array([2 * max(abs(arkkio_torque(one)) for one in solutions)])


@dataclass(frozen=True)
class OpposingField(FieldState):
    """The field strength against the magnets under a current, H = (B_r - B) / (mu_0 mu_r).

    What a grade stands is said by its field strength, which does not move with its remanence.
    share: of the magnets' volume that may see more of it
    """

    share: float

    @property
    def quantities(self) -> tuple[str, ...]:
        return ("opposing_field",)

    def solutions(self, model: FieldModel) -> list[FieldSolution]:
        """Over the part of a turn after which the next magnet sees the same."""
        return _turned(model, [(self.direct, self.quadrature)])

    def read(self, solutions: Solutions) -> np.ndarray:
        """That all but the share stay below over a turn [A/m], (1,)."""
        magnet = solutions[0].model.materials.magnet
        seen = [magnet_flux(one) for one in solutions]
        turn = MagnetFlux(np.min([one.smallest for one in seen], axis=0)[None], seen[0].areas)
        return np.array([(magnet.remanence - turn.exceeded(self.share)) / (MU_0 * magnet.recoil_permeability)])


@dataclass(frozen=True)
class AtTheKnee(OpposingField):
    """The current against the magnets that drives a share of their volume to the knee of their grade.

    direct: about that current, negative; quadrature: 0 [A]; knee: field strength there [A/m]
    """

    knee: float

    @property
    def quantities(self) -> tuple[str, ...]:
        return ("demagnetising_current",)

    def solutions(self, model: FieldModel) -> list[FieldSolution]:
        """A little below that current, then a little above."""
        return _turned(model, [(self.direct * (1 - _LITTLE), 0.0), (self.direct * (1 + _LITTLE), 0.0)])

    def read(self, solutions: Solutions) -> np.ndarray:
        """The ampere-turns at which the knee is met, linear between the two currents [A], (1,)."""
        half = len(solutions) // 2
        less, more = (float(super(AtTheKnee, self).read(some)[0]) for some in (solutions[:half], solutions[half:]))
        past = (self.knee - less) / (more - less) * 2 * _LITTLE
        return np.array([abs(self.direct) * (1 - _LITTLE + past)])


@dataclass(frozen=True)
class StateTask:
    """A state of a machine, and the deviations that its quantities are wanted over."""

    case: FieldCase
    machine: Machine
    state: FieldState
    deviations: tuple[Deviation, ...] = ()


@dataclass(frozen=True, eq=False)
class StateSlopes:
    """deviations: in the order of the rows; values: of the quantities of a state [SI, per metre and turn], (k,)

    relative: their derivatives over themselves [1 per unit of the deviation], (deviations, k)
    """

    deviations: tuple[Deviation, ...]
    values: np.ndarray
    relative: np.ndarray

    def of(self, deviation: Deviation) -> np.ndarray:
        """The row of one deviation [1 per unit of the deviation], (k,)."""
        return self.relative[self.deviations.index(deviation)]


def solve_slopes(task: StateTask) -> StateSlopes:
    """Quantities of a state and what each deviation does to them."""
    model = task.case.model(task.machine)
    solutions = task.state.solutions(model)
    values = task.state.read(solutions)
    found = slopes(solutions, _variations(model, task.deviations), task.state)
    relative = [found[one.name] / values if one.name in found else 0.0 * values for one in task.deviations]
    return StateSlopes(task.deviations, values, np.array(relative))


def slopes(solutions: Solutions, variations: dict[str, Variation], state: FieldState) -> dict[str, np.ndarray]:
    """Derivatives of the quantities of a state [unit of the quantity per its own], (k,), by name of the variation."""
    here, moved = state.read(solutions), [ahead(one, variations) for one in solutions]
    return {
        name: (state.read([one[name] for one in moved]) - here) / variation.step
        for name, variation in variations.items()
    }


def mesh_errors(task: StateTask) -> np.ndarray:
    """Bounds of what the mesh may have put the quantities off by, over themselves, dimensionless (k,).

    ``SAFETY`` times what triangles of half the size change, as in ``magnetostatics.mesh_error``; at every second angle.
    """
    model, solved = task.case.model(task.machine), list[FieldSolution]()
    coarse = task.state.solutions(model)[::_OF_THE_FINER_MESH]
    finer = refined_model(model)
    for one in coarse:
        solved.append(finer.solve(one.point, start=solved[-1] if solved else None))
    value = task.state.read(coarse)
    return SAFETY * np.abs(task.state.read(solved) / value - 1)


def _variations(model: FieldModel, deviations: Sequence[Deviation]) -> dict[str, Variation]:
    """Those of the deviations that the field feels, by name."""
    morpher = Morpher(model.section)
    found = {one.name: one.variation(morpher) for one in deviations}
    return {name: SameAmpereTurns(one) for name, one in found.items() if one is not None}


def _solved(model: FieldModel, direct: float, quadrature: float) -> list[FieldSolution]:
    """Under a current (i_d, i_q) over the finest part of the period; direct, quadrature: [A peak] of a coil."""
    point = operating_point(model, float(map_angles(model, 1)[0]), direct, quadrature)
    return list(solve_part(model, point, _STEPS).solutions)


def _turned(model: FieldModel, currents: Sequence[tuple[float, float]]) -> list[FieldSolution]:
    """Under one current (i_d, i_q) [A peak] of a coil after the other, each at all angles of the magnets."""
    angles, found = map_angles(model, _MAGNET_ANGLES).tolist(), list[FieldSolution]()
    for point in (operating_point(model, angle, *current) for current in currents for angle in angles):
        found.append(model.solve(point, start=found[-1] if found else None))
    return found


def _means(read: Sequence[dict[str, float]]) -> dict[str, float]:
    return {name: float(np.mean([one[name] for one in read])) for name in read[0]}
