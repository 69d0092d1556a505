"""What blind cases say about the diagnosis: shares with exact bounds, calibration of all that is printed, coverage.

A case is a dictionary as ``blind_score.case_of`` returns it: the answer of a campaign beside what its diagnosis.json
says. Bounds: Clopper and Pearson (1934), one-sided 95 %. A verdict prints names as sets: the members of a group are one
set of which one is meant; every other name is a set with the alternatives that are given for it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import beta

from benchmarks.virtual_benches.case import VISIBLE

LEVEL = 0.95  # of a one-sided bound
FEWEST = 40  # cases of a bin of stated probability
BINS = np.linspace(0.0, 1.0, 11)
# The same law under two names: no measurement of these benches can tell them apart.
TWINS = (frozenset({"winding_temperature", "contact_resistance"}),)
NAMING = ("effect", "group", "pair", "several", "partial")
ABSTAINING = ("none_of_these", "partial", "cannot_tell")
REMAINS = 0.5  # probability from which "something remains" is said
SLOWEST = {"damper": 10.0, "dq": 10.0, "machine": 60.0}  # s, of one diagnosis


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


# ---- one case --------------------------------------------------------------------------------------------------------


def is_named(name: str, names: Iterable[str]) -> bool:
    """Whether the truth, or its twin, is among the names."""
    alike = {name}.union(*(twins for twins in TWINS if name in twins))
    return bool(alike & set(names))


def stated_sets(case: Mapping) -> list[frozenset[str]]:
    """The sets that the probability of the verdict is about."""
    if case["verdict"] not in NAMING or not case["names"]:
        return []
    if case["verdict"] == "group":
        return [frozenset(case["names"])]
    return [frozenset((name, *case["alternatives"].get(name, ()))) for name in case["names"]]


def printed(case: Mapping) -> list[frozenset[str]]:
    """All sets of effects that the verdict prints, those said apart too; of each one is said to be there."""
    if case["verdict"] not in NAMING:
        return []
    apart = (frozenset((n, *others)) for n, others in case["alternatives"].items() if n not in case["names"])
    return [*stated_sets(case), *apart]


def all_true(case: Mapping) -> bool:
    """Whether every set that is printed holds something that was hidden, and no two sets the same one."""
    return are_true(case, printed(case))


def are_true(case: Mapping, sets: Sequence[frozenset[str]]) -> bool:
    """The same of some sets."""
    return _matched([[n for n in case["effects"] if is_named(n, names)] for names in sets])


def _matched(choices: Sequence[Sequence[str]], taken: frozenset[str] = frozenset()) -> bool:
    """Whether every entry can have one of its choices for itself."""
    if not choices:
        return True
    free = (name for name in choices[0] if name not in taken)
    return any(_matched(choices[1:], taken | {name}) for name in free)


def found(case: Mapping, name: str) -> bool:
    """Whether an effect that was hidden is in a printed set."""
    return any(is_named(name, names) for names in printed(case))


def asked_for(case: Mapping) -> list[str]:
    """What was hidden besides what every bench of the kind has."""
    return [name for name in case["effects"] if name not in case["ambient"]]


def is_seen(case: Mapping, name: str) -> bool:
    """Whether something hidden changes the readings by enough to be asked for."""
    return case["visibility"].get(name, 0.0) >= VISIBLE


def visible(case: Mapping) -> bool:
    """Whether everything that was hidden in this case could be seen."""
    hidden = [*asked_for(case), *([case["outside"]] if case["outside"] else [])]
    return all(is_seen(case, name) for name in hidden)


def nothing_to_see(case: Mapping) -> bool:
    """Whether nothing of what was hidden could be seen."""
    hidden = [*case["effects"], *([case["outside"]] if case["outside"] else [])]
    return not any(is_seen(case, name) for name in hidden) and not case["mistake"]


def all_found(case: Mapping) -> bool:
    """Whether everything that was hidden, but what every bench of the kind has, is in a printed set."""
    return all(found(case, name) for name in asked_for(case))


def abstains(case: Mapping) -> bool:
    """Whether it says that something is there which the library does not hold, and prints nothing false."""
    says = case["verdict"] in ABSTAINING or (case["verdict"] in NAMING and (case["p_remains"] or 0.0) >= REMAINS)
    return says and all_true(case)


def right(case: Mapping) -> bool:
    """Whether the verdict says what was there and could be seen, and nothing else."""
    if case["mistake"]:
        return convention_named(case)
    if case["outside"] and is_seen(case, case["outside"]):
        return abstains(case)
    if nothing_to_see(case):
        return case["verdict"] == "nothing_missing" or (bool(printed(case)) and all_true(case))
    seen = [name for name in case["effects"] if is_seen(case, name)]
    return bool(printed(case)) and all_true(case) and all(found(case, name) for name in seen)


def convention_named(case: Mapping) -> bool:
    """Whether one of the mistakes in the columns is the verdict."""
    return case["verdict"] == "convention" and bool(set(case["mistake"]) & set(case["names"]))


# ---- the score -------------------------------------------------------------------------------------------------------


def score(cases: Sequence[Mapping]) -> list[Metric]:
    """All metrics of a set of cases."""
    group = lambda name: [case for case in cases if case["group"] == name]  # noqa: E731
    naming = [case for case in cases if printed(case)]
    seen = [case for case in group("single") if visible(case)]
    foreign = [case for case in group("outside") if visible(case)]
    both, several = ([case for case in group(g) if visible(case)] for g in ("pair", "several"))
    honest = [case for case in cases if not case["mistake"]]
    ambient = [case for case in honest if any(is_seen(case, name) for name in case["ambient"])]
    return [
        _share("every printed name true", naming, all_true, 0.97, low=0.95),
        _share("visible effect in the printed set", seen, all_found, 0.95),
        _share("no name where nothing is hidden", group("null"), all_true, 0.95),
        _share("abstains outside the library, nothing false", foreign, abstains, 0.90),
        _share("both of a pair, in the printed sets", both, all_found, 0.60),
        _share("three or four at once: all found", several, all_found, 0.60),
        _share("three or four at once: none false", group("several"), all_true, 0.95),
        *_calibrations(cases),
        _covered([size for case in honest for size in sizes_covered(case)]),
        _share("what every such bench has is named", ambient, _ambient_found, None),
        _share("a convention is named as what it is", group("mistake"), convention_named, 0.95),
        _share("no effect named beside a mistake", group("mistake"), lambda c: not printed(c), 1.0),
        _share("no convention blamed without a mistake", honest, lambda c: c["verdict"] != "convention", 0.98),
        _share("ends with an answer", cases, lambda c: c["verdict"] != "error", 1.0),
        _share("quick enough", cases, lambda c: c["wall_s"] <= SLOWEST[c["bench"]], 1.0),
        _plain("slowest diagnosis [s]", max((c["wall_s"] for c in cases), default=np.nan), len(cases)),
        _plain("median diagnosis [s]", float(np.median([c["wall_s"] for c in cases])) if cases else np.nan, len(cases)),
    ]


def _ambient_found(case: Mapping) -> bool:
    return all(found(case, name) for name in case["ambient"] if is_seen(case, name))


def _share(name: str, cases: Sequence, is_so: Callable, at_least: float | None, low: float | None = None) -> Metric:
    """A share with its bounds. at_least: of the value;  low: of its lower bound"""
    hits, n = sum(bool(is_so(case)) for case in cases), len(cases)
    value, (lower, upper) = (hits / n if n else float("nan")), bounds(hits, n)
    gate = "" if at_least is None else f">= {at_least:g}" + ("" if low is None else f", bound >= {low:g}")
    passed = None if at_least is None or not n else value >= at_least and (low is None or lower >= low)
    return Metric(name, value, lower, upper, n, gate, passed)


def _plain(name: str, value: float, n: int, at_most: float | None = None) -> Metric:
    gate = "" if at_most is None else f"<= {at_most:g}"
    return Metric(name, value, value, value, n, gate, None if at_most is None or not n else bool(value <= at_most))


def sizes_covered(case: Mapping) -> list[bool]:
    """Of every printed effect that is true by its own name: whether its 90 % interval holds the size."""
    names = {name for names in printed(case) for name in names} & set(case["effects"]) & set(case["intervals"])
    return [case["intervals"][name][0] <= case["effects"][name] <= case["intervals"][name][1] for name in names]


def _covered(hits: Sequence[bool]) -> Metric:
    n, value = len(hits), (float(np.mean(hits)) if hits else float("nan"))
    return Metric("90 % interval holds the size", value, *bounds(sum(hits), n), n, "0.85 to 0.95",
                  0.85 <= value <= 0.95 if n else None)  # fmt: skip


# ---- calibration -----------------------------------------------------------------------------------------------------


def statements(case: Mapping) -> list[tuple[str, float, bool]]:
    """(what kind, stated probability, whether it is so) of every probability that a diagnosis prints.

    verdict: that the verdict is right, see ``_said_truly``;  effect: that it is there, alone or with others
    nothing: that there is no effect and nothing outside, of whatever size;  none of these: something outside the
    library and no effect;  remains: something outside it, with or without effects
    """
    outside = bool(case["outside"]) and is_seen(case, case["outside"])
    told = [("verdict", case["probability"], _said_truly(case))] if case["verdict"] != "error" else []
    told += [("effect", p, name in case["effects"]) for name, p in case["ranking"].items()]
    told.append(("nothing", case["p_nothing_missing"], not case["effects"] and not case["outside"]))
    told.append(("none of these", case["p_none_of_these"], outside and not case["effects"]))
    told.append(("remains", case["p_remains"], outside))
    return [(kind, float(p), so) for kind, p, so in told if p is not None]


def _said_truly(case: Mapping) -> bool:
    """What the verdict alone claims: its names are there; nothing visible is missing; a law outside is there."""
    if case["verdict"] == "convention":
        return convention_named(case)
    if case["verdict"] == "nothing_missing":
        return nothing_to_see(case)
    if case["verdict"] == "none_of_these":
        return bool(case["outside"]) and is_seen(case, case["outside"])
    if case["verdict"] == "cannot_tell":
        return not nothing_to_see(case)
    return are_true(case, stated_sets(case))


def _calibrations(cases: Sequence[Mapping]) -> list[Metric]:
    told = [statement for case in cases for statement in statements(case)]
    kinds = [kind for kind in ("verdict", "effect", "nothing", "none of these", "remains") if told]
    lines = [_calibration("calibration error, all that is printed", told, 0.03)]
    return lines + [
        _calibration(f"calibration error, {kind}", [t for t in told if t[0] == kind], None) for kind in kinds
    ]


def _calibration(name: str, told: Sequence[tuple[str, float, bool]], at_most: float | None) -> Metric:
    stated, hit = np.array([t[1] for t in told]), np.array([t[2] for t in told], float)
    return _plain(name, calibration_error(stated, hit), len(told), at_most)


def calibration_error(stated: np.ndarray, hit: np.ndarray) -> float:
    """sum over the bins of n_b/n |share that is so - mean stated probability|; stated, hit (n,)."""
    if not len(stated):
        return float("nan")
    gaps = [len(rows) * abs(hit[rows].mean() - stated[rows].mean()) for rows in bins_of(stated)]
    return float(sum(gaps) / len(stated))


def least_error(stated: np.ndarray, rng: np.random.Generator, draws: int = 200) -> float:
    """Mean calibration error of someone whose probabilities are right, from the same number of statements."""
    return float(np.mean([calibration_error(stated, rng.random(len(stated)) < stated) for _ in range(draws)]))


def bins_of(stated: np.ndarray) -> list[np.ndarray]:
    """Row numbers of bins of stated probability, tenths; one with fewer than ``FEWEST`` is joined to its neighbour."""
    tenth = np.clip(np.digitize(stated, BINS) - 1, 0, len(BINS) - 2)
    found_bins: list[np.ndarray] = []
    for number in np.unique(tenth):
        rows = np.flatnonzero(tenth == number)
        if found_bins and (len(rows) < FEWEST or len(found_bins[-1]) < FEWEST):
            rows = np.concatenate([found_bins.pop(), rows])
        found_bins.append(rows)
    return found_bins


def reliability(cases: Sequence[Mapping], kind: str) -> list[tuple[float, float, int]]:
    """Mean stated probability, share that is so and count of the bins of one kind of statement."""
    told = [statement for case in cases for statement in statements(case) if statement[0] == kind]
    stated, hit = np.array([t[1] for t in told]), np.array([t[2] for t in told], float)
    return [(stated[rows].mean(), hit[rows].mean(), len(rows)) for rows in bins_of(stated)]


# ---- who is taken for whom -------------------------------------------------------------------------------------------


def by_kind(cases: Sequence[Mapping]) -> dict[str, tuple[int, int]]:
    """Of every outside truth that can be seen: how often it is abstained from, and how often it was hidden."""
    kinds: dict[str, list[bool]] = {}
    for case in cases:
        if case["group"] == "outside" and visible(case):
            kinds.setdefault(f"{case['bench']}: {case['outside']}", []).append(abstains(case))
    return {kind: (sum(hits), len(hits)) for kind, hits in sorted(kinds.items())}


def confusion(cases: Sequence[Mapping]) -> tuple[list[str], list[str], np.ndarray]:
    """Truths, verdicts and shares (rows add to one) of nulls, visible single effects and visible outsiders."""
    rows: dict[str, list[Mapping]] = {}
    for case in cases:
        if case["group"] in ("null", "single", "outside") and visible(case):
            rows.setdefault(_truth(case), []).append(case)
    truths = sorted(rows, key=lambda name: (name.startswith("("), name))
    columns = sorted({name for case in cases for name in (*frozenset().union(*printed(case)), *case["effects"])})
    columns += ["nothing_missing", "none_of_these", "cannot_tell", "convention", "error"]
    table = np.zeros((len(truths), len(columns)))
    for row, truth in enumerate(truths):
        for case in rows[truth]:
            for said, share in _said(case):
                table[row, columns.index(said)] += share / len(rows[truth])
    return [f"{truth}  n = {len(rows[truth])}" for truth in truths], columns, table


def _said(case: Mapping) -> list[tuple[str, float]]:
    """What a case ends with, in shares that add to one: every set that is printed counts alike, and its members; one of
    what every bench of the kind has only where no other is printed."""
    sets = printed(case)
    sets = [names for names in sets if not names <= set(case["ambient"])] or sets
    if not sets:
        return [(case["verdict"] if case["verdict"] not in NAMING else "none_of_these", 1.0)]
    return [(name, 1.0 / len(sets) / len(names)) for names in sets for name in sorted(names)]


def _truth(case: Mapping) -> str:
    if case["group"] == "single":
        return next(iter(asked_for(case)))
    return "(nothing)" if case["group"] == "null" else f"({case['outside']})"
