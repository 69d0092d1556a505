"""The kinds of measurement on the bench of a drawn machine; ``model`` lists their columns."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from math import pi, sqrt

import numpy as np

from effects.base import Columns
from effects.dq_design import DqMachine
from electrical.bicubic import Bicubics
from workbench.errors import WorkbenchError
from workbench.models.by_fundamental import PHASES, Drag, Found, by_its_fundamental, by_phase, phase_currents
from workbench.models.drawn.answers import Answers

_STILL = 1e-9  # rad/s
_LEAST_TORQUE = 1e-9  # Nm, where nothing is to be held
_SMALL = 1.0  # A between lines, of an inductance where the table has no current
_SHARES = (-1.0, -0.55, -0.25, 0.0, 0.25, 0.55, 1.0)  # of the largest current of a map


def _back_emf(answers: Answers, at: Columns) -> Found:
    """v = speed d psi/d angle over an angle; without one RMS: of a phase's fundamental, between lines of all orders."""
    if "angle_mech" in at:
        slopes = answers.linkage_slopes(at["angle_mech"]) * at["speed"][:, None]
        return by_phase("v", slopes)
    orders = np.arange(len(answers.waves))
    each = answers.design.machine.pole_pairs * orders * np.abs(answers.waves)
    between = each * np.abs(1 - np.exp(-2j * pi / 3 * orders))
    speed = np.abs(at["speed"])
    found = {f"v_{x}": speed * each[1] / sqrt(2.0) for x in PHASES}
    return found | {"v_ll": speed * np.linalg.norm(between) / sqrt(2.0)}


def _cogging(answers: Answers, at: Columns) -> Found:
    none = np.zeros((len(at["angle_mech"]), 3))
    return {"torque": answers.torque(at["angle_mech"], none) + lost_torque(answers, at)}


def _locked_rotor(answers: Answers, at: Columns) -> Found:
    return {"torque": answers.torque(at["angle_mech"], phase_currents(at)) + lost_torque(answers, at)}


def _flux_linkage(answers: Answers, at: Columns) -> Found:
    change = answers.linkage_change(at["angle_mech"], phase_currents(at))
    whole = change + answers.magnet_linkage(at["angle_mech"])
    return by_phase("dpsi", change) | by_phase("psi", whole)


def _inductance(answers: Answers, at: Columns) -> Found:
    """Change of flux linkage over current: of phase A fed alone, its mutual one, and between two lines in series.

    A delta has no phase that can be fed alone.
    """
    angle = at["angle_mech"]
    current = at.get("current", np.full(len(angle), _SMALL))

    def per_current(fed: tuple[int, int, int]) -> np.ndarray:
        return answers.alternating_change(angle, np.outer(current, fed)) / current[:, None]

    found = {}
    if not answers.design.drawing.is_delta:
        alone = per_current((1, 0, 0))
        found = {"l_a": alone[:, 0], "l_m": alone[:, 1]}
    for name, fed in (("l_ab", (1, -1, 0)), ("l_bc", (0, 1, -1)), ("l_ca", (-1, 0, 1))):
        found[name] = per_current(fed) @ np.array(fed)
    return found


def _holding_current(answers: Answers, at: Columns) -> Found:
    """Peak current of a line along the q axis that leaves no torque on the rotor, friction included.

    From the torque at none and at both signs of the largest that a machine without reluctance would need, a parabola.
    """
    angle = at["angle_mech"]
    idle = answers.turning_torque(angle, 0.0) + lost_torque(answers, at)
    psi = abs(answers.waves[1])
    if not psi:
        raise WorkbenchError("a driver holds a rotor with magnets; this one has none: remove the holding_current")
    size = max(float(np.abs(idle).max()), _LEAST_TORQUE) / (1.5 * answers.design.machine.pole_pairs * psi)
    ahead, behind = (answers.turning_torque(angle, sign * size) + lost_torque(answers, at) for sign in (1.0, -1.0))
    slope, bend = (ahead - behind) / 2, (ahead + behind) / 2 - idle
    share = -2 * idle / (slope * (1 + np.sqrt(1 - 4 * bend * idle / slope**2)))
    return {"current": size * share}


def _phase_resistance(answers: Answers, at: Columns) -> Found:
    """Of each phase, their mean, and between two of them."""
    each = answers.resistances(at)
    lines = {f"r_{x}": each[:, k] + each[:, (k + 1) % 3] for k, x in enumerate(("ab", "bc", "ca"))}
    return {"resistance": answers.resistance(at)} | by_phase("r", each) | lines


def _drag(answers: Answers, at: Columns) -> Found:
    """Torque on the rotor, and the power that its drive gives."""
    torque = lost_torque(answers, at)
    return {"torque": torque, "power": -torque * at["speed"]}


def lost_torque(answers: Answers, at: Columns) -> np.ndarray:
    """Torque on the rotor against its motion [Nm] (n,), zero where neither speed nor direction is known.

    Where only a column ``direction`` is known (+1, -1) the rotor creeps: dry friction and hysteresis alone.
    """
    d, none = answers.design, np.zeros(len(next(iter(at.values()))))
    speed = at.get("speed", none)
    size, sign = np.abs(speed), np.sign(at.get("direction", speed))
    brake = d.dry_friction + d.viscous_friction * size + d.windage * size**2
    if d.iron_loss is not None and sign.any():
        loss, pairs = answers.iron_loss, d.machine.pole_pairs
        frequency = pairs * np.maximum(size, _STILL) / (2 * pi)
        brake = brake + pairs / (2 * pi) * loss.at(frequency) / frequency
    return -sign * (brake + answers.circulating_loss(speed) / np.maximum(size, _STILL))


# ---- by the fundamental ----------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class FluxMap:
    """Flux linkages beyond those of constant inductances, as a law of the dq machine; beyond the map they go on with
    the slope at its edge."""

    psi: Bicubics
    largest: float

    def flux(self, i_d: np.ndarray, i_q: np.ndarray, machine: DqMachine) -> tuple[np.ndarray, np.ndarray]:
        """psi_d and psi_q [Vs] at currents [A]."""
        d, q = (np.clip(i, -self.largest, self.largest) for i in (i_d, i_q))
        direct, quadrature = self.psi(d, q) + np.einsum("ij...,j...->i...", self.psi.slopes(d, q), [i_d - d, i_q - q])
        return direct, quadrature


def dq_machine(answers: Answers) -> DqMachine:
    """The machine by its fundamental, with the flux linkages of the field at every current on its bench."""
    largest = answers.design.largest_current
    if not (answers.design.phase_resistance and largest):
        raise WorkbenchError("currents at speed need phase_resistance and largest_current: give them in [device]")
    largest *= answers.expansion.drawn_turns / answers.design.turns  # the ampere-turns of the drawing
    axis = largest * np.array(_SHARES)
    psi = _map(answers, axis)
    none = len(axis) // 2
    psi_m = float(psi[none, none, 0])
    l_d = float((psi[-1, none, 0] - psi[0, none, 0]) / (2 * largest))
    l_q = float((psi[none, -1, 1] - psi[none, 0, 1]) / (2 * largest))
    left = psi - np.stack([psi_m + l_d * axis[:, None] + 0 * axis, l_q * axis + 0 * axis[:, None]], axis=2)
    law = FluxMap(Bicubics.through(axis, axis, np.moveaxis(left, 2, 0)), largest)
    machine = DqMachine(answers.design.machine.pole_pairs, psi_m, l_d, l_q, answers.design.phase_resistance)
    machine = machine.with_flux(law).with_torque(Drag(partial(lost_torque, answers)))
    return machine.with_brake(_loaded_delta(answers, axis)) if answers.design.drawing.is_delta else machine


def _map(answers: Answers, axis: np.ndarray) -> np.ndarray:
    """psi_d, psi_q (k, k, 2) over i_d and i_q; psi_d is even in i_q, psi_q odd."""
    half = axis[axis >= 0]
    i_d, i_q = (values.ravel() for values in np.meshgrid(axis, half, indexing="ij"))
    found = answers.mean_dq(i_d, i_q).reshape(len(axis), len(half), 2)
    found[:, 0, 1] = 0.0
    found = found + answers.design.end_winding_inductance * np.stack([i_d, i_q], axis=1).reshape(found.shape)
    return np.concatenate([found[:, :0:-1] * np.array([1.0, -1.0]), found], axis=1)


@dataclass(frozen=True, eq=False)
class LoadedDelta:
    """What load adds to the loss of the current round a delta, as a brake of the dq machine.

    Between the currents of the map within 10 % of the loss where that is well above idle, within 30 % deep in
    saturation.
    waves: real and imaginary parts of all orders, over i_d and the size of i_q [Wb]; beyond the largest current [A]
    they stay as they are there;  idle: squares of the amplitudes without current [Wb^2] (orders,)
    """

    answers: Answers
    waves: Bicubics
    idle: np.ndarray
    largest: float

    def lost_torque(self, speed: np.ndarray, i_d: np.ndarray, i_q: np.ndarray) -> np.ndarray:
        """See ``BrakeLaw``."""
        d, q = np.clip(i_d, -self.largest, self.largest), np.minimum(np.abs(i_q), self.largest)
        real, imaginary = np.split(self.waves(d, q), 2)
        squares = (real**2 + imaginary**2).T
        loss = self.answers.loss_round_delta(speed, self.answers.common_orders, squares - self.idle)
        return np.asarray(loss * np.sign(speed) / np.maximum(np.abs(speed), _STILL))


def _loaded_delta(answers: Answers, axis: np.ndarray) -> LoadedDelta:
    half = axis[axis >= 0]
    i_d, i_q = (values.ravel() for values in np.meshgrid(axis, half, indexing="ij"))
    waves = answers.common_waves(i_d, i_q).reshape(len(axis), len(half), -1)
    parts = np.moveaxis(np.concatenate([waves.real, waves.imag], axis=2), 2, 0)
    idle = np.abs(waves[len(axis) // 2, 0]) ** 2
    return LoadedDelta(answers, Bicubics.through(axis, half, parts), idle, float(axis[-1]))


KINDS: Mapping[str, Callable[[Answers, Columns], Found]] = {
    "back_emf": _back_emf,
    "cogging": _cogging,
    "locked_rotor": _locked_rotor,
    "flux_linkage": _flux_linkage,
    "inductance": _inductance,
    "holding_current": _holding_current,
    "phase_resistance": _phase_resistance,
    "drag": _drag,
    **{
        kind: by_its_fundamental(kind, dq_machine, Answers.resistance)
        for kind in ("dq_supply", "dq_operation", "dyno_map", "no_load")
    },
}
