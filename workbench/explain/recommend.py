"""What to measure next: the option that is expected to separate the remaining explanations best for its cost.

    U(m) = sum over i < j of p_i p_j [ D_ij(data + m) - D_ij(data) ],   D at most CAP nats

over the hypotheses "nothing", the leading effects as fitted and the unknown function at its mean; D_ij is the smaller
of both expected log-Bayes factors. Everything is a quadratic form of sums over rows, so that a new row is one more
outer product.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from workbench.data.column_units import for_people
from workbench.data.kinds import KINDS
from workbench.data.stack import rows_of, stacked
from workbench.data.table import Response, Table
from workbench.errors import WorkbenchError
from workbench.explain.explore import Posterior
from workbench.explain.hypotheses import Hypothesis
from workbench.explain.tried import Search
from workbench.findings import NextMeasurement
from workbench.likelihood.bench import Bench
from workbench.likelihood.fit import with_parameters
from workbench.likelihood.predictor import STEP, jacobian
from workbench.likelihood.unknown_laws import LAWS
from workbench.models.base import Option

CAP = 20.0  # nats; more certainty than this is worth nothing
FLOOR = 0.02  # least weight of a hypothesis: what is unlikely now is not forgotten
LEADERS = 5  # explanations that are weighed against one another
POINTS = 12  # operating points of a recommended measurement
LISTED = 6
STRETCHES = (0.5, 2.0)  # factors on one condition that make a new measurement of an old kind


@dataclass(frozen=True, eq=False)
class _Forms:
    """Sums over rows of products of whitened columns: nuisances first, then a block of each hypothesis.

    blocks: columns of each hypothesis, its change first, then its slopes;  weights: of the hypotheses (h,)
    """

    nuisances: int
    blocks: tuple[tuple[int, ...], ...]
    weights: np.ndarray

    def utility(self, gram: np.ndarray) -> np.ndarray:
        """Weighed sum of all D for sums of products (..., c, c)."""
        m = self.nuisances
        inner = np.eye(m) + gram[..., :m, :m]
        cross = gram[..., :m, m:]
        seen = gram[..., m:, m:] - np.swapaxes(cross, -1, -2) @ np.linalg.solve(inner, cross)
        total = np.zeros(gram.shape[:-2])
        for i, j in combinations(range(len(self.blocks)), 2):
            both = _expected(seen, self.blocks[i], self.blocks[j]), _expected(seen, self.blocks[j], self.blocks[i])
            # "nothing" can never be true against an effect by the data, only the other way round
            nats = np.minimum(*both) if self.blocks[i] and self.blocks[j] else np.maximum(*both)
            total = total + self.weights[i] * self.weights[j] * np.minimum(nats, CAP)
        return total


def _expected(seen: np.ndarray, true: tuple[int, ...], other: tuple[int, ...]) -> np.ndarray:
    """Expected log-Bayes factor [nats] of one hypothesis over another, both as fitted, from products of what the
    nuisances leave (..., k, k). The columns of a hypothesis stand side by side.

        D = 1/2 min over v of |W_true - W_other - T v|^2 + |v|^2

    W: change of the readings;  T: slopes of the other hypothesis over its standard normal parameters v, which can
    follow only as far as their prior lets them
    """
    signed = [(k, sign) for block, sign in ((true, 1.0), (other, -1.0)) for k in block[:1]]
    products = sum(sign * seen[..., k] for k, sign in signed)
    size = sum(sign * products[..., k] for k, sign in signed)
    if not other[1:]:
        return 0.5 * np.maximum(size, 0.0)
    slopes = slice(other[1], other[-1] + 1)
    along, block = products[..., slopes], seen[..., slopes, slopes] + np.eye(len(other) - 1)
    if len(other) == 2:  # a division, not a system of one equation for each of many rows
        return 0.5 * np.maximum(size - along[..., 0] ** 2 / block[..., 0, 0], 0.0)
    followed = np.sum(along * np.linalg.solve(block, along[..., None])[..., 0], axis=-1)
    return 0.5 * np.maximum(size - followed, 0.0)


def next_measurements(search: Search, p: Posterior) -> tuple[NextMeasurement, ...]:
    """The best few measurements, most nats for their cost first; empty where nothing was fitted."""
    weighing = _weighing(search, p)
    if weighing is None:
        return ()
    found = []
    for option in options_of(search.bench, search.unknown):
        try:
            found.append(_best_rows(option, *weighing))
        except WorkbenchError:
            continue  # the model cannot answer there
    ranked = sorted(found, key=lambda m: (-m.gain_nats / m.cost, m.words))
    return tuple(m for m in ranked if m.gain_nats > 0)[:LISTED]


def gains_of(search: Search, p: Posterior, options: Sequence[Option]) -> np.ndarray:
    """U [nats] of each option with all its rows (options,); zero where nothing was fitted or there is no answer."""
    weighing = _weighing(search, p)
    return np.array([_gain_of_all(option, *weighing) if weighing else 0.0 for option in options])


def _weighing(search: Search, p: Posterior) -> tuple[_Forms, _Columns, np.ndarray] | None:
    """What the leading hypotheses are weighed with, and the sums over the rows that were fitted."""
    known = [names for names in search.ranked if names and not names & LAWS.keys() and names in p.sets]
    bench = search.bench
    hypotheses = [h for h in (search.fitted[names] for names in known[:LEADERS]) if _has_an_answer(bench, h)]
    if not hypotheses:
        return None
    columns = _Columns(bench, hypotheses)
    have = columns.of_fit(bench.fit.white(search.unknown * bench.fit.white.sigma))
    return _forms(bench, hypotheses, p), columns, have.T @ have


def _has_an_answer(bench: Bench, h: Hypothesis) -> bool:
    """Without the tolerances that were fitted with it, too."""
    try:
        bench.fit.predictor.predict(bench.null.x, h.effects)
    except WorkbenchError:
        return False
    return True


def _gain_of_all(option: Option, forms: _Forms, columns: _Columns, gram: np.ndarray) -> float:
    try:
        values, _ = columns.of_option(option)
    except WorkbenchError:
        return 0.0
    return float(forms.utility(gram + values.T @ values) - forms.utility(gram))


def _forms(bench: Bench, hypotheses: Sequence[Hypothesis], p: Posterior) -> _Forms:
    m = len(bench.null.x)
    blocks, place = [()], 0
    for h in hypotheses:
        blocks.append(tuple(range(place, place + 1 + len(h.fit.z))))
        place += 1 + len(h.fit.z)
    blocks.append((place,))
    weights = np.array([p.nothing, *(p.sets[h.names] for h in hypotheses)]).clip(FLOOR)
    weights = np.append(weights, p.none_of_these)  # whose readings elsewhere nobody knows: no floor
    return _Forms(m, tuple(blocks), weights / weights.sum())


@dataclass(frozen=True, eq=False)
class _Columns:
    """Whitened derivatives to the nuisances, and change and slopes of every hypothesis, for any rows."""

    bench: Bench
    hypotheses: Sequence[Hypothesis]

    def of_fit(self, unknown: np.ndarray) -> np.ndarray:
        """Of the rows that were fitted (n, c)."""
        fit = self.bench.fit
        return np.column_stack([fit.white(self._raw(fit.predictor)), unknown])

    def of_option(self, option: Option) -> tuple[np.ndarray, int]:
        """Of the rows of an option, independent readings (responses * n, c), and its number of responses."""
        responses = {name: Response(name, np.zeros(len(u)), u, "") for name, u in option.random.items()}
        n = len(next(iter(option.random.values())))
        zero = np.zeros(n, dtype=int)
        stack = stacked([Table(option.kind, "option", option.conditions, responses, zero, zero, zero.astype(bool))])
        unknown = np.concatenate([(option.unknown or {}).get(c.response, np.zeros(n)) for c in stack.channels])
        raw = self._raw(self.bench.fit.predictor.on(stack)) / stack.u[:, None]
        return np.column_stack([raw, unknown]), len(responses)

    def _raw(self, predictor) -> np.ndarray:
        x = self.bench.null.x
        base = predictor.predict(x)
        added = [self._added(predictor, h, base) for h in self.hypotheses]
        return np.hstack([jacobian(predictor, x, (), base), *added])

    def _added(self, predictor, h: Hypothesis, base: np.ndarray) -> np.ndarray:
        """Change and slopes of a hypothesis; none where it has no answer, so that nothing is expected to tell it by
        (rows, 1 + k)."""
        x, z = self.bench.null.x, h.fit.z
        try:
            there = predictor.predict(x, h.effects)
            ends = z + np.diag(np.where(z < 0, STEP, -STEP))
            moved = [predictor.predict(x, with_parameters(h.fit.effects, end)) for end in ends]
        except WorkbenchError:
            return np.zeros((len(base), 1 + len(z)))
        slopes = [(one - there) / (end[k] - z[k]) for k, (one, end) in enumerate(zip(moved, ends))]
        return np.column_stack([there - base, *slopes])


def _best_rows(option: Option, forms: _Forms, columns: _Columns, gram: np.ndarray) -> NextMeasurement:
    """Operating points chosen one after the other, each the one that adds most."""
    values, responses = columns.of_option(option)
    n = len(values) // responses
    rows = values.reshape(responses, n, -1)
    products = np.einsum("rni,rnj->nij", rows, rows)
    start = forms.utility(gram)
    chosen: list[int] = []
    for _ in range(min(POINTS, n)):
        gains = forms.utility(gram + products)
        gains[chosen] = -np.inf
        best = int(np.argmax(gains))
        chosen.append(best)
        gram = gram + products[best]
    gain = float(forms.utility(gram) - start)
    cost = option.cost * len(chosen) / POINTS
    return NextMeasurement(option.kind, option.words, _listed(option, chosen), gain, cost)


def _listed(option: Option, chosen: list[int]) -> dict[str, list[float]]:
    """Operating points in the units people use, in the order of the rows."""
    order = sorted(chosen)
    listed = {}
    for name, values in option.conditions.items():
        unit, factor = for_people(name)
        listed[f"{name} / {unit}" if unit else name] = [float(f"{factor * values[k]:.5g}") for k in order]
    return listed


def options_of(bench: Bench, unknown: np.ndarray) -> list[Option]:
    """What could be measured: every table again and with one condition stretched, and all that the base model proposes.

    unknown: expected unknown function on the rows to fit, of their uncertainty (n,)
    """
    base, tables = bench.model.base, range(len(bench.fit.stack.tables))
    again = [option for number in tables for option in _options_of_table(bench, number, unknown)]
    return [*again, *base.options(bench.model.design, bench.campaign)]


def _options_of_table(bench: Bench, number: int, unknown: np.ndarray) -> list[Option]:
    stack = bench.fit.stack
    table = stack.tables[number]
    once = table.repeat == table.repeat[:1]
    channels = [c for c in stack.channels if c.table == number]
    random = {c.response: bench.fit.white.sigma[c.rows][once] for c in channels}
    pattern = {c.response: unknown[c.rows][once] for c in channels}
    conditions = rows_of(table, once).conditions
    cost = KINDS[table.kind].cost
    found = [Option(table.kind, f"measure {table.file} once more", conditions, random, cost, pattern)]
    for name in (n for n in conditions if _can_be_stretched(n, conditions[n])):
        for factor in STRETCHES:
            there = {**conditions, name: factor * conditions[name]}
            wide = {r: s * max(1.0, factor) for r, s in random.items()}
            words = f"measure {table.kind} with {name} {_span(name, there[name])}"
            found.append(Option(table.kind, words, there, wide, 1.2 * cost, pattern))
    return [option for option in found if len(next(iter(option.random.values())))]


def _can_be_stretched(name: str, values: np.ndarray) -> bool:
    """Not a direction, an angle or a temperature, and not a shunt that stands for open terminals too."""
    if name == "direction" or "angle" in name or name.endswith("_T") or not np.any(values):
        return False
    return not (name == "shunt" and np.ptp(values) > 1e5)


def _span(name: str, values: np.ndarray) -> str:
    unit, scale = for_people(name)
    low, high = scale * np.abs(values).min(), scale * np.abs(values).max()
    return (f"{low:.4g} to {high:.4g} {unit}" if high > low else f"{high:.4g} {unit}").strip()
