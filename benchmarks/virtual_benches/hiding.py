"""Hides effects in a bench: draws the device, its tolerances, instruments and noise, and says what could be seen of it.

A catalogue describes one kind of bench: what can be hidden in it, how it is laid out, and how its truth is simulated.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from benchmarks.virtual_benches.case import GROUPS, VISIBLE, Answer, Bench, Series
from benchmarks.virtual_benches.instruments import Noise, readings, room_temperature, scan_shapes, white, with_gaps

FREE = 1e4  # prior size of a free effect, in units of one standard deviation of all data
PLAUSIBLE = 0.3  # share of a column of readings by which a truth outside the library may change it
SMALL = (0.3, 3.0)  # chi2 of the one small effect that is left out of every model
SIZINGS = 30  # sizes that are tried until a chi2 is met
STEPS = 4  # of Gauss and Newton
CLOSE_TO = 0.2  # relative error of a chi2 that is wanted
SEVERAL = (3, 3, 4)  # effects at once in the group of that name, drawn alike
REDRAWN = 15  # times that several effects are drawn until each of them can be seen beside the others
OUTSIDE = (30.0, 1000.0)  # chi2 that a truth outside the library keeps when the best single effect is fitted to it


@dataclass(frozen=True)
class Hidden:
    """Something that may be hidden: size between low and high, log-uniform, of either sign where ``signed``."""

    low: float
    high: float
    apply: Callable[[Any, float], Any]  # (state, size) -> state
    signed: bool = False
    alone: bool = False  # cannot be combined with every other effect

    def size(self, rng: np.random.Generator) -> float:
        size = float(np.exp(rng.uniform(np.log(self.low), np.log(self.high))))
        return size * (float(rng.choice([-1.0, 1.0])) if self.signed else 1.0)


@dataclass(frozen=True, eq=False)
class Layout:
    """One table as planned. conditions: what is logged (n,) of one repeat;  declared: size of u from the responses."""

    file: str
    kind: str
    conditions: Mapping[str, np.ndarray]
    u_random: Mapping[str, str]
    declared: Callable[[Mapping[str, np.ndarray]], Mapping[str, np.ndarray]]


@dataclass(frozen=True, eq=False)
class Setup:
    """A bench before anything is hidden. state: device and instruments in truth, at nominal."""

    device: Mapping[str, object]
    tolerance: Mapping[str, float]
    systematic: Mapping[str, tuple[str, float]]
    layouts: Sequence[Layout]
    state: Any
    repeats: int


class Catalogue(Protocol):
    """What can be hidden on one kind of bench, and the truth that answers.

    effects: of the library;  outside: laws that no effect of it has
    """

    name: str
    effects: Mapping[str, Hidden]
    outside: Mapping[str, Hidden]
    tuning_kinds: frozenset[str]  # names of ``outside`` that may be looked at; the others are for the score
    alike: Sequence[frozenset[str]]  # effects of which no two are hidden together: one law, or one holds the other

    def setup(self, rng: np.random.Generator) -> Setup: ...

    def moved(self, setup: Setup, state: Any, name: str, z: float) -> Any:
        """The state with a tolerance or systematic of the setup moved by z standard deviations."""

    # forms, where there are any: name of an effect -> further (state, size) -> state, of other second parameters
    # settled(state) -> state, where there is one: called once the tolerances are drawn, before anything is hidden

    def simulate(self, setup: Setup, state: Any) -> list[dict[str, np.ndarray]]:
        """Responses of every table, one repeat, free of random error and of drift."""

    def drifts(self, state: Any) -> dict[str, float]:
        """By how much a response column drifts from the first to the last row of each scan, SI."""


@dataclass(frozen=True, eq=False)
class _Judge:
    """Measures how far a change of the truth stands out of noise, tolerances and instruments."""

    catalogue: Catalogue
    setup: Setup
    state: Any
    noise: Noise

    @cached_property
    def declared(self) -> list[Mapping[str, np.ndarray]]:
        """Declared uncertainties of every table at the nominal state."""
        nominal = self.catalogue.simulate(self.setup, self.setup.state)
        return [layout.declared(reference) for layout, reference in zip(self.setup.layouts, nominal)]

    def visibility(self, changed: Any, sensitivities: np.ndarray, base: np.ndarray) -> float:
        """chi2 that the change adds in the fitted repeats after tolerances and instruments took what they can."""
        r = self.stacked(changed) - base
        left = r - sensitivities @ np.linalg.solve(
            np.eye(sensitivities.shape[1]) + sensitivities.T @ sensitivities, sensitivities.T @ r
        )
        return float(r @ left)

    def beyond_tolerances(self, changed: Any, sensitivities: np.ndarray, base: np.ndarray) -> float:
        """As ``visibility``, with tolerances and instruments as far from linear as the bench itself is.

        Gauss and Newton's steps with the sensitivities of the start; the smallest sum of what is left and of the
        penalty counts. An effect that is a tolerance under another name adds its square in standard deviations.
        """
        r = self.stacked(changed) - base
        curvature = np.eye(sensitivities.shape[1]) + sensitivities.T @ sensitivities
        z, followed, least = np.zeros(len(curvature)), np.zeros_like(r), np.inf
        bent = len(self._tolerances)  # the columns behind are offsets and slopes of scans, which are linear
        for _ in range(STEPS):
            z = z + np.linalg.solve(curvature, sensitivities.T @ (r - followed) - z)
            try:
                followed = self.stacked(self._with_tolerances(z[:bent])) - base + sensitivities[:, bent:] @ z[bent:]
            except ValueError:  # farther than the truth of this bench can answer: no tolerance goes there
                break
            least = min(least, float((r - followed) @ (r - followed) + z @ z))
        return min(least, float(r @ r))

    def _with_tolerances(self, z: np.ndarray) -> Any:
        state = self.state
        for name, size in zip(self._tolerances, z):
            state = self.catalogue.moved(self.setup, state, name, float(size))
        return state

    @property
    def _tolerances(self) -> list[str]:
        return [*self.setup.tolerance, *self.setup.systematic]

    def stacked(self, state: Any) -> np.ndarray:
        """All responses over their uncertainty, freed of the correlation of their noise; fitted repeats count as a
        smaller uncertainty."""
        weight = self.weight
        tables = self.catalogue.simulate(self.setup, state)
        parts = []
        drifts = self.catalogue.drifts(state)
        for responses, u in zip(tables, self.declared):
            parts += [_drifted(responses[name], drifts.get(name, 0.0)) / u[name] * weight for name in responses]
        return np.concatenate([white(part, self.noise) for part in parts])

    @property
    def weight(self) -> float:
        """Of the fitted repeats and of the true size of the noise, on a reading over its declared uncertainty."""
        return np.sqrt(max(self.setup.repeats - 1, 1)) / self.noise.scale

    def sensitivities(self, base: np.ndarray) -> np.ndarray:
        moved = [self.catalogue.moved(self.setup, self.state, name, 1.0) for name in self._tolerances]
        own = np.stack([self.stacked(state) - base for state in moved], axis=1)
        return np.hstack([own, self.remounting(len(base))]) if self.noise.remount else own

    def remounting(self, n: int) -> np.ndarray:
        """What the mean offset and slope of the fitted scans do to ``stacked``, one standard deviation (n, columns)."""
        columns, row = [], 0
        for u in (values for table in self.declared for values in table.values()):
            shapes = scan_shapes(u) / u[:, None] * self.noise.remount / self.noise.scale
            for shape in shapes.T:
                column = np.zeros(n)
                column[row : row + len(u)] = white(shape, self.noise)
                columns.append(column)
            row += len(u)
        return np.stack(columns, axis=1)

    def signatures(self, base: np.ndarray) -> list[np.ndarray]:
        """What each effect of the catalogue would do at its middle size, (n, forms) an effect: where it has more
        parameters than its size, in several forms that may be added up."""
        further = getattr(self.catalogue, "forms", {})
        return [
            self._forms((hidden.apply, *further.get(name, ())), float(np.sqrt(hidden.low * hidden.high)), base)
            for name, hidden in self.catalogue.effects.items()
        ]

    def _forms(self, forms: Sequence[Callable], size: float, base: np.ndarray) -> np.ndarray:
        return np.stack([self.stacked(apply(self.state, size)) - base for apply in forms], axis=1)


def hide(
    catalogue: Catalogue, group: str, seed: int, wanted: tuple[str, ...] = (), kinds: Sequence[str] = ()
) -> tuple[Bench, Answer]:
    """One blind case of a group from a seed; see ``case.Answer``.

    wanted: names of what to hide instead of drawing it, for a story or a test
    kinds: names of ``outside`` to draw from, all where empty
    """
    case = _drawn(catalogue, group, seed, wanted, kinds)
    small = case.scene.with_a_small_one(case.truth, case.answer.outside, case.rng)
    noise = case.scene.judge.noise
    bench = measured(catalogue, case.scene.judge.setup, small, noise, f"{catalogue.name}-{group}-{seed}", case.rng)
    return bench, case.answer


def bare(
    catalogue: Catalogue, group: str, seed: int, wanted: tuple[str, ...] = (), kinds: Sequence[str] = ()
) -> tuple[Bench, Bench]:
    """The same bench as ``hide`` makes, without and with what is hidden, one repeat free of random error."""
    case = _drawn(catalogue, group, seed, wanted, kinds)
    judge = case.scene.judge
    once, still = replace(judge.setup, repeats=1), Noise.still()
    name = f"{catalogue.name}-{group}-{seed}"
    without, changed = (measured(catalogue, once, state, still, name, case.rng) for state in (judge.state, case.truth))
    return without, changed


@dataclass(frozen=True, eq=False)
class _Drawn:
    scene: _Scene
    truth: Any
    answer: Answer
    rng: np.random.Generator


def _drawn(catalogue: Catalogue, group: str, seed: int, wanted: tuple[str, ...], kinds: Sequence[str]) -> _Drawn:
    rng = np.random.default_rng([seed, GROUPS.index(group), sum(catalogue.name.encode())])
    setup, noise = catalogue.setup(rng), Noise.drawn(rng)
    state = setup.state
    for name in [*setup.tolerance, *setup.systematic]:
        state = catalogue.moved(setup, state, name, float(rng.standard_normal()))
    if hasattr(catalogue, "settled"):
        state = catalogue.settled(state)
    judge = _Judge(catalogue, setup, state, noise)
    base = judge.stacked(state)
    scene = _Scene(judge, base, judge.sensitivities(base), tuple(kinds or catalogue.outside))
    truth, answer = scene.outside(seed, wanted, rng) if group == "outside" else scene.inside(group, seed, wanted, rng)
    fitted = float(max(setup.repeats - 1, 1))
    about = noise.told | {"fitted": fitted}
    return _Drawn(scene, truth, replace(answer, about=about), rng)


@dataclass(frozen=True, eq=False)
class _Scene:
    """A bench with its tolerances drawn, before anything is hidden. kinds: outside truths to draw from"""

    judge: _Judge
    base: np.ndarray
    sensitivities: np.ndarray
    kinds: tuple[str, ...]

    @property
    def catalogue(self) -> Catalogue:
        return self.judge.catalogue

    def outside(self, seed: int, wanted: tuple[str, ...], rng: np.random.Generator) -> tuple[Any, Answer]:
        """A truth that no effect describes, as large as the best single effect leaves of it what is drawn."""
        free = [FREE * s / np.linalg.norm(s, axis=0) for s in self.judge.signatures(self.base)]

        def strange(changed: Any) -> float:
            """chi2 that is left when the best single effect, of any size and sign, has taken what it can."""
            columns = (np.hstack([self.sensitivities, s]) for s in free)
            return min(self.judge.visibility(changed, each, self.base) for each in columns)

        for name in wanted or [str(kind) for kind in rng.permutation(self.kinds)]:
            truth, chi2 = _sized(self.catalogue.outside[name], self.judge.state, log_uniform(OUTSIDE, rng), strange)
            if wanted or self._is_plausible(truth):
                break
        return truth, Answer(self.catalogue.name, "outside", seed, outside=name, visibility={name: chi2})

    def _is_plausible(self, truth: Any) -> bool:
        """Whether no column of readings changes by more than ``PLAUSIBLE`` of what such columns read, rms."""
        before, after = (self.catalogue.simulate(self.judge.setup, state) for state in (self.judge.state, truth))
        size: dict[str, float] = {}
        for name, values in (item for table in before for item in table.items()):
            size[name] = max(size.get(name, 0.0), _rms(values))
        pairs = [(name, t[name] - b[name]) for b, t in zip(before, after) for name in b]
        return all(_rms(change) <= PLAUSIBLE * size[name] for name, change in pairs)

    def inside(self, group: str, seed: int, wanted: tuple[str, ...], rng: np.random.Generator) -> tuple[Any, Answer]:
        """Effects of the library; several are drawn again until each of them can be seen beside the others."""
        count = {"null": 0, "single": 1, "pair": 2, "several": int(rng.choice(SEVERAL)), "mistake": 0}[group]
        drawn = []
        for _ in range(REDRAWN if count > 2 else 1):
            names = wanted or _chosen(self.catalogue, count, rng)
            sizes = {name: self.catalogue.effects[name].size(rng) for name in names}
            seen = self._seen(sizes)
            drawn.append((min(seen.values(), default=np.inf), sizes, seen))
            if drawn[-1][0] >= VISIBLE:
                break
        _, sizes, seen = max(drawn, key=lambda one: one[0])
        return self._hidden(sizes), Answer(self.catalogue.name, group, seed, sizes, visibility=seen)

    def _hidden(self, sizes: Mapping[str, float]) -> Any:
        truth = self.judge.state
        for name, size in sizes.items():
            truth = self.catalogue.effects[name].apply(truth, size)
        return truth

    def _seen(self, sizes: Mapping[str, float]) -> dict[str, float]:
        """chi2 of each effect beyond tolerances and instruments, and beyond the others at any size."""
        if len(sizes) == 1:
            return {n: self.judge.beyond_tolerances(self._hidden(sizes), self.sensitivities, self.base) for n in sizes}
        return {name: self._beside(name, sizes) for name in sizes}

    def _beside(self, name: str, sizes: Mapping[str, float]) -> float:
        others = {other: size for other, size in sizes.items() if other != name}
        without = self.judge.stacked(self._hidden(others))
        columns = [self.judge.stacked(self._hidden({other: size})) - self.base for other, size in others.items()]
        free = np.stack([FREE * column / max(np.linalg.norm(column), 1e-9) for column in columns], axis=1)
        return self.judge.visibility(self._hidden(sizes), np.hstack([self.sensitivities, free]), without)

    def with_a_small_one(self, truth: Any, outside: str, rng: np.random.Generator) -> Any:
        """With something below detection that no model has; it may act on what is hidden, beside which it is small."""
        with_it = self.judge.stacked(truth)
        name = str(rng.choice([kind for kind in self.kinds if kind != outside]))

        def small(changed: Any) -> float:
            return self.judge.visibility(changed, self.sensitivities, with_it)

        left_out, chi2 = _sized(self.catalogue.outside[name], truth, log_uniform(SMALL, rng), small)
        return left_out if chi2 < 2 * SMALL[1] else truth


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _chosen(catalogue: Catalogue, count: int, rng: np.random.Generator) -> list[str]:
    """Names of different effects, drawn alike; together only those that can be combined and are not one law."""
    names = [name for name, hidden in catalogue.effects.items() if count < 2 or not hidden.alone]
    while True:
        chosen = [str(name) for name in rng.choice(names, count, replace=False)]
        if not any(len(group & set(chosen)) > 1 for group in catalogue.alike):
            return chosen


def _sized(hidden: Hidden, state, chi2: float, seen) -> tuple[Any, float]:
    """The state with the thing in it, and its visibility: the wanted one within CLOSE_TO, or where that is not met the
    nearest that was tried.

    chi2 grows with the square of a small size, but not where there is a threshold: between a size that is too small
    and one that is too large the next is in the middle of their logarithms, unless the square lies between them.
    """
    place = np.log(hidden.size(np.random.default_rng(0)))
    low, high, tried = -np.inf, np.inf, []
    for _ in range(SIZINGS):
        changed = hidden.apply(state, float(np.exp(place)))
        found = max(seen(changed), 1e-12)
        tried.append((abs(np.log(found / chi2)), len(tried), changed, found))
        if tried[-1][0] < CLOSE_TO:
            break
        low, high = (place, high) if found < chi2 else (low, place)
        place += float(np.clip(0.5 * np.log(chi2 / found), -3.5, 3.5))
        if not low < place < high or len(tried) % 3 == 0 and np.isfinite(low + high):
            place = 0.5 * (low + high)
    return min(tried)[2:]


def log_uniform(between: tuple[float, float], rng: np.random.Generator) -> float:
    """A number between two others, each order of magnitude alike."""
    return float(np.exp(rng.uniform(*np.log(between))))


def measured(catalogue, setup: Setup, truth, noise: Noise, name: str, rng) -> Bench:
    """The truth as read by the instruments, all repeats; one scan of the bench drifts."""
    answers = catalogue.simulate(setup, truth)
    drifting = int(rng.integers(sum(len(responses) for responses in answers)))
    series, channel = [], 0
    for layout, responses in zip(setup.layouts, answers):
        rows = len(next(iter(responses.values())))
        repeat = np.repeat(np.arange(setup.repeats), rows)
        read, declared = {}, layout.declared(responses)
        for column, values in responses.items():
            many = np.tile(_drifted(values, catalogue.drifts(truth).get(column, 0.0)), setup.repeats)
            u = np.tile(declared[column], setup.repeats)
            read[column] = readings(many, u, repeat, noise, channel == drifting, rng)
            channel += 1
        conditions = {key: np.tile(values, setup.repeats) for key, values in layout.conditions.items()}
        if noise.logs:
            conditions["room_T_degC"] = room_temperature(len(repeat), rng)
        read = with_gaps(read, rng) if noise.logs and layout is setup.layouts[0] else read
        series.append(Series(layout.file, layout.kind, repeat, conditions, read, layout.u_random))
    return Bench(name, setup.device, setup.tolerance, setup.systematic, tuple(series))


def _drifted(values: np.ndarray, drift: float) -> np.ndarray:
    return values + drift * np.linspace(0.0, 1.0, len(values))
