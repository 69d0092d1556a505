"""Search for the gears of a gearbox over all tooth numbers that fit together.

All stages carry the same teeth, so that one ring blank serves them all; they differ in face width. Every triple of
tooth numbers and module of the series is formed within the ratio tolerance, with a grid of profile shifts; geometry
sorts out what cannot mesh, be assembled or be made; strength gives each stage its face width; the least cost in mass
and inertia wins. Costs only rise with the width, so that sets whose smallest widths already cost too much need no
fatigue rating.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, replace
from math import ceil, floor, log

import numpy as np

from gearbox.batch import Batch
from gearbox.bodies import Construction, inertia_at_carrier, total_mass
from gearbox.errors import GearError, TooWeakError
from gearbox.involute import ISO_53_A, BasicRack, Gear
from gearbox.planetary_set import PlanetarySet, equally_spaced, planetary_set, share_a_factor
from gearbox.rating import Rules, StageLoad, rate_stage, static_ratings, survives
from gearbox.train import GearTrain, Stage
from units import MILLIMETRE

# Normal modules [mm] from 0.5, below which teeth carry little. ISO 54:1996 series I and II begin at 1 mm; DIN 780-1
# continues both downwards.
SERIES_1 = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0)
SERIES_2 = (0.55, 0.65, 0.75, 0.85, 0.95, 1.125, 1.375, 1.75, 2.25, 2.75, 3.5, 4.5, 5.5)
PREFERRED_MODULES = tuple(sorted(module * MILLIMETRE for module in SERIES_1 + SERIES_2))

Checks = dict[str, np.ndarray]  # by the name of a constraint: whether each of a batch satisfies it
Entry = tuple[int, tuple[float, ...], float]  # index of a set in its batch, widths of the stages [m], cost

_BATCH = 400  # sets whose fatigue is rated at once
_THREE_PLANETS = 14.9  # stage ratio at which three planets touch
_PLANET_OFFSETS = range(-1, 5)  # planet teeth below half the difference of ring and sun; shifts close the rest


@dataclass(frozen=True)
class ToothLimits:
    """What can be made and runs well.

    least_sun_teeth; contact_ratio: smallest of either mesh, dimensionless (1.2, thesis below eq. 3.123)
    tip_thickness: [modules], 0.4 so that case hardening does not go through the tip;
    planet_gap: between tips of neighbouring planets [m]; rim: ring root to the envelope [modules];
    ring_shift: largest magnitude of the ring's profile shift [modules]; sun_shift, planet_shift: ranges searched
    [modules]; shift_step: [modules]
    """

    least_sun_teeth: int = 12
    contact_ratio: float = 1.2
    tip_thickness: float = 0.4
    planet_gap: float = 0.5 * MILLIMETRE
    rim: float = 1.5
    ring_shift: float = 1.0
    sun_shift: tuple[float, float] = (0.0, 0.9)
    planet_shift: tuple[float, float] = (-0.5, 0.8)
    shift_step: float = 0.1


@dataclass(frozen=True)
class WidthLimits:
    """Face width: at least ``modules`` m, at most ``most_modules`` m and ``sun_diameters`` m z_sun (3.124), in steps
    of ``step`` [m]."""

    modules: float = 6.0
    most_modules: float = 20.0
    sun_diameters: float = 1.6
    step: float = 0.5 * MILLIMETRE

    def range(self, gears: PlanetarySet) -> tuple[np.ndarray, np.ndarray]:
        """Smallest and largest number of steps, of the shape of the batch."""
        most = np.minimum(self.most_modules * gears.sun.module, self.sun_diameters * 2 * gears.sun.reference_radius)
        least = np.ceil(self.modules * gears.sun.module / self.step - 1e-9)
        return least.astype(int), np.floor(most / self.step + 1e-9).astype(int)


@dataclass(frozen=True)
class Safety:
    """Smallest safety factors, dimensionless; 0 leaves it to the report.

    flank, root: fatigue, dimensionless; static_flank, static_root: under the peak torque, dimensionless
    """

    flank: float
    root: float
    static_flank: float
    static_root: float


@dataclass(frozen=True)
class CostScale:
    """Cost = weight m_eq / equivalent_mass + (1 - weight) m / mass, as in the match (3.98).

    mass, equivalent_mass [kg]; weight: dimensionless, 0 to 1; linkage_ratio tau_l [m/rad] takes inertia to the wheel
    shared_factor_cost: added, relative, to the cost of a set whose meshing tooth numbers have a common factor
    """

    mass: float
    equivalent_mass: float
    weight: float
    linkage_ratio: float
    shared_factor_cost: float = 0.05


@dataclass(frozen=True)
class GearRequest:
    """What a gearbox must do and be.

    ratio: fast over slow speed, dimensionless; ratio_tolerance: relative; envelope_diameter [m]; modules [m]
    friction: mu of the teeth, dimensionless
    """

    ratio: float
    ratio_tolerance: float
    stage_count: int
    envelope_diameter: float
    load: StageLoad
    rules: Rules
    safety: Safety
    construction: Construction
    cost: CostScale
    friction: float
    planets: int = 3
    modules: tuple[float, ...] = PREFERRED_MODULES
    teeth: ToothLimits = ToothLimits()
    width: WidthLimits = WidthLimits()
    rack: BasicRack = ISO_53_A

    def __post_init__(self) -> None:
        if not (self.stage_count >= 1 and self.ratio ** (1 / self.stage_count) > 2):
            raise GearError(_no_planets(self.ratio, self.stage_count))

    @property
    def stage_ratios(self) -> tuple[float, float]:
        """Smallest and largest ratio of a stage within the tolerance, dimensionless."""
        ends = (self.ratio * (1 - self.ratio_tolerance), self.ratio * (1 + self.ratio_tolerance))
        low, high = (end ** (1 / self.stage_count) for end in ends)
        return low, high

    def train(self, gears: PlanetarySet, widths: Iterable[float]) -> GearTrain:
        """The gearbox of one set of teeth and the face widths [m] of its stages."""
        stages = tuple(Stage(gears, float(width)) for width in widths)
        return GearTrain(stages, self.envelope_diameter, self.construction, self.rules.material.density, self.friction)


def _no_planets(ratio: float, stages: int) -> str:
    """Sentence on stages whose ratio leaves no room for planets."""
    fewer = max((count for count in range(1, stages) if ratio ** (1 / count) > 2), default=0)
    advice = "a faster rotor needs a larger ratio (match.speed_max_rad_per_s)"
    return (
        f"a stage with a fixed ring needs a ratio above 2; {stages} stages for a ratio of {ratio:.4g} have "
        f"{ratio ** (1 / max(stages, 1)):.3g} each: "
        + (f"use fewer stages, match.gearbox_stages = {fewer}" if fewer else f"{advice}, or drive directly, "
           "match.gearbox_stages = 0")
    )  # fmt: skip


@dataclass(frozen=True)
class Found:
    """Outcome of a search: gearboxes in the order of rising cost, the first is the choice.

    costs: dimensionless; shared: whether meshing tooth numbers of each have a common factor
    sets_formed: sets of teeth and shifts looked at; sets_that_fit: those that can be made and assembled;
    tooth_triples_that_fit: different (module, z_sun, z_planet, z_ring) among them
    """

    trains: tuple[GearTrain, ...]
    costs: tuple[float, ...]
    shared: tuple[bool, ...]
    sets_formed: int
    sets_that_fit: int
    tooth_triples_that_fit: int

    @property
    def best(self) -> GearTrain:
        """The gearbox of least cost."""
        return self.trains[0]


def search(request: GearRequest, keep: int = 10) -> Found:
    """The ``keep`` best gearboxes of a request, different in tooth numbers or module.

    Raises GearError with the constraint to relax when there is none, TooWeakError when teeth fit but break.
    """
    gears, formed = _sets_that_fit(request)
    triples = np.unique(np.stack([gears.sun.module * 1e6, *gears.teeth]), axis=1).shape[1]
    best = _cheapest(gears, request, keep)
    trains = tuple(request.train(gears.at(k), widths) for k, widths, _ in best)
    shared = _shares(gears)
    return Found(
        trains, tuple(cost for *_, cost in best), tuple(bool(shared[k]) for k, *_ in best), formed,
        len(gears.centre_distance), triples,
    )  # fmt: skip


SHARES = (1.0, 0.95, 0.9, 0.8, 0.65, 0.5)  # of the wanted safety factors, tried in this order


def strongest(request: GearRequest, keep: int = 10) -> tuple[Found, str | None]:
    """(``Found``, weakness): the best gearboxes at the wanted safety factors, or at the largest of ``SHARES`` of them.

    weakness: None, or the sentence on what is too weak and what to change; the wanted factors then do not hold.
    Raises TooWeakError when not even the smallest share is reached, GearError when no teeth fit at all.
    """
    refusals: list[TooWeakError] = []
    for share in SHARES:
        safety = Safety(**{kind: share * value for kind, value in asdict(request.safety).items()})
        try:
            return search(replace(request, safety=safety), keep), str(refusals[0]) if refusals else None
        except TooWeakError as error:
            refusals.append(error)
    raise refusals[0]


def tooth_numbers(request: GearRequest, module: float) -> list[tuple[int, int, int]]:
    """All (z_sun, z_planet, z_ring < 0) of a module [m] within ratio tolerance and envelope that can be assembled."""
    low, high = request.stage_ratios
    largest_ring = floor(request.envelope_diameter / module)
    found = []
    for sun in range(request.teeth.least_sun_teeth, ceil(largest_ring / (low - 1)) + 1):
        for ring in range(ceil(sun * (low - 1)), min(floor(sun * (high - 1)), largest_ring) + 1):
            if equally_spaced(sun, ring, request.planets):
                half = (ring - sun) // 2
                found += [(sun, half - less, -ring) for less in _PLANET_OFFSETS if half - less > sun / 4]
    return found


def _sets_that_fit(request: GearRequest) -> tuple[PlanetarySet, int]:
    """All sets that pass the geometry, as a batch, and how many were formed; one module at a time, for the memory."""
    kept: list[PlanetarySet] = []
    checks: list[Checks] = []
    for module in request.modules:
        rows = tooth_numbers(request, module)
        if rows:
            gears = _form(request, np.array(rows), module)
            checks.append(geometry_checks(gears, request))
            kept.append(_select(gears, np.flatnonzero(np.logical_and.reduce(list(checks[-1].values())))))
    _require_any(checks, sum(len(gears.centre_distance) for gears in kept), request)
    return _join(kept), sum(next(iter(one.values())).size for one in checks)


def _form(request: GearRequest, rows: np.ndarray, module: float) -> PlanetarySet:
    """Sets of a module from rows of tooth numbers, with every pair of shifts of the grid."""
    limits = request.teeth
    steps = [
        np.arange(round(low / limits.shift_step), round(high / limits.shift_step) + 1) * limits.shift_step
        for low, high in (limits.sun_shift, limits.planet_shift)
    ]
    shifts = np.stack(np.meshgrid(*steps), axis=-1).reshape(-1, 2)
    teeth = np.repeat(rows, len(shifts), axis=0).T
    modules = np.full(teeth.shape[1], module)
    return planetary_set(teeth, np.tile(shifts, (len(rows), 1)).T, modules, planets=request.planets, rack=request.rack)


def _require_any(checks: list[Checks], count: int, request: GearRequest) -> None:
    """Raise GearError with the constraint that stands in the way when no set passed all the checks."""
    if not checks:
        raise GearError(_no_teeth(request))
    if count:
        return
    together = {name: np.concatenate([one[name] for one in checks]) for name in checks[0]}
    raise GearError(_in_the_way(together, request))


def _no_teeth(request: GearRequest) -> str:
    """Sentence on a stage ratio that no whole teeth give."""
    low, high = request.stage_ratios
    diameter, least = request.envelope_diameter, request.teeth.least_sun_teeth
    largest = 1 + floor(diameter / min(request.modules)) / least
    return (
        f"no tooth numbers with {request.planets} equally spaced planets give a stage ratio of {low:.3f} to "
        f"{high:.3f} inside {diameter / MILLIMETRE:g} mm with at least {least} teeth on the sun, where {largest:.4g} "
        "is the largest: "
        + (f"use more stages, match.gearbox_stages = {_stages_for(request.ratio, largest)}" if low > largest
           else "widen gearbox.ratio_tolerance or change gearbox.planets")
    )  # fmt: skip


def _stages_for(ratio: float, largest: float) -> int:
    """Fewest stages whose ratio is below the largest, with room for three planets (a ratio below 14.9)."""
    return ceil(log(ratio) / log(min(largest, _THREE_PLANETS)))


def geometry_checks(gears: PlanetarySet, request: GearRequest) -> Checks:
    """Which sets satisfy each geometric constraint, by its name, (batch) of bool."""
    limits, m = request.teeth, gears.sun.module
    meshes = (gears.sun_mesh, gears.ring_mesh)
    with np.errstate(invalid="ignore"):
        ratios = np.minimum(*(mesh.contact_ratio for mesh in meshes))
        margins = np.minimum.reduce([margin for mesh in meshes for margin in mesh.flank_margins])
        thick = np.minimum.reduce([gear.tip_thickness for gear in (gears.sun, gears.planet, gears.ring)])
        most = np.maximum(*(mesh.contact_ratio for mesh in meshes))
        cut = np.minimum(gears.sun.shift - gears.sun.least_shift, gears.planet.shift - gears.planet.least_shift)
        return {
            "undercut of sun or planet": cut >= -1e-9,
            "profile shift of the ring": np.abs(gears.ring.shift) <= limits.ring_shift,
            "contact ratio": (ratios >= limits.contact_ratio) & (most < 2),
            "interference with the fillets": margins >= -1e-9 * m,
            "tip thickness": thick >= limits.tip_thickness * m,
            "gap between the planets": gears.planet_gap >= limits.planet_gap,
            "rim of the ring in the envelope":
                gears.ring.root_radius + limits.rim * m <= request.envelope_diameter / 2 + 1e-12,
        }  # fmt: skip


def _in_the_way(checks: Checks, request: GearRequest) -> str:
    """Sentence on the constraint without which most sets would fit, or that fewest satisfy."""
    alone = {name: int(_others(checks, name).sum()) for name in checks}
    name = max(alone, key=alone.__getitem__)
    if not alone[name]:
        name = min(checks, key=lambda key: checks[key].sum())
    return (
        f"none of {checks[name].size} sets of teeth and profile shifts for a ratio of {request.ratio:.4g} in "
        f"{request.stage_count} stages fits; the constraint in the way is the {name}, which {int(checks[name].sum())} "
        f"of them satisfy: {_WAYS_OUT[name]}"
    )


_OTHER_TEETH = "widen gearbox.ratio_tolerance or change match.gearbox_stages, for other teeth to choose from"
_WAYS_OUT = {
    "undercut of sun or planet": _OTHER_TEETH,
    "profile shift of the ring": _OTHER_TEETH,
    "contact ratio": _OTHER_TEETH,
    "interference with the fillets": _OTHER_TEETH,
    "tip thickness": _OTHER_TEETH,
    "gap between the planets": "use fewer planets (gearbox.planets) or more stages (match.gearbox_stages)",
    "rim of the ring in the envelope": "use a larger stator, which the gears have to stay inside "
    "(match.chosen_stator_diameter_mm)",
}


def _others(checks: Checks, name: str) -> np.ndarray:
    return np.asarray(np.logical_and.reduce([passed for other, passed in checks.items() if other != name]))


def _shares(gears: PlanetarySet) -> np.ndarray:
    """Whether sun and planet or planet and ring have a common factor, (batch)."""
    sun, planet, ring = gears.teeth
    return share_a_factor(sun, planet) | share_a_factor(planet, ring)


def _cheapest(gears: PlanetarySet, request: GearRequest, keep: int) -> list[Entry]:
    """[(index, widths of the stages [m], cost)] of the best sets, different in teeth, in the order of rising cost."""
    loads = _stage_loads(request)
    static = [_static_steps(gears, load, request) for load in loads]
    usable = np.logical_and.reduce([steps <= request.width.range(gears)[1] for steps in static])
    if not usable.any():
        raise TooWeakError(_too_weak(gears, request, loads[0]))
    bound = np.where(usable, _cost(gears, static, request), np.inf)
    order, names = np.argsort(bound, kind="stable"), _teeth_names(gears)
    best: list[Entry] = []
    for start in range(0, int(usable.sum()), _BATCH):
        batch = order[start : start + _BATCH]
        batch = batch[np.isfinite(bound[batch])]
        if len(best) >= keep and bound[batch[0]] >= best[-1][2]:
            break
        best = _best_teeth(best + _rated(gears, batch, [s[batch] for s in static], request), names, keep)
    if not best:
        raise TooWeakError(_too_weak(gears, request, loads[0]))
    return best


def _stage_loads(request: GearRequest) -> list[StageLoad]:
    """Load of every stage; behind stage 1 with the smallest stage ratio allowed, on the safe side for the torque."""
    found = [request.load]
    for _ in range(request.stage_count - 1):
        found.append(found[-1].behind(request.stage_ratios[0]))
    return found


def _least_steps(passes: Callable[[np.ndarray], np.ndarray], least: np.ndarray, most: np.ndarray) -> np.ndarray:
    """Smallest steps, (batch), in least ... most for which ``passes(steps)`` holds, most + 1 where none does.

    ``passes`` is taken to hold from some step on: wider teeth are stronger.
    """
    low, high = least.copy(), most + 1
    while np.any(low < high):
        middle = (low + high) // 2
        good = passes(np.minimum(middle, most)) & (middle <= most)
        low, high = np.where(low < high, np.where(good, low, middle + 1), low), np.where(good, middle, high)
        low = np.minimum(low, most + 1)
        high = np.minimum(np.maximum(high, low), most + 1)
    return high


def _static_steps(gears: PlanetarySet, load: StageLoad, request: GearRequest) -> np.ndarray:
    """Width steps from which the peak torque is survived, (batch)."""
    wanted, step = request.safety, request.width.step

    def passes(steps: np.ndarray) -> np.ndarray:
        flank, root = static_ratings(gears, steps * step, load, request.rules)
        good = [flank[name] >= wanted.static_flank for name in flank]
        return np.asarray(np.logical_and.reduce(good + [root[name] >= wanted.static_root for name in root]))

    return _least_steps(passes, *request.width.range(gears))


def _rated(gears: PlanetarySet, batch: np.ndarray, static: list[np.ndarray], request: GearRequest) -> list[Entry]:
    """[(index, widths [m], cost)] of the sets of a batch whose stages also survive the spectrum."""
    part, wanted, step = _select(gears, batch), request.safety, request.width.step
    most = request.width.range(part)[1]

    def endures(load: StageLoad) -> Callable[[np.ndarray], np.ndarray]:
        return lambda steps: survives(part, steps * step, load, request.rules, (wanted.flank, wanted.root))

    loads = zip(_stage_loads(request), static, strict=True)
    needed = [_least_steps(endures(load), least, most) for load, least in loads]
    usable = np.logical_and.reduce([steps <= most for steps in needed])
    cost = _cost(part, needed, request)
    return [
        (int(batch[k]), tuple(float(steps[k] * step) for steps in needed), float(cost[k]))
        for k in np.flatnonzero(usable)
    ]


def _cost(gears: PlanetarySet, steps: list[np.ndarray], request: GearRequest) -> np.ndarray:
    """Cost of sets whose stages have these width steps, (batch)."""
    scale = request.cost
    mass: Batch = 0.0
    inertia: Batch = 0.0
    for number, count in enumerate(steps):
        bodies = request.construction.bodies(
            gears, count * request.width.step, request.envelope_diameter, request.rules.material.density
        )
        mass = mass + total_mass(bodies)
        inertia = inertia + inertia_at_carrier(bodies) * gears.ratio ** (2 * number)
    seen = inertia / scale.linkage_ratio**2
    cost = scale.weight * seen / scale.equivalent_mass + (1 - scale.weight) * mass / scale.mass
    return cost * np.where(_shares(gears), 1 + scale.shared_factor_cost, 1.0)


def _teeth_names(gears: PlanetarySet) -> list[tuple[float, ...]]:
    """(module, z_sun, z_planet, z_ring) of each set, as tuples."""
    return list(zip(gears.sun.module, *gears.teeth, strict=True))


def _best_teeth(found: list[Entry], names: list[tuple[float, ...]], keep: int) -> list[Entry]:
    """The cheapest of each tooth numbers and module, the ``keep`` cheapest of those."""
    chosen: dict[tuple[float, ...], Entry] = {}
    for entry in sorted(found, key=lambda one: (one[2], one[0])):
        chosen.setdefault(names[entry[0]], entry)
    return list(chosen.values())[:keep]


def _select(gears: PlanetarySet, index: np.ndarray) -> PlanetarySet:
    """Part of a batch, still a batch."""

    def part(gear: Gear) -> Gear:
        names = ("teeth", "shift", "module", "tip_radius")
        return replace(gear, **{name: getattr(gear, name)[index] for name in names})

    return PlanetarySet(
        part(gears.sun), part(gears.planet), part(gears.ring), gears.centre_distance[index], gears.planets
    )


def _join(batches: list[PlanetarySet]) -> PlanetarySet:
    """One batch of several."""

    def joined(name: str) -> Gear:
        parts = [getattr(batch, name) for batch in batches]
        numbers = ("teeth", "shift", "module", "tip_radius")
        return replace(parts[0], **{key: np.concatenate([getattr(part, key) for part in parts]) for key in numbers})

    distance = np.concatenate([batch.centre_distance for batch in batches])
    return PlanetarySet(joined("sun"), joined("planet"), joined("ring"), distance, batches[0].planets)


def _too_weak(gears: PlanetarySet, request: GearRequest, load: StageLoad) -> str:
    """Sentence on the set that comes nearest to its safety factors at its largest width."""
    count, width = len(gears.centre_distance), request.width.range(gears)[1] * request.width.step
    flank, root = (np.min(list(part.values()), axis=0) for part in static_ratings(gears, width, load, request.rules))
    strong = np.argsort(-np.minimum(flank, root))[:_BATCH]  # fatigue is rated for the best against the peak
    gears, width = _select(gears, strong), width[strong]
    rating = rate_stage(gears, width, load, request.rules)
    reached = {
        kind: np.min(np.stack(list(getattr(rating, kind).values())), axis=0) / max(getattr(request.safety, kind), 1e-9)
        for kind in ("flank", "root", "static_flank", "static_root")
    }
    best = int(np.argmax(np.minimum.reduce(list(reached.values()))))
    kind = min(reached, key=lambda name: reached[name][best])
    wanted = getattr(request.safety, kind)
    return (
        f"all {count} sets of teeth that fit are too weak; the strongest, module "
        f"{gears.sun.module[best] / MILLIMETRE:g} mm with {width[best] / MILLIMETRE:g} mm wide teeth, reaches a safety "
        f"factor {kind} of {reached[kind][best] * wanted:.3f} in stage 1 where {wanted:g} is wanted: lower "
        f"gearbox.safety_{kind}, use a better steel (gearbox.material), a larger stator "
        "(match.chosen_stator_diameter_mm) or more planets (gearbox.planets)"
    )
