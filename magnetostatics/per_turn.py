"""Per-turn values of a machine before its winding is chosen: flux linkage, apparent inductances, mean torque."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, hypot, pi

import numpy as np

from magnetostatics.flux_linkage import park, phase_flux_linkage
from magnetostatics.model import FieldModel, FieldSolution, OperatingPoint
from magnetostatics.torque import arkkio_torque

_WEAKENING = 0.25  # negative d-axis current over the q-axis current
_POSITIONS = 6  # over 60 electrical degrees, after which all dq quantities repeat


@dataclass(frozen=True)
class PerTurnValues:
    """One current density, mean over the rotor position; per metre of active length, all coils of a phase in series.

    ampere_turns: peak ampere-turns of one coil [A]
    flux_linkage: no-load psi_m [Wb per turn]
    inductance_q: apparent on the q axis, psi_q / i_q [H per turn^2]
    inductance_d: apparent in the loaded machine, the change of psi_d when a quarter of the current is added on the
        negative d axis while i_q stays. Without the load the d axis is less saturated than the q axis with it; the two
        together would promise a reluctance torque that is not there. [H per turn^2]
    psi_d_loaded: psi_d with the current on the q axis [Wb per turn]
    torque: on the q axis [Nm]; torque_from_flux: 1.5 p psi_d i_q, the same torque by another route [Nm]
    """

    ampere_turns: float
    flux_linkage: float
    inductance_d: float
    inductance_q: float
    psi_d_loaded: float
    torque: float
    torque_from_flux: float


def per_turn_values(model: FieldModel, amplitude: float, packing: float, first_angle: float = 0.0) -> PerTurnValues:
    """Solve no load, q-axis current and the same with some negative d-axis current over 60 electrical degrees; average.

    amplitude: of the current density in the copper [A/m^2]; packing: copper share of the slot
    first_angle: rotor angle of the first position [rad]
    """
    section = model.section
    span = pi / 3 / section.machine.pole_pairs
    angles = first_angle + span * np.arange(_POSITIONS) / _POSITIONS
    idle = _mean_dq(model, [OperatingPoint(angle, 0.0, 0.0, packing) for angle in angles])
    on_q = _mean_dq(model, [OperatingPoint(angle, amplitude, 0.0, packing) for angle in angles])
    weakened = amplitude * hypot(1.0, _WEAKENING), atan(_WEAKENING)
    with_d = _mean_dq(model, [OperatingPoint(angle, *weakened, packing) for angle in angles])
    ampere_turns = amplitude * packing * section.half_slot_area * section.half_slots_per_coil_side
    return PerTurnValues(
        ampere_turns=ampere_turns,
        flux_linkage=idle[0],
        inductance_d=(on_q[0] - with_d[0]) / (_WEAKENING * ampere_turns),
        inductance_q=on_q[1] / ampere_turns,
        psi_d_loaded=on_q[0],
        torque=on_q[2],
        torque_from_flux=1.5 * section.machine.pole_pairs * on_q[0] * ampere_turns,
    )


def mean_torque(
    model: FieldModel, amplitude: float, packing: float, current_angle: float = 0.0, first_angle: float = 0.0
) -> float:
    """Torque alone at one current, mean over 60 electrical degrees [Nm/m]; a third of the solutions of
    ``per_turn_values``.

    amplitude: of the current density in the copper [A/m^2]
    current_angle: from the q axis, positive weakens the field [rad]; the other arguments as there
    """
    span = pi / 3 / model.section.machine.pole_pairs
    angles = first_angle + span * np.arange(_POSITIONS) / _POSITIONS
    return _mean_dq(model, [OperatingPoint(angle, amplitude, current_angle, packing) for angle in angles])[2]


def _mean_dq(model: FieldModel, points: list[OperatingPoint]) -> list[float]:
    """Mean of (psi_d, psi_q, torque) over operating points."""
    solution, rows = None, []
    for point in points:
        solution = model.solve(point, start=solution)
        rows.append(_dq_and_torque(solution))
    return np.mean(rows, axis=0).tolist()


def _dq_and_torque(solution: FieldSolution) -> tuple[float, float, float]:
    section = solution.model.section
    electrical = section.machine.pole_pairs * solution.point.angle
    psi_d, psi_q = park(phase_flux_linkage(solution), electrical, section.layout.phase_axis)
    return psi_d, psi_q, arkkio_torque(solution)
