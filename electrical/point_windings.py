"""Windings for a machine of a given length: what each full slot gives at the operating points, and why it will not do.

A winding carries as much as its copper may and as its drive gives. A point is reached where its torque is within the
largest torque at its speed, by that current and the voltage, the field weakened where it must be; torques count less
what the mesh may have put on top. What each winding is valued by is ``electrical.winding_selection``.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import nan, sqrt

import numpy as np

from electrical.dq import DqMachine, mtpa_currents
from electrical.winding_selection import (
    LimitsWithDrive,
    PerTurnMachine,
    Winding,
    WindingError,
    merit,
    speed_at_current,
    torque_at_speed,
)
from units import RPM, percent

# Relative; losses this close compete by their current. Estimate, as ``winding_selection.AS_SHORT``.
AS_LITTLE_LOSS = 0.05
_BISECTIONS = 12  # of a current with weakened field: 2.4e-4 of the full one, less than the map is off by
_HALVINGS = 40  # of the ampere-turns of a torque: to round-off
_SAME = 1e-9  # relative; a torque this close below what is asked meets it
_VISIBLE = 1e-3  # relative; what is closer is called the same
VOLTAGE, LINE_CURRENT, DENSITY, CIRCULATION = "voltage", "line current", "current density", "current round the delta"
# What would help, by what refuses.
_HELP = {
    VOLTAGE: "raise dc_bus_voltage_V in [drive]",
    LINE_CURRENT: "raise line_current_peak_A in [drive]",
    DENSITY: "raise j_overload_rms_A_per_mm2 or packing_factor in [winding_selection]",
    CIRCULATION: "allow star or raise delta_circulating_loss_max in [winding_selection]",
}


@dataclass(frozen=True)
class OperatingPoint:
    """torque: asked of the shaft [Nm]; speed: mechanical [rad/s]"""

    torque: float
    speed: float

    def __str__(self) -> str:
        return f"{self.torque:g} Nm at {self.speed / RPM:g} rpm"


@dataclass(frozen=True)
class Candidate:
    """A full slot and what it gives.

    torques: surely, the largest at the speed of each operating point [Nm]
    needed_current: least peak line current with which every point is reached [A], NaN where one is not
    refused_by: what stands against it, empty where nothing does; refusal: the same in words
    """

    winding: Winding
    torques: tuple[float, ...]
    needed_current: float
    refused_by: str
    refusal: str

    @property
    def copper_loss(self) -> float:
        """At the needed current, with what goes round a delta [W]; NaN where a point is not reached."""
        loss = 1.5 * self.winding.phase_resistance * self.needed_current**2
        return loss * (1 + self.winding.circulating_share)


@dataclass(frozen=True)
class PointValuer:
    """What windings are held to; torque_error: share of the torque that the mesh may have put on top."""

    machine: PerTurnMachine
    limits: LimitsWithDrive
    points: tuple[OperatingPoint, ...]
    torque_error: float

    def candidates(self, windings: tuple[Winding, ...]) -> tuple[Candidate, ...]:
        """Every winding at every point."""
        torques = self.torques(windings)
        asked = np.array([one.torque for one in self.points])
        reached = np.all(torques >= asked * (1 - _SAME), axis=1)
        needed = np.full(len(windings), nan)
        needed[reached] = self._needed_currents(tuple(w for w, yes in zip(windings, reached, strict=True) if yes))
        rows = zip(windings, torques.tolist(), needed.tolist(), strict=True)
        return tuple(self._candidate(one, tuple(found), current) for one, found, current in rows)

    def torques(self, windings: tuple[Winding, ...]) -> np.ndarray:
        """Surely, the largest of each winding at the speed of each point [Nm], (windings, points)."""
        peak = np.array([one.peak_torque for one in windings])
        found = np.repeat(peak[:, None], len(self.points), axis=1)
        for k, point in enumerate(self.points):
            fast = np.array([one.base_speed <= point.speed for one in windings])
            found[fast, k] = self._torque(windings, fast, point.speed)
        return (1 - self.torque_error) * found

    def _torque(self, windings: tuple[Winding, ...], which: np.ndarray, speed: float) -> np.ndarray:
        some = tuple(one for one, yes in zip(windings, which, strict=True) if yes)
        return torque_at_speed(self.machine, self.limits, some, speed) if some else np.empty(0)

    def _needed_currents(self, windings: tuple[Winding, ...]) -> np.ndarray:
        """Of windings that reach every point [A]."""
        if not windings:
            return np.empty(0)
        shares = [self.needed_shares(windings, point) for point in self.points]
        return np.max(shares, axis=0) * np.array([one.current_peak for one in windings])

    def needed_shares(self, windings: tuple[Winding, ...], point: OperatingPoint) -> np.ndarray:
        """Of the full current of each with which it reaches a point, dimensionless (windings,); they must reach it.

        At the best angle where the voltage allows that.
        """
        wanted = point.torque / (1 - self.torque_error)
        turns = np.array([one.design.equivalent_turns for one in windings])
        full = turns * np.array([one.current_peak for one in windings])
        least = least_ampere_turns(self.machine.dq, wanted / windings[0].active_length, float(full.max()))
        slow = speed_at_current(self.machine, self.limits, windings, least) <= point.speed
        shares = np.minimum(least / full, 1.0)
        some = tuple(one for one, yes in zip(windings, slow, strict=True) if yes)
        if some:
            shares[slow] = self._weakened_shares(some, shares[slow], point.speed, wanted)
        return shares

    def _weakened_shares(
        self, windings: tuple[Winding, ...], low: np.ndarray, speed: float, torque: float
    ) -> np.ndarray:
        """Dimensionless (windings,), ``low`` or more; windings that reach the torque [Nm] at the speed [rad/s]."""
        high = np.ones(len(windings))
        for _ in range(_BISECTIONS):
            share = (low + high) / 2
            enough = torque_at_speed(self.machine, self.limits, windings, speed, share) >= torque
            low, high = np.where(enough, low, share), np.where(enough, share, high)
        return high

    def _candidate(self, winding: Winding, torques: tuple[float, ...], needed: float) -> Candidate:
        by, said = self._refusal(winding, torques)
        return Candidate(winding, torques, needed, by, said)

    def _refusal(self, winding: Winding, torques: tuple[float, ...]) -> tuple[str, str]:
        """What stands against a winding, in short and in words."""
        if winding.circulating_share > self.limits.circulating_share:
            return CIRCULATION, f"{CIRCULATION} loses {percent(winding.circulating_share, 1)} of the copper loss"
        worst = min(range(len(torques)), key=lambda k: torques[k] / self.points[k].torque)
        asked, found = self.points[worst], torques[worst]
        if found >= asked.torque * (1 - _SAME):
            return "", ""
        by = self._limit(winding, asked)
        return by, f"{by}: {found:.4g} Nm, asked are {asked}"

    def _limit(self, winding: Winding, point: OperatingPoint) -> str:
        """What keeps a winding from a point: the voltage where its full current gives the torque at rest."""
        if (1 - self.torque_error) * winding.peak_torque >= point.torque * (1 - _SAME):
            return VOLTAGE
        density = winding.current_rms * winding.design.equivalent_turns / winding.design.copper_area
        return DENSITY if density >= self.limits.overload_current_density * (1 - _SAME) else LINE_CURRENT


def least_ampere_turns(machine: DqMachine, torque: float, most: float) -> float:
    """Peak of one coil that gives a torque per metre [Nm/m] at the best angle [A]; most: that gives it, too [A]."""
    low, high = 0.0, most
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        enough = float(machine.torque(*mtpa_currents(machine, middle))) >= torque
        low, high = (low, middle) if enough else (middle, high)
    return high


def chosen_candidate(candidates: tuple[Candidate, ...], points: tuple[OperatingPoint, ...]) -> Candidate:
    """Of those that nothing refuses, the ones with the least copper loss and up to ``AS_LITTLE_LOSS`` more compete;
    the lowest needed line current wins, of equal currents the fullest copper, then fewest paths, star before delta,
    fewest wires.

    Raises WindingError where every candidate is refused.
    """
    competing = competitors(candidates)
    if not competing:
        raise WindingError(none_will_do(candidates, points))
    return min(competing, key=_merit)


def competitors(candidates: tuple[Candidate, ...]) -> tuple[Candidate, ...]:
    """Those that nothing refuses and that lose about the least."""
    allowed = [one for one in candidates if not one.refused_by]
    least = min((one.copper_loss for one in allowed), default=nan)
    return tuple(one for one in allowed if one.copper_loss <= least * (1 + AS_LITTLE_LOSS))


def best_of_each_kind(candidates: tuple[Candidate, ...], points: tuple[OperatingPoint, ...]) -> tuple[Candidate, ...]:
    """What would be wound of each gauge and connection; where nothing would, what comes nearest to the points."""
    kinds: dict[object, list[Candidate]] = {}
    for one in candidates:
        kinds.setdefault((one.winding.design.wire, one.winding.design.connection), []).append(one)
    return tuple(_best(tuple(group), points) for group in kinds.values())


def _best(candidates: tuple[Candidate, ...], points: tuple[OperatingPoint, ...]) -> Candidate:
    return min(competitors(candidates), key=_merit, default=nearest(candidates, points))


def nearest(candidates: tuple[Candidate, ...], points: tuple[OperatingPoint, ...]) -> Candidate:
    """The one with the most torque at the point that it misses by most."""
    return max(candidates, key=lambda one: min(t / point.torque for t, point in zip(one.torques, points, strict=True)))


def counts(candidates: tuple[Candidate, ...]) -> dict[str, int]:
    """How many each limit refuses, those that it does."""
    found = {by: sum(one.refused_by == by for one in candidates) for by in _HELP}
    return {by: number for by, number in found.items() if number}


def none_will_do(candidates: tuple[Candidate, ...], points: tuple[OperatingPoint, ...]) -> str:
    """Why, what comes nearest, and what would help."""
    near = nearest(candidates, points)
    refused = ", ".join(f"{number} by {by}" for by, number in counts(candidates).items())
    return (
        f"none of {len(candidates)} windings with full slots will do ({refused}); the nearest, {near.winding.design}, "
        f"is refused by {near.refusal}: {_HELP[near.refused_by]} or ask for less in [[operating_points]]"
    )


def _merit(one: Candidate) -> tuple[float, ...]:
    return merit(one.winding.design, one.needed_current)


def needed_density(one: Candidate) -> float:
    """RMS current density in the copper at the needed current [A/m^2]."""
    design = one.winding.design
    return one.needed_current / sqrt(2) * design.equivalent_turns / design.copper_area


def verdict(one: Candidate, candidates: tuple[Candidate, ...], chosen: Candidate | None) -> str:
    """What stands against a candidate, or what the chosen one has over it."""
    if one == chosen:
        return "chosen"
    if one.refused_by or chosen is None:
        return one.refusal or "reaches every point"
    least = min(other.copper_loss for other in candidates if not other.refused_by)
    lossier, more = one.copper_loss / least - 1, one.needed_current / chosen.needed_current - 1
    if lossier > AS_LITTLE_LOSS:
        return f"{percent(lossier, 1)} more copper loss than the least"
    if more > _VISIBLE:
        return f"{percent(more, 1)} more current"
    if one.winding.packing < chosen.winding.packing * (1 - _VISIBLE):
        return "as much current, less copper"
    return "as good, with more paths, wires or in delta"
