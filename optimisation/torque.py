"""The torque that designs are compared by: the mean over one electrical period with the current on the q axis.

Whatever reading a saturation limit has, the torque is this one. How it is found is an object, because a sweep can
afford less than an optimum. The thesis's torque in its null position is another quantity with an object of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence

import numpy as np

from geometry.winding import WindingLayout
from magnetostatics.flux_linkage import flux_linkage_torque
from magnetostatics.model import FieldModel, FieldSolution, OperatingPoint
from magnetostatics.positions import null_angle, period_points
from magnetostatics.torque import maxwell_torque
from optimisation.states import STEPS_OVER_PERIOD

Starts = Sequence[FieldSolution | None]  # to start the further states from, None where there is nothing


class TorqueObjective:
    """A torque per metre of a design, from the solved states of a reading and further ones.

    is_mean: whether it is the mean over one electrical period with the current on the q axis
    """

    is_mean: bool

    def points(self, known: Sequence[FieldSolution]) -> list[OperatingPoint]:
        """The states to solve besides those of the reading."""
        raise NotImplementedError

    def model(self, model: FieldModel) -> FieldModel:
        """In which problem they are solved."""
        return model

    def given(self, known: Sequence[FieldSolution]) -> list[FieldSolution]:
        """Solutions at hand that count besides those of the reading."""
        return []

    def further(self, known: Sequence[FieldSolution], starts: Starts = ()) -> list[FieldSolution]:
        """Everything that counts besides the states of the reading: what is at hand, then what is solved."""
        problem, found = self.model(known[0].model), self.given(known)
        at_hand = [*starts[len(found) :]]
        for number, point in enumerate(self.points(known)):
            near = at_hand[number] if number < len(at_hand) else None
            found.append(problem.solve(point, start=near or (found[-1] if found else None)))
        return found

    def read(self, solution: FieldSolution) -> float:
        """What counts of one solution [Nm/m]."""
        return maxwell_torque(solution)

    def combined(self, known: np.ndarray, further: np.ndarray) -> float:
        """The torque [Nm/m] from what ``read`` gives.

        known: in the states of the reading [Nm/m], (states,); further: in the further ones [Nm/m], (further,)
        """
        raise NotImplementedError

    def torque(self, known: Sequence[FieldSolution], further: Sequence[FieldSolution]) -> float:
        """The torque [Nm/m] of solved states."""
        return self.combined(*(np.array([self.read(solution) for solution in some]) for some in (known, further)))


@dataclass(frozen=True)
class MeanTorque(TorqueObjective):
    """Mean over one electrical period by ``steps`` positions in 60 electrical degrees, consistent-flux torque.

    With six positions within 0.01 % of the mean of 60 at 6 A/mm^2 RMS and 0.03 % at 20 (20 designs of 9 and 12 slots).
    """

    steps: int = STEPS_OVER_PERIOD
    is_mean: bool = True

    def points(self, known: Sequence[FieldSolution]) -> list[OperatingPoint]:
        return _period_of(known[0], self.steps)

    def combined(self, known: np.ndarray, further: np.ndarray) -> float:
        """Mean of the further ones [Nm/m]; known: [Nm/m], (states,); further: [Nm/m], (further,)."""
        return float(further.mean())


@dataclass(frozen=True)
class QuickMeanTorque(TorqueObjective):
    """The same mean from one solved state: its flux-linkage torque, times how much more linear elements say the mean is.

        T = tau(state) mean_k tau_1(position k) / tau_1(state),  tau = 1.5 p (psi_d i_q - psi_q i_d)

    with tau_1 on the same triangles with linear elements, at ``steps`` positions in 60 electrical degrees. It costs
    half a design more, six positions with quadratic elements five designs more. At 6 A/mm^2 RMS within 0.3 % of
    ``MeanTorque`` (RMS 0.1 %) over the whole sweep of 9 and 12 slots, where the null state alone is up to 5 % off, and
    within 0.1 % for optima; at 20 A/mm^2 RMS only within 1.1 %.
    """

    steps: int = 3
    is_mean: bool = True

    def points(self, known: Sequence[FieldSolution]) -> list[OperatingPoint]:
        return _period_of(known[0], self.steps)

    def model(self, model: FieldModel) -> FieldModel:
        return model.coarse_model

    def given(self, known: Sequence[FieldSolution]) -> list[FieldSolution]:
        coarse = known[0].coarse
        return [self.model(known[0].model).solve(known[0].point) if coarse is None else coarse]

    def read(self, solution: FieldSolution) -> float:
        """Torque by flux linkages [Nm/m]."""
        return flux_linkage_torque(solution)

    def combined(self, known: np.ndarray, further: np.ndarray) -> float:
        """The known one, scaled [Nm/m]; known: [Nm/m], (states,); further: [Nm/m], (further,)."""
        return float(known[0] * further[1:].mean() / further[0])


@dataclass(frozen=True)
class TorqueOfReading(TorqueObjective):
    """Mean over the states of the reading: the mean torque where these cover the period on the q axis."""

    is_mean: bool = True

    def points(self, known: Sequence[FieldSolution]) -> list[OperatingPoint]:
        return []

    def combined(self, known: np.ndarray, further: np.ndarray) -> float:
        """Mean of the known ones [Nm/m]; known: [Nm/m], (states,); further: [Nm/m], (further,)."""
        return float(known.mean())


@dataclass(frozen=True)
class NullTorque(TorqueObjective):
    """The thesis's torque: in its null position, a magnet on a tooth and the current of phase A at its peak.

    Only with a reading that looks at this state alone.
    """

    is_mean: bool = False

    def points(self, known: Sequence[FieldSolution]) -> list[OperatingPoint]:
        return []

    def combined(self, known: np.ndarray, further: np.ndarray) -> float:
        """That of the one known [Nm/m]; known: [Nm/m], (states,); further: [Nm/m], (further,)."""
        return float(known[0])


def _period_of(solution: FieldSolution, steps: int) -> list[OperatingPoint]:
    section, point = solution.model.section, _point(solution)
    return period_points(section.machine, section.layout, point.current_density, point.packing_factor, steps)


def _point(solution: FieldSolution) -> OperatingPoint:
    if not isinstance(solution.point, OperatingPoint):
        raise TypeError(f"a design is judged with balanced currents, found {type(solution.point).__name__}")
    return solution.point


def is_null_state(solution: FieldSolution, layout: WindingLayout) -> bool:
    """Whether a magnet stands on a tooth and phase A has its peak."""
    machine, point = solution.model.section.machine, _point(solution)
    peak = point.phase_densities(machine.pole_pairs, layout.phase_axis)[0]
    return abs(point.angle - null_angle(machine, layout)) < 1e-9 and peak >= point.current_density * (1 - 1e-9)
