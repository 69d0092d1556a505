"""The loop closed: radius, slots, poles, active length, ratio and linkage together, beside the design found by stages.

The search runs on the fits of the cross-sections; the design found stage by stage, the bettered ones and some of the
front are then solved by the field.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import partial
from math import inf

import numpy as np

from drivetrain.linkage_stage import LinkageFront
from drivetrain.masses import DrawnParts
from drivetrain.match import MatchError, SizedSection, damping_constraint
from drivetrain.matching import Matcher, MatchInputs, MatchOutcome, solved_section
from drivetrain.output import Output
from drivetrain.requirements import Linkage, Requirements
from drivetrain.whole_design import (
    OBJECTIVES,
    Aims,
    RatedDesign,
    RoadDemand,
    RoadMachine,
    RoadSection,
    WholeDesign,
    WholeProblem,
    front,
    improved,
    road_loss,
    road_machine,
    spread,
)
from geometry.family import Combination
from geometry.machine import Machine
from losses.iron import FrequencyTerms
from losses.map import field_losses
from magnetostatics.case import FamilyCase
from magnetostatics.model import OperatingPoint
from materials.iron_loss import IronLossLaw, iron_loss_law
from optimisation.fits import SectionFits
from tasks import Workers
from units import MILLIMETRE

_SHORTEST = 0.1  # active length of a design, as a share of the largest allowed one


@dataclass(frozen=True)
class WholeSearchInputs:
    """How the search goes.

    loss_grade: whose iron-loss data stand in for the steel's, None where the study names none
    seed, population, generations: of the front; solved: points of the front that the field solves
    idle_radii: of each slot-pole combination, at which the idle loss is solved
    """

    loss_grade: str | None
    seed: int = 1
    population: int = 120
    generations: int = 120
    solved: int = 12
    idle_radii: int = 5


@dataclass(frozen=True)
class FieldTask:
    """A machine of a study, with the loss data of its steel."""

    case: FamilyCase
    machine: Machine
    law: IronLossLaw


@dataclass(frozen=True)
class Question:
    """Which objective (number in OBJECTIVES) is bettered, and what the others may come to.

    allowed: [kg, kg, Ns/m, W]; inf: anything
    """

    objective: int
    allowed: tuple[float, ...]

    def words(self, output: Output) -> str:
        """What is asked, for a kind of output."""
        raise NotImplementedError


@dataclass(frozen=True)
class OthersKept(Question):
    """The other three no worse."""

    def words(self, output: Output) -> str:
        return f"{objective_words(output)[self.objective]}, the other three no worse"


@dataclass(frozen=True)
class DampingAsRequired(Question):
    """Of mass and inertia one no worse, the damping that is asked for, and a free loss."""

    def words(self, output: Output) -> str:
        names = objective_words(output)
        return f"{names[self.objective]}, {names[1 - self.objective]} no worse, damping as required"


def objective_words(output: Output) -> tuple[str, ...]:
    """The OBJECTIVES in words, for a kind of output."""
    return "mass", output.inertia, "regenerative damping", f"loss {output.duty}"


@dataclass(frozen=True)
class Bettered:
    """The answer to a question."""

    question: Question
    found: RatedDesign


@dataclass(frozen=True)
class SolvedDesign:
    """A design by the model, and the same with torques, slot area and idle loss of the field (``field``)."""

    model: RatedDesign
    field: RatedDesign


@dataclass(frozen=True)
class SearchRange:
    """What the search could choose from.

    radii: of the stator for each combination [m]; lengths: active [m]; ratios: transmission, linkage_ratios: nominal
        ratios of the linkages [m/rad], all smallest and largest
    """

    radii: tuple[tuple[Combination, tuple[float, float]], ...]
    lengths: tuple[float, float]
    ratios: tuple[float, float]
    linkage_ratios: tuple[float, float]

    def hits(self, design: WholeDesign) -> tuple[str, ...]:
        """The ends that a design lies on, in words with the key of the study that widens them."""
        radii = dict(self.radii)[design.combination]
        axes = (
            (design.stator_outer_radius, radii, _DIAMETER_ENDS),
            (design.active_length, self.lengths, _LENGTH_ENDS),
            (design.transmission_ratio, self.ratios, _RATIO_ENDS),
            (design.linkage_ratio, self.linkage_ratios, _LINKAGE_ENDS),
        )
        return tuple(words for value, ends, names in axes for words in _end(value, ends, names))


_AT_THE_END = 2e-3  # of the range; a design closer to its end lies on it
_DIAMETER_ENDS = (
    "the smallest diameter: add smaller ones to sweep.stator_diameters_mm",
    "the largest diameter: add larger ones to sweep.stator_diameters_mm",
)
_LENGTH_ENDS = (
    "the shortest machine of the search, a tenth of match.length_max_mm",
    "the longest machine: raise match.length_max_mm",
)
_RATIO_ENDS = (
    "the smallest transmission ratio: raise match.speed_max_rad_per_s, or match.gearbox_stages",
    "the largest transmission ratio: lower match.gearbox_stages",
)
_LINKAGE_ENDS = (
    "the smallest linkage ratio: let [linkage_search] choose a smaller one",
    "the largest linkage ratio of the front: raise linkage_search.ratio_limit_mm_per_rad",
)


def _end(value: float, ends: tuple[float, float], names: tuple[str, str]) -> tuple[str, ...]:
    """Which end of a range a value lies on; none where there is nothing to choose."""
    low, high = ends
    margin = _AT_THE_END * (high - low)
    if margin <= 0:
        return ()
    return tuple(name for name, apart in zip(names, (value - low, high - value), strict=True) if apart <= margin)


@dataclass(frozen=True)
class WholeSearch:
    """What the searches found.

    staged: the design found stage by stage, by the model; bettered: in one objective at a time; front: by the model
    solved: staged, bettered and some of the front by the field, in this order; force_rms: of the road [N]
    choices: what the search could choose from; machines: of the solved designs and then of the front, by the fits
    """

    staged: RatedDesign
    bettered: tuple[Bettered, ...]
    front: tuple[RatedDesign, ...]
    solved: tuple[SolvedDesign, ...]
    force_rms: float
    choices: SearchRange
    machines: tuple[RoadMachine, ...]


def optimise_stage(
    case: FamilyCase,
    fits: SectionFits,
    match: MatchOutcome,
    linkage: Linkage,
    linkages: LinkageFront | None,
    requirements: Requirements,
    match_inputs: MatchInputs,
    inputs: WholeSearchInputs,
    aims: Aims,
    output: Output,
    workers: Workers,
) -> WholeSearch:
    """Search over all stages at once, and solve what is shown by the field.

    match, linkage: the design found stage by stage; linkages: the front it was chosen from, None where it is stated
    aims: of the front of this search; output: in whose words a refusal is said
    Raises MatchError where no design meets the targets, MaterialError where the steel has no loss data, FitRefused.
    """
    drawn = DrawnParts(match_inputs.masses, case.packing)
    matcher = Matcher(case, fits, requirements, linkage, match_inputs, drawn)
    law = iron_loss_law(inputs.loss_grade)
    problem = _problem(matcher, linkages, _idle_sections(matcher, law, inputs.idle_radii, workers), aims)
    staged = _staged(problem, match, linkage)
    found = _front(problem, staged, inputs, output)
    bettered = tuple(
        Bettered(one, improved(problem, staged.design, one.objective, one.allowed))
        for one in questions(staged.values.objectives, requirements.maximum_damping)
    )
    shown = _shown(staged, bettered, spread(found, problem.costs(found), inputs.solved))
    solved, choices = _solved(problem, case, law, shown, workers), _choices(problem)
    every = (*(one.model for one in solved), *found)
    machines = tuple(problem.machine_of(one.design) for one in every)
    return WholeSearch(staged, bettered, found, solved, requirements.force_rms, choices, machines)


def questions(before: tuple[float, ...], damping: float) -> tuple[Question, ...]:
    """What is asked against the objectives of the stage-by-stage design.

    before: those objectives [kg, kg, Ns/m, W]; damping: required [Ns/m]

    First each objective with the other three no worse; then mass and inertia with the damping that is asked for and a
    free loss, which is all that the requirements ask for.
    """
    mass, inertia, _, _ = before
    kept = (OthersKept(k, before) for k in range(len(OBJECTIVES)))
    bare = (mass, inertia, damping, inf)
    return (*kept, DampingAsRequired(0, bare), DampingAsRequired(1, bare))


# ---- the problem ----------------------------------------------------------------------------------------------------


class _IdleSections:
    """(combination, stator outer radius [m]) -> ``RoadSection`` of the fits, its idle loss a parabola over that."""

    def __init__(self, matcher: Matcher, parabolas: dict[Combination, np.ndarray]) -> None:
        self._matcher, self._parabolas = matcher, parabolas  # (3, terms) by combination

    def __call__(self, combination: Combination, radius: float) -> RoadSection:
        section = self._matcher.section(combination, self._matcher.inputs.overload, radius)
        idle = (float(np.polyval(one, radius)) for one in self._parabolas[combination].T)
        return RoadSection.of(section, FrequencyTerms(*idle))


def _idle_sections(matcher: Matcher, law: IronLossLaw, count: int, workers: Workers) -> _IdleSections:
    """Idle loss solved at so many radii of each combination, and the cross-sections that carry it."""
    inputs = matcher.inputs
    samples = [
        (one, float(radius)) for one in inputs.combinations for radius in np.linspace(*matcher.fits.range(one), count)
    ]
    tasks = {
        f"{one.words}, {2 * radius / MILLIMETRE:.2f} mm": FieldTask(
            matcher.case, matcher.section(one, inputs.overload, radius).machine, law
        )
        for one, radius in samples
    }
    found = workers.map("idle loss", solve_idle, tasks)
    terms = np.array([(one.hysteresis, one.eddy, one.excess) for one in found.values()]).reshape(-1, count, 3)
    radii = np.array([radius for _, radius in samples]).reshape(-1, count)
    parabolas = {one: np.polyfit(x, y, 2) for one, x, y in zip(inputs.combinations, radii, terms, strict=True)}
    return _IdleSections(matcher, parabolas)


def _problem(matcher: Matcher, linkages: LinkageFront | None, section_at: _IdleSections, aims: Aims) -> WholeProblem:
    inputs, required = matcher.inputs, matcher.requirements
    demand = RoadDemand(required.force_rms, required.velocity_rms, matcher.loading)
    longest = inputs.limits.active_length
    return WholeProblem(
        section_at=section_at,
        combinations=inputs.combinations,
        radii=tuple(matcher.fits.range(one) for one in inputs.combinations),
        lengths=(_SHORTEST * longest, longest),
        linkage_ratios=_linkage_ratios(matcher.linkage, linkages),
        constraints_of=matcher.constraints_without_planets,
        gearbox=matcher.gearbox,
        masses=matcher.masses,
        damping_of=lambda section: damping_constraint(section, required, matcher.loading),
        loss_of=partial(_road_loss, demand),
        machine_of=lambda one: road_machine(
            section_at(one.combination, one.stator_outer_radius), one, matcher.loading
        ),
        targets=(inputs.scales.mass, inputs.scales.equivalent_mass),
        aims=aims,
    )


def _choices(problem: WholeProblem) -> SearchRange:
    radii = tuple(zip(problem.combinations, problem.radii, strict=True))
    ratios = problem.ratios if problem.gearbox.stage_count else problem.linkage_ratios
    return SearchRange(radii, problem.lengths, ratios, problem.linkage_ratios)


def _road_loss(demand: RoadDemand, section: SizedSection, design: WholeDesign) -> float:
    assert isinstance(section, RoadSection)  # all sections of this search carry their idle loss
    return road_loss(section, design, demand)


def _linkage_ratios(chosen: Linkage, linkages: LinkageFront | None) -> tuple[float, float]:
    """Nominal ratios [m/rad] of the front's linkages whose angles are no worse than those of the chosen one."""
    if linkages is None:
        return chosen.ratio_nominal, chosen.ratio_nominal
    return chosen.ratio_nominal, max(chosen.ratio_nominal, float(linkages.nominal_ratios.max()))


def _staged(problem: WholeProblem, match: MatchOutcome, linkage: Linkage) -> RatedDesign:
    """The design of match and linkage."""
    machine, found = match.machine, match.chosen
    design = WholeDesign(
        Combination.of(machine),
        machine.stator_outer_radius,
        found.active_length,
        found.transmission_ratio,
        linkage.ratio_nominal,
    )
    return problem.rated(design)


def _front(
    problem: WholeProblem, staged: RatedDesign, inputs: WholeSearchInputs, output: Output
) -> tuple[RatedDesign, ...]:
    settings = {"seed": inputs.seed, "population": inputs.population, "generations": inputs.generations}
    found = front(problem, start=staged.design, **settings)
    if not found:
        raise MatchError(
            f"no design meets match.mass_max_kg, {output.inertia_key} and the required damping together; relax one of "
            "them"
        )
    return found


# ---- field solutions ------------------------------------------------------------------------------------------------


def solve_idle(task: FieldTask) -> FrequencyTerms:
    """Idle loss of one machine, magnets included [W/m over the electrical frequency]."""
    case = task.case
    found = field_losses(case.model(task.machine), OperatingPoint(0.0, 0.0, 0.0, case.packing), task.law)
    total = found.stator + found.rotor + found.magnet
    return FrequencyTerms(*(float(getattr(total, one.name)) for one in fields(FrequencyTerms)))


def solve_section(task: FieldTask) -> RoadSection:
    """The cross-section of one machine with torques, slot area and idle loss from the field."""
    return RoadSection.of(solved_section(task.case, task.machine), solve_idle(task))


def _shown(
    staged: RatedDesign, bettered: tuple[Bettered, ...], points: tuple[RatedDesign, ...]
) -> tuple[tuple[str, RatedDesign], ...]:
    """(name, design) of all that the field solves."""
    answers = ((f"answer {k}", one.found) for k, one in enumerate(bettered, start=1))
    return (("stage by stage", staged), *answers, *((f"front {k}", one) for k, one in enumerate(points, start=1)))


def _solved(
    problem: WholeProblem,
    case: FamilyCase,
    law: IronLossLaw,
    shown: tuple[tuple[str, RatedDesign], ...],
    workers: Workers,
) -> tuple[SolvedDesign, ...]:
    """Every design with its cross-section by the field in the place of the fits."""
    machines = {
        name: problem.section_at(one.design.combination, one.design.stator_outer_radius).machine for name, one in shown
    }
    tasks = {name: FieldTask(case, machine, law) for name, machine in machines.items()}
    found = workers.map("designs", solve_section, tasks)
    return tuple(
        SolvedDesign(one, RatedDesign(one.design, problem.values(one.design, found[name]))) for name, one in shown
    )
