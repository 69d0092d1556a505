"""How good the diagnosis is on campaigns whose hidden effect it is not told: ``python -m benchmarks.blind_score``.

Scores seeds from 0 on, which nothing was tuned on. ``--tune N`` scores N cases of the tuning seeds instead and only
prints. Writes score.json, cases.csv, summary.md, confusion_<bench>.png and reliability.png to
results/reference/blind_score/.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import importlib
import importlib.util
import json
import tempfile
from dataclasses import asdict
from functools import cache
from pathlib import Path
from time import perf_counter

import numpy as np

from benchmarks.blind_figure import confusion_figure, reliability_figure
from benchmarks.blind_metrics import Metric, score
from benchmarks.inverse_crime import committed
from benchmarks.recommender_score import RecommenderScore, Tried, ambiguous
from benchmarks.recommender_score import score as score_advice
from benchmarks.this_machine import machine_name
from benchmarks.virtual_benches.case import GROUPS, Answer, Bench
from benchmarks.virtual_benches.hiding import hide
from effects.library import library
from pipeline.checkpoint import Checkpoint
from pipeline.pools import Interrupted, Pool, PooledWorkers, Processes
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.explain.diagnosis import diagnose
from workbench.models.bases import nominal_model

PROJECT = Path(__file__).resolve().parent.parent
RESULTS = PROJECT / "results" / "reference" / "blind_score"
CACHE = PROJECT / "results" / "cache"  # of field solutions
TUNING_START, SCORED_START = 10000, 0
SEED = 1  # of the diagnosis itself
# Cases of each group and bench; a bench is ``CATALOGUE`` of its module, see ``virtual_benches.hiding``.
BENCHES = {
    "damper": ("benchmarks.virtual_benches.damper_bench", {"null": 120, "single": 120, "outside": 40, "pair": 40}),
    "dq": ("benchmarks.virtual_benches.dq_bench", {"null": 120, "single": 120, "outside": 40, "pair": 40}),
    "machine": ("benchmarks.virtual_benches.machine_bench", {"null": 30, "single": 36, "outside": 7, "pair": 7}),
}
IN_FULL_FIELD = {"null": 6, "single": 12, "outside": 3, "pair": 3}  # of the machine, besides
FIELD_START = 500  # seeds of these; they hide other things than the expanded ones
INVERSE = {"null": 40, "single": 40}  # of each lumped bench, under the inverse crime
ADVICE = 10  # cases of each lumped bench in which the advice on what to measure next is tried
SEARCHED = 80  # seeds in which they are looked for
REPEATED = 6  # cases that are diagnosed twice; the answers must agree to the digit


@cache
def catalogue(bench: str):
    module = importlib.import_module(BENCHES[bench][0])
    return module.MachineBench(CACHE) if bench == "machine" else module.CATALOGUE


def is_there(bench: str) -> bool:
    return importlib.util.find_spec(BENCHES[bench][0]) is not None


def score_case(case: dict) -> dict:
    """One case made, written, read, diagnosed: the answer beside what the tool said.

    case: bench, group, seed;  crime: whether the readings are replaced by the workbench's own model
    field: whether the truth is solved in the field and not expanded
    """
    bench, answer = _made(case)
    with tempfile.TemporaryDirectory() as folder:
        campaign = read_campaign(bench.write(Path(folder) / bench.id))
        if case["crime"]:
            campaign, answer = committed(campaign, library(), tuple(answer.effects), answer)
        start = perf_counter()
        said = _told(campaign, answer)
    return {**case, **_answer(answer), **said, "wall_s": perf_counter() - start}


def _told(campaign, answer: Answer) -> dict:
    """What the tool said; a diagnosis that ends with an error is a wrong answer and stops no other case."""
    try:
        return _said(diagnose(nominal_model(campaign), campaign, library(), SEED), answer)
    except WorkbenchError as error:
        nothing = {"names": [], "alternatives": {}, "intervals": {}, "held_out_before": None, "held_out_after": None}
        zero = dict.fromkeys(("probability", "p_nothing_missing", "p_none_of_these"), 0.0)
        return {"verdict": "error", "first": str(error), **zero, **nothing}


def advice(task: dict) -> list[dict]:
    """Cases of one bench in which there is something to advise, as ``recommender_score.Tried``."""
    return [asdict(case) for case in ambiguous(task["bench"], task["start"], ADVICE, SEARCHED)]


def all_advice(benches: list[str], checkpoint: Path) -> RecommenderScore:
    """The advice on all lumped benches of these."""
    chosen = {f"advice {b}": {"bench": b, "start": SCORED_START} for b in benches if b != "machine"}
    found = workers_of(Processes(), checkpoint).map("advice", advice, chosen)
    return score_advice(Tried(**case) for cases in found.values() for case in cases)


def _made(case: dict) -> tuple[Bench, Answer]:
    """The campaign; cases "in full field" have readings from field solutions of the very machine."""
    if not case["field"]:
        return hide(catalogue(case["bench"]), case["group"], case["seed"])
    module = importlib.import_module(BENCHES[case["bench"]][0])
    return module.hide_in_full_field(catalogue(case["bench"]), case["group"], case["seed"])


def _answer(answer: Answer) -> dict:
    return {"effects": dict(answer.effects), "outside": answer.outside, "visibility": dict(answer.visibility)}


def _said(found, answer: Answer) -> dict:
    intervals = {r.name: [(e.low90, e.high90) for e in r.parameters.values()][0] for r in found.ranking if r.parameters}
    leader = next((r for r in found.ranking if r.name in answer.effects), found.ranking[0])
    return {
        "verdict": found.verdict,
        "names": list(found.names),
        "probability": found.probability,
        "first": found.ranking[0].name,
        "alternatives": {name: list(others) for name, others in found.alternatives.items()},
        "p_nothing_missing": found.p_nothing_missing,
        "p_none_of_these": found.p_none_of_these,
        "intervals": {name: intervals[name] for name in answer.effects if name in intervals},
        "held_out_before": leader.held_out_chi2_per_n_before,
        "held_out_after": leader.held_out_chi2_per_n_after,
    }


def tasks(start: int, counts: dict[str, dict[str, int]], crime: bool = False, field: bool = False) -> dict[str, dict]:
    """Cases by name: seeds from ``start``, as many of each group as asked."""
    prefix = "crime " if crime else "field " if field else ""
    how = {"crime": crime, "field": field}
    return {
        f"{prefix}{bench} {group} {seed}": {"bench": bench, "group": group, "seed": seed, **how}
        for bench, groups in counts.items()
        for group, count in groups.items()
        for seed in range(start, start + count)
    }


def all_cases(chosen: dict[str, dict], checkpoint: Path, what: str, pool: Pool | None = None) -> list[dict]:
    """Every case diagnosed, on the processes of this machine or on another pool."""
    results = workers_of(pool or Processes(), checkpoint).map(what, score_case, chosen)
    return list(with_noise(list(results.values())))


def workers_of(pool: Pool, checkpoint: Path) -> PooledWorkers:
    """Workers whose finished cases are kept in one file."""
    return PooledWorkers("blind score", pool, lambda what: Checkpoint(checkpoint, fingerprint()))


def with_noise(cases: list[dict]) -> list[dict]:
    """Each case with the held-out chi2/n that noise alone leaves: the median of its bench's empty campaigns."""
    floor = {}
    for case in cases:
        if case["group"] == "null" and case["held_out_before"] is not None:
            floor.setdefault((case["bench"], case["crime"]), []).append(case["held_out_before"])
    return [{**c, "held_out_noise": float(np.median(floor.get((c["bench"], c["crime"]), [1.0])))} for c in cases]


def fingerprint() -> str:
    """SHA-256 of everything that makes or judges a case."""
    folders = ("benchmarks", "effects", "workbench")
    files = sorted(path for name in folders for path in (PROJECT / name).rglob("*.py"))
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()


def answers_fingerprint(cases: list[dict]) -> str:
    hidden = [(c["bench"], c["group"], c["seed"], sorted(c["effects"].items()), c["outside"]) for c in cases]
    return hashlib.sha256(json.dumps(hidden).encode()).hexdigest()


def repeated(cases: list[dict]) -> int:
    """How many of the first cases give another answer when they are diagnosed again."""
    first = [case for case in cases if case["group"] == "single" and not case["crime"]][:REPEATED]
    keys = ("verdict", "names", "probability", "p_nothing_missing")
    again = [score_case({key: case[key] for key in ("bench", "group", "seed", "crime", "field")}) for case in first]
    return sum(any(new[key] != old[key] for key in keys) for new, old in zip(again, first))


def table_of(sets: dict[str, list[Metric]]) -> str:
    """Markdown: one line a metric, one column a set of cases."""
    lines = ["| metric | gate | " + " | ".join(sets) + " |", "| --- | --- |" + " --- |" * len(sets)]
    for rows in zip(*sets.values()):
        lines.append(f"| {rows[0].name} | {rows[0].gate} | " + " | ".join(_cell(row) for row in rows) + " |")
    return "\n".join(lines)


def _cell(m: Metric) -> str:
    if not m.n or np.isnan(m.value):
        return "no case"
    is_share = m.low != m.high
    interval = f" [{m.low:.3f}, {m.high:.3f}], {round(m.value * m.n)} of {m.n}" if is_share else f", n = {m.n}"
    mark = "" if m.passed is None else (" met" if m.passed else " **missed**")
    return f"{m.value:.3f}{interval},{mark}"


def sets_of(cases: list[dict]) -> dict[str, list[Metric]]:
    blind, crime = [c for c in cases if not c["crime"]], [c for c in cases if c["crime"]]
    benches = sorted({case["bench"] for case in blind})
    lumped = [c for c in blind if c["bench"] != "machine"]
    sets = {bench: score([c for c in blind if c["bench"] == bench]) for bench in benches}
    return {"damper and dq": score(lumped)} | sets | ({"inverse crime": score(crime)} if crime else {})


def write(cases: list[dict], wall_s: float, changed: int, advised: RecommenderScore, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    sets = sets_of(cases)
    record = {
        "metrics": {name: [asdict(metric) for metric in metrics] for name, metrics in sets.items()},
        "cases": len(cases),
        "advice": asdict(advised) | {"share_of_oracle": advised.share, "passed": advised.passed},
        "wall_s": wall_s,
        "answers_that_changed_on_repetition": changed,
        "repeated": REPEATED,
        "code_sha256": fingerprint(),
        "answers_sha256": answers_fingerprint(cases),
        "machine": machine_name(),
    }
    (folder / "score.json").write_text(json.dumps(record, indent=1), encoding="utf-8")
    _write_cases(cases, folder / "cases.csv")
    (folder / "summary.md").write_text(_summary(sets, record), encoding="utf-8")
    blind = [c for c in cases if not c["crime"]]
    for bench in sorted({c["bench"] for c in blind}):
        mine = [c for c in blind if c["bench"] == bench]
        confusion_figure(mine, f"Blind cases of the {bench} bench", folder / f"confusion_{bench}.png")
    reliability_figure(blind, [c for c in cases if c["crime"]], folder / "reliability.png")


def _write_cases(cases: list[dict], path: Path) -> None:
    columns = "bench group seed crime field effects outside visibility verdict names probability first wall_s".split()
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([json.dumps(c[k]) if isinstance(c[k], (dict, list)) else c[k] for k in columns] for c in cases)


def _summary(sets: dict[str, list[Metric]], record: dict) -> str:
    return (
        "# Blind score of the diagnosis\n\n"
        f"{record['cases']} campaigns in {record['wall_s'] / 60:.0f} min on {record['machine']['processor']}; "
        "brackets are one-sided 95 % bounds (Clopper and Pearson). A hidden effect counts as visible when it adds "
        "chi2 >= 20 beyond tolerances and instruments, a truth outside the library when it keeps as much beside the "
        "best effect. Winding temperature and contact resistance are the same law and count as one.\n\n"
        f"{table_of(sets)}\n\n"
        f"Advice on what to measure next: {_advice_line(record['advice'])}\n\n"
        f"{record['answers_that_changed_on_repetition']} of {record['repeated']} repeated diagnoses differed.\n"
    )


def _advice_line(advice: dict) -> str:
    if not advice["cases"]:
        return "no case."
    return (
        f"{advice['cases']} cases; the probability of the truth rises by {advice['advised']:.3f} with the advised "
        f"measurement, by {advice['oracle']:.3f} with the best one (share {advice['share_of_oracle']:.2f}, asked 0.8), "
        f"by {advice['fixed']:.3f} with the best fixed one, by {advice['blind']:.3f} with any."
    )


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tune", type=int, metavar="N", help="score N cases of the tuning seeds and print")
    parser.add_argument("--bench", action="append", choices=sorted(BENCHES), help="only this bench")
    parser.add_argument("--group", action="append", choices=GROUPS, help="only this group")
    parser.add_argument("--from", type=int, default=0, dest="skip", help="skip so many tuning seeds")
    chosen = parser.parse_args(arguments)
    benches = [bench for bench in chosen.bench or BENCHES if is_there(bench)]
    try:
        _tune(chosen, benches) if chosen.tune else _score(benches)
    except Interrupted as stopped:
        raise SystemExit(str(stopped)) from None


def _tune(chosen, benches: list[str]) -> None:
    groups = chosen.group or list(GROUPS)
    share = {"null": 3, "single": 3, "outside": 1, "pair": 1}
    whole = sum(share[g] for g in groups) * len(benches)
    counts = {b: {g: max(round(chosen.tune * share[g] / whole), 1) for g in groups} for b in benches}
    with tempfile.TemporaryDirectory() as folder:
        cases = all_cases(tasks(TUNING_START + chosen.skip, counts), Path(folder) / "cases", "tuning cases")
    for case in cases:
        print(_line(case))
    print(table_of({"tuning": score(cases)}))


def _line(case: dict) -> str:
    hidden = ", ".join(f"{n} {v:.3g} (chi2 {case['visibility'][n]:.0f})" for n, v in case["effects"].items())
    if case["outside"]:
        hidden = f"{case['outside']} (chi2 {case['visibility'][case['outside']]:.0f})"
    hidden = hidden or "nothing"
    said = f"{case['verdict']} {', '.join(case['names'])} ({case['probability']:.2f})"
    size = "".join(f" in [{low:.3g}, {high:.3g}]" for low, high in case["intervals"].values())
    return f"{case['bench']} {case['group']} {case['seed']}: {hidden} -> {said}{size}; {case['wall_s']:.1f} s"


def _score(benches: list[str]) -> None:
    start = perf_counter()
    chosen = tasks(SCORED_START, {bench: BENCHES[bench][1] for bench in benches})
    chosen |= tasks(SCORED_START, {bench: INVERSE for bench in benches if bench != "machine"}, crime=True)
    if "machine" in benches:
        chosen |= tasks(SCORED_START + FIELD_START, {"machine": IN_FULL_FIELD}, field=True)
    unfinished = RESULTS.parent.parent
    cases = all_cases(chosen, unfinished / "blind_score_cases.jsonl", "blind cases")
    changed = repeated(cases)
    advised = all_advice(benches, unfinished / "blind_score_advice.jsonl")
    write(cases, perf_counter() - start, changed, advised, RESULTS)
    print((RESULTS / "summary.md").read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
