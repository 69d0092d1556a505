"""A machine turned through some of its positions: torque and flux linkage of the stack at one current."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import park, phase_flux_linkage
from magnetostatics.model import FieldModel, FieldSolution
from magnetostatics.torque import arkkio_torque, maxwell_torque


@dataclass(frozen=True, eq=False)
class Turned:
    """One row a position.

    angle: of the rotor [rad], (n,)
    currents: of the phases [A], (n, 3)
    torque: ring average and consistent fluxes, of the stack [Nm], (n, 2)
    linkage: of the phases, of the stack [Wb], (n, 3); dq_linkage: of d and q axis [Wb], (n, 2)
    """

    angle: np.ndarray
    currents: np.ndarray
    torque: np.ndarray
    linkage: np.ndarray
    dq_linkage: np.ndarray

    @property
    def mean_torque(self) -> float:
        """Ring average [Nm]."""
        return float(self.torque[:, 0].mean())

    @property
    def ripple(self) -> float:
        """Ring average from peak to peak [Nm]."""
        return float(np.ptp(self.torque[:, 0]))

    @property
    def routes_apart(self) -> float:
        """Largest difference of the two torques, relative to the largest torque."""
        return float(np.abs(np.diff(self.torque)).max() / np.abs(self.torque).max())

    @property
    def fundamental(self) -> float:
        """Amplitude of the fundamental of phase A [Wb]; the positions span one electrical period evenly."""
        return float(2 / len(self.angle) * np.abs(np.fft.rfft(self.linkage[:, 0])[1]))


@dataclass(frozen=True)
class Supply:
    """Sinusoidal currents that turn with the rotor.

    amplitude: of a phase, i_d = -I sin gamma, i_q = I cos gamma [A]; current_angle: gamma, electrical, from the q axis
    [rad]; turns: of every coil, all coils of a phase in series, dimensionless
    """

    amplitude: float
    current_angle: float
    turns: float

    def at(self, angle: float, model: FieldModel) -> PhaseCurrents:
        """The currents at a rotor angle [rad]."""
        layout, pole_pairs = model.section.layout, model.section.machine.pole_pairs
        lag = pole_pairs * angle - layout.phase_axis - 2 * np.pi / 3 * np.arange(3)
        i_d, i_q = -self.amplitude * np.sin(self.current_angle), self.amplitude * np.cos(self.current_angle)
        a, b, c = (i_d * np.cos(lag) - i_q * np.sin(lag)).tolist()
        return PhaseCurrents(angle, (a, b, c), self.turns)


def turned(model: FieldModel, supply: Supply, active_length: float, angles: Iterable[float]) -> Turned:
    """Solve the field at rotor angles, each from the one before; active_length [m]; angles [rad]"""
    return read_turn(solved_turn(model, supply, angles), supply.turns, active_length)


def solved_turn(model: FieldModel, supply: Supply, angles: Iterable[float]) -> list[FieldSolution]:
    """The field at rotor angles, each solved from the one before; angles [rad]"""
    solutions: list[FieldSolution] = []
    for angle in angles:
        solutions.append(model.solve(supply.at(angle, model), solutions[-1] if solutions else None))
    return solutions


def read_turn(solutions: list[FieldSolution], turns: float, length: float) -> Turned:
    """Torque and linkages of a stack; turns: of every coil, dimensionless; length [m]"""
    model = solutions[0].model
    angle = np.array([solution.point.angle for solution in solutions])
    linkage = turns * length * np.array([phase_flux_linkage(solution) for solution in solutions])
    electrical, axis = model.section.machine.pole_pairs * angle, model.section.layout.phase_axis
    return Turned(
        angle,
        np.array([solution.point.currents for solution in solutions]),  # type: ignore[attr-defined]
        length * np.array([(arkkio_torque(solution), maxwell_torque(solution)) for solution in solutions]),
        linkage,
        np.array([park(one, at, axis) for one, at in zip(linkage, electrical, strict=True)]),
    )
