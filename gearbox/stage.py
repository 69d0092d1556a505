"""The gearbox of an actuator: what is asked of it, under which loads, and the gears that were found.

At the output act an effort and a speed: a force [N] and a velocity [m/s] where a linkage turns them into the torque and
the speed of the slow shaft, a torque [Nm] and a speed [rad/s] where the load sits on that shaft (linkage ratio 1).
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from gearbox.bodies import Construction
from gearbox.planetary_set import PlanetarySet
from gearbox.rating import Rules, StageLoad
from gearbox.search import CostScale, Found, GearRequest, Safety, strongest
from gearbox.spectrum import LoadSpectrum, gaussian_spectrum, largest_swing, spectrum_from_history
from gearbox.train import Gears, GearTrain
from labelled import xr

SETS_KEPT = 12
WIDTH_SLACK = 1e-3  # relative; widths are drawn in steps and Miner's sum is met to its rounding


@dataclass(frozen=True)
class GearDemand:
    """What the actuator asks of its gearbox.

    ratio: wanted, fast over slow speed, dimensionless, where the linkage ratio is largest
    envelope_diameter: to stay inside [m]
    linkage_ratio: nominal tau_l [m/rad], 1 for a load on the slow shaft; linkage_ratio_max: the largest along the
        travel [m/rad or 1], where torques are largest
    effort_peak: overload at the output [N or Nm], at speed_at_effort_peak [m/s or rad/s]
    """

    ratio: float
    envelope_diameter: float
    linkage_ratio: float
    linkage_ratio_max: float
    effort_peak: float
    speed_at_effort_peak: float


@dataclass(frozen=True)
class GearCost:
    """Scales of the cost of a gearbox, as in the match (3.98): mass, equivalent_mass that count as 1 [kg], and the
    weight (dimensionless) of the second against the first. Behind a linkage ratio of 1 the equivalent mass is an
    inertia [kg m^2]."""

    mass: float
    equivalent_mass: float
    weight: float


@dataclass(frozen=True)
class StatedGears:
    """Somebody else's gears, rated in the same way: teeth and the face_widths [m] of the stages."""

    gears: PlanetarySet
    face_widths: tuple[float, ...]


@dataclass(frozen=True)
class GearInputs:
    """What a study says about the gearbox.

    stage_count: planetary stages; ratio_tolerance: relative; planets of a stage; friction: mu, dimensionless
    torque_class_width: of the load spectrum at the slow shaft [Nm]; life: operating time [s]
    swing: largest turn of the slow shaft between two reversals [rad], inf for a shaft that turns on; read where no
        history tells it
    """

    rules: Rules
    safety: Safety
    construction: Construction
    cost: GearCost
    stage_count: int
    ratio_tolerance: float
    planets: int
    friction: float
    torque_class_width: float
    life: float
    swing: float
    stated: StatedGears | None = None


class GearLoads:
    """What acts at the output over the life; the concrete loads are below."""

    def spectrum(self, demand: GearDemand, class_width: float, life: float) -> LoadSpectrum:
        """Torque classes at the slow shaft for classes of this width [Nm] and a life [s]."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class RecordedLoads(GearLoads):
    """Histories of runs: ``force`` [N], ``velocity`` [m/s], ``stroke`` [m] over (seed, time), evenly sampled.

    Torques come with the largest linkage ratio, where they are largest (thesis eqs 3.121-3.122), angles with the
    nominal one.
    """

    histories: xr.Dataset

    def spectrum(self, demand: GearDemand, class_width: float, life: float) -> LoadSpectrum:
        """See ``GearLoads.spectrum``; class_width: [Nm]; life: [s]."""
        force, velocity, stroke = (self.histories[name].values for name in ("force", "velocity", "stroke"))
        ratio = demand.linkage_ratio_max
        swing = max(largest_swing(run / demand.linkage_ratio) for run in np.atleast_2d(stroke))
        return spectrum_from_history(
            force.ravel() * ratio, velocity.ravel() / ratio, class_width=class_width, duration=life, swing=swing
        )


@dataclass(frozen=True)
class NormalLoads(GearLoads):
    """A normal distribution with these RMS values, the speed in proportion to the effort.

    effort_rms [N or Nm], speed_rms [m/s or rad/s] at the output; swing: largest turn of the slow shaft between two
    reversals [rad], inf for a shaft that turns on
    """

    effort_rms: float
    speed_rms: float
    swing: float

    def spectrum(self, demand: GearDemand, class_width: float, life: float) -> LoadSpectrum:
        """See ``GearLoads.spectrum``; class_width: [Nm]; life: [s]."""
        ratio = demand.linkage_ratio_max
        return gaussian_spectrum(
            self.effort_rms * ratio, self.speed_rms / ratio, class_width=class_width, duration=life, swing=self.swing
        )


@dataclass(frozen=True)
class SafetyCheck:
    """Safety factor of all gears and stages; kind as in ``Safety``.

    wanted, reached: dimensionless, reached the smallest
    """

    kind: str
    wanted: float
    reached: float

    @property
    def margin(self) -> float:
        """Relative; negative where the factor is not reached."""
        return self.reached / self.wanted - 1

    @property
    def holds(self) -> bool:
        """Reached up to the rounding of the widths."""
        return self.margin >= -WIDTH_SLACK


@dataclass(frozen=True)
class RatedSet:
    """One of the best gearboxes of the search: its cost, its smallest safety factors, whether meshing tooth numbers
    have a common factor.

    cost, flank, root, static_flank, static_root: dimensionless
    """

    train: GearTrain
    cost: float
    common_factor: bool
    flank: float
    root: float
    static_flank: float
    static_root: float


@dataclass(frozen=True)
class GearSearch:
    """How the gears were found.

    load: at the slow shaft; requested_ratio: fast over slow speed, dimensionless
    weakness: None, or the sentence on what is too weak
    sets_formed, sets_that_fit: sets of teeth and profile shifts; tooth_triples_that_fit: different teeth among them
    best: in the order of rising cost, the first is the choice; stated: somebody else's gears in the same construction
    """

    load: StageLoad
    rules: Rules
    safety: Safety
    requested_ratio: float
    weakness: str | None
    sets_formed: int
    sets_that_fit: int
    tooth_triples_that_fit: int
    best: tuple[RatedSet, ...]
    stated: GearTrain | None


@dataclass(frozen=True)
class GearboxOutcome:
    """What lies between the slow shaft and the rotor.

    train: the gears, or ``DirectDrive``; linkage_ratio: nominal tau_l [m/rad]; checks: of the wanted safety factors
    search: None where there was nothing to search
    """

    train: Gears
    linkage_ratio: float
    checks: tuple[SafetyCheck, ...] = ()
    search: GearSearch | None = None

    @property
    def transmission_ratio(self) -> float:
        """tau_t = tau_l / i in the nominal position [m/rad], with the teeth as they are."""
        return self.linkage_ratio / self.train.ratio

    @property
    def equivalent_mass(self) -> float:
        """Inertia of the gears at the output, J / tau_l^2 [kg] (kg m^2 for a linkage ratio of 1)."""
        return self.train.inertia_at_slow_shaft / self.linkage_ratio**2


def gearbox_stage(demand: GearDemand, loads: GearLoads, inputs: GearInputs) -> GearboxOutcome:
    """The gears of least cost in mass and inertia among all sets of teeth.

    Where the wanted safety factors are out of reach the nearest set is taken and ``search.weakness`` says so.
    Raises GearError, naming the key of the study to move, when no teeth fit or none are strong enough.
    """
    request = _request(demand, loads, inputs)
    found, weakness = strongest(request, SETS_KEPT)
    search = _described(found, weakness, request, inputs.stated)
    return GearboxOutcome(found.best, demand.linkage_ratio, _checks(search), search)


def _request(demand: GearDemand, loads: GearLoads, inputs: GearInputs) -> GearRequest:
    cost = inputs.cost
    return GearRequest(
        ratio=demand.ratio,
        ratio_tolerance=inputs.ratio_tolerance,
        stage_count=inputs.stage_count,
        envelope_diameter=demand.envelope_diameter,
        load=stage_load(demand, loads, inputs),
        rules=inputs.rules,
        safety=inputs.safety,
        construction=inputs.construction,
        cost=CostScale(cost.mass, cost.equivalent_mass, cost.weight, demand.linkage_ratio),
        friction=inputs.friction,
        planets=inputs.planets,
    )


def stage_load(demand: GearDemand, loads: GearLoads, inputs: GearInputs) -> StageLoad:
    """Spectrum and overload at the slow shaft with the largest linkage ratio (thesis eqs 3.121-3.122)."""
    ratio = demand.linkage_ratio_max
    spectrum = loads.spectrum(demand, inputs.torque_class_width, inputs.life)
    return StageLoad(spectrum, demand.effort_peak * ratio, demand.speed_at_effort_peak / ratio)


def _described(found: Found, weakness: str | None, request: GearRequest, stated: StatedGears | None) -> GearSearch:
    return GearSearch(
        load=request.load,
        rules=request.rules,
        safety=request.safety,
        requested_ratio=request.ratio,
        weakness=weakness,
        sets_formed=found.sets_formed,
        sets_that_fit=found.sets_that_fit,
        tooth_triples_that_fit=found.tooth_triples_that_fit,
        best=_rated_sets(found, request),
        stated=None if stated is None else request.train(stated.gears, stated.face_widths),
    )


def _rated_sets(found: Found, request: GearRequest) -> tuple[RatedSet, ...]:
    rows = zip(found.trains, found.costs, found.shared, strict=True)
    load, rules = request.load, request.rules
    return tuple(RatedSet(train, cost, shared, **least_safety(train, load, rules)) for train, cost, shared in rows)


def least_safety(train: Gears, load: StageLoad, rules: Rules) -> dict[str, float]:
    """Smallest safety factor, dimensionless, of each kind (as in ``Safety``) over all gears and stages."""
    ratings = train.rate(load, rules)
    return {kind: min(float(rating.least[kind]) for rating in ratings) for kind in ratings[0].least}


def _checks(search: GearSearch) -> tuple[SafetyCheck, ...]:
    """The factors that are asked for; a wanted factor of 0 is only reported."""
    wanted, best = asdict(search.safety), search.best[0]
    return tuple(SafetyCheck(kind, value, getattr(best, kind)) for kind, value in wanted.items() if value > 0)
