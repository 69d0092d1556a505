"""How the match moves when its cross-sections are not quite what the fits say: by fit, mesh and tolerances.

A draw is another set of fits, and is matched anew as the stage ``match`` does:

    fit        coefficients by their covariance, and a misfit of the held-out residual's size on every quantity
    mesh       one factor on both torques, uniform within the bound of the mesh error
    tolerance  every deviation uniform within its half width; what it does to the torques at both currents is common

The quantities of a cross-section are drawn independently, and a misfit holds for all radii of a draw. So the spread is
that of the design, had the true cross-sections been known to the match.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from drivetrain.constraints import Constraint
from drivetrain.match import Infeasible, Match
from drivetrain.matching import Matcher, OverloadLaw
from geometry.family import Combination
from optimisation.fits import QUANTITIES, SectionFits
from optimisation.polynomial_fits import PolynomialFit
from tasks import Workers
from uncertainty.tolerance_stage import ToleranceOutcome

DRAWS = 80  # of the chosen machine, by each source alone and by all together
FREE_DRAWS = 16  # with radius and slots free too
_TOGETHER = 8  # free draws of a task
_SEED = 1  # the same draws every time
# Of a draw; the cost has one minimum over the ratio, so that the refined optimum does not feel how many are scanned.
_RATIO_SAMPLES, _RADII = 21, 6
_SLACK = 1e-6  # relative; a radius this close to the end of the fits lies on it

Torques = tuple[float, float]  # factors on the nominal and on the overload torque


@dataclass(frozen=True)
class DrawnMatch:
    """The match of one draw: transmission_ratio [m/rad], active_length [m], stator_outer_radius [m].

    torque_nominal, torque_overload: per length [Nm/m]
    binding: the constraint that sets the length; ratio_bound: whether the ratio lies on an end of the allowed ones
    radius_bound: whether the radius lies on an end of the fits; total_mass: of motor and gearbox [kg]
    """

    slots: int
    stator_outer_radius: float
    transmission_ratio: float
    active_length: float
    torque_nominal: float
    torque_overload: float
    total_mass: float
    binding: Constraint
    ratio_bound: bool
    radius_bound: bool


@dataclass(frozen=True)
class MatchSpread:
    """What the match makes of the draws, None where a draw has no match.

    fit, mesh, tolerance: of the chosen slots and radius, moved by one source alone; together: by all three
    free: radius and combination free, by all three
    """

    fit: tuple[DrawnMatch | None, ...]
    mesh: tuple[DrawnMatch | None, ...]
    tolerance: tuple[DrawnMatch | None, ...]
    together: tuple[DrawnMatch | None, ...]
    free: tuple[DrawnMatch | None, ...]


@dataclass(frozen=True, eq=False)
class DrawTask:
    """Fits to be matched one after the other; chosen: combination and stator radius [m], None where both are free."""

    matcher: Matcher
    fits: tuple[SectionFits, ...]
    chosen: tuple[Combination, float] | None


def match_spread(matcher: Matcher, chosen: Match, found: ToleranceOutcome, workers: Workers) -> MatchSpread:
    """Match the draws; chosen: by the fits as they are; found: what mesh and tolerances do to its torques."""
    coarse = replace(matcher, radii=_RADII, ratio_samples=_RATIO_SAMPLES)
    kept = [one for one in matcher.fits.usable if one in matcher.inputs.combinations]
    usable = SectionFits(tuple(matcher.fits.of(one) for one in kept))
    machine = chosen.section.machine
    own = Combination.of(machine), machine.stator_outer_radius
    mesh, tolerance = _mesh_factors(found), _tolerance_factors(found)
    sources = {
        "fit": _draws(DRAWS, lambda rng: drawn_fits(usable, rng)),
        "mesh": _draws(DRAWS, lambda rng: _scaled(usable, mesh(rng))),
        "tolerance": _draws(DRAWS, lambda rng: _scaled(usable, tolerance(rng))),
        "together": _draws(DRAWS, lambda rng: _scaled(_scaled(drawn_fits(usable, rng), mesh(rng)), tolerance(rng))),
    }
    tasks = {name: DrawTask(coarse, fits, own) for name, fits in sources.items()}
    tasks |= _free_tasks(coarse, sources["together"][:FREE_DRAWS])
    matched = workers.map("match again", match_draws, tasks)
    free = tuple(one for name, some in matched.items() if name not in sources for one in some)
    return MatchSpread(**{name: matched[name] for name in sources}, free=free)


def match_draws(task: DrawTask) -> tuple[DrawnMatch | None, ...]:
    """The match of each draw."""
    return tuple(_attempt(replace(task.matcher, fits=fits), task.chosen) for fits in task.fits)


def _free_tasks(matcher: Matcher, fits: tuple[SectionFits, ...]) -> dict[str, DrawTask]:
    firsts = range(0, len(fits), _TOGETHER)
    return {f"free, from {k}": DrawTask(matcher, fits[k : k + _TOGETHER], None) for k in firsts}


def _attempt(matcher: Matcher, chosen: tuple[Combination, float] | None) -> DrawnMatch | None:
    law = matcher.inputs.overload
    found = _best(matcher, law) if chosen is None else _of_section(matcher, law, *chosen)
    return None if found is None else _drawn_match(found, matcher)


def _of_section(matcher: Matcher, law: OverloadLaw, combination: Combination, radius: float) -> Match | None:
    try:
        return matcher.match(matcher.section(combination, law, radius))
    except Infeasible:
        return None


def _best(matcher: Matcher, law: OverloadLaw) -> Match | None:
    """The least cost over combinations and radii."""
    tried = (matcher.over_radius(one, law).over_radius for one in matcher.fits.combinations)
    return min((one.best for one in tried if one is not None), key=lambda one: one.total_cost, default=None)


def _drawn_match(found: Match, matcher: Matcher) -> DrawnMatch:
    machine = found.section.machine
    radius, ends = machine.stator_outer_radius, matcher.fits.range(Combination.of(machine))
    return DrawnMatch(
        slots=machine.slots,
        stator_outer_radius=radius,
        transmission_ratio=found.transmission_ratio,
        active_length=found.active_length,
        torque_nominal=found.section.torque_per_length_nominal,
        torque_overload=found.section.torque_per_length_overload,
        total_mass=found.cost.mass,
        binding=found.binding,
        ratio_bound=found.bound is not None,
        radius_bound=min(abs(radius / end - 1) for end in ends) < _SLACK,
    )


# ---- draws ----------------------------------------------------------------------------------------------------------


def _draws(count: int, draw: Callable[[np.random.Generator], SectionFits]) -> tuple[SectionFits, ...]:
    rng = np.random.default_rng(_SEED)
    return tuple(draw(rng) for _ in range(count))


def drawn_fits(fits: SectionFits, rng: np.random.Generator) -> SectionFits:
    """Every coefficient by its covariance, and every misfit by the held-out residual, anew."""

    def draw(_: str, fit: PolynomialFit) -> PolynomialFit:
        moved = rng.multivariate_normal(fit.coefficients, fit.scatter.covariance)
        moved[-1] += rng.normal(0.0, fit.scatter.held_out)
        return _with(fit, moved)

    return _changed(fits, draw)


def _scaled(fits: SectionFits, factors: Torques) -> SectionFits:
    """Both torques times factors of their own; the one scaled linearly goes with the nominal one."""
    nominal, overload = factors
    by_name = {"torque_nominal": nominal, "torque_overload": overload, "torque_overload_linear": nominal}
    return _changed(fits, lambda name, fit: _with(fit, by_name.get(name, 1.0) * np.array(fit.coefficients)))


def _changed(fits: SectionFits, change: Callable[[str, PolynomialFit], PolynomialFit]) -> SectionFits:
    """Every polynomial changed; change: (name of its quantity, polynomial) -> polynomial."""
    return SectionFits(
        tuple(
            replace(one, fits=tuple(change(name, fit) for name, fit in zip(QUANTITIES, one.fits)))
            for one in fits.each
        )
    )


def _with(fit: PolynomialFit, coefficients: np.ndarray) -> PolynomialFit:
    c2, c1, c0 = coefficients.tolist()
    return replace(fit, coefficients=(c2, c1, c0))


def _mesh_factors(found: ToleranceOutcome) -> Callable[[np.random.Generator], Torques]:
    """The mesh puts both torques off the same way."""

    def draw(rng: np.random.Generator) -> Torques:
        way = rng.uniform(-1.0, 1.0)
        return 1 + way * found.mesh.continuous_torque, 1 + way * found.mesh.peak_torque

    return draw


def _tolerance_factors(found: ToleranceOutcome) -> Callable[[np.random.Generator], Torques]:
    """Each deviation at one place of its tolerance, for both torques."""
    most = [
        [getattr(one.relative, name) * one.deviation.half_width for name in ("continuous_torque", "peak_torque")]
        for one in found.sensitivities
    ]

    def draw(rng: np.random.Generator) -> Torques:
        nominal, overload = 1 + rng.uniform(-1.0, 1.0, len(most)) @ np.array(most)
        return float(nominal), float(overload)

    return draw
