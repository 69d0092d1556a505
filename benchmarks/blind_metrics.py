"""What blind cases say about the diagnosis: shares with exact bounds, calibration, coverage, errors that are left.

A case is a dictionary as ``blind_score.score_case`` returns it. Bounds: Clopper and Pearson (1934), one-sided 95 %.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from scipy.stats import beta

from benchmarks.virtual_benches.case import VISIBLE

LEVEL = 0.95  # of a one-sided bound
SURE = 0.95  # stated probability
# The same law under two names: no measurement of these benches can tell them apart.
TWINS = ({"winding_temperature", "contact_resistance"},)
NAMING = ("effect", "group", "pair")
ABSTAINING = ("none_of_these", "partial")


@dataclass(frozen=True)
class Metric:
    """One line of the score. value with its bounds; gate: what it has to be; passed: None where nothing is demanded."""

    name: str
    value: float
    low: float
    high: float
    n: int
    gate: str
    passed: bool | None


def bounds(right: int, n: int) -> tuple[float, float]:
    """One-sided lower and upper 95 % bounds of a share, each for itself."""
    if n == 0:
        return 0.0, 1.0
    low = beta.ppf(1 - LEVEL, right, n - right + 1) if right else 0.0
    high = beta.ppf(LEVEL, right + 1, n - right) if right < n else 1.0
    return float(low), float(high)


def is_named(name: str, names: Iterable[str]) -> bool:
    """Whether the truth, or its twin, is among the names."""
    alike = {name}.union(*(twins for twins in TWINS if name in twins))
    return bool(alike & set(names))


def visible(case: dict) -> bool:
    """Whether everything that was hidden could be seen."""
    return all(chi2 >= VISIBLE for chi2 in case["visibility"].values())


def right(case: dict) -> bool:
    """Whether the verdict is a right one, for a null, a visible effect or a visible truth outside the library."""
    if case["group"] == "null":
        return case["verdict"] == "nothing_missing"
    if case["group"] == "outside":
        return case["verdict"] in ABSTAINING
    if case["group"] == "pair":
        return case["verdict"] == "pair" and both_found(case)
    return case["verdict"] in ("effect", "group") and all(is_named(name, case["names"]) for name in case["effects"])


def both_found(case: dict) -> bool:
    """Whether each of two hidden effects is one of two printed names, or an alternative that is given for it."""
    if len(case["names"]) != 2:
        return False
    groups = [[name, *case["alternatives"].get(name, [])] for name in case["names"]]
    return any(is_named(one, groups[0]) and is_named(two, groups[1]) for one, two in permutations(case["effects"], 2))


def wrong_name(case: dict) -> bool:
    """A definite name, and none of the names is true."""
    return case["verdict"] in NAMING and not any(is_named(name, case["names"]) for name in case["effects"])


def score(cases: Sequence[dict]) -> list[Metric]:
    """All metrics of a set of cases."""
    null, single, pair, outside = ([c for c in cases if c["group"] == g] for g in ("null", "single", "pair", "outside"))
    seen = [c for c in single if visible(c)]
    lone = [c for c in seen if not any(set(c["effects"]) & twins for twins in TWINS)]
    foreign = [c for c in outside if visible(c)]
    both = [c for c in pair if visible(c)]
    named = [c for c in seen if right(c)]
    judged = null + seen + foreign
    sure = [case for case in judged if case["probability"] >= SURE]
    return [
        _share("right name or group", seen, right, at_least=0.90),
        _share("first in the ranking", lone, lambda c: c["first"] in c["effects"], at_least=0.85),
        _share("wrong name", single + outside, wrong_name, at_most=0.03),
        _share("false alarm", null, lambda c: not right(c), at_most=0.05),
        _share("abstains outside the library", foreign, right, at_least=0.90, on_value=True),
        _share("abstains though in the library", seen, _abstains, at_most=0.10, on_value=True),
        _share("right when sure (0.95 and more)", sure, right, at_least=0.93, on_value=True),
        _plain("calibration error", *_calibration(judged), "<= 0.05", lambda v: v <= 0.05),
        _share("90 % interval holds the size", named, _covered, None, None, between=(0.85, 0.95)),
        _plain("held-out chi2 over noise, median", *_left(named, 50), "<= 1.1", lambda v: v <= 1.1),
        _plain("held-out chi2 over noise, 90th percentile", *_left(named, 90), "<= 1.3", lambda v: v <= 1.3),
        _plain("share of excess held-out chi2 removed", *_removed(named), ">= 0.9", lambda v: v >= 0.9),
        _share("both of a pair", both, right, at_least=0.60, on_value=True),
        _plain("slowest diagnosis [s]", *_slowest(cases), "<= 60", lambda v: v <= 60),
    ]


def confusion(cases: Sequence[dict]) -> tuple[list[str], list[str], np.ndarray]:
    """Truths, verdicts and shares (rows add to one) of nulls, visible single effects and visible outsiders.

    A group counts for its members in equal parts.
    """
    rows: dict[str, list[dict]] = {}
    for case in cases:
        if case["group"] != "pair" and visible(case):
            rows.setdefault(_truth(case), []).append(case)
    truths = sorted(rows, key=lambda name: (name.startswith("("), name))
    columns = sorted({name for case in cases for name in [*case["names"], *case["effects"]]})
    columns += ["nothing_missing", "none_of_these", "partial", "cannot_tell"]
    table = np.zeros((len(truths), len(columns)))
    for row, truth in enumerate(truths):
        for case in rows[truth]:
            hits = case["names"] if case["verdict"] in NAMING else [case["verdict"]]
            for hit in hits:
                table[row, columns.index(hit)] += 1.0 / len(hits) / len(rows[truth])
    return [f"{truth}  n = {len(rows[truth])}" for truth in truths], columns, table


def _truth(case: dict) -> str:
    if case["group"] == "single":
        return next(iter(case["effects"]))
    return "(nothing)" if case["group"] == "null" else f"({case['outside']})"


def _share(name, cases, is_so: Callable, at_least=None, at_most=None, between=None, on_value=False) -> Metric:
    """Gates hold for the bound on the careful side, or for the value itself."""
    hits, n = sum(bool(is_so(case)) for case in cases), len(cases)
    value, (low, high) = (hits / n if n else float("nan")), bounds(hits, n)
    where = "" if on_value else " (bound)"
    if at_least is not None:
        gate, holds = f">= {at_least:g}{where}", (value if on_value else low) >= at_least
    elif at_most is not None:
        gate, holds = f"<= {at_most:g}{where}", (value if on_value else high) <= at_most
    else:
        gate, holds = f"{between[0]:g} to {between[1]:g}", between[0] <= value <= between[1]
    return Metric(name, value, low, high, n, gate, bool(holds) if n else None)


def _plain(name: str, value: float, n: int, gate: str, holds: Callable[[float], bool]) -> Metric:
    return Metric(name, value, value, value, n, gate, bool(holds(value)) if n else None)


def _abstains(case: dict) -> bool:
    return case["verdict"] in (*ABSTAINING, "cannot_tell")


def _calibration(cases: Sequence[dict]) -> tuple[float, int]:
    """Expected calibration error over ten bins of stated probability."""
    if not cases:
        return float("nan"), 0
    stated, hit = np.array([c["probability"] for c in cases]), np.array([right(c) for c in cases], float)
    bins = np.minimum((stated * 10).astype(int), 9)
    gaps = [np.sum(bins == b) * abs(hit[bins == b].mean() - stated[bins == b].mean()) for b in np.unique(bins)]
    return float(sum(gaps) / len(cases)), len(cases)


def reliability(cases: Sequence[dict], edges: np.ndarray) -> list[tuple[float, float, int]]:
    """Mean stated probability, share right and count of the cases of each bin that has any."""
    chosen = [c for c in cases if c["group"] != "pair" and visible(c)]
    stated, hit = np.array([c["probability"] for c in chosen]), np.array([right(c) for c in chosen], float)
    bins = np.digitize(stated, edges)
    return [(stated[bins == b].mean(), hit[bins == b].mean(), int(np.sum(bins == b))) for b in np.unique(bins)]


def _covered(case: dict) -> bool:
    name, size = next(iter(case["effects"].items()))
    low, high = case["intervals"].get(name, (np.nan, np.nan))
    return low <= size <= high


def _left(cases: Sequence[dict], percentile: float) -> tuple[float, int]:
    """Held-out chi2/n with the effect over that of the readings' own noise."""
    ratios = [c["held_out_after"] / c["held_out_noise"] for c in cases if c["held_out_after"] is not None]
    return (float(np.percentile(ratios, percentile)) if ratios else float("nan")), len(ratios)


def _removed(cases: Sequence[dict]) -> tuple[float, int]:
    """Median share of the excess of held-out chi2/n over the noise that the effect takes away."""
    chosen = [c for c in cases if c["held_out_after"] is not None and c["held_out_before"] > 1.1 * c["held_out_noise"]]
    taken = [c["held_out_before"] - c["held_out_after"] for c in chosen]
    shares = [share / (c["held_out_before"] - c["held_out_noise"]) for share, c in zip(taken, chosen)]
    return (float(np.median(shares)) if shares else float("nan")), len(shares)


def _slowest(cases: Sequence[dict]) -> tuple[float, int]:
    return max((c["wall_s"] for c in cases), default=float("nan")), len(cases)
