"""How good the advice on what to measure next is: ``python -m benchmarks.recommender_score``.

A case is a virtual bench with one hidden effect of which only a part has been measured, too little to be sure. Each
option is another part of the same campaign, read by the same instruments. All are tried, and the case is judged by what
each does to the probability of the truth:

    share of the oracle = mean (P after the advised option - P before) / mean (P after the best option - P before)

beside it what the best fixed option gives, the same one in every case, and what a blind choice gives on average.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.virtual_benches.damper_bench import CATALOGUE as DAMPER
from benchmarks.virtual_benches.dq_bench import CATALOGUE as DQ
from benchmarks.virtual_benches.hiding import hide
from effects.library import library
from workbench.data.campaign import read_campaign
from workbench.data.stack import rows_of
from workbench.data.table import Campaign, Table
from workbench.explain.explore import Posterior
from workbench.explain.recommend import gains_of
from workbench.explain.search import searched
from workbench.explain.tried import Search
from workbench.likelihood.bench import bench_of
from workbench.models.base import Option
from workbench.models.bases import nominal_model

CATALOGUES = {"damper": DAMPER, "dq": DQ}
TUNING_START = 12000
SURE = 0.9  # probability of the truth from which nothing more need be measured
LIKELY = 0.02  # probability of the truth from which it is among what is weighed; with less there is nothing to separate
NOTHING_YET = 0.5  # probability of "nothing is missing" above which there is no question yet
VISIBLE = 50.0  # chi2 of the effect in the whole campaign; below it no measurement of it can tell
SAME_LAW = (frozenset({"winding_temperature", "contact_resistance"}),)  # one law, two names
PARTS = {  # name of a part -> file, and the condition and its value where the part is not the whole table
    "damper": {
        "shunt 1 ohm": ("force_velocity.csv", {"shunt": 1.0}),
        "shunt 0.5 ohm": ("force_velocity.csv", {"shunt": 0.5}),
        "shunt 10 ohm": ("force_velocity.csv", {"shunt": 10.0}),
        "open, velocity": ("force_velocity.csv", {"shunt": 1e6}),
        "back-EMF": ("open_circuit.csv", {}),
        "impedance 1 ohm": ("impedance.csv", {"shunt": 1.0, "amplitude": 2e-3}),
        "impedance, open": ("impedance.csv", {"shunt": 1e6}),
        "impedance, small": ("impedance.csv", {"amplitude": 5e-4}),
    },
    "dq": {
        "back-EMF": ("back_emf.csv", {}),
        "drag": ("drag.csv", {}),
        "operation": ("operation.csv", {}),
        "short circuit": ("short_circuit.csv", {}),
    },
}
MEASURED = {"damper": "shunt 1 ohm", "dq": "short circuit"}  # the part that each case begins with


@dataclass(frozen=True)
class Tried:
    """One case. before: P(truth) of what was measured;  after: with each option;  advised: its expected gain [nats]"""

    bench: str
    seed: int
    truth: str
    before: float
    after: Mapping[str, float]
    advised: Mapping[str, float]

    @property
    def choice(self) -> str:
        """What the recommender would measure."""
        return max(self.advised, key=self.advised.get)

    @property
    def gains(self) -> dict[str, float]:
        return {name: p - self.before for name, p in self.after.items()}


@dataclass(frozen=True)
class RecommenderScore:
    """Mean gain of P(truth): by advice, at best, by the best fixed option of each bench, by a blind choice."""

    cases: int
    advised: float
    oracle: float
    fixed: float
    blind: float

    @property
    def share(self) -> float:
        return self.advised / self.oracle if self.oracle > 0 else float("nan")

    @property
    def passed(self) -> bool:
        """At least 0.8 of the oracle, and better than the best fixed option."""
        return self.share >= 0.8 and self.advised > self.fixed


def score(cases: Iterable[Tried]) -> RecommenderScore:
    """The figures of some cases; the fixed option is chosen with hindsight, one a bench."""
    cases = list(cases)
    mean = lambda values: float(np.mean(list(values)))  # noqa: E731
    fixed = []
    for bench in {case.bench for case in cases}:
        mine = [case.gains for case in cases if case.bench == bench]
        best = max(mine[0], key=lambda name: mean(gains[name] for gains in mine))
        fixed += [gains[best] for gains in mine]
    return RecommenderScore(
        len(cases),
        mean(case.gains[case.choice] for case in cases),
        mean(max(case.gains.values()) for case in cases),
        mean(fixed),
        mean(mean(case.gains.values()) for case in cases),
    )


def tried(bench: str, seed: int) -> Tried | None:
    """One case with all its options; None where the data in hand do not leave several effects, the truth among them."""
    made, answer = hide(CATALOGUES[bench], "single", seed)
    truth = next(iter(answer.effects))
    if answer.visibility[truth] < VISIBLE:
        return None
    with tempfile.TemporaryDirectory() as folder:
        whole = read_campaign(made.write(Path(folder) / made.id))
        search, p = _searched(_part(whole, bench, MEASURED[bench]))
        before = _probability(p, truth)
        if not LIKELY < before < SURE or p.nothing > NOTHING_YET:
            return None
        names = [name for name in PARTS[bench] if name != MEASURED[bench]]
        advised = gains_of(search, p, [_option(whole, bench, name) for name in names])
        after = {n: _probability(_searched(_part(whole, bench, MEASURED[bench], n))[1], truth) for n in names}
    return Tried(bench, seed, truth, before, after, dict(zip(names, map(float, advised))))


def _searched(campaign: Campaign) -> tuple[Search, Posterior]:
    search = searched(bench_of(nominal_model(campaign), campaign, library()), library())
    return search, search.posterior


def _probability(p: Posterior, truth: str) -> float:
    """Of the truth, or of another name of the same law."""
    return p.any_of(next((same for same in SAME_LAW if truth in same), frozenset({truth})))


def _rows(table: Table, bench: str, parts: Iterable[str]) -> np.ndarray:
    """Rows of a table that belong to some parts (n,) bool."""
    chosen = np.zeros(table.rows, dtype=bool)
    for file, where in (PARTS[bench][name] for name in parts):
        if file == table.file:
            chosen |= np.all([np.isclose(table.conditions[c], v) for c, v in where.items()] or [~chosen], axis=0)
    return chosen


def _part(whole: Campaign, bench: str, *parts: str) -> Campaign:
    """The campaign with some parts only."""
    tables = [rows_of(table, _rows(table, bench, parts)) for table in whole.tables]
    return replace(whole, tables=tuple(table for table in tables if table.rows))


def _option(whole: Campaign, bench: str, name: str) -> Option:
    """A part as what could be measured, the rows of it to be fitted; of the readings only the declared u is used."""
    table = next(t for t in _part(whole, bench, name).tables)
    rows = rows_of(table, ~table.held_out)
    random = {r.name: r.random for r in rows.responses.values()}
    return Option(rows.kind, name, dict(rows.conditions), random)


def ambiguous(bench: str, start: int, count: int, most: int = 200) -> Iterator[Tried]:
    """The first cases from a seed on in which there is something to advise; at most so many seeds are looked at."""
    left = count
    for seed in range(start, start + most):
        case = tried(bench, seed) if left else None
        if case is not None:
            left -= 1
            yield case


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--from", type=int, default=TUNING_START, dest="start", help="first seed")
    parser.add_argument("--count", type=int, default=10, help="cases of each bench")
    parser.add_argument("--bench", choices=sorted(CATALOGUES), help="only this bench")
    chosen = parser.parse_args(arguments)
    cases = []
    for bench in [chosen.bench] if chosen.bench else CATALOGUES:
        for case in ambiguous(bench, chosen.start, chosen.count):
            print(_line(case), flush=True)
            cases.append(case)
    found = score(cases)
    print(f"{found.cases} cases: advised {found.advised:.3f}, oracle {found.oracle:.3f}, share {found.share:.2f}, "
          f"best fixed option {found.fixed:.3f}, blind choice {found.blind:.3f}")  # fmt: skip


def _line(case: Tried) -> str:
    best = max(case.after, key=case.after.get)
    return (
        f"{case.bench} {case.seed} {case.truth}: {case.before:.2f} -> {case.after[case.choice]:.2f} by {case.choice}; "
        f"at best {case.after[best]:.2f} by {best}"
    )


if __name__ == "__main__":
    main()
