"""How good the diagnosis is on campaigns whose hidden effect it is not told: ``python -m benchmarks.blind_score``.

Writes the scored campaigns to results/blind/campaigns (``blind_campaigns``), diagnoses every folder, and writes
score.json, cases.csv, summary.md and pictures to results/reference/blind_score/. A run that is stopped goes on where it
was. Only what stands in diagnosis.json is judged.

    --tune N              N campaigns of every bench from the tuning seeds and kinds, printed only
    --folders DIR         the campaigns of a folder that ``blind_campaigns`` wrote, printed only
    --code DIR            diagnosed by another checkout of this project instead, on the very same files
    --holdout RULE        with this hold-out rule added to every campaign.toml, for code that has none by itself
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter

import numpy as np

from benchmarks.blind_campaigns import ANSWERS, BENCHES, GROUPS, hashes, wanted, write_campaigns
from benchmarks.blind_figure import confusion_figure, reliability_figure
from benchmarks.blind_metrics import SLOWEST, Metric, by_kind, least_error, score, statements
from benchmarks.this_machine import machine_name
from pipeline.checkpoint import Checkpoint
from pipeline.pools import Interrupted, PooledWorkers
from processes import Pool, Processes

PROJECT = Path(__file__).resolve().parent.parent
RESULTS = PROJECT / "results" / "reference" / "blind_score"
WORK = PROJECT / "results" / "blind"
WORKER = Path(__file__).parent / "blind_worker.py"
SCORED = {"damper": 320, "dq": 320, "machine": 160}  # campaigns of each bench
_LAST_LINES = 4  # of what a diagnosis said that ended with an error: where it was, and what happened
LONGEST = 1800  # s that one diagnosis may take before it counts as an error


@dataclass(frozen=True)
class Code:
    """Who diagnoses. folder: a checkout of the project;  holdout: rule that is added to a campaign, empty for none"""

    folder: Path = PROJECT
    holdout: str = ""

    def fingerprint(self) -> str:
        """SHA-256 of everything that makes a diagnosis."""
        names = ("effects", "workbench", "magnetostatics", "geometry", "materials", "electrical")
        files = sorted(path for name in names for path in (self.folder / name).rglob("*.py"))
        return hashlib.sha256(b"".join(path.read_bytes() for path in files) + self.holdout.encode()).hexdigest()


@dataclass(frozen=True)
class Some:
    """Which campaigns of a folder are asked for. most: of every bench and group, all where None"""

    benches: Sequence[str] = BENCHES
    groups: Sequence[str] = GROUPS
    most: int | None = None

    def of(self, folder: Path) -> dict[str, dict]:
        """Their answers by bench/campaign."""
        found = {}
        for path in sorted(folder.glob(f"*/{ANSWERS}")):
            if path.parent.name in self.benches:
                answers = json.loads(path.read_text(encoding="utf-8"))
                found |= {f"{path.parent.name}/{name}": answers[name] for name in self._names(answers)}
        return found

    def _names(self, answers: Mapping[str, Mapping]) -> list[str]:
        groups = {group: sorted(n for n in answers if answers[n]["group"] == group) for group in self.groups}
        return sorted(name for names in groups.values() for name in names[: self.most])


# ---- one campaign ----------------------------------------------------------------------------------------------------


def diagnosed(task: Mapping[str, str]) -> dict:
    """What a checkout says about the campaign of a folder: its diagnosis.json, or the error it ended with.

    task: folder of the campaign, code: folder of the checkout, holdout: rule to be added
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(task["folder"])
        if task["holdout"]:
            folder = shutil.copytree(folder, Path(name) / folder.name)
            _with_holdout(folder / "campaign.toml", task["holdout"])
        out, start = Path(name) / "diagnosis.json", perf_counter()
        command = [sys.executable, str(WORKER), str(folder), str(out)]
        there = {**os.environ, "PYTHONPATH": task["code"]}
        try:
            end = subprocess.run(
                command, cwd=task["code"], env=there, capture_output=True, timeout=LONGEST, check=False
            )
        except subprocess.TimeoutExpired:
            return {"error": f"no answer after {LONGEST} s", "wall_s": perf_counter() - start}
        if end.returncode:
            lines = end.stderr.decode(errors="replace").strip().splitlines() or [f"status {end.returncode}"]
            return {"error": " | ".join(map(str.strip, lines[-_LAST_LINES:])), "wall_s": perf_counter() - start}
        return json.loads(out.read_text(encoding="utf-8"))


def _with_holdout(path: Path, rule: str) -> None:
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("[campaign]\n", f'[campaign]\nholdout = {{ rule = "{rule}" }}\n', 1), encoding="utf-8")


def case_of(bench: str, name: str, answer: Mapping, said: Mapping) -> dict:
    """A case as ``blind_metrics`` judges it: the answer of a campaign beside its diagnosis.json."""
    nothing = {"verdict": "error", "names": [], "probability": None}
    said = {**nothing, **said} if "error" in said else said
    ranking = said.get("ranking", [])
    return {
        **answer,
        "bench": bench,
        "campaign": name,
        "verdict": said["verdict"],
        "names": list(said["names"]),
        "alternatives": said.get("alternatives") or {},
        "probability": said["probability"],
        "ranking": {row["name"]: row["probability"] for row in ranking},
        "intervals": {row["name"]: _interval(row["parameters"]) for row in ranking if row.get("parameters")},
        "p_nothing_missing": said.get("p_nothing_missing"),
        "p_none_of_these": said.get("p_none_of_these"),
        "p_remains": said.get("p_something_remains"),
        "fix": said.get("fix", ""),
        "error": said.get("error", ""),
        "wall_s": said["wall_s"],
    }


def _interval(parameters: Mapping[str, Mapping]) -> tuple[float, float]:
    """Of the first parameter, which is the size of an effect."""
    size = next(iter(parameters.values()))
    low, high = size["low90"], size["high90"]
    return (-np.inf if low is None else low), (np.inf if high is None else high)


# ---- many ------------------------------------------------------------------------------------------------------------


def cases_of(folder: Path, code: Code, checkpoint: Path, pool: Pool, some: Some = Some()) -> list[dict]:
    """Campaigns of a folder diagnosed and laid beside their answers; all where not said which."""
    chosen = some.of(folder)
    tasks = {
        key: {"folder": str((folder / key).resolve()), "code": str(code.folder.resolve()), "holdout": code.holdout}
        for key in chosen
    }
    said = workers_on(folder, code, checkpoint, pool).map("diagnoses", diagnosed, tasks)
    return [case_of(*key.split("/"), answer, said[key]) for key, answer in chosen.items()]


def workers_on(folder: Path, code: Code, checkpoint: Path, pool: Pool) -> PooledWorkers:
    """Workers whose finished tasks hold as long as neither the campaigns of a folder nor who diagnoses them change."""
    inputs = hashlib.sha256((code.fingerprint() + json.dumps(hashes(folder))).encode()).hexdigest()
    return PooledWorkers("blind score", pool, lambda what: Checkpoint(checkpoint, inputs))


def sets_of(cases: Sequence[Mapping]) -> dict[str, list[Metric]]:
    """All cases, those of each bench, and those of the lumped benches together."""
    benches = sorted({case["bench"] for case in cases})
    lumped = [c for c in cases if c["bench"] != "machine"]
    sets = {"all": score(cases)}
    sets |= {"lumped": score(lumped)} if {"damper", "dq"} <= set(benches) and "machine" in benches else {}
    return sets | {bench: score([c for c in cases if c["bench"] == bench]) for bench in benches if len(benches) > 1}


def table_of(sets: Mapping[str, Sequence[Metric]]) -> str:
    """Markdown: one line a metric, one column a set of cases."""
    lines = ["| metric | gate | " + " | ".join(sets) + " |", "| --- | --- |" + " --- |" * len(sets)]
    for rows in zip(*sets.values(), strict=True):
        lines.append(f"| {rows[0].name} | {rows[0].gate} | " + " | ".join(_cell(row) for row in rows) + " |")
    return "\n".join(lines)


def _cell(m: Metric) -> str:
    if not m.n or np.isnan(m.value):
        return "no case"
    is_share = m.low != m.high
    interval = f" [{m.low:.3f}, {m.high:.3f}], {round(m.value * m.n)} of {m.n}" if is_share else f", n = {m.n}"
    mark = "" if m.passed is None else (" met" if m.passed else " **missed**")
    return f"{m.value:.3f}{interval},{mark}".removesuffix(",")


def line_of(case: Mapping) -> str:
    """One case in words."""
    hidden = ", ".join(f"{n} {v:.3g} (chi2 {case['visibility'].get(n, 0):.0f})" for n, v in case["effects"].items())
    if case["outside"]:
        hidden = " and ".join(
            filter(None, (hidden, f"{case['outside']} (chi2 {case['visibility'][case['outside']]:.0f})"))
        )
    hidden = " and ".join(filter(None, (hidden, case["detail"] if case["mistake"] else ""))) or "nothing"
    said = f"{case['verdict']} {', '.join(case['names'])}".strip()
    sure = "" if case["probability"] is None else f" ({case['probability']:.2f})"
    remains = "" if case["p_remains"] is None else f", remains {case['p_remains']:.2f}"
    return (
        f"{case['bench']}/{case['campaign']}: {hidden} -> {said}{sure}{remains} {case['error']}; {case['wall_s']:.1f} s"
    )


# ---- what is written -------------------------------------------------------------------------------------------------


def write(cases: Sequence[Mapping], record: Mapping[str, object], folder: Path) -> None:
    """score.json, cases.csv, summary.md and the pictures."""
    folder.mkdir(parents=True, exist_ok=True)
    sets = sets_of(cases)
    whole = {"metrics": {name: [asdict(metric) for metric in metrics] for name, metrics in sets.items()}, **record}
    (folder / "score.json").write_text(json.dumps(whole, indent=1), encoding="utf-8")
    _write_cases(cases, folder / "cases.csv")
    (folder / "summary.md").write_text(_summary(cases, sets, record), encoding="utf-8")
    for bench in sorted({c["bench"] for c in cases}):
        mine = [c for c in cases if c["bench"] == bench]
        confusion_figure(mine, f"Blind cases of the {bench} bench", folder / f"confusion_{bench}.png")
    reliability_figure(cases, folder / "reliability.png")


def _write_cases(cases: Sequence[Mapping], path: Path) -> None:
    columns = "bench campaign group effects outside mistake visibility about verdict names alternatives probability "
    columns = (columns + "p_nothing_missing p_none_of_these p_remains error wall_s").split()
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([json.dumps(c[k]) if isinstance(c[k], (dict, list)) else c[k] for k in columns] for c in cases)


def _summary(cases: Sequence[Mapping], sets: Mapping[str, Sequence[Metric]], record: Mapping[str, object]) -> str:
    stated = np.array([p for case in cases for _, p, _ in statements(case)])
    kinds = "\n".join(f"| {kind} | {hits} of {n} |" for kind, (hits, n) in by_kind(cases).items())
    return (
        "# Blind score of the diagnosis\n\n"
        f"{record['cases']} campaigns in {record['wall_s'] / 60:.0f} min on {record['machine']['processor']}. Brackets "
        "are one-sided 95 % bounds (Clopper and Pearson). A hidden effect counts as visible when it adds "
        "chi2 >= 20 beyond tolerances, instruments, scatter of mounting and the other hidden effects; a truth outside "
        "the library when it keeps as much beside the best effect of the bench. Groups, pairs and partial verdicts "
        "count as naming; winding temperature and contact resistance are one law and count as one. All cases are in "
        f"the calibration. Quick enough is {SLOWEST['damper']:g} s, for a machine whose fields are kept "
        f"{SLOWEST['machine']:g} s: those that were solved anew count, too.\n\n"
        f"{table_of(sets)}\n\n"
        f"Someone whose probabilities are right would show a calibration error of "
        f"{least_error(stated, np.random.default_rng(1)):.3f} on so many statements.\n\n"
        "Kinds of truths outside the library, none of them used for tuning: abstained from, nothing false printed.\n\n"
        f"| kind | abstains |\n| --- | --- |\n{kinds}\n"
    )


def record_of(cases: Sequence[Mapping], wall_s: float, code: Code, folder: Path) -> dict[str, object]:
    """What the score was measured on."""
    return {
        "cases": len(cases),
        "wall_s": wall_s,
        "code_sha256": code.fingerprint(),
        "campaigns_sha256": hashlib.sha256(json.dumps(hashes(folder)).encode()).hexdigest(),
        "machine": machine_name(),
    }


# ---- command ---------------------------------------------------------------------------------------------------------


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--tune", type=int, metavar="N", help="N campaigns of every bench from the tuning seeds, printed"
    )
    parser.add_argument("--folders", type=Path, metavar="DIR", help="the campaigns of a folder, printed only")
    parser.add_argument("--most", type=int, metavar="N", help="of --folders the first N of every bench and group")
    parser.add_argument("--bench", action="append", choices=sorted(BENCHES), help="only this bench")
    parser.add_argument("--group", action="append", choices=GROUPS, help="only this group")
    parser.add_argument("--code", type=Path, default=PROJECT, help="checkout that diagnoses; this one by default")
    parser.add_argument("--holdout", default="", help="hold-out rule that is added to every campaign")
    parser.add_argument("--jobs", type=int, help="processes; as many as there are cores where it is not given")
    parser.add_argument("--out", type=Path, help="folder for score.json, summary.md and pictures")
    parser.add_argument("--campaigns", type=int, metavar="N", help="so many of every bench instead of the full number")
    chosen = parser.parse_args(arguments)
    try:
        _run(chosen, Code(chosen.code, chosen.holdout))
    except Interrupted as stopped:
        raise SystemExit(str(stopped)) from None


def _run(chosen: argparse.Namespace, code: Code) -> None:
    start = perf_counter()
    folder = _campaigns(chosen)
    name = hashlib.sha256(f"{code.folder.resolve()} {code.holdout} {folder.resolve()}".encode()).hexdigest()[:12]
    some = Some(chosen.bench or BENCHES, chosen.group or GROUPS, chosen.most)
    cases = cases_of(folder, code, WORK / f"diagnoses-{name}.jsonl", Processes(chosen.jobs), some)
    for case in cases if chosen.tune or chosen.folders else ():
        print(line_of(case))
    print(table_of(sets_of(cases)))
    out = chosen.out or (None if chosen.tune or chosen.folders else RESULTS)
    if out is not None:
        write(cases, record_of(cases, perf_counter() - start, code, folder), out)


def _campaigns(chosen: argparse.Namespace) -> Path:
    """The folder of the campaigns, written where they are not there."""
    if chosen.folders:
        return chosen.folders
    scored, folder = not chosen.tune, WORK / (f"tuning-{chosen.tune}" if chosen.tune else "campaigns")
    counts = {bench: chosen.tune or chosen.campaigns or SCORED[bench] for bench in chosen.bench or BENCHES}
    asked = [one for bench, n in counts.items() for one in wanted(bench, n, scored, chosen.group or GROUPS)]
    write_campaigns(folder, asked, Processes(chosen.jobs))
    return folder


if __name__ == "__main__":
    main()
