"""The kinds of measurement on the bench of a machine; ``model`` lists their columns."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import floor, sqrt

import numpy as np

from effects.base import Columns
from effects.dq_design import DqMachine
from effects.machine_design import MachineAsBuilt
from units import DEGREE
from workbench.data.table import Table
from workbench.errors import WorkbenchError
from workbench.models.by_fundamental import PHASES, Drag, Found, by_its_fundamental, by_phase, phase_currents
from workbench.models.machine.answers import BRAKES, RESISTANCES, Answers, load_angles
from workbench.models.machine.drag import lost_torque
from workbench.models.machine.field import LoadedState
from workbench.models.machine.surrogate import Surrogate

_PROBE = 5e-4  # A, of an inductance; half of what still counts as no current
_TO_WHOLE_DEGREES = 0.3 * DEGREE  # that rotors are set to, encoders off by tenths: there mirrors make two states one
_TWO_DIGITS_WITHIN = 0.01  # relative; currents are solved at two digits where that is as near, else at three


def _back_emf(answers: Answers, at: Columns) -> Found:
    """v = speed * d psi/d angle."""
    return by_phase("v", (answers.flux_slopes(at["angle_mech"]) * at["speed"]).T)


def _cogging(answers: Answers, at: Columns) -> Found:
    return {"torque": answers.cogging(at["angle_mech"])}


def _locked_rotor(answers: Answers, at: Columns) -> Found:
    return {"torque": answers.loaded_torque(at["angle_mech"], phase_currents(at))}


def _flux_linkage(answers: Answers, at: Columns) -> Found:
    change = answers.flux_change(at["angle_mech"], phase_currents(at))
    whole = change + answers.magnet_linkage(at["angle_mech"])
    return by_phase("dpsi", change) | by_phase("psi", whole)


def _inductance(answers: Answers, at: Columns) -> Found:
    """l_x = dpsi_x / i_x, of the phases that carry current in every row."""
    currents = phase_currents(at)
    change = answers.flux_change(at["angle_mech"], currents)
    return {f"l_{x}": change[:, k] / currents[:, k] for k, x in enumerate(PHASES) if np.all(currents[:, k] != 0.0)}


def _phase_resistance(answers: Answers, at: Columns) -> Found:
    return by_phase("r", answers.resistances(at))


def _drag(answers: Answers, at: Columns) -> Found:
    return {"torque": lost_torque(answers, at)}


def _short_circuit(answers: Answers, at: Columns) -> Found:
    """Steady state of the fundamentals, terminals joined: R_x I_x + j w (L I + psi)_x = v for all x, sum of I = 0.

    The shaft covers the copper loss, T = -sum R |I|^2/2/speed. Without the saturation that the current makes.
    """
    speed, resistances = at["speed"], answers.resistances(at)
    _need_resistance(answers.design)
    currents = _joined_terminals(answers, speed, resistances)
    power = (resistances * np.abs(currents) ** 2).sum(axis=1) / 2
    torque = -np.divide(power, speed, out=np.zeros_like(power), where=speed != 0.0)
    each = np.abs(currents) / sqrt(2.0)
    found = {"torque": torque + lost_torque(answers, at), "current": np.sqrt((each**2).mean(axis=1))}
    return found | by_phase("i", each)


def _joined_terminals(answers: Answers, speed: np.ndarray, resistances: np.ndarray) -> np.ndarray:
    """Complex amplitudes of the phase currents [A] (n, 3)."""
    pairs = answers.design.machine.pole_pairs
    omega = (pairs * speed)[:, None]
    matrix = np.zeros((len(speed), 4, 4), dtype=complex)
    matrix[:, :3, :3] = 1j * omega[:, :, None] * answers.inductances + resistances[:, :, None] * np.eye(3)
    matrix[:, :3, 3], matrix[:, 3, :3] = -1.0, 1.0
    driven = np.zeros((len(speed), 4, 1), dtype=complex)
    driven[:, :3, 0] = -1j * omega * answers.linkage_waves[:, pairs]
    return np.linalg.solve(matrix, driven)[:, :3, 0]


def dq_machine(answers: Answers) -> DqMachine:
    """The machine by its fundamental, means over phases and angles: what remains of it under load at speed.

    Without saturation by its current; iron loss, friction and shorted turns brake the shaft.
    """
    waves = answers.linkage_waves[:, answers.design.machine.pole_pairs]
    l_d, l_q = _rotor_frame(answers, waves / np.abs(waves))
    _need_resistance(answers.design)
    resistance = float(answers.resistances({"speed": np.zeros(1)}).mean())
    psi_m = float(np.abs(waves).mean())
    return DqMachine(answers.design.machine.pole_pairs, psi_m, l_d, l_q, resistance).with_torque(
        Drag(partial(lost_torque, answers))
    )


def _rotor_frame(answers: Answers, axis: np.ndarray) -> tuple[float, float]:
    """L_d and L_q [H]: flux linkage along the magnets' axis, and a quarter ahead, per current there."""
    angle = load_angles(answers.design)
    turn = np.exp(1j * answers.design.machine.pole_pairs * angle)[:, None] * axis
    found = []
    for unit in (turn.real, (1j * turn).real):
        change = answers.flux_change(angle, _PROBE * unit) / _PROBE
        found.append(float(2 / 3 * (change * unit).sum(axis=1).mean()))
    return found[0], found[1]


def _mean_resistance(answers: Answers, at: Columns) -> np.ndarray:
    return answers.resistances(at).mean(axis=1)


@dataclass(frozen=True, eq=False)
class Summand:
    """What adds up to a reading. answer: from the machine and the conditions;  unseen: what of a design has no say in
    it: designs that differ in nothing else have one answer, which is worked out once"""

    answer: Callable[[Answers, Columns], Found]
    unseen: tuple[str, ...] = ()


_UNSEEN_BY_FLUX = (*BRAKES, *RESISTANCES, "cogging_of_mesh")
_UNSEEN_BY_TORQUE = (*BRAKES, *RESISTANCES, "recorder_loss", "end_winding_inductance")
_BRAKE = Summand(_drag)

KINDS: Mapping[str, tuple[Summand, ...]] = {
    "back_emf": (Summand(_back_emf, _UNSEEN_BY_FLUX),),
    "cogging": (Summand(_cogging, _UNSEEN_BY_TORQUE), _BRAKE),
    "locked_rotor": (Summand(_locked_rotor, _UNSEEN_BY_TORQUE), _BRAKE),
    "flux_linkage": (Summand(_flux_linkage, _UNSEEN_BY_FLUX),),
    "inductance": (Summand(_inductance, _UNSEEN_BY_FLUX),),
    "phase_resistance": (Summand(_phase_resistance),),
    "drag": (_BRAKE,),
    "short_circuit": (Summand(_short_circuit),),
    "no_load": (Summand(by_its_fundamental("no_load", dq_machine, _mean_resistance)),),
    "dyno_map": (Summand(by_its_fundamental("dyno_map", dq_machine, _mean_resistance)),),
}


def added_up(found: Sequence[Mapping[str, np.ndarray]]) -> Found:
    """Readings from the answers of all summands, which have the same names."""
    return {name: sum(one[name] for one in found) for name in found[0]}


_WITH_CURRENTS = ("locked_rotor", "flux_linkage", "inductance")
_WITH_INDUCTANCE = ("short_circuit", "no_load", "dyno_map")


def _need_resistance(design: MachineAsBuilt) -> None:
    if not all(design.phase_resistance):
        raise WorkbenchError("currents at speed need the resistance of the winding: give phase_resistance in [device]")


# ---- loaded states -------------------------------------------------------------------------------------------------


def loaded_states(design: MachineAsBuilt, tables: Sequence[Table]) -> tuple[LoadedState, ...]:
    """States near all rows with currents, and the ones without that differences and inductances need, each once."""
    found: dict[LoadedState, None] = {}
    for table in tables:
        found |= dict.fromkeys(_states_of(design, table))
    if found:  # a bench with currents may be asked for a short circuit next
        found |= dict.fromkeys(_of_inductance(design))
    return tuple(found)


def _of_inductance(design: MachineAsBuilt) -> list[LoadedState]:
    return [LoadedState(_on_grid(angle), (0.0, 0.0, 0.0)) for angle in load_angles(design)]


def _states_of(design: MachineAsBuilt, table: Table) -> list[LoadedState]:
    if table.kind in _WITH_INDUCTANCE:
        return _of_inductance(design)
    if table.kind not in _WITH_CURRENTS:
        return []
    found = []
    for angle, currents in zip(table.conditions["angle_mech"], phase_currents(table.conditions)):
        a, b, c = map(_few_digits, currents)
        found.append(LoadedState(_on_grid(angle), (a, b, c)))
        if table.kind != "locked_rotor":
            found.append(LoadedState(_on_grid(angle), (0.0, 0.0, 0.0)))
    return found


def beyond_states(surrogate: Surrogate, design: MachineAsBuilt, tables: Sequence[Table]) -> float:
    """Mean angle by which the rotor stands beyond the solved states in rows with currents, their conditions true [rad]:
    what a design and the error of an encoder make together no derivative at the drawing knows."""
    rows = [table.conditions for table in tables if table.kind in _WITH_CURRENTS]
    apart = [surrogate.beyond_states(at["angle_mech"] - design.rotor_turn, phase_currents(at)) for at in rows]
    return float(np.mean(np.concatenate(apart))) if apart else 0.0


def _on_grid(angle: float) -> float:
    """A whole degree of the revolution where one is near enough, else between two; never farther than that [rad]."""
    whole = round(angle / DEGREE)
    near = abs(angle - whole * DEGREE) <= _TO_WHOLE_DEGREES
    return (whole if near else floor(angle / DEGREE) + 0.5) % 360 * DEGREE


def _few_digits(current: float) -> float:
    two = float(f"{current:.1e}")
    return two if abs(two - current) <= _TWO_DIGITS_WITHIN * abs(current) else float(f"{current:.2e}")
