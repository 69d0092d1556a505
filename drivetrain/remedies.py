"""What would make a requirement hold that does not: one input moved alone, as little as will do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from drivetrain.asked import Check, Requirement
from drivetrain.capability import ActuatorDesign, Values, together
from drivetrain.output import Output

LEVER_RANGE = 3.0  # a lever is moved to a third of its value or to three times it, not further
_STEPS = 4  # between which the bisection starts
_BISECTIONS = 7  # of a lever: its value to 0.2 %


@dataclass(frozen=True)
class Lever:
    """An input that can be moved; the concrete ones are below and state its unit."""

    def value(self, design: ActuatorDesign) -> Values:
        """Its present value [unit of the lever, SI]."""
        raise NotImplementedError

    def moved(self, design: ActuatorDesign, value: Values) -> ActuatorDesign:
        """The design with another value [unit of the lever, SI], a batch of designs for several."""
        raise NotImplementedError

    def name(self) -> str:
        """In words."""
        raise NotImplementedError

    def unit(self, output: Output) -> str:
        """Drawing unit, a key of ``units.FACTORS`` or empty."""
        raise NotImplementedError


@dataclass(frozen=True)
class ActiveLengthLever(Lever):
    """Active length; value: [m]."""

    def value(self, design: ActuatorDesign) -> Values:
        return design.active_length

    def moved(self, design: ActuatorDesign, value: Values) -> ActuatorDesign:
        return replace(design, active_length=value)

    def name(self) -> str:
        return "active length"

    def unit(self, output: Output) -> str:
        return "mm"


@dataclass(frozen=True)
class TransmissionLever(Lever):
    """Transmission ratio; value: [m/rad or 1]."""

    def value(self, design: ActuatorDesign) -> Values:
        return design.transmission_ratio

    def moved(self, design: ActuatorDesign, value: Values) -> ActuatorDesign:
        return replace(design, transmission_ratio=value)

    def name(self) -> str:
        return "transmission ratio"

    def unit(self, output: Output) -> str:
        return output.ratio_unit


@dataclass(frozen=True)
class VoltageLever(Lever):
    """Bus voltage; value: [V]."""

    def value(self, design: ActuatorDesign) -> Values:
        return design.dc_voltage

    def moved(self, design: ActuatorDesign, value: Values) -> ActuatorDesign:
        return replace(design, dc_voltage=value)

    def name(self) -> str:
        return "bus voltage"

    def unit(self, output: Output) -> str:
        return "V"


@dataclass(frozen=True)
class TurnsLever(Lever):
    """Turns of the equivalent star at constant copper: the current grows as they fall; value: dimensionless."""

    def value(self, design: ActuatorDesign) -> Values:
        return design.turns

    def moved(self, design: ActuatorDesign, value: Values) -> ActuatorDesign:
        return replace(design, turns=value, strands=design.turns * design.strands / value)

    def name(self) -> str:
        return "turns in series, at the same copper"

    def unit(self, output: Output) -> str:
        return ""


LEVERS: tuple[Lever, ...] = (ActiveLengthLever(), TransmissionLever(), VoltageLever(), TurnsLever())
DIRECT_DRIVE_LEVERS: tuple[Lever, ...] = (ActiveLengthLever(), VoltageLever(), TurnsLever())  # its ratio stays 1


@dataclass(frozen=True)
class Remedy:
    """The smallest move of one lever that makes a failing requirement hold, and what would fail then.

    now: present value [unit of the lever, SI]
    value: [unit of the lever, SI], None where the lever does not reach it within ``LEVER_RANGE``
    """

    requirement: Requirement
    lever: Lever
    now: float
    value: float | None
    fails_then: tuple[Requirement, ...] = ()


def remedies(design: ActuatorDesign, checks: Sequence[Check], levers: Sequence[Lever] = LEVERS) -> tuple[Remedy, ...]:
    """For every check that does not hold: each lever alone, in both directions, the smaller move of the two.

    All levers and directions are one batch of designs, so that each step of the search is one envelope.
    """
    holding = [one.requirement for one in checks if one.holds]
    failing = [one.requirement for one in checks if not one.holds]
    return tuple(remedy for one in failing for remedy in _remedies_of(design, one, holding, levers))


def _remedies_of(
    design: ActuatorDesign, requirement: Requirement, holding: Sequence[Requirement], levers: Sequence[Lever]
) -> list[Remedy]:
    now = [float(lever.value(design)) for lever in levers]
    moves = _least_moves(design, requirement, levers)
    found = [k for k, value in enumerate(moves) if value is not None]
    fails = _failing(holding, [levers[k].moved(design, moves[k]) for k in found])
    then = dict(zip(found, fails, strict=True))
    return [Remedy(requirement, lever, now[k], moves[k], then.get(k, ())) for k, lever in enumerate(levers)]


def _failing(requirements: Sequence[Requirement], designs: Sequence[ActuatorDesign]) -> list[tuple[Requirement, ...]]:
    """Which requirements each of the designs does not meet."""
    if not designs:
        return []
    batch = together(designs)
    met = [np.broadcast_to(one.met(one.reached(batch)), len(designs)) for one in requirements]
    return [tuple(one for one, good in zip(requirements, met, strict=True) if not good[k]) for k in range(len(designs))]


def _least_moves(design: ActuatorDesign, requirement: Requirement, levers: Sequence[Lever]) -> list[float | None]:
    """Value of each lever nearest to the present one at which the requirement holds; None where there is none."""
    ways = [(lever, factor) for lever in levers for factor in (LEVER_RANGE, 1 / LEVER_RANGE)]
    shares = _nearest_shares(design, requirement, ways)
    rows = shares.reshape(len(levers), 2)  # share 1: three times or a third, so that the smaller share is nearer
    best = [int(np.argmin(row)) for row in rows]
    return [
        float(lever.value(design) * LEVER_RANGE ** (row[k] if k == 0 else -row[k])) if np.isfinite(row[k]) else None
        for lever, row, k in zip(levers, rows, best, strict=True)
    ]


def _nearest_shares(
    design: ActuatorDesign, requirement: Requirement, ways: Sequence[tuple[Lever, float]]
) -> np.ndarray:
    """Smallest share of each way (lever, factor), value times factor^share, that makes it hold; inf where none does.

    Steps first, then bisection between the last that does not hold and the first that does.
    """
    steps = np.linspace(0, 1, _STEPS + 1)
    holds = _holds(design, requirement, ways, np.tile(steps[1:], (len(ways), 1)))
    reached, first = np.asarray(holds.any(axis=1)), holds.argmax(axis=1)
    low, high = steps[first], steps[first + 1]
    if np.any(reached):
        some = [way for way, good in zip(ways, reached.tolist(), strict=True) if good]
        high[reached] = _bisected(design, requirement, some, low[reached], high[reached])
    return np.where(reached, high, np.inf)


def _bisected(
    design: ActuatorDesign,
    requirement: Requirement,
    ways: Sequence[tuple[Lever, float]],
    low: np.ndarray,
    high: np.ndarray,
) -> np.ndarray:
    """Shares (ways,) at which the requirement just holds, between low, where it does not, and high, where it does."""
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        good = _holds(design, requirement, ways, middle[:, None])[:, 0]
        low, high = np.where(good, low, middle), np.where(good, middle, high)
    return high


def _holds(
    design: ActuatorDesign, requirement: Requirement, ways: Sequence[tuple[Lever, float]], shares: np.ndarray
) -> np.ndarray:
    """Whether the requirement holds at shares (ways, n) of each way."""
    rows = zip(ways, shares, strict=True)
    moved = [lever.moved(design, lever.value(design) * factor**row) for (lever, factor), row in rows]
    met = requirement.met(requirement.reached(together(moved)))
    return np.broadcast_to(met, shares.size).reshape(shares.shape)
