"""The uncertainty of the headline numbers: what mesh, fit and tolerance contribute to each.

Method of the GUM (JCGM 100:2008): first order, independent contributions, relative to the value,

    u = sqrt(u_mesh^2 + u_fit^2 + u_tolerance^2),    U = k u with k = 2, about 95 %

mesh: the bound of ``magnetostatics.mesh_error``, by triangles of half the size, uniform, over sqrt(3). fit: from
matches of fits drawn by lot within their held-out residuals; the wound machine is drawn and solved again, so that no
fit is left in its numbers. tolerance: each +-a uniform, over sqrt(3), times the derivative. Not in it: what the model
itself leaves out (ends, friction, material data, films of air), which "How far to trust the numbers" in the README
speaks of.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot, sqrt

import numpy as np

from drivetrain.match import Match
from drivetrain.outcome import Outcome
from electrical.winding_stage import WindingOutcome
from thermal.stage import HeatOutcome
from uncertainty.match_spread import DrawnMatch, MatchSpread
from uncertainty.tolerance_stage import ToleranceOutcome

COVERAGE = 2.0  # k, of the expanded uncertainty


@dataclass(frozen=True)
class Uncertain:
    """A number with its standard uncertainties.

    value: [SI]; mesh, fit, tolerance: relative to it
    """

    value: float
    mesh: float
    fit: float
    tolerance: float

    @property
    def combined(self) -> float:
        """u, relative."""
        return hypot(self.mesh, self.fit, self.tolerance)

    @property
    def expanded(self) -> float:
        """U = 2 u, relative; the value lies within it with about 95 %."""
        return COVERAGE * self.combined


@dataclass(frozen=True)
class Budget:
    """The headline numbers, SI.

    Of the match: torque_nominal, torque_overload: per length, of the fitted cross-section [Nm/m];
    transmission_ratio [m/rad or 1]; matched_length: active length [m]; matched_mass: motor and gears [kg]
    Of the wound machine: peak_torque, continuous_torque: at the current densities [Nm]; torque_constant: no load
    [Nm/A]; resistance: of a phase [ohm]; inductance_d, inductance_q: incremental, no load [H]; base_speed [rad/s];
    cogging: from peak to peak, magnets alike [Nm]; copper_loss: at the continuous torque [W]; mass: active parts [kg]
    needed_length: active length that the peak torque is given with [m]
    Of the actuator: peak_effort: at rest [N or Nm]; continuous_effort: of the temperatures, turning slowly [N or Nm]
    """

    torque_nominal: Uncertain
    torque_overload: Uncertain
    transmission_ratio: Uncertain
    matched_length: Uncertain
    matched_mass: Uncertain
    peak_torque: Uncertain
    continuous_torque: Uncertain
    torque_constant: Uncertain
    resistance: Uncertain
    inductance_d: Uncertain
    inductance_q: Uncertain
    base_speed: Uncertain
    cogging: Uncertain
    copper_loss: Uncertain
    mass: Uncertain
    needed_length: Uncertain
    peak_effort: Uncertain
    continuous_effort: Uncertain


def budget_of(
    found: ToleranceOutcome,
    spread: MatchSpread,
    chosen: Match,
    winding: WindingOutcome,
    outcome: Outcome,
    heat: HeatOutcome,
) -> Budget:
    """All headline numbers of a design; chosen: its match by the fits as they are."""

    def wound(quantity: str, value: float | None = None) -> Uncertain:
        return of_wound(found, quantity, value)

    return Budget(
        torque_nominal=of_match(spread, chosen.section.torque_per_length_nominal, lambda one: one.torque_nominal),
        torque_overload=of_match(spread, chosen.section.torque_per_length_overload, lambda one: one.torque_overload),
        transmission_ratio=of_match(spread, chosen.transmission_ratio, lambda one: one.transmission_ratio),
        matched_length=of_match(spread, chosen.active_length, lambda one: one.active_length),
        matched_mass=of_match(spread, chosen.cost.mass, lambda one: one.total_mass),
        peak_torque=wound("peak_torque"),
        continuous_torque=wound("continuous_torque"),
        torque_constant=wound("magnet_flux", winding.chosen.no_load_torque_constant),
        resistance=wound("resistance"),
        inductance_d=wound("inductance_d"),
        inductance_q=wound("inductance_q"),
        base_speed=wound("base_speed"),
        cogging=wound("cogging"),
        copper_loss=wound("copper_loss"),
        mass=wound("mass"),
        needed_length=wound("peak_torque", winding.wound.active_length),
        peak_effort=wound("peak_torque", outcome.features.effort_peak),
        continuous_effort=_continuous(found, float(heat.effort(heat.slow.torque))),
    )


def of_wound(found: ToleranceOutcome, quantity: str, value: float | None = None) -> Uncertain:
    """A quantity of the wound machine, or what is proportional to it or to its inverse; value: of that [SI]."""
    own = float(getattr(found.values, quantity))
    mesh = float(getattr(found.mesh, quantity)) / sqrt(3)
    return Uncertain(own if value is None else value, mesh, 0.0, found.standard(quantity))


def of_match(spread: MatchSpread, value: float, read: Callable[[DrawnMatch], float]) -> Uncertain:
    """A number of the match, by what each source alone makes of it; value, read: [SI]."""
    return Uncertain(value, *(scatter_of(some, read) for some in (spread.mesh, spread.fit, spread.tolerance)))


def scatter_of(draws: Sequence[DrawnMatch | None], read: Callable[[DrawnMatch], float]) -> float:
    """Standard deviation over the mean of the draws that have a match, dimensionless; read: a number, [any unit]."""
    values = np.array([read(one) for one in draws if one is not None])
    return float(values.std(ddof=1) / values.mean())


def _continuous(found: ToleranceOutcome, value: float) -> Uncertain:
    """What the same heat in the copper allows: T ~ P^(e/2); value [N or Nm].

    With the losses in iron and magnets as they are, for it turns slowly.
    """
    share, loss = found.elasticity / 2, of_wound(found, "copper_loss")
    return Uncertain(value, share * loss.mesh, 0.0, share * loss.tolerance)
