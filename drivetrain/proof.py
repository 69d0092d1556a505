"""Why no design holds everything: bounds that are true wherever the levers stand.

What a requirement reaches is never better than a ceiling, a constant times powers of the levers:

    PeakEffortAtRest   F  = T' l / tau_t
    PeakEffort         F <= T' l / tau_t,   F v <= 3/2 (U / sqrt(3)) sqrt(2) I      power of bus and current
    PeakPower          the same times v
    ContinuousEffort   F <= F_0 lambda / lambda_0,  F <= F_0 sqrt(lambda / lambda_0),  over tau_t
    LowSpeedDamping    c  = k l^2 / (l + l_et) / tau_t^2
    ControlledDamping  c <= T' l / (tau_t v)
    RotorSpeed         omega = v / tau_t;   PhaseCurrent  I ~ 1/N at the same copper;   ActiveLength  l
    EquivalentMass     m  = (J' l + J_g) / tau_t^2

T': largest torque per length at the overload ampere-turns, at any current angle. A sum a + b l is no power of l, but
over logarithms it is convex, so that each of its tangents is one below it. With x the logarithms of the levers over
their present values every ceiling is a plane, and

    the largest t with   ln(ceiling / needed) >= t   for all,   |x| <= ln ``LEVER_RANGE``

is a linear programme. Where t < 0 no design of the range holds all requirements, and the least margin is at most
exp(t) - 1; its multipliers say which contradict each other. Where t >= 0 nothing is proved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import singledispatch
from math import exp, log, sqrt

import numpy as np
from scipy.optimize import linprog

from drivetrain.asked import (
    ActiveLength,
    ContinuousEffort,
    ControlledDamping,
    EquivalentMass,
    LowSpeedDamping,
    PeakEffort,
    PeakEffortAtRest,
    PeakPower,
    PhaseCurrent,
    Requirement,
    RotorSpeed,
)
from drivetrain.capability import ActuatorDesign
from drivetrain.remedies import (
    LEVER_RANGE,
    ActiveLengthLever,
    Lever,
    TransmissionLever,
    TurnsLever,
    VoltageLever,
)
from electrical.dq import mtpa_currents

LENGTH, RATIO, VOLTAGE, TURNS = ActiveLengthLever(), TransmissionLever(), VoltageLever(), TurnsLever()
_PROVED = 1e-6  # of a logarithm, below zero, beyond the rounding of the linear programme
_SHARE = 1e-6  # multiplier from which a requirement takes part
_ANCHORS = LEVER_RANGE ** np.linspace(-1, 1, 9)  # lengths over the present one at which a sum has its tangents


@dataclass(frozen=True)
class Ceiling:
    """What a requirement reaches at best: at most ``best`` [unit of the demand, SI] times the powers of the levers'
    values over their present ones; at least so much where the requirement is an upper limit.

    powers: of each lever that moves it
    """

    best: float
    powers: tuple[tuple[Lever, float], ...] = ()


@dataclass(frozen=True)
class Impossibility:
    """A proof that no design of the range holds all requirements.

    requirements: that contradict each other; shortfall: by which one of them is missed at least, relative
    """

    requirements: tuple[Requirement, ...]
    shortfall: float


def impossibility(
    design: ActuatorDesign, requirements: Sequence[Requirement], levers: Sequence[Lever]
) -> Impossibility | None:
    """The proof, None where the bounds leave room; that is no proof that a design exists."""
    rows = [(one, ceiling) for one in requirements if one.needed for ceiling in ceilings(one, design)]
    if not rows:
        return None
    planes, heights = _planes(rows, levers)
    found = linprog(
        np.append(np.zeros(len(levers)), -1.0),
        A_ub=np.column_stack([-planes, np.ones(len(rows))]),
        b_ub=heights,
        bounds=[(-log(LEVER_RANGE), log(LEVER_RANGE))] * len(levers) + [(None, None)],
    )
    least = float(found.x[-1])
    if least > -_PROVED:
        return None
    taking_part = [one for (one, _), share in zip(rows, found.ineqlin.marginals, strict=True) if -share > _SHARE]
    return Impossibility(tuple(dict.fromkeys(taking_part)), 1 - exp(least))


def _planes(rows: Sequence[tuple[Requirement, Ceiling]], levers: Sequence[Lever]) -> tuple[np.ndarray, np.ndarray]:
    """Slopes (rows, levers) and heights (rows,) of ln(ceiling / needed), of ln(needed / ceiling) for an upper limit."""
    signs = np.array([-1.0 if one.at_most else 1.0 for one, _ in rows])
    slopes = np.array([[dict(ceiling.powers).get(lever, 0.0) for lever in levers] for _, ceiling in rows])
    heights = np.array([log(ceiling.best / one.needed) for one, ceiling in rows])
    return signs[:, None] * slopes, signs * heights


# ---- what each requirement reaches at best --------------------------------------------------------------------------


@singledispatch
def ceilings(requirement: Requirement, design: ActuatorDesign) -> tuple[Ceiling, ...]:
    """The ceilings of a requirement at a design; none where nothing is known, which proves nothing."""
    return ()


@ceilings.register
def _(requirement: PeakEffortAtRest, design: ActuatorDesign) -> tuple[Ceiling, ...]:
    return (Ceiling(float(design.peak_torque / design.transmission_ratio), ((LENGTH, 1.0), (RATIO, -1.0))),)


@ceilings.register
def _(requirement: PeakEffort, design: ActuatorDesign) -> tuple[Ceiling, ...]:
    turning = _largest_effort(design)
    return turning if not requirement.speed else (*turning, _times(_largest_power(design), 1 / requirement.speed))


@ceilings.register
def _(requirement: PeakPower, design: ActuatorDesign) -> tuple[Ceiling, ...]:
    return (*(_times(one, requirement.speed) for one in _largest_effort(design)), _largest_power(design))


@ceilings.register
def _(requirement: ContinuousEffort, design: ActuatorDesign) -> tuple[Ceiling, ...]:
    longer = float(design.active_length) / design.rated_length
    now = design.continuous_torque / float(design.transmission_ratio)
    return tuple(Ceiling(now * longer**power, ((LENGTH, power), (RATIO, -1.0))) for power in (1.0, 0.5))


@ceilings.register
def _(requirement: LowSpeedDamping, design: ActuatorDesign) -> tuple[Ceiling, ...]:
    now, length, ends = float(design.low_speed_damping), float(design.active_length), design.end_turn_length
    sums = _tangents(length, ends)  # l + l_et over its present value
    return tuple(Ceiling(now / factor, ((LENGTH, 2.0 - power), (RATIO, -2.0))) for factor, power in sums)


@ceilings.register
def _(requirement: ControlledDamping, design: ActuatorDesign) -> tuple[Ceiling, ...]:
    return tuple(_times(one, 1 / requirement.speed) for one in _largest_effort(design))


@ceilings.register
def _(requirement: RotorSpeed, design: ActuatorDesign) -> tuple[Ceiling, ...]:
    return (Ceiling(requirement.speed / float(design.transmission_ratio), ((RATIO, -1.0),)),)


@ceilings.register
def _(requirement: PhaseCurrent, design: ActuatorDesign) -> tuple[Ceiling, ...]:
    return (Ceiling(float(design.phase_current_rms), ((TURNS, -1.0),)),)


@ceilings.register
def _(requirement: ActiveLength, design: ActuatorDesign) -> tuple[Ceiling, ...]:
    return (Ceiling(float(design.active_length), ((LENGTH, 1.0),)),)


@ceilings.register
def _(requirement: EquivalentMass, design: ActuatorDesign) -> tuple[Ceiling, ...]:
    rotor = design.rotor_inertia_per_length * float(design.active_length)
    sums, now = _tangents(rotor, design.gearbox_inertia), float(design.equivalent_mass)
    return tuple(Ceiling(now * factor, ((LENGTH, power), (RATIO, -2.0))) for factor, power in sums)


def _largest_effort(design: ActuatorDesign) -> tuple[Ceiling, ...]:
    """Of the overload ampere-turns at the best current angle, whatever the voltage [N or Nm]."""
    one = design.per_turn
    currents = mtpa_currents(one, design.phase_current_rms * sqrt(2) * design.turns)
    torque = float(np.squeeze(one.torque(*currents))) * float(design.active_length)
    return (Ceiling(torque / float(design.transmission_ratio), ((LENGTH, 1.0), (RATIO, -1.0))),)


def _largest_power(design: ActuatorDesign) -> Ceiling:
    """3/2 (U / sqrt(3)) sqrt(2) I [W]: what bus and overload current put in, of which losses only take away."""
    best = 1.5 * float(design.dc_voltage) / sqrt(3) * sqrt(2) * float(design.phase_current_rms)
    return Ceiling(best, ((VOLTAGE, 1.0), (TURNS, -1.0)))


def _times(one: Ceiling, factor: float) -> Ceiling:
    return Ceiling(one.best * factor, one.powers)


def _tangents(growing: float, constant: float) -> list[tuple[float, float]]:
    """(factor, power): factor lambda^power <= (growing lambda + constant) / (growing + constant) for every lambda.

    growing, constant: of one unit [any]
    """
    total = growing + constant
    sums = growing * _ANCHORS + constant
    powers = growing * _ANCHORS / sums
    return list(zip((sums / total / _ANCHORS**powers).tolist(), powers.tolist(), strict=True))
