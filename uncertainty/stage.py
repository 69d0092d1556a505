"""How sure the design is: the match drawn by lot, and the uncertainty of every headline number."""

from __future__ import annotations

from dataclasses import dataclass

from drivetrain.masses import DrawnParts
from drivetrain.matching import Matcher, MatchInputs, MatchOutcome
from drivetrain.outcome import Outcome
from drivetrain.requirements import Linkage, Requirements
from electrical.braking_stage import BrakingOutcome
from electrical.magnets_stage import MagnetsOutcome
from electrical.winding_stage import WindingInputs, WindingOutcome
from losses.stage import LossMap
from magnetostatics.case import FamilyCase
from magnetostatics.flux_map_stage import FluxMap
from optimisation.fits import SectionFits
from tasks import Workers
from thermal.stage import HeatOutcome
from uncertainty.budget import Budget, budget_of
from uncertainty.match_spread import MatchSpread, match_spread
from uncertainty.over_speed import OverSpeed
from uncertainty.tolerance_stage import ToleranceOutcome


@dataclass(frozen=True)
class Uncertainty:
    """spread: of the match; budget: of the headline numbers."""

    spread: MatchSpread
    budget: Budget


def uncertainty_stage(
    found: ToleranceOutcome,
    case: FamilyCase,
    fits: SectionFits,
    matched: MatchOutcome,
    requirements: Requirements,
    linkage: Linkage,
    inputs: MatchInputs,
    flux_map: FluxMap,
    winding: WindingOutcome,
    windings: WindingInputs,
    outcome: Outcome,
    heat: HeatOutcome,
    magnets: MagnetsOutcome | None,
    braking: BrakingOutcome,
    losses: LossMap | None,
    workers: Workers,
) -> Uncertainty:
    """Match again what the fits, the mesh and the tolerances leave open, and add up what each headline number carries.

    found: what the tolerances do; the others as in ``drivetrain.matching.match_stage``
    """
    matcher = Matcher(case, fits, requirements, linkage, inputs, DrawnParts(inputs.masses, case.packing))
    spread = match_spread(matcher, matched.chosen, found, workers)
    machine, fastest = winding.wound.on_map(flux_map.data), windings.limits.maximum_speed
    over_speed = OverSpeed(machine, winding.limits, fastest, found.values)
    return Uncertainty(
        spread,
        budget_of(found, spread, matched.chosen, winding, over_speed, outcome, heat, magnets, braking, losses),
    )
