"""What does a laboratory mean by its columns? Conventions are settled before any effect is looked for.

Every reading of a table that ``mistakes`` knows, alone and with a second one, and every zero of the angle over the
full turn, is a hypothesis with a likelihood (``misfit``). A fix that several files share is believed once: it is one
habit. Each must be preferred overwhelmingly, so that no physical effect is taken for a convention.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import exp

import numpy as np

from units import DEGREE
from workbench.data.checks import checks_of
from workbench.data.conventions import (
    ANGLE,
    DEVICE,
    NAMES,
    AngleDirection,
    AngleUnit,
    AngleZero,
    DeviceFactor,
    Fix,
    IgnoredColumns,
    InvertedColumns,
    LeftOut,
    Offset,
    Scaled,
    SwappedColumns,
    TemperatureScale,
    angle_factors,
    applied,
    merged,
    pole_pairs,
    section_of,
    section_text,
    stated_factors,
)
from workbench.data.table import Campaign, Response, Table
from workbench.errors import WorkbenchError
from workbench.explain.misfit import Sums, allowances, predicted, sums
from workbench.explain.mistakes import (
    COMMON,
    HAND_SET,
    NEAR,
    OVERWHELMING,
    RARE,
    Order,
    compatible,
    cost_of_zero,
    factors_of_constant,
    nearest,
    of_the_table,
    orders,
    quantity,
    scaled_groups,
    slack,
    wrong_kelvins,
    zero_grid,
)
from workbench.explain.verdict import CONVENTION
from workbench.findings import Diagnosis
from workbench.models.base import Progress
from workbench.models.bases import redesigned
from workbench.models.model import Model

POOL = 16  # readings of a table that are kept
SECONDS = 6  # leading readings of a table that a second fix is tried beside
BEAM = 60  # readings of a campaign that are kept while its tables are gone through
ALIKE = 3.0  # nats of likelihood between two readings that the data cannot tell apart
ALIKE_FACTOR = 9.0  # the same between two factors on one column, since a hidden effect of 15 % moves one to the other
ONCE_MORE = 0.3  # nats for a fix that another file needs too
APART = 4.0  # nats where tables of one encoder do not agree about its angle
SAME = 1.0  # nats that a fix may cost a table that cannot tell whether it needs it
OFF_BY_ONE_FACTOR = 5.0  # nats for a device whose readings of one quantity are all off by one factor, up to NEAR
MET = 0.12  # relative misfit of a channel, below which there is nothing to settle in it
DRAWN = 1.0  # nats for a wrong constant of the device before a wrong column: it is copied once, from a sheet
FAR = 0.3  # misfit of a channel, from which constants of the device are doubted
EXPLAINED = 0.5  # that a channel may be left with by a fix that improves it; signs and exchanges have no size to fit
EXPLAINED_SIGN = 0.8
LEFT = 0.5  # of the misfit before, that another unit of a constant may leave: drag that nobody knows is no other unit
POWER = 0.3  # misfit against taking power, that a drag may be left with by a change of its sign
LOUD = 10.0  # times its uncertainty that a drag must be, before its sign is judged
BETTER = 0.8  # of the misfit before, that counts as improved
SCANNED_ROWS = 60  # of a table over the full turn
SCAN_STEP = 5 * DEGREE  # electrical, of ``zero_grid``
FEW = 5  # readings at one value that may be chance
CLIPPED_SHARE = 0.02  # of the readings of a channel
BEYOND = 0.7  # share of the readings at an end that the model must place beyond it
STUCK_RUN = 8  # equal readings one after the other
STUCK_MOVES = 0.5  # of the rms of a channel that the model must change meanwhile


@dataclass(frozen=True)
class Found:
    """One fix. log_odds: nats that the data prefer it by, after what it is believed;  probability: that it is needed"""

    fix: Fix
    log_odds: float
    probability: float


@dataclass(frozen=True, eq=False)
class Conventions:
    """What was settled.

    found: the fixes;  campaign: with them applied;  probability: that something is wrong with the conventions
    names: of what is wrong, from ``data.conventions.NAMES``, with the names of readings that are as simple and likely
    sentences: what it looks like, for people;  fix: the text for campaign.toml;  checks: what needs no model
    """

    found: tuple[Found, ...]
    campaign: Campaign
    probability: float
    names: tuple[str, ...] = ()
    sentences: tuple[str, ...] = ()
    fix: str = ""
    checks: tuple[str, ...] = ()

    @property
    def are_right(self) -> bool:
        """Whether nothing has to be settled."""
        return not self.found

    @property
    def advice(self) -> tuple[str, ...]:
        """What to do before effects are looked for."""
        said = ("Say so in campaign.toml and no effect is looked for before: the text is below.",)
        if any(isinstance(found.fix, Scaled) for found in self.found):
            said += ("Where the readings are right as they are, a factor of 1 says so, and it is not doubted again.",)
        return said


def settle(model: Model, campaign: Campaign, progress: Progress = lambda words: None) -> Conventions:
    """The conventions of a campaign.

    model: effects that it has are left out, beside one of them what is right may look wrong
    """
    progress("settling conventions")
    model = replace(model, base=model.base.anywhere(model.design), effects=())
    told = tuple(fix for table in campaign.tables for fix in wrong_kelvins(table))
    declared, campaign = campaign, applied(campaign, told)
    readers = [_Reader(model, campaign, table) for table in campaign.tables if table.responses]
    readings = _readings_of_all(readers)
    best = sorted([*_joint(readings), *_of_device(readers)], key=lambda w: -w.net)
    fixes = _sharpened(readers, _habits(readers, best[0].fixes))
    repaired = applied(campaign, fixes)
    broken = tuple(_broken_channels(redesigned(model, campaign, repaired), repaired))
    return _conventions(declared, readers, readings, best, fixes, told + broken)


def diagnosis_of(conventions: Conventions, model: Model, seed: int, wall_s: float) -> Diagnosis:
    """The diagnosis of a campaign whose conventions are not settled: no effect is looked for."""
    return Diagnosis(
        campaign=conventions.campaign.id,
        model=model.base.name,
        effects=model.names,
        verdict=CONVENTION,
        names=conventions.names,
        probability=conventions.probability,
        seed=seed,
        wall_s=wall_s,
        complaints=conventions.campaign.complaints,
        checks=conventions.checks,
        fix=conventions.fix,
        conventions=(*conventions.sentences, *conventions.advice),
        provenance=dict(conventions.campaign.file_hashes),
    )


# ---- one table -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Reading:
    """What one table may mean. log_likelihood: see ``misfit``;  costs: of each fix, minus ln of its belief

    errors: misfit of the channels relative to their readings, by the column that is believed to hold them
    """

    fixes: tuple[Fix, ...]
    costs: tuple[float, ...]
    log_likelihood: float
    errors: Mapping[str, float] = field(default_factory=dict, compare=False)

    @property
    def net(self) -> float:
        return self.log_likelihood - sum(self.costs) - OVERWHELMING * len(self.costs)

    def explains(self, before: Reading, most: float, share: float = 1.0) -> bool:
        """Whether every channel that it improves is left with no more than that, and than a share of what it was."""
        both = zip(before.errors.values(), self.errors.values())
        return all(now <= min(most, share * was) or now > BETTER * was for was, now in both)


class _Reader:
    """Tries what a table may mean."""

    def __init__(self, model: Model, campaign: Campaign, table: Table):
        self.model, self.campaign, self.table = model, campaign, table
        self.pairs = pole_pairs(campaign)
        self.turns = ANGLE in table.conditions and bool(self.pairs)
        self.allowed = allowances(model, table, campaign.tolerances)
        self.angles = angle_factors(campaign, table) if self.turns else {}
        self.stated = stated_factors(campaign, table.file)
        doubted = [part for part in of_the_table(table, self.pairs, self.angles) if not self._is_stated(part[0])]
        self.first = doubted + self._offsets()
        self.slack = slack(self.pairs) if self.pairs and self.turns else np.zeros(1)
        self._orders: dict[tuple[str, ...], list[Order]] = {}

    def _is_stated(self, fix: Fix) -> bool:
        """Whether the campaign states the factor that a fix would change."""
        return isinstance(fix, Scaled) and not self.stated.isdisjoint(fix.columns)

    def orders(self, names: tuple[str, ...]) -> list[Order]:
        if names not in self._orders:
            self._orders[names] = orders(self.table.file, names)
        return self._orders[names]

    def read(self, fixes: Iterable[Fix]) -> Table:
        table = self.table
        for fix in sorted(fixes, key=lambda f: f.place):
            table = fix.apply(table)
        return table

    def sums(self, fixes: Iterable[Fix], offsets: np.ndarray | None = None) -> Sums:
        table = self.read(fixes)
        return sums(self.model, table, self.slack if offsets is None else offsets, self.allowed)

    def readings(self) -> list[Reading]:
        """The best readings, with at most two fixes and a zero of the angle."""
        nothing = self.as_it_is
        met = np.maximum(MET, 1.5 * self.allowed)
        if np.all(np.array(list(nothing.errors.values())) < met):
            return [nothing]
        none: tuple[tuple[Fix, float], ...] = ()
        found = self.with_responses(none)
        for one in self.first:
            found += self.with_responses((one,))
        if self.turns:
            found += self._turned()
        best = max(found, key=lambda r: r.net)
        if max(best.errors.values()) > (2 * MET if best.fixes else EXPLAINED_SIGN):
            found += self._seconds(found)
        return _best([nothing] + [reading for reading in found if self._explains(reading)])

    @cached_property
    def as_it_is(self) -> Reading:
        """The reading without any fix, of the device as drawn or of one that is off by a factor that effects reach."""
        drawn = self._alone((), (), self.slack)
        found = self.sums((), self.slack)
        same, best = np.arange(len(found.names))[None], drawn.log_likelihood
        for group in scaled_groups(found.names):
            members = np.array([name in group for name in found.names])
            gain = np.clip(found.gains(same[0], np.ones(len(same[0])), members), exp(-NEAR), exp(NEAR))
            off = found.log_likelihood(same, np.where(members, gain, 1.0)[None]).max()
            best = max(best, float(off) - OFF_BY_ONE_FACTOR)
        return replace(drawn, log_likelihood=best)

    def _alone(self, fixes: tuple[Fix, ...], costs: tuple[float, ...], offsets: np.ndarray) -> Reading:
        found = self.sums(fixes, offsets)
        same = np.arange(len(found.names))[None]
        one = np.ones(same.shape)
        errors = dict(zip(found.names, found.errors(same, one)[0].tolist()))
        return Reading(fixes, costs, float(found.log_likelihood(same, one).max()), errors)

    @property
    def _is_loud(self) -> bool:
        """Whether the readings stand far above their uncertainty, so that an offset or drift is none of their sign."""
        return all(np.mean((r.values / r.random) ** 2) > LOUD**2 for r in self.table.responses.values())

    def _explains(self, reading: Reading) -> bool:
        """Whether every channel that a reading improves is well met with it."""
        sized = any(isinstance(f, (Scaled, AngleUnit, Offset, TemperatureScale)) for f in reading.fixes)
        if self.table.kind == "drag" and reading.fixes:
            exchanged = any(isinstance(f, SwappedColumns) for f in reading.fixes)  # their product is the same power
            return self._is_loud and not exchanged and max(reading.errors.values()) < POWER
        return reading.explains(self.as_it_is, EXPLAINED if sized else EXPLAINED_SIGN)

    def _seconds(self, found: Sequence[Reading]) -> list[Reading]:
        """A second fix of the table beside the leading ones."""
        more: list[Reading] = []
        known = {fix: cost for fix, cost in self.first}
        leaders = [r for r in sorted(found, key=lambda r: -r.net) if r.fixes and all(f in known for f in r.fixes)]
        for leader in [r for r in leaders if len(r.fixes) == 1][:SECONDS]:
            for fix, cost in self.first:
                if compatible(leader.fixes, fix):
                    more += self.with_responses(((leader.fixes[0], known[leader.fixes[0]]), (fix, cost)), most=2)
        return more

    def with_responses(self, base: tuple[tuple[Fix, float], ...], most: int = 2) -> list[Reading]:
        """Readings with given fixes and what the responses may mean besides."""
        found = self.sums(fix for fix, _ in base)
        room = max(most - len(base), 0)
        chosen = [order for order in self.orders(found.names) if len(order.fixes) <= room]
        holds, sign = np.array([o.holds for o in chosen]), np.array([o.sign for o in chosen])
        likelihood, errors = found.log_likelihood(holds, sign).max(axis=0), found.errors(holds, sign)
        out = [self._reading(base, o, (), float(v), e) for o, v, e in zip(chosen, likelihood, errors)]
        if room:
            out += self._scaled(base, found, chosen, room)
        return _best(out)

    def _reading(self, base: tuple[tuple[Fix, float], ...], order: Order, more, value: float, errors) -> Reading:
        parts = [*base, *more]
        fixes = tuple(f for f, _ in parts) + order.fixes
        costs = tuple(c for _, c in parts) + (
            (order.cost / len(order.fixes),) * len(order.fixes) if order.fixes else ()
        )
        return Reading(fixes, costs, value, dict(enumerate(errors.tolist())))

    def _scaled(self, base, found: Sums, chosen: list[Order], room: int) -> list[Reading]:
        """With a factor on some responses; only beside orders that leave room for it."""
        out = []
        for order in (o for o in chosen if len(o.fixes) < room):
            for group in (g for g in scaled_groups(found.names) if self.stated.isdisjoint(g)):
                members = np.array([name in group for name in found.names])
                gain = found.gains(order.holds, order.sign, members)
                alone = len(group) == 1 < sum(quantity(n) == quantity(group[0]) for n in found.names)
                for nice in nearest(group[0], 1 / gain, self.pairs, alone) if gain > 0 else ():
                    gains = order.sign * np.where(members, 1 / nice.value, 1.0)
                    value = float(found.log_likelihood(order.holds[None], gains[None]).max())
                    errors = found.errors(order.holds[None], gains[None])[0]
                    fix = Scaled(self.table.file, group, nice.value, nice.means)
                    out.append(self._reading(base, order, ((fix, nice.cost),), value, errors))
        return out

    def _offsets(self) -> list[tuple[Fix, float]]:
        """Zeros of responses that lie farther off than everything that was measured is large."""
        if self.table.kind == "drag":
            return []
        nominal = predicted(self.model, self.table, np.zeros(1))[0]
        out: list[tuple[Fix, float]] = []
        for k, r in enumerate(self.table.responses.values()):
            weight = 1 / r.random**2
            off = float(np.sum(weight * (r.values - nominal[k])) / np.sum(weight))
            if abs(off) > 2 * np.sqrt(np.mean(nominal[k] ** 2)) > 0:
                out.append((Offset(self.table.file, r.name, off, r.unit if r.scale != 1.0 else ""), RARE))
        return out

    # ---- the angle ---------------------------------------------------------------------------------------------------

    def _turned(self) -> list[Reading]:
        """Readings with another zero of the angle, for every direction and unit of it."""
        found: list[Reading] = []
        directions: list[tuple[tuple[Fix, float], ...]] = [
            (), ((AngleDirection(self.table.file), COMMON + 1.5),),
            ((InvertedColumns(self.table.file, (ANGLE,)), COMMON),),
        ]  # fmt: skip
        units: list[tuple[tuple[Fix, float], ...]] = [()]
        units += [((fix, cost),) for fix, cost in self.first if isinstance(fix, AngleUnit)]
        for direction in directions:
            for unit in units:
                found += self.zeros(direction + unit)
        return found

    def zeros(self, base: tuple[tuple[Fix, float], ...]) -> list[Reading]:
        """Readings with a zero of the angle from the full turn, for the orders of the responses that it suits best."""
        grid, fixes = zero_grid(self.pairs), [fix for fix, _ in base]
        found = sums(self.model, self.read(fixes), grid, self.allowed, SCANNED_ROWS)
        chosen = [order for order in self.orders(found.names) if len(order.fixes) < 3 - len(base)]
        value = found.log_likelihood(np.array([o.holds for o in chosen]), np.array([o.sign for o in chosen]))
        value[np.abs(grid) < HAND_SET / self.pairs] = -np.inf
        places = np.argmax(value >= value.max(axis=0) - 0.5, axis=0)  # the smallest of equal ones
        scores = [float(row[k]) - o.cost - OVERWHELMING * len(o.fixes) for o, k, row in zip(chosen, places, value.T)]
        leaders = np.argsort(scores)[::-1][:3]
        return [r for k in leaders if (r := self._near(base, chosen[k], float(grid[places[k]]))) is not None]

    def _near(self, base: tuple[tuple[Fix, float], ...], order: Order, zero: float) -> Reading | None:
        """The best zero near one."""
        grid = zero + np.linspace(-1.0, 1.0, 21) * SCAN_STEP / self.pairs
        grid = grid[np.abs(grid) > HAND_SET / self.pairs]
        found = self.sums((fix for fix, _ in base), grid) if len(grid) else None
        if found is None:
            return None
        value = found.log_likelihood(order.holds[None], order.sign[None])[:, 0]
        errors = found.errors(order.holds[None], order.sign[None])[0]
        return self._reading(base, order, (self._zero(float(grid[value.argmax()])),), float(value.max()), errors)

    def _zero(self, zero: float) -> tuple[Fix, float]:
        return AngleZero(self.table.file, zero), cost_of_zero(zero, self.slots, self.pairs)

    @property
    def slots(self) -> float | None:
        slots = self.campaign.device.get("slots")
        return float(slots) if isinstance(slots, (int, float)) else None

    def has(self, fix: Fix) -> bool:
        """Whether the table has what a fix is about."""
        if isinstance(fix, Scaled):
            return all(column in self.table.conditions for column in fix.columns)
        return self.turns

    def fall(self, fixes: Iterable[Fix], more: Fix) -> float:
        """Nats that one more fix costs."""
        mine = tuple(fix for fix in fixes if fix.file == self.table.file)
        without = self._alone(mine, (), self.slack).log_likelihood
        return without - self._alone((*mine, replace(more, file=self.table.file)), (), self.slack).log_likelihood

    def again(self, reading: Reading) -> Reading:
        """A reading of the angle that another table proposed, for this one."""
        fixes = tuple(replace(fix, file=self.table.file) for fix in reading.fixes)
        has_zero = any(isinstance(fix, AngleZero) for fix in fixes)
        return self._alone(fixes, reading.costs, self.slack / 4 if has_zero else self.slack)


def _best(found: Iterable[Reading]) -> list[Reading]:
    """The best of each set of fixes, the leading ones."""
    kept: dict[frozenset[Fix], Reading] = {}
    for reading in found:
        key = frozenset(reading.fixes)
        if key not in kept or reading.log_likelihood > kept[key].log_likelihood:
            kept[key] = reading
    ordered = sorted(kept.values(), key=lambda r: -r.net)
    nothing = [r for r in ordered[POOL:] if not r.fixes]
    return ordered[:POOL] + nothing


# ---- all tables ------------------------------------------------------------------------------------------------------


def _readings_of_all(readers: Sequence[_Reader]) -> list[list[Reading]]:
    """The readings of every table, and those of the angle that other tables propose."""
    own = [reader.readings() for reader in readers]
    shared = [part for readings in own for r in readings[:8] if (part := _of_the_angle(r)) is not None]
    out = []
    for reader, readings in zip(readers, own):
        more = [reader.again(r) for r in shared] if reader.turns else []
        out.append(_best(readings + more)[: POOL + 1])
    return out


def _of_the_angle(reading: Reading) -> Reading | None:
    """What it says of the angle alone."""
    kept = [(f, c) for f, c in zip(reading.fixes, reading.costs) if _is_of_the_angle(f)]
    return Reading(tuple(f for f, _ in kept), tuple(c for _, c in kept), 0.0) if kept else None


def _is_of_the_angle(fix: Fix) -> bool:
    return isinstance(fix, (AngleZero, AngleUnit, AngleDirection)) or fix.anywhere == InvertedColumns("", (ANGLE,))


@dataclass(frozen=True)
class _Whole:
    """A reading of some tables. habits: fixes without their file -> cost"""

    fixes: tuple[Fix, ...]
    habits: Mapping[Fix, float]
    log_likelihood: float
    net: float

    def with_table(self, reading: Reading) -> _Whole:
        habits, net = dict(self.habits), self.net + reading.log_likelihood
        for fix, cost in zip(reading.fixes, reading.costs):
            net -= ONCE_MORE if fix.anywhere in habits else cost + OVERWHELMING
            habits[fix.anywhere] = cost
        return _Whole(self.fixes + reading.fixes, habits, self.log_likelihood + reading.log_likelihood, net)

    def agreeing(self, turning: int) -> _Whole:
        """With what it costs that only some of the tables with an angle share a habit of the angle."""
        of_angle = [fix.anywhere for fix in self.fixes if _is_of_the_angle(fix)]
        apart = sum(of_angle.count(habit) < turning for habit in set(of_angle))
        return replace(self, net=self.net - APART * apart)

    @property
    def posterior(self) -> float:
        """ln of likelihood times belief."""
        return self.net


def _joint(readings: Sequence[Sequence[Reading]]) -> list[_Whole]:
    """Readings of the whole campaign, the best first."""
    beam = [_Whole((), {}, 0.0, 0.0)]
    for of_table in readings:
        longer = [whole.with_table(reading) for whole in beam for reading in of_table]
        beam = sorted(longer, key=lambda w: -w.net)[:BEAM]
        nothing = min(longer, key=lambda w: len(w.fixes))
        beam += [nothing] if nothing not in beam else []
    turning = sum(any(_is_of_the_angle(f) for r in of_table for f in r.fixes) for of_table in readings)
    return sorted((whole.agreeing(turning) for whole in beam), key=lambda w: -w.net)


def _of_device(readers: Sequence[_Reader]) -> list[_Whole]:
    """Readings of the whole campaign with a constant of the device that is not what its key says, where a table is
    missed by far. An expansion about a drawing is not asked: lengths of a machine have a scale of their own."""
    far = any(max(r.as_it_is.errors.values(), default=0.0) > FAR for r in readers)
    if not far or readers[0].model.base.is_expansion:
        return []
    fixes = _of_constants(readers[0].campaign.device)
    return [whole for fix, cost in fixes if (whole := _with_device(readers, fix, cost)) is not None]


def _of_constants(device: Mapping[str, object]) -> Iterator[tuple[Fix, float]]:
    """What constants of a device may mean, with what each costs."""
    numbers = ((key, v) for key, v in device.items() if isinstance(v, (int, float)) and v)
    for key, number in numbers:
        for nice in factors_of_constant(key):
            yield DeviceFactor(DEVICE, key, number, nice.value, nice.means), nice.cost + DRAWN


def _with_device(readers: Sequence[_Reader], fix: Fix, cost: float) -> _Whole | None:
    """None where there is no such device, or a table that it changes is not met with it."""
    before = readers[0].campaign
    campaign = applied(before, [fix])
    try:
        model = redesigned(readers[0].model, before, campaign)
    except WorkbenchError:
        return None
    again = [_Reader(model, campaign, reader.table).as_it_is for reader in readers]
    if not all(one.explains(reader.as_it_is, EXPLAINED, LEFT) for one, reader in zip(again, readers)):
        return None
    likelihood = sum(one.log_likelihood for one in again)
    return _Whole((fix,), {fix.anywhere: cost}, likelihood, likelihood - cost - OVERWHELMING)


def _habits(readers: Sequence[_Reader], fixes: tuple[Fix, ...]) -> tuple[Fix, ...]:
    """The fixes, and those of the angle and the speed also in tables that cannot tell, if no table speaks against."""
    for habit in dict.fromkeys(fix.anywhere for fix in fixes if _is_of_the_shaft(fix)):
        rest = [r for r in readers if not any(f.anywhere == habit for f in fixes if f.file == r.table.file)]
        falls = [r.fall(fixes, habit) for r in rest if r.has(habit)]
        if all(fall < SAME for fall in falls):
            fixes += tuple(replace(habit, file=r.table.file) for r in rest if r.has(habit))
    return fixes


def _is_of_the_shaft(fix: Fix) -> bool:
    return _is_of_the_angle(fix) or isinstance(fix, Scaled) and fix.columns == ("speed",)


def _sharpened(readers: Sequence[_Reader], fixes: tuple[Fix, ...]) -> tuple[Fix, ...]:
    """The zero of the angle as all tables that have it see it best."""
    zeros = {fix.zero for fix in fixes if isinstance(fix, AngleZero)}
    for zero in zeros:
        tables = [f.file for f in fixes if isinstance(f, AngleZero) and f.zero == zero]
        mine = [r for r in readers if r.table.file in tables]
        off = np.linspace(-1.0, 1.0, 101) * HAND_SET / (4 * mine[0].pairs)
        total = 0.0
        for reader in mine:
            found = reader.sums([f for f in fixes if f.file == reader.table.file], off)
            same = np.arange(len(found.names))[None]
            total = total + found.log_likelihood(same, np.ones(same.shape))[:, 0]
        better = zero + float(off[int(np.argmax(total))])
        fixes = tuple(replace(f, zero=better) if isinstance(f, AngleZero) and f.zero == zero else f for f in fixes)
    return fixes


# ---- channels that are broken ----------------------------------------------------------------------------------------


def _broken_channels(model: Model, campaign: Campaign) -> list[Fix]:
    """Readings that stop at the end of a range or do not change any more while the device does."""
    found: list[Fix] = []
    for table in campaign.tables:
        nominal = predicted(model, table, np.zeros(1))[0] if table.responses else ()
        for r, s in zip(table.responses.values(), nominal):
            found += _clipped(table, r, s) or _stuck(table, r, s)
    return found


def _stuck(table: Table, r: Response, s: np.ndarray) -> list[Fix]:
    moves = STUCK_MOVES * np.sqrt(np.mean(s**2))
    if table.rows >= 4 and np.ptp(r.values) == 0 and np.ptp(s) > moves > 0:
        return [IgnoredColumns(table.file, (r.name,))] if len(table.responses) > 1 else []
    ends = np.flatnonzero(np.append(np.diff(r.values) != 0, True))
    starts = np.append(0, ends[:-1] + 1)
    for start, end in zip(starts, ends):
        if end - start + 1 >= STUCK_RUN and np.ptp(s[start : end + 1]) > moves > 0:
            return [LeftOut(table.file, r.name, float(r.values[start]), r.unit if r.scale != 1 else "", "stuck")]
    return []


def _as_large(s: np.ndarray, readings: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """The model as large as the readings are in some rows: an effect may lie in them besides."""
    square = float(np.sum(s[rows] ** 2))
    return s * (float(np.sum(readings[rows] * s[rows])) / square) if square > 0 else s


def _clipped(table: Table, r: Response, s: np.ndarray) -> list[Fix]:
    found: list[Fix] = []
    if np.ptp(r.values) == 0:
        return found
    for sign, edge in ((1, r.values.max()), (-1, r.values.min())):
        at = r.values == edge
        s = _as_large(s, r.values, (r.values < r.values.max()) & (r.values > r.values.min()))
        beyond = sign * (s - edge) > 0
        far = sign * (s - edge) > ALLOWED_BEYOND * abs(edge)
        enough = at.sum() >= max(FEW, CLIPPED_SHARE * table.rows)
        if enough and beyond[at].mean() >= BEYOND and far.any() and at[far].mean() >= BEYOND:
            found.append(LeftOut(table.file, r.name, float(edge), r.unit if r.scale != 1 else ""))
    return found


ALLOWED_BEYOND = 0.1  # of an end, by which the model must go beyond it somewhere


# ---- what is said ----------------------------------------------------------------------------------------------------

SAID = 3  # other readings at most that are said
SETTLED = 0.75  # probability that a convention is wrong, below which effects are looked for all the same


def _conventions(campaign, readers, readings, best: list[_Whole], fixes, broken) -> Conventions:
    everything = fixes + broken
    if not everything or not broken and _p_wrong(best) < SETTLED:
        return Conventions((), campaign, _p_wrong(best), checks=checks_of(campaign))
    others = _equivalents(best)
    found = tuple(Found(fix, *_odds(fix, best, fixes)) for fix in everything)
    simple = [other.fixes for other in others if _as_simple(other, best[0])]
    probability = 1.0 if broken else _p_wrong(best)
    return said_of(campaign, found, probability, [other.fixes for other in others], simple)


def said_of(
    campaign: Campaign,
    found: Sequence[Found],
    probability: float,
    others: Sequence[tuple[Fix, ...]],
    simple: Sequence[tuple[Fix, ...]],
) -> Conventions:
    """What is said where fixes are needed. others: what the data cannot tell from these;  simple: of that, what is as
    simple and likely"""
    fixes = tuple(one.fix for one in found)
    section, repaired = section_of(fixes), applied(campaign, fixes)
    of_files = {file: entry for file, entry in section.items() if file != DEVICE}
    repaired = replace(repaired, conventions=merged(campaign.conventions, of_files))
    names, sentences = _names_of([fixes, *simple]), _sentences(fixes, others)
    return Conventions(
        tuple(found), repaired, probability, names, sentences, _text(section, others), checks_of(campaign)
    )


def _p_wrong(best: list[_Whole]) -> float:
    """Probability that some fix is needed."""
    with_fixes = [w.posterior for w in best if w.fixes]
    without = [w.posterior for w in best if not w.fixes]
    if not with_fixes:
        return 0.0
    return float(1 / (1 + np.exp(np.clip(max(without, default=-np.inf) - np.logaddexp.reduce(with_fixes), -700, 700))))


def _odds(fix: Fix, best: list[_Whole], fixes: tuple[Fix, ...]) -> tuple[float, float]:
    """Nats before the best reading without this fix, and the probability."""
    if not any(type(fix) is type(other) and fix.file == other.file for other in fixes):
        return np.inf, 1.0
    without = [w.posterior for w in best if not any(type(f) is type(fix) and f.file == fix.file for f in w.fixes)]
    odds = best[0].posterior - max(without, default=-np.inf)
    return float(odds), float(1 / (1 + np.exp(-min(max(odds, -700.0), 700.0))))


def _equivalents(best: list[_Whole]) -> list[_Whole]:
    """Other readings that the data cannot tell from the leading one, simplest first; not those that only say more."""
    lead = best[0]
    habits = [set(lead.habits)]
    out = []
    for other in best[1:]:
        mine = set(other.habits)
        alike = ALIKE_FACTOR if _other_factors(mine, set(lead.habits)) else ALIKE
        near = other.log_likelihood > lead.log_likelihood - alike
        if near and len(mine) <= len(lead.habits) + 1 and not any(h <= mine for h in habits):
            habits.append(mine)
            out.append(other)
    return sorted(out, key=lambda w: len(w.habits))


def _other_factors(one: set[Fix], other: set[Fix]) -> bool:
    """Whether two readings differ by the sizes of factors alone."""
    bare = [{replace(f, factor=1.0, means=()) if isinstance(f, Scaled) else f for f in fixes} for fixes in (one, other)]
    return bare[0] == bare[1]


def _as_simple(other: _Whole, lead: _Whole) -> bool:
    alike = ALIKE_FACTOR if _other_factors(set(other.habits), set(lead.habits)) else ALIKE
    return len(other.habits) <= len(lead.habits) and other.net > lead.net - alike


def _names_of(readings: Iterable[tuple[Fix, ...]]) -> tuple[str, ...]:
    named = [name for fixes in readings for fix in fixes for name in fix.names]
    return tuple(name for name in dict.fromkeys(named) if name in NAMES)


def _sentences(fixes: tuple[Fix, ...], others: Sequence[tuple[Fix, ...]]) -> tuple[str, ...]:
    said = [f"{_files(fixes, words)}: {words}." for words in dict.fromkeys(fix.words for fix in fixes)]
    if others:
        same = "; ".join(map(_words, others[:SAID]))
        said.append(f"These data cannot tell that from: {same}.")
    return tuple(said)


def _words(fixes: tuple[Fix, ...]) -> str:
    return " and ".join(dict.fromkeys(fix.words for fix in fixes))


def _text(section: Mapping[str, Mapping[str, object]], others: Sequence[tuple[Fix, ...]]) -> str:
    """The section for campaign.toml; below it, as comments, what to write instead where another reading is right."""
    instead = [f"or, {_words(fixes)}:\n{section_text(section_of(fixes))}" for fixes in others[:SAID]]
    comments = [f"# {line}" for text in instead for line in text.splitlines() if line != "[conventions]"]
    return "\n".join([section_text(section).rstrip("\n"), *comments]) + "\n"


def _files(fixes: Iterable[Fix], words: str) -> str:
    return ", ".join(dict.fromkeys(fix.file for fix in fixes if fix.words == words))
