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

from drivetrain.asked import LowSpeedDamping, Requirement
from drivetrain.match import Match
from drivetrain.outcome import Outcome
from electrical.braking_stage import BrakingOutcome
from electrical.winding_stage import WindingOutcome
from losses.map import PowerLosses
from losses.stage import LossMap
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
    needed_length: active length that the peak torque asks for, the first of the needs [m]
    power_at_base_speed: at the peak torque [W]; rated_speed [rad/s]; rated_power: continuous torque at that speed [W]
    iron_loss: of the stator, losses: all [W], efficiency: at the rated point; None without loss data. The mesh of the
        iron loss is not bounded
    loaded_constant: torque constant at the overload current [Nm/A]; continuous_current: RMS, of the temperatures [A]
    short_circuit_current: peak [A], braking_torque [Nm], braking_speed: of it, cold [rad/s]: with shorted phases, by
        psi_m / L_d, psi_m^2 / L_q and R / L_q
    Of the actuator: peak_effort: at rest [N or Nm]; continuous_effort: of the temperatures, turning slowly [N or Nm];
    low_speed_damping: short-circuited [Ns/m or Nms/rad]
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
    power_at_base_speed: Uncertain
    rated_speed: Uncertain
    rated_power: Uncertain
    iron_loss: Uncertain | None
    losses: Uncertain | None
    efficiency: Uncertain | None
    loaded_constant: Uncertain
    continuous_current: Uncertain
    short_circuit_current: Uncertain
    braking_torque: Uncertain
    braking_speed: Uncertain
    peak_effort: Uncertain
    continuous_effort: Uncertain
    low_speed_damping: Uncertain


def budget_of(
    found: ToleranceOutcome,
    spread: MatchSpread,
    chosen: Match,
    winding: WindingOutcome,
    outcome: Outcome,
    heat: HeatOutcome,
    braking: BrakingOutcome,
    losses: LossMap | None,
) -> Budget:
    """All headline numbers of a design; chosen: its match by the fits as they are; losses: None without loss data."""

    def wound(quantity: str, value: float | None = None) -> Uncertain:
        return of_wound(found, quantity, value)

    def product(value: float, **powers: float) -> Uncertain:
        return of_product(found, value, **powers)

    shorted, values, speed = braking.shorted, found.values, found.rated_speed
    moves = float(speed == winding.chosen.base_speed)  # where the largest speed that is allowed is lower, it is exact
    at_rated = None if losses is None else losses.losses.at(values.continuous_torque, speed)
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
        needed_length=wound("peak_torque", winding.length.needs[0].length),
        peak_effort=wound("peak_torque", outcome.features.effort_peak),
        power_at_base_speed=product(winding.chosen.power_at_base_speed, peak_torque=1, base_speed=1),
        rated_speed=product(speed, base_speed=moves),
        rated_power=product(values.continuous_torque * speed, continuous_torque=1, base_speed=moves),
        iron_loss=None if at_rated is None else wound("iron_loss", float(at_rated.stator_iron)),
        losses=None if at_rated is None else product(float(at_rated.total), **_loss_shares(at_rated)),
        efficiency=None if at_rated is None else _efficiency(found, at_rated),
        loaded_constant=wound("peak_torque", winding.chosen.torque_constant),
        continuous_current=product(heat.slow.current / sqrt(2), resistance=-0.5),
        short_circuit_current=product(shorted.current_peak, magnet_flux=1, inductance_d=-1),
        braking_torque=product(shorted.torque, magnet_flux=2, inductance_q=-1),
        braking_speed=product(shorted.best_speed_cold, resistance=1, inductance_q=-1),
        # What the same heat in the copper allows, T ~ P^(e/2), the losses in iron and magnets as they are.
        continuous_effort=product(float(heat.effort(heat.slow.torque)), copper_loss=found.elasticity / 2),
        low_speed_damping=product(_reached(outcome, LowSpeedDamping), magnet_flux=2, resistance=-1),
    )


def of_wound(found: ToleranceOutcome, quantity: str, value: float | None = None) -> Uncertain:
    """A quantity of the wound machine, or what is proportional to it or to its inverse; value: of that [SI]."""
    own = float(getattr(found.values, quantity)) if value is None else value
    return of_product(found, own, **{quantity: 1.0})


def of_product(found: ToleranceOutcome, value: float, **powers: float) -> Uncertain:
    """What is in proportion to a product of powers of quantities of the wound machine, d ln y = sum p_k d ln x_k.

    Each deviation moves all of them at once; bounds of the mesh are added, where they are known. value: [SI]
    """
    rows = ([p * one.standard(name) for name, p in powers.items()] for one in found.sensitivities)
    bounds = [abs(p) * float(getattr(found.mesh, name)) for name, p in powers.items()]
    return Uncertain(value, float(np.nansum(bounds)) / sqrt(3), 0.0, hypot(*map(sum, rows)))


def _loss_shares(at: PowerLosses) -> dict[str, float]:
    """Of copper and iron in all losses, which magnets and what circulates leave as they are; dimensionless."""
    iron = float(at.stator_iron + at.rotor_iron)
    return {"copper_loss": float(at.copper / at.total), "iron_loss": iron / float(at.total)}


def _efficiency(found: ToleranceOutcome, at: PowerLosses) -> Uncertain:
    """d ln eta = -(1 - eta) d ln P at the same torque and speed."""
    efficiency = float(at.efficiency)
    powers = {name: -(1 - efficiency) * share for name, share in _loss_shares(at).items()}
    return of_product(found, efficiency, **powers)


def of_match(spread: MatchSpread, value: float, read: Callable[[DrawnMatch], float]) -> Uncertain:
    """A number of the match, by what each source alone makes of it; value, read: [SI]."""
    return Uncertain(value, *(scatter_of(some, read) for some in (spread.mesh, spread.fit, spread.tolerance)))


def scatter_of(draws: Sequence[DrawnMatch | None], read: Callable[[DrawnMatch], float]) -> float:
    """Standard deviation over the mean of the draws that have a match, dimensionless; read: a number, [any unit]."""
    values = np.array([read(one) for one in draws if one is not None])
    return float(values.std(ddof=1) / values.mean())


def _reached(outcome: Outcome, kind: type[Requirement]) -> float:
    """What the actuator reaches of a requirement [SI]."""
    return next(one.reached for one in outcome.checks if isinstance(one.requirement, kind))
