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
from dataclasses import dataclass, fields
from math import hypot, sqrt

import numpy as np

from drivetrain.asked import ControlledDamping, LowSpeedDamping, PeakEffort, PeakPower
from drivetrain.match import Match
from drivetrain.outcome import Outcome
from electrical.braking_stage import BrakingOutcome
from electrical.magnets_stage import MagnetsOutcome
from electrical.winding_stage import WindingOutcome
from losses.map import PowerLosses
from losses.stage import LossMap
from thermal.machine import MAGNETS
from thermal.stage import HeatOutcome
from uncertainty.match_spread import DrawnMatch, MatchSpread
from uncertainty.over_speed import OverSpeed, Powers
from uncertainty.tolerance_stage import ToleranceOutcome
from uncertainty.wound_slopes import PARTS

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

    @property
    def plus_minus(self) -> float:
        """U [SI]."""
        return self.value * self.expanded


@dataclass(frozen=True)
class MatchBudget:
    """The match: torque_nominal, torque_overload: per length, of the fitted cross-section [Nm/m];
    transmission_ratio [m/rad or 1]; matched_length: active length [m]; matched_mass: motor and gears [kg]
    """

    torque_nominal: Uncertain
    torque_overload: Uncertain
    transmission_ratio: Uncertain
    matched_length: Uncertain
    matched_mass: Uncertain


@dataclass(frozen=True)
class PerformanceBudget:
    """What the wound machine gives and takes.

    peak_torque, ripple: of it from peak to peak; cogging: from peak to peak, magnets alike; continuous_torque: at the
        nominal current density [Nm]; needed_length: active length that the peak torque asks for [m]
    base_speed, rated_speed [rad/s]; power_at_base_speed: at the peak torque, rated_power: continuous torque at the
        rated speed, overload_input: electrical at peak torque and rated speed, copper loss alone [W]
    largest_power: by ideal field weakening [W], None where it was not asked for
    """

    peak_torque: Uncertain
    ripple: Uncertain
    cogging: Uncertain
    needed_length: Uncertain
    continuous_torque: Uncertain
    base_speed: Uncertain
    power_at_base_speed: Uncertain
    rated_speed: Uncertain
    rated_power: Uncertain
    overload_input: Uncertain
    largest_power: Uncertain | None


@dataclass(frozen=True)
class ConstantsBudget:
    """What a drive is set up with.

    torque_constant: no load, loaded_constant: at the overload current [Nm/A]; resistance: of a phase [ohm]
    inductance_d, inductance_q: incremental, no load, loaded_inductance_d, loaded_inductance_q: apparent [H]
    """

    torque_constant: Uncertain
    loaded_constant: Uncertain
    resistance: Uncertain
    inductance_d: Uncertain
    inductance_q: Uncertain
    loaded_inductance_d: Uncertain
    loaded_inductance_q: Uncertain


@dataclass(frozen=True)
class LossBudget:
    """The rated point: copper_loss, iron_loss: of the stator, losses: all, rated_input: electrical [W]; efficiency.

    All at the torque and speed of the machine as drawn. Those but the copper loss are None without loss data. The mesh
    of the iron loss is not bounded.
    """

    copper_loss: Uncertain
    iron_loss: Uncertain | None = None
    losses: Uncertain | None = None
    efficiency: Uncertain | None = None
    rated_input: Uncertain | None = None


@dataclass(frozen=True)
class HeatBudget:
    """Turning slowly, by the temperatures: continuous_current: RMS [A]; copper_rise: of the hottest place of the
    winding, magnet_rise: of their mean, over the surroundings, of machines that give the same torque [K]
    """

    continuous_current: Uncertain
    copper_rise: Uncertain
    magnet_rise: Uncertain


@dataclass(frozen=True)
class MagnetBudget:
    """demagnetising_current: peak [A], None where none was found; kept: share of the volume before the knee in the
    worst state, dimensionless. Both None without a grade.
    """

    demagnetising_current: Uncertain | None = None
    kept: Uncertain | None = None


@dataclass(frozen=True)
class BrakingBudget:
    """Shorted phases, by psi_m / L_d, psi_m^2 / L_q and R / L_q: short_circuit_current: peak [A]; braking_torque [Nm];
    braking_speed: of it, cold [rad/s]
    """

    short_circuit_current: Uncertain
    braking_torque: Uncertain
    braking_speed: Uncertain


@dataclass(frozen=True)
class MassBudget:
    """Of the parts and all of them, mass [kg]; rotor_inertia [kg m^2]."""

    stator_laminations: Uncertain
    rotor_laminations: Uncertain
    magnets: Uncertain
    shaft: Uncertain
    copper: Uncertain
    mass: Uncertain
    rotor_inertia: Uncertain


@dataclass(frozen=True)
class OutputBudget:
    """The actuator: peak_effort: at rest; fast_effort: at the speed where the peak is asked for; continuous_effort: of
    the temperatures, turning slowly [N or Nm]; peak_power: where it is asked for [W]
    low_speed_damping: short-circuited; controlled_damping: where it is asked for [Ns/m or Nms/rad]
    equivalent_mass: of rotor and gears, the gears exact [kg or kg m^2]

    None where nothing is asked for, or nothing is left at that speed.
    """

    peak_effort: Uncertain
    fast_effort: Uncertain | None
    peak_power: Uncertain | None
    continuous_effort: Uncertain
    low_speed_damping: Uncertain
    controlled_damping: Uncertain | None
    equivalent_mass: Uncertain


@dataclass(frozen=True)
class Budget:
    """The headline numbers, SI, group by group."""

    match: MatchBudget
    performance: PerformanceBudget
    constants: ConstantsBudget
    losses: LossBudget
    heat: HeatBudget
    magnets: MagnetBudget
    braking: BrakingBudget
    masses: MassBudget
    output: OutputBudget

    @property
    def known(self) -> dict[str, Uncertain]:
        """Every number that is known, by its name."""
        groups = (getattr(self, group.name) for group in fields(self))
        named = {one.name: getattr(group, one.name) for group in groups for one in fields(group)}
        return {name: one for name, one in named.items() if one is not None}


def budget_of(
    found: ToleranceOutcome,
    spread: MatchSpread,
    chosen: Match,
    winding: WindingOutcome,
    over_speed: OverSpeed,
    outcome: Outcome,
    heat: HeatOutcome,
    magnets: MagnetsOutcome | None,
    braking: BrakingOutcome,
    losses: LossMap | None,
) -> Budget:
    """All headline numbers of a design.

    chosen: its match by the fits as they are; over_speed: the wound machine; magnets: None without a grade; losses:
    None without loss data
    """
    return Budget(
        match=_match(spread, chosen),
        performance=_performance(found, winding, over_speed),
        constants=_constants(found, winding),
        losses=_losses(found, losses),
        heat=_heat(found, heat),
        magnets=_magnets(found, magnets),
        braking=_braking(found, braking),
        masses=MassBudget(**{name: of_wound(found, name) for name in PARTS}),
        output=_output(found, over_speed, outcome, heat),
    )


def _match(spread: MatchSpread, chosen: Match) -> MatchBudget:
    section = chosen.section
    return MatchBudget(
        torque_nominal=of_match(spread, section.torque_per_length_nominal, lambda one: one.torque_nominal),
        torque_overload=of_match(spread, section.torque_per_length_overload, lambda one: one.torque_overload),
        transmission_ratio=of_match(spread, chosen.transmission_ratio, lambda one: one.transmission_ratio),
        matched_length=of_match(spread, chosen.active_length, lambda one: one.active_length),
        matched_mass=of_match(spread, chosen.cost.mass, lambda one: one.total_mass),
    )


def _performance(found: ToleranceOutcome, winding: WindingOutcome, over_speed: OverSpeed) -> PerformanceBudget:
    values, speed = found.values, found.rated_speed
    moves = float(speed == winding.chosen.base_speed)  # where the largest speed that is allowed is lower, it is exact
    shaft, copper = values.peak_torque * speed, 1.5 * values.resistance * winding.limits.current_peak**2
    shares = {"peak_torque": shaft / (shaft + copper), "resistance": copper / (shaft + copper)}
    return PerformanceBudget(
        peak_torque=of_wound(found, "peak_torque"),
        ripple=of_wound(found, "ripple"),
        cogging=of_wound(found, "cogging"),
        needed_length=of_wound(found, "peak_torque", winding.length.needs[0].length),
        continuous_torque=of_wound(found, "continuous_torque"),
        base_speed=of_wound(found, "base_speed"),
        power_at_base_speed=of_product(found, winding.chosen.power_at_base_speed, peak_torque=1, base_speed=1),
        rated_speed=of_product(found, speed, base_speed=moves),
        rated_power=of_product(found, values.continuous_torque * speed, continuous_torque=1, base_speed=moves),
        overload_input=of_product(found, shaft + copper, **shares),
        largest_power=_largest_power(found, winding.chosen.maximum_power, over_speed),
    )


def _largest_power(found: ToleranceOutcome, power: float | None, over_speed: OverSpeed) -> Uncertain | None:
    return None if power is None else of_product(found, power, **over_speed.largest_power())


def _constants(found: ToleranceOutcome, winding: WindingOutcome) -> ConstantsBudget:
    return ConstantsBudget(
        torque_constant=of_wound(found, "magnet_flux", winding.chosen.no_load_torque_constant),
        loaded_constant=of_wound(found, "loaded_flux", winding.chosen.torque_constant),
        resistance=of_wound(found, "resistance"),
        inductance_d=of_wound(found, "inductance_d"),
        inductance_q=of_wound(found, "inductance_q"),
        loaded_inductance_d=of_wound(found, "loaded_inductance_d"),
        loaded_inductance_q=of_wound(found, "loaded_inductance_q"),
    )


def _losses(found: ToleranceOutcome, losses: LossMap | None) -> LossBudget:
    copper = of_wound(found, "copper_loss")
    if losses is None:
        return LossBudget(copper)
    at = losses.losses.at(found.values.continuous_torque, found.rated_speed)
    shares, lost = _loss_shares(at), float(at.total / at.electrical)
    return LossBudget(
        copper_loss=copper,
        iron_loss=of_wound(found, "iron_loss", float(at.stator_iron)),
        losses=of_product(found, float(at.total), **shares),
        efficiency=_efficiency(found, at),
        rated_input=of_product(found, float(at.electrical), **{name: lost * share for name, share in shares.items()}),
    )


def _braking(found: ToleranceOutcome, braking: BrakingOutcome) -> BrakingBudget:
    shorted = braking.shorted
    return BrakingBudget(
        short_circuit_current=of_product(found, shorted.current_peak, magnet_flux=1, inductance_d=-1),
        braking_torque=of_product(found, shorted.torque, magnet_flux=2, inductance_q=-1),
        braking_speed=of_product(found, shorted.best_speed_cold, resistance=1, inductance_q=-1),
    )


def _heat(found: ToleranceOutcome, heat: HeatOutcome) -> HeatBudget:
    """The torque goes with its own loss; a rise by T goes as dT / d ln P over T with it."""
    ambient, state = heat.inputs.cooling.ambient, heat.slow.state
    copper, magnets = state.hottest_copper - ambient, state.temperature[MAGNETS] - ambient
    return HeatBudget(
        continuous_current=of_product(found, heat.slow.current / sqrt(2), resistance=-0.5),
        copper_rise=_rise(found, copper, heat.slope.copper),
        magnet_rise=_rise(found, magnets, heat.slope.magnets),
    )


def _rise(found: ToleranceOutcome, rise: float, slope: float) -> Uncertain:
    return of_product(found, rise, copper_loss=slope / rise) if rise else Uncertain(0.0, 0.0, 0.0, 0.0)


def _magnets(found: ToleranceOutcome, magnets: MagnetsOutcome | None) -> MagnetBudget:
    if magnets is None:
        return MagnetBudget()
    current = None if magnets.at_knee is None else of_wound(found, "demagnetising_current")
    return MagnetBudget(current, _kept(magnets, of_wound(found, "opposing_field")))


def _kept(magnets: MagnetsOutcome, opposing: Uncertain) -> Uncertain:
    """Share before the knee, were the field against the magnets off everywhere as much as where it decides.

    The share is no straight line, so u is half of what 2u does.
    """
    kept = 1 - magnets.flux.share_below(magnets.knee)

    def moved(relative: float) -> float:
        ends = (magnets.knee_off_by(way * COVERAGE * relative) for way in (-1, 1))
        return max(abs(1 - magnets.flux.share_below(end) - kept) for end in ends) / COVERAGE

    return Uncertain(kept, moved(opposing.mesh) / kept, 0.0, moved(opposing.tolerance) / kept)


def _output(found: ToleranceOutcome, over_speed: OverSpeed, outcome: Outcome, heat: HeatOutcome) -> OutputBudget:
    # What the same heat in the copper allows, T ~ P^(e/2), the losses in iron and magnets as they are.
    by_heat = {"copper_loss": found.elasticity / 2}
    rotor = outcome.masses.rotor_inertia
    damping = next(one.reached for one in outcome.checks if isinstance(one.requirement, LowSpeedDamping))
    return OutputBudget(
        peak_effort=of_wound(found, "peak_torque", outcome.features.effort_peak),
        fast_effort=_at_speed(found, outcome, PeakEffort, over_speed.torque),
        peak_power=_at_speed(found, outcome, PeakPower, over_speed.torque),
        continuous_effort=of_product(found, float(heat.effort(heat.slow.torque)), **by_heat),
        low_speed_damping=of_product(found, damping, magnet_flux=2, resistance=-1),
        controlled_damping=_at_speed(found, outcome, ControlledDamping, over_speed.braking),
        equivalent_mass=of_product(
            found, outcome.features.equivalent_mass, rotor_inertia=rotor / (rotor + outcome.gearbox_inertia)
        ),
    )


def _at_speed(
    found: ToleranceOutcome,
    outcome: Outcome,
    kind: type[PeakEffort] | type[PeakPower] | type[ControlledDamping],
    powers: Callable[[float], Powers],
) -> Uncertain | None:
    """What is reached of a demand at its speed; powers: of the torque at a speed of the rotor [rad/s]."""
    for one in outcome.checks:
        asked = one.requirement
        if isinstance(asked, kind) and one.reached > 0:
            return of_product(found, one.reached, **powers(asked.speed / outcome.features.transmission_ratio))
    return None


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

